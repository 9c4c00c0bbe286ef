// test_oblique.cpp: oblique impacts of calx.hertz-mindlin against published benchmarks, an experiment and stored
// answers of other codes. Codes differ in what a changing contact keeps, force or displacement, and in friction while
// the dashpot pulls; each comparison names the form of its source. Data: tests/data/README.md.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"
#include "support/table.hpp"

using namespace bench;

namespace {
const char* kLib = "calx-hertz-mindlin";
const Material kRigid{1e14, 0.23};  // 250 times stiffer than alumina
const double kDegree = pi / 180;
}  // namespace

TEST_CASE("Chung and Ooi test 4: oblique impact of alumina on a rigid plane") {
  // Their DEM keeps the displacement: at 5 degrees it gives back 0.948 of the tangential speed, the force form 0.87.
  const Law law(kLib, {{"tangential", "displacement"}}, {{"restitution", 0.98}, {"friction", 0.092}}, {3.8e11, 0.23},
                kRigid);
  const Law preset(kLib, {}, {{"restitution", 0.98}, {"friction", 0.092}}, {3.8e11, 0.23}, kRigid);
  const Body ball = sphere(0.0025, 4000, {}, {});
  double et_error = 0, spin_error = 0, angle_error = 0, mean_angle = 0;
  int count = 0;
  for (const Row& row : read_table("chung_ooi/test4_oblique_impact_digitised.csv")) {
    if (row.at("series") != "Al_oxide_DEM") continue;
    const double angle = number(row, "incident_angle_deg") * kDegree,
                 rebound = number(row, "rebound_angle_contact_patch_deg");
    const double vt = 3.9 * std::sin(angle), vn = 3.9 * std::cos(angle);
    const Rebound b = oblique(law, ball, vt, vn, 2e-9);
    et_error += std::fabs(b.vt / vt / number(row, "tangential_restitution") - 1);
    spin_error += std::fabs(b.omega / -number(row, "final_omega_rad_s") - 1);
    angle_error += std::fabs(std::atan2(b.patch(ball.r), b.vn) / kDegree - rebound);
    mean_angle += std::fabs(rebound);
    ++count;
    if (angle > 34 * kDegree)  // gross sliding: exact, whatever the spring
      for (const Rebound& slid : {b, oblique(preset, ball, vt, vn, 2e-9)}) {
        CHECK_NEAR(slid.vt / vt, 1 - 0.092 * 1.98 / std::tan(angle), 1e-3);
        CHECK_NEAR(slid.omega, 2.5 * 0.092 * 1.98 * vn / ball.r, 3e-3);  // lever r - overlap
      }
  }
  REQUIRE(count == 13);
  CHECK(et_error / count < 0.02);
  CHECK(spin_error / count < 0.02);
  CHECK(angle_error < 0.02 * mean_angle);
}

TEST_CASE("Chung and Ooi test 5: tangential rebound against its incidence") {
  // psi1 = v_t / (mu v_n) before, psi2 the same of the contact patch after; both depend on the ratio of tangential to
  // normal stiffness only, not on modulus, density or speed. Error over the range of the quantity, 3 %; reading errors
  // show where sliding is exact: up to 0.053 in psi2 (DEM, psi1 = 12.96: 6.013, exactly psi1 - 7 = 5.961).
  //
  // The two published series differ from each other by up to 1.2, so no one law meets both:
  //  - FEM resolves the slip inside the contact, which softens it: Mindlin's stiffness times 0.78.
  //  - DEM (Steel) follows from Mindlin's force increments and half the stiffness of a rigid plane, as if the plane had
  //    the shear modulus of the sphere (best fit 0.49). It cycles with a gain of energy and is no choice for a run.
  struct Series {
    const char *name, *tangential;
    double ratio;
  };
  const double r = 1e-5, mu_vn = 0.3 * 5;
  for (const Series& series : {Series{"FEM", "rescaled", 0.78}, Series{"Steel", "incremental", 0.5}}) {
    const Law law(kLib, {{"tangential", series.tangential}},
                  {{"restitution", 1}, {"friction", 0.3}, {"tangential_ratio", series.ratio}}, {2.08e11, 0.3},
                  {1e14, 0.3});
    double worst[2] = {0, 0}, low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    int count = 0;
    for (const Row& row : read_table("chung_ooi/test5_normalised_digitised.csv")) {
      if (row.at("series") != series.name) continue;
      const double psi1 = number(row, "psi1_Vt_over_muVn"), value = number(row, "value");
      const Rebound b = oblique(law, sphere(r, 7850, {}, {}), psi1 * mu_vn, 5, 2e-11);
      const int k = row.at("quantity")[0] == 'p' ? 0 : 1;
      worst[k] = std::fmax(worst[k], std::fabs((k == 0 ? b.patch(r) : -b.omega * r) / mu_vn - value));
      low[k] = std::fmin(low[k], value);
      high[k] = std::fmax(high[k], value);
      ++count;
    }
    CAPTURE(series.name);
    CHECK(count == 30);
    CHECK(worst[0] < 0.03 * (high[0] - low[0]));
    CHECK(worst[1] < 0.03 * (high[1] - low[1]));
  }
  // Sliding throughout: psi2 = psi1 - 7 and R omega = 5 mu v_n exactly, from 4 chi - 1 on; preset law.
  const Law law(kLib, {}, {{"restitution", 1}, {"friction", 0.3}}, {2.08e11, 0.3}, {1e14, 0.3});
  for (const double psi1 : {6.5, 8.0, 13.0, 20.0}) {
    const Rebound b = oblique(law, sphere(r, 7850, {}, {}), psi1 * mu_vn, 5, 2e-11);
    CHECK(std::fabs(b.patch(r) / mu_vn - (psi1 - 7)) < 0.03);  // the spin's lever is the overlap shorter, 0.6 %
    CHECK_NEAR(b.omega * r / mu_vn, 5, 6e-3);
  }
}

TEST_CASE("Chung and Ooi test 6: a spinning sphere dropped on a plane") {
  // beta = s - 1 while it slides, s from the restitution it really has: friction sees the impulse that pushes. Where
  // the dashpot may pull, that is more than (1 + e) m v_n (by 3 % for 0.5), so the comparison clips and 0.43631 returns
  // 0.5.
  const Law law(kLib, {{"tension", "clipped"}}, {{"restitution", 0.43631}, {"friction", 0.4}}, {7e10, 0.33}, kRigid);
  const Body still = sphere(0.1, 2700, {}, {});
  CHECK_NEAR(restitution(law, still, wall(), 0.2, 2e-7, 1), 0.5, 1e-4);
  int sliding = 0;
  for (const Row& row : read_table("chung_ooi/test6_beta_digitised.csv")) {
    const double s = number(row, "s_3.5mu(1+e)Vn_over_Vt"), point = number(row, "beta");
    if (s >= 1) continue;
    const double vt = 3.5 * 0.4 * 1.5 * 0.2 / s;
    Body b = still;
    b.w.y = vt / b.r;
    const Rebound after = oblique(law, b, 0, 0.2, 2e-7);
    const double beta = after.patch(b.r) / vt;
    // The points themselves lie up to 2.4 % off s - 1; the last, at 0.979, is 0 but for reading.
    CHECK(std::fabs(beta - (s - 1)) < 1e-3);
    CHECK(std::fabs(beta - point) < (s < 0.9 ? 0.03 * std::fabs(point) : 0.01));
    ++sliding;
  }
  CHECK(sliding == 5);
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

namespace {
const double kSpeed = 3.9;
const Body kAlumina = sphere(0.0025, 4000, {}, {});
/// Tangential restitution, spin, rebound angle of the centre at an impact angle, degrees.
std::array<double, 3> kharaz(const Law& law, double degrees) {
  const double vt = kSpeed * std::sin(degrees * kDegree);
  const Rebound b = oblique(law, kAlumina, vt, kSpeed * std::cos(degrees * kDegree), 5e-9);
  return {b.vt / vt, b.omega, std::atan2(b.vt, b.vn) / kDegree};
}
/// Particle-wall answers of MFiX by angle: second half of the file, Hertzian.
std::vector<std::array<double, 2>> mfix(const std::string& name) {
  std::vector<std::array<double, 2>> all;
  for (const auto& row : read_numbers("kharaz_mfix/mfix_DEM05_POST_" + name + ".dat"))
    if (row.size() == 3) all.push_back({row[0], row[2]});
  all.erase(all.begin(), all.begin() + static_cast<long>(all.size() / 2));
  return all;
}
double between(const std::vector<std::array<double, 2>>& table, double x) {
  for (std::size_t k = 1; k < table.size(); ++k)
    if (x <= table[k][0]) {
      const double w = (x - table[k - 1][0]) / (table[k][0] - table[k - 1][0]);
      return table[k - 1][1] + w * (table[k][1] - table[k - 1][1]);
    }
  return table.back()[1];
}
const char* kMfix[] = {"COEFF", "OMEGA", "ALPHA"};
const char* kMeasured[] = {"tangential_restitution", "rebound_omega_rad_s", "rebound_angle_deg"};
}  // namespace

TEST_CASE("MFiX DEM05, Hertzian: tangential restitution, spin and rebound angle from 0.5 to 65 degrees") {
  const Law law(kLib, {{"tangential", "displacement"}}, {{"restitution", 1}, {"friction", 0.092}}, {3.8e11, 0.23},
                {7e10, 0.25});
  const double limit[] = {0.002, 0.5, 0.01};  // 1, rad/s of 640, degrees
  for (int k = 0; k < 3; ++k)
    for (const auto& row : mfix(kMfix[k])) {
      if (row[0] == 0) continue;
      CAPTURE(kMfix[k]);
      CAPTURE(row[0]);
      CHECK(std::fabs(kharaz(law, row[0])[static_cast<std::size_t>(k)] - row[1]) < limit[k]);
    }
}

TEST_CASE("Kharaz, Gorham, Salman: alumina on glass, MFiX' own error beside ours") {
  // RMS over all measured angles: absolute for the restitution, relative for the spin, degrees for the angle. Two
  // digitisations of one spin point differ by 1.4 %, and spin and tangential speed as measured break m v r = I w by 6
  // %.
  struct Form {
    double ratio, most[3];
  };
  const Form forms[] = {{1, {0.054, 0.21, 0.38}},      // preset
                        {0.78, {0.025, 0.07, 0.19}}};  // softened as the FEM points of test 5 ask
  for (const Form& form : forms) {
    const Law law(kLib, {}, {{"restitution", 1}, {"friction", 0.092}, {"tangential_ratio", form.ratio}}, {3.8e11, 0.23},
                  {7e10, 0.25});
    for (int k = 0; k < 3; ++k) {
      const auto answers = mfix(kMfix[k]);
      double ours = 0, theirs = 0;
      int count = 0;
      for (const Row& row : read_table("kharaz_mfix/kharaz_experiment.csv")) {
        if (row.at("quantity") != kMeasured[k]) continue;
        const double angle = number(row, "impact_angle_deg"), value = number(row, "value");
        const double scale = k == 1 ? value : 1;
        ours += std::pow((kharaz(law, angle)[static_cast<std::size_t>(k)] - value) / scale, 2);
        theirs += std::pow((between(answers, angle) - value) / scale, 2);
        ++count;
      }
      ours = std::sqrt(ours / count);
      theirs = std::sqrt(theirs / count);
      MESSAGE(std::string(kMeasured[k]) << ", tangential_ratio " << form.ratio << ": RMS error " << ours << ", MFiX "
                                        << theirs);
      CHECK(count >= 7);
      CHECK(ours < form.most[k]);
      CHECK(ours < theirs);
    }
  }
}

TEST_CASE("stored answers of the open-source comparison: normal impact on steel and the sliding pair") {
  const Material m1{1e9, 0.2}, steel{2.1e11, 0.2};
  {
    const Law law(kLib, {}, {{"restitution", 0.4}, {"friction", 0.2}}, m1, steel);
    CHECK(std::fabs(restitution(law, sphere(1e-3, 2500, {}, {}), wall(), 1, 1e-8, 1) - 0.4) < 1e-3);
  }
  const Law law(kLib, {}, {{"restitution", 0.4}, {"friction", 0.2}}, steel, m1);
  Duel d(law, sphere(1e-3, 7200, {0, 0, 1e-3}, {}), wall());
  d.gravity = {5, 0, -5};
  for (int k = 0; k < 10001; ++k) d.step(5e-7);
  CHECK_NEAR(d.i.v.x, 0.020002, 1e-3);
  CHECK_NEAR(d.i.w.y, 12.50, 1e-3);
  CHECK_NEAR(d.i.x.x, 5.002e-5, 1e-3);
}

TEST_CASE("LIGGGHTS and Yade: floor bounce, oblique floor and oblique pair with spin") {
  // Answers of the Debian packages LIGGGHTS 3.8.0 and Yade 2023.02a after 2000 steps of 9.8e-7 s. LIGGGHTS keeps the
  // displacement and takes friction from |F_n| while the dashpot pulls; Yade clips the pull.
  const double r = 1.25e-3, rho = 2100;
  struct Answers {
    Choices choices;
    double bounce, floor_vx, floor_wy, vx, vy, wz, tight, loose;
  };
  // LIGGGHTS: 0.1 %; the floor's vx 0.4 %, its contact point lies half an overlap nearer the surface of the sphere.
  // Yade: 0.25 %; 1.5 % in the sticking floor impact, where it keeps neither force nor displacement exactly.
  const Answers all[] = {{{{"tension", "gripping"}, {"tangential", "displacement"}},
                          0.13316,
                          0.2139,
                          171.2,
                          -0.14885,
                          0.16471,
                          -75.16,
                          1e-3,
                          4e-3},
                         {{{"tension", "clipped"}}, 0.18205, 0.2110, 175.2, -0.19752, 0.16431, -77.40, 2.5e-3, 1.5e-2}};
  for (const Answers& a : all) {
    const Law law(kLib, a.choices, {{"restitution", 0.3}, {"friction", 0.5}});
    const auto run = [&](const Body& i, const Body& j, double g) {
      Duel d(law, i, j);
      d.gravity = {0, 0, -g};
      for (int k = 0; k < 2000; ++k) d.step(9.8e-7);
      return d.i;
    };
    CAPTURE(a.floor_wy);
    CHECK_NEAR(run(sphere(r, rho, {0, 0, 0.001251}, {0, 0, -0.5}), wall(), 9.81).v.z, a.bounce, 2.5e-3);
    const Body slid = run(sphere(r, rho, {0, 0, 0.001251}, {0.3, 0, -0.5}), wall(), 9.81);
    CHECK_NEAR(slid.v.x, a.floor_vx, 4e-3);
    CHECK_NEAR(slid.w.y, a.floor_wy, a.loose);
    const Body hit = run(sphere(r, rho, {0.025, 0, 0}, {0.5, 0.2, 0}),
                         sphere(r, rho, {0.0275025, 0, 0}, {-0.5, 0, 0}, {0, 0, 50}), 0);
    CHECK_NEAR(hit.v.x, a.vx, a.tight);
    CHECK_NEAR(hit.v.y, a.vy, a.tight);
    CHECK_NEAR(hit.w.z, a.wz, a.tight);
  }
}
