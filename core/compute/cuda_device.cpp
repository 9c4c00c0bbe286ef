#include "base/error.hpp"
#include "compute/device_backends.hpp"
namespace calx {
std::unique_ptr<Device> open_cuda(int, const DeviceOptions&) { throw Error(Fault::usage, "no CUDA"); }
std::vector<DeviceListing> list_cuda(const DeviceOptions&) { return {}; }
}  // namespace calx
