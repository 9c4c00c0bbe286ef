// What a user reads when a device, its compiler, its memory or its cache fails.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <thread>

#include "base/log.hpp"
#include "compute/cuda_compile.hpp"
#include "compute/device_cache.hpp"
#include "compute/devices.hpp"

using namespace calx;
using testing::error_of;
using testing::has;

namespace {

/// An environment variable for the length of a scope.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* before = std::getenv(name);
    had_ = before;
    before_ = before ? before : "";
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
  bool had_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

ModuleText text_of(const std::string& kernel, const std::string& name = "wrong.law.h") {
  ModuleText text;
  text.label = "contact kernels, sand-steel";
  text.add("good.h", "KERNEL(good, GLOBAL u32* x, const u32 n) {\n  if (ITEM >= n) return;\n  x[ITEM] = ITEM;\n}\n");
  text.add(name, kernel);
  return text;
}

const std::string kBad = "/* one */\n/* two */\nFN u32 broken(u32 x) { return x + surface_energi; }\n";

/// Runs f with a log file and gives the lines.
template <class F>
std::string log_of(F&& f) {
  const std::string path = CALX_TEST_CACHE "/errors.log";
  LogSettings settings;
  settings.file = path;
  open_log(settings);
  f();
  close_log();
  return content(path);
}

}  // namespace

TEST_CASE("a kind or an ordinal that is not there") {
  testing::use_stand_in();
  CHECK(has(error_of([] { open_device("vulkan"); }), "no device kind \"vulkan\"; there are host, opencl and cuda"));
  CHECK(has(error_of([] { open_device("host", 1); }), "no host device 1; there is 0: "));
  CHECK(has(error_of([] { open_device("cuda", 7); }),
            "no CUDA device 7; there are 0: Stand-in GPU 0 (4 GB), 1: Stand-in GPU 1 (4 GB)"));
  if (testing::open("opencl")) {
    const std::string text = error_of([] { open_device("opencl", 99); });
    CHECK(has(text, "no OpenCL device 99; there are 0: "));
  }
}

TEST_CASE("no library, no compiler, no device") {
  {
    const Variable none("CALX_LIBOPENCL", "/nowhere/libOpenCL.so");
    const std::string text = error_of([] { open_device("opencl"); });
    CHECK(has(text, "needs the OpenCL loader, which does not open (/nowhere/libOpenCL.so: "));
    CHECK(has(text, "pocl-opencl-icd"));
  }
  {
    const Variable wrong("CALX_LIBOPENCL", CALX_STAND_IN_CUDA);
    CHECK(has(error_of([] { open_device("opencl"); }), "has no function clGetPlatformIDs; OpenCL 1.2"));
  }
  {
    const Variable none("CALX_LIBCUDA", "/nowhere/libcuda.so");
    const std::string text = error_of([] { open_device("cuda"); });
    CHECK(has(text, "needs an NVIDIA driver, whose library does not open (/nowhere/libcuda.so: "));
  }
  testing::use_stand_in();
  {
    const Variable none("CALX_LIBNVRTC", "/nowhere/libnvrtc.so");
    CHECK(
        has(error_of([] { open_device("cuda"); }), "compiles its kernels with NVRTC, which does not open (/nowhere/"));
    bool said = false;
    for (const DeviceListing& line : list_devices(testing::options()))
      said = said || (line.kind == "cuda" && line.ordinal == 1 && has(line.why_not, "NVRTC"));
    CHECK(said);
  }
  {
    const Variable none("CALX_STAND_IN_DEVICES", "0");
    CHECK(has(error_of([] { open_device("cuda"); }), "finds no device; CUDA_VISIBLE_DEVICES may hide them"));
  }
  {
    const Variable none("CALX_CXX", "no-such-compiler -g");
    CHECK(has(error_of([] { open_device("host"); }), "\"no-such-compiler\" does not start; install g++ or clang"));
  }
}

TEST_CASE("every device is listed, or why there is none") {
  testing::use_stand_in();
  const Variable none("CALX_LIBOPENCL", "/nowhere/libOpenCL.so");
  const std::vector<DeviceListing> all = list_devices(testing::options());
  REQUIRE(all.size() == 4);
  CHECK(all[0].kind == "host");
  CHECK(all[0].why_not == "");
  CHECK(!all[0].driver.empty());
  CHECK(all[1].kind == "opencl");
  CHECK(all[1].ordinal == -1);
  CHECK(has(all[1].why_not, "OpenCL loader"));
  CHECK(all[2].name == "Stand-in GPU 0");
  CHECK(all[3].ordinal == 1);
  CHECK(all[3].memory == 4000000000u);
  CHECK(all[3].driver == "CUDA driver 12.4");
}

TEST_CASE("a text that does not compile names part and line, and the log is kept") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const std::string text = error_of([&] { device->build(text_of(kBad)); });
    CAPTURE(text);
    CHECK(has(text, "module \"contact kernels, sand-steel\" does not compile for "));
    CHECK(has(text, "the error is in wrong.law.h"));
    CHECK(has(text, "wrong.law.h:3:"));
    CHECK(has(text, "surface_energi"));
    std::smatch path;
    REQUIRE(std::regex_search(text, path, std::regex("the whole log: (\\S+)")));
    CHECK(has(content(path[1]), "surface_energi"));
  }
}

TEST_CASE("a kernel that a module lacks, and arguments that do not fit") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    ModuleText text = text_of("");
    const DeviceModule module = device->build(text);
    CHECK(has(error_of([&] { module.kernel("gather"); }), "module \"contact kernels, sand-steel\" for "));
    CHECK(has(error_of([&] { module.kernel("gather"); }), "has no kernel gather; its text must define KERNEL(gather"));
    const DeviceKernel good = module.kernel("good");
    const DeviceBuffer x = device->allocate(400);
    CHECK(has(error_of([&] { device->launch(good, 100, arguments(x)); }), "kernel good"));
    CHECK(has(error_of([&] { device->launch(good, 100, arguments(x)); }), "takes 2 arguments; 1 are given"));
    CHECK(has(error_of([&] { device->launch(good, 100, arguments(x, 1.0)); }), "8 bytes"));
    const std::string swapped = error_of([&] { device->launch(good, 100, arguments(100u, x)); });
    CHECK(has(swapped, kind == "cuda" ? "takes 8 bytes as argument 1; 4 bytes are given"
                                      : "takes a buffer as argument 1; 4 bytes are given"));
    CHECK(has(error_of([&] { device->launch(good, std::size_t(1) << 32, arguments(x, 1u)); }), "4294967296 items"));
    // The device goes on.
    device->launch(good, 100, arguments(x, 100u));
    CHECK(device->download<std::uint32_t>(x, 100)[99] == 99);
  }
}

TEST_CASE("no memory left") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const std::string text = error_of([&] { device->allocate(std::size_t(1) << 50); });
    CAPTURE(text);
    CHECK(has(text, "has no memory left: asked for 1126 TB, free "));
    CHECK(has(text, "use fewer particles"));
  }
  if (testing::real_cuda()) return;
  const auto device = testing::open("cuda");
  const Variable memory("CALX_STAND_IN_MEMORY", "1000000");
  const DeviceBuffer a = device->allocate(600000);
  CHECK(has(error_of([&] { device->allocate(600000); }), "asked for 600 kB, free 400 kB, in all 1 MB"));
}

TEST_CASE("a launch that fails names the kernel") {
  if (const auto device = testing::open("opencl")) {
    const DeviceKernel good = device->build(text_of("")).kernel("good");
    const DeviceBuffer x = device->allocate(400);
    const std::string text = error_of([&] { device->launch(good, 100, arguments(x, 100u), 1u << 30); });
    CHECK(has(text, "kernel good of module \"contact kernels, sand-steel\" failed on 100 items: CL_INVALID_WORK"));
  }
  if (testing::real_cuda()) return;
  const auto device = testing::open("cuda");
  const DeviceKernel good = device->build(text_of("")).kernel("good");
  const DeviceBuffer x = device->allocate(400);
  {
    const Variable fail("CALX_STAND_IN_FAIL", "good");
    CHECK(has(error_of([&] { device->launch(good, 100, arguments(x, 100u)); }),
              "Stand-in GPU 0: kernel good of module \"contact kernels, sand-steel\" failed on 100 items: "
              "CUDA_ERROR_LAUNCH_FAILED"));
  }
  CHECK(has(error_of([&] { device->launch(good, 100, arguments(x, 100u), 2048); }), "with groups of 2048"));
}

TEST_CASE("a failure that shows later names the last kernel, and with waiting its own") {
  if (testing::real_cuda()) return;
  // The stand-in keeps the failure for good, as a real context does: so in a library of its own.
  const std::string copy = CALX_TEST_CACHE "/stand_in_copy.so";
  testing::use_stand_in();
  std::filesystem::create_directories(CALX_TEST_CACHE);
  std::filesystem::copy_file(CALX_STAND_IN_CUDA, copy, std::filesystem::copy_options::overwrite_existing);
  const Variable other("CALX_LIBCUDA", copy), fail("CALX_STAND_IN_FAIL_LATE", "good");
  {
    const auto device = open_device("cuda", 0, testing::options());
    const DeviceKernel good = device->build(text_of("")).kernel("good");
    const DeviceBuffer x = device->allocate(400);
    device->launch(good, 100, arguments(x, 100u));
    const std::string text = error_of([&] { device->finish(); });
    CHECK(has(text, "waiting failed: CUDA_ERROR_ILLEGAL_ADDRESS"));
    CHECK(has(text, "the last kernel started was good (CALX_DEVICE_SYNC=1 names the one at fault)"));
  }
  const std::string again = CALX_TEST_CACHE "/stand_in_copy_2.so";
  std::filesystem::copy_file(CALX_STAND_IN_CUDA, again, std::filesystem::copy_options::overwrite_existing);
  const Variable third("CALX_LIBCUDA", again), sync("CALX_DEVICE_SYNC", "1");
  const auto device = open_device("cuda", 0, testing::options());
  const DeviceKernel good = device->build(text_of("")).kernel("good");
  const DeviceBuffer x = device->allocate(400);
  CHECK(has(error_of([&] { device->launch(good, 100, arguments(x, 100u)); }), "kernel good of module"));
}

TEST_CASE("compiled modules are kept, checked, and compiled anew where damaged") {
  testing::use_stand_in();
  for (const std::string kind : {"host", "cuda"}) {
    CAPTURE(kind);
    DeviceOptions own = testing::options();
    own.cache = CALX_TEST_CACHE "/damage";
    std::filesystem::remove_all(own.cache);
    const auto device = open_device(kind, 0, own);
    CHECK(!device->build(text_of("")).from_cache());
    CHECK(device->build(text_of("")).from_cache());
    CHECK(!device->build(text_of("/* another text */")).from_cache());
    ModuleText fast = text_of("");
    fast.fast = true;
    CHECK(!device->build(fast).from_cache());
    for (const char* damage : {"cut", "flipped", "empty"}) {
      CAPTURE(damage);
      for (const auto& file : std::filesystem::directory_iterator(own.cache)) {
        std::string all = content(file.path());
        if (damage[0] == 'c') all.resize(all.size() / 2);
        if (damage[0] == 'f') all[all.size() / 2] = static_cast<char>(all[all.size() / 2] ^ 1);
        if (damage[0] == 'e') all.clear();
        std::ofstream(file.path(), std::ios::binary) << all;
      }
      std::string log;
      log = log_of([&] {
        const DeviceModule module = device->build(text_of(""));
        CHECK(!module.from_cache());
        const DeviceBuffer x = device->allocate(40);
        device->launch(module.kernel("good"), 10, arguments(x, 10u));
        CHECK(device->download<std::uint32_t>(x, 10)[9] == 9);
      });
      CHECK(has(log, "is damaged; it is compiled anew"));
      CHECK(device->build(text_of("")).from_cache());
    }
  }
}

TEST_CASE("a cache that cannot be written is said once and ends nothing") {
  DeviceOptions own;
  own.cache = "/dev/null/calx";
  const std::string log = log_of([&] {
    const auto device = open_device("host", 0, own);
    CHECK(!device->build(text_of("")).from_cache());
    CHECK(!device->build(text_of("")).from_cache());
    CHECK(has(error_of([&] { device->build(text_of(kBad)); }), "the whole log could not be kept: no cache folder"));
  });
  const std::string words = "compiled device modules are not kept: folder /dev/null/calx: Not a directory";
  CHECK(has(log, words));
  CHECK(log.find(words) == log.rfind(words));
}

TEST_CASE("two devices in two threads") {
  testing::use_stand_in();
  std::uint32_t got[2] = {0, 0};
  std::vector<std::thread> threads;
  for (int k = 0; k < 2; ++k)
    threads.emplace_back([k, &got] {
      const auto device = open_device("cuda", testing::real_cuda() ? 0 : k, testing::options());
      const DeviceKernel good = device->build(text_of("")).kernel("good");
      const DeviceBuffer x = device->allocate(4000);
      for (int round = 0; round < 50; ++round) device->launch(good, 1000, arguments(x, 1000u));
      got[k] = device->download<std::uint32_t>(x, 1000)[999];
    });
  for (std::thread& each : threads) each.join();
  CHECK(got[0] == 999);
  CHECK(got[1] == 999);
}

TEST_CASE("the use of registers is read from the compiler's log") {
  const auto all = read_resources(
      "ptxas info    : 0 bytes gmem\nptxas info    : Compiling entry function 'a' for 'sm_90'\n"
      "ptxas info    : Function properties for a\n"
      "ptxas         .     88 bytes stack frame, 12 bytes spill stores, 20 bytes spill loads\n"
      "ptxas info    : Used 40 registers, used 0 barriers, 88 bytes cumulative stack size\n"
      "ptxas info    : Compiling entry function 'b' for 'sm_90'\n"
      "    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n");
  REQUIRE(all.size() == 2);
  CHECK(all[0].first == "a");
  CHECK(all[0].second.stack_bytes == 88);
  CHECK(all[0].second.spill_bytes == 32);
  CHECK(all[0].second.registers == 40);
  CHECK(all[1].second.spill_bytes == 0);
  CHECK(all[1].second.registers == -1);
}

// The loader reads its surroundings once, so these two run in processes of their own; see CMakeLists.txt.
TEST_CASE("no driver is registered with the OpenCL loader" * doctest::skip()) {
  const std::string text = error_of([] { open_device("opencl"); });
  if (has(text, "needs the OpenCL loader")) {
    MESSAGE("skipped: " << text);
    return;
  }
  CHECK(has(text, "finds no device; no driver is registered: /nowhere/vendors holds no usable .icd file"));
}

TEST_CASE("the cache folder of PoCL cannot be written" * doctest::skip()) {
  const std::string text = error_of([] { open_device("opencl"); });
  if (!has(text, "registered and show")) {
    MESSAGE("skipped: no PoCL here: " << text);
    return;
  }
  CHECK(has(text, "PoCL does so where its cache folder cannot be written, and POCL_CACHE_DIR is \"/dev/null/pocl\""));
}
