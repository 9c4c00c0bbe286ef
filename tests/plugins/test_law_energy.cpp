// test_law_energy.cpp: energy of every contact law: an account that closes, no gain from a closed path, nothing of size
// left behind at parting, and a stable step that keeps it. One body for all laws and options.
#include <doctest/doctest.h>

#include <random>

#include "law_setups.hpp"

using namespace bench;

namespace {
const double kDt = 1e-6;
}  // namespace

TEST_CASE("energy outputs sum to the work done in oblique impacts") {
  for (const Setup& setup : all_setups()) {
    const Law law(setup.library, setup.choices, setup.values);
    CAPTURE(std::string(law.table().symbol));
    for (const double angle : {0.1, 0.5, 1.0}) {
      CAPTURE(angle);
      Body s = sphere(1.25e-3, 2000, {}, {}, {20, -30, 10});
      s.x = {0, 0, 2 * s.r};
      s.v = {0.5 * std::sin(angle), 0, -0.5 * std::cos(angle)};
      Duel d(law, s, sphere(1.25e-3, 2000, {}, {}));
      const double before = d.kinetic();
      // 30 to 40 steps a contact, as the rule for the time step gives.
      const double dt = 1e-5;
      bool touched = false;
      for (int k = 0; k < 3000; ++k) {
        d.step(dt);
        touched = touched || d.overlap > 0;
        if (touched && d.overlap <= 0) break;
      }
      const Record& r = d.record;
      const double lost = before - d.kinetic();
      const double told = r.friction + r.damping + r.plastic + (d.overlap > 0 ? r.elastic : 0);
      CAPTURE(r.friction / before);
      CAPTURE(r.damping / before);
      CAPTURE(r.plastic / before);
      CHECK(lost > 0);
      CHECK(std::fabs(lost - told) < 0.01 * before);
    }
  }
}

TEST_CASE("no closed path of pressing and shearing gives more energy than was stored") {
  // Presets of every law. Legs between random corners in overlap and the contact plane, back to the first corner; one
  // path is the worst case of the displacement form: sheared while shallow, sheared back while deep.
  std::mt19937 bits(11);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (bits() / 4294967296.0); };
  double created = 0;  // largest share of the stored energy, by the displacement form
  auto setups = all_setups();
  setups.push_back({"calx-hertz-mindlin", {{"tangential", "displacement"}}, {{"restitution", 1}, {"friction", 0.5}}});
  for (const Setup& setup : setups) {
    const bool kept = setup.choices.count("tangential") && setup.choices.at("tangential") == "displacement";
    const Law law(setup.library, setup.choices, setup.values);
    CAPTURE(std::string(law.table().symbol));
    for (int path = 0; path < 12; ++path) {
      std::vector<V3> corners = {{0, 0, 6e-6}, {0, 0, 4e-6}, {1e-7, 0, 4e-6}, {1e-7, 0, 8e-6}, {0, 0, 8e-6}};
      for (int k = 1; path > 0 && k < 5; ++k)
        corners[static_cast<std::size_t>(k)] = {uniform(-5e-7, 5e-7), uniform(-5e-7, 5e-7), uniform(1e-6, 1e-5)};
      corners.push_back(corners[0]);
      auto state = law.fresh();
      const double r = 1e-3;
      double work = 0;  // done on the contact
      V3 at{0, 0, 1e-6}, f_before;
      Output o;
      const auto go = [&](const V3& to, int steps) {
        const V3 leg = (to - at) * (1.0 / steps);
        for (int k = 0; k < steps; ++k) {
          at = at + leg;
          Input row;
          const double in[CALX_IN_COUNT] = {at.z, 0, 0, 1, leg.x / kDt, leg.y / kDt, -leg.z / kDt, 0, 0, 0, 0.5 * r,
                                            1e-6, r, r, 0};
          std::memcpy(row.in, in, sizeof in);
          o = law.evaluate(row, state, kDt);
          const V3 f{o[0], o[1], o[2]};
          work += 0.5 * ((f.z + f_before.z) * leg.z - (f.x + f_before.x) * leg.x - (f.y + f_before.y) * leg.y);
          f_before = f;
        }
      };
      go(corners[0], 2000);
      work = 0;
      const double stored = o[CALX_OUT_ELASTIC];
      for (std::size_t k = 1; k < corners.size(); ++k) go(corners[k], 2000);
      const double lost = work - (o[CALX_OUT_ELASTIC] - stored);
      if (kept)
        created = std::fmax(created, -lost / stored);
      else
        CHECK(lost > -1e-6 * stored);
    }
  }
  CHECK(created > 1e-4);  // the path tells the forms apart
}

TEST_CASE("what a contact still stores when it ends is nothing against what it lost") {
  // A law cannot know that a step is the last one touching, so this energy leaves the account unbooked. Both springs
  // fade with the force that limits them; what stays is an effect of the last step's size, here 30 to 40 steps a
  // contact.
  std::mt19937 bits(3);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (bits() / 4294967296.0); };
  for (const Setup& setup : all_setups()) {
    const Law law(setup.library, setup.choices, setup.values);
    CAPTURE(std::string(law.table().symbol));
    double left = 0, lost = 0;
    for (int k = 0; k < 60; ++k) {
      const Body still = sphere(1.25e-3, 2000, {}, {});
      Body s = sphere(1.25e-3, 2000, {0, 0, 2.5e-3}, {uniform(-.3, .3), uniform(-.3, .3), uniform(-.5, -.02)},
                      {uniform(-50, 50), uniform(-50, 50), uniform(-50, 50)});
      Duel d(law, s, still);
      const double before = d.kinetic();
      double stored = 0;
      for (int n = 0; n < 4000; ++n) {
        d.step(1e-5);
        if (d.overlap > 0)
          stored = d.record.elastic;
        else if (n > 0)
          break;
      }
      if (d.overlap > 0) continue;  // sticks
      left += std::fabs(stored);
      lost += before - d.kinetic();
    }
    CHECK(lost > 0);
    CHECK(left < 1e-3 * lost);
  }
}

TEST_CASE("the stable step keeps an undamped contact's energy, and a dozen of them are too much") {
  const Values none = {{"restitution", 1}, {"friction", 0}};
  Values linear = none, plastic = none;
  linear["kn"] = 1e4;
  plastic["plasticity"] = 0;
  for (const Setup& s : {Setup{"calx-hertz-mindlin", {}, none}, Setup{"calx-linear", {}, linear},
                         Setup{"calx-epam", {}, plastic}, Setup{"calx-epam", {{"exponent", "1"}}, plastic}}) {
    CAPTURE(std::string(s.library));
    const Law law(s.library, s.choices, s.values);
    const Body ball = sphere(1e-3, 2500, {}, {});
    Record r;
    restitution(law, ball, ball, 0.5, 1e-8, 1, &r);
    const double dt = law.table().stable_dt(law.pair().data(), 0.5 * ball.m, 0.5 * ball.r, r.max_overlap);
    CHECK_NEAR(restitution(law, ball, ball, 0.5, dt, 1), 1, 0.05);
    CHECK(r.contact_time / dt > 15);  // steps a collision
    CHECK(r.contact_time / dt < 40);
    CHECK(std::fabs(restitution(law, ball, ball, 0.5, 14 * dt, 1) - 1) > 0.2);  // beyond 2 / omega
  }
  // Whatever is stiffest or most damped sets it.
  const auto step = [](const Values& more, const char* rolling) {
    Values v = {{"kn", 1e4}, {"restitution", 0.5}, {"friction", 0.5}};
    v.insert(more.begin(), more.end());
    const Law law("calx-linear", {{"rolling", rolling}}, v);
    return law.table().stable_dt(law.pair().data(), 1e-6, 1e-3, 1e-5);
  };
  CHECK_NEAR(step({}, "none"), 0.17 * std::sqrt(1e-6 / 1e4), 1e-12);
  CHECK_NEAR(step({{"kt", 4e4}}, "none"), 0.17 * std::sqrt(1e-6 / 4e4), 1e-12);
  CHECK_NEAR(step({{"rolling_stiffness", 9e4}}, "sds"), 0.17 * std::sqrt(1e-6 / 9e4), 1e-12);
  CHECK_NEAR(step({{"damping", 10}}, "none"), 0.34 * 1e-6 / 10, 1e-12);
  CHECK_NEAR(step({{"damping_rate", 1e7}}, "none"), 0.34 / 1e7, 1e-12);
  CHECK_NEAR(step({{"rolling_viscosity", 5}}, "sds"), 0.34 * 1e-6 / 5, 1e-12);
}
