// cuda.cpp: a stand-in for the CUDA driver, as strict as the real one where the backend could go wrong: calls need a
// current context, work waits in its stream until someone waits for it, ranges are checked, captured work does not run.
// Environment: CALX_STAND_IN_DEVICES, CALX_STAND_IN_MEMORY (bytes of a device), CALX_STAND_IN_FAIL (a kernel whose
// launch fails), CALX_STAND_IN_FAIL_LATE (a kernel whose run fails).
#include <dlfcn.h>
#include <elf.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace {

enum Code {
  ok = 0,
  bad_value = 1,
  no_memory = 2,
  no_device = 100,
  bad_image = 200,
  no_context = 201,
  not_found = 500,
  not_ready = 600,
  bad_address = 700,
  launch_failed = 719,
  not_permitted = 800
};
using Work = std::function<int()>;
struct Module {
  void* library;
};
struct Function {
  std::string name;
  void (*run)(unsigned, unsigned, void**);
  const std::size_t* sizes;
};
struct Stream {
  std::vector<Work> queue;
  bool capturing = false;
  std::vector<Work> captured;
};
struct Event {
  Stream* stream = nullptr;
};
struct Graph {
  std::vector<Work> list;
};

std::recursive_mutex mutex;
std::map<unsigned long long, std::size_t> allocations;
std::set<Stream*> streams;
std::size_t used = 0;
int sticky = 0;
thread_local void* current = nullptr;

const char* variable(const char* name, const char* preset) {
  const char* value = std::getenv(name);
  return value ? value : preset;
}
std::size_t memory() { return std::strtoull(variable("CALX_STAND_IN_MEMORY", "4000000000"), nullptr, 10); }

int drain(Stream* stream) {
  std::vector<Work> work;
  work.swap(stream->queue);
  for (Work& each : work)
    if (sticky == 0) sticky = each();
  return sticky;
}
int drain_all() {
  for (Stream* stream : streams) drain(stream);
  return sticky;
}
int submit(Stream* stream, Work work) {
  (stream->capturing ? stream->captured : stream->queue).push_back(std::move(work));
  return sticky;
}
bool holds(unsigned long long at, std::size_t bytes) {
  auto next = allocations.upper_bound(at);
  if (next == allocations.begin()) return false;
  --next;
  return at + bytes <= next->first + next->second;
}
void* pointer(unsigned long long at) { return reinterpret_cast<void*>(at); }

}  // namespace

#define GUARD                                              \
  const std::lock_guard<std::recursive_mutex> lock(mutex); \
  if (!current) return no_context;
extern "C" {
int cuInit(unsigned) { return ok; }
int cuDriverGetVersion(int* version) { return *version = 12040, ok; }
int cuDeviceGetCount(int* count) { return *count = std::atoi(variable("CALX_STAND_IN_DEVICES", "2")), ok; }
int cuDeviceGet(int* device, int ordinal) { return *device = ordinal, ok; }
int cuDeviceGetName(char* name, int bytes, int device) {
  std::strncpy(name, ("Stand-in GPU " + std::to_string(device)).c_str(), static_cast<std::size_t>(bytes));
  return ok;
}
int cuDeviceGetAttribute(int* value, int attribute, int) { return *value = attribute == 75 ? 9 : 0, ok; }
int cuDeviceTotalMem_v2(std::size_t* bytes, int) { return *bytes = memory(), ok; }
int cuDevicePrimaryCtxRetain(void** context, int device) { return *context = pointer(1000u + unsigned(device)), ok; }
int cuDevicePrimaryCtxRelease_v2(int) { return ok; }
int cuCtxSetCurrent(void* context) { return current = context, ok; }
int cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
  GUARD* total = memory();
  *free = *total > used ? *total - used : 0;
  return ok;
}
int cuMemAlloc_v2(unsigned long long* at, std::size_t bytes) {
  GUARD if (bytes == 0) return bad_value;
  if (used + bytes > memory()) return no_memory;
  void* fresh = std::malloc(bytes);
  std::memset(fresh, 0xab, bytes);  // nobody may count on zero
  *at = reinterpret_cast<unsigned long long>(fresh);
  allocations[*at] = bytes;
  used += bytes;
  return ok;
}
int cuMemFree_v2(unsigned long long at) {
  GUARD drain_all();
  const auto found = allocations.find(at);
  if (found == allocations.end()) return bad_value;
  used -= found->second;
  std::free(pointer(at));
  allocations.erase(found);
  return ok;
}
int cuMemAllocHost_v2(void** at, std::size_t bytes) { return *at = std::malloc(bytes), ok; }
int cuMemFreeHost(void* at) { return std::free(at), ok; }
int cuMemcpyHtoDAsync_v2(unsigned long long to, const void* from, std::size_t bytes, Stream* stream) {
  GUARD if (!holds(to, bytes)) return bad_value;
  const std::string copy(static_cast<const char*>(from), bytes);
  return submit(stream, [=] { return std::memcpy(pointer(to), copy.data(), bytes), ok; });
}
int cuMemcpyDtoHAsync_v2(void* to, unsigned long long from, std::size_t bytes, Stream* stream) {
  GUARD if (!holds(from, bytes)) return bad_value;
  return submit(stream, [=] { return std::memcpy(to, pointer(from), bytes), ok; });
}
int cuMemcpyDtoDAsync_v2(unsigned long long to, unsigned long long from, std::size_t bytes, Stream* stream) {
  GUARD if (!holds(to, bytes) || !holds(from, bytes)) return bad_value;
  return submit(stream, [=] { return std::memcpy(pointer(to), pointer(from), bytes), ok; });
}
int cuMemsetD8Async(unsigned long long at, unsigned char value, std::size_t bytes, Stream* stream) {
  GUARD if (!holds(at, bytes)) return bad_value;
  return submit(stream, [=] { return std::memset(pointer(at), value, bytes), ok; });
}
int cuModuleLoadData(Module** module, const void* image) {
  GUARD Elf64_Ehdr head;
  std::memcpy(&head, image, sizeof head);
  if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) return bad_image;
  const std::size_t bytes = head.e_shoff + std::size_t(head.e_shnum) * head.e_shentsize;
  char path[] = "/tmp/calx-cubin-XXXXXX";
  const int file = mkstemp(path);
  const bool written = write(file, image, bytes) == static_cast<ssize_t>(bytes);
  close(file);
  void* library = written ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : nullptr;
  unlink(path);
  if (!library) return bad_image;
  *module = new Module{library};
  return ok;
}
int cuModuleUnload(Module* module) {
  GUARD drain_all();
  dlclose(module->library);
  delete module;
  return ok;
}
int cuModuleGetFunction(Function** function, Module* module, const char* name) {
  GUARD static std::map<std::pair<void*, std::string>, Function> all;
  void* run = dlsym(module->library, ("calx_run_" + std::string(name)).c_str());
  void* sizes = dlsym(module->library, ("calx_sizes_" + std::string(name)).c_str());
  if (!run || !sizes) return not_found;
  Function& found = all[{run, name}];
  found = {name, reinterpret_cast<decltype(found.run)>(run), reinterpret_cast<const std::size_t* (*)()>(sizes)()};
  *function = &found;
  return ok;
}
int cuFuncGetAttribute(int* value, int attribute, Function*) { return *value = attribute == 0 ? 1024 : 0, ok; }
int cuFuncGetParamInfo(Function* function, std::size_t index, std::size_t* offset, std::size_t* bytes) {
  for (std::size_t k = 0; k <= index; ++k)
    if (function->sizes[k] == 0) return bad_value;
  *offset = 0;
  *bytes = function->sizes[index];
  return ok;
}
int cuLaunchKernel(Function* function, unsigned grid, unsigned, unsigned, unsigned block, unsigned, unsigned, unsigned,
                   Stream* stream, void** values, void**) {
  GUARD if (grid == 0 || block == 0 || block > 1024) return bad_value;
  if (function->name == variable("CALX_STAND_IN_FAIL", "")) return launch_failed;
  const bool fails = function->name == variable("CALX_STAND_IN_FAIL_LATE", "");
  std::vector<std::string> copies;
  for (std::size_t k = 0; function->sizes[k]; ++k)
    copies.emplace_back(static_cast<const char*>(values[k]), function->sizes[k]);
  return submit(stream, [=]() mutable {
    if (fails) return int(bad_address);
    std::vector<void*> list;
    for (std::string& copy : copies) list.push_back(&copy[0]);
    function->run(grid, block, list.data());
    return int(ok);
  });
}
int cuStreamCreate(Stream** stream, unsigned) {
  GUARD streams.insert(*stream = new Stream);
  return ok;
}
int cuStreamDestroy_v2(Stream* stream) {
  GUARD drain(stream);
  streams.erase(stream);
  delete stream;
  return ok;
}
int cuStreamSynchronize(Stream* stream) { GUARD return stream->capturing ? int(not_permitted) : drain(stream); }
int cuStreamBeginCapture_v2(Stream* stream, int) {
  GUARD stream->capturing = true;
  return ok;
}
int cuStreamEndCapture(Stream* stream, Graph** graph) {
  GUARD stream->capturing = false;
  *graph = new Graph;
  (*graph)->list.swap(stream->captured);
  return ok;
}
int cuGraphInstantiateWithFlags(Graph** executable, Graph* graph, unsigned long long) {
  return *executable = new Graph(*graph), ok;
}
int cuGraphLaunch(Graph* executable, Stream* stream) {
  GUARD for (const Work& each : executable->list) submit(stream, each);
  return sticky;
}
int cuGraphExecDestroy(Graph* executable) { return delete executable, ok; }
int cuGraphDestroy(Graph* graph) { return delete graph, ok; }
int cuEventCreate(Event** event, unsigned) { return *event = new Event, ok; }
int cuEventRecord(Event* event, Stream* stream) {
  GUARD event->stream = stream;
  return ok;
}
int cuEventQuery(Event* event) {
  GUARD if (event->stream->queue.empty()) return sticky;
  drain(event->stream);
  return not_ready;
}
int cuEventSynchronize(Event* event) { GUARD return drain(event->stream); }
int cuEventDestroy_v2(Event* event) { return delete event, ok; }
int cuGetErrorName(int code, const char** text) {
  static const std::map<int, const char*> names = {{bad_value, "CUDA_ERROR_INVALID_VALUE"},
                                                   {no_memory, "CUDA_ERROR_OUT_OF_MEMORY"},
                                                   {bad_image, "CUDA_ERROR_INVALID_IMAGE"},
                                                   {bad_address, "CUDA_ERROR_ILLEGAL_ADDRESS"},
                                                   {launch_failed, "CUDA_ERROR_LAUNCH_FAILED"}};
  const auto found = names.find(code);
  return *text = found == names.end() ? "CUDA_ERROR" : found->second, ok;
}
int cuGetErrorString(int, const char** text) { return *text = "stand-in", ok; }
}
