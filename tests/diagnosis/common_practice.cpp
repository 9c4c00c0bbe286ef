#include "diagnosis/common_practice.hpp"

namespace calx::diagnosis {

void common_practice(const Study& study, LineSimulator& simulator, Outcome& outcome) {
  const infer::Observables& all = study.observables;
  const Vector sd = all.sd();
  Vector y(all.rows());
  for (std::size_t b = 0; b < all.blocks.size(); ++b) y.segment(all.first(b), all.size(b)) = all.blocks[b].fit;
  const Vector zero = Vector::Zero(line::parameters);
  Matrix j(all.rows(), line::parameters);
  for (int k = 0; k < line::parameters; ++k)
    j.col(k) = (simulate(Vector::Unit(line::parameters, k), {}) - simulate(-Vector::Unit(line::parameters, k), {})) / 2;
  Matrix normal = 0.01 * Matrix::Identity(line::parameters, line::parameters);
  Vector pull = zero;
  const Vector base = simulate(zero, {});
  for (BlockIndex b : {angle_drained, angle_static, density, compression, wall})
    for (int k = all.first(b); k < all.first(b) + all.size(b); ++k) {
      normal += j.row(k).transpose() * j.row(k) / (sd[k] * sd[k]);
      pull += j.row(k).transpose() * (y[k] - base[k]) / (sd[k] * sd[k]);
    }
  const Vector u = normal.ldlt().solve(pull);
  const Vector r = (y - simulator.run({{u, -1, {}, 77}}).col(0)).cwiseQuotient(sd);
  const std::vector<infer::Effect> library = effect_library();
  double best = 0.95 * r.squaredNorm();
  std::size_t cause = effect_count;
  for (std::size_t e = 0; e < library.size(); ++e) {
    Matrix g(r.size(), library[e].components);
    for (int k = 0; k < library[e].components; ++k) {
      std::vector<Vector> amplitudes(effect_count);
      amplitudes[e] = library[e].scale * Vector::Unit(library[e].components, k);
      g.col(k) = (simulate(u, amplitudes) - simulate(u, {})).cwiseQuotient(sd);
    }
    const Vector q = g.colPivHouseholderQr().solve(r);
    if (library[e].one_sided && q[0] < 0) continue;
    const double left = (r - g * q).squaredNorm();
    if (left < best) best = left, cause = e;
  }
  outcome.common_practice_named = cause != effect_count;
  outcome.common_practice_right = study.truth.effects == std::vector<std::size_t>{cause};
}

}  // namespace calx::diagnosis
