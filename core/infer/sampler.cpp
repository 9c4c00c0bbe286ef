#include "infer/sampler.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/random.hpp"

namespace calx {
namespace {

/// Integrated autocorrelation time, in kept moves, of the mean over walkers (Goodman and Weare 2010, section 3), with
/// the self-consistent window of Sokal (5 times the sum so far).
double correlation_time(const Eigen::MatrixXd& series) {
  // series: one kept move a row, one walker a column.
  const Eigen::Index n = series.rows();
  const double mean = series.mean();
  const Eigen::MatrixXd x = series.array() - mean;
  const double variance = x.squaredNorm() / static_cast<double>(x.size());
  if (!(variance > 0)) return static_cast<double>(n);
  double sum = 1;
  for (Eigen::Index lag = 1; lag < n; ++lag) {
    const double covariance = (x.topRows(n - lag).array() * x.bottomRows(n - lag).array()).mean();
    sum += 2 * covariance / variance;
    if (static_cast<double>(lag) >= 5 * sum) break;
  }
  return std::max(sum, 1.0);
}

}  // namespace

Samples draw(const std::function<double(const Eigen::VectorXd&)>& log_density, const Eigen::MatrixXd& start,
             const SamplerSettings& settings) {
  const Eigen::Index walkers = start.rows(), d = start.cols(), half = walkers / 2;
  if (walkers % 2 != 0 || walkers < 2 * d + 2)
    throw std::invalid_argument("the sampler needs an even number of walkers, 2 dimensions + 2 or more");
  Eigen::MatrixXd x = start;
  Eigen::VectorXd density(walkers);
  for (Eigen::Index k = 0; k < walkers; ++k) density(k) = log_density(x.row(k).transpose());
  Random random(settings.seed, 0x4D434D43);
  const auto kept_moves = static_cast<Eigen::Index>((settings.steps - settings.first) / settings.keep_every);
  Samples out;
  out.x.resize(kept_moves * walkers, d);
  out.log_density.resize(kept_moves * walkers);
  std::size_t taken = 0;
  Eigen::Index kept = 0;
  for (std::size_t step = 0; step < settings.steps; ++step) {
    for (Eigen::Index k = 0; k < walkers; ++k) {
      const Eigen::Index other =
          (k < half ? half : 0) +
          std::min(half - 1, static_cast<Eigen::Index>(random.uniform() * static_cast<double>(half)));
      // z has the density 1 / sqrt(z) on [1/2, 2].
      const double root = std::sqrt(0.5) + random.uniform() * (std::sqrt(2.0) - std::sqrt(0.5)), z = root * root;
      const Eigen::VectorXd proposal = (x.row(other) + z * (x.row(k) - x.row(other))).transpose();
      const double proposed = log_density(proposal);
      const double ratio = static_cast<double>(d - 1) * std::log(z) + proposed - density(k);
      if (!(std::log(1 - random.uniform()) < ratio)) continue;
      x.row(k) = proposal.transpose();
      density(k) = proposed;
      ++taken;
    }
    if (step < settings.first || (step - settings.first + 1) % settings.keep_every != 0 || kept == kept_moves) continue;
    out.x.middleRows(kept * walkers, walkers) = x;
    out.log_density.segment(kept * walkers, walkers) = density;
    ++kept;
  }
  out.acceptance = static_cast<double>(taken) / static_cast<double>(settings.steps * static_cast<std::size_t>(walkers));
  out.effective = std::numeric_limits<double>::max();
  for (Eigen::Index k = 0; k < d; ++k) {
    Eigen::MatrixXd series(kept_moves, walkers);
    for (Eigen::Index m = 0; m < kept_moves; ++m)
      series.row(m) = out.x.col(k).segment(m * walkers, walkers).transpose();
    out.effective = std::min(out.effective, static_cast<double>(out.x.rows()) / correlation_time(series));
  }
  return out;
}

}  // namespace calx
