#include "compute/opencl_api.hpp"

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include "base/error.hpp"

namespace calx {

const OpenCl& opencl() {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<OpenCl>> opened;  // by what the variable names, for tests
  const char* own = std::getenv("CALX_LIBOPENCL");
  const std::lock_guard<std::mutex> lock(mutex);
  std::unique_ptr<OpenCl>& known = opened[own ? own : ""];
  if (known) return *known;
  auto api = std::make_unique<OpenCl>();
  api->library = open_device_library("CALX_LIBOPENCL", {"libOpenCL.so.1", "libOpenCL.so"});
  if (!api->library.handle)
    throw Error(Fault::usage, "device kind opencl needs the OpenCL loader, which does not open (" +
                                  api->library.failure +
                                  "); install ocl-icd-libopencl1 and the driver of the device, for processors "
                                  "pocl-opencl-icd, or name the library in CALX_LIBOPENCL");
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(library_function(api->library, name));
    if (!function)
      throw Error(Fault::usage, api->library.name + " has no function " + name + "; OpenCL 1.2 or newer is needed");
  };
#define CALX_FIND(name, ...) find(api->name, #name);
  CALX_OPENCL_FUNCTIONS(CALX_FIND)
#undef CALX_FIND
  find(api->clCreateContext, "clCreateContext");
  find(api->clCreateCommandQueue, "clCreateCommandQueue");
  find(api->clCreateBuffer, "clCreateBuffer");
  find(api->clCreateProgramWithSource, "clCreateProgramWithSource");
  find(api->clCreateKernel, "clCreateKernel");
  known = std::move(api);
  return *known;
}

std::string opencl_error(cl_int code) {
  static const std::map<cl_int, const char*> names = {{-4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                                                      {-5, "CL_OUT_OF_RESOURCES"},
                                                      {-6, "CL_OUT_OF_HOST_MEMORY"},
                                                      {-11, "CL_BUILD_PROGRAM_FAILURE"},
                                                      {-34, "CL_INVALID_CONTEXT"},
                                                      {-38, "CL_INVALID_MEM_OBJECT"},
                                                      {-45, "CL_INVALID_PROGRAM_EXECUTABLE"},
                                                      {-46, "CL_INVALID_KERNEL_NAME"},
                                                      {-50, "CL_INVALID_ARG_VALUE"},
                                                      {-51, "CL_INVALID_ARG_SIZE"},
                                                      {-52, "CL_INVALID_KERNEL_ARGS"},
                                                      {-54, "CL_INVALID_WORK_GROUP_SIZE"},
                                                      {-55, "CL_INVALID_WORK_ITEM_SIZE"},
                                                      {-61, "CL_INVALID_BUFFER_SIZE"},
                                                      {-1001, "CL_PLATFORM_NOT_FOUND_KHR"}};
  const auto found = names.find(code);
  return std::string(found == names.end() ? "OpenCL error" : found->second) + " (" + std::to_string(code) + ")";
}

}  // namespace calx
