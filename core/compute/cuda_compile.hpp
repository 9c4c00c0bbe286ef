// cuda_compile.hpp: kernel text to machine code of one NVIDIA architecture. Needs NVRTC, neither a GPU nor a driver.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "compute/device.hpp"
#include "compute/device_cache.hpp"

namespace calx {

struct CudaBinary {
  std::string image, log;
  std::vector<std::pair<std::string, KernelResources>> resources;  // by kernel
  bool from_cache = false;
};

/// architecture: "sm_90"; driver: part of the cache's key. Throws Error(Fault::plugin) where the text does not compile,
/// Error(Fault::usage) where there is no NVRTC.
CudaBinary compile_cuda(const ModuleText& text, const std::string& architecture, const std::string& driver,
                        DeviceCache& cache);

/// Registers, stack and spills of each kernel, from what ptxas prints with -v.
std::vector<std::pair<std::string, KernelResources>> read_resources(const std::string& log);

}  // namespace calx
