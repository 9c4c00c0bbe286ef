// blind_study.hpp: one study whose truth is hidden from the diagnosis: made from a seed, diagnosed, scored.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/plant.hpp"
#include "infer/unknown_term.hpp"

namespace calx::diagnosis {

enum class Kind { control, single, pair, outside };

/// What makes a study harder than the default.
enum class Trouble {
  none,
  few_observables,  // no speed sweep, no flow by angle, no bed heights, no angle after the run
  far_powder,       // two nuisance parameters 2 to 3 prior sd off
  gross_errors,     // three numbers of each campaign 8 sd off
  wrong_sd,         // declared sd wrong by a factor exp(0.5 N(0, 1)) per observable
  weak,             // delta 0.5 to 2: below detection
  inert_covariate,  // a logged temperature rises along the cycles, is offered as a cause, and does nothing
  like_causes,      // the hidden effect has an imitation closer than 3
  count
};
const char* trouble_name(Trouble trouble);
/// Each in turn for eight studies, so that all kinds meet it.
Trouble trouble_of(std::uint64_t study);

/// What the generator knows.
struct Truth {
  Kind kind = Kind::control;
  std::vector<std::size_t> effects;  // rising
  Alien alien = alien_count;
  Vector u;
  std::vector<Vector> amplitudes;  // per effect of the library, empty where off
  std::vector<double> strange;     // per alien
  double delta = 0;  // signal over noise after recalibration, of the fitted campaign, with the plant's own shapes
  double separability = 0;          // distance to the best imitation by one other effect, in the same metric
  std::vector<double> noise_error;  // true over declared sd of each block
};

struct Study {
  Trouble trouble = Trouble::none;
  Truth truth;
  infer::Observables observables;  // as declared, with both campaigns
  Vector bias;                     // numerical, of the simulator
  Forms forms;
};

/// Ways to break the method, each of which must be seen in the table.
enum class Broken { no, shuffled_signatures, no_recalibration, no_seed_scatter, no_unknown, fit_is_hold_out };

/// Mix of kinds by seed: of eight, two controls, three single effects, two outside the library, one pair; with like
/// causes, single effects only. Strengths are drawn so that delta is log-uniform in 3 to 15, or 3 to 10 with like
/// causes.
Study make_study(std::uint64_t seed, Trouble trouble = Trouble::none);

struct Outcome {
  Trouble trouble = Trouble::none;
  Truth truth;
  infer::Diagnosis diagnosis;
  int runs = 0;
  std::string family;  // of the first term of an unknown effect; empty: none found
  double stability = 0;
  std::string rival;  // strongest simple term outside the library: family and observable
  /// What one more measurement would have settled, where a single effect was left undecided.
  struct Next {
    bool asked = false;
    bool best_right = false, best_wrong = false, random_right = false, random_wrong = false;
  } next;
  bool common_practice_right = false;  // bench calibration and the effect that cuts the squared error most
  bool common_practice_named = false;
};

/// scatter: of the simulator's runs by their seed, over the usual.
Outcome diagnose_study(std::uint64_t seed, const infer::Options& options, Broken broken = Broken::no,
                       double scatter = 1, Trouble trouble = Trouble::none);

}  // namespace calx::diagnosis
