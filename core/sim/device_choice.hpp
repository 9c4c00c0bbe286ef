// device_choice.hpp: where the steps of a case run, and why there.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "compute/device.hpp"

namespace calx {

struct DeviceChoice {
  std::unique_ptr<Device> device;  // null: this processor
  std::string text;                // "cpu; no CUDA device", "opencl: <name>, <driver>"
  bool differs = false;            // not what was asked for by name: say so before the run starts
};

/// asked: "auto", "cpu", "opencl", "cuda" or "host", the last three with ":ordinal" or without. obstacles: why the case
/// cannot step on a device; then it runs on this processor whatever was asked. "auto" takes a CUDA device that gives
/// the bits of the processor. Throws Error(Fault::usage) for another word, and for a device asked for that is not
/// there.
DeviceChoice choose_device(const std::string& asked, const std::vector<std::string>& obstacles);

}  // namespace calx
