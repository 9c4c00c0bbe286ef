// device.hpp: the thin seam between the engine and what computes for it: an OpenCL device, a CUDA device, or the host,
// where the same kernels run as plain loops. One text (device_text.hpp) for all; in exact mode the same bits on all.
// A Device is used by one thread at a time; several threads may use several devices. Operations run in the order given;
// launches, copies and zeroing return at once, and a failure may surface at a later call.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "compute/device_text.hpp"

namespace calx {

/// What the backends keep behind the handles below. Each holds its context alive, so that destructors may run in any
/// order.
namespace device_part {
struct Memory {
  virtual ~Memory() = default;
};
struct Parameter {
  std::uint32_t bytes = 0;  // 0: not known
  enum { value, buffer, unknown } kind = unknown;
};
struct Kernel {
  virtual ~Kernel() = default;
  std::string name;
  std::string module;                 // label of its module
  std::vector<Parameter> parameters;  // empty where the backend cannot tell
};
struct Module {
  virtual ~Module() = default;
  virtual std::shared_ptr<const Kernel> find(const std::string& name) = 0;
};
struct Pending {
  virtual ~Pending() = default;
  virtual bool ready() = 0;
  virtual void wait() = 0;
};
struct Graph {
  virtual ~Graph() = default;
  std::size_t operations = 0;
  std::vector<std::shared_ptr<const void>> kept;  // kernels and work space that its operations use
};
}  // namespace device_part

/// Memory of a device; freed with the object. Must outlive what was launched on it and graphs that use it.
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  DeviceBuffer(std::unique_ptr<device_part::Memory> memory, std::size_t bytes)
      : memory_(std::move(memory)), bytes_(bytes) {}
  std::size_t bytes() const { return bytes_; }
  explicit operator bool() const { return memory_ != nullptr; }
  const device_part::Memory* memory() const { return memory_.get(); }

 private:
  std::unique_ptr<device_part::Memory> memory_;
  std::size_t bytes_ = 0;
};

/// A kernel of a module; copied freely, keeps the module's code alive.
class DeviceKernel {
 public:
  DeviceKernel() = default;
  explicit DeviceKernel(std::shared_ptr<const device_part::Kernel> kernel) : kernel_(std::move(kernel)) {}
  const std::string& name() const { return kernel_->name; }
  explicit operator bool() const { return kernel_ != nullptr; }
  const std::shared_ptr<const device_part::Kernel>& part() const { return kernel_; }

 private:
  std::shared_ptr<const device_part::Kernel> kernel_;
};

/// Per item; -1 where the backend does not tell. Known for CUDA.
struct KernelResources {
  int registers = -1, stack_bytes = -1, spill_bytes = -1;
};

class DeviceModule {
 public:
  DeviceModule() = default;
  /// Throws Error(Fault::plugin) for a name that is not a kernel of the module.
  DeviceKernel kernel(const std::string& name) const;
  /// What the compiler said, warnings and, for CUDA, the use of registers.
  const std::string& log() const { return log_; }
  double build_seconds() const { return build_seconds_; }
  /// Came from the cache folder of compiled modules.
  bool from_cache() const { return from_cache_; }
  KernelResources resources(const std::string& kernel) const;

 private:
  friend class Device;
  std::shared_ptr<device_part::Module> module_;
  std::string label_, device_, log_;
  std::vector<std::pair<std::string, KernelResources>> resources_;
  double build_seconds_ = 0;
  bool from_cache_ = false;
};

/// Operations recorded once and started as one.
class DeviceGraph {
 public:
  DeviceGraph() = default;
  explicit operator bool() const { return graph_ != nullptr; }
  std::size_t operations() const { return graph_ ? graph_->operations : 0; }

 private:
  friend class Device;
  std::shared_ptr<device_part::Graph> graph_;
};

/// A read under way. wait() before the target is looked at; the destructor waits, too. Made to be moved.
class DeviceEvent {
 public:
  DeviceEvent() = default;
  explicit DeviceEvent(std::unique_ptr<device_part::Pending> pending) : pending_(std::move(pending)) {}
  DeviceEvent(DeviceEvent&&) = default;
  DeviceEvent& operator=(DeviceEvent&& other) noexcept;
  ~DeviceEvent();
  bool ready() const { return !pending_ || pending_->ready(); }
  void wait();

 private:
  std::unique_ptr<device_part::Pending> pending_;
};

/// Arguments of one launch, copied: buffers (an empty one is a null pointer), numbers of 4 or 8 bytes, structs of such.
class DeviceArguments {
 public:
  static constexpr std::size_t kMost = 64, kValueBytes = 1024;
  struct Item {
    const device_part::Memory* memory;  // of a buffer; null for an empty one
    std::uint32_t offset, bytes;        // of a value
    bool is_buffer;
  };

  std::size_t size() const { return count_; }
  const Item& operator[](std::size_t k) const { return items_[k]; }
  const void* value(std::size_t k) const { return values_ + items_[k].offset; }

  void add(const DeviceBuffer& buffer) { items_[count_++] = {buffer.memory(), 0, sizeof(void*), true}; }
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable<T>::value && !std::is_pointer<T>::value,
                  "pass buffers, numbers or structs");
    static_assert(sizeof(T) % 4 == 0, "pass 4- and 8-byte numbers or structs of them; bool and char differ per device");
    used_ = (used_ + 7u) & ~7u;
    __builtin_memcpy(values_ + used_, &value, sizeof value);
    items_[count_++] = {nullptr, used_, sizeof value, false};
    used_ += sizeof value;
  }

 private:
  std::uint32_t count_ = 0, used_ = 0;
  Item items_[kMost];
  alignas(8) unsigned char values_[kValueBytes];
};

/// launch(kernel, n, arguments(positions, radii, dt, n)).
template <class... A>
DeviceArguments arguments(const A&... a) {
  static_assert(sizeof...(A) <= DeviceArguments::kMost, "too many arguments");
  static_assert((((sizeof(A) + 7) & ~std::size_t(7)) + ... + 0) <= DeviceArguments::kValueBytes, "too large arguments");
  DeviceArguments list;
  (list.add(a), ...);
  return list;
}

enum class Reduction { sum, smallest, largest };

struct DeviceMemory {
  std::uint64_t total = 0, free = 0;  // bytes; 0: not known
};

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device();

  /// "host", "opencl" or "cuda".
  virtual std::string kind() const = 0;
  virtual std::string name() const = 0;
  /// Driver and compiler with their versions, for provenance.
  virtual std::string driver() const = 0;
  virtual DeviceMemory memory() const = 0;
  virtual bool supports_double() const = 0;
  /// Modules that are not fast give the bits of every other exact device. Otherwise inexact_reason() says why not.
  bool exact() const { return inexact_reason().empty(); }
  virtual std::string inexact_reason() const { return {}; }

  /// All bytes zero. Throws Error(Fault::settings) with the bytes asked for, free and in all.
  DeviceBuffer allocate(std::size_t bytes);
  /// The bytes at data may change after the call.
  void write(const DeviceBuffer& to, const void* data, std::size_t bytes, std::size_t offset = 0);
  /// Waits for all before it and for the bytes.
  void read(const DeviceBuffer& from, void* data, std::size_t bytes, std::size_t offset = 0);
  /// Returns at once; data must live until the event has been waited for.
  DeviceEvent read_later(const DeviceBuffer& from, void* data, std::size_t bytes, std::size_t offset = 0);
  /// Of all reads so far.
  std::uint64_t bytes_read() const { return bytes_read_; }
  void zero(const DeviceBuffer& buffer, std::size_t bytes, std::size_t offset = 0);
  /// The two ranges must not overlap.
  void copy(const DeviceBuffer& to, const DeviceBuffer& from, std::size_t bytes, std::size_t to_offset = 0,
            std::size_t from_offset = 0);
  template <class T>
  DeviceBuffer upload(const std::vector<T>& values) {
    DeviceBuffer buffer = allocate(values.size() * sizeof(T));
    write(buffer, values.data(), values.size() * sizeof(T));
    return buffer;
  }
  template <class T>
  std::vector<T> download(const DeviceBuffer& from, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    read(from, values.data(), count * sizeof(T), first * sizeof(T));
    return values;
  }

  /// Throws Error(Fault::plugin) with the first lines of the log, which names part and line, and the path of the whole.
  DeviceModule build(const ModuleText& text);
  /// items: at most 2^32 - 1024; group: items that run together, 0 for a preset. Number and size of the arguments are
  /// compared with the kernel's.
  void launch(const DeviceKernel& kernel, std::size_t items, const DeviceArguments& arguments, std::size_t group = 0);
  /// Waits for everything.
  void finish();

  /// Between the two, launches, copies, zeroing, scans and reductions are recorded and not run; anything else throws.
  void begin_capture();
  DeviceGraph end_capture();
  void launch(const DeviceGraph& graph);

  /// out[k] = in[0] + ... + in[k-1] of u32 for k = 0..n, so that out[n] is the total; modulo 2^32. in and out may not
  /// be the same buffer; out holds n + 1 numbers.
  void exclusive_scan(const DeviceBuffer& in, const DeviceBuffer& out, std::size_t n);
  /// out[out_index] = in[0] (+) ... (+) in[n-1], in an order that depends on n alone. T: float, double or uint32_t.
  /// The sum of none is 0; the smallest and the largest of none is 0, too.
  template <class T>
  void reduce(Reduction what, const DeviceBuffer& in, std::size_t n, const DeviceBuffer& out,
              std::size_t out_index = 0);
  /// Work space and kernels for scans and reductions of up to n; needed before a capture that holds the first of them.
  void reserve(std::size_t n);

 protected:
  struct Built {
    std::shared_ptr<device_part::Module> module;
    std::string log;
    std::vector<std::pair<std::string, KernelResources>> resources;
    bool from_cache = false;
  };
  virtual std::unique_ptr<device_part::Memory> do_allocate(std::size_t bytes) = 0;
  virtual void do_write(const device_part::Memory& to, const void* data, std::size_t bytes, std::size_t offset) = 0;
  virtual std::unique_ptr<device_part::Pending> do_read(const device_part::Memory& from, void* data, std::size_t bytes,
                                                        std::size_t offset) = 0;
  virtual void do_zero(const device_part::Memory& buffer, std::size_t bytes, std::size_t offset) = 0;
  virtual void do_copy(const device_part::Memory& to, const device_part::Memory& from, std::size_t bytes,
                       std::size_t to_offset, std::size_t from_offset) = 0;
  virtual Built do_build(const ModuleText& text) = 0;
  virtual void do_launch(const device_part::Kernel& kernel, std::size_t items, const DeviceArguments& arguments,
                         std::size_t group) = 0;
  virtual void do_finish() = 0;
  /// A backend without graphs of its own leaves these: operations are kept as a list and run one after the other.
  virtual bool records_itself() const { return false; }
  virtual void do_begin_capture() {}
  virtual std::shared_ptr<device_part::Graph> do_end_capture() { return nullptr; }
  virtual void do_launch_graph(const device_part::Graph&) {}

 private:
  struct Primitives;
  void submit(std::function<void()> operation);
  void refuse_in_capture(const char* what) const;
  void reduce(Reduction what, const char* suffix, std::size_t size, const DeviceBuffer& in, std::size_t n,
              const DeviceBuffer& out, std::size_t out_index);

  std::shared_ptr<Primitives> primitives_;
  bool capturing_ = false;
  std::vector<std::function<void()>> recorded_;
  std::vector<std::shared_ptr<const void>> kept_;
  std::size_t operations_ = 0;
  std::uint64_t bytes_read_ = 0;
};

struct DeviceOptions {
  /// Folder of compiled modules and logs; empty: $CALX_CACHE, else calx in $XDG_CACHE_HOME or ~/.cache. "none": no
  /// cache.
  std::string cache;
  /// Wait after each launch, so that an error names its own kernel. Also set by CALX_DEVICE_SYNC=1.
  bool sync_each_launch = false;
};

/// kind: "host", "opencl" or "cuda". Throws Error(Fault::usage) that says what is missing, or which ordinals there are.
/// [any]
std::unique_ptr<Device> open_device(const std::string& kind, int ordinal = 0, const DeviceOptions& options = {});

struct DeviceListing {
  std::string kind;
  int ordinal = -1;  // -1: the kind cannot be used at all
  std::string name;
  std::string driver;
  std::uint64_t memory = 0;  // bytes
  std::string why_not;       // empty where it can be used
  std::string inexact;       // empty where exact
};

/// Every device of every kind, and one line for each kind that has none. Never throws for a missing one. [any]
std::vector<DeviceListing> list_devices(const DeviceOptions& options = {});

}  // namespace calx
