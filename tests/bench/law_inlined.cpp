// law_inlined.cpp: what a plugin's block call costs against the same law text compiled into the caller.
//
// All compute the same contacts in the same columns: the plugin in blocks of 256 rows, as the engine calls it; the
// caller's copy of the law in the same blocks; and that copy in one loop over all rows, which spares the ends of
// blocks, too. They take turns in going first; ratios are medians over the rounds. One JSON line for each law and
// precision. Argument: rounds (default 200).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "support/law_bench.hpp"

#define CALX_BITS 32
#include <calx/law/native.h>
#include <calx/law/prelude.h>
#include <calx/law/rolling.h>
#include <calx/law/sliding.h>

#include "epam.law.h"
#include "hertz_mindlin.law.h"
CALX_LAW_BATCH(hertz_mindlin)
CALX_LAW_BATCH(epam_n15)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/native.h>
#include <calx/law/prelude.h>
#include <calx/law/rolling.h>
#include <calx/law/sliding.h>

#include "epam.law.h"
#include "hertz_mindlin.law.h"
CALX_LAW_BATCH(hertz_mindlin)
CALX_LAW_BATCH(epam_n15)
#undef real

namespace {

/// The columns stay in the second-level cache.
constexpr std::uint32_t kRows = 1024, kBlockRows = 256, kRepeats = 16, kOutputs = 6;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Contacts as in a bed of 2.5 mm spheres, in columns one behind the other.
template <class Real, class Block>
struct Columns {
  // Columns a power of two apart would share cache sets.
  static constexpr std::size_t kStride = kRows + 8;
  std::vector<Real> pair, data;
  const Real *first, *last;  // of the columns
  Block block;

  explicit Columns(const bench::Law& law) : pair(law.pair().begin(), law.pair().end()) {
    const std::vector<double> fresh = law.fresh();
    data.resize(kStride * (CALX_IN_COUNT + kOutputs + fresh.size() + 1));
    // The first column starts where a cache line does.
    void* start = data.data();
    std::size_t room = data.size() * sizeof(Real);
    Real* column = static_cast<Real*>(std::align(64, 1, start, room));
    first = column;
    last = first + kStride * (CALX_IN_COUNT + kOutputs + fresh.size());
    std::memset(&block, 0, sizeof block);
    std::mt19937 random(1);
    auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() / 4294967296.0); };
    for (std::uint32_t r = 0; r < kRows; ++r) {
      const double c = uniform(-1, 1), a = uniform(0, 6.283), s = std::sqrt(1 - c * c);
      const double row[CALX_IN_COUNT] = {uniform(1e-7, 5e-6),
                                         s * std::cos(a),
                                         s * std::sin(a),
                                         c,
                                         uniform(-0.02, 0.02),
                                         uniform(-0.02, 0.02),
                                         uniform(-0.02, 0.02),
                                         uniform(-5, 5),
                                         uniform(-5, 5),
                                         uniform(-5, 5),
                                         6.25e-4,
                                         8.6e-6,
                                         1.25e-3,
                                         1.25e-3,
                                         0};
      for (std::size_t k = 0; k < CALX_IN_COUNT; ++k) column[k * kStride + r] = static_cast<Real>(row[k]);
    }
    block.struct_size = sizeof block;
    block.count = kRows;
    block.stride = kStride;
    block.dt = 9.8e-6;
    block.pair = pair.data();
    for (std::size_t k = 0; k < CALX_IN_COUNT; ++k, column += kStride) block.in[k] = column;
    for (std::size_t k = 0; k < kOutputs; ++k, column += kStride) block.out[k] = column;
    block.state = column;
    for (std::size_t k = 0; k < fresh.size(); ++k, column += kStride)
      std::fill_n(column, kRows, static_cast<Real>(fresh[k]));
  }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
};

/// The block of all rows as blocks of kBlockRows.
template <class Block>
std::vector<Block> cut(const Block& all) {
  std::vector<Block> parts(kRows / kBlockRows, all);
  for (std::uint32_t n = 0; n < parts.size(); ++n) {
    parts[n].count = kBlockRows;
    for (std::size_t c = 0; c < CALX_IN_COUNT; ++c) parts[n].in[c] += n * kBlockRows;
    for (std::size_t c = 0; c < kOutputs; ++c) parts[n].out[c] += n * kBlockRows;
    parts[n].state += n * kBlockRows;
  }
  return parts;
}

/// Nanoseconds of one contact when all rows go through the function, in these blocks.
template <class Block>
double time(const std::vector<Block>& parts, void (*eval)(const Block*)) {
  const double start = seconds();
  for (std::uint32_t k = 0; k < kRepeats; ++k)
    for (const Block& part : parts) eval(&part);
  return 1e9 * (seconds() - start) / (kRows * kRepeats);
}

template <class Real, class Block>
bool compare(const char* id, const bench::Law& law, void (*plugin)(const Block*), void (*own)(const Block*),
             int rounds) {
  // One set of columns for all, since where columns lie shows in the times.
  Columns<Real, Block> columns(law);
  const std::vector<Block> parts = cut(columns.block), whole{columns.block};
  std::vector<double> plugin_ns, caller_ns, loop_ns, ratio, loop_ratio;
  for (int round = -4; round < rounds; ++round) {
    double p = 0, q = 0, one = 0;
    // Each goes first in every third round.
    for (int k = 0; k < 3; ++k) switch ((round + 6 + k) % 3) {
        case 0:
          p = time(parts, plugin);
          break;
        case 1:
          q = time(parts, own);
          break;
        default:
          one = time(whole, own);
      }
    if (round < 0) continue;  // warms caches and the choice of instruction sets
    plugin_ns.push_back(p);
    caller_ns.push_back(q);
    loop_ns.push_back(one);
    ratio.push_back(p / q);
    loop_ratio.push_back(p / one);
  }
  std::printf(
      "{\"bench\": \"law-inlined\", \"law\": \"%s\", \"scalar\": \"f%zu\", \"rows\": %u, \"rounds\": %d, "
      "\"plugin_ns_per_contact\": %.4g, \"inlined_ns_per_contact\": %.4g, \"one_loop_ns_per_contact\": %.4g, "
      "\"ratio\": %.4g, \"ratio_to_one_loop\": %.4g}\n",
      id, 8 * sizeof(Real), kBlockRows, rounds, median(plugin_ns), median(caller_ns), median(loop_ns), median(ratio),
      median(loop_ratio));
  Columns<Real, Block> a(law), b(law);
  for (int k = 0; k < 3; ++k) {
    for (const Block& part : cut(a.block)) plugin(&part);
    own(&b.block);
  }
  if (std::equal(a.first, a.last, b.first)) return true;
  std::fprintf(stderr, "%s: plugin and inlined law differ\n", id);
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
  const bench::Law hertz("calx-hertz-mindlin", {}, {{"restitution", 0.3}, {"friction", 0.5}});
  const bench::Law epam("calx-epam", {{"exponent", "1.5"}},
                        {{"restitution", 0.3}, {"friction", 0.5}, {"plasticity", 0.4}, {"surface_energy", 0.1}});
  bool same = compare<double>("calx.hertz-mindlin", hertz, hertz.table().eval_f64, hertz_mindlin_batch_f64, rounds);
  same &= compare<float>("calx.hertz-mindlin", hertz, hertz.table().eval_f32, hertz_mindlin_batch_f32, rounds);
  same &= compare<double>("calx.epam", epam, epam.table().eval_f64, epam_n15_batch_f64, rounds);
  same &= compare<float>("calx.epam", epam, epam.table().eval_f32, epam_n15_batch_f32, rounds);
  return same ? 0 : 1;
}
