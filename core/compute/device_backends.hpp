// device_backends.hpp: what open_device chooses from.
#pragma once
#include <memory>
#include <vector>

#include "compute/device.hpp"

namespace calx {

std::unique_ptr<Device> open_host(int ordinal, const DeviceOptions& options);
std::unique_ptr<Device> open_opencl(int ordinal, const DeviceOptions& options);
std::unique_ptr<Device> open_cuda(int ordinal, const DeviceOptions& options);
std::vector<DeviceListing> list_host(const DeviceOptions& options);
std::vector<DeviceListing> list_opencl(const DeviceOptions& options);
std::vector<DeviceListing> list_cuda(const DeviceOptions& options);

/// CALX_DEVICE_SYNC=1, or asked for.
bool sync_each_launch(const DeviceOptions& options);

}  // namespace calx
