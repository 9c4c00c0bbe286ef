// calibrate.cpp: waves of runs, surrogates of their figures, draws from the posterior, checks of what came out.
// Waves follow history matching (Craig, Goldstein, Seheult and Smith 1997): each looks only where what is known so far
// does not rule the parameters out. Draws use the likelihood of Kennedy and O'Hagan (2001), J. R. Stat. Soc. B 63, with
// a tolerance in place of a discrepancy function.
#include "study/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/units.hpp"
#include "infer/design.hpp"
#include "infer/sampler.hpp"
#include "study/observe.hpp"
#include "study/surrogate.hpp"

namespace calx {
namespace {

/// Candidates of which the plausible share is counted.
constexpr std::size_t kCandidates = 2000;
/// The cut of history matching: beyond, a place is ruled out (three sigma rule of Pukelsheim 1994, Am. Stat. 48).
constexpr double kImplausible = 3;
/// New places are drawn from the posterior to the power 1 / this, twice as wide as the posterior itself.
constexpr double kTemperature = 4;
/// Waves end early when the emulators' own variance is below this share of all that is open: it then widens intervals
/// by 5 %, which more runs could take away at most.
constexpr double kEnough = 0.1;
/// Posterior sd over prior sd from which on a parameter counts as not told by the data, and |correlation| of two that
/// are told only together.
constexpr double kConfounded = 0.8;

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(v.begin(), v.end());
  const double at = share * static_cast<double>(v.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), v.size() - 1), next = std::min(k + 1, v.size() - 1);
  return v[k] + (at - static_cast<double>(k)) * (v[next] - v[k]);
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::vector<double> list_of(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

class Calibrator {
 public:
  Calibrator(const Study& study, Executor& executor, const ProgressSink& sink)
      : study_(study), executor_(executor), sink_(sink), d_(static_cast<Eigen::Index>(study.parameters.size())) {
    box_ = {Eigen::VectorXd::Zero(d_), Eigen::VectorXd::Ones(d_)};
    gaps_.resize(study.observables.size());
    for (const StudyCase& c : study.cases) {
      const auto asks = [&](const StudyObservable& o) { return o.case_name == c.name; };
      if (std::any_of(study.observables.begin(), study.observables.end(), asks)) cases_.push_back(&c);
      has_reduced_ = has_reduced_ || (!c.reduced.empty() && cases_.back() == &c);
    }
  }

  Calibration go() {
    if (d_ == 0) throw Error(Fault::settings, study_.file + " /parameters: is empty; at least one parameter is needed");
    const std::vector<std::size_t> plan = plan_waves();
    for (std::size_t w = 0; w < plan.size(); ++w) {
      if (plan[w] == 0) continue;
      const bool reduced = w == 0 && has_reduced_;
      stage_ = "wave " + std::to_string(w + 1) + (reduced ? " (reduced cases)" : "");
      say(stage_ + ": " + std::to_string(plan[w]) + " places of the parameters, budget " +
          std::to_string(study_.budget) + " runs in all");
      const std::size_t before = out_.runs.size();
      run_places(w == 0 ? latin_hypercube(plan[0], static_cast<std::size_t>(d_), study_.seed) : new_places(plan[w]),
                 reduced);
      learn(reduced, plan[w], out_.runs.size() - before);
      if (!reduced && w + 1 < plan.size() && enough()) {
        out_.notes.push_back(
            "the waves ended early: the emulators' own uncertainty is small beside that of the "
            "measurements");
        break;
      }
    }
    sample();
    predict();
    confirm();
    tell_gaps();
    return std::move(out_);
  }

 private:
  void say(const std::string& text) const {
    if (sink_.message) sink_.message(text);
  }

  /// Places of each wave, so that with the place that confirms the budget is kept.
  std::vector<std::size_t> plan_waves() const {
    const std::size_t each = cases_.size() * study_.seeds, d = study_.parameters.size(), least = d + 4;
    const std::size_t places = study_.budget / each;
    const std::size_t wanted = (has_reduced_ ? 2 : 1) * least + 1;
    if (places < wanted)
      throw Error(Fault::settings, study_.file + " /budget/runs: " + std::to_string(study_.budget) +
                                       " runs are too few; " + counted(cases_.size(), "case") + " with " +
                                       counted(study_.seeds, "seed") + " at " + std::to_string(wanted) +
                                       " places needs " + std::to_string(each * wanted));
    const std::size_t all = places - 1, first = std::max(least, all / 2), left = all - std::min(first, all);
    const std::size_t second = has_reduced_ ? std::max(least, (3 * left + 4) / 5) : (3 * left + 4) / 5;
    return {std::min(first, all), std::min(second, left), left - std::min(second, left)};
  }

  std::vector<double> values_of(const Eigen::VectorXd& u) const {
    std::vector<double> out;
    for (Eigen::Index k = 0; k < d_; ++k) {
      const StudyParameter& p = study_.parameters[static_cast<std::size_t>(k)];
      out.push_back(p.low + u(k) * (p.high - p.low));
    }
    return out;
  }

  void run_places(const Eigen::MatrixXd& places, bool reduced) {
    std::vector<RunRequest> requests;
    const std::size_t first_row = out_.runs.size();
    for (Eigen::Index k = 0; k < places.rows(); ++k) {
      const std::size_t number = places_.size() + static_cast<std::size_t>(k);
      const std::vector<double> values = values_of(places.row(k).transpose());
      for (const StudyCase* c : cases_)
        for (std::size_t r = 0; r < study_.seeds; ++r) {
          const bool small = reduced && !c->reduced.empty();
          RunRow row;
          row.seed = Random(study_.seed, 1000 + 64 * number + r).bits() >> 33;
          row.wave = out_.waves.size() + 1;
          row.place = number + 1;
          row.case_name = c->name;
          row.reduced = small;
          row.values = values;
          requests.push_back(request_for(study_, *c, values, row.seed, small));
          out_.runs.push_back(row);
        }
    }
    const std::size_t before = first_row;
    ProgressSink inner = sink_;
    inner.progress = [&](const StudyProgress& p) {
      if (!sink_.progress) return;
      StudyProgress all = p;
      all.done += before;
      all.total = std::max(study_.budget, before + p.total);
      all.text = stage_ + ", " + std::to_string(before) + " runs before it: " + p.text;
      sink_.progress(all);
    };
    const std::vector<RunResult> results = executor_.run(requests, inner);
    for (std::size_t k = 0; k < results.size(); ++k) {
      out_.runs[first_row + k].take(results[k]);
    }
    take_figures(places, reduced, first_row);
  }

  void take_figures(const Eigen::MatrixXd& places, bool reduced, std::size_t first_row) {
    std::size_t row = first_row;
    for (Eigen::Index k = 0; k < places.rows(); ++k) {
      PlaceRuns place;
      place.u = places.row(k).transpose();
      place.reduced = reduced;
      place.figures.resize(study_.observables.size());
      for (const StudyCase* c : cases_)
        for (std::size_t r = 0; r < study_.seeds; ++r, ++row) {
          if (!out_.runs[row].error.empty()) continue;
          for (std::size_t o = 0; o < study_.observables.size(); ++o) {
            if (study_.observables[o].case_name != c->name) continue;
            const std::vector<double> y = observe(out_.runs[row].folder, study_.observables[o]);
            const Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
            ++gaps_[o].asked;
            if (v.allFinite()) {
              place.figures[o].push_back(v);
            } else if (gaps_[o].missed++ == 0) {
              gaps_[o].why = why_not(out_.runs[row].folder, study_.observables[o]);
            }
          }
        }
      places_.push_back(std::make_unique<PlaceRuns>(std::move(place)));
    }
  }

  bool reduced_case(std::size_t o) const { return !case_of(study_, study_.observables[o].case_name).reduced.empty(); }

  /// Places whose runs tell the observable, of the reduced case or of the full one; inside of the box where enough are.
  std::vector<const PlaceRuns*> places_for(std::size_t o, bool reduced, UnitBox* box) const {
    std::vector<const PlaceRuns*> all, inside;
    for (const auto& p : places_) {
      if (p->figures[o].empty() || (reduced_case(o) && p->reduced != reduced)) continue;
      all.push_back(p.get());
      if (box->holds(p->u)) inside.push_back(p.get());
    }
    if (inside.size() >= 2 * static_cast<std::size_t>(d_ + 3)) return inside;
    *box = {Eigen::VectorXd::Zero(d_), Eigen::VectorXd::Ones(d_)};
    if (all.size() < static_cast<std::size_t>(d_) + 2) too_few(o, all.size());
    return all;
  }

  [[noreturn]] void too_few(std::size_t o, std::size_t count) const {
    std::string why = "the figure is not a number there: " + gaps_[o].why;
    for (const RunRow& r : out_.runs)
      if (!r.error.empty() && r.case_name == study_.observables[o].case_name) {
        why = "one run says: " + r.error;
        break;
      }
    throw Error(Fault::numerics, "observable \"" + study_.observables[o].name + "\": only " + std::to_string(count) +
                                     " of " + std::to_string(places_.size()) + " places gave it; " + why);
  }

  void build(bool reduced) {
    surrogates_.clear();
    targets_.clear();
    for (std::size_t o = 0; o < study_.observables.size(); ++o) {
      std::shared_ptr<const Surrogate> base;
      if (reduced_case(o)) {
        UnitBox all{Eigen::VectorXd::Zero(d_), Eigen::VectorXd::Ones(d_)};
        base = std::make_shared<Surrogate>(study_, o, places_for(o, true, &all), all, nullptr);
      }
      const StudyCase& c = case_of(study_, study_.observables[o].case_name);
      if (reduced && base) {
        surrogates_.push_back(base);
        targets_.push_back(target_of(study_.observables[o], c.reduced_tolerance));
        continue;
      }
      UnitBox box = box_;
      const auto places = places_for(o, false, &box);
      surrogates_.push_back(std::make_shared<Surrogate>(study_, o, places, box, base));
      targets_.push_back(target_of(study_.observables[o]));
    }
  }

  double log_prior(const Eigen::VectorXd& u) const {
    double out = 0;
    const std::vector<double> values = values_of(u);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const StudyParameter& p = study_.parameters[k];
      if (p.prior != StudyParameter::Prior::normal) continue;
      const double z = (values[k] - p.mean) / p.sd;
      out -= 0.5 * z * z;
    }
    return out;
  }

  static bool in_cube(const Eigen::VectorXd& u) { return (u.array() >= 0).all() && (u.array() <= 1).all(); }

  /// Log posterior and, on request, the largest implausibility.
  double log_posterior(const Eigen::VectorXd& u, double* implausibility = nullptr) const {
    if (!in_cube(u)) return -std::numeric_limits<double>::infinity();
    double out = log_prior(u);
    if (implausibility) *implausibility = 0;
    for (std::size_t o = 0; o < surrogates_.size(); ++o) {
      if (study_.observables[o].use != StudyObservable::Use::fit) continue;
      const Misfit m = misfit(targets_[o], surrogates_[o]->at(u));
      out += m.log_likelihood;
      if (implausibility) *implausibility = std::max(*implausibility, m.implausibility);
    }
    return out;
  }

  Samples draws(double temperature, const Eigen::MatrixXd& candidates, const std::vector<double>& log_density,
                const SamplerSettings& settings) const {
    const auto walkers = static_cast<std::size_t>(std::max<Eigen::Index>(24, 4 * d_ + 4));
    std::vector<std::size_t> order(log_density.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return log_density[a] > log_density[b]; });
    Eigen::MatrixXd start(static_cast<Eigen::Index>(walkers), d_);
    for (std::size_t k = 0; k < walkers; ++k)
      start.row(static_cast<Eigen::Index>(k)) = candidates.row(static_cast<Eigen::Index>(order[k]));
    return draw([&](const Eigen::VectorXd& u) { return log_posterior(u) / temperature; }, start, settings);
  }

  /// After a wave: surrogates, what is still plausible, and the box where the next wave looks.
  void learn(bool reduced, std::size_t places, std::size_t runs) {
    build(reduced);
    look();
    Wave wave;
    wave.places = places;
    wave.runs = runs;
    wave.reduced = reduced;
    std::size_t plausible = 0;
    Eigen::VectorXd low = Eigen::VectorXd::Ones(d_), high = Eigen::VectorXd::Zero(d_);
    for (std::size_t k = 0; k < implausibility_.size(); ++k) {
      if (implausibility_[k] >= kImplausible) continue;
      ++plausible;
      const Eigen::VectorXd u = candidates_.row(static_cast<Eigen::Index>(k)).transpose();
      low = low.cwiseMin(u);
      high = high.cwiseMax(u);
    }
    wave.plausible_share = static_cast<double>(plausible) / static_cast<double>(kCandidates);
    SamplerSettings settings;
    settings.steps = 200;
    settings.first = 100;
    settings.seed = study_.seed + 100 * (out_.waves.size() + 1);
    wide_ = draws(kTemperature, candidates_, log_density_, settings);
    const Eigen::VectorXd least = wide_.x.colwise().minCoeff().transpose(),
                          most = wide_.x.colwise().maxCoeff().transpose();
    if (plausible == 0) low = least, high = most;
    wave.low = values_of(low);
    wave.high = values_of(high);
    if (plausible == 0)
      out_.notes.push_back("after wave " + std::to_string(out_.waves.size() + 1) +
                           " no place of the ranges is plausible: the model misses the data everywhere, or a range "
                           "leaves the truth out");
    out_.waves.push_back(wave);
    const Eigen::VectorXd margin = 0.15 * (most - least).cwiseMax(0.05);
    box_ = {(least - margin).cwiseMax(0.0), (most + margin).cwiseMin(1.0)};
  }

  void look() {
    candidates_ = random_hypercube(kCandidates, static_cast<std::size_t>(d_), study_.seed + 7);
    log_density_.assign(kCandidates, 0);
    implausibility_.assign(kCandidates, 0);
    for (std::size_t k = 0; k < kCandidates; ++k)
      log_density_[k] = log_posterior(candidates_.row(static_cast<Eigen::Index>(k)).transpose(), &implausibility_[k]);
  }

  Eigen::MatrixXd new_places(std::size_t count) const {
    Eigen::MatrixXd taken(static_cast<Eigen::Index>(places_.size()), d_);
    for (std::size_t k = 0; k < places_.size(); ++k)
      taken.row(static_cast<Eigen::Index>(k)) = places_[k]->u.transpose();
    const Eigen::RowVectorXd mean = wide_.x.colwise().mean();
    const Eigen::VectorXd sd =
        ((wide_.x.rowwise() - mean).array().square().colwise().mean().sqrt()).transpose().cwiseMax(1e-6);
    const std::vector<std::size_t> chosen = spread_out(wide_.x, taken, count, sd);
    Eigen::MatrixXd out(static_cast<Eigen::Index>(chosen.size()), d_);
    for (std::size_t k = 0; k < chosen.size(); ++k)
      out.row(static_cast<Eigen::Index>(k)) = wide_.x.row(static_cast<Eigen::Index>(chosen[k]));
    return out;
  }

  /// Share of the emulator in what is open about an observable, over the places in draws.
  double emulator_share(std::size_t o, const Eigen::MatrixXd& draws_) const {
    double sum = 0;
    const Eigen::Index step = std::max<Eigen::Index>(1, draws_.rows() / 100);
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < draws_.rows(); k += step, ++count)
      sum += surrogates_[o]->at(draws_.row(k).transpose()).covariance.trace();
    const double own = sum / static_cast<double>(count);
    return own / (own + targets_[o].covariance.trace());
  }

  bool enough() const {
    // The likelier half of the wide draws lies about where the posterior does.
    const double median = quantile(list_of(wide_.log_density), 0.5);
    Eigen::MatrixXd core(wide_.x.rows(), d_);
    Eigen::Index kept = 0;
    for (Eigen::Index k = 0; k < wide_.x.rows(); ++k)
      if (wide_.log_density(k) >= median) core.row(kept++) = wide_.x.row(k);
    core.conservativeResize(kept, d_);
    for (std::size_t o = 0; o < surrogates_.size(); ++o)
      if (study_.observables[o].use == StudyObservable::Use::fit && emulator_share(o, core) > kEnough) return false;
    return true;
  }

  void sample() {
    build(false);
    look();
    SamplerSettings settings;
    settings.steps = 1300;
    settings.first = 300;
    settings.seed = study_.seed;
    const Samples s = draws(1, candidates_, log_density_, settings);
    unit_samples_ = s.x;
    out_.log_density = s.log_density;
    out_.acceptance = s.acceptance;
    out_.effective = s.effective;
    out_.samples.resize(s.x.rows(), d_);
    for (Eigen::Index k = 0; k < s.x.rows(); ++k) {
      const std::vector<double> v = values_of(s.x.row(k).transpose());
      for (Eigen::Index j = 0; j < d_; ++j) out_.samples(k, j) = v[static_cast<std::size_t>(j)];
    }
    // Rule of thumb for the error of a 5 % quantile to stay below a tenth of the spread.
    if (s.effective < 200)
      out_.notes.push_back("the draws are worth " + format_number(std::round(s.effective)) +
                           " independent ones only; the tails of the posterior are rough");
    summarise();
  }

  double prior_sd(const StudyParameter& p) const {
    const double width = p.high - p.low;
    if (p.prior == StudyParameter::Prior::uniform) return width / std::sqrt(12.0);
    // The normal prior is cut off at the range.
    double sum = 0, first = 0, second = 0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
      const double v = p.low + width * (k + 0.5) / kSteps, z = (v - p.mean) / p.sd, w = std::exp(-0.5 * z * z);
      sum += w, first += w * v, second += w * v * v;
    }
    return std::sqrt(std::max(second / sum - first / sum * (first / sum), 0.0));
  }

  void summarise() {
    const Eigen::RowVectorXd mean = out_.samples.colwise().mean();
    const Eigen::MatrixXd centred = out_.samples.rowwise() - mean;
    const Eigen::MatrixXd covariance = centred.transpose() * centred / static_cast<double>(centred.rows() - 1);
    out_.correlation.resize(d_, d_);
    for (Eigen::Index k = 0; k < d_; ++k) {
      Posterior p;
      const std::vector<double> v = list_of(out_.samples.col(k));
      p.mean = mean(k);
      p.sd = std::sqrt(covariance(k, k));
      p.q05 = quantile(v, 0.05);
      p.q50 = quantile(v, 0.5);
      p.q95 = quantile(v, 0.95);
      p.prior_sd = prior_sd(study_.parameters[static_cast<std::size_t>(k)]);
      p.identifiability = p.sd / p.prior_sd;
      out_.parameters.push_back(p);
      for (Eigen::Index j = 0; j < d_; ++j) {
        const double size = std::sqrt(covariance(k, k) * covariance(j, j));
        out_.correlation(k, j) = k == j || !(size > 0) ? (k == j ? 1 : 0) : covariance(k, j) / size;
        if (j < k && std::fabs(out_.correlation(k, j)) > kConfounded)
          out_.confounded.push_back({static_cast<std::size_t>(j), static_cast<std::size_t>(k), out_.correlation(k, j)});
      }
    }
  }

  void predict() {
    Random random(study_.seed, 0x505245);
    constexpr Eigen::Index kDraws = 400;
    const Eigen::Index step = std::max<Eigen::Index>(1, unit_samples_.rows() / kDraws);
    for (std::size_t o = 0; o < surrogates_.size(); ++o) {
      const Eigen::Index m = targets_[o].y.size();
      std::vector<std::vector<double>> drawn(static_cast<std::size_t>(m));
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(m);
      Eigen::MatrixXd square = Eigen::MatrixXd::Zero(m, m), own = square;
      double count = 0;
      for (Eigen::Index k = 0; k < unit_samples_.rows(); k += step, ++count) {
        const Figures f = surrogates_[o]->at(unit_samples_.row(k).transpose());
        sum += f.mean;
        square += f.mean * f.mean.transpose();
        own += f.covariance;
        for (Eigen::Index j = 0; j < m; ++j)
          drawn[static_cast<std::size_t>(j)].push_back(f.mean(j) + std::sqrt(f.covariance(j, j)) * random.normal());
      }
      PredictiveCheck check;
      const Eigen::VectorXd mean = sum / count;
      const Eigen::MatrixXd covariance = square / count - mean * mean.transpose() + own / count;
      for (Eigen::Index j = 0; j < m; ++j) {
        check.mean.push_back(mean(j));
        check.sd.push_back(std::sqrt(std::max(covariance(j, j), 0.0)));
        check.q05.push_back(quantile(drawn[static_cast<std::size_t>(j)], 0.05));
        check.q95.push_back(quantile(drawn[static_cast<std::size_t>(j)], 0.95));
      }
      const Misfit far = misfit(targets_[o], {mean, covariance});
      const double sign = (targets_[o].y - mean).mean() < 0 ? -1 : 1;
      check.z = m == 1 ? sign * far.implausibility : far.implausibility;
      check.agrees = far.implausibility < 2;
      out_.observables.push_back(check);
      out_.emulators.push_back(check_emulator(o));
    }
  }

  EmulatorCheck check_emulator(std::size_t o) const {
    const Surrogate& s = *surrogates_[o];
    EmulatorCheck out;
    out.components = s.emulators().size();
    double sum = 0, count = 0;
    for (std::size_t c = 0; c < s.emulators().size(); ++c) {
      const Emulator& e = s.emulators()[c];
      const std::vector<Estimate> left_out = e.leave_one_out();
      // A scalar is shown as itself, a curve by its first component.
      const double shift = targets_[o].y.size() == 1 ? s.basis().mean(0) : 0;
      for (std::size_t k = 0; k < left_out.size(); ++k) {
        const double seen = e.places_mean()(static_cast<Eigen::Index>(k)), sd = std::sqrt(left_out[k].variance);
        const double r = (seen - left_out[k].mean) / sd;
        sum += r * r;
        ++count;
        if (c > 0) continue;
        out.seen.push_back(seen + shift);
        out.predicted.push_back(left_out[k].mean + shift);
        out.sd.push_back(sd);
      }
      if (c == 0) out.noise_sd = e.noise_sd();
    }
    out.mean_square = sum / count;
    out.share = emulator_share(o, unit_samples_);
    return out;
  }

  /// Runs without a figure leave the emulator blind where they lie, which is seldom by chance.
  void tell_gaps() {
    for (std::size_t o = 0; o < gaps_.size(); ++o) {
      if (gaps_[o].missed == 0) continue;
      out_.notes.push_back("observable \"" + study_.observables[o].name + "\": " + std::to_string(gaps_[o].missed) +
                           " of " + counted(gaps_[o].asked, "run") +
                           " gave no number and are left out; the first: " + gaps_[o].why);
    }
  }

  /// The cases themselves at the posterior mean, with seeds that no emulator has seen.
  void confirm() {
    stage_ = "confirmation at the posterior mean";
    say(stage_);
    Eigen::MatrixXd place(1, d_);
    for (Eigen::Index k = 0; k < d_; ++k) {
      const StudyParameter& p = study_.parameters[static_cast<std::size_t>(k)];
      place(0, k) = (out_.parameters[static_cast<std::size_t>(k)].mean - p.low) / (p.high - p.low);
    }
    run_places(place, false);
    for (std::size_t o = 0; o < study_.observables.size(); ++o) {
      const auto& runs = places_.back()->figures[o];
      PredictiveCheck& check = out_.observables[o];
      if (runs.empty()) {
        out_.notes.push_back("observable \"" + study_.observables[o].name + "\": no run at the posterior mean gave it");
        continue;
      }
      const auto n = static_cast<double>(runs.size());
      bool differs = false;
      for (Eigen::Index j = 0; j < runs[0].size(); ++j) {
        double mean = 0, square = 0;
        for (const Eigen::VectorXd& r : runs) mean += r(j) / n;
        for (const Eigen::VectorXd& r : runs) square += (r(j) - mean) * (r(j) - mean);
        // With two or three runs their own scatter is a guess; the emulator knows that of all places.
        const double scatter =
            runs[0].size() == 1 ? out_.emulators[o].noise_sd : std::sqrt(square / std::max(n - 1, 1.0));
        check.confirmed.push_back(mean);
        check.confirmed_sd.push_back(scatter / std::sqrt(n));
        const auto k = static_cast<std::size_t>(j);
        differs = differs || std::fabs(mean - check.mean[k]) > 4 * std::hypot(check.sd[k], check.confirmed_sd[k]);
      }
      if (differs)
        out_.notes.push_back("observable \"" + study_.observables[o].name +
                             "\": runs at the posterior mean differ from what was predicted; the emulator is not good "
                             "enough there, give the study more runs");
    }
  }

  const Study& study_;
  Executor& executor_;
  const ProgressSink& sink_;
  const Eigen::Index d_;
  std::vector<const StudyCase*> cases_;  // those that observables ask for
  bool has_reduced_ = false;
  std::string stage_;  // for progress
  UnitBox box_;
  std::vector<std::unique_ptr<PlaceRuns>> places_;
  std::vector<std::shared_ptr<const Surrogate>> surrogates_;
  std::vector<Target> targets_;
  Eigen::MatrixXd candidates_, unit_samples_;
  std::vector<double> log_density_, implausibility_;
  Samples wide_;
  /// Finished runs that were asked for an observable, and those that gave no number.
  struct Gaps {
    std::size_t asked = 0, missed = 0;
    std::string why;  // of the first
  };
  std::vector<Gaps> gaps_;
  Calibration out_;
};

}  // namespace

Calibration calibrate(const Study& study, Executor& executor, const ProgressSink& sink) {
  return Calibrator(study, executor, sink).go();
}

}  // namespace calx
