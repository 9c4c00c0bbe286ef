// device_kinds.hpp: the devices that tests of whole cases run on.
#pragma once
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "compute/device.hpp"

namespace calx {

/// Devices of this machine; CUDA is a stand-in driver unless CALX_TEST_CUDA is "real".
inline std::vector<std::string> test_devices() {
  setenv("CALX_CACHE", CALX_TEST_CACHE, 0);
  std::filesystem::create_directories(CALX_TEST_CACHE "/pocl");
  setenv("POCL_CACHE_DIR", CALX_TEST_CACHE "/pocl", 0);
  const char* asked = std::getenv("CALX_TEST_CUDA");
  if (!asked || std::string(asked) != "real") {
    setenv("CALX_LIBCUDA", CALX_STAND_IN_CUDA, 1);
    setenv("CALX_LIBNVRTC", CALX_STAND_IN_NVRTC, 1);
  }
  std::vector<std::string> kinds{"host", "cuda"};
  try {
    open_device("opencl");
    kinds.push_back("opencl");
  } catch (const Error& e) {
    MESSAGE("skipped: " << e.what());
  }
  return kinds;
}

}  // namespace calx
