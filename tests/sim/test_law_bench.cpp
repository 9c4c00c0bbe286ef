// The law bench against closed forms: Hertz' curve, the loops of EEPA, restitution, Coulomb's loop, viscoelastic
// spheres.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/units.hpp"
#include "sim/law_bench.hpp"

using namespace calx;

namespace {

using Overrides = std::vector<std::pair<std::string, std::string>>;

LawBench bench(const std::vector<std::string>& laws, const Overrides& set = {}, const LawBenchOptions& options = {}) {
  PluginRegistry registry({CALX_PLUGIN_DIR, CALX_TEST_PLUGIN_DIR});
  return bench_law_list(parse_case(law_bench_case(laws, registry), "bench", set), "i", "j", options, registry);
}

std::pair<std::string, std::string> given(const std::string& key, double value) {
  return {"/contacts/0/laws/0/parameters/" + key, format_number(value)};
}

/// Relative to the value alone; doctest adds 1, which hides forces of millinewtons.
doctest::Approx about(double value, double share) { return doctest::Approx(value).scale(0).epsilon(share); }

// Of the bench's materials and radii: 10 MPa, 0.25, 1 mm.
const double e_star = 1e7 / (2 * (1 - 0.0625)), r_star = 0.5e-3;
const double k_hertz = 4.0 / 3 * e_star * std::sqrt(r_star);
const double m_star = 0.5 * 4.0 / 3 * 3.141592653589793 * 1e-9 * 2500;

}  // namespace

TEST_CASE("a slow press of elastic spheres is Hertz' curve, there and back") {
  const LawBench b = bench({"calx.hertz-mindlin"});
  CHECK(b.mass == about(m_star, 1e-12));
  CHECK(b.radius == about(r_star, 1e-12));
  REQUIRE(b.press.size() == 3);
  for (const LawPress& press : b.press) {
    REQUIRE(press.overlap.size() == 239);
    for (std::size_t k = 0; k < press.overlap.size(); ++k) {
      // The dashpot at the speed of the press is 7e-10 of the force at the shallowest row.
      CHECK(press.force[k] == about(k_hertz * std::pow(press.overlap[k], 1.5), 2e-9));
    }
    CHECK(std::fabs(press.loss_share) < 1e-9);
  }
  // The deepest press is that of an impact at 0.1 m/s; the table of its work has steps of 0.4 % there.
  const double deepest = std::pow(1.25 * m_star * 0.01 / k_hertz, 0.4);
  CHECK(b.press[2].overlap[119] == about(deepest, 5e-3));
}

TEST_CASE(
    "an elastic impact turns where Hertz says and lasts as long, and a dashpot gives its restitution at every speed") {
  for (const double e : {1.0, 0.8, 0.3}) {
    CAPTURE(e);
    const LawBench b = bench({"calx.hertz-mindlin"}, {given("restitution", e)});
    REQUIRE(b.speed.size() == 16);
    CHECK(b.speed.front() == about(0.01, 1e-12));
    CHECK(b.speed.back() == about(3, 1e-12));
    for (std::size_t k = 0; k < b.speed.size(); ++k) {
      CAPTURE(b.speed[k]);
      // Some 3000 steps of an impact: measured 2e-4 off at most.
      CHECK(b.restitution[k] == about(e, 1e-3));
      if (e < 1) continue;
      const double deepest = std::pow(1.25 * m_star * b.speed[k] * b.speed[k] / k_hertz, 0.4);
      CHECK(b.deepest[k] == about(deepest, 1e-4));
      // Johnson 1985, eq. 11.24: 2.94 deepest / speed. One step in 3000 is the error of its end.
      CHECK(b.contact_time[k] == about(2.9433 * deepest / b.speed[k], 1e-3));
    }
  }
}

TEST_CASE("a loop of EEPA follows its three branches at every row") {
  const double lambda = 0.6, gamma = 2;
  const LawBench b = bench({"calx.epam"}, {given("plasticity", lambda), given("surface_energy", gamma)});
  const double k1 = k_hertz, k2 = k1 / (1 - lambda), r = 1e-3;
  for (const LawPress& press : b.press) {
    const double deepest = press.overlap[119], plastic = std::pow(lambda, 2.0 / 3) * deepest;
    // The undeformed spheres cut at the plastic overlap on a circle of radius a.
    const double a =
        std::sqrt(plastic * (2 * r - plastic) * (2 * r - plastic) * (4 * r - plastic) / 4) / (2 * r - plastic);
    const double pull = std::min(1.5 * 3.141592653589793 * gamma * a, 0.5 * k2 * std::pow(plastic, 1.5));
    const double lowest_at = std::pow(std::pow(plastic, 1.5) - pull / k2, 2.0 / 3);
    const double k_adh = pull / std::pow(lowest_at, 1.5);
    CHECK(press.most == about(k1 * std::pow(deepest, 1.5), 1e-6));
    for (std::size_t k = 0; k < press.overlap.size(); ++k) {
      const double d15 = std::pow(press.overlap[k], 1.5);
      const double branch = k < 120 ? k1 * d15 : std::max(k2 * (d15 - std::pow(plastic, 1.5)), -k_adh * d15);
      CHECK(press.force[k] == doctest::Approx(branch).scale(press.most).epsilon(1e-6));
    }
    // The kink lies between two rows; k2 times their distance is 3 % of the peak.
    CHECK(press.least < -pull + 0.03 * press.most);
    CHECK(press.least >= -pull * (1 + 1e-6));
  }
  CHECK(b.restitution.front() == 0);  // too slow to part again
  CHECK(b.restitution.back() > 0.2);
}

TEST_CASE("plastic loss alone gives EEPA the same restitution at every speed") {
  const LawBench b = bench({"calx.epam"}, {given("plasticity", 0.5), given("restitution", 1)});
  // e^2 = [1 - (n+1) lambda + n lambda^((n+1)/n)] / (1 - lambda), n = 1.5: README of plugins/epam.
  const double e = std::sqrt((1 - 2.5 * 0.5 + 1.5 * std::pow(0.5, 2.5 / 1.5)) / 0.5);
  for (const double one : b.restitution) CHECK(one == about(e, 1e-3));
  // The same loss in the slow loop. Trapezoids of 120 steps: 1e-3.
  CHECK(1 - b.press[2].loss_share == about(e * e, 2e-3));
}

TEST_CASE("a tangential loop has the stiffness, the limit and the area of spring and slider") {
  const double kn = 2e4, kt = 1e4, mu = 0.4;
  const LawBench b = bench({"calx.linear"}, {given("kn", kn), given("kt", kt), given("friction", mu)});
  const double limit = mu * kn * b.sheared_overlap;
  CHECK(b.sheared_force == about(kn * b.sheared_overlap, 1e-6));
  CHECK(b.tangential[0] == about(kt * b.displacement[0], 1e-6));
  CHECK(*std::max_element(b.tangential.begin(), b.tangential.end()) == about(limit, 1e-6));
  CHECK(*std::min_element(b.tangential.begin(), b.tangential.end()) == about(-limit, 1e-6));
  // Closed loop from the far end and back to it: a parallelogram.
  double area = 0;
  for (std::size_t k = 150; k < b.displacement.size(); ++k)
    area += 0.5 * (b.tangential[k] + b.tangential[k - 1]) * (b.displacement[k] - b.displacement[k - 1]);
  const double far = b.displacement[149];
  REQUIRE(far > 2 * limit / kt);
  // Two corners fall between rows, 1/300 of the way apart.
  CHECK(area == about(4 * limit * (far - limit / kt), 5e-3));
}

TEST_CASE("a rolling loop ends at the torque that the law allows") {
  const Overrides set = {given("rolling_friction", 0.1), {"/contacts/0/laws/0/parameters/rolling", "\"a\""}};
  const LawBench b = bench({"calx.linear"}, set);
  // mu_r R* F, at once and against the turn.
  const double cap = 0.1 * r_star * b.sheared_force;
  CHECK(b.torque[0] == about(cap, 1e-6));
  CHECK(*std::min_element(b.torque.begin(), b.torque.end()) == about(-cap, 1e-6));
  CHECK(b.angle.front() > 0);
  CHECK(b.roll_spin == 10);  // this kind only brakes what turns
  for (const double none : bench({"calx.linear"}).torque) CHECK(none == 0);
  // A spring of stiffness k R*^2 that yields at the same torque.
  const LawBench sds = bench({"calx.linear"}, {given("rolling_friction", 0.1),
                                               given("rolling_stiffness", 1e4),
                                               {"/contacts/0/laws/0/parameters/rolling", "\"sds\""}});
  CHECK(sds.roll_spin == 1e-4);
  CHECK(sds.torque[0] == about(1e4 * r_star * r_star * sds.angle[0], 1e-6));
  CHECK(*std::max_element(sds.torque.begin(), sds.torque.end()) == about(cap, 1e-6));
}

TEST_CASE("without friction there is no tangential force, and forces of a list add") {
  const LawBench smooth = bench({"calx.linear"}, {given("friction", 0)});
  for (const double force : smooth.tangential) CHECK(force == 0);
  LawBenchOptions same;
  same.overlap = 1e-5;
  const LawBench a = bench({"calx.linear"}, {}, same), b = bench({"calx.hertz-mindlin"}, {}, same);
  const LawBench both = bench({"calx.linear", "calx.hertz-mindlin"}, {}, same);
  CHECK(both.laws == std::vector<std::string>{"calx.linear", "calx.hertz-mindlin"});
  for (std::size_t k = 0; k < both.press[2].force.size(); ++k)
    CHECK(both.press[2].force[k] == about(a.press[2].force[k] + b.press[2].force[k], 1e-12));
}

TEST_CASE("against a wall radius and mass are those of the sphere") {
  LawBenchOptions wall;
  wall.wall = true;
  const LawBench b = bench({"calx.hertz-mindlin"}, {}, wall);
  CHECK(b.radius == about(2 * r_star, 1e-12));
  CHECK(b.mass == about(2 * m_star, 1e-12));
  CHECK(b.press[1].force[50] == about(std::sqrt(2.0) * k_hertz * std::pow(b.press[1].overlap[50], 1.5), 1e-6));
}

TEST_CASE("viscoelastic spheres lose the more, the faster they meet") {
  const double time = 1e-7;  // A, s: losses below 3 %, where the first terms of the series hold
  const LawBench b = bench({"org.example.restitution-hertz"}, {given("relaxation", time)});
  for (std::size_t k = 0; k < b.speed.size(); ++k) {
    CAPTURE(b.speed[k]);
    // Schwager and Poeschel 1998: e = 1 - C1 x + C2 x^2, x = 3/2 A (k/m*)^0.4 v^0.2, C1 = 1.15344, C2 = 3/5 C1^2.
    const double x = 1.5 * time * std::pow(k_hertz / m_star, 0.4) * std::pow(b.speed[k], 0.2);
    const double loss = 1.15344 * x - 0.6 * 1.15344 * 1.15344 * x * x;
    REQUIRE(loss < 0.03);
    // The next term of the series is below 1 % of the loss; steps add 1e-4 to e.
    CHECK(1 - b.restitution[k] == about(loss, 0.02));
  }
  CHECK(1 - b.restitution.back() > 3 * (1 - b.restitution.front()));  // 300^0.2 = 3.13
}

TEST_CASE("a pair that the case does not have is answered with those it has") {
  PluginRegistry registry({CALX_PLUGIN_DIR});
  const CaseFile file = parse_case(law_bench_case({"calx.linear"}, registry), "bench");
  const auto said = [&](const std::string& i, const std::string& j) -> std::string {
    try {
      bench_law_list(file, i, j, {}, registry);
    } catch (const Error& e) {
      return e.what();
    }
    return "nothing";
  };
  CHECK(said("i", "i") == "bench /contacts: none is between \"i\" and \"i\"; known are \"i,j\"");
  CHECK(said("steal", "j") == "bench: no material \"steal\"; known are \"i\", \"j\"");
}
