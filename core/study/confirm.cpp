#include "study/confirm.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "study/surrogate.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

constexpr double least_improvement = 0.05;   // of the held-out error, for an extension to be worth having
constexpr double contradicted_below = 1e-3;  // p of the difference between runs and algebra
constexpr std::uint64_t fit_seeds = 600, confirmation_seeds = 700;  // after the thousands of the study's seed
constexpr double prior_strength = 4;  // sd of a strength, in scales of its effect: as wide as the widest prior, doubled
constexpr double longest_step = 1;    // of a parameter, in prior sd
constexpr double largest_share = 0.6;  // of a strength in one step

std::vector<Setting> settings_of(const StudyDiagnosis& d, const RealModel& model, std::uint64_t first,
                                 std::size_t count) {
  std::vector<Setting> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back({model.u, {}, d.options.seed * 1000 + first + k});
    for (std::size_t e = 0; e < model.effects.size(); ++e)
      out.back().doses.emplace_back(d.kept[model.effects[e]], model.amplitudes[e]);
  }
  return out;
}

/// Everything between the mean of so many runs and what was measured, but for the noise of the measurement.
Matrix error_of_means(const StudyDiagnosis& d, std::size_t seeds) {
  infer::Options without = d.options;
  without.seed_scatter = false;
  return infer::error_budget(d.model, without).systematic +
         d.model.scatter.covariance(d.model.observables) / static_cast<double>(seeds);
}

std::vector<infer::Part> parts_of(const StudyDiagnosis& d, const RealModel& model) {
  std::vector<infer::Part> parts;
  for (std::size_t k = 0; k < model.effects.size(); ++k)
    parts.push_back({model.effects[k], model.amplitudes[k], d.diagnosis.posterior.fits[model.effects[k]].shape_factor});
  return parts;
}

class FitByRuns {
 public:
  FitByRuns(const StudyDiagnosis& d, StudySimulator& simulator, const RealModel& start, int seeds)
      : d_(d), simulator_(simulator), model_(start), seeds_(static_cast<std::size_t>(seeds)) {
    const Eigen::Index p = start.u.size();
    secants_ = d.model.sensitivities;
    prior_ = Vector::Ones(p);
    for (const std::size_t e : start.effects) {
      const infer::Effect& effect = d.model.effects[e];
      secants_.conservativeResize(Eigen::NoChange, secants_.cols() + effect.components);
      secants_.rightCols(effect.components) = d.model.signatures[e];
      prior_.conservativeResize(secants_.cols());
      prior_.tail(effect.components).setConstant(prior_strength * effect.scale);
    }
    metric_ = std::make_unique<infer::Metric>(error_of_means(d, seeds_) + d.diagnosis.budget.fit.noise,
                                              Vector::Zero(d.model.base.size()));
  }

  RealFit go(int rounds) {
    Vector x = flat(model_);
    Vector figures = run(model_);
    RealFit best{model_, {}, figures};
    double least = misfit(x, figures);
    Matrix secants = secants_;
    for (int round = 0; round < rounds; ++round) {
      const Vector to = step_from(x, figures);
      if ((to - x).cwiseQuotient(prior_).norm() < 0.05) break;
      Vector next;
      try {
        next = run(unflat(to));
      } catch (const Error& e) {
        // A place that cannot be run is no place to go to; what was found so far stands.
        if (e.fault() != Fault::numerics && e.fault() != Fault::settings) throw;
        break;
      }
      const Vector way = (to - x).cwiseQuotient(prior_);
      const Vector missed = next - figures - secants_ * (to - x);
      secants_ += missed * way.cwiseQuotient(prior_).transpose() / way.squaredNorm();
      x = to, figures = next;
      const double now = misfit(x, figures);
      if (now >= least) continue;
      least = now, best.model = unflat(x), best.figures = figures, secants = secants_;
    }
    const Matrix w = metric_->whiten(secants);
    Matrix precision = w.transpose() * w;
    precision.diagonal() += prior_.cwiseAbs2().cwiseInverse();
    const Matrix v = precision.inverse();
    best.freedom = secants * Matrix(Eigen::LLT<Matrix>(v).matrixL());
    Eigen::Index column = model_.u.size();
    for (const Vector& a : best.model.amplitudes) {
      const Vector along = a.norm() > 0 ? Vector(a / a.norm()) : Vector(Vector::Unit(a.size(), 0));
      best.sd.push_back(std::sqrt(along.dot(v.block(column, column, a.size(), a.size()) * along)));
      column += a.size();
    }
    return best;
  }

 private:
  static Vector flat(const RealModel& model) {
    Vector x = model.u;
    for (const Vector& a : model.amplitudes) {
      x.conservativeResize(x.size() + a.size());
      x.tail(a.size()) = a;
    }
    return x;
  }

  RealModel unflat(const Vector& x) const {
    RealModel out = model_;
    out.u = x.head(model_.u.size());
    Eigen::Index at = model_.u.size();
    for (Vector& a : out.amplitudes) {
      a = x.segment(at, a.size());
      at += a.size();
    }
    return out;
  }

  Vector run(const RealModel& model) {
    return simulator_.run_settings(settings_of(d_, model, fit_seeds, seeds_), true).rowwise().mean();
  }

  double misfit(const Vector& x, const Vector& figures) const {
    return metric_->whiten(d_.diagnosis.budget.fit.y - figures).squaredNorm() + x.cwiseQuotient(prior_).squaredNorm();
  }

  Vector step_from(const Vector& x, const Vector& figures) const {
    const Matrix w = metric_->whiten(secants_);
    const Vector r = metric_->whiten(d_.diagnosis.budget.fit.y - figures + secants_ * x);
    Matrix precision = w.transpose() * w;
    precision.diagonal() += prior_.cwiseAbs2().cwiseInverse();
    Vector change = precision.ldlt().solve(w.transpose() * r) - x;
    // A shorter step keeps its direction, so that parameters which make up for each other do so all along.
    double share = 1;
    for (Eigen::Index k = 0; k < model_.u.size(); ++k)
      share = std::min(share, longest_step / std::max(std::fabs(change[k]), 1e-12));
    Eigen::Index at = model_.u.size();
    for (std::size_t e = 0; e < model_.amplitudes.size(); ++e) {
      const Eigen::Index n = model_.amplitudes[e].size();
      const double size =
          std::max(x.segment(at, n).norm(), 0.5 * d_.model.effects[model_.effects[e]].scale) * largest_share;
      share = std::min(share, size / std::max(change.segment(at, n).norm(), 1e-12 * size));
      at += n;
    }
    Vector to = x + share * change;
    at = model_.u.size();
    for (std::size_t e = 0; e < model_.amplitudes.size(); ++e) {
      if (d_.model.effects[model_.effects[e]].one_sided) to[at] = std::max(to[at], 0.0);
      at += model_.amplitudes[e].size();
    }
    return to;
  }

  const StudyDiagnosis& d_;
  StudySimulator& simulator_;
  RealModel model_;
  std::size_t seeds_;
  Matrix secants_;
  Vector prior_;
  std::unique_ptr<infer::Metric> metric_;
};

double held_out_error(const infer::Observables& observables, const Vector& figures) {
  double sum = 0, count = 0;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const infer::Block& block = observables.blocks[b];
    const int first = observables.first(b);
    for (Eigen::Index k = 0; k < block.hold.size(); ++k) {
      sum += std::pow((block.hold[k] - figures[first + k]) / block.sd[k], 2);
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::vector<double> list_of(const Vector& v) { return {v.data(), v.data() + v.size()}; }

}  // namespace

RealFit fit_by_runs(const StudyDiagnosis& d, StudySimulator& simulator, const RealModel& start, int rounds, int seeds) {
  return FitByRuns(d, simulator, start, seeds).go(rounds);
}

infer::FitCheck check_runs(const StudyDiagnosis& d, const RealFit& fit, std::size_t seeds) {
  const infer::View& view = d.diagnosis.budget.both;
  const Matrix systematic = error_of_means(d, seeds) + fit.freedom * fit.freedom.transpose() +
                            infer::freedom_of(d.model, parts_of(d, fit.model), d.options).own;
  return infer::check_fit(d.model, d.bank, systematic, view.noise, view.y - fit.figures, d.options, 2);
}

double held_out_score(const StudyDiagnosis& d, const Vector& figures, std::size_t seeds) {
  const infer::View& hold = d.diagnosis.budget.hold;
  return -0.5 * infer::Metric(error_of_means(d, seeds) + hold.noise, hold.y - figures).residual().squaredNorm();
}

Confirmation confirm_by_runs(const StudyDiagnosis& d, StudySimulator& simulator, const RealModel& old,
                             const RealModel& extended, std::size_t seeds) {
  Confirmation c;
  c.done = true, c.seeds = seeds;
  const Vector before = simulator.run_settings(settings_of(d, old, confirmation_seeds, seeds), true).rowwise().mean();
  const Vector after =
      simulator.run_settings(settings_of(d, extended, confirmation_seeds, seeds), true).rowwise().mean();
  c.before = list_of(before), c.after = list_of(after);
  c.log_score = held_out_score(d, after, seeds) - held_out_score(d, before, seeds);
  const infer::Observables& all = d.model.observables;
  c.error_before = held_out_error(all, before), c.error_after = held_out_error(all, after);

  const infer::LinearModel& m = d.model;
  Vector foretold = m.base + m.sensitivities * (extended.u - m.u);
  const std::vector<infer::Part> parts = parts_of(d, extended);
  for (const infer::Part& part : parts) foretold += m.signatures[part.effect] * part.amplitude;
  const Matrix spread =
      m.scatter.covariance(all) * (1 / static_cast<double>(seeds) + m.base_weight + m.sensitivity_weight) +
      infer::freedom_of(m, parts, d.options).own;
  const double square = infer::Metric(spread, after - foretold).residual().squaredNorm();
  c.agreement = 0.5 * std::erfc(normal_score(square, after.size()) / std::sqrt(2.0));
  c.error_foretold = held_out_error(all, foretold);
  // Causes were weighed by the algebra alone: where it fails at the place that it chose, its choice may fail, too.
  c.contradicted = c.agreement < contradicted_below && c.error_after > c.error_foretold;

  // Half of what the algebra foretold is enough, since runs of a few seeds scatter.
  const double needed = std::min(d.options.gain_above, 0.5 * d.diagnosis.gain.log_score);
  c.passed = c.log_score >= needed && c.error_after <= (1 - least_improvement) * c.error_before;
  return c;
}

}  // namespace calx
