// curves.cpp: what a contact law does, as curves for the page: a press and release, impacts, a tangential loop.
#include <algorithm>
#include <cmath>

#include "conformance/checks.hpp"
#include "conformance/law_rig.hpp"

namespace calx::conformance {
namespace {

CheckCurve press(const LawRig& rig) {
  CheckCurve curve{"normal", rig.name(), {}, {}};
  std::vector<double> state = rig.fresh(1);
  const int steps = 400;
  for (int k = 0; k <= 2 * steps; ++k) {
    const double share = k <= steps ? static_cast<double>(k) / steps : 2 - static_cast<double>(k) / steps;
    if (share <= 0) continue;
    const double d = share * rig.overlap();
    curve.x.push_back(d);
    // As slow as can be: dashpots do not act.
    curve.y.push_back(rig.at(d, {}, {}, state, rig.dt()).force.z);
  }
  return curve;
}

CheckCurve impacts(const LawRig& rig) {
  CheckCurve curve{"restitution", rig.name(), {}, {}};
  for (double speed = 0.01; speed < 2.1; speed *= std::sqrt(2.0)) {
    const LawRig::Impact impact = rig.impact(speed, rig.dt(), 0.5, rig.reach() / speed + 20000 * rig.dt());
    curve.x.push_back(speed);
    curve.y.push_back(std::max(0.0, impact.restitution));  // 0: they stay together
  }
  return curve;
}

CheckCurve shear(const LawRig& rig) {
  CheckCurve curve{"tangential", rig.name(), {}, {}};
  std::vector<double> state = rig.fresh(1);
  const double d = 0.5 * rig.overlap();
  rig.at(d, {}, {}, state, rig.dt());
  const int steps = 400;
  const double far = rig.overlap();
  double x = 0;
  for (const double to : {far, -far, far}) {
    const double step = (to - x) / steps;
    for (int k = 0; k < steps; ++k) {
      x += step;
      const LawRig::Wrench w = rig.at(d, {step / rig.dt(), 0, 0}, {}, state, rig.dt());
      curve.x.push_back(x);
      curve.y.push_back(-w.force.x);
    }
  }
  return curve;
}

}  // namespace

std::vector<CheckCurve> law_curves(Subject& subject) {
  std::vector<std::vector<CheckCurve>> shown;
  for (const LawRig& rig : rigs(subject)) {
    // Options that change none of the three would only hide each other; more than six curves cannot be told apart.
    if (shown.size() == 6) break;
    std::vector<CheckCurve> curves = {press(rig), impacts(rig), shear(rig)};
    const bool seen = std::any_of(shown.begin(), shown.end(), [&](const std::vector<CheckCurve>& other) {
      return other[0].y == curves[0].y && other[1].y == curves[1].y && other[2].y == curves[2].y;
    });
    if (!seen) shown.push_back(std::move(curves));
  }
  std::vector<CheckCurve> out;
  for (const std::vector<CheckCurve>& curves : shown) out.insert(out.end(), curves.begin(), curves.end());
  return out;
}

}  // namespace calx::conformance
