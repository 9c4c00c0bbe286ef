#include "infer/terms.hpp"

#include <algorithm>
#include <cmath>

namespace calx::infer {

namespace {

constexpr double pi = 3.14159265358979323846;
/// A curve whose numbers differ by less than this many declared sd from neighbour to neighbour is flat.
constexpr double flat = 1;

/// Unit index to the user's index.
double place_of(const Block& block, double z) {
  const double low = block.x[0], high = block.x[block.x.size() - 1];
  return block.log_x ? low * std::pow(high / low, z) : low + z * (high - low);
}

}  // namespace

namespace {

std::vector<Term> own_terms(const Observables& observables, std::size_t index) {
  const Block& block = observables.blocks[index];
  const Vector z = unit_index(block);
  const int n = static_cast<int>(z.size());
  std::vector<Term> terms;
  const auto add = [&](const char* family, double place, const Matrix& columns) {
    Matrix scaled = columns;
    for (int c = 0; c < columns.cols(); ++c) scaled.col(c) = columns.col(c).cwiseProduct(block.sd);
    terms.push_back({family, place, index, scaled, 0, {}});
  };
  const auto along = [&](auto shape) {
    Vector v(n);
    for (int k = 0; k < n; ++k) v[k] = shape(z[k]);
    return v;
  };
  add("constant", 0, Matrix::Ones(n, 1));
  if (n < 3) {
    if (n == 2) add("drift", 0, z);
    return terms;
  }
  const Matrix smooth = low_rank(smooth_kernel(block, 0.3), 1e-3);
  add("smooth", 0, smooth);
  if (n < 5) return terms;
  add("rough", 0, low_rank(smooth_kernel(block, 0.08), 1e-2));
  add("drift", 0, z);
  if (n >= 12)
    for (double length : {0.05, 0.15, 0.4})
      add("decay", length * (block.x[n - 1] - block.x[0]), along([&](double t) { return std::exp(-t / length); }));
  const int places = n > 60 ? 39 : n > 20 ? 15 : 7;
  if (block.ordered)
    for (int k = 1; k <= places; ++k) {
      const double at = k / (places + 1.0);
      add("step", place_of(block, at), along([&](double t) { return t >= at ? 1.0 : 0.0; }));
    }
  else
    for (int k = 0; k < places; ++k) {
      const double at = 0.1 + 0.8 * k / (places - 1.0);
      add("hinge", place_of(block, at), along([&](double t) { return t > at ? (t - at) / (1 - at) : 0.0; }));
    }
  if (n >= 12 && !block.ordered)
    for (double width : {0.06, 0.12})
      for (int k = 0; k < places; ++k) {
        const double at = 0.1 + 0.8 * k / (places - 1.0);
        add("bump", place_of(block, at),
            along([&](double t) { return std::exp(-0.5 * std::pow((t - at) / width, 2)); }));
      }
  if (n >= 24)
    for (double period : {0.12, 0.2, 0.3, 0.45, 0.6, 0.75, 1.0}) {
      Matrix wave(n, 2);
      wave.col(0) = along([&](double t) { return std::sin(2 * pi * t / period); });
      wave.col(1) = along([&](double t) { return std::cos(2 * pi * t / period); });
      add("periodic", period * (block.x[n - 1] - block.x[0]), wave);
    }
  if (n >= 60 && block.ordered)
    for (int teeth : {2, 3, 4, 6})
      add("sawtooth", (block.x[n - 1] - block.x[0]) / teeth, along([&](double t) {
            const double phase = t * teeth;
            return t >= 1 ? 1.0 : phase - std::floor(phase);
          }));
  return terms;
}

/// Change of the block where it is displaced along its index, of rms one declared sd. Empty where the curve is flat.
std::vector<Term> shift_of(const Block& block, std::size_t index, const Vector& base) {
  const auto n = base.size();
  if (n < 12 || block.log_x) return {};
  const Vector& x = block.x;
  Vector slope(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index a = std::max<Eigen::Index>(k - 1, 0), b = std::min(k + 1, n - 1);
    slope[k] = -(base[b] - base[a]) / (x[b] - x[a]);
  }
  const double rms = slope.cwiseQuotient(block.sd).norm() / std::sqrt(static_cast<double>(n));
  if (rms * (x[n - 1] - x[0]) < flat * static_cast<double>(n)) return {};
  return {{"shift", 1 / rms, index, slope / rms, 0, {}}};
}

}  // namespace

std::vector<Term> terms_of(const Observables& observables, std::size_t index, const Vector& base) {
  const Block& block = observables.blocks[index];
  std::vector<Term> terms = own_terms(observables, index);
  const std::vector<Term> shift = shift_of(block, index, base);
  terms.insert(terms.end(), shift.begin(), shift.end());
  const std::size_t sums_block = observables.sums_of(index);
  if (sums_block == observables.blocks.size()) return terms;
  const Vector& until = observables.blocks[sums_block].x;
  Matrix weights = Matrix::Zero(until.size(), block.x.size());
  for (Eigen::Index i = 0; i < until.size(); ++i)
    for (Eigen::Index k = 0; k < block.x.size() && block.x[k] <= until[i]; ++k)
      weights(i, k) = block.x[k] - (k == 0 ? 0 : block.x[k - 1]);
  for (std::size_t k = 0, own = terms.size(); k < own; ++k) {
    if (terms[k].family == "shift") continue;
    terms.push_back(terms[k]);
    terms.back().sums_block = sums_block, terms.back().sums = weights * terms[k].columns;
  }
  return terms;
}

}  // namespace calx::infer
