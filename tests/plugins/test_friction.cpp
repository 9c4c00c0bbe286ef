// test_friction.cpp: T8, sliding and rolling of a solid sphere on a plane against closed forms, and the set-up of PFC's
// verification of rolling resistance. Every law where the law matters, calx.hertz-mindlin where it does not.
#include <doctest/doctest.h>

#include <memory>

#include "support/law_bench.hpp"

using namespace bench;

namespace {

const double kG = 9.81, kR = 5e-3, kRho = 2500, kStep = 1e-5;

struct Model {
  const char* library;
  Choices choices;
  Values values;
};
/// The three laws with one friction, rolling model and rolling friction.
std::vector<Model> models(double mu, const std::string& rolling, double mu_r) {
  Values v = {{"restitution", 0.3}, {"friction", mu}, {"rolling_friction", mu_r}};
  if (rolling == "sds") v.insert({{"rolling_stiffness", 500}, {"rolling_viscosity", 0.05}});
  Values linear = v, plastic = v;
  linear["kn"] = 1e4;
  plastic["plasticity"] = 0.5;
  return {{"calx-hertz-mindlin", {{"rolling", rolling}}, v},
          {"calx-linear", {{"rolling", rolling}}, linear},
          {"calx-epam", {{"rolling", rolling}}, plastic}};
}
/// A sphere pressed into the plane by gravity until it rests, then with the given slope (tangent), speed and spin.
Duel placed(const Law& law, double tan_slope, double speed, double spin) {
  Duel d(law, sphere(kR, kRho, {0, 0, kR}, {}), wall());
  d.gravity = {0, 0, -kG};
  for (int k = 0; k < 20000; ++k) d.step(kStep);
  const double a = std::atan(tan_slope);
  d.gravity = {kG * std::sin(a), 0, -kG * std::cos(a)};
  d.i.x.x = 0;
  d.i.v.x = speed;
  d.i.w = {0, spin, 0};
  return d;
}
void run(Duel& d, double time) {
  const int steps = static_cast<int>(std::lround(time / kStep));
  for (int k = 0; k < steps; ++k) d.step(kStep);
}

}  // namespace

TEST_CASE("T8: slide to roll ends at 5/7 of the speed after 2 u0 / (7 mu g)") {
  const double mu = 0.3, u0 = 0.5, t_roll = 2 * u0 / (7 * mu * kG);
  for (const Model& m : models(mu, "none", 0)) {
    CAPTURE(std::string(m.library));
    const Law law(m.library, m.choices, m.values);
    Duel d = placed(law, 0, u0, 0);
    run(d, 0.5 * t_roll);
    CHECK_NEAR(d.i.v.x, u0 - mu * kG * 0.5 * t_roll, 1e-3);
    CHECK_NEAR(d.i.w.y, 2.5 * mu * kG * 0.5 * t_roll / kR, 3e-3);
    double slip_ends = 0;
    for (double t = 0.5 * t_roll; slip_ends == 0 && t < 2 * t_roll; t += kStep) {
      d.step(kStep);
      if (d.i.v.x - d.i.w.y * kR <= 1e-3 * u0) slip_ends = t;
    }
    CHECK_NEAR(slip_ends, t_roll, 2e-3);
    run(d, t_roll);
    CHECK_NEAR(d.i.v.x, u0 * 5 / 7, 2e-3);
    CHECK_NEAR(d.i.w.y * kR, u0 * 5 / 7, 2e-3);
  }
}

TEST_CASE("T8: incline: rolls up to tan = 7/2 mu, slides above") {
  const double mu = 0.3;
  for (const Model& m : models(mu, "none", 0))
    for (const double tan_slope : {0.36, 1.0, 1.1, 1.7}) {
      CAPTURE(std::string(m.library));
      CAPTURE(tan_slope);
      const Law law(m.library, m.choices, m.values);
      Duel d = placed(law, tan_slope, 0, 0);
      run(d, 0.2);
      const double a = std::atan(tan_slope);
      const double rolls = 5.0 / 7.0 * kG * std::sin(a), slides = kG * (std::sin(a) - mu * std::cos(a));
      CHECK_NEAR(d.i.v.x, 0.2 * (tan_slope <= 3.5 * mu ? rolls : slides), 3e-3);
    }
}

TEST_CASE("T8: with rolling resistance it rests, rolls or slides as slope and frictions say") {
  const double mu = 0.2, mu_r = 0.1;  // rolls without slip below tan = 3.5 mu - 2.5 mu_r = 0.45
  for (const char* rolling : {"a", "epsd", "epsd2", "sds"})
    for (const Model& m : models(mu, rolling, mu_r)) {
      CAPTURE(std::string(m.library));
      CAPTURE(std::string(rolling));
      const Law law(m.library, m.choices, m.values);
      if (std::string(rolling) == "epsd") {  // type C rests; the others ring or, type a, creep
        Duel rest = placed(law, 0.095, 0, 0);
        run(rest, 0.5);
        CHECK(std::fabs(rest.i.v.x) < 1e-6);
        CHECK(std::fabs(rest.i.x.x) < 3e-4);  // what winds the spring up
      }
      for (const double tan_slope : {0.4, 0.6}) {
        CAPTURE(tan_slope);
        const double a = std::atan(tan_slope);
        Duel d = placed(law, tan_slope, 0, 0);
        run(d, 0.1);  // the spring of the rolling resistance is wound up first
        const double v = d.i.v.x, w = d.i.w.y;
        run(d, 0.2);
        if (tan_slope < 3.5 * mu - 2.5 * mu_r) {
          CHECK_NEAR(d.i.v.x - v, 0.2 * 5 / 7 * kG * (std::sin(a) - mu_r * std::cos(a)), 5e-3);
          CHECK_NEAR(d.i.w.y * kR, d.i.v.x, 2e-3);
        } else {
          CHECK_NEAR(d.i.v.x - v, 0.2 * kG * (std::sin(a) - mu * std::cos(a)), 5e-3);
          CHECK_NEAR(d.i.w.y - w, 0.2 * 2.5 * kG * std::cos(a) * (mu - mu_r) / kR, 5e-3);
        }
      }
    }
}

TEST_CASE("T8: spin-down without sliding friction, and roll-out") {
  const double mu_r = 0.1, w0 = 100;
  for (const char* rolling : {"a", "cdt", "epsd"})
    for (const Model& m : models(0, rolling, mu_r)) {
      CAPTURE(std::string(m.library));
      CAPTURE(std::string(rolling));
      const Law law(m.library, m.choices, m.values);
      Duel d = placed(law, 0, 0, w0);
      run(d, 0.1);
      CHECK_NEAR(d.i.w.y, w0 - 2.5 * mu_r * kG * 0.1 / kR, 5e-3);
      run(d, 0.5);
      CHECK(std::fabs(d.i.w.y) < 1e-3 * w0);  // stopped, not reversed
    }
  const double v0 = 0.5;
  for (const char* rolling : {"a", "epsd"})
    for (const Model& m : models(0.5, rolling, mu_r)) {
      CAPTURE(std::string(m.library));
      CAPTURE(std::string(rolling));
      const Law law(m.library, m.choices, m.values);
      Duel d = placed(law, 0, v0, v0 / kR);
      run(d, 1.4 * v0 / (mu_r * kG) * 1.5);
      CHECK_NEAR(d.i.x.x, 0.7 * v0 * v0 / (mu_r * kG), 1e-2);
      CHECK(std::fabs(d.i.v.x) < 1e-3 * v0);
    }
}

TEST_CASE("cdt: a sphere that twists as well is braked by the rolling share of its spin") {
  const double mu_r = 0.1, w0 = 100, k = 2.5 * mu_r * kG / kR;
  for (const Model& m : models(0, "cdt", mu_r)) {
    CAPTURE(std::string(m.library));
    const Law law(m.library, m.choices, m.values);
    // Without twist as type a.
    Duel plain = placed(law, 0, 0, w0);
    run(plain, 0.1);
    CHECK_NEAR(plain.i.w.y, w0 - k * 0.1, 5e-3);
    // dw/dt = -k w / sqrt(w^2 + c^2) at a twist c that stays: F(w0) - F(w) = k t, F = sqrt(w^2 + c^2) - c asinh(c / w).
    for (const double twist : {30.0, 200.0}) {
      CAPTURE(twist);
      Duel d = placed(law, 0, 0, w0);
      d.i.w.z = twist;
      run(d, 0.1);
      const auto f = [&](double w) { return std::hypot(w, twist) - twist * std::asinh(twist / w); };
      CHECK_NEAR(d.i.w.z, twist, 1e-9);
      CHECK_NEAR(f(w0) - f(d.i.w.y), k * 0.1, 5e-3);
    }
  }
}

TEST_CASE("T8: gross-sliding oblique impact") {
  const double mu = 0.2, e = 0.7, vn = 1;
  for (const double factor : {1.05, 2.0, 5.0}) {
    CAPTURE(factor);
    const double vt = factor * 3.5 * mu * (1 + e) * vn;
    // Exact with a dashpot that does not pull and the restitution that results.
    const Law law("calx-hertz-mindlin", {{"tension", "clipped"}}, {{"restitution", e}, {"friction", mu}}, {1e11, 0.25},
                  {1e11, 0.25});
    const Rebound b = oblique(law, sphere(kR, kRho, {}, {}), vt, vn, 5e-9);
    CHECK_NEAR(b.vt, vt - mu * (vn + b.vn), 1e-3);
    CHECK_NEAR(b.omega, 2.5 * mu * (vn + b.vn) / kR, 3e-3);  // the lever is the overlap shorter
  }
}

TEST_CASE("T8: PFC's rolling verification: r 5 mm, rho 2500, E 10 MPa, mu 0.8, v0 1 m/s, 1.5 s") {
  const double mu = 0.8, v0 = 1, time = 1.5;
  const Material soft{1e7, 0.25};
  const auto ball = [&](const char* rolling, double mu_r) {
    return std::unique_ptr<Law>(new Law("calx-hertz-mindlin", {{"rolling", rolling}},
                                        {{"restitution", 0.3}, {"friction", mu}, {"rolling_friction", mu_r}}, soft,
                                        soft));
  };
  SUBCASE("flat, no resistance: slides, then rolls at 5/7") {
    const auto law = ball("none", 0);
    Duel d = placed(*law, 0, v0, 0);
    run(d, time);
    const double t = 2 * v0 / (7 * mu * kG);
    CHECK_NEAR(d.i.v.x, 5.0 / 7 * v0, 2e-3);
    CHECK_NEAR(d.i.x.x, v0 * t - 0.5 * mu * kG * t * t + 5.0 / 7 * v0 * (time - t), 2e-3);
  }
  SUBCASE("flat, resistance while it slides and rolls: slowed to the end") {
    const double mu_r = 0.02;
    const auto law = ball("epsd", mu_r);
    Duel d = placed(*law, 0, v0, 0);
    run(d, time);
    // Sliding: u' = -mu g, r w' = 5/2 (mu - mu_r) g; then u' = -5/7 mu_r g.
    const double t = v0 / (mu * kG + 2.5 * (mu - mu_r) * kG), u = v0 - mu * kG * t;
    CHECK_NEAR(d.i.v.x, u - 5.0 / 7 * mu_r * kG * (time - t), 5e-3);
    CHECK_NEAR(d.i.w.y * kR, d.i.v.x, 2e-3);
  }
  SUBCASE("flat, rolling from the start: stops after 0.7 v0^2 / (mu_r g)") {
    const double mu_r = 0.1;
    const auto law = ball("epsd", mu_r);
    Duel d = placed(*law, 0, v0, v0 / kR);
    run(d, time);
    CHECK_NEAR(d.i.x.x, 0.7 * v0 * v0 / (mu_r * kG), 5e-3);
    CHECK(std::fabs(d.i.v.x) < 1e-3 * v0);
  }
  SUBCASE("incline steeper than the resistance: rolls with 5/7 g (sin - mu_r cos)") {
    const double mu_r = 0.1, a = std::atan(0.3);
    const auto law = ball("epsd", mu_r);
    Duel d = placed(*law, 0.3, 0, 0);
    run(d, time);
    CHECK_NEAR(d.i.v.x, time * 5 / 7 * kG * (std::sin(a) - mu_r * std::cos(a)), 1e-2);
  }
  SUBCASE("incline flatter than the resistance: stays") {
    const auto law = ball("epsd", 0.4);
    Duel d = placed(*law, 0.3, 0, 0);
    run(d, time);
    CHECK(std::fabs(d.i.v.x) < 1e-6);
    CHECK(std::fabs(d.i.x.x) < 1e-3);
  }
}
