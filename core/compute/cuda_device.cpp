// cuda_device.cpp: the CUDA driver interface. Everything runs on one stream of its own per device; every call first
// makes the device's context current, so that any thread may use it.
#include <cstring>
#include <map>
#include <mutex>

#include "base/error.hpp"
#include "compute/cuda_api.hpp"
#include "compute/cuda_compile.hpp"
#include "compute/cuda_devices.hpp"
#include "compute/device_backends.hpp"
#include "compute/device_cache.hpp"
#include "compute/device_failure.hpp"

namespace calx {
namespace {

/// Context and stream, and pinned memory for reads that are not waited for.
struct Core {
  const CudaDriver& api;
  CudaDeviceFacts facts;
  CUcontext context = nullptr;
  CUstream stream = nullptr;
  std::string last_kernel;
  std::mutex mutex;
  std::vector<std::pair<std::size_t, void*>> pinned;  // free pieces

  Core(const CudaDriver& driver, const CudaDeviceFacts& device) : api(driver), facts(device) {
    check(api.cuDevicePrimaryCtxRetain(&context, facts.id), "opening it");
    enter();
    check(api.cuStreamCreate(&stream, CU_STREAM_NON_BLOCKING), "a stream");
  }
  ~Core() {
    api.cuCtxSetCurrent(context);
    for (const auto& piece : pinned) api.cuMemFreeHost(piece.second);
    if (stream) api.cuStreamDestroy_v2(stream);
    api.cuDevicePrimaryCtxRelease_v2(facts.id);
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  void enter() const { check(api.cuCtxSetCurrent(context), "its context"); }
  void check(CUresult code, const char* what) const {
    if (code == 0) return;
    if (code == CUDA_ERROR_OUT_OF_MEMORY) out_of_memory(facts.name, 0, memory(), api.error(code));
    throw Error(Fault::numerics, facts.name + ": " + what + " failed: " + api.error(code) +
                                     (last_kernel.empty() ? ""
                                                          : "; the last kernel started was " + last_kernel +
                                                                " (CALX_DEVICE_SYNC=1 names the one at fault)"));
  }
  DeviceMemory memory() const {
    std::size_t free = 0, total = 0;
    if (api.cuCtxSetCurrent(context) != 0 || api.cuMemGetInfo_v2(&free, &total) != 0) return {facts.memory, 0};
    return {total, free};
  }
  std::pair<std::size_t, void*> take(std::size_t bytes) {
    const std::lock_guard<std::mutex> lock(mutex);
    for (auto piece = pinned.begin(); piece != pinned.end(); ++piece)
      if (piece->first >= bytes) {
        const auto taken = *piece;
        pinned.erase(piece);
        return taken;
      }
    void* fresh = nullptr;
    check(api.cuMemAllocHost_v2(&fresh, bytes), "pinned memory");
    return {bytes, fresh};
  }
  void give_back(std::pair<std::size_t, void*> piece) {
    const std::lock_guard<std::mutex> lock(mutex);
    pinned.push_back(piece);
  }
};
using CorePtr = std::shared_ptr<Core>;

struct CuMemory : device_part::Memory {
  CuMemory(CorePtr c, CUdeviceptr a) : core(std::move(c)), address(a) {}
  ~CuMemory() override {
    core->api.cuCtxSetCurrent(core->context);
    core->api.cuMemFree_v2(address);
  }
  CorePtr core;
  CUdeviceptr address;
};

CUdeviceptr address(const device_part::Memory& memory) { return static_cast<const CuMemory&>(memory).address; }

struct Loaded {
  Loaded(CorePtr c, CUmodule m) : core(std::move(c)), module(m) {}
  ~Loaded() {
    core->api.cuCtxSetCurrent(core->context);
    core->api.cuModuleUnload(module);
  }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;
  CorePtr core;
  CUmodule module;
};

struct CuKernel : device_part::Kernel {
  std::shared_ptr<Loaded> loaded;
  CUfunction function = nullptr;
  int most = 1024;  // items in a group
};

struct CuModule : device_part::Module {
  std::shared_ptr<Loaded> loaded;
  std::string label;
  std::map<std::string, std::shared_ptr<const device_part::Kernel>> kernels;

  std::shared_ptr<const device_part::Kernel> find(const std::string& name) override {
    auto& known = kernels[name];
    if (known) return known;
    const Core& core = *loaded->core;
    core.enter();
    auto kernel = std::make_shared<CuKernel>();
    const CUresult code = core.api.cuModuleGetFunction(&kernel->function, loaded->module, name.c_str());
    if (code == CUDA_ERROR_NOT_FOUND) return nullptr;
    core.check(code, "looking for a kernel");
    kernel->name = name;
    kernel->module = label;
    kernel->loaded = loaded;
    core.api.cuFuncGetAttribute(&kernel->most, CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK, kernel->function);
    std::size_t offset = 0, bytes = 0;
    if (core.api.cuFuncGetParamInfo)
      for (std::size_t k = 0; core.api.cuFuncGetParamInfo(kernel->function, k, &offset, &bytes) == 0; ++k)
        kernel->parameters.push_back({static_cast<std::uint32_t>(bytes), device_part::Parameter::unknown});
    return known = kernel;
  }
};

/// Small reads go through pinned memory, so that they wait for nothing; large ones would pin too much.
constexpr std::size_t kMostPinned = std::size_t(1) << 20;

struct CuRead : device_part::Pending {
  CuRead(CorePtr c, void* to, std::size_t n) : core(std::move(c)), target(to), bytes(n) {
    if (n <= kMostPinned) piece = core->take(n);
  }
  ~CuRead() override {
    core->api.cuCtxSetCurrent(core->context);
    if (event) core->api.cuEventDestroy_v2(event);
    if (piece.second) core->give_back(piece);
  }
  bool ready() override {
    core->enter();
    const CUresult code = core->api.cuEventQuery(event);
    if (code == CUDA_ERROR_NOT_READY) return false;
    core->check(code, "a read");
    return true;
  }
  void wait() override {
    core->enter();
    core->check(core->api.cuEventSynchronize(event), "a read");
    if (piece.second) std::memcpy(target, piece.second, bytes);
  }
  CorePtr core;
  void* target;
  std::size_t bytes;
  std::pair<std::size_t, void*> piece{0, nullptr};
  CUevent event = nullptr;
};

struct CuGraph : device_part::Graph {
  explicit CuGraph(CorePtr c) : core(std::move(c)) {}
  ~CuGraph() override {
    core->api.cuCtxSetCurrent(core->context);
    if (executable) core->api.cuGraphExecDestroy(executable);
    if (graph) core->api.cuGraphDestroy(graph);
  }
  CorePtr core;
  CUgraph graph = nullptr;
  CUgraphExec executable = nullptr;
};

class CudaBackend : public Device {
 public:
  CudaBackend(const CudaDriver& api, const CudaDeviceFacts& facts, const DeviceOptions& options)
      : core_(std::make_shared<Core>(api, facts)), cache_(options.cache), sync_(sync_each_launch(options)) {}
  ~CudaBackend() override {
    core_->api.cuCtxSetCurrent(core_->context);
    core_->api.cuStreamSynchronize(core_->stream);
  }

  std::string kind() const override { return "cuda"; }
  std::string name() const override { return core_->facts.name; }
  std::string driver() const override {
    const Nvrtc& compiler = nvrtc();
    return driver_text(core_->api) + ", NVRTC " + std::to_string(compiler.major) + "." +
           std::to_string(compiler.minor) + ", " + architecture();
  }
  DeviceMemory memory() const override { return core_->memory(); }
  bool supports_double() const override { return true; }

 protected:
  std::unique_ptr<device_part::Memory> do_allocate(std::size_t bytes) override {
    core_->enter();
    CUdeviceptr at = 0;
    const CUresult code = core_->api.cuMemAlloc_v2(&at, bytes);
    if (code == CUDA_ERROR_OUT_OF_MEMORY) out_of_memory(name(), bytes, memory(), core_->api.error(code));
    core_->check(code, "an allocation");
    auto made = std::make_unique<CuMemory>(core_, at);
    core_->check(core_->api.cuMemsetD8Async(at, 0, bytes, core_->stream), "an allocation");
    return made;
  }
  void do_write(const device_part::Memory& to, const void* data, std::size_t bytes, std::size_t offset) override {
    core_->enter();
    core_->check(core_->api.cuMemcpyHtoDAsync_v2(address(to) + offset, data, bytes, core_->stream), "a write");
    core_->check(core_->api.cuStreamSynchronize(core_->stream), "a write");
  }
  std::unique_ptr<device_part::Pending> do_read(const device_part::Memory& from, void* data, std::size_t bytes,
                                                std::size_t offset) override {
    core_->enter();
    auto pending = std::make_unique<CuRead>(core_, data, bytes);
    core_->check(core_->api.cuEventCreate(&pending->event, CU_EVENT_DISABLE_TIMING), "a read");
    core_->check(core_->api.cuMemcpyDtoHAsync_v2(pending->piece.second ? pending->piece.second : data,
                                                 address(from) + offset, bytes, core_->stream),
                 "a read");
    core_->check(core_->api.cuEventRecord(pending->event, core_->stream), "a read");
    return pending;
  }
  void do_zero(const device_part::Memory& buffer, std::size_t bytes, std::size_t offset) override {
    core_->enter();
    core_->check(core_->api.cuMemsetD8Async(address(buffer) + offset, 0, bytes, core_->stream), "zeroing");
  }
  void do_copy(const device_part::Memory& to, const device_part::Memory& from, std::size_t bytes, std::size_t to_offset,
               std::size_t from_offset) override {
    core_->enter();
    core_->check(
        core_->api.cuMemcpyDtoDAsync_v2(address(to) + to_offset, address(from) + from_offset, bytes, core_->stream),
        "a copy");
  }

  Built do_build(const ModuleText& text) override {
    core_->enter();
    CudaBinary binary = compile_cuda(text, architecture(), name() + driver_text(core_->api), cache_);
    CUmodule handle = nullptr;
    core_->check(core_->api.cuModuleLoadData(&handle, binary.image.data()), "loading a module");
    auto module = std::make_shared<CuModule>();
    module->label = text.label;
    module->loaded = std::make_shared<Loaded>(core_, handle);
    return {module, std::move(binary.log), std::move(binary.resources), binary.from_cache};
  }

  void do_launch(const device_part::Kernel& kernel, std::size_t items, const DeviceArguments& given,
                 std::size_t group) override {
    core_->enter();
    const CuKernel& cu = static_cast<const CuKernel&>(kernel);
    CUdeviceptr addresses[DeviceArguments::kMost];
    void* values[DeviceArguments::kMost];
    for (std::size_t k = 0; k < given.size(); ++k) {
      addresses[k] = given[k].memory ? address(*given[k].memory) : 0;
      values[k] = given[k].is_buffer ? static_cast<void*>(&addresses[k]) : const_cast<void*>(given.value(k));
    }
    constexpr std::size_t kGroup = 128;
    const std::size_t most = static_cast<std::size_t>(cu.most);
    const unsigned local = static_cast<unsigned>(group ? group : (most < kGroup ? most : kGroup));
    const unsigned groups = static_cast<unsigned>((items + local - 1) / local);
    core_->last_kernel = kernel.name;
    CUresult code =
        core_->api.cuLaunchKernel(cu.function, groups, 1, 1, local, 1, 1, 0, core_->stream, values, nullptr);
    if (code == 0 && sync_ && !recording_) code = core_->api.cuStreamSynchronize(core_->stream);
    if (code != 0)
      launch_failed(name(), kernel, items, core_->api.error(code) + " with groups of " + std::to_string(local));
  }
  void do_finish() override {
    core_->enter();
    core_->check(core_->api.cuStreamSynchronize(core_->stream), "waiting");
  }

  bool records_itself() const override { return true; }
  void do_begin_capture() override {
    core_->enter();
    core_->check(core_->api.cuStreamBeginCapture_v2(core_->stream, CU_STREAM_CAPTURE_MODE_RELAXED), "a recording");
    recording_ = true;
  }
  std::shared_ptr<device_part::Graph> do_end_capture() override {
    core_->enter();
    recording_ = false;
    auto graph = std::make_shared<CuGraph>(core_);
    core_->check(core_->api.cuStreamEndCapture(core_->stream, &graph->graph), "a recording");
    core_->check(core_->api.cuGraphInstantiateWithFlags(&graph->executable, graph->graph, 0), "a graph");
    return graph;
  }
  void do_launch_graph(const device_part::Graph& graph) override {
    core_->enter();
    core_->check(core_->api.cuGraphLaunch(static_cast<const CuGraph&>(graph).executable, core_->stream), "a graph");
  }

 private:
  std::string architecture() const {
    return "sm_" + std::to_string(core_->facts.major) + std::to_string(core_->facts.minor);
  }

  CorePtr core_;
  DeviceCache cache_;
  bool sync_, recording_ = false;
};

}  // namespace

std::unique_ptr<Device> open_cuda(int ordinal, const DeviceOptions& options) {
  const CudaDriver& api = cuda_driver();
  nvrtc();  // says now that it is missing
  return std::make_unique<CudaBackend>(api, cuda_device(api, ordinal), options);
}

}  // namespace calx
