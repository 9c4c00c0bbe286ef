// cuda_devices.hpp: the devices of the CUDA driver.
#pragma once
#include <string>
#include <vector>

#include "compute/cuda_api.hpp"

namespace calx {

struct CudaDeviceFacts {
  CUdevice id = 0;
  std::string name;
  std::uint64_t memory = 0;  // bytes
  int major = 0, minor = 0;  // compute capability
};

/// Throws Error(Fault::usage) where there is none.
std::vector<CudaDeviceFacts> cuda_devices(const CudaDriver& api);
/// Throws Error(Fault::usage) with a list of all for a number that is none of them.
CudaDeviceFacts cuda_device(const CudaDriver& api, int ordinal);

/// "CUDA driver 12.4".
std::string driver_text(const CudaDriver& api);

}  // namespace calx
