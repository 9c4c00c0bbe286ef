#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "measure/overlap.hpp"

using namespace calx;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double ball = 4 * pi / 3;

RegionSettings box(const Vec3& lo, const Vec3& hi) {
  RegionSettings region;
  region.a = lo, region.b = hi;
  return region;
}

RegionSettings round(RegionSettings::Kind kind, const Vec3& a, const Vec3& b, double ra, double rb = 0) {
  RegionSettings region;
  region.kind = kind, region.a = a, region.b = b, region.radius = ra, region.radius_b = rb;
  return region;
}

double cap(double r, double h) { return pi * h * h * (3 * r - h) / 3; }

}  // namespace

TEST_CASE("caps, halves and eighths of a sphere in a box have their closed forms") {
  const RegionSettings region = box({0, 0, 0}, {10, 10, 10});
  CHECK(overlap_volume(region, {5, 5, 5}, 1) == doctest::Approx(ball).epsilon(1e-14));
  CHECK(overlap_volume(region, {0, 5, 5}, 1) == doctest::Approx(ball / 2).epsilon(1e-10));
  CHECK(overlap_volume(region, {0, 5, 10}, 1) == doctest::Approx(ball / 4).epsilon(1e-10));
  CHECK(overlap_volume(region, {0, 0, 0}, 1) == doctest::Approx(ball / 8).epsilon(1e-10));
  for (double h : {0.1, 0.7, 1.6}) {
    CHECK(overlap_volume(region, {5, 5, h - 1}, 1) == doctest::Approx(cap(1, h)).epsilon(1e-9));
    CHECK(overlap_volume(region, {h - 1, 5, 5}, 1) == doctest::Approx(cap(1, h)).epsilon(1e-9));
  }
  CHECK(overlap_volume(region, {-1.01, 5, 5}, 1) == 0);
  // The corner's nearest point is outside the sphere although both faces cut it.
  CHECK(overlap_volume(region, {-0.8, -0.8, 5}, 1) < 1e-14);
  // Sphere larger than the box.
  CHECK(overlap_volume(box({-1, -1, -1}, {1, 1, 1}), {0, 0, 0}, 2) == doctest::Approx(8).epsilon(1e-9));
}

TEST_CASE("boxes that tile space share a sphere without rest") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.9, 0.9);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 c{place(random), place(random), place(random)}, split{place(random), place(random), place(random)};
    double sum = 0;
    for (int part = 0; part < 8; ++part) {
      Vec3 lo, hi;
      for (int k = 0; k < 3; ++k) {
        const bool upper = (part >> k & 1) != 0;
        lo[k] = upper ? split[k] : -5;
        hi[k] = upper ? 5 : split[k];
      }
      sum += overlap_volume(box(lo, hi), c, 1);
    }
    CHECK(sum == doctest::Approx(ball).epsilon(1e-9));
  }
}

TEST_CASE("cylinders, also slanting ones, and spherical regions cut as they should") {
  using Kind = RegionSettings::Kind;
  const RegionSettings slanting = round(Kind::cylinder, {0, 0, 0}, {3, 4, 0}, 2);
  CHECK(overlap_volume(slanting, {1.5, 2, 0}, 1) == doctest::Approx(ball).epsilon(1e-9));
  CHECK(overlap_volume(slanting, {0, 0, 0}, 1) == doctest::Approx(ball / 2).epsilon(1e-9));
  // A sphere on the axis of a narrow cylinder: ball less a napkin ring, 4 pi / 3 (R^3 - (R^2 - a^2)^1.5).
  const double hole = ball * (1 - std::pow(1 - 0.25, 1.5));
  CHECK(overlap_volume(round(Kind::cylinder, {0, 0, -9}, {0, 0, 9}, 0.5), {0, 0, 0}, 1) ==
        doctest::Approx(hole).epsilon(1e-9));
  // A very wide cylinder is nearly a half space: its wall sags by at most 0.5 / 1e4.
  CHECK(overlap_volume(round(Kind::cylinder, {0, 0, -9}, {0, 0, 9}, 1e4), {1e4, 0, 0}, 1) ==
        doctest::Approx(ball / 2).epsilon(1e-4));
  const RegionSettings region = round(Kind::sphere, {1, 0, 0}, {}, 1);
  CHECK(overlap_volume(region, {0, 0, 0}, 1) == doctest::Approx(2 * cap(1, 0.5)).epsilon(1e-12));
  CHECK(overlap_volume(region, {1, 0.2, 0}, 0.5) == doctest::Approx(ball / 8).epsilon(1e-12));
  CHECK(overlap_volume(region, {1, 0, 0}, 3) == doctest::Approx(ball).epsilon(1e-12));
  CHECK(overlap_volume(region, {4, 0, 0}, 1) == 0);
}

TEST_CASE("a cylinder and a cone agree with a fine sum over points") {
  using Kind = RegionSettings::Kind;
  const auto counted = [](const auto& is_inside, const Vec3& c, double r) {
    const int n = 120;
    double count = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          const Vec3 u{(2 * i + 1.0) / n - 1, (2 * j + 1.0) / n - 1, (2 * k + 1.0) / n - 1};
          if (norm2(u) <= 1 && is_inside(c + r * u)) count += 1;
        }
    return count * 8 * r * r * r / (n * n * n);
  };
  const RegionSettings cylinder = round(Kind::cylinder, {0, 0, 0}, {0, 0, 2}, 1.5);
  const RegionSettings cone = round(Kind::cone, {0, 0, 0}, {0, 0, 2}, 1.5, 0.2);
  const auto in_cylinder = [](const Vec3& p) { return p.z >= 0 && p.z <= 2 && p.x * p.x + p.y * p.y <= 2.25; };
  const auto in_cone = [](const Vec3& p) {
    const double r = 1.5 - 0.65 * p.z;
    return p.z >= 0 && p.z <= 2 && p.x * p.x + p.y * p.y <= r * r;
  };
  for (const Vec3& c : {Vec3{1, 0.7, 0.3}, Vec3{-0.4, 1.2, 1.8}, Vec3{0.1, 0, 2.1}}) {
    // The sum's own error: about n^-1.5 of the ball, 1e-3.
    CHECK(overlap_volume(cylinder, c, 0.6) == doctest::Approx(counted(in_cylinder, c, 0.6)).epsilon(4e-3));
    CHECK(overlap_volume(cone, c, 0.6) == doctest::Approx(counted(in_cone, c, 0.6)).epsilon(4e-3));
  }
}
