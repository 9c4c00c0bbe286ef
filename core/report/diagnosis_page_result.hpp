// diagnosis_page_result.hpp: what calx diagnose wrote, read for its page. Private to report/. Keys that are missing
// leave NaN, empty texts and empty lists, so that results of older and newer versions still give a page.
#pragma once
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace calx {

struct DiagnosisResult {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  /// A parameter of a cause, in its unit, with its 90 % interval.
  struct Amount {
    std::string name, unit;
    double value = unknown, low = unknown, high = unknown, off = unknown, lowest = unknown, highest = unknown;
  };
  struct Rival {
    std::string effect, separate;
  };
  struct Cause {
    std::string id, label, summary;        // label: the id, with the parameter if several causes share the id
    double probability = 0, evidence = 0;  // as stated, after the self-test's calibration; before it
    double signal_to_noise = unknown;
    bool named = false, is_dropped = false, is_instrument = false;
    std::vector<Amount> parameters;  // the first is the strength
    std::vector<Rival> rivals;
  };
  /// Numbers of one observable; every list has one value per place of x, or none. sd, band: one standard deviation of
  /// the measurement, and of all that may part measurement and simulation without anything being wrong.
  struct Observable {
    std::string name, kind, case_name, unit, against, looks_like;
    std::vector<double> x, fit, hold, sd, before, after, band;
    bool log_x = false, noise_estimated = false, simulated_elsewhere = false;
    double z = unknown, p = unknown, signed_error = unknown;  // simulation - measured
    double z_after = unknown, p_after = unknown, seed_scatter = unknown, repeats = unknown;
    std::vector<std::pair<std::string, std::string>> conditions;
  };
  struct Event {
    std::string observable;
    double x = unknown, z = unknown;
  };
  /// A force known by a formula alone, tried where the cause is not in the library.
  struct GenericTerm {
    std::string id, summary, reason;
    bool accepted = false;
    Amount amount;
    double gain = unknown;
    double error_before = unknown, error_after = unknown;  // held out, sd, by runs
    std::vector<std::pair<std::string, double>> tried;     // id and log odds, best first
  };
  struct UnknownTerm {
    std::string observable, family, words;
    double gain = unknown, stability = unknown;
  };
  struct Parameter {
    std::string name, unit;
    double prior_mean = unknown, prior_sd = unknown, before = unknown, after = unknown, sd = unknown;
    /// The value lies more than two prior standard deviations off what was expected.
    bool strained(double value) const { return value > prior_mean + 2 * prior_sd || value < prior_mean - 2 * prior_sd; }
  };
  struct Power {
    std::string cause, unit;
    double strength = unknown, studies = 0, right = 0, wrong = 0;
  };
  struct Measurement {
    std::string name;
    double cost = unknown, information = unknown, clear_verdict = unknown;
  };
  struct Claim {
    std::string effect, says, verdict, sentence;
  };
  struct Extension {
    std::string case_name, path, text;  // path: below the folder; text: empty when the file is not there
  };

  std::string dir, title, study, data_sha256, calx, seed, verdict, reason, sentence;
  std::vector<Cause> causes;                  // likeliest first
  double none = unknown, unlisted = unknown;  // shares of "nothing" and of "not in the library"
  double fit_p = unknown, fit_p_with_named = unknown;
  std::vector<std::string> set, after_holds;
  std::vector<Observable> observables;
  std::vector<Event> events;
  std::vector<std::string> ids;               // rows and columns of distance
  std::vector<std::vector<double>> distance;  // (k, l): signal of k that the best imitation by l leaves, in sd
  std::vector<std::vector<std::string>> groups;
  std::vector<UnknownTerm> terms;
  GenericTerm generic;  // without id: none was tried
  std::vector<Extension> extensions;
  double gain = unknown, gain_sd = unknown, gain_needed = unknown;
  bool held_out = true, split_repeats = false;
  struct {
    bool done = false, passed = false, contradicted = false;
    double seeds = unknown, gain = unknown, error_before = unknown, error_after = unknown, error_foretold = unknown,
           agreement_p = unknown;
    std::vector<double> before, after;  // over all observables, one after the other
    bool holds() const { return passed && !contradicted; }
  } confirmation;
  double controls = 0, controls_named = 0;
  std::vector<Power> powers;
  std::vector<double> stated, observed;  // calibration of probabilities
  std::vector<Measurement> next;
  std::vector<Parameter> parameters;
  std::vector<Claim> claims;
  std::vector<std::pair<std::string, std::string>> untested;  // effect, reason
  double budget = unknown, planned = unknown, used = unknown;
  std::vector<std::string> assumptions, notes, hints;

  /// From cost.json; has_cost false: not there.
  bool has_cost = false;
  double runs = unknown, cached = unknown, failed = unknown, run_seconds = unknown;
  std::string executor;
  std::vector<std::vector<std::string>> run_rows;  // of runs.csv, the head first

  std::vector<const Cause*> named() const;
  /// after holds a cause: one that is named, or one that is likelier than all else and not proven.
  bool has_cause() const { return !after_holds.empty() || !named().empty(); }
  /// Something was added to the recalibrated simulation, so that before and after differ.
  bool has_after() const { return has_cause() || !terms.empty(); }
};

/// Throws Error(Fault::files) when dir/diagnosis.json cannot be read, is no JSON or is no diagnosis.
DiagnosisResult read_diagnosis(const std::string& dir);

}  // namespace calx
