// candidates.hpp: the library of a diagnosis: which effects can act in which cases of a study, how strong they are
// tried, and how they are put into a run. Private to study/.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "config/effects.hpp"
#include "infer/simulator.hpp"
#include "study/study.hpp"

namespace calx {

/// One amplitude of one effect.
struct Candidate {
  EffectInfo info;
  std::string parameter;                                     // the amplitude
  std::string direction;                                     // the angle that turns it; empty: none
  std::map<std::string, std::string> on;                     // names by role, as the study gives them
  std::vector<std::map<std::string, std::string>> bound;     // of each case: all roles
  std::map<std::string, double> shape;                       // parameters given that are no amplitude
  double off = 0, lowest = 0, highest = 0, orientation = 1;  // value = off + orientation * amplitude
  std::string unit;
  std::vector<bool> cases;  // of study.cases
  bool named = false;       // by the study
  std::size_t touched = 0;  // observables of a kind that the effect is declared to touch
  infer::Effect effect;

  /// Value of the parameter, kept in its range, and of the direction in degrees (0 where there is none).
  double value(const infer::Vector& amplitude) const;
  double angle(const infer::Vector& amplitude) const;
  /// All parameters that a run with this strength gets, by name.
  std::vector<std::pair<std::string, double>> settings(const infer::Vector& amplitude) const;
  /// Whether the value lies in its range without being moved there.
  bool allows(const infer::Vector& amplitude) const;
};

/// An effect that is not tried, with the reason in words.
struct Untested {
  std::string effect, reason;
};

struct Library {
  std::vector<Candidate> candidates;  // by id and parameter, whatever the order in the study
  std::vector<Untested> untested;
  std::size_t runs_for_all = 0;  // budget that would try every candidate; 0: this one does
};

/// Every effect that comes with Calx and those the study names ("library": "named": only those), where it can be put
/// into a case that has an observable of a kind it touches. Each is built once at its trial strength, not run. Throws
/// Error(Fault::settings) for a named effect that is not there or does not fit.
/// step_scales: trial strength in scales of the effect.
Library find_library(const Study& study, double step_scales);

/// The generic terms of the study (generic_terms.hpp), whose plugins must be on its plugin path, likewise.
Library find_generic_terms(const Study& study, double step_scales);

/// A strength of a candidate.
struct Dose {
  const Candidate* candidate;
  infer::Vector amplitude;
};

/// The run of a case with doses of candidates; those that do not act in the case leave it as it is.
RunRequest dosed_request(const Study& study, std::size_t case_number, const std::vector<double>& values,
                         std::uint64_t seed, const std::vector<Dose>& doses, bool reduced);

}  // namespace calx
