#include "study/next_measurements.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/column_name.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "config/document.hpp"
#include "config/node.hpp"
#include "infer/denoise.hpp"
#include "plugin/effects.hpp"
#include "study/case_check.hpp"
#include "study/measured.hpp"
#include "study/observe.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

/// Effects below this probability are not run for a measurement that was not made.
constexpr double least_probability = 0.01;

void read_known_load(Object& o, const Node& node, const Study& study, PossibleMeasurement& m) {
  m.is_known_load = true;
  Object load(node, "a known load");
  std::vector<std::string> sensors;
  for (const StudyObservable& b : study.observables) sensors.push_back(b.sensor);
  m.sensor = load.need("sensor", "the sensor that shows it").name_of("sensor of an observable", sensors);
  const Node time = load.need("time_s", "times of the load"),
             value = load.need("value", "the load, SI, at these times");
  m.time = read_numbers(time, "s"), m.load = read_numbers(value, "1");
  need_rising(time, m.time);
  if (m.time.size() < 2) time.fail("must hold two times at least");
  if (m.load.size() != m.time.size()) value.fail("must hold one value per time");
  load.done();
  const Node at = o.need("at", "times at which the sensor is read, s");
  m.at = read_numbers(at, "s");
  need_rising(at, m.at);
  for (const double t : m.at)
    if (t < m.time.front() || t > m.time.back()) at.fail(format_number(t) + " s is outside of the load's times");
  m.reading.unit = "1";
}

void read_case_reading(Object& o, const Study& study, PossibleMeasurement& m) {
  StudyObservable& r = m.reading;
  r.name = m.name, r.kind = "other";
  read_reading(o, study.cases, r);
  if (r.against.empty()) return;
  const Node at = o.need("at", "the places of the numbers");
  const std::string x_unit = split_column(r.against).unit;
  r.measured.x = read_numbers(at, x_unit.empty() ? "1" : x_unit);
  need_rising(at, r.measured.x);
  if (r.measured.x.empty()) at.fail("is empty; at least one place is needed");
}

/// Prediction of a measurement near where the model is linear.
class Foretelling {
 public:
  Foretelling(const Study& study, StudyDiagnosis& d, Executor& executor, const ProgressSink& sink)
      : study_(study), d_(d), executor_(executor), sink_(sink) {}

  infer::Experiment known_load(const PossibleMeasurement& m) const {
    infer::Experiment e = blank(m, m.at.size());
    for (std::size_t k = 0; k < m.at.size(); ++k)
      e.base[static_cast<Eigen::Index>(k)] = passing(m.time, m.load, m.at[k]);
    PluginRegistry registry(plugin_search_path(study_.executor.plugin_path));
    for (std::size_t k = 0; k < d_.kept.size(); ++k) {
      const Candidate& c = d_.library.candidates[d_.kept[k]];
      if (!c.info.is_instrument || !acts_on(c, m.sensor)) continue;
      const double step = d_.options.step_scales * c.effect.scale;
      for (int i = 0; i < c.effect.components; ++i) {
        const Vector amplitude = step * Vector::Unit(c.effect.components, i);
        const std::vector<double> shown =
            apply_instruments(registry, instruments_of(c.info, c.settings(amplitude)), m.time, m.load);
        for (std::size_t p = 0; p < m.at.size(); ++p)
          e.signatures[k](static_cast<Eigen::Index>(p), i) =
              (passing(m.time, shown, m.at[p]) - e.base[static_cast<Eigen::Index>(p)]) / step;
      }
    }
    return e;
  }

  /// left_for_effects: runs with effects that the budget still pays for; the likelier causes come first. Throws
  /// Error(Fault::numerics) where the case does not give the numbers.
  infer::Experiment of_case(const PossibleMeasurement& m, std::size_t left_for_effects) {
    const std::size_t n = std::max<std::size_t>(1, m.reading.measured.x.size());
    infer::Experiment e = blank(m, n);
    StudySimulator simulator(study_, {m.reading}, d_.library, executor_, sink_, d_.ledger);
    simulator.effects = d_.kept;
    const infer::Options& options = d_.options;
    // The points of the model's own runs, so that what the case recorded already is read again, not run.
    const auto seeds = d_.model.base_columns.cols();
    std::vector<infer::RunPoint> base;
    for (Eigen::Index k = 0; k < seeds; ++k)
      base.push_back({d_.model.u, -1, {}, d_.model.base_seed + static_cast<std::uint64_t>(k)});
    const Matrix runs = simulator.run(base);
    infer::Observables one;
    infer::Block block;
    block.name = m.name, block.sd = e.sd, block.x = n == 1 ? Vector(Vector::Zero(1)) : vector_of(m.reading.measured.x);
    block.fit = runs.rowwise().mean();
    one.blocks = {block};
    infer::LinearModel local;
    local.observables = one;
    local.base = block.fit;
    local.base_weight = 1.0 / static_cast<double>(seeds);
    local.scatter = infer::estimate_scatter(one, {runs});
    local.common_numbers = d_.model.common_numbers;
    const infer::Denoiser denoise(one, local.scatter);
    const std::uint64_t common = options.seed * 1000;

    std::vector<infer::RunPoint> points;
    const int p = simulator.parameters();
    for (int k = 0; k < p; ++k)
      for (const double sign : {1.0, -1.0})
        points.push_back({sign * simulator.step(k) * Vector::Unit(p, k), -1, {}, common});
    if (p > 0) {
      const Matrix sides = simulator.run(points);
      for (int k = 0; k < p; ++k)
        e.sensitivities.col(k) = denoise((sides.col(2 * k) - sides.col(2 * k + 1)) / (2 * simulator.step(k)),
                                         (1 - local.common_numbers) / (2 * std::pow(simulator.step(k), 2)));
    }
    points = {{d_.model.u, -1, {}, common}};
    std::vector<std::pair<std::size_t, int>> owner;
    std::vector<std::size_t> order(d_.kept.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::vector<double>& probable = d_.diagnosis.posterior.inclusion;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return probable[x] > probable[y]; });
    for (const std::size_t k : order) {
      const Candidate& c = d_.library.candidates[d_.kept[k]];
      const double step = options.step_scales * c.effect.scale;
      for (int i = 0; i < c.effect.components; ++i) {
        const infer::RunPoint point{d_.model.u, static_cast<int>(k), step * Vector::Unit(c.effect.components, i),
                                    common};
        if (c.info.is_instrument)
          e.signatures[k].col(i) = simulator.instrument(point) / step;
        else if (probable[k] >= least_probability && points.size() <= left_for_effects)
          points.push_back(point), owner.emplace_back(k, i);
      }
    }
    const Matrix changed = simulator.run(points);
    local.partner = local.common_run = changed.col(0);
    for (std::size_t k = 0; k < owner.size(); ++k) {
      const double step = options.step_scales * d_.model.effects[owner[k].first].scale;
      if (!changed.col(static_cast<Eigen::Index>(k) + 1).allFinite()) continue;
      e.signatures[owner[k].first].col(owner[k].second) =
          denoise(local.response(changed.col(static_cast<Eigen::Index>(k) + 1)), local.response_variance()) / step;
    }
    e.base = local.base;
    // The base of a few runs is known no better than this.
    e.tolerance = (e.tolerance.cwiseAbs2() + local.base_weight * local.scatter.covariance(one).diagonal()).cwiseSqrt();
    return e;
  }

 private:
  infer::Experiment blank(const PossibleMeasurement& m, std::size_t size) const {
    const auto n = static_cast<Eigen::Index>(size);
    infer::Experiment e;
    e.name = m.name, e.cost = m.cost;
    e.sd = m.sd.size() == 1 ? Vector(Vector::Constant(n, m.sd[0])) : vector_of(m.sd);
    e.tolerance =
        m.tolerance.empty() ? Vector(d_.options.tolerance * e.sd) : Vector(Vector::Constant(n, m.tolerance[0]));
    e.base = Vector::Zero(n);
    e.sensitivities = Matrix::Zero(n, d_.model.u.size());
    for (const infer::Effect& effect : d_.model.effects) e.signatures.push_back(Matrix::Zero(n, effect.components));
    return e;
  }

  static bool acts_on(const Candidate& c, const std::string& sensor) {
    for (std::size_t k = 0; k < c.cases.size(); ++k)
      for (const auto& bound : c.bound[k])
        if (c.cases[k] && bound.second == sensor) return true;
    return false;
  }

  const Study& study_;
  StudyDiagnosis& d_;
  Executor& executor_;
  const ProgressSink& sink_;
};

}  // namespace

std::vector<PossibleMeasurement> read_experiments(const Study& study) {
  Document document(Parameters{study.experiments, "/experiments", study.folder}, study.file);
  std::vector<PossibleMeasurement> out;
  for (const Node& node : Node(document, document.root(), "/experiments").items("measurements that could be made")) {
    Object o(node, "a measurement that could be made");
    PossibleMeasurement m;
    m.name = o.need("name", "what would be measured").text("a name");
    m.cost = o.number("cost", "1", 1, Allow::above_zero);
    const auto load = o.find("known_load");
    if (load)
      read_known_load(o, *load, study, m);
    else
      read_case_reading(o, study, m);
    const Node sd = o.need("sd", "of one number of the measurement");
    m.sd = sd.json().is_array() ? read_numbers(sd, m.reading.unit)
                                : std::vector<double>{sd.number(m.reading.unit, Allow::above_zero)};
    const std::size_t n = load ? m.at.size() : std::max<std::size_t>(1, m.reading.measured.x.size());
    if (m.sd.size() != 1 && m.sd.size() != n) sd.fail("must be one number or one per place");
    for (const double s : m.sd)
      if (!(s > 0)) sd.fail("must be above 0");
    if (const auto t = o.find("tolerance")) m.tolerance = {t->number(m.reading.unit, Allow::not_negative)};
    o.done();
    if (!load) check_reading(study, m.reading, node.pointer());
    out.push_back(m);
  }
  return out;
}

std::vector<NextMeasurement> weigh_measurements(const Study& study, const std::vector<PossibleMeasurement>& possible,
                                                StudyDiagnosis& d, Executor& executor, const ProgressSink& sink) {
  if (sink.message) sink.message("weighing " + std::to_string(possible.size()) + " measurements that could be made");
  Foretelling foretelling(study, d, executor, sink);
  std::vector<infer::Experiment> experiments;
  for (const PossibleMeasurement& m : possible) try {
      if (m.is_known_load) {
        experiments.push_back(foretelling.known_load(m));
        continue;
      }
      const bool is_read = std::any_of(d.measured.readings.begin(), d.measured.readings.end(),
                                       [&](const StudyObservable& o) { return o.case_name == m.reading.case_name; });
      // A case that gave data has its runs without effects already.
      const std::size_t own =
          is_read ? 0 : 1 + static_cast<std::size_t>(d.model.base_columns.cols()) + 2 * study.parameters.size();
      if (d.ledger.runs.size() + own > study.budget)
        d.notes.push_back("measurement \"" + m.name + "\" was not weighed: the budget leaves no runs for its case");
      else
        experiments.push_back(foretelling.of_case(m, study.budget - d.ledger.runs.size() - own));
    } catch (const Error& e) {
      // What was found so far is worth more than one measurement that cannot be foretold.
      if (e.fault() != Fault::numerics) throw;
      d.notes.push_back("measurement \"" + m.name + "\" was not weighed: " + e.what());
    }
  std::vector<NextMeasurement> out;
  for (const infer::Proposal& p : infer::propose(d.model, d.diagnosis, experiments, d.options))
    out.push_back({experiments[p.experiment].name, experiments[p.experiment].cost, p.information, p.clear_verdict});
  // What is told per unit of cost decides which comes first.
  std::stable_sort(out.begin(), out.end(), [](const NextMeasurement& a, const NextMeasurement& b) {
    return a.information / a.cost > b.information / b.cost;
  });
  return out;
}

}  // namespace calx
