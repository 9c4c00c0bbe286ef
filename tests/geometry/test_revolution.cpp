// Surfaces of revolution against numbers known in closed form and against fine meshes.
#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/random.hpp"
#include "geometry/shapes.hpp"

using namespace calx;
using doctest::Approx;

TEST_CASE("a tube touches from inside and outside with exact overlap and radial normal") {
  const Surface s = revolution({0.1, 0, 0.1, 1});
  Random random(5, 1);
  for (int k = 0; k < 500; ++k) {
    const double angle = random.uniform(0, 6.28), r = random.uniform(0.085, 0.115), z = random.uniform(0, 1);
    const Vec3 e{std::cos(angle), std::sin(angle), 0};
    const auto c = contacts(s, r * e + Vec3{0, 0, z}, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance == Approx(std::abs(r - 0.1)).epsilon(1e-9));
    CHECK(norm(c[0].normal - (r < 0.1 ? -1.0 : 1.0) * e) < 1e-12);
    CHECK(norm(c[0].point - (0.1 * e + Vec3{0, 0, z})) < 1e-12);
  }
}

TEST_CASE("the corner of tube and floor gives two contacts, its outside one, an open end is an edge") {
  const Surface s = revolution({0, 0, 0.1, 0, 0.1, 1});
  const auto inside = contacts(s, {0.09, 0, 0.015}, 0.02);
  REQUIRE(inside.size() == 2);
  CHECK(inside[0].distance == Approx(0.01));
  CHECK(norm(inside[0].normal - Vec3{-1, 0, 0}) < 1e-12);
  CHECK(inside[1].distance == Approx(0.015));
  CHECK(norm(inside[1].normal - Vec3{0, 0, 1}) < 1e-12);
  const auto outside = contacts(s, {0, 0.103, -0.004}, 0.02);
  REQUIRE(outside.size() == 1);
  CHECK(outside[0].distance == Approx(0.005));
  CHECK(norm(outside[0].normal - Vec3{0, 0.6, -0.8}) < 1e-12);
  const auto rim = contacts(s, {-0.096, 0, 1.003}, 0.02);
  REQUIRE(rim.size() == 1);
  CHECK(rim[0].distance == Approx(0.005));
  CHECK(norm(rim[0].normal - Vec3{0.8, 0, 0.6}) < 1e-12);
  CHECK(norm(rim[0].point - Vec3{-0.1, 0, 1}) < 1e-12);
}

TEST_CASE("a cone tip touches as a point from above and as a ring from within") {
  // Half angle 45 degrees, tip up at z = 1.
  const Surface s = revolution({0, 1, 0.5, 0.5});
  for (const Vec3& p : {Vec3{0, 0, 1.01}, Vec3{0.003, 0, 1.01}, Vec3{-0.002, 0.005, 1.008}}) {
    const auto c = contacts(s, p, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(norm(c[0].point - Vec3{0, 0, 1}) < 1e-12);
    CHECK(norm(c[0].normal - normalized(p - Vec3{0, 0, 1})) < 1e-12);
  }
  const auto flank = contacts(s, {0.1, 0, 1}, 0.1);
  REQUIRE(flank.size() == 1);
  CHECK(flank[0].distance == Approx(0.1 / std::sqrt(2.0)));
  const auto within = contacts(s, {0, 0, 0.98}, 0.02);
  REQUIRE(within.size() == 1);
  CHECK(within[0].distance == Approx(0.02 / std::sqrt(2.0)));
  CHECK(within[0].normal.z == Approx(-1 / std::sqrt(2.0)));
}

TEST_CASE("points on the axis are safe on discs, and the middle of a disc is no corner") {
  const Surface s = revolution({0, 0.2, 0.1, 0.2});
  for (const double x : {0.0, 1e-18, 1e-12, 1e-6, 0.05}) {
    const auto c = contacts(s, {x, 0, 0.21}, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance == Approx(0.01));
    CHECK(norm(c[0].normal - Vec3{0, 0, 1}) < 1e-12);
  }
  const auto on = contacts(s, {0, 0, 0.2}, 0.02);
  REQUIRE(on.size() == 1);
  CHECK(std::abs(on[0].normal.z) == Approx(1));
}

TEST_CASE("the edge of a thin disc gives two face corners and turns the normal continuously round them") {
  const double half = 0.002, radius = 0.0245;
  const Surface s = revolution({0, -half, radius, -half, radius, half, 0, half});
  Vec3 last;
  const int steps = 3000;
  // Round the upper corner at 0.001 from the surface.
  for (int k = 0; k <= steps; ++k) {
    const double phi = 1.5707963267948966 * k / steps;
    const Vec3 p{radius + 0.001 * std::sin(phi), 0, half + 0.001 * std::cos(phi)};
    const auto c = contacts(s, p, 0.00125);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance == Approx(0.001).epsilon(1e-7));
    if (k > 0) CHECK(norm(c[0].normal - last) < 1.1 * 1.5708 / steps);
    last = c[0].normal;
  }
  // A sphere larger than the thickness beside the rim touches the rim's face only.
  const auto rim = contacts(s, {radius + 0.004, 0, 0.0005}, 0.005);
  REQUIRE(rim.size() == 1);
  CHECK(rim[0].distance == Approx(0.004));
}

TEST_CASE("profiles about one line are linked, also from separate calls and opposite axes") {
  Surface s;
  s.add_revolution({0, 0, 0}, {0, 0, 2}, {0.1, 0, 0.1, 0.5}, false);
  s.add_revolution({0, 0, 1}, {0, 0, -3}, {0.1, 0.2, 0.1, 0.5}, false);
  s.finish();
  CHECK(s.element_count() == 2);
  for (int k = -20; k <= 20; ++k) {
    const auto c = contacts(s, {0.095, 0, 0.5 + k * 1e-4}, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance == Approx(0.005));
  }
  // Its own normal stays outwards on both pieces.
  CHECK(contacts(s, {0.1, 0, 0.2}, 0.02)[0].normal.x == Approx(1));
  CHECK(contacts(s, {0.1, 0, 0.7}, 0.02)[0].normal.x == Approx(1));
  CHECK(contacts(s, {0.095, 0, 0.804}, 0.02)[0].normal.z == Approx(0.004 / std::sqrt(0.004 * 0.004 + 0.005 * 0.005)));
}

TEST_CASE("a closed profile has no ends and a sphere meets one contact at every outer corner") {
  const Surface s = revolution({0.1, 0, 0.2, 0, 0.2, 0.1, 0.1, 0.1}, true);
  CHECK(s.element_count() == 4);
  for (const Vec3& corner : {Vec3{0.1, 0, 0}, Vec3{0.2, 0, 0}, Vec3{0.2, 0, 0.1}, Vec3{0.1, 0, 0.1}}) {
    const Vec3 out = corner - Vec3{0.15, 0, 0.05};
    const auto c = contacts(s, corner + 0.1 * out, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(norm(c[0].point - corner) < 1e-12);
    CHECK(norm(c[0].normal - normalized(out)) < 1e-9);
    CHECK(contacts(s, corner - 0.1 * out, 0.02).size() == 2);
  }
}

TEST_CASE("the smooth tube and a fine mesh of it agree within the chord error, inside and outside") {
  PluginProbe probe("calx_cylinder");
  ProbeValues v = probe.presets("calx.cylinder");
  v.set("from", Vec3{0.1, -0.05, 0.02}).set("to", Vec3{0.25, 0.1, 0.2}).set("radius", 0.05).set("caps", "both");
  const Surface smooth = build(probe, "calx.cylinder", v);
  const int facets = 180;
  const Surface fine = build(probe, "calx.cylinder", v.set("facets", facets));
  const double chord = 0.05 * (1 - std::cos(3.14159265358979 / facets));
  CHECK(smooth.element_count() == 3);
  CHECK(fine.element_count() == 4 * facets);
  CHECK(fine.faults().describe() == "");
  Random random(17, 4);
  const Vec3 axis = normalized(Vec3{0.15, 0.15, 0.18});
  int touching = 0;
  for (int k = 0; k < 16000; ++k) {
    const Vec3 p{random.uniform(0, 0.35), random.uniform(-0.15, 0.2), random.uniform(-0.08, 0.3)};
    const auto a = contacts(smooth, p, 0.01), b = contacts(fine, p, 0.01);
    if (a.empty() || b.empty()) {
      if (!a.empty()) CHECK(a[0].distance > 0.01 - 1.01 * chord);
      if (!b.empty()) CHECK(b[0].distance > 0.01 - 1.01 * chord);
      continue;
    }
    ++touching;
    CHECK(std::abs(a[0].distance - b[0].distance) < 1.01 * chord);
    if (a.size() == 1 && b.size() == 1 && a[0].distance > 0.002) CHECK(dot(a[0].normal, b[0].normal) > 0.99);
  }
  CHECK(touching > 500);
  CHECK(dot(contacts(smooth, Vec3{0.1, -0.05, 0.02} - 0.005 * axis, 0.01)[0].normal, -axis) == Approx(1));
}

TEST_CASE("a sphere rolling inside a 24-facet tube keeps one contact and a continuous overlap") {
  PluginProbe probe("calx_cylinder");
  ProbeValues v = probe.presets("calx.cylinder");
  v.set("to", Vec3{0, 0, 0.1}).set("radius", 0.05).set("facets", 25);
  const Surface s = build(probe, "calx.cylinder", v);
  double last = 0;
  const int steps = 20000;
  for (int k = 0; k <= steps; ++k) {
    const double angle = 6.283185307179586 * k / steps;
    const Vec3 p{0.048 * std::cos(angle), 0.048 * std::sin(angle), 0.041};
    const auto c = contacts(s, p, 0.0025);
    REQUIRE(c.size() == 1);
    // The facet's distance from the axis is 0.05 cos(pi / 25); along the tube nothing pushes.
    CHECK(c[0].distance <= 0.002);
    CHECK(c[0].distance >= 0.05 * std::cos(3.141592653589793 / 25) - 0.048 - 1e-12);
    CHECK(std::abs(c[0].normal.z) < 1e-9);
    if (k > 0) CHECK(std::abs(c[0].distance - last) < 0.048 * 6.2832 / steps * std::sin(3.1416 / 25) * 1.01);
    last = c[0].distance;
  }
}

TEST_CASE("triangles and revolutions work together in one part") {
  Surface s;
  s.add_triangles({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  s.add_revolution({0, 0, 0}, {0, 0, 1}, {0.1, 0, 0.1, 1}, false);
  s.finish();
  CHECK(s.element_count() == 3);
  const auto c = contacts(s, {0.09, 0, 0.012}, 0.02);
  REQUIRE(c.size() == 2);
  CHECK(c[0].element == 2);
  CHECK(c[0].distance == Approx(0.01));
  CHECK(c[1].distance == Approx(0.012));
  CHECK(s.bounds().lo.x == Approx(-1));
  CHECK(s.bounds().hi.z == Approx(1));
}

TEST_CASE("the tessellation lies within the chord, is closed and points outwards") {
  const Surface s = revolution({0, 0, 0.1, 0, 0.1, 0.2, 0.05, 0.3, 0, 0.3}, false, {1, 2, 3}, {1, 1, 0});
  const Tessellation t = s.tessellate(1e-4);
  const Surface again = mesh(t.vertices, t.triangles);
  CHECK(again.faults().describe() == "");
  for (std::size_t k = 0; k < t.triangles.size(); k += 3) {
    const Vec3 middle =
        (t.vertices[t.triangles[k]] + t.vertices[t.triangles[k + 1]] + t.vertices[t.triangles[k + 2]]) / 3;
    CHECK(distance_to(s, middle, 0.05) < 1e-4);
  }
  double volume = 0;
  for (std::size_t k = 0; k < t.triangles.size(); k += 3)
    volume +=
        dot(t.vertices[t.triangles[k]], cross(t.vertices[t.triangles[k + 1]], t.vertices[t.triangles[k + 2]])) / 6;
  const double exact = 3.14159265358979 * (0.01 * 0.2 + 0.1 / 3 * (0.01 + 0.005 + 0.0025));
  CHECK(volume == Approx(exact).epsilon(0.002));
  CHECK(volume < exact);
}

TEST_CASE("a profile is refused with its fault named") {
  Surface s;
  CHECK_THROWS_WITH_AS(s.add_revolution({}, {0, 0, 1}, {0.1, 0, -0.1, 1}, false),
                       "profile point 1 of a surface of revolution must be finite with r >= 0", Error);
  CHECK_THROWS_WITH_AS(s.add_revolution({}, {0, 0, 0}, {0.1, 0, 0.1, 1}, false),
                       "a surface of revolution needs a finite origin and an axis that is not zero", Error);
  CHECK_THROWS_WITH_AS(revolution({0.1, 0, 0.1, 0, 0.1, 1}),
                       "a surface of revolution has two equal neighbouring points", Error);
  CHECK_THROWS_WITH_AS(revolution({0, 0, 0, 1, 0.1, 1}),
                       "a surface of revolution has a piece that lies on its own axis", Error);
}
