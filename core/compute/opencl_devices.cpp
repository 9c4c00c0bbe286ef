#include "compute/opencl_devices.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"

namespace calx {
namespace {

std::string text(const OpenCl& api, cl_device_id id, cl_uint what) {
  std::size_t bytes = 0;
  if (api.clGetDeviceInfo(id, what, 0, nullptr, &bytes) != 0) return "unknown";
  std::string value(bytes, '\0');
  api.clGetDeviceInfo(id, what, bytes, &value[0], nullptr);
  while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.pop_back();
  return value;
}

cl_ulong number(const OpenCl& api, cl_device_id id, cl_uint what) {
  cl_ulong value = 0;
  return api.clGetDeviceInfo(id, what, sizeof value, &value, nullptr) == 0 ? value : 0;
}

OpenClDevice describe(const OpenCl& api, cl_platform_id platform, cl_device_id id) {
  OpenClDevice device;
  char name[256] = "";
  api.clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, nullptr);
  device.id = id;
  device.name = text(api, id, CL_DEVICE_NAME);
  device.driver =
      std::string(name) + ", " + text(api, id, CL_DEVICE_VERSION) + ", driver " + text(api, id, CL_DRIVER_VERSION);
  device.memory = number(api, id, CL_DEVICE_GLOBAL_MEM_SIZE);
  device.largest = number(api, id, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  const cl_ulong single = number(api, id, CL_DEVICE_SINGLE_FP_CONFIG);
  const cl_ulong twice = number(api, id, CL_DEVICE_DOUBLE_FP_CONFIG);
  device.has_double = twice != 0;
  device.rounds_divide = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  if (!(single & CL_FP_ROUND_TO_NEAREST))
    device.inexact = "single precision does not round to nearest";
  else if (!device.rounds_divide)
    device.inexact = "division and square root in single precision are not rounded correctly";
  else if (!(single & CL_FP_DENORM))
    device.inexact = "numbers below 1.2e-38 count as zero in single precision";
  return device;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Why a loader finds nothing, as far as it can be seen from here.
std::string causes(cl_uint platforms) {
  const std::string folder =
      environment("OCL_ICD_VENDORS").empty() ? "/etc/OpenCL/vendors" : environment("OCL_ICD_VENDORS");
  if (platforms == 0)
    return "no driver is registered: " + folder +
           " holds no usable .icd file. Install pocl-opencl-icd for processors or " +
           "the driver of the device; in containers with an NVIDIA driver set OCL_ICD_VENDORS=libnvidia-opencl.so.1";
  const std::string cache = environment("POCL_CACHE_DIR");
  std::error_code ignored;
  std::filesystem::create_directories(cache, ignored);
  if (!cache.empty() && access(cache.c_str(), W_OK) != 0)
    return "a platform is registered and shows no device: PoCL does so where its cache folder cannot be written, and "
           "POCL_CACHE_DIR is \"" +
           cache + "\", which cannot; name another folder or unset it";
  return std::to_string(platforms) +
         " platforms are registered and show no device: the driver may not match the "
         "hardware, or its cache folder (PoCL: POCL_CACHE_DIR, else in XDG_CACHE_HOME or HOME) cannot be written";
}

}  // namespace

std::vector<OpenClDevice> opencl_devices(const OpenCl& api) {
  cl_uint count = 0;
  if (api.clGetPlatformIDs(0, nullptr, &count) != 0) count = 0;
  std::vector<cl_platform_id> platforms(count);
  if (count > 0) api.clGetPlatformIDs(count, platforms.data(), nullptr);
  std::vector<OpenClDevice> devices;
  for (cl_platform_id platform : platforms) {
    cl_uint here = 0;
    if (api.clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &here) != 0) continue;
    std::vector<cl_device_id> ids(here);
    if (here > 0) api.clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, here, ids.data(), nullptr);
    for (cl_device_id id : ids) devices.push_back(describe(api, platform, id));
  }
  if (devices.empty())
    throw Error(Fault::usage, "device kind opencl: " + api.library.name + " finds no device; " + causes(count));
  return devices;
}

OpenClDevice opencl_device(const OpenCl& api, int ordinal) {
  const std::vector<OpenClDevice> devices = opencl_devices(api);
  if (ordinal >= 0 && static_cast<std::size_t>(ordinal) < devices.size()) return devices[ordinal];
  std::string known;
  for (std::size_t k = 0; k < devices.size(); ++k)
    known += (k ? ", " : "") + std::to_string(k) + ": " + devices[k].name + " (" + devices[k].driver + ")";
  throw Error(Fault::usage, "there is no OpenCL device " + std::to_string(ordinal) + "; there are " + known);
}

}  // namespace calx
