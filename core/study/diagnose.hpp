// diagnose.hpp: from a study to what its measurements show of its simulation: what is wrong, which cause explains it,
// the model extended by that cause, and what that is worth. Some 30 to 300 runs; the algebra takes seconds to minutes.
#pragma once
#include <string>
#include <vector>

#include "infer/confusability.hpp"
#include "infer/experiment.hpp"
#include "infer/self_test.hpp"
#include "infer/unknown_term.hpp"
#include "study/candidates.hpp"
#include "study/executor.hpp"
#include "study/measured_blocks.hpp"
#include "study/study_simulator.hpp"

namespace calx {

/// What was really run to see whether the extension does what the algebra says.
struct Confirmation {
  bool done = false, passed = false;
  std::size_t seeds = 0;
  double log_score = 0;  // ln of the likelihood ratio of the held-out data, extended over old, at the means of the runs
  double error_before = 0, error_after = 0;  // root mean square of held-out residuals, in sd
  double agreement = 1;                      // p of the difference between runs and algebra
  double error_foretold = 0;                 // of the algebra, at the place of the extended case
  bool contradicted = false;                 // runs are not where the algebra put them, and farther from the data
  std::vector<double> before, after;         // means of the runs, rows of the blocks
};

/// A measurement that could be made next.
struct NextMeasurement {
  std::string name;
  double cost = 1, information = 0, clear_verdict = 0;  // information in nats
};

/// A cause that somebody claims, held against the sign of what it does.
struct Claim {
  std::string effect, observable, says, verdict;  // verdict: contradicted, possible, unresolved, untested
  bool too_much = false;                          // the simulation is said to have too much of it; else it lacks it
  double departure = 0, departure_sd = 0;         // measured - simulated, unit of the observable
  double change = 0;                              // by the effect at a typical strength, same unit
  std::string sentence;
};

/// A generic term, tried where something outside of the library is wrong. It describes and does not name.
struct GenericFit {
  struct Trial {
    std::size_t candidate;  // of the library, behind its effects
    double log_odds;        // of the fitted campaign against the recalibrated model, amplitude integrated out
  };
  std::vector<Trial> tried;  // best first
  bool accepted = false;     // the first of them
  std::string reason;        // why it is accepted or refused
  double fit_p = 1;          // of what is left with it
  double gain = 0;           // ln of the held-out likelihood ratio as foretold, before any run confirms it
  infer::Vector u;           // nuisance parameters with it
  infer::Vector amplitude;
  double amplitude_sd = 0;
  Confirmation confirmation;
};

struct StudyDiagnosis {
  MeasuredBlocks measured;
  Library library;
  std::vector<std::size_t> kept;  // candidates behind the effects of the model
  infer::Options options;
  infer::LinearModel model;
  infer::Bank bank;
  infer::Diagnosis diagnosis;
  infer::Vector u_before, u_after;  // nuisance parameters without and with the named effects, standardised
  std::vector<double> u_sd;
  std::vector<std::size_t> explained;     // the named effects; when none is named, one that is likelier than all else
  std::vector<std::size_t> dropped;       // probable beside what is named, but adds nothing when it is run
  std::vector<infer::Vector> amplitudes;  // of these
  std::vector<double> amplitude_sd;       // of these where runs of the extended case were fitted
  infer::Vector before, after;            // numbers of the recalibrated model, and with what was explained
  infer::Confusability confusion;
  infer::SelfTest self_test;
  std::vector<infer::UnknownTerm> terms;
  GenericFit generic;
  Confirmation confirmation;
  std::vector<NextMeasurement> next;
  std::vector<Claim> claims;
  RunLedger ledger;
  std::vector<std::string> notes;
  std::vector<std::string> hints;  // what the reader can do next
};

/// The result depends on the study, its seed and the figures of the runs alone, not on jobs, on what was cached or on
/// the order of effects in the study. Throws Error(Fault::settings) for effects or experiments that do not fit and for
/// a budget too small for any plan, Error(Fault::numerics) when the cases without effects give no numbers, and what the
/// executor throws. [main]
StudyDiagnosis diagnose_study(const Study& study, Executor& executor, const ProgressSink& sink);

/// Writes the generic terms of the study as text-only plugins to folder/generic and puts that on its plugin path. To be
/// called before the executor is made; does nothing for a study without generic terms. Throws Error(Fault::settings)
/// for terms that cannot be, Error(Fault::files).
void prepare_generic_terms(Study& study, const std::string& folder);

/// What a person wants to know first, as text of some lines.
std::string diagnosis_summary(const Study& study, const StudyDiagnosis& result);

/// The extended cases, extension/CASE.json, if something was named; diagnosis.json, cost.json and runs.csv. Throws
/// Error(Fault::files).
void write_diagnosis(const std::string& folder, const Study& study, const StudyDiagnosis& result);

}  // namespace calx
