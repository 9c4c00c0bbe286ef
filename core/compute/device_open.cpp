// device_open.cpp: the choice of a backend.
#include <cstdlib>

#include "base/error.hpp"
#include "compute/device_backends.hpp"

namespace calx {

bool sync_each_launch(const DeviceOptions& options) {
  const char* asked = std::getenv("CALX_DEVICE_SYNC");
  return options.sync_each_launch || (asked && *asked && *asked != '0');
}

std::unique_ptr<Device> open_device(const std::string& kind, int ordinal, const DeviceOptions& options) {
  if (kind == "host") return open_host(ordinal, options);
  if (kind == "opencl") return open_opencl(ordinal, options);
  if (kind == "cuda") return open_cuda(ordinal, options);
  throw Error(Fault::usage, "there is no device kind \"" + kind + "\"; there are host, opencl and cuda");
}

std::vector<DeviceListing> list_devices(const DeviceOptions& options) {
  std::vector<DeviceListing> all;
  for (const auto list : {list_host, list_opencl, list_cuda})
    for (DeviceListing& each : list(options)) all.push_back(std::move(each));
  return all;
}

}  // namespace calx
