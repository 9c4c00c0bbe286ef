// Every operation of a device on every backend, with the same expected numbers.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "compute/devices.hpp"

using namespace calx;

namespace {

struct Shift {
  double dx, dy, dz;
  std::uint32_t steps, odd;
};

const char* const kText = R"(
typedef struct { double dx, dy, dz; u32 steps, odd; } shift;
KERNEL(twice, GLOBAL const u32* RESTRICT in, GLOBAL u32* RESTRICT out, const u32 n) {
  if (ITEM >= n) return;
  out[ITEM] = 2 * in[ITEM];
}
KERNEL(move, GLOBAL double* x, const shift by, const float factor, const u64 wide, const u32 n) {
  if (ITEM >= n) return;
  const vec3_f64 d = scale3_f64((double)factor, make3_f64(by.dx, by.dy, by.dz));
  x[ITEM] = x[ITEM] + d.x + d.y * (double)by.steps + d.z * (double)by.odd + (double)wide;
}
KERNEL(marks, GLOBAL u32* sums, const u32 n) {
  if (ITEM >= n) return;
  ATOMIC_ADD(sums, ITEM);
  ATOMIC_OR(sums + 1, 1u << (ITEM % 32));
  ATOMIC_MAX(sums + 2, ITEM);
}
KERNEL(advance, GLOBAL u32* x, const u32 n) {
  if (ITEM >= n) return;
  x[ITEM] = x[ITEM] * 3 + 1;
}
KERNEL(maybe, GLOBAL u32* out, GLOBAL const u32* in, const u32 n) {
  if (ITEM >= n) return;
  out[ITEM] = in ? in[ITEM] : 7;
}
KERNEL(math, GLOBAL double* d, GLOBAL float* f, const u32 n) {
  if (ITEM >= n) return;
  const vec3_f64 a = make3_f64(1.0, 2.0, (double)ITEM), b = make3_f64(0.5, -1.0, 3.0);
  d[ITEM] = length3_f64(cross3_f64(mad3_f64(a, 2.0, b), sub3_f64(a, b))) + floor_f64(-0.5 * (double)ITEM) +
            abs_f64(-sqrt_f64(2.0)) + dot3_f64(a, add3_f64(a, b)) / 3.0;
  f[ITEM] = sqrt_f32(0.1f * (float)ITEM) + floor_f32(1.5f * (float)ITEM) / 3.0f + abs_f32(-1.0f);
}
)";

ModuleText module_text() {
  ModuleText text;
  text.label = "device test";
  text.add("test.h", kText);
  return text;
}

std::vector<std::uint32_t> numbers(std::size_t n) {
  std::vector<std::uint32_t> v(n);
  std::uint32_t x = 12345;
  for (auto& each : v) {
    x = x * 1664525u + 1013904223u;
    each = x >> 24;
  }
  return v;
}

}  // namespace

TEST_CASE("a device says what it is") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    CHECK(device->kind() == kind);
    CHECK(!device->name().empty());
    CHECK(!device->driver().empty());
    CHECK(device->memory().total > 1000000u);
    CHECK(device->supports_double());
    CHECK(device->exact() == device->inexact_reason().empty());
    if (kind != "opencl") CHECK(device->exact());
  }
}

TEST_CASE("buffers are zero at first, and hold what is written, copied and zeroed") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceBuffer a = device->allocate(1001), b = device->allocate(1001);
    CHECK(a.bytes() == 1001);
    std::vector<unsigned char> all = device->download<unsigned char>(a, 1001);
    CHECK(all == std::vector<unsigned char>(1001, 0));
    std::vector<unsigned char> some(77);
    std::iota(some.begin(), some.end(), static_cast<unsigned char>(1));
    device->write(a, some.data(), some.size(), 13);
    device->copy(b, a, 500, 8, 5);
    device->zero(b, 3, 20);
    all = device->download<unsigned char>(b, 1001);
    CHECK(all[15] == 0);
    CHECK(all[16] == 1);
    CHECK(all[19] == 4);
    CHECK(all[20] == 0);
    CHECK(all[22] == 0);
    CHECK(all[23] == 8);
    CHECK(all[92] == 77);
    CHECK(all[93] == 0);
    CHECK(testing::has(testing::error_of([&] { device->read(a, all.data(), 10, 995); }),
                       "a read of 10 bytes at 995 does not fit in a device buffer of 1001 bytes"));
    CHECK(testing::has(testing::error_of([&] { device->copy(a, b, 1001, 1, 0); }), "a copy of 1001 bytes at 1"));
    DeviceBuffer moved = std::move(const_cast<DeviceBuffer&>(b));
    CHECK(moved.bytes() == 1001);
    CHECK(device->allocate(0).bytes() == 0);
  }
}

TEST_CASE("kernels get their arguments") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceModule module = device->build(module_text());
    CHECK(module.build_seconds() > 0);
    if (kind == "cuda") {
      CHECK(module.resources("twice").registers > 0);
      CHECK(module.resources("twice").spill_bytes == 0);
    }
    CHECK(module.resources("no_such_kernel").registers == -1);
    const std::uint32_t n = 1000;
    const std::vector<std::uint32_t> in = numbers(n);
    const DeviceBuffer from = device->upload(in), to = device->allocate(4 * n);
    device->launch(module.kernel("twice"), n, arguments(from, to, n));
    const auto out = device->download<std::uint32_t>(to, n);
    for (std::uint32_t k = 0; k < n; ++k) REQUIRE(out[k] == 2 * in[k]);

    const DeviceBuffer x = device->upload(std::vector<double>(300, 1.5));
    const Shift by = {1, 10, 100, 2, 3};
    const std::uint64_t wide = 5000000000ull;
    device->launch(module.kernel("move"), 300, arguments(x, by, 0.5f, wide, std::uint32_t(300)), 32);
    CHECK(device->download<double>(x, 300) == std::vector<double>(300, 1.5 + 0.5 + 10 + 150 + 5e9));

    const DeviceBuffer sums = device->allocate(12);
    device->launch(module.kernel("marks"), n, arguments(sums, n));
    const auto got = device->download<std::uint32_t>(sums, 3);
    CHECK(got[0] == n * (n - 1) / 2);
    CHECK(got[1] == 0xffffffffu);
    CHECK(got[2] == n - 1);

    const DeviceKernel maybe = module.kernel("maybe");
    device->launch(maybe, 3, arguments(to, DeviceBuffer(), std::uint32_t(3)));
    CHECK(device->download<std::uint32_t>(to, 3) == std::vector<std::uint32_t>(3, 7));
    device->launch(maybe, 0, arguments(to, from, std::uint32_t(0)));
    CHECK(maybe.name() == "maybe");
  }
}

TEST_CASE("the functions of the language layer give the same bits everywhere") {
  const std::uint32_t n = 200;
  std::vector<double> first_d;
  std::vector<float> first_f;
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceModule module = device->build(module_text());
    const DeviceBuffer d = device->allocate(8 * n), f = device->allocate(4 * n);
    device->launch(module.kernel("math"), n, arguments(d, f, n));
    const auto dd = device->download<double>(d, n);
    const auto ff = device->download<float>(f, n);
    if (first_d.empty()) {
      first_d = dd;
      first_f = ff;
      // Item 0: a = (1, 2, 0), b = (0.5, -1, 3); a + 2 b = (2, 0, 6), a - b = (0.5, 3, -3).
      CHECK(dd[0] == doctest::Approx(std::sqrt(18. * 18 + 9 * 9 + 6 * 6) + std::sqrt(2.) + 3.5 / 3).epsilon(1e-14));
      CHECK(ff[3] == doctest::Approx(std::sqrt(0.3) + 4 / 3. + 1).epsilon(1e-6));
    }
    CHECK(std::memcmp(dd.data(), first_d.data(), 8 * n) == 0);
    CHECK(std::memcmp(ff.data(), first_f.data(), 4 * n) == 0);
  }
}

TEST_CASE("a read that comes later") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceModule module = device->build(module_text());
    const DeviceBuffer x = device->allocate(4 * 64);
    const DeviceKernel advance = module.kernel("advance");
    std::uint32_t one = 99, four = 99;
    device->launch(advance, 64, arguments(x, std::uint32_t(64)));
    DeviceEvent early = device->read_later(x, &one, 4, 4 * 63);
    device->launch(advance, 64, arguments(x, std::uint32_t(64)));
    DeviceEvent late = device->read_later(x, &four, 4);
    late.wait();
    CHECK(late.ready());
    CHECK(four == 4);
    early.wait();
    early.wait();
    CHECK(one == 1);
    std::uint32_t dropped = 99;
    { const DeviceEvent unused = device->read_later(x, &dropped, 4); }
    CHECK(dropped == 4);
    device->finish();
  }
}

TEST_CASE("a graph does what was recorded, each time it is started") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceModule module = device->build(module_text());
    const std::uint32_t n = 500;
    const DeviceBuffer x = device->allocate(4 * n), y = device->allocate(4 * n), scan = device->allocate(4 * (n + 1));
    device->reserve(n);
    device->begin_capture();
    device->launch(module.kernel("advance"), n, arguments(x, n));
    device->launch(module.kernel("advance"), n, arguments(x, n));
    device->copy(y, x, 4 * n);
    device->zero(y, 4);
    device->exclusive_scan(y, scan, n);
    CHECK(testing::has(testing::error_of([&] { device->allocate(16); }),
                       "memory is asked for while a graph is recorded"));
    CHECK(testing::has(testing::error_of([&] { device->finish(); }), "while a graph is recorded"));
    DeviceGraph graph = device->end_capture();
    CHECK(graph.operations() >= 6);
    // Nothing has run yet.
    CHECK(device->download<std::uint32_t>(x, 1)[0] == 0);
    device->launch(graph);
    CHECK(device->download<std::uint32_t>(x, n) == std::vector<std::uint32_t>(n, 4));
    device->reserve(1000000);  // other work space; the graph keeps its own
    device->launch(graph);
    CHECK(device->download<std::uint32_t>(x, n) == std::vector<std::uint32_t>(n, 40));
    CHECK(device->download<std::uint32_t>(y, 2) == std::vector<std::uint32_t>({0, 40}));
    CHECK(device->download<std::uint32_t>(scan, n + 1)[n] == 40 * (n - 1));
    CHECK(testing::has(testing::error_of([&] { device->end_capture(); }), "not begun"));
  }
}

TEST_CASE("exclusive scan") {
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    for (const std::size_t n : {0, 1, 63, 64, 65, 4096, 4097, 300001}) {
      CAPTURE(n);
      const std::vector<std::uint32_t> in = numbers(n);
      const DeviceBuffer from = device->upload(in), to = device->allocate(4 * (n + 1));
      device->exclusive_scan(from, to, n);
      const auto out = device->download<std::uint32_t>(to, n + 1);
      std::uint32_t sum = 0;
      bool same = true;
      for (std::size_t k = 0; k < n; ++k) {
        same = same && out[k] == sum;
        sum += in[k];
      }
      CHECK(same);
      CHECK(out[n] == sum);
    }
    const DeviceBuffer small = device->allocate(40);
    CHECK(testing::has(testing::error_of([&] { device->exclusive_scan(small, small, 5); }), "not the same"));
  }
}

TEST_CASE("reductions, with the same bits on every device") {
  const std::size_t n = 100003;
  std::vector<double> d(n);
  std::vector<float> f(n);
  const std::vector<std::uint32_t> u = numbers(n);
  for (std::size_t k = 0; k < n; ++k)
    f[k] = static_cast<float>(d[k] = std::sin(0.37 * double(k)) * 1e3 / double(k + 1));
  std::vector<double> first;
  for (const std::string& kind : testing::kinds()) {
    CAPTURE(kind);
    const auto device = testing::open(kind);
    if (!device) continue;
    const DeviceBuffer bd = device->upload(d), bf = device->upload(f), bu = device->upload(u);
    const DeviceBuffer od = device->allocate(8 * 3), of = device->allocate(4 * 3), ou = device->allocate(4 * 3);
    int row = 0;
    for (const Reduction what : {Reduction::sum, Reduction::smallest, Reduction::largest}) {
      device->reduce<double>(what, bd, n, od, row);
      device->reduce<float>(what, bf, n, of, row);
      device->reduce<std::uint32_t>(what, bu, n, ou, row++);
    }
    std::vector<double> all = device->download<double>(od, 3);
    for (const float x : device->download<float>(of, 3)) all.push_back(x);
    for (const std::uint32_t x : device->download<std::uint32_t>(ou, 3)) all.push_back(x);
    CHECK(all[0] == doctest::Approx(std::accumulate(d.begin(), d.end(), 0.0)).epsilon(1e-12));
    CHECK(all[1] == *std::min_element(d.begin(), d.end()));
    CHECK(all[2] == *std::max_element(d.begin(), d.end()));
    CHECK(all[4] == *std::min_element(f.begin(), f.end()));
    CHECK(all[6] == std::accumulate(u.begin(), u.end(), 0u));
    CHECK(all[7] == 0);
    CHECK(all[8] == 255);
    if (first.empty()) first = all;
    CHECK(std::memcmp(all.data(), first.data(), 8 * all.size()) == 0);
    device->reduce<double>(Reduction::largest, bd, 1, od);
    CHECK(device->download<double>(od, 1)[0] == d[0]);
    device->reduce<double>(Reduction::sum, bd, 0, od);
    CHECK(device->download<double>(od, 1)[0] == 0);
  }
}
