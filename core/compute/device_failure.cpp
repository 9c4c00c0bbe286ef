#include "compute/device_failure.hpp"

#include <cstdio>
#include <sstream>

#include "base/error.hpp"

namespace calx {

std::string bytes_text(double bytes) {
  const char* prefix = "";
  for (const char* next : {"k", "M", "G", "T"}) {
    if (bytes < 1000) break;
    bytes /= 1000;
    prefix = next;
  }
  char text[40];
  std::snprintf(text, sizeof text, *prefix ? "%.4g %sB" : "%.0f %sB", bytes, prefix);
  return text;
}

void build_failed(const ModuleText& text, const std::string& device, const std::string& log, DeviceCache& cache) {
  constexpr int kLines = 6;
  std::istringstream lines(log);
  std::string line, shown, part;
  int count = 0;
  while (std::getline(lines, line) && count < kLines) {
    if (count == 0 && line.find("error") == std::string::npos) continue;
    if (count++ == 0)
      for (const TextPart& each : text.parts)
        if (line.find(each.name) != std::string::npos) part = each.name;
    shown += "\n  " + line;
  }
  if (shown.empty()) shown = "\n  " + (log.empty() ? std::string("the compiler says nothing") : log.substr(0, 1000));
  const std::string path = cache.keep_log(text.label, log);
  throw Error(Fault::plugin, "module \"" + text.label + "\" does not compile for " + device +
                                 (part.empty() ? "" : "; the error is in " + part) + ":" + shown +
                                 (path.empty() ? "\n  (the whole log could not be kept: no cache folder)"
                                               : "\n  the whole log: " + path));
}

void out_of_memory(const std::string& device, std::uint64_t asked, const DeviceMemory& memory,
                   const std::string& reason) {
  throw Error(Fault::settings,
              device + " has no memory left: " + (asked ? "asked for " + bytes_text(double(asked)) + ", " : "") +
                  "free " + (memory.free ? bytes_text(double(memory.free)) : "unknown") + ", in all " +
                  (memory.total ? bytes_text(double(memory.total)) : "unknown") + " (" + reason +
                  "); use fewer particles, a device with more memory, or --device cpu");
}

void launch_failed(const std::string& device, const device_part::Kernel& kernel, std::size_t items,
                   const std::string& reason) {
  throw Error(Fault::numerics, device + ": kernel " + kernel.name + " of module \"" + kernel.module + "\" failed on " +
                                   std::to_string(items) + " items: " + reason);
}

}  // namespace calx
