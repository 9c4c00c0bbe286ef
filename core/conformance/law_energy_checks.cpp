// law_energy_checks.cpp: signs and energy of a contact law: presses, closed paths, impacts.
#include <algorithm>
#include <cmath>

#include "conformance/checks.hpp"
#include "conformance/law_rig.hpp"

namespace calx::conformance {
namespace {

/// One closed path of pressing, shearing and rolling from separation to separation: energy got out of the contact over
/// the energy put into it.
double created(Subject& s, const LawRig& rig, bool roll) {
  constexpr int kLegs = 5, kSteps = 2000;
  const double d = rig.overlap(), dt = rig.dt(), gap = 1.05 * rig.reach();
  struct Corner {
    double overlap, x, y, turn_x, turn_y;
  };
  std::vector<Corner> corners = {{-gap, 0, 0, 0, 0}};
  for (int k = 1; k < kLegs; ++k) {
    Corner c = {d * s.uniform(0.1, 1), d * s.uniform(-0.2, 0.2), d * s.uniform(-0.2, 0.2), 0, 0};
    if (roll) {
      c.turn_x = 0.2 * d / LawRig::radius * s.uniform(-1, 1);
      c.turn_y = 0.2 * d / LawRig::radius * s.uniform(-1, 1);
    }
    corners.push_back(c);
  }
  corners.push_back({-gap, corners.back().x, corners.back().y, corners.back().turn_x, corners.back().turn_y});
  std::vector<double> state = rig.fresh(1);
  LawRig::Wrench before;
  double sum = 0, put_in = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Corner &a = corners[k - 1], &b = corners[k];
    const double press = (b.overlap - a.overlap) / kSteps, x = (b.x - a.x) / kSteps, y = (b.y - a.y) / kSteps;
    const double wx = (b.turn_x - a.turn_x) / kSteps, wy = (b.turn_y - a.turn_y) / kSteps;
    for (int n = 1; n <= kSteps; ++n) {
      const double overlap = a.overlap + press * n;
      LawRig::Wrench now;
      // Contacts that do not overlap are evaluated for laws that reach only.
      if (gap > 0 || overlap > 1e-12 * d)
        now = rig.at(overlap, {x / dt, y / dt, -press / dt}, {wx / dt, wy / dt, 0}, state, dt);
      const Vec3 f = 0.5 * (now.force + before.force), m = 0.5 * (now.moment + before.moment);
      const double work = f.z * press - f.x * x - f.y * y - m.x * wx - m.y * wy;
      sum += work;
      put_in += std::max(work, 0.0);
      before = now;
    }
  }
  return put_in > 0 ? -sum / put_in : 0;
}

bool pushes_apart(const LawRig& rig) {
  std::vector<double> state = rig.fresh(1);
  return rig.at(rig.overlap(), {}, {}, state, rig.dt()).force.z > 0;
}

std::string pushes(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    constexpr int kSteps = 200;
    std::vector<double> state = rig.fresh(1);
    double quarter = 0, full = 0;
    for (int k = 1; k <= kSteps; ++k) {
      full = rig.at(rig.overlap() * k / kSteps, {}, {}, state, rig.dt()).force.z;
      if (4 * k == kSteps) quarter = full;
    }
    // A constant pull, as of a liquid, or one that something stiffer outgrows is none that has the wrong sign.
    require(
        s.manifest().pulls || full >= 1.5 * std::min(quarter, 0.0),
        rig.name() + ": pressed slowly to an overlap of " + short_number(rig.overlap()) +
            " m it pulls i towards j with " + short_number(-full) +
            " N, the more the deeper; n points from j to i and out is the force on i, so one that pushes is +fn * n. " +
            "A law that is meant to pull says \"normal\": \"pulls\" in the manifest");
  }
  return variants_text(all.size());
}

/// What is wrong with a head-on impact that nobody drives; empty where it loses energy, or the law does not push.
std::string gain_of_impact(const LawRig& rig, double speed) {
  if (!pushes_apart(rig)) return "";
  const double longest = 100 * std::max(rig.overlap(), rig.reach()) / speed;  // s; some laws hold the spheres
  double fast = 0;
  for (const double dt : {rig.dt(), 0.1 * rig.dt()}) {
    fast = rig.impact(speed, dt, 0.5, longest).restitution;
    // The step is some fiftieth of the period over two pi, where an undamped spring errs by less than 1e-3; whatever is
    // above because of the step is not at a tenth of it.
    if (fast <= 1.01) return "";
  }
  return "two spheres that meet with " + short_number(speed) + " m/s part with " + short_number(fast) +
         " times that speed, however short the step; a dashpot takes energy where its force is -gn * vn along n, with "
         "vn = " +
         "v . n, positive when parting";
}

constexpr const char* kIfMeant = "; if that is meant, set CALX_LAW_ACTIVE";

std::string energy(Subject& s) {
  const auto all = rigs(s);
  double worst = -1e300;
  for (const LawRig& rig : all) {
    if (rig.law().is_active()) continue;
    for (int path = 0; path < 12; ++path) {
      const double share = created(s, rig, path % 2 != 0);
      worst = std::max(worst, share);
      // The trapezoid errs by the jump of slope times half a step where a spring begins to slide, 1 / 4000 of a leg's
      // work, at most a few times a path.
      if (share < 1e-3) continue;
      const std::string gain = gain_of_impact(rig, LawRig::speed);
      throw Failed{rig.name() + ": a closed path of pressing and shearing gives " + short_number(100 * share) +
                   " % more energy than was put in" + (gain.empty() ? "" : ", and " + gain) + kIfMeant};
    }
    for (const double share : {0.2, 1.0, 2.0}) {
      const std::string gain = gain_of_impact(rig, share * LawRig::speed);
      require(gain.empty(), rig.name() + ": " + gain + kIfMeant);
    }
  }
  if (worst < -1e299) throw Skipped{"the law is CALX_LAW_ACTIVE: it may create energy"};
  return variants_text(all.size()) + ", 12 paths each, least loss " + short_number(-100 * worst) + " %";
}

std::string stable_step(Subject& s) {
  const auto all = rigs(s);
  double worst = 0;
  for (const LawRig& rig : all) {
    if (!rig.table().stable_dt) throw Skipped{"it states no stable step; runs then rely on the Rayleigh limit"};
    const double m = 0.5 * rig.mass();
    // A term that does not push stands beside a spring that a hundredth of the radius stops; inverse squares add.
    const bool alone = pushes_apart(rig);
    const double spring = alone ? 0 : m * std::pow(LawRig::speed / (0.01 * LawRig::radius), 2);
    const double longest = alone ? 1 : 0.02;  // s; such a term may hold the spheres for ever
    const LawRig::Impact fine = rig.impact(LawRig::speed, rig.dt(), 0.5, longest, spring);
    double dt = rig.table().stable_dt(rig.pair().data(), m, 0.5 * LawRig::radius, fine.overlap);
    if (std::isinf(dt)) continue;
    require(dt > 0, rig.name() + ": its stable step is " + short_number(dt) + " s");
    if (!alone) dt = 1 / std::sqrt(1 / (dt * dt) + spring / (0.04 * m));
    for (int phase = 0; phase < 16; ++phase) {
      const LawRig::Impact impact = rig.impact(LawRig::speed, dt, phase / 16.0, longest, spring);
      worst = std::max(worst, impact.restitution);
      // Measured: an undamped linear spring at a tenth of its period, 0.63 sqrt(m / k), parts with up to 1.016 of the
      // speed, depending on where in the step it is met; at 1.9 sqrt(m / k), near the limit of 2, with 2.6.
      if (impact.restitution <= 1.05) continue;
      const double finer = rig.impact(LawRig::speed, 0.1 * dt, phase / 16.0, longest, spring).restitution;
      throw Failed{rig.name() + ": at its stable step, " + short_number(dt) + " s, two spheres part with " +
                   short_number(impact.restitution) + " times the speed they met with" +
                   (finer > 1.05 ? ", and at a tenth of it with " + short_number(finer) +
                                       " times: not the step, the law creates energy; see the sign of force and dashpot"
                                 : "")};
    }
  }
  return variants_text(all.size()) + ", largest speed after over before " + short_number(worst);
}

}  // namespace

std::vector<Check> law_energy_checks() {
  constexpr const char* kind = CALX_CONTACT_LAW;
  return {{"pushes", "Pressed slowly it pushes, or at least does not pull the more the deeper.", kind, false, pushes},
          {"energy", "Neither an impact nor a closed path of pressing, shearing and rolling creates energy.", kind,
           true, energy},
          {"stable-step", "At its stated stable step an impact of two spheres is stable.", kind, false, stable_step}};
}

}  // namespace calx::conformance
