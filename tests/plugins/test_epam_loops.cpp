// test_epam_loops.cpp: calx.epam against LIGGGHTS loops, its refusals, and what its tables say. Data:
// tests/data/README.md.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"
#include "support/table.hpp"

using namespace bench;

namespace {
const char* kLib = "calx-epam";
const Material kSoft{5e7, 0.25};
Values base(Values more) {
  more.insert({"restitution", 1});
  more.insert({"friction", 0});
  return more;
}
}  // namespace

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
