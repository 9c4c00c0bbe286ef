// Columns of particles: what insertion, removal, reordering and saving keep.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "base/error.hpp"
#include "base/random.hpp"
#include "store/particles.hpp"
#include "support/memory_state.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

Quat random_turn(Random& r) { return normalized(Quat{r.normal(), r.normal(), r.normal(), r.normal()}); }
Vec3 random_vec(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

/// Spheres, pairs and triples, two materials.
Particles mixture(std::size_t count, bool keeps_wrench = false) {
  Particles p;
  p.keeps_wrench = keeps_wrench;
  p.shapes = {make_shape("ball", {{{}, 1e-3}}), make_shape("pair", {{{}, 1e-3}, {{1e-3, 0, 0}, 0.8e-3}}),
              make_shape("triple", {{{}, 1e-3}, {{1e-3, 0, 0}, 1e-3}, {{0, 1.2e-3, 0}, 0.7e-3}})};
  p.density = {2000, 7800};
  p.has_clumps = true;
  Random r(5, 1);
  for (std::size_t k = 0; k < count; ++k)
    p.insert(static_cast<std::uint32_t>(k % 3), static_cast<std::uint32_t>(k % 2), r.uniform(0.5, 1.5),
             random_vec(r, 1), random_turn(r), random_vec(r, 2), random_vec(r, 50));
  return p;
}

/// Where member k of particle p must be, and how fast, from first principles.
void check_members(const Particles& p) {
  REQUIRE(p.first_sphere.size() == p.count() + 1);
  CHECK(p.first_sphere[p.count()] == p.sphere_count());
  for (std::size_t k = 0; k < p.count(); ++k) {
    const Shape& s = p.shapes[p.shape[k]];
    REQUIRE(p.first_sphere[k + 1] - p.first_sphere[k] == s.members.size());
    for (std::size_t m = 0; m < s.members.size(); ++m) {
      const std::size_t at = p.first_sphere[k] + m;
      const Vec3 arm = rotate(p.turn[k], p.scale[k] * s.members[m].at);
      CHECK(norm(position(p.member[at]) - position(p.body[k]) - arm) < 1e-15);
      CHECK(norm(velocity(p.member[at]) - velocity(p.body[k]) - cross(spin(p.body[k]), arm)) < 1e-13);
      CHECK(norm(spin(p.member[at]) - spin(p.body[k])) == 0);
      CHECK(p.member[at].r == p.scale[k] * s.members[m].radius);
      CHECK(p.member[at].m == p.body[k].m);
      CHECK(p.owner_of(at) == k);
    }
  }
}

}  // namespace

TEST_CASE("an inserted particle has mass, moments and bound of its shape, scale and material") {
  Particles p = mixture(6);
  check_members(p);
  for (std::size_t k = 0; k < p.count(); ++k) {
    const Shape& s = p.shapes[p.shape[k]];
    const double f = p.scale[k], rho = p.density[p.material[k]];
    CHECK(p.mass(k) == near(rho * s.volume * f * f * f, 1e-14));
    CHECK(p.inertia(k).y == near(rho * s.inertia.y * std::pow(f, 5), 1e-14));
    CHECK(p.body[k].r == near(s.bound * f, 1e-14));
    CHECK(p.equal_radius(k) == near(std::cbrt(3 * s.volume * f * f * f / (4 * 3.14159265358979)), 1e-12));
    CHECK(p.id[k] == k);
  }
  CHECK(p.body[0].aux == near(1 / (0.4 * p.mass(0) * p.body[0].r * p.body[0].r), 1e-12));
}

TEST_CASE("kinetic energy of a spinning clump is m v^2 / 2 + w I w / 2") {
  Particles p = mixture(3);
  const Vec3 w = rotate(conjugate(p.turn[2]), spin(p.body[2])), i = p.inertia(2);
  CHECK(p.kinetic_energy(2) ==
        near(0.5 * p.mass(2) * norm2(velocity(p.body[2])) + 0.5 * (i.x * w.x * w.x + i.y * w.y * w.y + i.z * w.z * w.z),
             1e-14));
  // Spin along a principal axis.
  p.body[2].vx = p.body[2].vy = p.body[2].vz = 0;
  const Vec3 axis = rotate(p.turn[2], {0, 1, 0});
  p.body[2].wx = 7 * axis.x, p.body[2].wy = 7 * axis.y, p.body[2].wz = 7 * axis.z;
  CHECK(p.kinetic_energy(2) == near(24.5 * i.y, 1e-13));
}

TEST_CASE("a permutation carries every column of a particle and of its spheres") {
  Particles p = mixture(40);
  const Particles before = p;
  std::vector<std::uint32_t> order(40);
  std::iota(order.begin(), order.end(), 0u);
  Random r(2, 2);
  for (std::size_t k = 39; k > 0; --k)
    std::swap(order[k], order[static_cast<std::size_t>(r.uniform() * double(k + 1))]);
  p.permute(order);
  check_members(p);
  for (std::size_t k = 0; k < 40; ++k) {
    const std::uint32_t o = order[k];
    CHECK(p.id[k] == before.id[o]);
    CHECK(p.shape[k] == before.shape[o]);
    CHECK(p.material[k] == before.material[o]);
    CHECK(p.scale[k] == before.scale[o]);
    CHECK(p.body[k].x == before.body[o].x);
    CHECK(p.body[k].wz == before.body[o].wz);
    CHECK(p.turn[k].y == before.turn[o].y);
    for (std::uint32_t m = 0; m < p.first_sphere[k + 1] - p.first_sphere[k]; ++m) {
      CHECK(p.sphere_id[p.first_sphere[k] + m] == before.sphere_id[before.first_sphere[o] + m]);
      // Bits: a member is moved, not computed anew.
      CHECK(p.member[p.first_sphere[k] + m].y == before.member[before.first_sphere[o] + m].y);
    }
  }
}

TEST_CASE("removal keeps the order of the others, and ids are never given twice") {
  Particles p = mixture(9);
  p.remove({1, 0, 0, 1, 0, 0, 0, 0, 1});
  CHECK(std::vector<std::uint32_t>(p.id.begin(), p.id.end()) == std::vector<std::uint32_t>{1, 2, 4, 5, 6, 7});
  check_members(p);
  const auto spheres = p.next_sphere_id;
  const std::size_t rank = p.insert(1, 0, 1, {}, {}, {}, {});
  CHECK(p.id[rank] == 9);
  CHECK(p.sphere_id[p.first_sphere[rank]] == spheres);
  check_members(p);
  p.remove(std::vector<std::uint8_t>(p.count(), 1));
  CHECK(p.count() == 0);
  CHECK(p.sphere_count() == 0);
  CHECK(p.id[p.insert(2, 1, 1, {}, {}, {}, {})] == 10);
  check_members(p);
}

TEST_CASE("particles of one sphere are their own spheres") {
  Particles p;
  p.shapes = {make_shape("ball", {{{}, 1e-3}})};
  p.density = {2000};
  for (int k = 0; k < 5; ++k) p.insert(0, 0, 1, {double(k), 0, 0}, {}, {}, {});
  CHECK(p.member.empty());
  CHECK(p.sphere_count() == 5);
  CHECK(p.spheres() == p.body.data());
  p.remove({0, 1, 0, 0, 1});
  CHECK(p.sphere_id[1] == 2);
  CHECK(p.first_sphere[3] == 3);
  p.permute({2, 0, 1});
  CHECK(p.id[0] == 3);
  CHECK(p.sphere_id[0] == 3);
  CHECK(p.owner_of(2) == 2);
}

TEST_CASE("saved particles come back to the bit, with their counters") {
  Particles p = mixture(17, true);
  p.remove({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  for (std::size_t k = 0; k < p.count(); ++k) p.wrench[k] = {1.0 / double(k + 1), 2, 3, 4, 5, 6.5};
  MemoryState state;
  p.save(state);
  Particles q = mixture(0, true);
  q.load(state);
  REQUIRE(q.count() == 16);
  CHECK(q.next_id == 17);
  CHECK(q.next_sphere_id == p.next_sphere_id);
  for (std::size_t k = 0; k < 16; ++k) {
    CHECK(q.id[k] == p.id[k]);
    CHECK(q.shape[k] == p.shape[k]);
    CHECK(q.material[k] == p.material[k]);
    CHECK(q.scale[k] == p.scale[k]);
    CHECK(std::memcmp(&q.body[k], &p.body[k], sizeof(Record)) == 0);
    CHECK(std::memcmp(&q.turn[k], &p.turn[k], sizeof(Quat)) == 0);
    CHECK(std::memcmp(&q.wrench[k], &p.wrench[k], sizeof(Wrench)) == 0);
  }
  for (std::size_t s = 0; s < p.sphere_count(); ++s) {
    CHECK(q.sphere_id[s] == p.sphere_id[s]);
    CHECK(q.member[s].x == p.member[s].x);
    CHECK(q.member[s].vz == p.member[s].vz);
    CHECK(q.member[s].r == p.member[s].r);
  }
  check_members(q);
}

TEST_CASE("forces of the last step are kept where they are needed, and a checkpoint without them is refused there") {
  const Particles p = mixture(5);
  CHECK(p.wrench.empty());
  MemoryState state;
  p.save(state);
  Particles euler = mixture(0), verlet = mixture(0, true);
  euler.load(state);
  CHECK(euler.count() == 5);
  CHECK(euler.wrench.empty());
  CHECK_THROWS_WITH_AS(verlet.load(state), doctest::Contains("written by another integrator"), Error);
}
