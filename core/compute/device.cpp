// The parts of a device that are the same for every backend: checks of ranges and arguments, and recording.
#include "compute/device.hpp"

#include <chrono>

#include "base/error.hpp"

namespace calx {
namespace {

/// The operations of a backend without graphs of its own.
struct RecordedGraph : device_part::Graph {
  std::vector<std::function<void()>> list;
};

void check_range(const DeviceBuffer& buffer, std::size_t bytes, std::size_t offset, const char* what) {
  if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
    throw Error(Fault::numerics, std::string(what) + " of " + std::to_string(bytes) + " bytes at " +
                                     std::to_string(offset) + " does not fit in a device buffer of " +
                                     std::to_string(buffer.bytes()) + " bytes");
}

void check_arguments(const device_part::Kernel& kernel, const DeviceArguments& given) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Fault::numerics, "kernel " + kernel.name + " of module \"" + kernel.module + "\" " + why);
  };
  if (kernel.parameters.empty()) return;
  if (kernel.parameters.size() != given.size())
    refuse("takes " + std::to_string(kernel.parameters.size()) + " arguments; " + std::to_string(given.size()) +
           " are given");
  for (std::size_t k = 0; k < given.size(); ++k) {
    const device_part::Parameter& wanted = kernel.parameters[k];
    const bool is_buffer = given[k].is_buffer;
    const bool same_kind =
        wanted.kind == device_part::Parameter::unknown || (wanted.kind == device_part::Parameter::buffer) == is_buffer;
    if (same_kind && (wanted.bytes == 0 || wanted.bytes == given[k].bytes)) continue;
    refuse("takes " +
           (wanted.kind == device_part::Parameter::buffer ? "a buffer" : std::to_string(wanted.bytes) + " bytes") +
           " as argument " + std::to_string(k + 1) + "; " +
           (is_buffer ? "a buffer is" : std::to_string(given[k].bytes) + " bytes are") + " given");
  }
}

}  // namespace

DeviceEvent& DeviceEvent::operator=(DeviceEvent&& other) noexcept {
  std::swap(pending_, other.pending_);
  return *this;
}

DeviceEvent::~DeviceEvent() {
  try {
    wait();
  } catch (const std::exception&) {
    // The device has failed; the next operation on it says so.
  }
}

void DeviceEvent::wait() {
  if (!pending_) return;
  const std::unique_ptr<device_part::Pending> pending = std::move(pending_);
  pending->wait();
}

DeviceKernel DeviceModule::kernel(const std::string& name) const {
  std::shared_ptr<const device_part::Kernel> found = module_->find(name);
  if (!found)
    throw Error(Fault::plugin, "module \"" + label_ + "\" for " + device_ + " has no kernel " + name +
                                   "; its text must define KERNEL(" + name + ", ...)");
  return DeviceKernel(std::move(found));
}

KernelResources DeviceModule::resources(const std::string& kernel) const {
  for (const auto& each : resources_)
    if (each.first == kernel) return each.second;
  return {};
}

Device::~Device() = default;

void Device::refuse_in_capture(const char* what) const {
  if (capturing_)
    throw Error(Fault::numerics, name() + ": " + what +
                                     " while a graph is recorded; only launches, copies, zeroing, scans and "
                                     "reductions can be part of one");
}

void Device::submit(std::function<void()> operation) {
  if (capturing_) ++operations_;
  if (capturing_ && !records_itself())
    recorded_.push_back(std::move(operation));
  else
    operation();
}

DeviceBuffer Device::allocate(std::size_t bytes) {
  refuse_in_capture("memory is asked for");
  const std::size_t rounded = bytes ? (bytes + 15) / 16 * 16 : 16;
  return DeviceBuffer(do_allocate(rounded), bytes);
}

void Device::write(const DeviceBuffer& to, const void* data, std::size_t bytes, std::size_t offset) {
  refuse_in_capture("a buffer is written");
  check_range(to, bytes, offset, "a write");
  if (bytes) do_write(*to.memory(), data, bytes, offset);
}

void Device::read(const DeviceBuffer& from, void* data, std::size_t bytes, std::size_t offset) {
  read_later(from, data, bytes, offset).wait();
}

DeviceEvent Device::read_later(const DeviceBuffer& from, void* data, std::size_t bytes, std::size_t offset) {
  refuse_in_capture("a buffer is read");
  check_range(from, bytes, offset, "a read");
  if (bytes == 0) return {};
  bytes_read_ += bytes;
  return DeviceEvent(do_read(*from.memory(), data, bytes, offset));
}

void Device::zero(const DeviceBuffer& buffer, std::size_t bytes, std::size_t offset) {
  check_range(buffer, bytes, offset, "zeroing");
  if (bytes) submit([=, memory = buffer.memory()] { do_zero(*memory, bytes, offset); });
}

void Device::copy(const DeviceBuffer& to, const DeviceBuffer& from, std::size_t bytes, std::size_t to_offset,
                  std::size_t from_offset) {
  check_range(to, bytes, to_offset, "a copy");
  check_range(from, bytes, from_offset, "a copy");
  if (bytes)
    submit([=, target = to.memory(), source = from.memory()] {
      do_copy(*target, *source, bytes, to_offset, from_offset);
    });
}

DeviceModule Device::build(const ModuleText& text) {
  refuse_in_capture("a module is built");
  const auto start = std::chrono::steady_clock::now();
  Built built = do_build(text);
  DeviceModule module;
  module.module_ = std::move(built.module);
  module.label_ = text.label;
  module.device_ = name();
  module.log_ = std::move(built.log);
  module.resources_ = std::move(built.resources);
  module.from_cache_ = built.from_cache;
  module.build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return module;
}

void Device::launch(const DeviceKernel& kernel, std::size_t items, const DeviceArguments& given, std::size_t group) {
  constexpr std::size_t kMostItems = 0xffffffffu - 1023u;
  if (items > kMostItems)
    throw Error(Fault::settings, "kernel " + kernel.name() + " is asked for " + std::to_string(items) +
                                     " items; at most " + std::to_string(kMostItems) + " are possible");
  check_arguments(*kernel.part(), given);
  if (items == 0) return;
  if (capturing_) kept_.push_back(kernel.part());
  if (capturing_ && !records_itself())
    submit([this, part = kernel.part(), items, given, group] { do_launch(*part, items, given, group); });
  else {
    if (capturing_) ++operations_;
    do_launch(*kernel.part(), items, given, group);
  }
}

void Device::finish() {
  refuse_in_capture("its end is waited for");
  do_finish();
}

void Device::begin_capture() {
  refuse_in_capture("a second recording is begun");
  do_begin_capture();
  capturing_ = true;
  operations_ = 0;
}

DeviceGraph Device::end_capture() {
  if (!capturing_) throw Error(Fault::numerics, name() + ": the end of a recording that was not begun");
  capturing_ = false;
  DeviceGraph graph;
  if (records_itself()) {
    graph.graph_ = do_end_capture();
  } else {
    auto list = std::make_shared<RecordedGraph>();
    list->list.swap(recorded_);
    graph.graph_ = std::move(list);
  }
  graph.graph_->operations = operations_;
  graph.graph_->kept.swap(kept_);
  return graph;
}

void Device::launch(const DeviceGraph& graph) {
  refuse_in_capture("a graph is started");
  if (!graph) return;
  if (records_itself())
    do_launch_graph(*graph.graph_);
  else
    for (const auto& operation : static_cast<const RecordedGraph&>(*graph.graph_).list) operation();
}

}  // namespace calx
