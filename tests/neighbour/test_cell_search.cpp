// The cell search against all pairs: sizes, margins, periodic directions, strays, thin and crowded places.
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>

#include "neighbour/cell_search.hpp"
#include "neighbour/clouds.hpp"

using namespace calx;

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Runs of 150 particles, so that many pairs cross.
std::vector<std::uint32_t> runs_of(const Particles& p) {
  std::vector<std::uint32_t> out;
  for (std::size_t k = 0; k < p.count(); k += 150)
    out.push_back(p.has_clumps ? p.first_sphere[k] : static_cast<std::uint32_t>(k));
  out.push_back(static_cast<std::uint32_t>(p.sphere_count()));
  return out;
}

Pairs pairs_of(const CellSearch& search, const std::vector<std::uint32_t>& runs) {
  Pairs out;
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    REQUIRE(search.run(r).count.size() == runs[r + 1] - runs[r]);
    std::size_t e = 0;
    for (std::uint32_t k = runs[r]; k < runs[r + 1]; ++k)
      for (std::uint32_t m = search.run(r).count[k - runs[r]]; m > 0; --m)
        out.emplace_back(k, search.run(r).partner[e++]);
    CHECK(e == search.run(r).partner.size());
  }
  return out;
}

Pairs found(const Cloud& c) {
  CellSearch search;
  const auto runs = runs_of(c.particles);
  search.find(c.particles, c.wrap, c.margin, runs);
  return pairs_of(search, runs);
}

/// Equality says order, completeness and that no pair stands twice.
void check(const Cloud& c, std::size_t at_least) {
  const Pairs want = brute_force(c);
  CHECK(want.size() >= at_least);
  CHECK(found(c) == want);
}

/// Spheres of the radii given in shares of equal number, anywhere in a box.
Cloud mixed(std::size_t count, const std::vector<double>& radii, const Vec3& size, std::uint64_t seed) {
  Cloud c;
  c.particles.shapes = {make_shape("ball", {{{}, 1e-3}})};
  c.particles.density = {2000};
  Random r(seed, 5);
  for (std::size_t k = 0; k < count; ++k) {
    const double radius = radii[k % radii.size()];
    c.particles.insert(0, 0, radius / 1e-3, {r.uniform(0, size.x), r.uniform(0, size.y), r.uniform(0, size.z)}, {}, {},
                       {});
    c.margin.push_back(0.1 * radius);
  }
  c.wrap = {{0, 0, 0}, size, {false, false, false}};
  return c;
}

std::vector<double> one_in(std::size_t n, double one, double others) {
  std::vector<double> radii(n, others);
  radii[0] = one;
  return radii;
}

}  // namespace

TEST_CASE("size ratios of 1, 5 and 50, mixed evenly and with few of the large or of the small") {
  for (const double ratio : {1.0, 5.0, 50.0})
    for (const auto& radii : {std::vector<double>{1e-3, 1e-3 * ratio}, one_in(60, 1e-3 * ratio, 1e-3),
                              one_in(60, 1e-3, 1e-3 * ratio), std::vector<double>{1e-3, 2e-3, 3e-3, 1e-3 * ratio}}) {
      CAPTURE(ratio);
      CAPTURE(radii.size());
      check(mixed(1200, radii, Vec3{0.06, 0.05, 0.04}, static_cast<std::uint64_t>(ratio)), 100);
    }
}

TEST_CASE("a few fast particles with wide margins") {
  Cloud c = mixed(1500, {1e-3}, {0.03, 0.03, 0.03}, 3);
  for (std::size_t k = 0; k < c.margin.size(); k += 50) c.margin[k] = 1e-3;
  check(c, 1000);
  for (std::size_t k = 0; k < c.margin.size(); k += 170) c.margin[k] = 0.02;
  check(c, 1000);
}

TEST_CASE("periodic boxes with few cells, down to one shorter than a pair distance") {
  for (int faces = 1; faces < 8; ++faces)
    for (const double length : {3.2e-3, 4.5e-3, 5e-3, 7e-3, 9e-3, 0.02})
      for (const bool sizes : {false, true}) {
        const std::array<bool, 3> periodic{(faces & 1) != 0, (faces & 2) != 0, (faces & 4) != 0};
        Cloud c = mixed(150, sizes ? std::vector<double>{1e-3, 1e-3, 1e-3, 0.2e-3} : std::vector<double>{1e-3},
                        {periodic[0] ? length : 0.02, periodic[1] ? length : 0.02, periodic[2] ? length : 0.02},
                        static_cast<std::uint64_t>(faces));
        c.wrap.periodic = periodic;
        if (sizes) c.margin[8] = 1e-3;
        CAPTURE(faces);
        CAPTURE(length);
        CAPTURE(sizes);
        check(c, 20);
      }
}

TEST_CASE("members of clumps that stand out of a periodic box") {
  CloudOptions o;
  o.count = 300;
  o.size = {0.012, 0.012, 0.012};
  o.smallest_scale = 0.3;
  o.wide_share = 0.3;
  o.periodic = {true, true, true};
  const Cloud c = make_cloud(o);
  bool outside = false;
  for (std::size_t k = 0; k < c.particles.sphere_count(); ++k) outside = outside || c.particles.spheres()[k].x < 0;
  CHECK(outside);
  check(c, 500);
}

TEST_CASE("none, one, and all at one place") {
  Cloud c = mixed(0, {1e-3}, {1, 1, 1}, 1);
  CHECK(found(c).empty());
  c = mixed(1, {1e-3}, {1, 1, 1}, 1);
  CHECK(found(c).empty());
  for (const bool wraps : {false, true}) {
    c = mixed(333, {1e-3, 2e-3, 8e-3}, {0.05, 0.05, 0.05}, 1);
    for (auto& b : c.particles.body) b.x = b.y = b.z = 0.01;
    c.wrap.periodic = {wraps, wraps, wraps};
    check(c, 333 * 332 / 2);
  }
}

TEST_CASE("particles far away cost neither pairs nor memory nor comparisons without end") {
  for (const double far : {1e6, -1e6, 3e7, -2e9, 1e14}) {
    Cloud c = mixed(3000, one_in(40, 4e-3, 1e-3), {0.06, 0.06, 0.06}, 9);
    c.particles.body[700].x = far;
    c.particles.body[701].y = far;
    // Two that touch out there, as far as doubles can tell.
    c.particles.body[702].z = far;
    c.particles.body[703] = c.particles.body[702];
    CellSearch search;
    const auto runs = runs_of(c.particles);
    search.find(c.particles, c.wrap, c.margin, runs);
    const Pairs have = pairs_of(search, runs);
    CAPTURE(far);
    CHECK(have == brute_force(c));
    CHECK(std::count(have.begin(), have.end(), std::pair<std::uint32_t, std::uint32_t>(702, 703)) == 1);
    CHECK(search.memory_bytes() < 3000 * 400);
  }
}

TEST_CASE("a thin stream in a large room is found in a table of few cells") {
  // About 2e9 cells of 2.2 mm, or a line of 2e5.
  for (const Vec3 size : {Vec3{3, 3, 2}, Vec3{400, 1e-3, 1e-3}, Vec3{1e-3, 30, 30}, Vec3{1e-3, 1e-3, 400}})
    for (const bool wraps : {false, true}) {
      Cloud c = mixed(1000, one_in(30, 5e-3, 1e-3), size, 4);
      // Neighbours for every third.
      for (std::size_t k = 0; k + 3 < 1000; k += 3) {
        c.particles.body[k + 1] = c.particles.body[k + 2] = c.particles.body[k];
        c.particles.body[k + 1].x += 1.9e-3;
        c.particles.body[k + 2].y -= 1.9e-3;
      }
      if (wraps) c.wrap.periodic = {size.x > 0.1, size.y > 0.1, size.z > 0.1};
      CellSearch search;
      const auto runs = runs_of(c.particles);
      search.find(c.particles, c.wrap, c.margin, runs);
      CHECK(pairs_of(search, runs) == brute_force(c));
      CHECK(search.memory_bytes() < 1000 * 400);
    }
}

TEST_CASE("the same with any number of threads, sorted or not, and when used again") {
  Cloud c = mixed(9000, one_in(100, 6e-3, 1e-3), {0.05, 0.05, 0.05}, 11);
  c.wrap.periodic = {true, false, true};
  const auto runs = runs_of(c.particles);
  CellSearch again;
  for (const bool sorted : {false, true}) {
    if (sorted) {
      const auto order = morton_order(c.particles, 2.2e-3);
      c.particles.permute(order);
      Column<double> margin;
      for (const auto k : order) margin.push_back(c.margin[k]);
      c.margin.swap(margin);
    }
    omp_set_num_threads(1);
    const Pairs want = found(c);
    CHECK(want.size() > 9000);
    for (const int threads : {1, 2, 3, 8}) {
      omp_set_num_threads(threads);
      again.find(c.particles, c.wrap, c.margin, runs);
      CHECK(pairs_of(again, runs) == want);
    }
  }
  omp_set_num_threads(omp_get_num_procs());
  check(c, 9000);
}
