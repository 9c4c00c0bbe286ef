// device_failure.hpp: the messages that all backends share.
#pragma once
#include <cstdint>
#include <string>

#include "compute/device.hpp"
#include "compute/device_cache.hpp"

namespace calx {

/// "12.5 GB"; SI prefixes.
std::string bytes_text(double bytes);

/// Names the part at fault where the log does; keeps the whole log in the cache folder. The text itself is not kept.
[[noreturn]] void build_failed(const ModuleText& text, const std::string& device, const std::string& log,
                               DeviceCache& cache);
[[noreturn]] void out_of_memory(const std::string& device, std::uint64_t asked, const DeviceMemory& memory,
                                const std::string& reason);
[[noreturn]] void launch_failed(const std::string& device, const device_part::Kernel& kernel, std::size_t items,
                                const std::string& reason);

}  // namespace calx
