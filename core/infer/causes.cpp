#include "infer/causes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace calx::infer {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int grid = 241, directions = 12;
constexpr std::array<double, 4> prior_scales = {0.25, 0.5, 1, 2};
constexpr std::array<double, 3> shape_factors = {0.5, 1, 2};

double log_prior(double amplitude, double scale, bool one_sided) {
  double sum = 0;
  for (double m : prior_scales) {
    const double z = amplitude / (m * scale);
    sum += std::exp(-0.5 * z * z) / (m * scale);
  }
  return std::log(std::max(sum, 1e-300) / prior_scales.size() / std::sqrt(2 * pi) * (one_sided ? 2 : 1));
}

/// A stretch of amplitudes with its share of the posterior, not normalised; evidence and prior share count.
struct Cell {
  double from, size, log_weight;
};

/// 5 % and 95 % points of cells that may overlap.
void set_interval(std::vector<Cell> cells, SingleFit& fit) {
  if (cells.empty()) return;
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.from < b.from; });
  double largest = -1e300, total = 0, below = 0;
  for (const Cell& c : cells) largest = std::max(largest, c.log_weight);
  for (const Cell& c : cells) total += std::exp(c.log_weight - largest);
  fit.low = cells.front().from, fit.high = cells.back().from + cells.back().size;
  for (const Cell& c : cells) {
    const double w = std::exp(c.log_weight - largest) / total;
    if (below < 0.05 && below + w >= 0.05) fit.low = c.from + c.size * (0.05 - below) / w;
    if (below < 0.95 && below + w >= 0.95) fit.high = c.from + c.size * (0.95 - below) / w;
    below += w;
  }
}

/// With one tolerance of the shape. Adds its cells.
SingleFit fit_line(const Vector& g, const Matrix& shape, double scale, bool one_sided, const Vector& r,
                   std::vector<Cell>& cells) {
  SingleFit fit;
  fit.amplitude = Vector::Zero(1);
  const double power = g.squaredNorm();
  if (power * scale * scale < 1e-6) return fit;
  Vector lambda(0), a(0), b(0);
  if (shape.cols() > 0) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(shape.transpose() * shape);
    lambda = solver.eigenvalues().cwiseMax(0);
    a = solver.eigenvectors().transpose() * (shape.transpose() * r);
    b = solver.eigenvectors().transpose() * (shape.transpose() * g);
  }
  const double along = r.dot(g), mean = along / power, v = 1 / std::sqrt(power);
  const bool tolerant = shape.cols() > 0;
  double low = mean - (tolerant ? 16 : 8) * v - (tolerant ? 0.4 * std::abs(mean) : 0),
         high = mean + (tolerant ? 16 : 8) * v + (tolerant ? 0.8 * std::abs(mean) : 0);
  if (one_sided) low = std::max(low, 0.0), high = std::max(high, 3 * v);
  // Where the data hardly speak, the prior ends the grid: beyond eight of its widest sd there is nothing to add up, and
  // a grid much wider than the prior would see it at one point only.
  if (v > scale) {
    const double widest = 8 * prior_scales.back() * scale;
    low = one_sided ? 0 : -widest, high = widest;
  }
  const double step = (high - low) / (grid - 1);
  std::array<double, grid> log_posterior;
  double largest = -1e300;
  for (int k = 0; k < grid; ++k) {
    const double x = low + k * step;
    double l = x * along - 0.5 * x * x * power + log_prior(x, scale, one_sided);
    for (int q = 0; q < lambda.size(); ++q) {
      const double p = x * x * lambda[q], c = a[q] - x * b[q];
      l += 0.5 * x * x * c * c / (1 + p) - 0.5 * std::log1p(p);
    }
    log_posterior[static_cast<std::size_t>(k)] = l;
    largest = std::max(largest, l);
  }
  // Trapezoids: half a cell at either end, where a one-sided posterior may be at its largest.
  const auto cell = [&](int k) { return k == 0 || k == grid - 1 ? 0.5 : 1.0; };
  double sum = 0, first = 0, second = 0;
  for (int k = 0; k < grid; ++k) {
    const double x = low + k * step, w = cell(k) * std::exp(log_posterior[static_cast<std::size_t>(k)] - largest);
    sum += w, first += w * x, second += w * x * x;
  }
  fit.odds = largest + std::log(sum * step);
  fit.amplitude[0] = first / sum;
  fit.sd = std::sqrt(std::max(0.0, second / sum - fit.amplitude[0] * fit.amplitude[0]));
  for (int k = 0; k < grid; ++k)
    cells.push_back({low + (k == 0 ? 0 : k - 0.5) * step, cell(k) * step,
                     log_posterior[static_cast<std::size_t>(k)] + std::log(cell(k) * step)});
  return fit;
}

/// Evidence and interval averaged over tolerances of the shape, the rest with the most probable one.
SingleFit fit_direction(const Vector& g, const Matrix& shape, double scale, bool one_sided, const Vector& r) {
  std::vector<double> odds;
  std::vector<Cell> cells;
  SingleFit best;
  for (double factor : shape_factors) {
    SingleFit fit = fit_line(g, factor * shape, scale, one_sided, r, cells);
    if (shape.cols() == 0) {
      set_interval(cells, fit);
      return fit;
    }
    fit.shape_factor = factor;
    odds.push_back(fit.odds - std::log(shape_factors.size()));
    if (odds.size() == 1 || fit.odds > best.odds) best = fit;
  }
  best.odds = log_sum(odds);
  set_interval(cells, best);
  return best;
}

Matrix shape_at(const Signature& s, const Vector& amplitude) {
  Matrix b = amplitude[0] * s.shape[0];
  if (amplitude.size() == 1) return b;
  Matrix all(b.rows(), b.cols() + s.shape[1].cols());
  all << b, amplitude[1] * s.shape[1];
  return all;
}

/// Unit vectors all around; only along the other axis where nothing is known of one.
std::vector<Vector> directions_of(const Signature& s) {
  std::vector<Vector> out;
  for (int c = 0; c < 2; ++c)
    if (s.columns.col(1 - c).isZero(0))
      for (double sign : {1.0, -1.0}) out.push_back(sign * Vector::Unit(2, c));
  for (int k = 0; k < directions && out.empty(); ++k)
    out.push_back((Vector(2) << std::cos(2 * pi * k / directions), std::sin(2 * pi * k / directions)).finished());
  return out;
}

/// ln of the standard normal distribution function.
double log_normal_cdf(double x) { return std::log(std::max(0.5 * std::erfc(-x / std::sqrt(2.0)), 1e-300)); }

}  // namespace

Matrix shape_columns(const Observables& observables, const Vector& signature, double scale, double factor,
                     const Options& options) {
  Matrix all = Matrix::Zero(signature.size(), 0);
  if (options.shape <= 0) return all;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const int first = observables.first(b), n = observables.size(b);
    const Vector g = signature.segment(first, n);
    if (options.shape * 4 * scale * g.cwiseQuotient(observables.blocks[b].sd).norm() < 0.1) continue;
    Matrix kernel = Matrix::Ones(1, 1);
    if (n > 1)
      kernel =
          low_rank(0.5 * Matrix::Ones(n, n) + 0.5 * smooth_kernel(observables.blocks[b], options.shape_length), 2e-3);
    all.conservativeResize(Eigen::NoChange, all.cols() + kernel.cols());
    all.rightCols(kernel.cols()).setZero();
    all.block(first, all.cols() - kernel.cols(), n, kernel.cols()) = factor * options.shape * g.asDiagonal() * kernel;
  }
  return all;
}

Matrix noise_columns(const LinearModel& model, std::size_t effect, const Options& options) {
  const Observables& all = model.observables;
  Matrix out = Matrix::Zero(all.rows(), 0);
  if (!options.signature_noise || model.signature_variance[effect] <= 0) return out;
  const double sd = std::sqrt(model.signature_variance[effect]);
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const int first = all.first(b), n = all.size(b);
    if (model.signatures[effect].middleRows(first, n).isZero(0)) continue;
    Matrix smooth = n > 1 ? low_rank(smooth_kernel(all.blocks[b], 0.3), 1e-2) : Matrix::Ones(1, 1);
    smooth.colwise().normalize();
    out.conservativeResize(Eigen::NoChange, out.cols() + smooth.cols() + 1);
    out.rightCols(smooth.cols() + 1).setZero();
    const SeedScatter& scatter = model.scatter;
    const Vector own = (sd * all.blocks[b].sd).cwiseProduct(scatter.profile[b]);
    // Scatter that is correlated along the index has more of itself in what is smooth.
    const Matrix rest = autocorrelation_matrix(n, scatter.correlation[b]);
    for (Eigen::Index k = 0; k < smooth.cols(); ++k)
      smooth.col(k) *= scatter.white[b] * std::sqrt(smooth.col(k).dot(rest * smooth.col(k)));
    out.block(first, out.cols() - 1, n, 1) = scatter.common[b] * own;
    out.block(first, out.cols() - 1 - smooth.cols(), n, smooth.cols()) = own.asDiagonal() * smooth;
  }
  return out;
}

Signature whiten_signature(const LinearModel& model, std::size_t effect, const Metric& metric, const Options& options) {
  const Effect& e = model.effects[effect];
  Signature s;
  s.scale = e.scale, s.one_sided = e.one_sided;
  s.columns = metric.whiten(model.signatures[effect]);
  const Matrix noise = noise_columns(model, effect, options);
  for (int c = 0; c < e.components; ++c) {
    const Matrix shape = shape_columns(model.observables, model.signatures[effect].col(c), e.scale, 1, options);
    Matrix both(shape.rows(), shape.cols() + noise.cols());
    both << shape, noise;
    s.shape.push_back(metric.whiten(both));
  }
  return s;
}

SingleFit fit_single(const Signature& s, const Metric& metric) {
  const Vector& r = metric.residual();
  if (s.columns.cols() == 1) return fit_direction(s.columns.col(0), s.shape[0], s.scale, s.one_sided, r);
  std::vector<double> odds;
  SingleFit best;
  for (const Vector& direction : directions_of(s)) {
    SingleFit fit = fit_direction(s.columns * direction, shape_at(s, direction), s.scale, true, r);
    odds.push_back(fit.odds);
    if (odds.size() == 1 || fit.odds > best.odds) {
      best = fit;
      best.amplitude = fit.amplitude[0] * direction;
    }
  }
  best.odds = log_sum(odds) - std::log(static_cast<double>(odds.size()));
  return best;
}

PairFit fit_pair(const Signature& a, const Signature& b, const SingleFit& fit_a, const SingleFit& fit_b,
                 const Metric& metric) {
  const int na = static_cast<int>(a.columns.cols()), nb = static_cast<int>(b.columns.cols()), n = na + nb;
  Matrix x(metric.residual().size(), n);
  x << a.columns, b.columns;
  Vector mean(n), scale(n);
  mean << fit_a.amplitude, fit_b.amplitude;
  scale << Vector::Constant(na, a.scale), Vector::Constant(nb, b.scale);
  PairFit fit;
  Matrix information(n, n);
  Vector pull(n);
  double base = 0;
  for (int pass = 0; pass < 3; ++pass) {
    const Matrix shape_a = fit_a.shape_factor * shape_at(a, mean.head(na)),
                 shape_b = fit_b.shape_factor * shape_at(b, mean.tail(nb));
    Matrix c(x.rows(), shape_a.cols() + shape_b.cols());
    c << shape_a, shape_b;
    information = x.transpose() * x;
    pull = x.transpose() * metric.residual();
    if (c.cols() > 0) {
      const Eigen::LLT<Matrix> factor(Matrix::Identity(c.cols(), c.cols()) + c.transpose() * c);
      const Vector cr = factor.matrixL().solve(c.transpose() * metric.residual());
      const Matrix cx = factor.matrixL().solve(c.transpose() * x);
      information -= cx.transpose() * cx;
      pull -= cx.transpose() * cr;
      base = 0.5 * cr.squaredNorm() - Matrix(factor.matrixL()).diagonal().array().log().sum();
    }
    Matrix precision = information;
    precision.diagonal().array() += (2 * scale).array().pow(-2);
    mean = precision.ldlt().solve(pull);
    if (a.one_sided) mean[0] = std::max(mean[0], 0.0);
    if (b.one_sided) mean[na] = std::max(mean[na], 0.0);
  }
  std::vector<double> odds;
  for (double ma : prior_scales)
    for (double mb : prior_scales) {
      Vector s(n);
      s << Vector::Constant(na, ma * a.scale), Vector::Constant(nb, mb * b.scale);
      Matrix precision = information;
      precision.diagonal().array() += s.array().pow(-2);
      const Matrix v = precision.inverse();
      const Vector m = v * pull;
      double l = base + 0.5 * m.dot(pull) + 0.5 * std::log(v.determinant()) - s.array().log().sum();
      // Half-normal priors: twice the probability that the amplitude is positive.
      if (a.one_sided) l += std::log(2.0) + log_normal_cdf(m[0] / std::sqrt(v(0, 0)));
      if (b.one_sided) l += std::log(2.0) + log_normal_cdf(m[na] / std::sqrt(v(na, na)));
      odds.push_back(l - std::log(16.0));
    }
  // The tolerances were chosen among three each.
  fit.odds = log_sum(odds) - 2 * std::log(shape_factors.size());
  fit.first = mean.head(na), fit.second = mean.tail(nb);
  return fit;
}

}  // namespace calx::infer
