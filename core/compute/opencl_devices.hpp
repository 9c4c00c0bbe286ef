// opencl_devices.hpp: the OpenCL devices of all platforms and what they can do.
#pragma once
#include <string>
#include <vector>

#include "compute/opencl_api.hpp"

namespace calx {

struct OpenClDevice {
  cl_device_id id = nullptr;
  std::string name, driver;
  std::uint64_t memory = 0, largest = 0;  // bytes in all, and of one allocation
  bool has_double = false, rounds_divide = false;
  std::string inexact;  // why it does not give the bits of other devices
};

/// In the order of platforms. Throws Error(Fault::usage) with the likely causes where there are none.
std::vector<OpenClDevice> opencl_devices(const OpenCl& api);
/// Throws Error(Fault::usage) with a list of all for a number that is none of them.
OpenClDevice opencl_device(const OpenCl& api, int ordinal);

}  // namespace calx
