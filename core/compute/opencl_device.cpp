// opencl_device.cpp: OpenCL 1.2. Drivers of OpenCL keep compiled kernels themselves; our cache holds logs only.
#include <map>

#include "base/error.hpp"
#include "compute/device_backends.hpp"
#include "compute/device_cache.hpp"
#include "compute/device_failure.hpp"
#include "compute/opencl_api.hpp"
#include "compute/opencl_devices.hpp"

namespace calx {
namespace {

/// A context and its queue; memory, kernels and reads hold it.
struct Core {
  const OpenCl& api;
  OpenClDevice at;
  std::string name;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  std::string last_kernel;  // what a late error may come from

  Core(const OpenCl& cl, const OpenClDevice& device) : api(cl), at(device), name(device.name) {
    cl_int code = 0;
    context = api.clCreateContext(nullptr, 1, &at.id, nullptr, nullptr, &code);
    check(code, "a context");
    queue = api.clCreateCommandQueue(context, at.id, 0, &code);
    check(code, "a queue");
  }
  ~Core() {
    if (queue) api.clReleaseCommandQueue(queue);
    if (context) api.clReleaseContext(context);
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  void check(cl_int code, const char* what) const {
    if (code == 0) return;
    if (is_memory(code)) out_of_memory(name, 0, {at.memory, 0}, opencl_error(code));
    throw Error(Fault::numerics, name + ": " + what + " failed: " + opencl_error(code) +
                                     (last_kernel.empty() ? "" : "; the last kernel started was " + last_kernel));
  }
  static bool is_memory(cl_int code) {
    return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_HOST_MEMORY || code == CL_INVALID_BUFFER_SIZE;
  }
};
using CorePtr = std::shared_ptr<Core>;

struct ClMemory : device_part::Memory {
  ClMemory(CorePtr c, cl_mem m) : core(std::move(c)), memory(m) {}
  ~ClMemory() override { core->api.clReleaseMemObject(memory); }
  CorePtr core;
  cl_mem memory;
};

cl_mem handle(const device_part::Memory& memory) { return static_cast<const ClMemory&>(memory).memory; }

struct Program {
  Program(CorePtr c, cl_program p) : core(std::move(c)), program(p) {}
  ~Program() { core->api.clReleaseProgram(program); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  CorePtr core;
  cl_program program;
};

struct ClKernel : device_part::Kernel {
  ~ClKernel() override {
    if (kernel) program->core->api.clReleaseKernel(kernel);
  }
  std::shared_ptr<Program> program;
  cl_kernel kernel = nullptr;
  std::size_t most = 1;  // items in a group
};

/// Drivers differ in whether they check the size of an argument; names of numbers tell it. 0 for a struct.
std::uint32_t bytes_of(const std::string& type) {
  for (const char* four : {"u32", "i32", "uint", "int", "float", "unsigned int"})
    if (type == four) return 4;
  for (const char* eight : {"u64", "i64", "ulong", "long", "double", "unsigned long"})
    if (type == eight) return 8;
  return 0;
}

struct ClModule : device_part::Module {
  std::shared_ptr<Program> program;
  std::string label;
  std::map<std::string, std::shared_ptr<const device_part::Kernel>> kernels;

  std::shared_ptr<const device_part::Kernel> find(const std::string& name) override {
    auto& known = kernels[name];
    if (known) return known;
    const Core& core = *program->core;
    cl_int code = 0;
    auto kernel = std::make_shared<ClKernel>();
    kernel->program = program;
    kernel->kernel = core.api.clCreateKernel(program->program, name.c_str(), &code);
    if (!kernel->kernel || code != 0) return nullptr;
    kernel->name = name;
    kernel->module = label;
    cl_uint count = 0;
    core.check(core.api.clGetKernelInfo(kernel->kernel, CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr), "a query");
    core.check(core.api.clGetKernelWorkGroupInfo(kernel->kernel, core.at.id, CL_KERNEL_WORK_GROUP_SIZE,
                                                 sizeof kernel->most, &kernel->most, nullptr),
               "a query");
    for (cl_uint k = 0; k < count; ++k) {
      device_part::Parameter parameter;
      cl_uint where = 0;
      if (core.api.clGetKernelArgInfo(kernel->kernel, k, CL_KERNEL_ARG_ADDRESS_QUALIFIER, sizeof where, &where,
                                      nullptr) == 0)
        parameter.kind =
            where == CL_KERNEL_ARG_ADDRESS_GLOBAL ? device_part::Parameter::buffer : device_part::Parameter::value;
      char type[128] = "";
      if (core.api.clGetKernelArgInfo(kernel->kernel, k, CL_KERNEL_ARG_TYPE_NAME, sizeof type, type, nullptr) == 0 &&
          parameter.kind == device_part::Parameter::value)
        parameter.bytes = bytes_of(type);
      kernel->parameters.push_back(parameter);
    }
    return known = kernel;
  }
};

struct ClRead : device_part::Pending {
  ClRead(CorePtr c, cl_event e) : core(std::move(c)), event(e) {}
  ~ClRead() override { core->api.clReleaseEvent(event); }
  bool ready() override {
    cl_int status = 0;
    core->check(core->api.clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr),
                "a read");
    return status <= 0;
  }
  void wait() override { core->check(core->api.clWaitForEvents(1, &event), "a read"); }
  CorePtr core;
  cl_event event;
};

class OpenClBackend : public Device {
 public:
  OpenClBackend(const OpenCl& cl, const OpenClDevice& device, const DeviceOptions& options)
      : core_(std::make_shared<Core>(cl, device)), cache_(options.cache), sync_(sync_each_launch(options)) {}
  ~OpenClBackend() override { core_->api.clFinish(core_->queue); }

  std::string kind() const override { return "opencl"; }
  std::string name() const override { return core_->name; }
  std::string driver() const override { return core_->at.driver; }
  DeviceMemory memory() const override { return {core_->at.memory, 0}; }
  bool supports_double() const override { return core_->at.has_double; }
  std::string inexact_reason() const override { return core_->at.inexact; }

 protected:
  std::unique_ptr<device_part::Memory> do_allocate(std::size_t bytes) override {
    cl_int code = 0;
    if (bytes > core_->at.largest)
      out_of_memory(name(), bytes, memory(), "one allocation holds at most " + bytes_text(double(core_->at.largest)));
    cl_mem memory_object = core_->api.clCreateBuffer(core_->context, CL_MEM_READ_WRITE, bytes, nullptr, &code);
    // A driver may promise memory and look for it later; zeroing makes it look now.
    std::unique_ptr<ClMemory> made;
    if (code == 0) {
      made = std::make_unique<ClMemory>(core_, memory_object);
      code = fill(*made, bytes, 0);
    }
    if (Core::is_memory(code)) out_of_memory(name(), bytes, memory(), opencl_error(code));
    core_->check(code, "an allocation");
    return made;
  }
  void do_write(const device_part::Memory& to, const void* data, std::size_t bytes, std::size_t offset) override {
    core_->check(core_->api.clEnqueueWriteBuffer(core_->queue, handle(to), 1, offset, bytes, data, 0, nullptr, nullptr),
                 "a write");
  }
  std::unique_ptr<device_part::Pending> do_read(const device_part::Memory& from, void* data, std::size_t bytes,
                                                std::size_t offset) override {
    cl_event event = nullptr;
    core_->check(core_->api.clEnqueueReadBuffer(core_->queue, handle(from), 0, offset, bytes, data, 0, nullptr, &event),
                 "a read");
    auto pending = std::make_unique<ClRead>(core_, event);
    core_->check(core_->api.clFlush(core_->queue), "a read");
    return pending;
  }
  void do_zero(const device_part::Memory& buffer, std::size_t bytes, std::size_t offset) override {
    core_->check(fill(buffer, bytes, offset), "zeroing");
  }
  void do_copy(const device_part::Memory& to, const device_part::Memory& from, std::size_t bytes, std::size_t to_offset,
               std::size_t from_offset) override {
    core_->check(core_->api.clEnqueueCopyBuffer(core_->queue, handle(from), handle(to), from_offset, to_offset, bytes,
                                                0, nullptr, nullptr),
                 "a copy");
  }

  Built do_build(const ModuleText& text) override {
    const std::string source = compose(text);
    const char* start = source.c_str();
    cl_int code = 0;
    auto module = std::make_shared<ClModule>();
    module->label = text.label;
    cl_program program = core_->api.clCreateProgramWithSource(core_->context, 1, &start, nullptr, &code);
    core_->check(code, "a program");
    module->program = std::make_shared<Program>(core_, program);
    std::string flags = "-cl-std=CL1.2 -cl-kernel-arg-info";
    if (!text.fast && core_->at.rounds_divide) flags += " -cl-fp32-correctly-rounded-divide-sqrt";
    if (text.fast) flags += " -cl-mad-enable";
    code = core_->api.clBuildProgram(program, 1, &core_->at.id, flags.c_str(), nullptr, nullptr);
    Built built;
    std::size_t bytes = 0;
    if (core_->api.clGetProgramBuildInfo(program, core_->at.id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &bytes) == 0) {
      built.log.resize(bytes);
      core_->api.clGetProgramBuildInfo(program, core_->at.id, CL_PROGRAM_BUILD_LOG, bytes, &built.log[0], nullptr);
      while (!built.log.empty() && built.log.back() == '\0') built.log.pop_back();
    }
    if (code != 0) build_failed(text, name(), built.log.empty() ? opencl_error(code) : built.log, cache_);
    built.module = module;
    return built;
  }

  void do_launch(const device_part::Kernel& kernel, std::size_t items, const DeviceArguments& given,
                 std::size_t group) override {
    const ClKernel& cl = static_cast<const ClKernel&>(kernel);
    for (std::size_t k = 0; k < given.size(); ++k) {
      const cl_mem memory = given[k].memory ? handle(*given[k].memory) : nullptr;
      const cl_int code = given[k].is_buffer
                              ? core_->api.clSetKernelArg(cl.kernel, cl_uint(k), sizeof memory, &memory)
                              : core_->api.clSetKernelArg(cl.kernel, cl_uint(k), given[k].bytes, given.value(k));
      if (code != 0)
        launch_failed(name(), kernel, items,
                      "argument " + std::to_string(k + 1) + " of " + std::to_string(given[k].bytes) +
                          " bytes: " + opencl_error(code));
    }
    constexpr std::size_t kGroup = 128;
    const std::size_t local = group ? group : (cl.most < kGroup ? cl.most : kGroup);
    const std::size_t global = (items + local - 1) / local * local;
    core_->last_kernel = kernel.name;
    cl_int code =
        core_->api.clEnqueueNDRangeKernel(core_->queue, cl.kernel, 1, nullptr, &global, &local, 0, nullptr, nullptr);
    if (code == 0 && sync_) code = core_->api.clFinish(core_->queue);
    if (code == CL_MEM_OBJECT_ALLOCATION_FAILURE) out_of_memory(name(), 0, memory(), opencl_error(code));
    if (code != 0)
      launch_failed(name(), kernel, items, opencl_error(code) + " with groups of " + std::to_string(local));
  }
  void do_finish() override { core_->check(core_->api.clFinish(core_->queue), "waiting"); }

 private:
  cl_int fill(const device_part::Memory& buffer, std::size_t bytes, std::size_t offset) {
    // The pattern is as wide as offset and size allow; both are multiples of it, as the call wants.
    const cl_ulong zero[2] = {0, 0};
    std::size_t width = 16;
    while ((bytes | offset) % width != 0) width /= 2;
    return core_->api.clEnqueueFillBuffer(core_->queue, handle(buffer), zero, width, offset, bytes, 0, nullptr,
                                          nullptr);
  }

  CorePtr core_;
  DeviceCache cache_;
  bool sync_;
};

}  // namespace

std::unique_ptr<Device> open_opencl(int ordinal, const DeviceOptions& options) {
  const OpenCl& api = opencl();
  return std::make_unique<OpenClBackend>(api, opencl_device(api, ordinal), options);
}

std::vector<DeviceListing> list_opencl(const DeviceOptions&) {
  std::vector<DeviceListing> lines;
  try {
    const OpenCl& api = opencl();
    for (const OpenClDevice& device : opencl_devices(api)) {
      DeviceListing line;
      line.kind = "opencl";
      line.ordinal = static_cast<int>(lines.size());
      line.name = device.name;
      line.driver = device.driver;
      line.memory = device.memory;
      line.inexact = device.inexact;
      lines.push_back(line);
    }
  } catch (const Error& error) {
    DeviceListing line;
    line.kind = "opencl";
    line.why_not = error.what();
    lines.push_back(line);
  }
  return lines;
}

}  // namespace calx
