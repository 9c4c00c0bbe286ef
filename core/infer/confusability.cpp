#include "infer/confusability.hpp"

#include <cmath>

namespace calx::infer {

Confusability compare_causes(const LinearModel& model, const Metric& metric, const std::vector<Vector>& amplitudes,
                             double apart) {
  const std::size_t count = model.effects.size();
  const auto n = static_cast<Eigen::Index>(count);
  Confusability out;
  Matrix traces(model.base.size(), n);
  std::vector<Matrix> spans;
  for (std::size_t e = 0; e < count; ++e) {
    spans.push_back(metric.whiten(model.signatures[e]));
    traces.col(static_cast<Eigen::Index>(e)) = spans[e] * amplitudes[e];
    out.detectability.push_back(traces.col(static_cast<Eigen::Index>(e)).norm());
  }
  out.cosine = Matrix::Zero(n, n), out.distance = Matrix::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index l = 0; l < n; ++l) {
      const double size_k = traces.col(k).norm(), size_l = traces.col(l).norm();
      if (size_k > 0 && size_l > 0) out.cosine(k, l) = traces.col(k).dot(traces.col(l)) / (size_k * size_l);
      if (k == l) continue;
      const auto other = static_cast<std::size_t>(l);
      const Vector q = spans[other].colPivHouseholderQr().solve(traces.col(k));
      const bool can = !(model.effects[other].one_sided && q[0] < 0);
      out.distance(k, l) = can ? (traces.col(k) - spans[other] * q).norm() : size_k;
    }
  std::vector<bool> seen(count, false);
  for (std::size_t e = 0; e < count; ++e) {
    if (seen[e]) continue;
    std::vector<std::size_t> group = {e};
    seen[e] = true;
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t l = 0; l < count; ++l) {
        const auto a = static_cast<Eigen::Index>(group[k]), b = static_cast<Eigen::Index>(l);
        // Each must be seen at all: what is below the noise resembles everything.
        const bool visible = out.detectability[group[k]] >= apart && out.detectability[l] >= apart;
        if (!seen[l] && visible && std::min(out.distance(a, b), out.distance(b, a)) < apart)
          seen[l] = true, group.push_back(l);
      }
    if (group.size() > 1) out.groups.push_back(group);
  }
  return out;
}

}  // namespace calx::infer
