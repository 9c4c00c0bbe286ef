#include "sim/device_choice.hpp"

#include "base/error.hpp"

namespace calx {
namespace {

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const auto& t : texts) out += (out.empty() ? "" : "; ") + t;
  return out;
}

std::string describe(const Device& d) {
  return d.kind() + ": " + d.name() + ", " + d.driver() + (d.exact() ? "" : "; not exact: " + d.inexact_reason());
}

}  // namespace

DeviceChoice choose_device(const std::string& asked, const std::vector<std::string>& obstacles) {
  const auto colon = asked.find(':');
  const std::string kind = asked.substr(0, colon);
  const std::string number = colon == std::string::npos ? "0" : asked.substr(colon + 1);
  const bool named = kind == "opencl" || kind == "cuda" || kind == "host";
  if ((!named && (colon != std::string::npos || (kind != "auto" && kind != "cpu"))) || number.empty() ||
      number.size() > 3 || number.find_first_not_of("0123456789") != std::string::npos)
    throw Error(Fault::usage, "--device " + asked +
                                  ": expected auto, cpu, opencl, cuda or host; a number chooses among several: cuda:1");
  DeviceChoice choice;
  choice.text = "cpu";
  if (kind == "cpu") return choice;
  if (!obstacles.empty()) {
    choice.text = "cpu, because of " + std::to_string(obstacles.size()) +
                  (obstacles.size() == 1 ? " obstacle" : " obstacles") + " to devices: " + joined(obstacles);
    choice.differs = named;
    return choice;
  }
  if (named) {
    choice.device = open_device(kind, std::stoi(number));
    choice.text = describe(*choice.device);
    return choice;
  }
  choice.text = "cpu; no CUDA device";  // --device cuda says why
  for (const DeviceListing& d : list_devices()) {
    if (d.kind != "cuda" || d.ordinal < 0) continue;
    if (d.why_not.empty() && d.inexact.empty()) {
      choice.device = open_device(d.kind, d.ordinal);
      choice.text = describe(*choice.device);
      return choice;
    }
    choice.text = "cpu; " + d.name + ": " + (d.why_not.empty() ? d.inexact : d.why_not);
  }
  return choice;
}

}  // namespace calx
