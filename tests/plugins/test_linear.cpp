// test_linear.cpp: calx.linear against the damped oscillator, MFiX' DEM01 to DEM03 and DEM05, and LAMMPS' way to give
// a dashpot. Data: tests/data/README.md.
#include <doctest/doctest.h>

#include <memory>

#include "support/law_bench.hpp"
#include "support/table.hpp"

using namespace bench;

namespace {
const char* kLib = "calx-linear";
const double kG = 9.80665;  // m/s^2, as MFiX takes it

/// Normal force of one contact, N, from overlap and separation speed.
double normal_force(const Law& law, double overlap, double vn, double m_eff) {
  if (overlap <= 0) return 0;
  auto state = law.fresh();
  Input row;
  row[CALX_IN_OVERLAP] = overlap;
  row[CALX_IN_NZ] = 1;
  row[CALX_IN_VZ] = vn;
  row[CALX_IN_M_EFF] = m_eff;
  return law.evaluate(row, state, 1e-6)[CALX_OUT_FZ];
}
}  // namespace

TEST_CASE("the dashpot returns the restitution; clipped it follows its closed form") {
  for (const double e : {0.3, 0.5, 0.9}) {
    const Body s = sphere(1e-3, 2500, {}, {});
    const double dt = pi * std::sqrt(0.5 * s.m / 1e3) / 20000;
    const Law free(kLib, {}, {{"kn", 1e3}, {"restitution", e}, {"friction", 0}});
    Record r;
    CHECK_NEAR(restitution(free, s, s, 0.5, dt, 1, &r), e, 1e-3);
    CHECK_NEAR(r.damping, 0.25 * s.m * 0.25 * (1 - e * e), 2e-3);
    const Law cut(kLib, {{"tension", "clipped"}}, {{"kn", 1e3}, {"restitution", e}, {"friction", 0}});
    const double z = -std::log(e) / std::sqrt(pi * pi + std::log(e) * std::log(e)), w = std::sqrt(1 - z * z);
    const double exact = std::exp(-z / w * (pi - std::atan(2 * z * w / (1 - 2 * z * z))));
    CHECK_NEAR(restitution(cut, s, s, 0.5, dt, 1), exact, 1e-3);
  }
}

TEST_CASE("dashpots can be given outright, per mass, and for the tangent") {
  const Law law(kLib, {},
                {{"kn", 1e4},
                 {"restitution", 1},
                 {"friction", 0.5},
                 {"damping", 3},
                 {"damping_rate", 200},
                 {"tangential_damping", 0.5}});
  const double m = 1e-3;
  CHECK_NEAR(normal_force(law, 1e-5, -0.1, m), 1e4 * 1e-5 + (3 + 200 * m) * 0.1, 1e-12);
  CHECK(law.pair("given_t") == 1.5);
  CHECK(law.pair("rate_t") == 100);
  CHECK_NEAR(law.pair("kt"), 2.0 / 7.0 * 1e4, 1e-12);
  const Law wrong(kLib, {}, {{"kn", 0}});
  CHECK(wrong.status() == CALX_E_CONFIG);
  CHECK(wrong.message() == "kn is 0 N/m; a contact needs a positive normal stiffness");
}

TEST_CASE("LAMMPS gran/hooke/history: same force from k_n, gamma_n, k_t, gamma_t below the Coulomb limit") {
  // F_t = -(k_t xi + m* gamma_t v_t), F_n = k_n delta - m* gamma_n v_n; gamma_t = gamma_n / 2 by default.
  const double kn = 2e5, kt = 2.0 / 7.0 * kn, gamma = 50, m = 1e-3, dt = 1e-6, vt = 1e-3;
  const Law law(kLib, {},
                {{"kn", kn},
                 {"kt", kt},
                 {"restitution", 1},
                 {"friction", 0.5},
                 {"damping_rate", gamma},
                 {"tangential_damping", 0.5}});
  auto state = law.fresh();
  Input row;
  row[CALX_IN_OVERLAP] = 1e-4;
  row[CALX_IN_NZ] = 1;
  row[CALX_IN_VX] = vt;
  row[CALX_IN_VZ] = -0.01;
  row[CALX_IN_M_EFF] = m;
  Output o;
  for (int k = 1; k <= 100; ++k) o = law.evaluate(row, state, dt);
  CHECK_NEAR(o[CALX_OUT_FX], -(kt * 100 * vt * dt + m * 0.5 * gamma * vt), 1e-12);
  CHECK_NEAR(o[CALX_OUT_FZ], kn * 1e-4 + m * gamma * 0.01, 1e-12);
  // Far beyond the limit: mu F_n, and the spring is what that force needs.
  for (int k = 0; k < 1000000; ++k) o = law.evaluate(row, state, dt);
  CHECK_NEAR(o[CALX_OUT_FX], -0.5 * o[CALX_OUT_FZ], 1e-12);
  CHECK_NEAR(state[0], 0.5 * o[CALX_OUT_FZ] / kt, 1e-12);
}

TEST_CASE("MFiX DEM01: free fall and bounce") {
  std::map<std::pair<double, double>, std::vector<Row>> blocks;
  for (const Row& row : read_table("mfix_dem/DEM01_position.csv"))
    blocks[{number(row, "kn_N_m"), number(row, "restitution")}].push_back(row);
  REQUIRE(blocks.size() == 19);
  for (const auto& block : blocks) {
    const Law law(kLib, {}, {{"kn", block.first.first}, {"restitution", block.first.second}, {"friction", 0}});
    Duel d(law, sphere(0.1, 2600, {0, 0, 0.5}, {}), wall());
    d.gravity = {0, 0, -kG};
    const double dt = 2e-6;
    // Semi-implicit Euler starts half a step ahead of the exact parabola; take that half step back.
    d.i.v.z = 0.5 * kG * dt;
    double t = 0, worst = 0;
    V3 before = d.i.x;
    for (const Row& row : block.second) {
      const double until = number(row, "time_s");
      for (; t < until - 1e-12; t += dt) {
        before = d.i.x;
        d.step(dt);
      }
      const double z = d.i.x.z + (before.z - d.i.x.z) * (t - until) / dt;
      worst = std::fmax(worst, std::fabs(z - number(row, "position_m")) / number(row, "position_m"));
    }
    CAPTURE(block.first.first);
    CAPTURE(block.first.second);
    CHECK(worst < 1e-3);
  }
}

TEST_CASE("MFiX DEM02: bounce heights tend to the hard-sphere limit as the spring stiffens") {
  int before = -1;
  for (const double kn : {5e4, 5e5, 5e6}) {
    const Law law(kLib, {}, {{"kn", kn}, {"restitution", 0.9}, {"friction", 0}});
    Duel d(law, sphere(0.1, 2600, {0, 0, 0.5}, {}), wall());
    d.gravity = {0, 0, -kG};
    const double dt = pi * std::sqrt(d.i.m / kn) / 400;
    int bounce = 0, good = 0;
    double last = 0;
    for (double t = 0; t < 20 && bounce <= 30; t += dt) {
      d.step(dt);
      if (last > 0 && d.i.v.z <= 0 && d.i.x.z > 0.1) {
        ++bounce;
        const double limit = 0.1 + 0.4 * std::pow(0.9, 2 * bounce);
        if (good == bounce - 1 && std::fabs(d.i.x.z - limit) < 0.01 * limit) good = bounce;
      }
      last = d.i.v.z;
    }
    CAPTURE(kn);
    CHECK(good > before);  // 0, 2 and more than 15 bounces within 1 %
    before = good;
  }
  CHECK(before >= 15);
}

TEST_CASE("MFiX DEM03: two stacked, compressed spheres between walls") {
  std::vector<std::vector<double>> lower, upper;
  for (const auto& row : read_numbers("mfix_dem/DEM03_POST_POS1.dat"))
    if (row.size() == 4) lower.push_back(row);
  for (const auto& row : read_numbers("mfix_dem/DEM03_POST_POS2.dat"))
    if (row.size() == 4) upper.push_back(row);
  REQUIRE(lower.size() == upper.size());
  REQUIRE(lower.size() == 609);
  const double r = 0.5e-3;
  const double m1 = 20000 * 4.0 / 3 * pi * r * r * r, m2 = 0.5 * m1;
  const double restitutions[] = {1, 0.9, 0.8, 0.7, 0.6, 0.5};
  int block = -1;
  double t = 0, x1 = 0, x2 = 0, v1 = 0, v2 = 0, worst = 0;
  const double dt = 2e-8;
  std::unique_ptr<Law> law;
  for (std::size_t k = 0; k < lower.size(); ++k) {
    if (lower[k][0] == 0) {
      ++block;
      law.reset(new Law(kLib, {}, {{"kn", 1e3}, {"restitution", restitutions[block]}, {"friction", 0}}));
      t = v1 = v2 = 0;
      x1 = 0.45e-3;
      x2 = 1.35e-3;
    }
    for (; t < lower[k][0] - 0.5 * dt; t += dt) {
      const double floor = normal_force(*law, r - x1, v1, m1);
      const double pair = normal_force(*law, 2 * r - (x2 - x1), v2 - v1, m1 * m2 / (m1 + m2));
      const double roof = normal_force(*law, x2 + r - 1.8e-3, -v2, m2);
      v1 += dt * ((floor - pair) / m1 - kG);
      v2 += dt * ((pair - roof) / m2 - kG);
      x1 += dt * v1;
      x2 += dt * v2;
    }
    worst = std::fmax(worst, std::fabs(x1 / lower[k][1] - 1));
    worst = std::fmax(worst, std::fabs(x2 / upper[k][1] - 1));
  }
  CHECK(block == 5);
  CHECK(worst < 1e-4);
}

TEST_CASE("MFiX DEM05: oblique impact with linear springs") {
  const Law law(kLib, {}, {{"kn", 1.72e7}, {"kt", 1.48e7}, {"restitution", 1}, {"friction", 0.092}});
  std::vector<std::vector<double>> answers;
  for (const auto& row : read_numbers("kharaz_mfix/mfix_DEM05_POST_COEFF.dat"))
    if (row.size() == 3) answers.push_back(row);
  REQUIRE(answers.size() == 60);
  for (std::size_t k = 0; k < 30; ++k) {
    const double angle = answers[k][0] * pi / 180;
    Duel d(law, sphere(0.0025, 4000, {0, 0, 0.0025}, {3.9 * std::sin(angle), 0, -3.9 * std::cos(angle)}), wall());
    REQUIRE(d.collide(5e-9, 1));
    CAPTURE(answers[k][0]);
    // MFiX takes 50 steps a contact; 1 % of the full scale, 2 % where its first steps decide, below 4 degrees.
    CHECK(std::fabs(d.i.v.x / (3.9 * std::sin(angle)) - answers[k][2]) < (answers[k][0] < 4 ? 0.02 : 0.01));
  }
}
