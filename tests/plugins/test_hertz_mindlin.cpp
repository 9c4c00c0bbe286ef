// test_hertz_mindlin.cpp: calx.hertz-mindlin against closed forms, published benchmarks and stored answers of other
// codes. Data: tests/data/README.md.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"
#include "support/table.hpp"

using namespace bench;

namespace {

const char* kLib = "calx-hertz-mindlin";
const Material kRigid{1e14, 0.23};  // 1000 times stiffer than steel

struct Rebound {
  double vt, vn, omega;  // of the centre; omega positive when friction slowed the slide
};
/// Oblique impact on a plane: speed, angle from the normal.
Rebound oblique(const Law& law, const Body& shape, double speed, double angle, double dt, Duel** keep = nullptr) {
  Body s = shape;
  s.x = {0, 0, s.r};
  s.v = {speed * std::sin(angle), 0, -speed * std::cos(angle)};
  static Duel* last = nullptr;
  delete last;
  last = new Duel(law, s, wall());
  REQUIRE(last->collide(dt, 1));
  if (keep) *keep = last;
  return {last->i.v.x, last->i.v.z, last->i.w.y};
}

}  // namespace

TEST_CASE("Tsuji dashpot returns the restitution asked for when tension is allowed") {
  // Chung and Ooi test 3: 0.5 %; e = 0 needs an infinite time to part and is left out.
  for (const double e : {0.1, 0.3, 0.5, 0.9, 1.0}) {
    const Law law(kLib, {}, {{"restitution", e}, {"friction", 0}}, {3.8e11, 0.23}, {3.8e11, 0.23});
    const Body s = sphere(2.5e-3, 4000, {}, {});
    Record r;
    const double out = restitution(law, s, s, 3.9, 5e-9, 1, &r);
    CHECK_NEAR(out, e, 2e-3);
    const double before = 0.25 * s.m * 3.9 * 3.9;
    CHECK(std::fabs(r.damping - before * (1 - out * out)) < 2e-3 * before);
    CHECK(std::fabs(r.friction) < 1e-9 * before);
  }
}

TEST_CASE("clipping the tensile part raises restitution 0.3 to 0.397") {
  const Law law(kLib, {{"tension", "clipped"}}, {{"restitution", 0.3}, {"friction", 0}});
  Record r;
  CHECK_NEAR(restitution(law, sphere(1.25e-3, 2100, {}, {}), wall(), 0.5, 1e-7, 1, &r), 0.397, 2e-3);
  CHECK(r.min_force == 0);
}

TEST_CASE("Chung and Ooi tests 1 and 2: Hertz peak and duration") {
  struct Case {
    double r, young, nu, rho, v, overlap, force, time;
    bool pair;
  };
  // Last three: closed Hertz solution, m, N, s.
  const Case cases[] = {{0.01, 4.8e10, 0.2, 2800, 20, 274.1127e-6, 10696.89, 40.3395e-6, true},
                        {0.01, 2e10, 0.25, 2500, 20, 368.304e-6, 7108.241, 54.201e-6, true},
                        {0.1, 7e10, 0.3, 2699, 0.2, 49.7172e-6, 11369.86, 731.657e-6, false},
                        {0.1, 4e10, 0.35, 1800, 0.2, 52.1233e-6, 7232.681, 767.066e-6, false}};
  for (const Case& c : cases) {
    const Material m{c.young, c.nu};
    // A plane of 1e14 Pa moves the peak by 0.03 %, within the 0.1 % asked for.
    const Law law(kLib, {}, {{"restitution", 1}, {"friction", 0.35}}, m, c.pair ? m : kRigid);
    const Body s = sphere(c.r, c.rho, {}, {});
    Record r;
    const double e = restitution(law, s, c.pair ? s : wall(), c.v, c.time / 4000, 1, &r);
    CHECK_NEAR(e, 1, 1e-3);
    CHECK_NEAR(r.max_overlap, c.overlap, 1e-3);
    CHECK_NEAR(r.max_force, c.force, 1e-3);
    CHECK_NEAR(r.contact_time, c.time, 5e-3);
  }
}

TEST_CASE("Chung and Ooi test 1: the digitised force-displacement curve is the law's") {
  const Material glass{4.8e10, 0.2};
  const Law law(kLib, {}, {{"restitution", 1}, {"friction", 0}}, glass, glass);
  double worst = 0;
  for (const Row& row : read_table("chung_ooi/test1_force_vs_displacement_um_kN_digitised.csv")) {
    auto state = law.fresh();
    const double f = press(law, state, 1e-6 * number(row, "x_displacement_um"), 0.01, 0.01);
    worst = std::fmax(worst, std::fabs(f - 1e3 * number(row, "normal_force_kN")) / 10697);
  }
  CHECK(worst < 0.015);  // reading error of the points: 1 %
}

TEST_CASE("Chung and Ooi test 4: oblique impact of alumina on a rigid plane") {
  const Law law(kLib, {}, {{"restitution", 0.98}, {"friction", 0.092}}, {3.8e11, 0.23}, kRigid);
  const Body ball = sphere(0.0025, 4000, {}, {});
  double et_error = 0, spin_error = 0, angle_error = 0;
  int count = 0;
  for (const Row& row : read_table("chung_ooi/test4_oblique_impact_digitised.csv")) {
    if (row.at("series") != "Al_oxide_DEM") continue;
    const double angle = number(row, "incident_angle_deg") * pi / 180;
    const Rebound b = oblique(law, ball, 3.9, angle, 2e-9);
    const double et = b.vt / (3.9 * std::sin(angle));
    et_error += std::fabs(et / number(row, "tangential_restitution") - 1);
    spin_error += std::fabs(b.omega / -number(row, "final_omega_rad_s") - 1);
    angle_error += std::fabs(std::atan2(b.vt - b.omega * ball.r, b.vn) * 180 / pi -
                             number(row, "rebound_angle_contact_patch_deg"));
    ++count;
    if (angle > 34 * pi / 180) {  // gross sliding: exact
      CHECK_NEAR(et, 1 - 0.092 * 1.98 / std::tan(angle), 1e-3);
      CHECK_NEAR(b.omega, 2.5 * 0.092 * 1.98 * 3.9 * std::cos(angle) / ball.r, 3e-3);  // lever r - overlap
    }
  }
  REQUIRE(count == 13);
  CHECK(et_error / count < 0.02);
  CHECK(spin_error / count < 0.02);
  CHECK(angle_error / count < 0.7);  // degrees, 2 % of the mean angle
}

TEST_CASE("Chung and Ooi test 5: tangential rebound against its incidence") {
  // The points of DEM and FEM differ from each other by up to 1.2 below 4.5. Gated: where the contact slides nearly
  // throughout (3 % of psi1), and, below, that the energy-keeping spring lies within 0.65 of the FEM points.
  const Law law(kLib, {{"tangential", "rescaled"}}, {{"restitution", 1}, {"friction", 0.3}}, {2.08e11, 0.3},
                {1e14, 0.3});
  const double r = 1e-5, mu_vn = 0.3 * 5;
  int sliding = 0;
  for (const Row& row : read_table("chung_ooi/test5_normalised_digitised.csv")) {
    const double psi1 = number(row, "psi1_Vt_over_muVn");
    Body s = sphere(r, 7850, {0, 0, r}, {psi1 * mu_vn, 0, -5});
    Duel d(law, s, wall());
    REQUIRE(d.collide(1e-10, 1));
    const bool patch = row.at("quantity")[0] == 'p';
    const double value = patch ? (d.i.v.x - d.i.w.y * r) / mu_vn : -d.i.w.y * r / mu_vn;
    if (psi1 > 5.9) {
      CHECK(std::fabs(value - number(row, "value")) < 0.03 * psi1);
      ++sliding;
    } else if (patch && row.at("series") == "FEM") {
      CHECK(std::fabs(value - number(row, "value")) < 0.65);
    }
  }
  CHECK(sliding >= 8);
}

TEST_CASE("Chung and Ooi test 6: a spinning sphere dropped on a plane") {
  const Law law(kLib, {}, {{"restitution", 0.5}, {"friction", 0.4}}, {7e10, 0.33}, kRigid);
  const Law clipped(kLib, {{"tension", "clipped"}}, {{"restitution", 0.5}, {"friction", 0.4}}, {7e10, 0.33}, kRigid);
  for (const Row& row : read_table("chung_ooi/test6_beta_digitised.csv")) {
    const double s = number(row, "s_3.5mu(1+e)Vn_over_Vt");
    if (s > 0.9) continue;  // gross sliding only: beta = s - 1 exactly
    const double vt = 3.5 * 0.4 * 1.5 * 0.2 / s;
    Body b = sphere(0.1, 2700, {0, 0, 0.1}, {0, 0, -0.2}, {0, vt / 0.1, 0});
    Duel d(law, b, wall());
    REQUIRE(d.collide(2e-7, 1));
    const double beta = -(d.i.w.y * 0.1 - d.i.v.x) / vt;
    // The dashpot pulls at the end, so the pushing impulse is a little more than (1 + e) m Vn.
    CHECK(std::fabs(beta - (s - 1)) < 0.03);
    CHECK(std::fabs(beta - number(row, "beta")) < 0.03);
    Duel c(clipped, b, wall());
    REQUIRE(c.collide(2e-7, 1));
    const double exact = s * (1 + c.i.v.z / 0.2) / 1.5 - 1;
    CHECK(std::fabs(-(c.i.w.y * 0.1 - c.i.v.x) / vt - exact) < 7e-3);  // it sticks a little at the very end
  }
}

TEST_CASE("Chung and Ooi test 7: opposite spins, head-on, stay as they are") {
  const Law law(kLib, {}, {{"restitution", 0.5}, {"friction", 0.4}}, {7e10, 0.33}, {7e10, 0.33});
  Body a = sphere(0.1, 2700, {0, 0, 0.2}, {0, 0, -0.2}, {0, 3, 0});
  Body b = sphere(0.1, 2700, {0, 0, 0}, {0, 0, 0.2}, {0, -3, 0});
  // Surfaces move alike at the contact point: no sliding.
  Duel d(law, a, b);
  REQUIRE(d.collide(1e-6, 1));
  CHECK(std::fabs(d.i.v.x) < 1e-3 * 0.2);
  CHECK_NEAR(d.i.w.y, 3, 1e-3);
  CHECK_NEAR(d.j.w.y, -3, 1e-3);
}

TEST_CASE("MFiX DEM05: Kharaz' alumina spheres, Hertzian contact") {
  // MFiX' Hertzian particle-wall answers, 1 % of the full scale; below 10 degrees the tangential spring decides.
  const Law law(kLib, {}, {{"restitution", 1}, {"friction", 0.092}}, {3.8e11, 0.23}, {7e10, 0.25});
  const Body ball = sphere(0.0025, 4000, {}, {});
  const auto rows = read_numbers("kharaz_mfix/mfix_DEM05_POST_COEFF.dat");
  std::vector<std::vector<double>> answers;
  for (const auto& row : rows)
    if (row.size() == 3) answers.push_back(row);
  REQUIRE(answers.size() == 60);
  for (std::size_t k = 30; k < 60; ++k) {
    const double angle = answers[k][0] * pi / 180;
    if (answers[k][0] < 10) continue;
    const Rebound b = oblique(law, ball, 3.9, angle, 5e-9);
    CHECK(std::fabs(b.vt / (3.9 * std::sin(angle)) - answers[k][2]) < 0.012);
  }
  // Against the experiment: RMS of the absolute error; MFiX' own is 0.08 over the same angles.
  double sum = 0;
  int count = 0;
  for (const Row& row : read_table("kharaz_mfix/kharaz_experiment.csv")) {
    if (row.at("quantity") != "tangential_restitution" || number(row, "impact_angle_deg") < 9) continue;
    const double angle = number(row, "impact_angle_deg") * pi / 180;
    const double et = oblique(law, ball, 3.9, angle, 5e-9).vt / (3.9 * std::sin(angle));
    sum += (et - number(row, "value")) * (et - number(row, "value"));
    ++count;
  }
  REQUIRE(count >= 6);
  CHECK(std::sqrt(sum / count) < 0.03);
}

TEST_CASE("stored answers of the open-source comparison: normal impact on steel and the sliding pair") {
  const Material m1{1e9, 0.2}, steel{2.1e11, 0.2};
  {
    const Law law(kLib, {}, {{"restitution", 0.4}, {"friction", 0.2}}, m1, steel);
    CHECK_NEAR(restitution(law, sphere(1e-3, 2500, {}, {}), wall(), 1, 1e-8, 1), 0.4, 2.5e-3);
  }
  const Law law(kLib, {}, {{"restitution", 0.4}, {"friction", 0.2}}, steel, m1);
  Duel d(law, sphere(1e-3, 7200, {0, 0, 1e-3}, {}), wall());
  d.gravity = {5, 0, -5};
  for (int k = 0; k < 10001; ++k) d.step(5e-7);
  CHECK_NEAR(d.i.v.x, 0.020002, 1e-3);
  CHECK_NEAR(d.i.w.y, 12.50, 1e-3);
  CHECK_NEAR(d.i.x.x, 5.002e-5, 1e-3);
}

TEST_CASE("LIGGGHTS and LAMMPS: floor bounce, oblique floor and oblique pair with spin") {
  // Answers of LIGGGHTS 3.8.0 (Debian) after 2000 steps of 9.8e-7 s. It takes friction from |F_n| while the dashpot
  // pulls, this law takes none there; Yade, which clips the pull, gives 0.2110, 175.2 and -77.40 for the last figures
  // of each.
  const Law law(kLib, {}, {{"restitution", 0.3}, {"friction", 0.5}});
  const double r = 1.25e-3, rho = 2100;
  const auto run = [&](const Body& i, const Body& j, double g) {
    Duel d(law, i, j);
    d.gravity = {0, 0, -g};
    for (int k = 0; k < 2000; ++k) d.step(9.8e-7);
    return d;
  };
  CHECK_NEAR(run(sphere(r, rho, {0, 0, 0.001251}, {0, 0, -0.5}), wall(), 9.81).i.v.z, 0.13316, 2e-3);
  const Body slid = run(sphere(r, rho, {0, 0, 0.001251}, {0.3, 0, -0.5}), wall(), 9.81).i;
  CHECK_NEAR(slid.v.x, 0.2139, 0.02);
  CHECK_NEAR(slid.w.y, 171.2, 0.04);
  const Body hit =
      run(sphere(r, rho, {0.025, 0, 0}, {0.5, 0.2, 0}), sphere(r, rho, {0.0275025, 0, 0}, {-0.5, 0, 0}, {0, 0, 50}), 0)
          .i;
  CHECK_NEAR(hit.v.x, -0.14885, 2e-3);
  CHECK_NEAR(hit.v.y, 0.16471, 0.01);
  CHECK_NEAR(hit.w.z, -75.16, 0.03);
}

TEST_CASE("slide to roll, incline and gross sliding") {
  const double g = 9.81, r = 5e-3, mu = 0.3;
  const Law law(kLib, {}, {{"restitution", 0.3}, {"friction", mu}});
  const auto settled = [&](V3 gravity) {
    Duel d(law, sphere(r, 2500, {0, 0, r}, {}), wall());
    d.gravity = {0, 0, gravity.z};
    for (int k = 0; k < 40000; ++k) d.step(1e-5);
    d.gravity = gravity;
    return d;
  };
  SUBCASE("slide to roll: u = 5/7 u0") {
    Duel d = settled({0, 0, -g});
    d.i.v.x = 0.5;
    const double t_roll = 2 * 0.5 / (7 * mu * g);
    for (double t = 0; t < 0.5 * t_roll; t += 1e-5) d.step(1e-5);
    CHECK_NEAR(d.i.v.x, 0.5 - mu * g * 0.5 * t_roll, 2e-3);
    CHECK_NEAR(d.i.w.y, 2.5 * mu * g * 0.5 * t_roll / r, 2e-3);
    for (double t = 0; t < t_roll; t += 1e-5) d.step(1e-5);
    CHECK_NEAR(d.i.v.x, 0.5 * 5 / 7, 2e-3);
  }
  SUBCASE("incline: rolls below tan = 7/2 mu, slides above") {
    for (const double tilt : {20.0, 60.0}) {
      const double a = tilt * pi / 180;
      Duel d = settled({g * std::sin(a), 0, -g * std::cos(a)});
      for (int k = 0; k < 20000; ++k) d.step(1e-5);
      const double rolls = 5.0 / 7.0 * g * std::sin(a), slides = g * (std::sin(a) - mu * std::cos(a));
      CHECK_NEAR(d.i.v.x, 0.2 * (std::tan(a) <= 3.5 * mu ? rolls : slides), 5e-3);
    }
  }
}

TEST_CASE("rolling resistance holds, rolls and spins down as the closed forms say") {
  const double g = 9.81, r = 5e-3, mu_r = 0.1;
  const auto on_slope = [&](const char* model, double tan_slope, double friction, V3 spin, double time) {
    const Law law(kLib, {{"rolling", model}},
                  {{"restitution", 0.3},
                   {"friction", friction},
                   {"rolling_friction", mu_r},
                   {"rolling_stiffness", 500},
                   {"rolling_viscosity", 0.05}});
    Duel d(law, sphere(r, 2500, {0, 0, r}, {}), wall());
    d.gravity = {0, 0, -g};
    for (int k = 0; k < 20000; ++k) d.step(1e-5);
    const double a = std::atan(tan_slope);
    d.gravity = {g * std::sin(a), 0, -g * std::cos(a)};
    d.i.w = spin;
    for (double t = 0; t < time; t += 1e-5) d.step(1e-5);
    return d.i;
  };
  for (const char* model : {"epsd", "epsd2", "sds"}) {
    CAPTURE(model);
    // mu_r = 0.1 >= tan = 0.08: it rests but for the ringing of an undamped spring.
    const Body rest = on_slope(model, 0.08, 0.5, {}, 0.5);
    CHECK(std::fabs(rest.x.x) < 1e-4);
    const Body rolling = on_slope(model, 0.4, 0.5, {}, 0.2);
    const double a = std::atan(0.4);
    CHECK_NEAR(rolling.v.x, 0.2 * 5 / 7 * g * (std::sin(a) - mu_r * std::cos(a)), 0.02);
  }
  const Body a = on_slope("a", 0.4, 0.5, {}, 0.2);
  CHECK_NEAR(a.v.x, 0.2 * 5 / 7 * g * (std::sin(std::atan(0.4)) - mu_r * std::cos(std::atan(0.4))), 0.02);
  // Spin-down without sliding friction: omega0 - 5 mu_r g t / (2 r).
  const Body spun = on_slope("a", 0, 0, {0, 100, 0}, 0.1);
  CHECK_NEAR(spun.w.y, 100 - 2.5 * mu_r * g * 0.1 / r, 5e-3);
  const Body stopped = on_slope("a", 0, 0, {0, 20, 0}, 0.2);
  CHECK(std::fabs(stopped.w.y) < 1e-6);  // at rest it stays at rest
}

TEST_CASE("without rolling the law has three history columns and asks for no spin") {
  const Law plain(kLib, {}, {{"restitution", 0.3}, {"friction", 0.5}});
  CHECK(plain.table().state_count == 3);
  CHECK((plain.table().needs >> CALX_IN_WX & 7u) == 0);
  const Law rolls(kLib, {{"rolling", "epsd"}}, {{"restitution", 0.3}, {"friction", 0.5}});
  CHECK(rolls.table().state_count == 6);
  CHECK((rolls.table().needs >> CALX_IN_WX & 7u) == 7);
  CHECK(std::string(plain.table().symbol) == "hertz_mindlin");
}

TEST_CASE("stable step shrinks as the overlap grows") {
  const Law law(kLib, {}, {{"restitution", 0.3}, {"friction", 0.5}});
  const double e_star = 1e7 / (2 * (1 - 0.0625)), m = 1e-5, r = 1e-3, d = 1e-5;
  CHECK_NEAR(law.table().stable_dt(law.pair().data(), m, r, d), 0.17 * std::sqrt(m / (2 * e_star * std::sqrt(r * d))),
             1e-12);
}
