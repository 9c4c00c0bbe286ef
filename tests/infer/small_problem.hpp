// small_problem.hpp: two blocks and three effects, linear by construction, for tests of the mathematics.
#pragma once
#include "base/random.hpp"
#include "infer/linearise.hpp"

namespace calx::infer {

inline Block small_block(const char* name, int size, double sd) {
  Block b;
  b.name = name, b.kind = "mass-per-cycle", b.ordered = size > 20;
  b.x = Vector::LinSpaced(size, 1, size);
  b.sd = Vector::Constant(size, sd);
  b.fit = b.hold = Vector::Zero(size);
  return b;
}

inline Observables small_observables() { return {{small_block("series", 30, 0.5), small_block("single", 1, 2)}}; }

/// Amplitude times: a rise along the series; a shift of the series and the single number; a bump in the series.
inline std::vector<Matrix> small_signatures() {
  std::vector<Matrix> all(3, Matrix::Zero(31, 1));
  for (int k = 0; k < 30; ++k) {
    all[0](k, 0) = k / 29.0;
    all[1](k, 0) = 1;
    all[2](k, 0) = std::exp(-0.5 * (k - 15) * (k - 15) / 4.0);
  }
  all[1](30, 0) = 4;
  return all;
}

/// White along the series and with a common mode there.
inline SeedScatter small_scatter(double white, double common) {
  return {{white, white}, {common, 0}, {0, 0}, {Vector::Ones(30), Vector::Ones(1)}};
}

/// The plane itself: base zero, one nuisance that shifts the single number by 3 per prior sd.
inline LinearModel small_model() {
  LinearModel model;
  model.observables = small_observables();
  model.u = Vector::Zero(1);
  model.base = Vector::Zero(31);
  model.sensitivities = Matrix::Zero(31, 1);
  model.sensitivities(30, 0) = 3;
  model.signatures = small_signatures();
  for (const char* id : {"rise", "shift", "bump"}) {
    Effect e;
    e.id = id;
    model.effects.push_back(e);
  }
  model.effects[0].one_sided = true;
  model.scatter = small_scatter(0.5, 0.2);
  model.base_weight = 0.1;
  return model;
}

inline Vector normal_vector(Random& random, Eigen::Index size) {
  Vector v(size);
  for (double& x : v) x = random.normal();
  return v;
}

}  // namespace calx::infer
