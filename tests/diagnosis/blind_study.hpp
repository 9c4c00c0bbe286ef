// blind_study.hpp: one study whose truth is hidden from the diagnosis: made from a seed, diagnosed, scored.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/plant.hpp"
#include "infer/unknown_term.hpp"

namespace calx::diagnosis {

enum class Kind { control, single, pair, outside };

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
  Truth truth;
  infer::Observables observables;  // as declared, with both campaigns
  Vector bias;                     // numerical, of the simulator
  Forms forms;
};

/// Ways to break the method, each of which must be seen in the table.
enum class Broken { no, shuffled_signatures, no_recalibration, no_seed_scatter, no_unknown, fit_is_hold_out };

/// Mix of kinds by seed: of eight, two controls, three single effects, two outside the library, one pair. Strengths are
/// drawn so that delta is log-uniform in 3 to 15.
Study make_study(std::uint64_t seed);

struct Outcome {
  Truth truth;
  infer::Diagnosis diagnosis;
  int runs = 0;
  std::string family;  // of the first term of an unknown effect; empty: none found
  double stability = 0;
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
                       double scatter = 1);

}  // namespace calx::diagnosis
