// test_liquid_bridge.cpp: calx.liquid-bridge alone against its closed forms, against the fit of Willett et al. (2000)
// to solutions of the Laplace-Young equation, and against the lubrication force of a sphere near a plane.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"

using namespace bench;

namespace {

const char* kLib = "calx-liquid-bridge";
constexpr double kTension = 0.0728, kR = 1e-3;

/// Equal spheres of radius kR; a wall where r_j is 0.
Input contact(double overlap, double vn = 0, double r_j = kR) {
  Input row;
  row[CALX_IN_OVERLAP] = overlap;
  row[CALX_IN_NZ] = 1;
  row[CALX_IN_VZ] = vn;
  row[CALX_IN_R_EFF] = r_j > 0 ? kR * r_j / (kR + r_j) : kR;
  row[CALX_IN_M_EFF] = 5e-6;
  return row;
}
/// Pull at a gap of a bridge that is there, N, and what the contact stores, J.
double pull(const Law& law, double gap, double r_j = kR, double* stored = nullptr) {
  std::vector<double> state = {1};
  const Output o = law.evaluate(contact(-gap, 0, r_j), state, 1e-6);
  if (stored) *stored = o[CALX_OUT_ELASTIC];
  return -o[CALX_OUT_FZ];
}

}  // namespace

TEST_CASE("touching spheres pull with 2 pi gamma R cos theta, a sphere on a wall with twice that") {
  for (const double angle : {0.0, 0.5, 1.2}) {
    const Law law(kLib, {}, {{"relative_volume", 1e-3}, {"contact_angle", angle}});
    const double expected = 2 * pi * kTension * kR * std::cos(angle);
    CHECK_NEAR(pull(law, 0), expected, 1e-14);
    CHECK_NEAR(pull(law, -1e-5), expected, 1e-14);
    CHECK_NEAR(pull(law, 0, 0), 2 * expected, 1e-14);
    // Unequal spheres: R = 2 r_i r_j / (r_i + r_j).
    CHECK_NEAR(pull(law, 0, 3 * kR), 1.5 * expected, 1e-14);
  }
}

TEST_CASE("the pull falls with the gap as 1 - S / sqrt(S^2 + 2 V / (pi R)), whichever way the volume is given") {
  const double share = 2e-3, volume = share * kR * kR * kR;
  const Law by_share(kLib, {}, {{"relative_volume", share}}), by_volume(kLib, {}, {{"volume", volume}});
  for (const double gap : {1e-6, 1e-5, 5e-5, 1.2e-4}) {
    const double expected = 2 * pi * kTension * kR * (1 - gap / std::sqrt(gap * gap + 2 * volume / (pi * kR)));
    CHECK_NEAR(pull(by_share, gap), expected, 1e-12);
    CHECK_NEAR(pull(by_volume, gap), expected, 1e-12);
  }
}

TEST_CASE("the pull follows the fit of Willett et al. to solutions of the Laplace-Young equation") {
  // Langmuir 16 (2000) 9396: ln F* = f1 - f2 exp(f3 ln s + f4 ln^2 s) at a contact angle of 0, F* = F / (2 pi gamma R),
  // s = S / 2 sqrt(R / V). The closed form takes the bridge for a cylinder; measured, it differs by up to 0.03 of the
  // force at contact, and by half of the little that is left where the bridge breaks.
  for (const double share : {1e-5, 1e-4, 1e-3}) {
    const Law law(kLib, {}, {{"relative_volume", share}});
    const double volume = share * kR * kR * kR, first = 2 * pi * kTension * kR, l = std::log(share);
    const double f1 = -0.44507 - 0.1119 * l - 0.012101 * l * l - 0.0005 * l * l * l,
                 f2 = 1.9222 - 0.0668 * l - 0.0013375 * l * l,
                 f3 = 1.268 + 0.198 * l + 0.02232 * l * l + 0.0008585 * l * l * l,
                 f4 = -0.010703 + 0.03345 * l + 0.0018574 * l * l;
    for (int k = 1; k <= 40; ++k) {
      const double gap = k / 40.0 * 0.99 * std::cbrt(volume), s = std::log(0.5 * gap * std::sqrt(kR / volume));
      const double fit = first * std::exp(f1 - f2 * std::exp(f3 * s + f4 * s * s));
      CHECK(std::fabs(pull(law, gap) - fit) < 0.035 * first);
      CHECK(pull(law, gap) > 0.5 * fit);
    }
  }
}

TEST_CASE("a bridge breaks at (1 + theta / 2) V^(1/3) and does not come back before the spheres touch") {
  const double volume = 1e-12, angle = 0.6;
  const Law law(kLib, {}, {{"volume", volume}, {"contact_angle", angle}});
  const double end = (1 + 0.5 * angle) * std::cbrt(volume);
  CHECK_NEAR(law.table().reach(law.pair().data(), kR, kR), end, 1e-14);
  CHECK_NEAR(law.table().reach(law.pair().data(), kR, 0), end, 1e-14);
  std::vector<double> state = law.fresh();
  const auto at = [&](double gap) { return -law.evaluate(contact(-gap), state, 1e-6)[CALX_OUT_FZ]; };
  CHECK(at(1e-6) == 0);
  CHECK(at(0.5 * end) == 0);
  CHECK(at(0) > 0);  // forms
  CHECK(at(0.5 * end) > 0);
  CHECK(at(end * (1 - 1e-9)) > 0);
  CHECK(at(end * (1 + 1e-9)) == 0);  // breaks
  CHECK(at(0.5 * end) == 0);
  CHECK(at(-1e-7) > 0);
  CHECK(at(0.99 * end) > 0);

  // In proportion to the size: the reach is, too, and that against a wall is of R = 2 r.
  const Law share(kLib, {}, {{"relative_volume", 1e-3}});
  CHECK_NEAR(share.table().reach(share.pair().data(), kR, kR), 0.1 * kR, 1e-14);
  CHECK_NEAR(share.table().reach(share.pair().data(), kR, 0), 0.2 * kR, 1e-14);
  CHECK_NEAR(share.table().reach(share.pair().data(), kR, 3 * kR), 0.15 * kR, 1e-14);
}

TEST_CASE("with liquid films a bridge forms at the formation distance, never beyond where it breaks") {
  const double volume = 1e-12, end = std::cbrt(volume);
  for (const double formation : {2e-5, 3e-4}) {
    const Law law(kLib, {}, {{"volume", volume}, {"formation_distance", formation}});
    std::vector<double> state = law.fresh();
    const auto at = [&](double gap) { return -law.evaluate(contact(-gap), state, 1e-6)[CALX_OUT_FZ]; };
    CHECK(at(1.001 * std::fmin(formation, end)) == 0);
    CHECK(at(0.999 * std::fmin(formation, end)) > 0);
  }
}

TEST_CASE("work of separation is the integral of the pull; what a bridge stored on forming was lost then") {
  const double share = 1e-3, volume = share * kR * kR * kR, end = std::cbrt(volume), a = 2 * volume / (pi * kR);
  const Law law(kLib, {}, {{"relative_volume", share}});
  // 2 pi gamma R (sqrt(a) - (sqrt(end^2 + a) - end)), the integral of the closed form.
  const double exact = 2 * pi * kTension * kR * (std::sqrt(a) - (std::sqrt(end * end + a) - end));
  double work = 0, stored = 0;
  const int steps = 20000;
  for (int k = 0; k < steps; ++k) work += pull(law, (k + 0.5) / steps * end * (1 - 1e-12)) * end / steps;
  // Midpoint rule: curvature times the square of a step, 1e-9 here.
  CHECK_NEAR(work, exact, 1e-6);
  pull(law, 0, kR, &stored);
  CHECK_NEAR(-stored, exact, 1e-12);
  for (const double gap : {1e-6, 3e-5, 9e-5}) {
    double left = 0;
    pull(law, gap, kR, &left);
    const double dx = 1e-9;
    double nearer = 0;
    pull(law, gap - dx, kR, &nearer);
    CHECK_NEAR((left - nearer) / dx, pull(law, gap - 0.5 * dx), 1e-5);  // cancellation: 1e-16 of 1e-8 J over 1e-9 m
  }
  std::vector<double> state = law.fresh();
  const Output formed = law.evaluate(contact(2e-6), state, 1e-6);
  CHECK_NEAR(formed[CALX_OUT_PLASTIC], -formed[CALX_OUT_ELASTIC], 0);
  CHECK_NEAR(formed[CALX_OUT_PLASTIC], exact + 2 * pi * kTension * kR * 2e-6, 1e-12);
  CHECK(law.evaluate(contact(1e-6), state, 1e-6)[CALX_OUT_PLASTIC] == 0);
  CHECK(law.evaluate(contact(-2 * end), state, 1e-6)[CALX_OUT_ELASTIC] == 0);
}

TEST_CASE("the viscous part is the lubrication force 6 pi mu r_eff^2 v / S, less where the bridge is narrow") {
  const double mu = 0.1, v = 0.01, share = 0.05, least = 2e-6;
  const Law dry(kLib, {}, {{"relative_volume", share}, {"surface_tension", 0}}),
      law(kLib, {}, {{"relative_volume", share}, {"surface_tension", 0}, {"viscosity", mu}, {"least_gap", least}});
  const double volume = share * kR * kR * kR, r = 0.5 * kR;
  const auto force = [&](const Law& l, double gap, double vn) {
    std::vector<double> state = {1};
    return l.evaluate(contact(-gap, vn), state, 1e-6)[CALX_OUT_FZ];
  };
  for (const double gap : {5e-6, 3e-5, 2e-4}) {
    const double x = 1 - gap / std::sqrt(gap * gap + 2 * volume / (pi * kR));
    CHECK_NEAR(force(law, gap, v), -6 * pi * mu * r * r * x * x * v / gap, 1e-12);
    CHECK_NEAR(force(law, gap, -v), 6 * pi * mu * r * r * x * x * v / gap, 1e-12);
    CHECK(force(dry, gap, v) == 0);
  }
  // Closer than the roughness, and while touching, it no longer grows.
  CHECK_NEAR(force(law, -1e-6, v), -6 * pi * mu * r * r * v / least, 1e-12);
  std::vector<double> state = {1};
  const Output o = law.evaluate(contact(-1e-5, v), state, 1e-9);
  CHECK_NEAR(o[CALX_OUT_DAMPING], -o[CALX_OUT_FZ] * v * 1e-9, 1e-3);  // half a kick, 1e-4 of v
}

TEST_CASE("a dry contact pulls with nothing; two volumes are refused") {
  const Law dry(kLib, {}, {});
  std::vector<double> state = dry.fresh();
  const Output o = dry.evaluate(contact(1e-5, 0.1), state, 1e-6);
  for (int k = 0; k < CALX_OUT_COUNT; ++k) CHECK(o[k] == 0);
  CHECK(dry.table().reach(dry.pair().data(), kR, kR) == 0);
  const Law both(kLib, {}, {{"relative_volume", 1e-3}, {"volume", 1e-12}});
  CHECK(both.status() == CALX_E_CONFIG);
  CHECK(both.message() == "\"volume\" and \"relative_volume\" both say how much liquid a bridge has; give one");
}

TEST_CASE("single precision stays near double, also where the bridge is about to break") {
  const Law law(kLib, {}, {{"relative_volume", 1e-4}, {"viscosity", 0.01}, {"least_gap", 1e-6}});
  std::vector<Input> rows;
  for (int k = 0; k < 100; ++k) rows.push_back(contact(-k / 100.0 * std::cbrt(1e-4) * kR, 0.02));
  std::vector<std::vector<double>> a(rows.size(), {1}), b = a;
  const auto in_double = law.evaluate<double>(rows, a, 1e-6, 256), in_single = law.evaluate<float>(rows, b, 1e-6, 256);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK_NEAR(in_single[k][CALX_OUT_FZ], in_double[k][CALX_OUT_FZ], 3e-6);
    CHECK(a[k] == b[k]);
  }
}
