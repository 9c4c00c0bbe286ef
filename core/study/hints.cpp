#include "study/hints.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "plugin/effects.hpp"

namespace calx {
namespace {

using infer::Verdict;

constexpr std::size_t most_of_a_kind = 3;
constexpr double most_repeats = 20;  // more of the same is no plan
constexpr double off_below = 0.05;
/// Standard deviations of the data at the 95 % end of a strength that data and prior bound alike: 1.645 / sqrt(2).
constexpr double told = 1.16;

class Hints {
 public:
  Hints(const Study& study, const StudyDiagnosis& d) : study_(study), d_(d), v_(d.diagnosis) {}

  std::vector<std::string> all() {
    if (v_.verdict == Verdict::none) excluded();
    if (v_.verdict == Verdict::ambiguous) apart_by_repeats(), apart_by_measurement();
    if (v_.verdict == Verdict::unknown) left_out(), ask_for_generic_terms();
    if (v_.verdict == Verdict::named) still_off();
    strained();
    if (!d_.measured.has_hold_out || d_.measured.split_repeats)
      out_.push_back("Measure at one more condition (another speed or fill) and hold it out: " +
                     std::string(d_.measured.has_hold_out ? "so far only later repeats are held out."
                                                          : "without held-out data no cause can be named."));
    return out_;
  }

 private:
  const Candidate& candidate(std::size_t e) const { return d_.library.candidates[d_.kept[e]]; }

  /// Whether the data bound the strength at least as much as its prior does, by signal over noise at its upper end. An
  /// effect that leaves no trace is not excluded by anything measured.
  bool told_by_data(std::size_t e) const {
    const infer::SingleFit& fit = v_.posterior.fits[e];
    const double size = fit.amplitude.norm();
    return size > 0 && fit.high > 0 && d_.confusion.detectability[e] / size * fit.high >= told;
  }

  /// Strengths that the data exclude, for the causes they see best.
  void excluded() {
    std::vector<std::size_t> order;
    for (std::size_t e = 0; e < d_.model.effects.size(); ++e)
      if (d_.model.effects[e].components == 1 && told_by_data(e)) order.push_back(e);
    const auto seen = [&](std::size_t e) { return v_.posterior.fits[e].high / d_.model.effects[e].scale; };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seen(a) < seen(b); });
    std::string list;
    for (std::size_t k = 0; k < order.size() && k < most_of_a_kind; ++k) {
      const Candidate& c = candidate(order[k]);
      const double limit = c.value(infer::Vector::Constant(1, v_.posterior.fits[order[k]].high));
      list += (k > 0 ? ", " : "") + c.effect.id + " beyond " + c.parameter + " = " + brief_quantity(limit, c.unit);
    }
    if (!list.empty()) out_.push_back("These data already exclude (95 %): " + list + ".");
  }

  /// Pairs of what is left that more of the same measurement would separate.
  void apart_by_repeats() {
    std::size_t said = 0;
    for (std::size_t a = 0; a < v_.set.size(); ++a)
      for (std::size_t b = a + 1; b < v_.set.size() && said < most_of_a_kind; ++b) {
        const std::size_t i = v_.set[a], k = v_.set[b];
        if (i >= d_.model.effects.size() || k >= d_.model.effects.size()) continue;
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
        const double distance = d_.confusion.distance(row, column);
        if (!(distance > 0) || distance >= infer::least_apart) continue;
        // The distance grows as the root of the repeats.
        const double times = std::ceil(std::pow(infer::least_apart / distance, 2));
        const std::string pair = d_.model.effects[i].id + " and " + d_.model.effects[k].id;
        out_.push_back(times <= most_repeats
                           ? pair + " are " + rounded(distance) + " standard errors apart; " + format_number(times) +
                                 " times as many repeats would separate them, if the scatter of the measurement limits."
                           : pair + " are " + rounded(distance) +
                                 " standard errors apart: no number of repeats of these measurements separates them.");
        ++said;
      }
  }

  /// What the authors of the effects say would separate what is left.
  void apart_by_measurement() {
    std::size_t said = 0;
    for (const std::size_t e : v_.set) {
      if (e >= d_.model.effects.size()) continue;
      for (const EffectRival& r : candidate(e).info.rivals) {
        const bool left = std::any_of(v_.set.begin(), v_.set.end(), [&](std::size_t k) {
          return k < d_.model.effects.size() && candidate(k).info.id == r.effect;
        });
        if (!left || said == most_of_a_kind) continue;
        out_.push_back(candidate(e).info.id + " and " + r.effect + " are told apart by: " + r.separate + ".");
        ++said;
      }
    }
  }

  /// Effects of Calx that the study does not try and that can change what is off most.
  void left_out() {
    std::size_t worst = 0;
    const std::vector<infer::BlockCheck>& blocks = v_.before.blocks;
    for (std::size_t b = 1; b < blocks.size(); ++b)
      if (std::fabs(blocks[b].z) > std::fabs(blocks[worst].z)) worst = b;
    const infer::Block& block = d_.model.observables.blocks[worst];
    std::string list;
    std::size_t count = 0;
    for (const EffectInfo& info : list_effects(plugin_search_path(study_.executor.plugin_path))) {
      const bool tried = info.id.rfind("generic.", 0) == 0 ||
                         std::any_of(d_.library.candidates.begin(), d_.library.candidates.end(),
                                     [&](const Candidate& c) { return c.info.id == info.id; }) ||
                         std::any_of(d_.library.untested.begin(), d_.library.untested.end(),
                                     [&](const Untested& u) { return u.effect == info.id; });
      if (tried || std::count(info.touches.begin(), info.touches.end(), block.kind) == 0) continue;
      list += (count++ > 0 ? ", " : "") + info.id;
    }
    if (count > 0)
      out_.push_back("The study's library leaves out " + std::to_string(count) + " effects that can change \"" +
                     block.name + "\", which is off most: " + list + ". Name them under \"effects\".");
  }

  void ask_for_generic_terms() {
    if (d_.generic.tried.empty())
      out_.push_back(
          "\"generic_terms\": true in the study tries forces known by a formula alone; they describe what is wrong "
          "without naming it.");
  }

  void still_off() {
    std::string list;
    for (std::size_t b = 0; b < v_.after.blocks.size(); ++b)
      if (v_.after.blocks[b].p < off_below)
        list += (list.empty() ? "" : ", ") + ("\"" + d_.model.observables.blocks[b].name + "\"");
    if (!list.empty())
      out_.push_back("With the cause, " + list +
                     " is still off; diagnose the extended case again to see what is left.");
  }

  void strained() {
    const infer::Vector& u = v_.verdict == Verdict::named ? d_.u_after : d_.u_before;
    for (std::size_t k = 0; k < study_.parameters.size(); ++k) {
      const double by = u[static_cast<Eigen::Index>(k)];
      if (std::fabs(by) > 2)
        out_.push_back("Measure " + study_.parameters[k].name + " by itself: recalibration puts it " +
                       rounded(std::fabs(by)) + " of its standard deviations " + (by > 0 ? "above" : "below") +
                       " what was expected.");
    }
  }

  static std::string rounded(double v) { return format_number(std::round(10 * v) / 10); }

  const Study& study_;
  const StudyDiagnosis& d_;
  const infer::Diagnosis& v_;
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> hints_of(const Study& study, const StudyDiagnosis& d) { return Hints(study, d).all(); }

}  // namespace calx
