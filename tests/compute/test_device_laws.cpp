// Every shipped law, from the text its plugin carries, gives the bits of the plugin's own machine code on every device.
#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "compute/cuda_api.hpp"
#include "compute/cuda_compile.hpp"
#include "compute/devices.hpp"
#include "compute/law_kernel.hpp"
#include "support/law_bench.hpp"

using namespace calx;

namespace {

struct Case {
  std::string plugin;
  bench::Choices choices;
  bench::Values values;
};

const std::vector<Case>& cases() {
  static const bench::Values sliding = {{"restitution", 0.4}, {"friction", 0.3}};
  static const bench::Values plastic = {{"plasticity", 0.6}, {"restitution", 0.4}, {"friction", 0.3}};
  const auto with = [](bench::Values values, const bench::Values& more) {
    values.insert(more.begin(), more.end());
    return values;
  };
  const bench::Values roll = {{"rolling_friction", 0.1}};
  const bench::Values energy = {{"surface_energy", 0.5}}, adhesive = {{"k_adh", 1e3}, {"rolling_friction", 0.1}};
  static const std::vector<Case> all = {
      {"calx-hertz-mindlin", {}, sliding},
      {"calx-hertz-mindlin", {{"rolling", "epsd"}, {"tension", "clipped"}}, with(sliding, roll)},
      {"calx-hertz-mindlin", {{"rolling", "a"}, {"tangential", "incremental"}}, with(sliding, roll)},
      {"calx-epam", {{"exponent", "1"}}, with(plastic, energy)},
      {"calx-epam", {{"exponent", "1.5"}}, with(plastic, energy)},
      {"calx-epam", {{"exponent", "1"}, {"rolling", "epsd2"}}, with(plastic, with(energy, roll))},
      {"calx-epam", {{"exponent", "1.5"}, {"rolling", "a"}}, with(plastic, with(energy, roll))},
      {"calx-epam", {{"exponent", "1"}, {"adhesion_exponent", "3.5"}, {"rolling", "epsd"}}, with(plastic, adhesive)},
      {"calx-epam", {{"exponent", "1.5"}, {"adhesion_exponent", "5"}}, with(plastic, energy)},
  };
  return all;
}

TextPart text_of(const bench::Law& law, const std::string& plugin) {
  return {plugin + ".law.h", std::string(law.table().source, law.table().source_size)};
}

std::vector<bench::Input> rows(const calx_contact_law& table, std::size_t n, unsigned step) {
  std::mt19937 random(7 + step);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  std::vector<bench::Input> all(n);
  for (std::size_t k = 0; k < n; ++k) {
    bench::Input& row = all[k];
    const double r_i = 1e-3 * (1 + double(k % 7)), r_j = k % 5 == 0 ? 0 : 1e-3 * (1 + double(k % 3));
    bench::V3 normal{uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
    normal = normal * (1 / bench::norm(normal));
    row[CALX_IN_OVERLAP] = uniform(-1e-5, 1e-4);
    row[CALX_IN_NX] = normal.x, row[CALX_IN_NY] = normal.y, row[CALX_IN_NZ] = normal.z;
    for (int c = CALX_IN_VX; c <= CALX_IN_VZ; ++c) row[c] = uniform(-0.5, 0.5);
    for (int c = CALX_IN_WX; c <= CALX_IN_WZ; ++c) row[c] = uniform(-50, 50);
    row[CALX_IN_R_EFF] = r_j > 0 ? r_i * r_j / (r_i + r_j) : r_i;
    row[CALX_IN_M_EFF] = 1e4 * r_i * r_i * r_i;
    row[CALX_IN_R_I] = r_i, row[CALX_IN_R_J] = r_j;
    for (int c = 0; c < CALX_IN_COUNT; ++c)
      if (!((table.needs >> c) & 1u)) row[c] = 0;
  }
  return all;
}

/// Three steps of n contacts on the device and in the plugin; the number of values that differ in any bit.
template <class Real>
std::size_t differences(Device& device, const DeviceModule& module, const bench::Law& law, bool* moved) {
  const calx_contact_law& table = law.table();
  const std::size_t n = 500, stride = n + 13;
  const double dt = 1e-6;
  const std::vector<Real> pair(law.pair().begin(), law.pair().end());
  std::vector<std::vector<double>> history(n, law.fresh());
  std::vector<Real> state(stride * table.state_count);
  for (std::size_t k = 0; k < table.state_count; ++k)
    for (std::size_t r = 0; r < n; ++r) state[k * stride + r] = static_cast<Real>(history[r][k]);
  const DeviceBuffer pair_buffer = device.upload(pair), state_buffer = device.upload(state);
  const DeviceBuffer in_buffer = device.allocate(sizeof(Real) * stride * CALX_IN_COUNT);
  const DeviceBuffer out_buffer = device.allocate(sizeof(Real) * stride * CALX_OUT_COUNT);
  const DeviceKernel kernel =
      module.kernel(std::string(table.symbol) + "_rows" + (sizeof(Real) == 8 ? "_f64" : "_f32"));
  std::size_t count = 0;
  for (unsigned step = 0; step < 3; ++step) {
    const std::vector<bench::Input> contacts = rows(table, n, step);
    std::vector<Real> in(stride * CALX_IN_COUNT);
    for (std::size_t r = 0; r < n; ++r)
      for (int c = 0; c < CALX_IN_COUNT; ++c) in[c * stride + r] = static_cast<Real>(contacts[r][c]);
    device.write(in_buffer, in.data(), in.size() * sizeof(Real));
    device.launch(kernel, n,
                  arguments(in_buffer, pair_buffer, state_buffer, out_buffer, std::uint64_t(stride),
                            static_cast<Real>(dt), std::uint32_t(n)));
    const std::vector<bench::Output> expected = law.evaluate<Real>(contacts, history, dt, 256);
    const auto out = device.download<Real>(out_buffer, stride * CALX_OUT_COUNT);
    state = device.download<Real>(state_buffer, state.size());
    const auto differ = [](Real a, double b) {
      const Real other = static_cast<Real>(b);
      return std::memcmp(&a, &other, sizeof a) != 0;
    };
    for (std::size_t r = 0; r < n; ++r) {
      for (int c = 0; c < CALX_OUT_COUNT; ++c) {
        count += differ(out[c * stride + r], expected[r][c]);
        *moved = *moved || expected[r][c] != 0;
      }
      for (std::size_t k = 0; k < table.state_count; ++k) count += differ(state[k * stride + r], history[r][k]);
    }
  }
  return count;
}

}  // namespace

TEST_CASE("laws give the plugin's bits on every device, in both precisions") {
  for (const std::string& kind : testing::kinds()) {
    const auto device = testing::open(kind);
    if (!device) continue;
    std::map<std::string, DeviceModule> modules;
    for (const Case& each : cases()) {
      const bench::Law law(each.plugin, each.choices, each.values);
      REQUIRE(law.status() == CALX_OK);
      if (!modules.count(each.plugin))
        modules[each.plugin] = device->build(testing::law_module({text_of(law, each.plugin)}));
      CAPTURE(kind);
      CAPTURE(law.table().symbol);
      bool moved = false;
      CHECK(differences<double>(*device, modules[each.plugin], law, &moved) == 0);
      CHECK(differences<float>(*device, modules[each.plugin], law, &moved) == 0);
      CHECK(moved);
    }
  }
}

TEST_CASE("NVRTC compiles every shipped law without a spill and without a stack") {
  unsetenv("CALX_LIBNVRTC");
  try {
    nvrtc();
  } catch (const Error& error) {
    MESSAGE("skipped: " << error.what());
    return;
  }
  DeviceCache cache(testing::options().cache);
  std::vector<TextPart> texts;
  std::size_t laws = 0;
  const std::vector<Case> one_each = {cases()[0], cases()[3]};
  for (const Case& each : one_each) {
    texts.push_back(text_of(bench::Law(each.plugin, each.choices, each.values), each.plugin));
    laws += testing::laws_of(texts.back().text).size();
  }
  const bench::Law linear("calx-linear", {}, {});
  texts.push_back(text_of(linear, "calx-linear"));
  laws += testing::laws_of(texts.back().text).size();
  for (const std::string architecture : {"sm_80", "sm_86", "sm_90"}) {
    const CudaBinary binary = compile_cuda(testing::law_module(texts), architecture, "none", cache);
    CHECK(binary.image.size() > 1000);
    CHECK(binary.resources.size() == 2 * laws);
    for (const auto& kernel : binary.resources) {
      CAPTURE(kernel.first);
      CHECK(kernel.second.spill_bytes == 0);
      CHECK(kernel.second.stack_bytes == 0);
      CHECK(kernel.second.registers > 10);
      CHECK(kernel.second.registers <= 160);
    }
  }
}
