#include "study/surrogate.hpp"

#include <cmath>

namespace calx {
namespace {

/// Share of the tolerance that is smooth along a curve, and the length of its correlation as a share of the range: a
/// model that is off is mostly off in the same way nearby.
constexpr double kSmoothShare = 0.5, kSmoothLength = 0.35;

/// An sd from few repeats is itself uncertain; the variance of Student's t with that many degrees of freedom stands for
/// it, and 3 for less than three degrees, where t has none.
double repeat_inflation(const MeasuredData& data) {
  if (!data.sd_estimated) return 1;
  const double freedom = static_cast<double>((data.repeats - 1) * std::max<std::size_t>(data.x.size(), 1));
  return freedom > 2.5 ? std::min(3.0, freedom / (freedom - 2)) : 3;
}

}  // namespace

Surrogate::Surrogate(const Study& study, std::size_t number, const std::vector<const PlaceRuns*>& places,
                     const UnitBox& box, std::shared_ptr<const Surrogate> base)
    : box_(box), base_(std::move(base)) {
  for (const PlaceRuns* p : places)
    if (!p->figures[number].empty()) places_.push_back(p);
  const auto n = static_cast<Eigen::Index>(places_.size());
  const StudyObservable& o = study.observables[number];
  const auto m = static_cast<Eigen::Index>(o.measured.y.size());
  Eigen::MatrixXd means(n, m), x(n, box.low.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& runs = places_[static_cast<std::size_t>(k)]->figures[number];
    means.row(k).setZero();
    for (const Eigen::VectorXd& r : runs) means.row(k) += r.transpose() / static_cast<double>(runs.size());
    x.row(k) = scaled(places_[static_cast<std::size_t>(k)]->u).transpose();
  }
  basis_ = curve_basis(means, target_of(o).covariance.diagonal().cwiseSqrt());
  Eigen::MatrixXd trends;
  if (base_) {
    trends.resize(n, basis_.shapes.cols());
    for (Eigen::Index k = 0; k < n; ++k) trends.row(k) = trend(places_[static_cast<std::size_t>(k)]->u).transpose();
  }
  for (Eigen::Index c = 0; c < basis_.shapes.cols(); ++c) {
    std::vector<std::vector<double>> values;
    for (const PlaceRuns* p : places_) {
      values.emplace_back();
      for (const Eigen::VectorXd& r : p->figures[number]) values.back().push_back(basis_.coefficients(r)(c));
    }
    emulators_.emplace_back(x, values, base_ ? Eigen::MatrixXd(trends.col(c)) : Eigen::MatrixXd());
  }
}

Eigen::VectorXd Surrogate::scaled(const Eigen::VectorXd& u) const {
  return (u - box_.low).cwiseQuotient(box_.high - box_.low);
}

Eigen::VectorXd Surrogate::trend(const Eigen::VectorXd& u) const {
  return base_ ? basis_.coefficients(base_->at(u).mean) : Eigen::VectorXd();
}

Figures Surrogate::at(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd x = scaled(u), t = trend(u);
  const Eigen::Index count = basis_.shapes.cols();
  Eigen::VectorXd coefficients(count), variances(count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const Estimate e =
        emulators_[static_cast<std::size_t>(c)].at(x, base_ ? Eigen::VectorXd(t.segment(c, 1)) : Eigen::VectorXd());
    coefficients(c) = e.mean;
    variances(c) = e.variance;
  }
  Figures out;
  out.mean = basis_.curve(coefficients);
  out.covariance = basis_.shapes * variances.asDiagonal() * basis_.shapes.transpose();
  out.covariance.diagonal() += basis_.rest;
  return out;
}

Target target_of(const StudyObservable& o, double relative_tolerance) {
  const MeasuredData& data = o.measured;
  const auto m = static_cast<Eigen::Index>(data.y.size());
  Target out;
  out.y = Eigen::Map<const Eigen::VectorXd>(data.y.data(), m);
  out.covariance.resize(m, m);
  const double repeats = static_cast<double>(data.repeats), range = m > 1 ? data.x.back() - data.x.front() : 1;
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      double c = data.sd[a] * data.sd[b] * repeat_inflation(data) / repeats *
                 std::pow(data.correlation, std::fabs(static_cast<double>(i - j)));
      const double apart = m > 1 ? (data.x[a] - data.x[b]) / (kSmoothLength * range) : 0;
      c += o.tolerance * o.tolerance * kSmoothShare * std::exp(-0.5 * apart * apart);
      c += relative_tolerance * relative_tolerance * data.y[a] * data.y[b];
      if (i == j) c += o.tolerance * o.tolerance * (1 - kSmoothShare);
      out.covariance(i, j) = c;
    }
  return out;
}

double normal_score(double square, Eigen::Index freedom) {
  if (freedom == 1) return std::sqrt(square);
  const double m = static_cast<double>(freedom), s = 2 / (9 * m);
  return (std::cbrt(square / m) - (1 - s)) / std::sqrt(s);
}

Misfit misfit(const Target& target, const Figures& figures) {
  const Eigen::Index m = target.y.size();
  const Eigen::VectorXd r = target.y - figures.mean;
  Misfit out;
  constexpr double kLogTwoPi = 1.8378770664093453;
  if (m == 1) {
    const double variance = target.covariance(0, 0) + figures.covariance(0, 0);
    out.square = r(0) * r(0) / variance;
    out.log_likelihood = -0.5 * (out.square + std::log(variance) + kLogTwoPi);
  } else {
    const Eigen::LLT<Eigen::MatrixXd> factor(target.covariance + figures.covariance);
    out.square = factor.matrixL().solve(r).squaredNorm();
    out.log_likelihood =
        -0.5 * (out.square + static_cast<double>(m) * kLogTwoPi) - factor.matrixLLT().diagonal().array().log().sum();
  }
  out.implausibility = std::max(normal_score(out.square, m), 0.0);
  return out;
}

}  // namespace calx
