#include "compute/cuda_devices.hpp"

#include "base/error.hpp"
#include "compute/device_backends.hpp"
#include "compute/device_failure.hpp"

namespace calx {

std::vector<CudaDeviceFacts> cuda_devices(const CudaDriver& api) {
  int count = 0;
  api.cuDeviceGetCount(&count);
  std::vector<CudaDeviceFacts> all;
  for (int k = 0; k < count; ++k) {
    CudaDeviceFacts device;
    if (api.cuDeviceGet(&device.id, k) != 0) continue;
    char name[256] = "";
    api.cuDeviceGetName(name, sizeof name - 1, device.id);
    device.name = name;
    std::size_t bytes = 0;
    api.cuDeviceTotalMem_v2(&bytes, device.id);
    device.memory = bytes;
    api.cuDeviceGetAttribute(&device.major, CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR, device.id);
    api.cuDeviceGetAttribute(&device.minor, CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR, device.id);
    all.push_back(device);
  }
  if (all.empty())
    throw Error(Fault::usage, "device kind cuda: the driver " + api.library.name +
                                  " finds no device; CUDA_VISIBLE_DEVICES may hide them");
  return all;
}

CudaDeviceFacts cuda_device(const CudaDriver& api, int ordinal) {
  const std::vector<CudaDeviceFacts> all = cuda_devices(api);
  if (ordinal >= 0 && static_cast<std::size_t>(ordinal) < all.size()) return all[ordinal];
  std::string known;
  for (std::size_t k = 0; k < all.size(); ++k)
    known += (k ? ", " : "") + std::to_string(k) + ": " + all[k].name + " (" + bytes_text(double(all[k].memory)) + ")";
  throw Error(Fault::usage, "there is no CUDA device " + std::to_string(ordinal) + "; there are " + known);
}

std::string driver_text(const CudaDriver& api) {
  return "CUDA driver " + std::to_string(api.version / 1000) + "." + std::to_string(api.version % 1000 / 10);
}

std::vector<DeviceListing> list_cuda(const DeviceOptions&) {
  std::vector<DeviceListing> lines;
  try {
    const CudaDriver& api = cuda_driver();
    std::string why_not;
    try {
      nvrtc();
    } catch (const Error& error) {
      why_not = error.what();
    }
    for (const CudaDeviceFacts& device : cuda_devices(api))
      lines.push_back(
          {"cuda", static_cast<int>(lines.size()), device.name, driver_text(api), device.memory, why_not, ""});
  } catch (const Error& error) {
    DeviceListing line;
    line.kind = "cuda";
    line.why_not = error.what();
    lines.push_back(line);
  }
  return lines;
}

}  // namespace calx
