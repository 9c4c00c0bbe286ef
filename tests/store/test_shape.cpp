// Volume, centre, axes and moments of shapes against closed forms and independent quadrature.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "store/particles.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Volume, centre and moments about the centre of two spheres on the z axis, by midpoints of 4e5 discs.
struct Discs {
  double volume = 0, centre = 0, axial = 0, transverse = 0;
};
Discs by_discs(double r1, double r2, double distance) {
  constexpr int kDiscs = 400000;
  const double lo = std::min(-r1, distance - r2), hi = std::max(r1, distance + r2), h = (hi - lo) / kDiscs;
  double v = 0, sz = 0, qz = 0, qx = 0;
  for (int k = 0; k < kDiscs; ++k) {
    const double z = lo + (k + 0.5) * h, p = std::max(r1 * r1 - z * z, r2 * r2 - (z - distance) * (z - distance));
    if (p <= 0) continue;
    v += kPi * p * h;
    sz += kPi * p * z * h;
    qz += kPi * p * z * z * h;
    qx += kPi / 4 * p * p * h;
  }
  const double c = sz / v;
  return {v, c, 2 * qx, qx + qz - v * c * c};
}

/// The inertia tensor in the user's frame, unit density, from a shape's axes and moments.
void tensor_of(const Shape& s, double out[3][3]) {
  const Vec3 e[3] = {rotate(s.frame, {1, 0, 0}), rotate(s.frame, {0, 1, 0}), rotate(s.frame, {0, 0, 1})};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      out[a][b] = 0;
      for (int k = 0; k < 3; ++k) out[a][b] += s.inertia[k] * e[k][a] * e[k][b];
    }
}

void check_places(const Shape& s, const std::vector<Shape::Member>& drawn) {
  double bound = 0;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const Vec3 back = rotate(s.frame, s.members[k].at) + s.centre;
    CHECK(norm(back - drawn[k].at) < 4e-15 * (1 + norm(drawn[k].at)));
    CHECK(s.members[k].radius == drawn[k].radius);
    bound = std::max(bound, norm(drawn[k].at - s.centre) + drawn[k].radius);
  }
  CHECK(s.bound == near(bound, 1e-14));
}

}  // namespace

TEST_CASE("one sphere has volume 4/3 pi r^3 and moment 2/5 m r^2 wherever it is drawn") {
  const double r = 1.25e-3;
  const Shape s = make_shape("ball", {{{0.3, -0.2, 0.1}, r}});
  const double v = 4.0 / 3 * kPi * r * r * r;
  CHECK(s.volume == near(v, 1e-15));
  for (int k = 0; k < 3; ++k) CHECK(s.inertia[k] == near(0.4 * v * r * r, 1e-10));
  CHECK(s.inertia.x == s.inertia.y);
  CHECK(s.inertia.y == s.inertia.z);
  CHECK(s.bound == r);
  CHECK(s.equal_radius == near(r, 1e-14));
  CHECK(norm(s.members[0].at) == 0);
  CHECK(norm(s.centre - Vec3{0.3, -0.2, 0.1}) < 1e-15);
}

TEST_CASE("two equal spheres have the published volume and moments of the clump of aspect 1.25") {
  // EPAM.md section 5, reading A: R 1.25 mm, distance 0.625 mm, density 2000 kg/m3.
  const double r = 1.25e-3, h = 0.3125e-3;
  const Shape s = make_shape("grain", {{{0, 0, -h}, r}, {{0, 0, h}, r}});
  CHECK(s.volume == near(11.1853e-9, 5e-6));
  CHECK(s.volume / (8.0 / 3 * kPi * r * r * r) == near(0.6836, 1e-4));
  CHECK(2 * s.equal_radius == near(2.7747e-3, 2e-5));
  CHECK(2000 * s.volume == near(22.371e-6, 3e-5));
  CHECK(2000 * s.inertia.z == near(1.48242e-11, 4e-6));
  CHECK(2000 * s.inertia.x == near(1.91155e-11, 4e-6));
  CHECK(s.inertia.x == near(s.inertia.y, 1e-14));
  CHECK(s.bound == near(r + h, 1e-14));
  // Closed forms of the same page, s = h.
  const double v = 2 * kPi * (2 * r * r * r / 3 + r * r * h - h * h * h / 3);
  CHECK(s.volume == near(v, 1e-13));
}

TEST_CASE("two unequal spheres agree with a sum over discs, whatever the axis they lie on") {
  for (const double distance : {0.9, 1.5, 1.9}) {
    const double r1 = 1.2, r2 = 0.7;
    const Discs want = by_discs(r1, r2, distance);
    for (const Vec3 axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, normalized(Vec3{1, 2, -0.5})}) {
      const Vec3 o{0.4, -3, 2};
      const std::vector<Shape::Member> drawn{{o, r1}, {o + distance * axis, r2}};
      const Shape s = make_shape("pear", drawn);
      CHECK(s.volume == near(want.volume, 1e-9));
      CHECK(norm(s.centre - (o + want.centre * axis)) < 1e-9);
      CHECK(s.inertia.z == near(want.axial, 1e-9));
      CHECK(s.inertia.x == near(want.transverse, 1e-8));
      CHECK(s.inertia.y == near(want.transverse, 1e-8));
      CHECK(norm(rotate(s.frame, {0, 0, 1}) - axis) < 1e-14);
      check_places(s, drawn);
    }
  }
}

TEST_CASE("a sphere inside the other leaves the other alone") {
  const Shape s = make_shape("nut", {{{0, 0, 0}, 1}, {{0.2, 0, 0}, 0.5}});
  CHECK(s.volume == near(4.0 / 3 * kPi, 1e-13));
  CHECK(norm(s.centre) < 1e-14);
  for (int k = 0; k < 3; ++k) CHECK(s.inertia[k] == near(0.4 * 4.0 / 3 * kPi, 1e-12));
  CHECK(s.bound == near(1, 1e-13));
  const Shape same = make_shape("same", {{{1, 1, 1}, 1}, {{1, 1, 1}, 1}});
  CHECK(same.volume == near(4.0 / 3 * kPi, 1e-4));
}

TEST_CASE("three spheres of which one is swallowed equal the exact pair") {
  const std::vector<Shape::Member> pair{{{0, 0, 0}, 1.2}, {{0.6, 0.9, -0.7}, 0.7}};
  std::vector<Shape::Member> three = pair;
  three.push_back({{0.1, 0.1, 0}, 0.6});
  const Shape exact = make_shape("pair", pair), grid = make_shape("three", three);
  CHECK(grid.volume == near(exact.volume, 1e-4));
  CHECK(norm(grid.centre - exact.centre) < 1e-4);
  double a[3][3], b[3][3];
  tensor_of(exact, a);
  tensor_of(grid, b);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) CHECK(std::abs(a[i][j] - b[i][j]) < 1e-4 * exact.inertia.x);
  check_places(grid, three);
}

TEST_CASE("spheres that only touch add like separate bodies, products of inertia included") {
  const std::vector<Shape::Member> drawn{{{0, 0, 0}, 1}, {{1.5, 0, 0}, 0.5}, {{0, 1.2, 1.6}, 1}, {{0, 0, -1.25}, 0.25}};
  const Shape s = make_shape("jack", drawn);
  double v = 0, want[3][3] = {};
  Vec3 c;
  for (const auto& m : drawn) {
    const double vm = 4.0 / 3 * kPi * m.radius * m.radius * m.radius;
    v += vm;
    c += vm * m.at;
  }
  c = c / v;
  for (const auto& m : drawn) {
    const double vm = 4.0 / 3 * kPi * m.radius * m.radius * m.radius;
    const Vec3 d = m.at - c;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        want[i][j] += vm * ((i == j ? 0.4 * m.radius * m.radius + norm2(d) : 0.0) - d[i] * d[j]);
  }
  CHECK(s.volume == near(v, 1e-4));
  CHECK(norm(s.centre - c) < 1e-4);
  double have[3][3];
  tensor_of(s, have);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) CHECK(std::abs(have[i][j] - want[i][j]) < 2e-4 * want[2][2]);
  CHECK(s.inertia.x <= s.inertia.y);
  CHECK(s.inertia.y <= s.inertia.z);
  // A right-handed frame of unit length.
  const Vec3 x = rotate(s.frame, {1, 0, 0}), y = rotate(s.frame, {0, 1, 0}), z = rotate(s.frame, {0, 0, 1});
  CHECK(norm(cross(x, y) - z) < 1e-14);
  check_places(s, drawn);
}

TEST_CASE("spheres drawn at the sum of their radii touch in every direction") {
  for (int k = 0; k < 50; ++k) {
    const double a = 0.1 * k;
    const Vec3 axis = normalized(Vec3{std::cos(a), std::sin(a), std::sin(3 * a)});
    const Shape s = make_shape("dumbbell", {{{1, 2, 3}, 1.2}, {Vec3{1, 2, 3} + 1.9 * axis, 0.7}});
    CHECK(s.volume == near(4.0 / 3 * kPi * (1.2 * 1.2 * 1.2 + 0.7 * 0.7 * 0.7), 1e-12));
  }
}

TEST_CASE("shapes that are no body are refused") {
  CHECK_THROWS_WITH_AS(make_shape("a", {}), doctest::Contains("at least one sphere"), std::invalid_argument);
  CHECK_THROWS_WITH_AS(make_shape("a", {{{}, 0}}), doctest::Contains("above 0"), std::invalid_argument);
  CHECK_THROWS_WITH_AS(make_shape("a", {{{}, 1}, {{2.1, 0, 0}, 1}}), doctest::Contains("touch or overlap"),
                       std::invalid_argument);
  CHECK_THROWS_AS(make_shape("a", {{{}, std::nan("")}}), std::invalid_argument);
  CHECK_THROWS_WITH_AS(make_shape("a", {{{}, 1}, {{2.00001, 0, 0}, 1}}), doctest::Contains("touch or overlap"),
                       std::invalid_argument);
  // Joined by a third.
  CHECK(make_shape("a", {{{}, 1}, {{3, 0, 0}, 1}, {{1.5, 0, 0}, 0.6}}).members.size() == 3);
}
