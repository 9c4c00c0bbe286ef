// host_device.cpp: kernels as plain loops of one thread, compiled by the machine's C++ compiler: the reference for
// tests and the place where a debugger sees everything ("CALX_CXX=g++ -g -O0").
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

#include "base/error.hpp"
#include "compute/device_backends.hpp"
#include "compute/device_cache.hpp"
#include "compute/device_failure.hpp"
#include "compute/host_compiler.hpp"

namespace calx {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.compare(0, 10, "model name") == 0) return line.substr(line.find(':') + 2);
  return "processor";
}

struct HostMemory : device_part::Memory {
  explicit HostMemory(std::size_t bytes) : data(static_cast<char*>(std::calloc(bytes, 1))) {}
  ~HostMemory() override { std::free(data); }
  char* data;
};

char* data(const device_part::Memory& memory) { return static_cast<const HostMemory&>(memory).data; }

struct HostKernel : device_part::Kernel {
  void (*run)(unsigned long long items, void** arguments) = nullptr;
  std::shared_ptr<void> library;
};

struct HostModule : device_part::Module {
  std::shared_ptr<void> library;
  std::string label;
  std::map<std::string, std::shared_ptr<const device_part::Kernel>> kernels;

  std::shared_ptr<const device_part::Kernel> find(const std::string& name) override {
    auto& known = kernels[name];
    if (known) return known;
    void* run = dlsym(library.get(), ("calx_run_" + name).c_str());
    void* parameters = dlsym(library.get(), ("calx_parameters_" + name).c_str());
    if (!run || !parameters) return nullptr;
    auto kernel = std::make_shared<HostKernel>();
    kernel->name = name;
    kernel->module = label;
    kernel->library = library;
    kernel->run = reinterpret_cast<decltype(kernel->run)>(run);
    constexpr std::uint32_t kPointer = 0x80000000u;
    for (const std::uint32_t* p = reinterpret_cast<const std::uint32_t* (*)()>(parameters)(); *p; ++p)
      kernel->parameters.push_back(
          {*p & ~kPointer, *p & kPointer ? device_part::Parameter::buffer : device_part::Parameter::value});
    return known = kernel;
  }
};

/// Reads are done when asked for.
struct Done : device_part::Pending {
  bool ready() override { return true; }
  void wait() override {}
};

class HostDevice : public Device {
 public:
  explicit HostDevice(const DeviceOptions& options)
      : compiler_(find_host_compiler()), cache_(options.cache), name_(processor()) {
    if (compiler_.version.empty())
      throw Error(Fault::usage, "device kind host compiles its kernels at run time: \"" + compiler_.command.front() +
                                    "\" does not start; install g++ or clang, or name a compiler in CALX_CXX");
  }
  std::string kind() const override { return "host"; }
  std::string name() const override { return name_; }
  std::string driver() const override { return compiler_.version; }
  DeviceMemory memory() const override {
    const std::uint64_t page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return {page * static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)),
            page * static_cast<std::uint64_t>(sysconf(_SC_AVPHYS_PAGES))};
  }
  bool supports_double() const override { return true; }

 protected:
  std::unique_ptr<device_part::Memory> do_allocate(std::size_t bytes) override {
    // The system promises more than it has and ends the process later; so no more than the machine holds is asked for.
    const DeviceMemory all = memory();
    auto memory = std::make_unique<HostMemory>(bytes > all.total ? 0 : bytes);
    if (bytes > all.total || !memory->data) out_of_memory(name(), bytes, all, "the machine's memory");
    return memory;
  }
  void do_write(const device_part::Memory& to, const void* from, std::size_t bytes, std::size_t offset) override {
    std::memcpy(data(to) + offset, from, bytes);
  }
  std::unique_ptr<device_part::Pending> do_read(const device_part::Memory& from, void* to, std::size_t bytes,
                                                std::size_t offset) override {
    std::memcpy(to, data(from) + offset, bytes);
    return std::make_unique<Done>();
  }
  void do_zero(const device_part::Memory& buffer, std::size_t bytes, std::size_t offset) override {
    std::memset(data(buffer) + offset, 0, bytes);
  }
  void do_copy(const device_part::Memory& to, const device_part::Memory& from, std::size_t bytes, std::size_t to_offset,
               std::size_t from_offset) override {
    std::memcpy(data(to) + to_offset, data(from) + from_offset, bytes);
  }

  Built do_build(const ModuleText& text) override {
    const std::string source = compose(text);
    std::vector<std::string> parts = compiler_.command;
    parts.insert(parts.end(), {compiler_.version, name_, text.fast ? "fast" : "exact", source});
    const std::string key = DeviceCache::key(parts);
    Built built;
    std::optional<CompiledModule> compiled = cache_.load(key);
    built.from_cache = compiled.has_value();
    if (!compiled) {
      compiled = compile_on_host(compiler_, source, text.fast);
      if (compiled->image.empty()) build_failed(text, compiler_.version, compiled->log, cache_);
      cache_.store(key, *compiled);
    }
    auto module = std::make_shared<HostModule>();
    module->label = text.label;
    module->library = std::shared_ptr<void>(open_image(compiled->image), [](void* handle) { dlclose(handle); });
    built.module = module;
    built.log = compiled->log;
    return built;
  }

  void do_launch(const device_part::Kernel& kernel, std::size_t items, const DeviceArguments& given,
                 std::size_t) override {
    void* pointers[DeviceArguments::kMost];
    void* values[DeviceArguments::kMost];
    for (std::size_t k = 0; k < given.size(); ++k) {
      pointers[k] = given[k].memory ? data(*given[k].memory) : nullptr;
      values[k] = given[k].is_buffer ? static_cast<void*>(&pointers[k]) : const_cast<void*>(given.value(k));
    }
    static_cast<const HostKernel&>(kernel).run(items, values);
  }
  void do_finish() override {}

 private:
  HostCompiler compiler_;
  DeviceCache cache_;
  std::string name_;
};

}  // namespace

std::unique_ptr<Device> open_host(int ordinal, const DeviceOptions& options) {
  if (ordinal != 0)
    throw Error(Fault::usage, "there is no host device " + std::to_string(ordinal) + "; there is 0: " + processor());
  return std::make_unique<HostDevice>(options);
}

std::vector<DeviceListing> list_host(const DeviceOptions& options) {
  DeviceListing line;
  line.kind = "host";
  line.ordinal = 0;
  line.name = processor();
  try {
    const HostDevice device(options);
    line.driver = device.driver();
    line.memory = device.memory().total;
  } catch (const Error& error) {
    line.why_not = error.what();
  }
  return {line};
}

}  // namespace calx
