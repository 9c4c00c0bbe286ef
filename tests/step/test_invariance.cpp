// The same motion whatever the frame and the order in which particles are given.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numeric>

#include "neighbour/pair_list.hpp"
#include "scenes/scenes.hpp"

using namespace calx;

namespace {

std::string text_of(const Vec3& v) {
  char out[120];
  std::snprintf(out, sizeof out, "[%.17g, %.17g, %.17g]", v.x, v.y, v.z);
  return out;
}

/// 40 clumps thrown on a large floor through the origin and into each other. Everything is turned by the rotation
/// given.
CaseFile thrown_on_floor(const Quat& rotation, const std::string& integrator) {
  CaseText c;
  c.gravity = text_of(rotate(rotation, {0, 0, -9.81}));
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.materials = kTwoMaterials;
  c.contacts = kEpamContacts;
  c.parts = R"([{"name": "floor", "geometry": "calx.plane", "material": "steel",
                 "parameters": {"point": [0, 0, 0], "normal": )" +
            text_of(rotate(rotation, {0, 0, 1})) + R"(, "half_u": 0.5, "half_v": 0.5}}])";
  auto particles = lattice(40, 4, 5, 3e-3, {-6e-3, -7e-3, 2e-4}, 1e-4, 0.5);
  for (auto& p : particles) {
    p.v.z -= 1;
    p.x = rotate(rotation, p.x);
    p.v = rotate(rotation, p.v);
    p.w = rotate(rotation, p.w);
    p.turn = rotation * p.turn;
  }
  return with_given(c, "odd", particles);
}

/// Particles flying into each other, seen from a frame that moves.
CaseFile collision(const Vec3& frame_velocity, const Vec3& frame_shift) {
  CaseText c;
  c.contacts = kEpamContacts;
  c.materials = kTwoMaterials;
  auto particles = lattice(60, 4, 4, 2.7e-3, {0, 0, 0}, 4e-5, 0.8);
  for (auto& p : particles) {
    p.x += frame_shift;
    p.v += frame_velocity;
  }
  return with_given(c, "grain", particles);
}

}  // namespace

TEST_CASE("a turned scene gives the turned motion") {
  for (const char* integrator : {"euler", "verlet"}) {
    Simulation plain(thrown_on_floor({}, integrator), test_options());
    advance(plain, 250);
    CHECK(plain.counters().touching > 3);
    CHECK(norm(plain.world().part_load(0).force) > 0);
    for (const Quat& q : {normalized(Quat{0.3, 0.5, -0.7, 0.2}), normalized(Quat{0.7, -0.1, 0.1, 0.8})}) {
      Simulation turned(thrown_on_floor(q, integrator), test_options());
      advance(turned, 250);
      CHECK(turned.counters().touching == plain.counters().touching);
      double x_off = 0, v_off = 0, w_off = 0, turn_off = 0;
      for (std::uint32_t id = 0; id < 40; ++id) {
        const Record& a = body_of(plain, id);
        const Record& b = body_of(turned, id);
        x_off = std::max(x_off, norm(rotate(q, position(a)) - position(b)));
        v_off = std::max(v_off, norm(rotate(q, velocity(a)) - velocity(b)));
        w_off = std::max(w_off, norm(rotate(q, spin(a)) - spin(b)));
        const Quat& ta = plain.world().particles().turn[ranks_by_id(plain)[id]];
        const Quat& tb = turned.world().particles().turn[ranks_by_id(turned)[id]];
        turn_off = std::max(turn_off, norm(rotate(q, rotate(ta, {1, 0, 0})) - rotate(tb, {1, 0, 0})));
      }
      // Sizes: 0.01 m, 1 m/s, 1000 rad/s.
      CHECK(x_off < 1e-12 * 0.01);
      CHECK(v_off < 1e-11);
      CHECK(w_off < 1e-11 * 1000);
      CHECK(turn_off < 1e-11);
      CHECK(norm(rotate(q, plain.world().part_load(0).force) - turned.world().part_load(0).force) <
            1e-9 * norm(plain.world().part_load(0).force));
    }
  }
}

TEST_CASE("a frame moving at constant velocity sees the same collisions") {
  Simulation rest(collision({}, {}), test_options()), moving(collision({3, -2, 1}, {0.1, 0.2, -0.3}), test_options());
  advance(rest, 300);
  advance(moving, 300);
  CHECK(rest.counters().touching > 3);
  CHECK(rest.counters().touching == moving.counters().touching);
  const double t = rest.time();
  for (std::uint32_t id = 0; id < 60; ++id) {
    const Record& a = body_of(rest, id);
    const Record& b = body_of(moving, id);
    // Rounding of positions of 0.3 m, 5e-17, acts on overlaps of 1e-5 m.
    CHECK(norm(position(b) - position(a) - Vec3{0.1, 0.2, -0.3} - t * Vec3{3, -2, 1}) < 1e-12);
    CHECK(norm(velocity(b) - velocity(a) - Vec3{3, -2, 1}) < 1e-9);
  }
}

TEST_CASE("the order in which particles are given does not matter beyond rounding") {
  CaseFile file = thrown_on_floor({}, "euler");
  const SourceSettings given = file.settings.sources[0];
  std::vector<std::size_t> order(given.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random r(4, 4);
  for (std::size_t k = order.size() - 1; k > 0; --k)
    std::swap(order[k], order[static_cast<std::size_t>(r.uniform() * static_cast<double>(k + 1))]);
  SourceSettings& other = file.settings.sources[0];
  for (std::size_t k = 0; k < order.size(); ++k) {
    other.positions[k] = given.positions[order[k]];
    other.velocities[k] = given.velocities[order[k]];
    other.spins[k] = given.spins[order[k]];
    other.orientations[k] = given.orientations[order[k]];
  }
  Simulation plain(thrown_on_floor({}, "euler"), test_options()), mixed(file, test_options());
  advance(plain, 250);
  advance(mixed, 250);
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    const Record& a = body_of(plain, static_cast<std::uint32_t>(order[k]));
    const Record& b = body_of(mixed, k);
    CHECK(norm(position(a) - position(b)) < 1e-14);
    CHECK(norm(velocity(a) - velocity(b)) < 1e-11);
  }
}

TEST_CASE("a periodic shift of everything changes nothing beyond rounding") {
  auto scene = [](const Vec3& shift) {
    CaseText c;
    c.domain = R"({"min": [0, 0, 0], "max": [0.012, 0.0115, 0.0125], "periodic": [true, true, true]})";
    c.contacts = kEpamContacts;
    c.materials = kTwoMaterials;
    auto particles = lattice(64, 4, 4, 2.8e-3, {0, 0, 0}, 1e-4, 0.8);
    for (auto& p : particles) {
      p.x += shift;
      const double length[3] = {0.012, 0.0115, 0.0125};
      for (int k = 0; k < 3; ++k) p.x[k] -= length[k] * std::floor(p.x[k] / length[k]);
    }
    return with_given(c, "grain", particles);
  };
  Simulation plain(scene({}), test_options()), shifted(scene({0.0047, 0.0101, -0.0033}), test_options());
  advance(plain, 400);
  advance(shifted, 400);
  CHECK(plain.counters().touching > 10);
  CHECK(shifted.counters().touching == plain.counters().touching);
  const Wrap wrap{{0, 0, 0}, {0.012, 0.0115, 0.0125}, {true, true, true}};
  for (std::uint32_t id = 0; id < 64; ++id) {
    const Record& a = body_of(plain, id);
    const Record& b = body_of(shifted, id);
    const Vec3 d = wrap.nearest(wrap.nearest(position(b) - position(a) - Vec3{0.0047, 0.0101, -0.0033}));
    CHECK(norm(d) < 1e-11);
    CHECK(norm(velocity(b) - velocity(a)) < 1e-8);
  }
}
