// Contacts with triangles against numbers known in closed form and against brute force.
#include <doctest/doctest.h>

#include <algorithm>

#include "base/random.hpp"
#include "geometry/shapes.hpp"

using namespace calx;
using doctest::Approx;

namespace {

const double deg = 0.017453292519943295;

/// Two half planes that meet along the y axis; the right one is turned up by the angle (concave seen from above).
Surface crease(double angle, int cells = 4) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  const Vec3 right{std::cos(angle), 0, std::sin(angle)};
  for (int j = 0; j <= cells; ++j) {
    const Vec3 y{0, -1 + 2.0 * j / cells, 0};
    v.push_back(y + Vec3{-1, 0, 0});
    v.push_back(y);
    v.push_back(y + right);
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells); ++j)
    for (std::uint32_t i = 0; i < 2; ++i) {
      const std::uint32_t p = 3 * j + i;
      t.insert(t.end(), {p, p + 1, p + 4, p, p + 4, p + 3});
    }
  return mesh(v, t);
}

/// Independent: nearest point of a triangle by projection on the plane, or by clamping on its sides.
double brute_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 n = cross(b - a, c - a);
  const double area2 = norm2(n);
  const double u = dot(cross(b - p, c - p), n) / area2, v = dot(cross(c - p, a - p), n) / area2, w = 1 - u - v;
  if (u >= 0 && v >= 0 && w >= 0) return std::abs(dot(p - a, n)) / std::sqrt(area2);
  const auto side = [&](const Vec3& s, const Vec3& e) {
    const double t = std::clamp(dot(p - s, e - s) / norm2(e - s), 0.0, 1.0);
    return norm(p - (s + t * (e - s)));
  };
  return std::min({side(a, b), side(b, c), side(c, a)});
}

}  // namespace

TEST_CASE("a flat wall gives one contact, the same for 2, 8 and 200 triangles, also exactly on seams and corners") {
  const Surface one = flat(1, 1, 1), two = flat(1, 1, 2), many = flat(1, 1, 10);
  CHECK(one.element_count() == 2);
  CHECK(many.element_count() == 200);
  std::vector<Vec3> points;
  for (int i = 1; i < 40; ++i)
    for (int j = 1; j < 40; ++j) points.push_back({i / 40.0, j / 40.0, 0.1});  // every tenth on a seam, many on corners
  Random random(7, 1);
  for (int k = 0; k < 3000; ++k) points.push_back({random.uniform(0, 1), random.uniform(0, 1), 0.1});
  for (int k = 0; k < 300; ++k) {
    // Seams and vertices left by a few units in the last place.
    const double e = 1e-16 * static_cast<int>(random.uniform(-4, 5));
    points.push_back({std::clamp(static_cast<int>(random.uniform(0, 11)) / 10.0 + e, 0.0, 1.0),
                      std::clamp(static_cast<int>(random.uniform(0, 11)) / 10.0 - e, 0.0, 1.0), 0.1});
  }
  for (const Vec3& p : points)
    for (const Surface* s : {&one, &two, &many}) {
      const auto c = contacts(*s, p, 0.125);
      REQUIRE(c.size() == 1);
      CHECK(std::abs(c[0].distance - 0.1) < 1e-15);
      CHECK(norm(c[0].normal - Vec3{0, 0, 1}) < 1e-9);
      CHECK(norm(c[0].point - Vec3{p.x, p.y, 0}) < 1e-9);
    }
}

TEST_CASE("a tilted and turned flat wall far from the origin still has no gap and no double at its seams") {
  const Vec3 u = normalized(Vec3{1, 2, -0.5}), n = normalized(cross(u, {0.3, -0.2, 0.9})), w = cross(n, u);
  const Vec3 base{3.1, -2.7, 5.3};
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  const std::uint32_t cells = 12;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) v.push_back(base + (i * 0.017) * u + (j * 0.013) * w);
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t p = j * (cells + 1) + i;
      t.insert(t.end(), {p, p + 1, p + cells + 2, p, p + cells + 2, p + cells + 1});
    }
  const Surface s = mesh(v, t);
  CHECK(s.faults().open_edges == 4 * cells);
  for (std::uint32_t j = 1; j < cells; ++j)
    for (std::uint32_t i = 1; i < cells; ++i)
      for (const double f : {0.0, 0.25, 0.5})
        for (const Vec3& along : {u * 0.017, w * 0.013, u * 0.017 + w * 0.013}) {
          const Vec3 foot = v[j * (cells + 1) + i] + f * along;
          for (const double side : {1.0, -1.0}) {
            const auto c = contacts(s, foot + side * 0.001 * n, 0.00125);
            REQUIRE(c.size() == 1);
            CHECK(std::abs(c[0].distance - 0.001) < 1e-14);
            CHECK(norm(c[0].normal - side * n) < 1e-6);
          }
        }
}

TEST_CASE("the deepest contact is the nearest point of the mesh for random centres") {
  Random random(11, 2);
  std::vector<Vec3> v;
  for (int k = 0; k < 60; ++k) v.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  std::vector<std::uint32_t> t;
  for (int k = 0; k < 80; ++k) {
    std::uint32_t c[3];
    for (auto& i : c) i = static_cast<std::uint32_t>(random.uniform(0, 60));
    if (c[0] != c[1] && c[1] != c[2] && c[0] != c[2]) t.insert(t.end(), c, c + 3);
  }
  const Surface s = mesh(v, t);
  for (int k = 0; k < 4000; ++k) {
    const Vec3 p{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
    double best = 1e300;
    for (std::size_t i = 0; i < t.size(); i += 3)
      best = std::min(best, brute_triangle(v[t[i]], v[t[i + 1]], v[t[i + 2]], p));
    const auto c = contacts(s, p, 0.4);
    if (best >= 0.4) {
      CHECK(c.empty());
      continue;
    }
    REQUIRE(!c.empty());
    CHECK(c[0].distance == Approx(best).epsilon(1e-9));
    CHECK(norm(p - c[0].point) == Approx(c[0].distance).epsilon(1e-9));
    for (std::size_t i = 1; i < c.size(); ++i) CHECK(c[i - 1].distance <= c[i].distance);
  }
}

TEST_CASE("gather returns exactly the elements within reach, ascending, after what was there") {
  const Surface s = cube(1);
  Random random(3, 3);
  for (int k = 0; k < 500; ++k) {
    const Vec3 p{random.uniform(-1, 2), random.uniform(-1, 2), random.uniform(-1, 2)};
    std::vector<std::uint32_t> near{99};
    s.gather(p, 0.5, near);
    CHECK(near[0] == 99);
    CHECK(std::is_sorted(near.begin() + 1, near.end()));
    // The cube's own tables: faces of the cube in pairs of triangles; a face is near where the clamped point is.
    for (int f = 0; f < 6; ++f) {
      Vec3 q;
      for (int a = 0; a < 3; ++a) q[a] = std::clamp(p[a], 0.0, 1.0);
      q[f / 2] = f % 2;
      const bool is_near = norm(p - q) <= 0.5;
      const bool found =
          std::count(near.begin() + 1, near.end(), 2u * f) + std::count(near.begin() + 1, near.end(), 2u * f + 1) > 0;
      CHECK(found == is_near);
    }
  }
}

TEST_CASE("inside a box a corner gives three contacts, an edge two, a face one, deepest first") {
  const Surface s = cube(1);
  const auto three = contacts(s, {0.03, 0.02, 0.04}, 0.05);
  REQUIRE(three.size() == 3);
  CHECK(three[0].distance == Approx(0.02));
  CHECK(norm(three[0].normal - Vec3{0, 1, 0}) < 1e-12);
  CHECK(three[1].distance == Approx(0.03));
  CHECK(norm(three[1].normal - Vec3{1, 0, 0}) < 1e-12);
  CHECK(three[2].distance == Approx(0.04));
  CHECK(norm(three[2].normal - Vec3{0, 0, 1}) < 1e-12);
  CHECK(contacts(s, {0.03, 0.02, 0.5}, 0.05).size() == 2);
  CHECK(contacts(s, {0.5, 0.02, 0.5}, 0.05).size() == 1);
  CHECK(contacts(s, {0.5, 0.06, 0.5}, 0.05).empty());
  SurfacePoint out[2];
  std::vector<std::uint32_t> near;
  s.gather({0.03, 0.02, 0.04}, 0.05, near);
  CHECK(s.closest({0.03, 0.02, 0.04}, 0.05, near.data(), near.size(), out, 2) == 2);
  CHECK(out[1].distance == Approx(0.03));
}

TEST_CASE("inside a box the contacts are exactly the faces within reach, outside there is one at most") {
  const Surface s = cube(1);
  Random random(23, 5);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 p{random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3)};
    const double r = random.uniform(0.05, 0.45);
    std::vector<double> expected;
    const bool is_inside = p.x > 0 && p.y > 0 && p.z > 0 && p.x < 1 && p.y < 1 && p.z < 1;
    Vec3 q;
    for (int a = 0; a < 3; ++a) {
      q[a] = std::clamp(p[a], 0.0, 1.0);
      if (is_inside && p[a] < r) expected.push_back(p[a]);
      if (is_inside && 1 - p[a] < r) expected.push_back(1 - p[a]);
    }
    const double away = norm(p - q);
    if (!is_inside && away < r) expected.push_back(away);
    std::sort(expected.begin(), expected.end());
    const auto c = contacts(s, p, r);
    REQUIRE(c.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(c[i].distance == Approx(expected[i]).epsilon(1e-12));
  }
}

TEST_CASE("outside a box a corner and an edge give one contact whose normal points at the centre") {
  const Surface s = cube(1);
  const Vec3 d{-0.01, -0.02, -0.015};
  auto c = contacts(s, d, 0.05);
  REQUIRE(c.size() == 1);
  CHECK(norm(c[0].point) < 1e-15);
  CHECK(c[0].distance == Approx(norm(d)));
  CHECK(norm(c[0].normal - normalized(d)) < 1e-12);
  c = contacts(s, {-0.01, -0.02, 0.5}, 0.05);
  REQUIRE(c.size() == 1);
  CHECK(norm(c[0].normal - normalized(Vec3{-0.01, -0.02, 0})) < 1e-12);
  // Just inside the region of a face next to the edge: one contact, the face.
  c = contacts(s, {1e-4, -0.02, 0.5}, 0.05);
  REQUIRE(c.size() == 1);
  CHECK(c[0].distance == Approx(0.02));
}

TEST_CASE("over a convex edge the normal turns continuously and the overlap has no jump") {
  for (const double angle : {5 * deg, 30 * deg, 90 * deg}) {
    const Surface s = crease(-angle);
    Vec3 last;
    double last_distance = 0;
    const int steps = 2000;
    for (int k = 0; k <= steps; ++k) {
      const double phi = (-0.5 + 2.0 * k / steps) * angle;  // rolls over the edge at 0.01 from the surface
      const Vec3 p = phi < 0       ? Vec3{phi * 0.05, 0.1, 0.01}
                     : phi < angle ? Vec3{0.01 * std::sin(phi), 0.1, 0.01 * std::cos(phi)}
                                   : Vec3{0.01 * std::sin(angle), 0.1, 0.01 * std::cos(angle)} +
                                         (phi - angle) * 0.05 * Vec3{std::cos(angle), 0, -std::sin(angle)};
      const auto c = contacts(s, p, 0.0125);
      REQUIRE(c.size() == 1);
      CHECK(c[0].distance == Approx(0.01).epsilon(1e-9));
      if (k > 0) {
        CHECK(norm(c[0].normal - last) < 2.1 * angle / steps);
        CHECK(std::abs(c[0].distance - last_distance) < 1e-11);
      }
      last = c[0].normal;
      last_distance = c[0].distance;
    }
  }
}

TEST_CASE("a concave crease below 15 degrees is one contact with the nearer face, a sharper one two") {
  const auto count_at = [](double angle) {
    const Surface s = crease(angle);
    // On the bisector, so that both faces are equally near.
    const Vec3 n{-std::sin(angle / 2), 0, std::cos(angle / 2)};
    return contacts(s, Vec3{0, 0.1, 0} + 0.01 / std::cos(angle / 2) * n, 0.0125).size();
  };
  CHECK(count_at(2 * deg) == 1);
  CHECK(count_at(14.9 * deg) == 1);
  CHECK(count_at(15.1 * deg) == 2);
  CHECK(count_at(60 * deg) == 2);
  const double angle = 10 * deg;
  const Surface s = crease(angle);
  double last = 0;
  for (int k = 0; k <= 400; ++k) {
    const Vec3 p{-0.005 + 0.01 * k / 400, 0.1, 0.01};
    const auto c = contacts(s, p, 0.0125);
    REQUIRE(c.size() == 1);
    const double expected = std::min(0.01, -p.x * std::sin(angle) + 0.01 * std::cos(angle));
    CHECK(c[0].distance == Approx(expected).epsilon(1e-9));
    if (k > 0) CHECK(std::abs(c[0].distance - last) < 0.01 / 400 * std::sin(angle) * 1.01);
    last = c[0].distance;
  }
}

TEST_CASE("both sides of a sheet touch and its free edges are round") {
  const Surface s = flat(1, 1, 3);
  CHECK(contacts(s, {0.4, 0.3, -0.01}, 0.02)[0].normal.z == Approx(-1));
  const auto edge = contacts(s, {-0.003, 0.5, 0.004}, 0.02);
  REQUIRE(edge.size() == 1);
  CHECK(edge[0].distance == Approx(0.005));
  CHECK(norm(edge[0].normal - Vec3{-0.6, 0, 0.8}) < 1e-12);
  const auto corner = contacts(s, {-0.002, -0.001, 0.002}, 0.02);
  REQUIRE(corner.size() == 1);
  CHECK(corner[0].distance == Approx(0.003));
}

TEST_CASE("a centre exactly on the surface gives the face's own normal, on an edge a unit normal") {
  const Surface s = flat(1, 1, 3);
  for (const Vec3& p :
       {Vec3{0.4, 0.3, 0}, Vec3{0.5, 1.0 / 3, 0}, Vec3{1.0 / 3, 1.0 / 3, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0}}) {
    const auto c = contacts(s, p, 0.02);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance < 1e-15);
    CHECK(norm(c[0].normal - Vec3{0, 0, 1}) < 1e-12);
  }
}

TEST_CASE("an edge counts by all triangles sharing it, also when only one of them is a candidate") {
  const Surface s = crease(90 * deg, 1);
  // Over the floor near the wall: the seam is nearer to the second triangle of the floor than its face, yet no minimum.
  const Vec3 p{-0.01, 0.9, 0.012};
  SurfacePoint out[4];
  for (std::uint32_t element = 0; element < s.element_count(); ++element) {
    const std::size_t n = s.closest(p, 0.02, &element, 1, out, 4);
    for (std::size_t k = 0; k < n; ++k) CHECK((std::abs(out[k].normal.x) < 1e-12 || std::abs(out[k].normal.z) < 1e-12));
  }
  CHECK(contacts(s, p, 0.02).size() == 2);
}
