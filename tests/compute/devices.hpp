// devices.hpp: opens the devices that the tests of this folder run on: host, OpenCL where the machine has it, and CUDA
// through the stand-in driver, or a real one where CALX_TEST_CUDA is "real".
#pragma once
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "compute/device.hpp"

namespace testing {

/// Compiled modules are kept in the build tree, so that a second run of the tests is fast.
inline calx::DeviceOptions options() {
  calx::DeviceOptions o;
  o.cache = CALX_TEST_CACHE;
  return o;
}

inline bool real_cuda() {
  const char* asked = std::getenv("CALX_TEST_CUDA");
  return asked && std::string(asked) == "real";
}

inline void use_stand_in() {
  if (real_cuda()) return;
  setenv("CALX_LIBCUDA", CALX_STAND_IN_CUDA, 1);
  setenv("CALX_LIBNVRTC", CALX_STAND_IN_NVRTC, 1);
}

/// Null, and a line that says why, where the machine has no such device.
inline std::unique_ptr<calx::Device> open(const std::string& kind) {
  if (kind == "cuda") use_stand_in();
  if (kind == "opencl") {
    std::error_code ignored;
    std::filesystem::create_directories(CALX_TEST_CACHE "/pocl", ignored);
    setenv("POCL_CACHE_DIR", CALX_TEST_CACHE "/pocl", 0);
  }
  if (kind != "opencl") return calx::open_device(kind, 0, options());
  try {
    return calx::open_device(kind, 0, options());
  } catch (const calx::Error& error) {
    MESSAGE("skipped: " << error.what());
    return nullptr;
  }
}

inline const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all = {"host", "opencl", "cuda"};
  return all;
}

/// The text of the calx::Error that f throws.
template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const calx::Error& error) {
    return error.what();
  }
  return "no error";
}

inline bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace testing
