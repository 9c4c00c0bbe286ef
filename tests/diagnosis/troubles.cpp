#include "diagnosis/troubles.hpp"

#include <cmath>

#include "base/random.hpp"

namespace calx::diagnosis {

void take_far(Random& random, Vector& u) {
  const auto count = static_cast<std::uint64_t>(u.size());
  const std::uint64_t first = random.bits() % count, second = (first + 1 + random.bits() % (count - 1)) % count;
  for (std::uint64_t k : {first, second})
    u[static_cast<Eigen::Index>(k)] = random.uniform(2, 3) * (random.uniform() < 0.5 ? 1 : -1);
}

void add_gross_errors(Random& random, infer::Observables& observables) {
  constexpr double error = 8;
  std::vector<infer::Block*> long_ones;
  for (infer::Block& block : observables.blocks)
    if (block.sd.size() >= 12) long_ones.push_back(&block);
  for (bool hold : {false, true})
    for (int k = 0; k < 3; ++k) {
      infer::Block& block = *long_ones[random.bits() % long_ones.size()];
      const auto row = static_cast<Eigen::Index>(random.bits() % static_cast<std::uint64_t>(block.sd.size()));
      (hold ? block.hold : block.fit)[row] += error * block.sd[row] * (random.uniform() < 0.5 ? 1 : -1);
    }
}

TroubledSimulator::TroubledSimulator(LineSimulator& line, Trouble trouble, infer::Observables& observables)
    : line_(line), library_(effect_library()) {
  if (trouble == Trouble::inert_covariate) {
    infer::Effect temperature;
    temperature.id = "temperature of the load cell", temperature.scale = 0.4, temperature.instrument = true;
    library_.push_back(temperature);
  }
  std::vector<infer::Block> kept;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    if (trouble == Trouble::few_observables && (b == speed || b == fold || b == height || b == angle_after)) continue;
    kept_.push_back({observables.first(b), observables.size(b)});
    kept.push_back(observables.blocks[b]);
  }
  observables.blocks = kept;
}

Matrix TroubledSimulator::seen(const Matrix& all) const {
  int rows = 0;
  for (const auto& [first, size] : kept_) rows += size;
  Matrix out(rows, all.cols());
  int row = 0;
  for (const auto& [first, size] : kept_) out.middleRows(row, size) = all.middleRows(first, size), row += size;
  return out;
}

Matrix TroubledSimulator::run(const std::vector<infer::RunPoint>& points) { return seen(line_.run(points)); }

Vector TroubledSimulator::instrument(const infer::RunPoint& point) {
  if (point.effect < effect_count) return seen(line_.instrument(point));
  // Warmer towards the end of the shift, with the heating going on and off: mass shown per scale of it.
  Vector change = Vector::Zero(line_observables().rows());
  for (int k = 0; k < line::cycles; ++k) {
    const double done = (k + 1.0) / line::cycles;
    change[k] = point.amplitude[0] * (std::sqrt(done) + 0.1 * std::sin(9 * line::pi * done));
  }
  return seen(change);
}

}  // namespace calx::diagnosis
