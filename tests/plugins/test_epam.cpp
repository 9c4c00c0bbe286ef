// test_epam.cpp: calx.epam against closed forms T1 to T7 of the elasto-plastic adhesive law and against LIGGGHTS loops.
// Symbols as in plugins/epam/README.md; figures without a source are exact solutions. Data: tests/data/README.md.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"
#include "support/table.hpp"

using namespace bench;

namespace {

const char* kLib = "calx-epam";
const Material kSoft{5e7, 0.25};
const double kR = 1e-3, kRho = 2500;
const double kModulus = 5e7 / (2 * (1 - 0.0625)), kK1 = 4.0 / 3.0 * kModulus * std::sqrt(0.5e-3);

Body grain() { return sphere(kR, kRho, {}, {}); }
Values base(Values more) {
  more.insert({"restitution", 1});
  more.insert({"friction", 0});
  return more;
}
/// Impact of two grains; the step is a share of the Hertz time at that speed.
double impact(const Law& law, double v, double share, Record* record = nullptr) {
  const Body g = grain();
  const double t = 2.87 * std::pow(0.25 * g.m * g.m / (0.5 * kR * kModulus * kModulus * v), 0.2);
  return restitution(law, g, g, v, t / share, 40 * t, record);
}
double linear_impact(const Law& law, double k1, double v, int share, Record* record = nullptr) {
  const Body g = grain();
  const double t = pi * std::sqrt(0.5 * g.m / k1);
  return restitution(law, g, g, v, t / share, 30 * t, record);
}
/// Closed restitution of the undamped loop.
double loop_restitution(double lambda, double n) {
  return std::sqrt((1 - (n + 1) * lambda + n * std::pow(lambda, (n + 1) / n)) / (1 - lambda));
}
struct Loop {
  double peak = 0, minimum = 0, work = 0, plastic = 0;
};
/// Quasi-static loop to an overlap and back to 0.
Loop loop(const Law& law, double top, int steps) {
  Loop l;
  auto state = law.fresh();
  Output o;
  double f_before = 0, d_before = 0;
  for (int k = 1; k <= 2 * steps; ++k) {
    const double d = top * (k <= steps ? k : 2 * steps - k) / steps;
    const double f = d > 0 ? press(law, state, d, kR, kR, &o) : 0;
    l.peak = std::fmax(l.peak, f);
    l.minimum = std::fmin(l.minimum, f);
    l.work += 0.5 * (f + f_before) * (d - d_before);
    if (d > 0) l.plastic += o[CALX_OUT_PLASTIC];
    f_before = f;
    d_before = d;
  }
  return l;
}

}  // namespace

TEST_CASE("T1, T2: loop restitution and peak of both exponents") {
  const Body g = grain();
  for (const double lambda : {0.0, 0.1, 0.3, 0.5, 0.8, 0.95, 0.99}) {
    CAPTURE(lambda);
    const Law linear(kLib, {{"exponent", "1"}}, base({{"plasticity", lambda}, {"k1", 1000}}), kSoft, kSoft);
    const Law hertz(kLib, {}, base({{"plasticity", lambda}}), kSoft, kSoft);
    Record a, b;
    CHECK_NEAR(linear_impact(linear, 1000, 0.5, 20000, &a), std::sqrt(1 - lambda), 1e-3);
    CHECK_NEAR(impact(hertz, 0.5, 20000, &b), loop_restitution(lambda, 1.5), 1e-3);
    CHECK_NEAR(a.max_overlap, peak_overlap(1000, 1, 0.5 * g.m, 0.5), 1e-4);
    CHECK_NEAR(b.max_overlap, peak_overlap(kK1, 1.5, 0.5 * g.m, 0.5), 1e-4);
    CHECK_NEAR(b.max_force, kK1 * std::pow(peak_overlap(kK1, 1.5, 0.5 * g.m, 0.5), 1.5), 1e-4);
    const double before = 0.25 * g.m * 0.25;
    CHECK(std::fabs(a.plastic - lambda * before) < 1e-3 * before);
    CHECK(std::fabs(b.plastic - (1 - loop_restitution(lambda, 1.5) * loop_restitution(lambda, 1.5)) * before) <
          1e-3 * before);
  }
  // Table of the closed form, n = 1.5.
  CHECK_NEAR(loop_restitution(0.5, 1.5), 0.66704, 1e-5);
  CHECK_NEAR(loop_restitution(0.99, 1.5), 0.09134, 1e-4);
}

TEST_CASE("T3: fixed adhesive stiffness, n = chi = 1") {
  const Body g = grain();
  const double v = 0.5, top = v * std::sqrt(0.5 * g.m / 1000);
  for (const double lambda : {0.3, 0.5, 0.7})
    for (const double k : {0.0, 200.0, 1000.0, 5000.0}) {
      CAPTURE(lambda);
      CAPTURE(k);
      const Law law(kLib, {{"exponent", "1"}}, base({{"plasticity", lambda}, {"k1", 1000}, {"k_adh", k}}), kSoft,
                    kSoft);
      Record r;
      const double e = linear_impact(law, 1000, v, 20000, &r);
      const double e2 = (1 - lambda) - lambda * lambda * k / (1000 + (1 - lambda) * k);
      if (e2 > 0) {
        CHECK_NEAR(e, std::sqrt(e2), 1e-3);
        const double k2 = 1000 / (1 - lambda);
        CHECK(std::fabs(r.min_force + k * k2 * lambda * top / (k2 + k)) < 1e-3 * r.max_force);
      } else {
        CHECK(e == -1);
      }
    }
}

TEST_CASE("T4: pull-off and loop energy by surface energy, all rows, both caps") {
  struct Case {
    const char* cap;
    double gamma, minimum, energy;
  };
  const Case cases[] = {{"consistent", 0.1, 3.737e-5, 5.5914e-8}, {"consistent", 1, 3.737e-4, 5.6764e-8},
                        {"consistent", 10, 3.737e-3, 6.5488e-8},  {"consistent", 100, 0.012571, 9.0985e-8},
                        {"literal", 0.1, 3.737e-5, 5.5914e-8},    {"literal", 10, 3.737e-3, 6.5488e-8},
                        {"literal", 100, 0.014728, 9.8045e-8}};
  for (const Case& c : cases) {
    CAPTURE(c.cap);
    CAPTURE(c.gamma);
    const Law law(kLib, {{"adhesion_cap", c.cap}}, base({{"plasticity", 0.5}, {"surface_energy", c.gamma}}), kSoft,
                  kSoft);
    const Loop l = loop(law, 1e-5, 20000);
    CHECK_NEAR(l.peak, 0.025142, 1e-4);
    CHECK_NEAR(l.minimum, -c.minimum, 2e-4);
    CHECK_NEAR(l.work, c.energy, 1e-4);
    CHECK_NEAR(l.plastic, l.work, 1e-6);
  }
}

TEST_CASE("T4: separate adhesive exponents keep the pull-off and shorten the tail") {
  double energy = 1;
  for (const char* chi : {"1", "1.5", "2", "2.5", "3", "3.5", "4", "4.5", "5"})
    for (const char* n : {"1", "1.5"}) {
      CAPTURE(chi);
      CAPTURE(n);
      const bool hertz = n[1] != 0;
      const double nn = hertz ? 1.5 : 1, x = std::stod(chi), lambda = 0.5, gamma = 10, top = 1e-5;
      Values v = base({{"plasticity", lambda}, {"surface_energy", gamma}});
      const double k1 = hertz ? kK1 : 1000;
      if (!hertz) v["k1"] = k1;
      const Law law(kLib, {{"exponent", n}, {"adhesion_exponent", chi}}, v, kSoft, kSoft);
      const Loop l = loop(law, top, 20000);
      const double dp = std::pow(lambda, 1 / nn) * top, k2 = 2 * k1, dpn = std::pow(dp, nn);
      const double f = std::fmin(1.5 * pi * gamma * std::sqrt(kR * dp - dp * dp / 4), 0.5 * k2 * dpn);
      const double dmin = std::pow(dpn - f / k2, 1 / nn), ka = f / std::pow(dmin, x), q = nn + 1;
      const double load = k1 * std::pow(top, q) / q;
      const double unload = k2 * ((std::pow(top, q) - std::pow(dp, q)) / q - dpn * (top - dp));
      const double pull = k2 * (dpn * (dp - dmin) - (std::pow(dp, q) - std::pow(dmin, q)) / q);
      const double tail = ka * std::pow(dmin, x + 1) / (x + 1);
      CHECK_NEAR(l.minimum, -f, 1e-3);
      CHECK_NEAR(l.work, load - unload + pull + tail, 1e-4);
      CHECK_NEAR(l.plastic, l.work, 1e-6);
      if (hertz) {
        CHECK(l.work < energy);
        energy = l.work;
      }
    }
}

TEST_CASE("T4b: reload from the adhesive branch") {
  const Law law(kLib, {{"exponent", "1"}}, base({{"plasticity", 0.5}, {"k1", 1000}, {"k_adh", 500}}), kSoft, kSoft);
  auto state = law.fresh();
  const int n = 10000;
  double before = 0, jump = 0, lowest = 0;
  const auto at = [&](double d) {
    const double f = press(law, state, d, kR, kR);
    jump = std::fmax(jump, std::fabs(f - before));
    lowest = std::fmin(lowest, f);
    before = f;
  };
  for (int k = 1; k <= n; ++k) at(1e-5 * k / n);
  CHECK_NEAR(before, 0.01, 1e-9);
  CHECK_NEAR(state[law.column("plastic")], 5e-6, 1e-9);
  for (int k = n - 1; k >= 24 * n / 100; --k) at(1e-5 * k / n);
  CHECK_NEAR(lowest, -2e-3, 1e-3);
  CHECK_NEAR(before, -1.2e-3, 1e-6);
  double regained = 0;
  for (int k = 1; k <= n; ++k) {
    const double d = 2.4e-6 + 7.6e-6 * k / n;
    at(d);
    if (k == 1) CHECK_NEAR(state[law.column("plastic")], 3e-6, 1e-3);
    if (regained == 0 && before >= 1000 * d * (1 - 1e-9)) regained = d;
  }
  CHECK_NEAR(regained, 6e-6, 2e-3);
  CHECK(jump <= 2000 * 1e-9 * 1.001);  // one k2 increment
  // Retracing goes back along the branch to the same minimum instead.
  const Law back(kLib, {{"exponent", "1"}, {"adhesion_reload", "retrace"}},
                 base({{"plasticity", 0.5}, {"k1", 1000}, {"k_adh", 500}}), kSoft, kSoft);
  state = back.fresh();
  press(back, state, 1e-5, kR, kR);
  press(back, state, 2.4e-6, kR, kR);
  CHECK_NEAR(press(back, state, 4e-6, kR, kR), -2e-3, 1e-9);
  CHECK_NEAR(press(back, state, 1e-5, kR, kR), 1e-2, 1e-9);
}

TEST_CASE("T5: restitution rises from sticking with the impact speed") {
  const Law law(kLib, {}, base({{"plasticity", 0.8}, {"surface_energy", 0.5}}), kSoft, kSoft);
  CHECK(impact(law, 0.001, 2000) == -1);
  const double table[][2] = {{0.01, 0.299}, {0.03, 0.370}, {0.1, 0.397}, {0.3, 0.407}, {1, 0.411}, {3, 0.412}};
  for (const auto& row : table) CHECK(std::fabs(impact(law, row[0], 5000) - row[1]) < 1.1e-3);
}

TEST_CASE("T6 and damped plastic impacts: what the dashpot switches do") {
  const double table[][4] = {{0, 0.5, 0.5503, 0.5000},   {0.3, 0.5, 0.4811, 0.3543}, {0.5, 0.4, 0.3683, 0.1474},
                             {0.5, 0.5, 0.4216, 0.2423}, {0.5, 0.7, 0.5319, 0.4295}, {0.8, 0.5, 0.2876, 0.0266}};
  for (const auto& row : table) {
    const Values v = {{"plasticity", row[0]}, {"restitution", row[1]}, {"friction", 0}, {"k1", 1000}};
    CAPTURE(row[0]);
    const Law clipped(kLib, {{"exponent", "1"}, {"dashpot", "clipped"}}, v, kSoft, kSoft);
    const Law always(kLib, {{"exponent", "1"}, {"dashpot", "always"}}, v, kSoft, kSoft);
    CHECK(std::fabs(linear_impact(clipped, 1000, 1, 8000) - row[2]) < 6e-4);
    CHECK(std::fabs(linear_impact(always, 1000, 1, 8000) - row[3]) < 6e-4);
  }
  const Values trap = {{"plasticity", 0.8}, {"restitution", 0.4}, {"friction", 0}, {"k1", 1000}};
  const Law always(kLib, {{"exponent", "1"}, {"dashpot", "always"}}, trap, kSoft, kSoft);
  CHECK(linear_impact(always, 1000, 1, 2000) == -1);
  const Law sane(kLib, {{"exponent", "1"}}, trap, kSoft, kSoft);
  CHECK(linear_impact(sane, 1000, 1, 2000) > 0.2);
  // Hertz with the Tsuji form returns e_in where nothing is plastic.
  for (const double e : {0.3, 0.5, 0.9}) {
    const Law law(kLib, {}, {{"plasticity", 0}, {"restitution", e}, {"friction", 0}}, kSoft, kSoft);
    CHECK_NEAR(impact(law, 0.5, 20000), e, 1e-3);
  }
}

TEST_CASE("T7: pull-off of a virgin and of a consolidated contact, pair and wall") {
  const double f0 = 1e-4, gamma = 1, lambda = 0.5, top = 1e-5;
  const Law law(kLib, {}, base({{"plasticity", lambda}, {"surface_energy", gamma}, {"pull_off", f0}}), kSoft, kSoft);
  auto state = law.fresh();
  CHECK_NEAR(press(law, state, 1e-14, kR, kR), -f0, 1e-3);
  for (const double r_j : {kR, 0.0, 3 * kR}) {
    state = law.fresh();
    press(law, state, top, kR, r_j);
    double lowest = 0;
    for (int k = 20000; k > 0; --k) lowest = std::fmin(lowest, press(law, state, top * k / 20000, kR, r_j));
    const double dp = std::pow(lambda, 1 / 1.5) * top, d = kR + r_j - dp;
    const double c = r_j == 0 ? 0 : (d * d - r_j * r_j + kR * kR) / (2 * d);
    const double a = r_j == 0 ? std::sqrt(2 * kR * dp - dp * dp) : std::sqrt(kR * kR - c * c);
    CHECK_NEAR(lowest, -f0 - 1.5 * pi * gamma * a, 1e-3);
  }
  // f0 does no work in a closed loop.
  const Law without(kLib, {}, base({{"plasticity", lambda}, {"surface_energy", gamma}}), kSoft, kSoft);
  CHECK_NEAR(loop(law, top, 20000).plastic, loop(without, top, 20000).plastic, 1e-12);
}

TEST_CASE("friction limit: mu (F + k_adh delta^chi), nothing on the adhesive branch") {
  const double mu = 0.5;
  const Law law(
      kLib, {{"exponent", "1"}},
      {{"plasticity", 0.5}, {"restitution", 1}, {"friction", mu}, {"k1", 1000}, {"k_adh", 500}, {"pull_off", 1e-3}},
      kSoft, kSoft);
  auto state = law.fresh();
  Input row;
  row[CALX_IN_NZ] = 1;
  row[CALX_IN_VX] = 100;  // slides at once
  row[CALX_IN_R_EFF] = 0.5 * kR;
  row[CALX_IN_M_EFF] = 1e-6;
  row[CALX_IN_R_I] = row[CALX_IN_R_J] = kR;
  const auto friction = [&](double d) {
    row[CALX_IN_OVERLAP] = d;
    return -law.evaluate(row, state, 1e-6)[CALX_OUT_FX];
  };
  CHECK_NEAR(friction(1e-5), mu * (1000 + 500) * 1e-5, 1e-9);
  CHECK_NEAR(friction(6e-6), mu * (2000 * 1e-6 + 500 * 6e-6), 1e-9);
  CHECK_NEAR(friction(4.5e-6), mu * (2000 * -0.5e-6 + 500 * 4.5e-6), 1e-9);
  CHECK(friction(3.9e-6) == 0);
}

TEST_CASE("lambda = 0 with surface energy is elastic and never pulls") {
  const Law law(kLib, {}, base({{"plasticity", 0}, {"surface_energy", 10}}), kSoft, kSoft);
  const Loop l = loop(law, 1e-5, 1000);
  CHECK(l.minimum == 0);
  CHECK(std::fabs(l.work) < 1e-12 * l.peak * 1e-5);
  CHECK(std::fabs(l.plastic) < 1e-7 * l.peak * 1e-5);  // truncation of the trapezoid
}

TEST_CASE("LIGGGHTS edinburgh/stiffness: all 16 loops") {
  const double r = 1.25e-3, rho = 2000;
  int captured = 0;
  for (const Row& row : read_table("eepa_liggghts/summary.csv")) {
    CAPTURE(row.at("case"));
    const bool hertz = number(row, "n") > 1.2, fixed = row.at("adhesion_mode") == "fixed_k_adh";
    const double k1 = number(row, "k1_N_per_m_n");
    Values v = base(
        {{"plasticity", 1 - 1 / number(row, "k2_over_k1")}, {"k1", k1}, {"pull_off", number(row, "f0_pull_off_N")}});
    if (fixed) v["k_adh"] = k1 * number(row, "k_adh_over_k1");
    if (row.at("adhesion_mode") == "surface_energy") v["surface_energy"] = number(row, "dgamma_J_m2");
    const std::string chi = number(row, "chi") > 1.2 ? "1.5" : "1";
    const Law law(kLib, {{"exponent", hertz ? "1.5" : "1"}, {"adhesion_exponent", chi}, {"adhesion_cap", "literal"}}, v,
                  kSoft, kSoft);
    REQUIRE(law.status() == CALX_OK);
    // Started like LIGGGHTS: its first sample gives the time of first contact; dt 1e-8 s as there.
    Duel d(law, sphere(r, rho, {0, 0, 2 * r}, {0, 0, -number(row, "impact_speed_m_s")}), sphere(r, rho, {}, {}));
    const auto curve = read_table("eepa_liggghts/loop_" + row.at("case") + ".csv");
    const double peak = number(row, "max_force_N"), t0 = number(curve.front(), "t_s");
    d.i.x.z -= number(curve.front(), "overlap_m");
    const bool first_cycle_only = row.at("outcome") == "captured";
    double worst = 0, force_at = 0, first_separation = 0;
    std::size_t k = 0;
    bool was_in = false, parted = false;
    for (long step = 0; k < curve.size() && !parted; ++step) {
      const double t = t0 + step * 1e-8;
      d.step(1e-8);
      force_at = d.overlap > 0 ? d.record.last[CALX_OUT_FZ] : 0;
      if (d.overlap > 0) was_in = true;
      parted = was_in && d.overlap <= 0;
      // One cycle: until the overlap turns up again.
      if (first_cycle_only && d.record.max_force > 0.9 * peak && force_at < 0 && d.i.v.z - d.j.v.z < 0) break;
      if (std::fabs(number(curve[k], "t_s") - t) < 5e-9) {
        worst = std::fmax(worst, std::fabs(number(curve[k], "force_N") - force_at));
        ++k;
      }
      first_separation = d.i.v.z - d.j.v.z;
    }
    REQUIRE(k > 50);
    CHECK(worst < 2e-3 * peak);
    CHECK_NEAR(d.record.max_overlap, number(row, "max_overlap_m"), 1e-3);
    CHECK_NEAR(d.record.max_force, peak, 1e-3);
    if (number(row, "min_force_N") < 0) CHECK_NEAR(d.record.min_force, number(row, "min_force_N"), 5e-3);
    if (parted) CHECK_NEAR(first_separation / number(row, "impact_speed_m_s"), number(row, "restitution"), 1e-3);
    CHECK(parted == !first_cycle_only);
    captured += first_cycle_only;
  }
  CHECK(captured == 4);
}

TEST_CASE("wrong input is refused with its reason") {
  const Law both(kLib, {}, {{"surface_energy", 1}, {"k_adh", 10}}, kSoft, kSoft);
  CHECK(both.status() == CALX_E_CONFIG);
  CHECK(both.message() ==
        "surface_energy and k_adh are both given; adhesion follows from one of them, leave the other at 0");
  const Law law(kLib, {}, {}, kSoft, kSoft);
  std::vector<double> given(law.table().given_count), pair(law.table().pair_count);
  for (std::uint32_t k = 0; k < given.size(); ++k) given[k] = law.table().given[k].preset;
  given[0] = -0.25;
  struct Memo {
    std::string text;
  } memo;
  calx_host host = {sizeof(calx_host),
                    1,
                    0,
                    &memo,
                    "test",
                    "1",
                    nullptr,
                    [](const calx_host* h, calx_status code, const char* text) -> calx_status {
                      static_cast<Memo*>(h->self)->text = text;
                      return code;
                    }};
  const double m[] = {1e7, 0.25};
  CHECK(law.derive(&host, m, m, given.data(), pair.data()) == CALX_E_CONFIG);
  CHECK(memo.text.find("plasticity is -0.25") == 0);
  CHECK(memo.text.find("k2 is not below k1") != std::string::npos);
}

TEST_CASE("units and presets follow the exponents") {
  const auto field = [](const Law& law, const std::string& name) {
    for (std::uint32_t k = 0; k < law.table().given_count; ++k)
      if (name == law.table().given[k].name) return law.table().given[k];
    return calx_field();
  };
  const Law a(kLib, {{"exponent", "1"}, {"adhesion_exponent", "2.5"}}, {}, kSoft, kSoft);
  CHECK(std::string(field(a, "k1").unit) == "N/m");
  CHECK(std::string(field(a, "k_adh").unit) == "N/m^2.5");
  CHECK_NEAR(field(a, "tangential_ratio").preset, 2.0 / 7.0, 1e-15);
  const Law b(kLib, {}, {}, kSoft, kSoft);
  CHECK(std::string(field(b, "k1").unit) == "N/m^1.5");
  CHECK(field(b, "tangential_ratio").preset == 0.67);
  CHECK(std::string(b.table().symbol) == "epam_n15");
  CHECK(b.table().state_count == 7);
  // The unloading line is stiffer by 1/(1 - lambda), and the stable step smaller by its root.
  const Law soft(kLib, {}, {{"plasticity", 0}}, kSoft, kSoft), stiff(kLib, {}, {{"plasticity", 0.9}}, kSoft, kSoft);
  CHECK_NEAR(stiff.table().stable_dt(stiff.pair().data(), 1e-6, 1e-3, 1e-5) /
                 soft.table().stable_dt(soft.pair().data(), 1e-6, 1e-3, 1e-5),
             std::sqrt(0.1), 1e-12);
}
