#include "compute/cuda_api.hpp"

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include "base/error.hpp"

namespace calx {
namespace {

/// One opened library for each value of the variable: programs have one, tests several.
template <class Api, class Open>
const Api& opened_once(const char* variable, Open&& open) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<Api>> opened;
  const char* own = std::getenv(variable);
  const std::lock_guard<std::mutex> lock(mutex);
  std::unique_ptr<Api>& known = opened[own ? own : ""];
  if (!known) known = open();
  return *known;
}

template <class Function>
void find(Function& function, const DeviceLibrary& library, const char* name) {
  function = reinterpret_cast<Function>(library_function(library, name));
  if (!function)
    throw Error(Fault::usage, library.name + " has no function " + name + "; CUDA 11.4 or newer is needed");
}

}  // namespace

std::string CudaDriver::error(CUresult code) const {
  const char *name = nullptr, *text = nullptr;
  cuGetErrorName(code, &name);
  cuGetErrorString(code, &text);
  return std::string(name ? name : "CUDA error " + std::to_string(code)) + ": " + (text ? text : "unknown");
}

const CudaDriver& cuda_driver() {
  return opened_once<CudaDriver>("CALX_LIBCUDA", [] {
    auto api = std::make_unique<CudaDriver>();
    api->library = open_device_library("CALX_LIBCUDA", {"libcuda.so.1"});
    if (!api->library.handle)
      throw Error(Fault::usage, "device kind cuda needs an NVIDIA driver, whose library does not open (" +
                                    api->library.failure +
                                    "); install the driver, in a container start it with the GPU, or name the "
                                    "library in CALX_LIBCUDA");
#define CALX_FIND(name, ...) find(api->name, api->library, #name);
    CALX_CUDA_FUNCTIONS(CALX_FIND)
#undef CALX_FIND
    api->cuFuncGetParamInfo =
        reinterpret_cast<decltype(api->cuFuncGetParamInfo)>(library_function(api->library, "cuFuncGetParamInfo"));
    if (const CUresult code = api->cuInit(0))
      throw Error(Fault::usage, "device kind cuda: the driver " + api->library.name +
                                    " does not start: " + api->error(code) + "; nvidia-smi says more");
    api->cuDriverGetVersion(&api->version);
    return api;
  });
}

const Nvrtc& nvrtc() {
  return opened_once<Nvrtc>("CALX_LIBNVRTC", [] {
    auto api = std::make_unique<Nvrtc>();
    std::vector<std::string> names = {"libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so", "libnvrtc.so.11.2"};
    const char* home = std::getenv("CUDA_HOME");
    for (const std::string& base : {std::string(home ? home : ""), std::string("/usr/local/cuda")})
      if (!base.empty()) names.push_back(base + "/lib64/libnvrtc.so");
    for (const char* version : {"13", "12"})
      names.push_back("/usr/local/cuda/lib64/libnvrtc.so." + std::string(version));
    api->library = open_device_library("CALX_LIBNVRTC", names);
    if (!api->library.handle)
      throw Error(Fault::usage, "device kind cuda compiles its kernels with NVRTC, which does not open (" +
                                    api->library.failure +
                                    "); install the CUDA toolkit's package of nvrtc, or name the library in "
                                    "CALX_LIBNVRTC");
#define CALX_FIND(name, ...) find(api->name, api->library, #name);
    CALX_NVRTC_FUNCTIONS(CALX_FIND)
#undef CALX_FIND
    api->nvrtcVersion(&api->major, &api->minor);
    return api;
  });
}

}  // namespace calx
