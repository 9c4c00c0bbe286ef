// study_simulator.hpp: the cases of a study as the diagnosis sees them: numbers of the observables at given parameters,
// with given doses of effects, by seed. Private to study/.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "infer/simulator.hpp"
#include "study/candidates.hpp"
#include "study/executor.hpp"
#include "study/study_run.hpp"

namespace calx {

/// A run of the diagnosis.
struct DosedRun : StudyRun {
  std::string stage, doses;  // what it is for; in words
};

/// Every distinct run that was asked for, in the order of asking.
struct RunLedger {
  std::vector<DosedRun> runs;
  std::set<std::string> known;  // requests, as text
  std::size_t planned = 0;      // runs of the whole diagnosis at most
  std::string stage;            // what the next runs are for
};

/// What a run is asked for beside its seed.
struct Setting {
  infer::Vector u;                                           // nuisance parameters, standardised
  std::vector<std::pair<std::size_t, infer::Vector>> doses;  // candidate and amplitude
  std::uint64_t seed = 1;
};

/// Numbers of runs of the cases behind some readings. A case with a reduced form runs reduced; its numbers are carried
/// to those of the full form, or of another program ("simulated"), by anchor(). [main]
class StudySimulator : public infer::Simulator {
 public:
  StudySimulator(const Study& study, std::vector<StudyObservable> readings, const Library& library, Executor& executor,
                 const ProgressSink& sink, RunLedger& ledger);

  int parameters() const override { return static_cast<int>(study_.parameters.size()); }
  double step(int parameter) const override;
  /// Effects of points are numbers in `effects`. Throws Error(Fault::numerics) where a run without effect fails or
  /// gives no number; a run with an effect that fails, or that its case refuses, is NaN and noted in failures().
  infer::Matrix run(const std::vector<infer::RunPoint>& points) override;
  infer::Vector instrument(const infer::RunPoint& point) override;

  /// The same for any doses; full: full cases instead of reduced ones, not carried. A failure throws.
  infer::Matrix run_settings(const std::vector<Setting>& settings, bool full);

  /// Runs of the full cases, or the numbers of another program, at the prior of the parameters decide how numbers of
  /// the reduced cases are carried: by a factor where both are well away from zero, else by a shift. seeds: of the
  /// runs at the prior, two or more. Returns the standard error of what is carried, per number; zero where nothing is.
  infer::Vector anchor(const std::vector<std::uint64_t>& seeds, const infer::Vector& sd);

  /// Values of the parameters in their units; standardised ones beyond their range end at its border.
  std::vector<double> values(const infer::Vector& u) const;

  std::vector<std::size_t> effects;  // candidate behind each effect of a RunPoint
  /// Of runs with effects alone, for the ledger.
  std::string stage_of_effects = "leading effects at their fitted strength";
  const std::map<std::size_t, std::string>& failures() const { return failures_; }  // by candidate

 private:
  struct Block {
    int first, size;
    std::size_t case_number;
  };
  /// Folder or error of each setting's run of each case in use.
  std::vector<std::vector<RunResult>> execute(const std::vector<Setting>& settings, bool full);
  infer::Vector read(const std::vector<RunResult>& runs) const;
  infer::Vector carried(const infer::Vector& figures) const;
  /// Why the cases refuse a dose, or it lies outside of its range; empty: they do not.
  std::string refusal(const Setting& setting) const;
  std::string trouble(const std::vector<RunResult>& runs, const infer::Vector& figures) const;
  bool uses(std::size_t case_number) const;

  const Study& study_;
  std::vector<StudyObservable> readings_;
  const Library& library_;
  Executor& executor_;
  const ProgressSink& sink_;
  RunLedger& ledger_;
  std::vector<Block> blocks_;
  int rows_ = 0;
  infer::Vector factor_, shift_;
  std::map<std::size_t, std::string> failures_;
};

}  // namespace calx
