#include "infer/emulator.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace calx {
namespace {

/// Variance of the coefficients of the trend in units of that of y: wide, so that the data decide.
constexpr double kTrendVariance = 100;
/// Added to the diagonal in units of the variance of y, so that runs without scatter can be factorised.
constexpr double kJitter = 1e-8;
/// Bounds of log lengths, log signal and log noise. Lengths of a tenth to ten ranges; a length beyond is a straight
/// line.
constexpr double kLength[2] = {-2.3, 2.3}, kSignal[2] = {-4, 2.3}, kNoise[2] = {-9.2, 1.1};
/// Log-normal prior of lengths: median one range, factor e.
constexpr double kLengthSd = 1;

double matern(double r) {
  const double s = std::sqrt(5.0) * r;
  return (1 + s + s * s / 3) * std::exp(-s);
}

double objective(unsigned n, const double* v, double*, void* emulator) {
  const double value = static_cast<const Emulator*>(emulator)->log_density(Eigen::Map<const Eigen::VectorXd>(v, n));
  // The optimiser must not see an infinity.
  return std::max(value, -1e12);
}

}  // namespace

Emulator::Emulator(const Eigen::MatrixXd& x, const std::vector<std::vector<double>>& values,
                   const Eigen::MatrixXd& trend)
    : x_(x) {
  const Eigen::Index n = x.rows(), d = x.cols();
  if (n < 2 || values.size() != static_cast<std::size_t>(n) || (trend.cols() > 0 && trend.rows() != n))
    throw std::invalid_argument("an emulator needs two places or more, and runs and trend for each");
  y_.resize(n);
  counts_.resize(n);
  double within = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& runs = values[static_cast<std::size_t>(k)];
    if (runs.empty()) throw std::invalid_argument("an emulator needs a run at every place");
    counts_(k) = static_cast<double>(runs.size());
    y_(k) = Eigen::Map<const Eigen::VectorXd>(runs.data(), static_cast<Eigen::Index>(runs.size())).mean();
    for (const double v : runs) within += (v - y_(k)) * (v - y_(k));
    within_freedom_ += counts_(k) - 1;
  }
  if (!x.allFinite() || !y_.allFinite() || !trend.allFinite())
    throw std::invalid_argument("an emulator needs finite numbers");
  shift_ = y_.mean();
  const double sd = std::sqrt((y_.array() - shift_).square().sum() / static_cast<double>(n - 1));
  // A figure that never changes keeps a scale of its own size, so that it stays a constant.
  scale_ = sd > 1e-12 * std::fabs(shift_) && sd > 0 ? sd : std::max(std::fabs(shift_) * 1e-6, 1e-300);
  standard_ = (y_.array() - shift_) / scale_;
  within_ = within / (scale_ * scale_);

  const Eigen::Index extra = trend.cols();
  trend_shift_ = Eigen::VectorXd::Zero(extra);
  trend_scale_ = Eigen::VectorXd::Ones(extra);
  trend_.resize(n, 1 + d + extra);
  trend_.col(0).setOnes();
  trend_.middleCols(1, d) = x_.array() - 0.5;
  for (Eigen::Index k = 0; k < extra; ++k) {
    trend_shift_(k) = trend.col(k).mean();
    const double spread = std::sqrt((trend.col(k).array() - trend_shift_(k)).square().mean());
    trend_scale_(k) = spread > 0 ? spread : 1;
    trend_.col(1 + d + k) = (trend.col(k).array() - trend_shift_(k)) / trend_scale_(k);
  }
  find_hyperparameters();
  solve();
}

double Emulator::kernel(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& inverse,
                        double signal) const {
  return signal * signal * matern((a - b).cwiseProduct(inverse).norm());
}

Eigen::MatrixXd Emulator::covariance(const Eigen::VectorXd& log_parameters) const {
  const Eigen::Index n = x_.rows(), d = x_.cols();
  const Eigen::VectorXd inverse = (-log_parameters.head(d)).array().exp();
  const double signal = std::exp(log_parameters(d)), noise = std::exp(log_parameters(d + 1));
  Eigen::MatrixXd k = kTrendVariance * trend_ * trend_.transpose();
  const Eigen::MatrixXd scaled = x_ * inverse.asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double c = signal * signal * matern((scaled.row(i) - scaled.row(j)).norm());
      k(i, j) += c;
      k(j, i) += c;
    }
    k(i, i) += signal * signal + noise * noise / counts_(i) + kJitter;
  }
  return k;
}

double Emulator::log_density(const Eigen::VectorXd& log_parameters) const {
  const Eigen::Index d = x_.cols();
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance(log_parameters));
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const double fit = factor.matrixL().solve(standard_).squaredNorm();
  double out = -0.5 * fit - factor.matrixLLT().diagonal().array().log().sum();
  // Runs that share a place tell the scatter without the kernel.
  const double noise = std::exp(log_parameters(d + 1)), noise2 = noise * noise + kJitter;
  out += -0.5 * within_freedom_ * std::log(noise2) - 0.5 * within_ / noise2;
  out -= 0.5 * log_parameters.head(d).squaredNorm() / (kLengthSd * kLengthSd);
  // The signal has a weak prior about the size of y; without it a straight line drives it anywhere.
  return out - 0.125 * log_parameters(d) * log_parameters(d);
}

void Emulator::find_hyperparameters() {
  const auto d = static_cast<std::size_t>(x_.cols());
  const auto count = static_cast<unsigned>(d + 2);
  std::vector<double> low(d, kLength[0]), high(d, kLength[1]);
  for (const auto* bound : {kSignal, kNoise}) low.push_back(bound[0]), high.push_back(bound[1]);
  double start_noise = within_freedom_ > 0 ? 0.5 * std::log(within_ / within_freedom_ + 1e-16) : -1;
  start_noise = std::min(std::max(start_noise, kNoise[0]), kNoise[1]);
  double best = -std::numeric_limits<double>::infinity();
  for (const double start : {-0.7, 0.4, 1.4}) {
    std::vector<double> v(d, start);
    v.push_back(-0.5);
    v.push_back(start_noise);
    nlopt_opt optimiser = nlopt_create(NLOPT_LN_BOBYQA, count);
    nlopt_set_max_objective(optimiser, objective, this);
    nlopt_set_lower_bounds(optimiser, low.data());
    nlopt_set_upper_bounds(optimiser, high.data());
    nlopt_set_initial_step1(optimiser, 0.4);
    // A hundredth of a unit of log density is far below what changes a prediction.
    nlopt_set_ftol_abs(optimiser, 1e-3);
    nlopt_set_maxeval(optimiser, 60 * static_cast<int>(count));
    double value = 0;
    nlopt_optimize(optimiser, v.data(), &value);
    nlopt_destroy(optimiser);
    if (value > best || best_.size() == 0) {
      best = value;
      best_ = Eigen::Map<Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
    }
  }
}

void Emulator::solve() {
  const Eigen::Index d = x_.cols();
  lengths_ = best_.head(d).array().exp();
  signal_ = std::exp(best_(d));
  noise_ = std::exp(best_(d + 1));
  factor_.compute(covariance(best_));
  weights_ = factor_.solve(standard_);
  double sum = 0;
  const std::vector<Estimate> left_out = leave_one_out();
  for (Eigen::Index k = 0; k < y_.size(); ++k) {
    const Estimate& e = left_out[static_cast<std::size_t>(k)];
    // One wild run must not decide alone.
    sum += std::min((y_(k) - e.mean) * (y_(k) - e.mean) / e.variance, 9.0);
  }
  inflation_ = std::max(1.0, sum / static_cast<double>(y_.size()));
}

Estimate Emulator::at(const Eigen::VectorXd& x, const Eigen::VectorXd& trend) const {
  const Eigen::Index n = x_.rows(), d = x_.cols(), extra = trend_.cols() - 1 - d;
  if (x.size() != d || trend.size() != extra)
    throw std::invalid_argument("a place of another size than the emulator's");
  Eigen::VectorXd features(trend_.cols());
  features(0) = 1;
  features.segment(1, d) = x.array() - 0.5;
  for (Eigen::Index k = 0; k < extra; ++k) features(1 + d + k) = (trend(k) - trend_shift_(k)) / trend_scale_(k);
  const Eigen::VectorXd inverse = lengths_.cwiseInverse();
  Eigen::VectorXd c = kTrendVariance * trend_ * features;
  for (Eigen::Index k = 0; k < n; ++k) c(k) += kernel(x_.row(k).transpose(), x, inverse, signal_);
  const double prior = kTrendVariance * features.squaredNorm() + signal_ * signal_;
  const double left = prior - factor_.matrixL().solve(c).squaredNorm();
  return {shift_ + scale_ * c.dot(weights_), scale_ * scale_ * inflation_ * std::max(left, 0.0)};
}

std::vector<Estimate> Emulator::leave_one_out() const {
  const Eigen::Index n = x_.rows();
  const Eigen::MatrixXd inverse = factor_.solve(Eigen::MatrixXd::Identity(n, n));
  std::vector<Estimate> out;
  for (Eigen::Index k = 0; k < n; ++k)
    out.push_back({y_(k) - scale_ * weights_(k) / inverse(k, k), scale_ * scale_ / inverse(k, k)});
  return out;
}

}  // namespace calx
