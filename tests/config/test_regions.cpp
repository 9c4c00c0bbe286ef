// Regions against closed forms and against each other.
#include <doctest/doctest.h>

#include "base/random.hpp"
#include "config/settings.hpp"

using namespace calx;
using doctest::Approx;
using Kind = RegionSettings::Kind;

namespace {

RegionSettings make(Kind kind, Vec3 a, Vec3 b, double radius, double radius_b = 0) {
  RegionSettings r;
  r.kind = kind;
  r.a = a;
  r.b = b;
  r.radius = radius;
  r.radius_b = radius_b;
  return r;
}

const double pi = 3.141592653589793;
const RegionSettings regions[] = {make(Kind::box, {-1, 0, 2}, {1, 3, 4}, 0), make(Kind::sphere, {1, 2, 3}, {}, 0.5),
                                  make(Kind::cylinder, {0, 0, 0}, {1, 1, 1}, 0.4),
                                  make(Kind::cone, {0, 0, 0}, {0, 2, 1}, 0.2, 0.7)};

}  // namespace

TEST_CASE("volumes are those of the closed forms") {
  CHECK(regions[0].volume() == Approx(12));
  CHECK(regions[1].volume() == Approx(pi / 6));
  CHECK(regions[2].volume() == Approx(pi * 0.16 * std::sqrt(3.0)));
  CHECK(regions[3].volume() == Approx(pi / 3 * std::sqrt(5.0) * (0.04 + 0.14 + 0.49)));
}

TEST_CASE("random points inside fill the volume and stay within the bounds") {
  for (const RegionSettings& r : regions) {
    const Box b = r.bounds();
    Random random(1, 2);
    int inside = 0;
    const int draws = 200000;
    for (int k = 0; k < draws; ++k) {
      // A margin around the bounds shows points inside that the bounds would miss.
      const Vec3 d = b.hi - b.lo, lo = b.lo - 0.1 * d;
      const Vec3 p{lo.x + 1.2 * d.x * random.uniform(), lo.y + 1.2 * d.y * random.uniform(),
                   lo.z + 1.2 * d.z * random.uniform()};
      if (!r.contains(p)) continue;
      ++inside;
      CHECK_MESSAGE(b.contains(p), static_cast<int>(r.kind));
    }
    const Vec3 d = 1.2 * (b.hi - b.lo);
    // The share has a standard deviation of at most 0.5 / sqrt(draws) = 0.11 % of the box; four of them.
    CHECK(std::abs(inside / double(draws) - r.volume() / (d.x * d.y * d.z)) < 4 * 0.5 / std::sqrt(double(draws)));
  }
}

TEST_CASE("bounds touch the region: a slightly smaller box would cut it") {
  const Box cylinder = regions[2].bounds();
  const double reach = 0.4 * std::sqrt(2.0 / 3);
  CHECK(cylinder.lo.x == Approx(-reach));
  CHECK(cylinder.hi.z == Approx(1 + reach));
  const Box cone = regions[3].bounds();
  CHECK(cone.hi.x == Approx(0.7));
  CHECK(cone.hi.y == Approx(2 + 0.7 / std::sqrt(5.0)));
  CHECK(cone.lo.z == Approx(std::min(-0.2 * 2 / std::sqrt(5.0), 1 - 0.7 * 2 / std::sqrt(5.0))));
}

TEST_CASE("the surface belongs to the region, what lies beyond an end does not") {
  CHECK(regions[0].contains({1, 3, 4}));
  CHECK_FALSE(regions[0].contains({1.001, 3, 4}));
  CHECK(regions[1].contains({1.5, 2, 3}));
  const RegionSettings upright = make(Kind::cylinder, {0, 0, 0}, {0, 0, 1}, 0.5);
  CHECK(upright.contains({0.5, 0, 1}));
  CHECK_FALSE(upright.contains({0, 0, 1.001}));
  CHECK_FALSE(upright.contains({0, 0, -0.001}));
  const RegionSettings tip = make(Kind::cone, {0, 0, 0}, {0, 0, 1}, 0.5, 0);
  CHECK(tip.contains({0.2, 0, 0.5}));
  CHECK_FALSE(tip.contains({0.3, 0, 0.5}));
}
