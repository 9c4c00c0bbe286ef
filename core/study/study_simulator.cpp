#include "study/study_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/units.hpp"
#include "io/io.hpp"
#include "plugin/effects.hpp"
#include "study/case_check.hpp"
#include "study/measured_blocks.hpp"
#include "study/observe.hpp"
#include "study/table.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

/// Beyond so many sd from zero a number is carried by a factor.
constexpr double away_from_zero = 8;

std::string text_of(const RunRequest& r) {
  std::string out = r.case_path + " " + std::to_string(r.seed);
  for (const auto& o : r.overrides) out += " " + o.first + "=" + o.second;
  return out;
}

}  // namespace

StudySimulator::StudySimulator(const Study& study, std::vector<StudyObservable> readings, const Library& library,
                               Executor& executor, const ProgressSink& sink, RunLedger& ledger)
    : study_(study),
      readings_(std::move(readings)),
      library_(library),
      executor_(executor),
      sink_(sink),
      ledger_(ledger) {
  for (const StudyObservable& o : readings_) {
    const int size = o.against.empty() ? 1 : static_cast<int>(o.measured.x.size());
    std::size_t number = 0;
    while (study.cases[number].name != o.case_name) ++number;
    blocks_.push_back({rows_, size, number});
    rows_ += size;
  }
  factor_ = Vector::Ones(rows_), shift_ = Vector::Zero(rows_);
  for (std::size_t c = 0; c < library.candidates.size(); ++c) effects.push_back(c);
}

double StudySimulator::step(int parameter) const {
  // A fifth of the range to either side, at most three prior sd, so that the difference stands out of the scatter of
  // two runs, and not beyond the range.
  const StudyParameter& p = study_.parameters[static_cast<std::size_t>(parameter)];
  const double sd = prior_sd(p), mean = prior_mean(p);
  const double room = std::max(0.1 * sd, std::min(mean - p.low, p.high - mean)) / sd;
  return std::min(std::clamp(0.2 * (p.high - p.low) / sd, 1.0, 3.0), room);
}

std::vector<double> StudySimulator::values(const Vector& u) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < study_.parameters.size(); ++k)
    out.push_back(parameter_value(study_.parameters[k], u[static_cast<Eigen::Index>(k)]));
  return out;
}

bool StudySimulator::uses(std::size_t case_number) const {
  return std::any_of(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.case_number == case_number; });
}

std::vector<std::vector<RunResult>> StudySimulator::execute(const std::vector<Setting>& settings, bool full) {
  std::vector<RunRequest> requests;
  std::vector<DosedRun> rows;
  for (const Setting& s : settings) {
    std::vector<Dose> doses;
    std::string words;
    for (const auto& d : s.doses) {
      const Candidate& c = library_.candidates[d.first];
      doses.push_back({&c, d.second});
      words += (words.empty() ? "" : ", ") + c.effect.id + " " + brief_quantity(c.value(d.second), c.unit);
    }
    const std::vector<double> at = values(s.u);
    for (std::size_t k = 0; k < study_.cases.size(); ++k) {
      if (!uses(k)) continue;
      const bool reduced = !full && !study_.cases[k].reduced.empty();
      requests.push_back(dosed_request(study_, k, at, s.seed, doses, reduced));
      DosedRun row;
      row.stage = ledger_.stage, row.case_name = study_.cases[k].name, row.seed = s.seed, row.reduced = reduced;
      row.values = at, row.doses = words;
      rows.push_back(row);
    }
  }
  ProgressSink inner = sink_;
  const std::size_t before = ledger_.runs.size();
  inner.progress = [&](const StudyProgress& p) {
    if (!sink_.progress) return;
    StudyProgress all = p;
    all.done += before;
    all.total = std::max(ledger_.planned, before + p.total);
    all.text = ledger_.stage + ": " + p.text;
    sink_.progress(all);
  };
  const std::vector<RunResult> results = executor_.run(requests, inner);
  const std::size_t per_setting = settings.empty() ? 0 : requests.size() / settings.size();
  std::vector<std::vector<RunResult>> out(settings.size());
  for (std::size_t k = 0; k < results.size(); ++k) {
    out[k / per_setting].push_back(results[k]);
    if (!ledger_.known.insert(text_of(requests[k])).second) continue;
    rows[k].take(results[k]);
    ledger_.runs.push_back(rows[k]);
  }
  return out;
}

Vector StudySimulator::read(const std::vector<RunResult>& runs) const {
  Vector figures = Vector::Constant(rows_, std::nan(""));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < blocks_[b].case_number; ++k) at += uses(k) ? 1 : 0;
    if (!runs[at].error.empty()) continue;
    figures.segment(blocks_[b].first, blocks_[b].size) = vector_of(observe(runs[at].folder, readings_[b]));
  }
  return figures;
}

Vector StudySimulator::carried(const Vector& figures) const { return factor_.cwiseProduct(figures) + shift_; }

std::string StudySimulator::trouble(const std::vector<RunResult>& runs, const Vector& figures) const {
  for (const RunResult& r : runs)
    if (!r.error.empty()) return r.error;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int k = 0; k < blocks_[b].size; ++k)
      if (!std::isfinite(figures[blocks_[b].first + k])) {
        const StudyObservable& o = readings_[b];
        return "sensor \"" + o.sensor + "\" of case \"" + o.case_name + "\" gives no \"" + o.column + "\"" +
               (o.against.empty()
                    ? std::string()
                    : " at " + o.against + " = " + format_number(o.measured.x[static_cast<std::size_t>(k)])) +
               ", which observable \"" + o.name + "\" needs; does the run reach that far?";
      }
  return "";
}

Matrix StudySimulator::run_settings(const std::vector<Setting>& settings, bool full) {
  const auto runs = execute(settings, full);
  Matrix out(rows_, static_cast<Eigen::Index>(settings.size()));
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const Vector figures = read(runs[k]);
    const std::string why = trouble(runs[k], figures);
    if (!why.empty()) throw Error(Fault::numerics, ledger_.stage + ": " + why);
    // Numbers of another program stay the reference; those of the full case need no carrying.
    const bool plain = full && std::all_of(readings_.begin(), readings_.end(),
                                           [](const StudyObservable& o) { return o.simulated.empty(); });
    out.col(static_cast<Eigen::Index>(k)) = plain ? figures : carried(figures);
  }
  return out;
}

Matrix StudySimulator::run(const std::vector<infer::RunPoint>& points) {
  std::vector<Setting> settings;
  for (const infer::RunPoint& p : points) {
    settings.push_back({p.u, {}, p.seed});
    if (p.effect >= 0) settings.back().doses.emplace_back(effects[static_cast<std::size_t>(p.effect)], p.amplitude);
  }
  const auto has_effect = [](const infer::RunPoint& p) { return p.effect >= 0; };
  ledger_.stage = std::all_of(points.begin(), points.end(), has_effect)   ? stage_of_effects
                  : std::any_of(points.begin(), points.end(), has_effect) ? "signatures of the effects"
                                                                          : "base and sensitivities";
  Matrix out = Matrix::Constant(rows_, static_cast<Eigen::Index>(points.size()), std::nan(""));
  std::vector<Setting> possible;
  std::vector<std::size_t> place;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string why = settings[k].doses.empty() ? "" : refusal(settings[k]);
    if (why.empty())
      possible.push_back(settings[k]), place.push_back(k);
    else
      failures_.emplace(settings[k].doses[0].first, why);
  }
  const auto runs = execute(possible, false);
  for (std::size_t k = 0; k < possible.size(); ++k) {
    const Vector figures = read(runs[k]);
    const std::string why = trouble(runs[k], figures);
    if (why.empty())
      out.col(static_cast<Eigen::Index>(place[k])) = carried(figures);
    else if (possible[k].doses.empty())
      throw Error(Fault::numerics, ledger_.stage + ": a run without any effect failed: " + why);
    else
      failures_.emplace(possible[k].doses[0].first, why);
  }
  return out;
}

std::string StudySimulator::refusal(const Setting& setting) const {
  const Candidate& c = library_.candidates[setting.doses[0].first];
  const Vector& amplitude = setting.doses[0].second;
  if (!c.allows(amplitude))
    return c.parameter + " would have to lie outside of its range, " + format_number(c.lowest) + " to " +
           brief_quantity(c.highest, c.unit);
  for (std::size_t k = 0; k < study_.cases.size(); ++k) {
    if (!c.cases[k] || !uses(k)) continue;
    try {
      try_run(dosed_request(study_, k, values(setting.u), setting.seed, {{&c, amplitude}},
                            !study_.cases[k].reduced.empty()),
              study_.executor.plugin_path);
    } catch (const Error& e) {
      if (e.fault() == Fault::files || e.fault() == Fault::interrupted) throw;
      return e.what();
    }
  }
  return "";
}

Vector StudySimulator::instrument(const infer::RunPoint& point) {
  const Candidate& c = library_.candidates[effects[static_cast<std::size_t>(point.effect)]];
  const std::vector<RunResult> runs = execute({{point.u, {}, point.seed}}, false)[0];
  const std::vector<InstrumentUse> uses_of = instruments_of(c.info, c.settings(point.amplitude));
  PluginRegistry registry(plugin_search_path(study_.executor.plugin_path));
  Vector change = Vector::Zero(rows_);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const StudyObservable& o = readings_[b];
    const auto& bound = c.bound[blocks_[b].case_number];
    const bool meant = std::any_of(c.info.roles.begin(), c.info.roles.end(), [&](const EffectRole& r) {
      const auto name = bound.find(r.name);
      return r.kind == "sensor" && name != bound.end() && name->second == o.sensor;
    });
    if (!c.cases[blocks_[b].case_number] || !meant) continue;
    std::size_t at = 0;
    for (std::size_t k = 0; k < blocks_[b].case_number; ++k) at += uses(k) ? 1 : 0;
    const std::string path = runs[at].folder + "/series/" + o.sensor + ".csv";
    const Table table = parse_table(read_text(path), path);
    // Instruments act on the first column of a sensor.
    if (table.columns.size() < 2 || table.columns[1] != o.column) continue;
    std::vector<double> time, value;
    for (const auto& row : table.rows) time.push_back(row[0]), value.push_back(row[1]);
    const std::vector<double> shown = apply_instruments(registry, uses_of, time, value);
    const std::vector<double> places = o.against.empty() ? std::vector<double>{time.back()} : o.measured.x;
    for (std::size_t k = 0; k < places.size(); ++k)
      change[blocks_[b].first + static_cast<int>(k)] =
          o.factor * (passing(time, shown, places[k]) - passing(time, value, places[k]));
  }
  return factor_.cwiseProduct(change);
}

Vector StudySimulator::anchor(const std::vector<std::uint64_t>& seeds, const Vector& sd) {
  const bool reduced = std::any_of(blocks_.begin(), blocks_.end(),
                                   [&](const Block& b) { return !study_.cases[b.case_number].reduced.empty(); });
  const bool foreign =
      std::any_of(readings_.begin(), readings_.end(), [](const StudyObservable& o) { return !o.simulated.empty(); });
  if (!reduced && !foreign) return Vector::Zero(rows_);
  std::vector<Setting> settings;
  for (const std::uint64_t seed : seeds) settings.push_back({Vector::Zero(parameters()), {}, seed});
  const auto figures_of = [&](bool full) {
    const auto runs = execute(settings, full);
    Matrix out(rows_, static_cast<Eigen::Index>(runs.size()));
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const Vector figures = read(runs[k]);
      const std::string why = trouble(runs[k], figures);
      if (!why.empty()) throw Error(Fault::numerics, ledger_.stage + ": " + why);
      out.col(static_cast<Eigen::Index>(k)) = figures;
    }
    return out;
  };
  const Matrix small = figures_of(false), large = reduced ? figures_of(true) : small;
  const Vector from = small.rowwise().mean();
  Vector to = large.rowwise().mean();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!readings_[b].simulated.empty())
      to.segment(blocks_[b].first, blocks_[b].size) = vector_of(readings_[b].simulated);
  for (int k = 0; k < rows_; ++k) {
    const double least = away_from_zero * sd[k];
    if (from[k] * to[k] > 0 && std::fabs(from[k]) > least && std::fabs(to[k]) > least)
      factor_[k] = to[k] / from[k];
    else
      shift_[k] = to[k] - from[k];
  }
  // Both means scatter, and what the reduced case is carried by with them.
  Vector error = Vector::Zero(rows_);
  const double count = static_cast<double>(seeds.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!readings_[b].simulated.empty() || study_.cases[blocks_[b].case_number].reduced.empty()) continue;
    const Matrix rest = ((large.colwise() - to) - factor_.asDiagonal() * Matrix(small.colwise() - from))
                            .middleRows(blocks_[b].first, blocks_[b].size);
    const double pooled = std::sqrt(rest.squaredNorm() / ((count - 1) * static_cast<double>(rest.rows())));
    error.segment(blocks_[b].first, blocks_[b].size).setConstant(pooled / std::sqrt(count));
  }
  return error;
}

}  // namespace calx
