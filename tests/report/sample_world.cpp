#include "sample_world.hpp"

#include <algorithm>

namespace calx_test {
namespace {

using calx::Vec3;
const double pi = 3.14159265358979323846;
const double fall = 0.3;             // s from rotor to pile
const double radius = 0.0036;        // m
const Vec3 rotor_axis{0, 0, 0.515};  // m, along y

class Random {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }
  double between(double a, double b) { return a + (b - a) * next(); }

 private:
  std::uint64_t state_ = 7;
};

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> triangles;
  std::uint32_t add(const Vec3& v) {
    vertices.push_back(v);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    for (std::uint32_t k : {a, b, c, a, c, d}) triangles.push_back(k);
  }
};

// A profile of (radius, z) turned about the z axis.
Mesh lathe(const std::vector<std::pair<double, double>>& profile) {
  const std::uint32_t sides = 64;
  Mesh out;
  for (const auto& [r, z] : profile) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double a = 2 * pi * s / sides;
      out.add({r * std::cos(a), r * std::sin(a), z});
    }
  }
  for (std::uint32_t k = 0; k + 1 < profile.size(); ++k) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t n = (s + 1) % sides;
      out.quad(k * sides + s, k * sides + n, (k + 1) * sides + n, (k + 1) * sides + s);
    }
  }
  return out;
}

// Hub and six vanes, axis along y through the origin.
Mesh rotor() {
  Mesh out;
  const double half = 0.020, hub = 0.010, tip = 0.025, thick = 0.001;
  for (int v = 0; v < 6; ++v) {
    const double a = pi / 6 + v * pi / 3, ca = std::cos(a), sa = std::sin(a);
    std::uint32_t corner[8];
    for (int k = 0; k < 8; ++k) {
      const double along = k & 1 ? tip : hub * 0.95, across = k & 2 ? thick : -thick, y = k & 4 ? half : -half;
      corner[k] = out.add({along * ca - across * sa, y, along * sa + across * ca});
    }
    out.quad(corner[0], corner[1], corner[5], corner[4]);
    out.quad(corner[2], corner[6], corner[7], corner[3]);
    out.quad(corner[1], corner[3], corner[7], corner[5]);
    out.quad(corner[0], corner[2], corner[3], corner[1]);
    out.quad(corner[4], corner[5], corner[7], corner[6]);
  }
  const std::uint32_t sides = 36, first = static_cast<std::uint32_t>(out.vertices.size());
  for (std::uint32_t s = 0; s < sides; ++s) {
    const double a = 2 * pi * s / sides;
    out.add({hub * std::cos(a), -half, hub * std::sin(a)});
    out.add({hub * std::cos(a), half, hub * std::sin(a)});
  }
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t n = (s + 1) % sides;
    out.quad(first + 2 * s, first + 2 * n, first + 2 * n + 1, first + 2 * s + 1);
  }
  return out;
}

// The two closed arcs of the housing, 60 degrees each, about the rotor's axis.
Mesh housing() {
  Mesh out;
  for (int side = 0; side < 2; ++side) {
    const std::uint32_t first = static_cast<std::uint32_t>(out.vertices.size());
    for (int k = 0; k <= 12; ++k) {
      const double a = side * pi - pi / 6 + k * pi / 36;
      for (double y : {-0.0205, 0.0205}) out.add({0.0255 * std::cos(a), y, rotor_axis.z + 0.0255 * std::sin(a)});
    }
    for (std::uint32_t k = 0; k < 12; ++k)
      out.quad(first + 2 * k, first + 2 * k + 1, first + 2 * k + 3, first + 2 * k + 2);
  }
  return out;
}

}  // namespace

void SampleWorld::add_part(const std::string& name, const std::vector<Vec3>& vertices,
                           const std::vector<std::uint32_t>& triangles) {
  calx::PartSettings part;
  part.name = name;
  part.geometry = "calx.mesh";
  part.material = "steel";
  settings_.parts.push_back(part);
  surfaces_.emplace_back();
  surfaces_.back().add_triangles(vertices, triangles);
  surfaces_.back().finish();
}

SampleWorld::SampleWorld(std::size_t grains) {
  settings_.title = "Canister fill, standard operation";
  settings_.domain.box.add({-0.12, -0.12, -0.01});
  settings_.domain.box.add({0.12, 0.12, 1});
  settings_.materials.resize(2);
  settings_.materials[0].name = "calcine";
  settings_.materials[1].name = "steel";
  Mesh m = lathe({{0.0005, 0}, {0.1, 0}, {0.1, 0.26}, {0.018, 0.26}, {0.018, 0.3}});
  add_part("canister", m.vertices, m.triangles);
  m = lathe({{0.018, 0.306}, {0.018, 0.38}, {0.0225, 0.4895}});
  add_part("nozzle", m.vertices, m.triangles);
  m = housing();
  add_part("housing", m.vertices, m.triangles);
  m = rotor();
  add_part("rotor", m.vertices, m.triangles);
  m = lathe({{0.0225, 0.5405}, {0.025, 0.6}, {0.1, 0.76}, {0.1, 0.86}});
  add_part("hopper", m.vertices, m.triangles);

  Random random;
  std::vector<Vec3> pile, hopper;
  while (pile.size() < 3 * grains) {
    const Vec3 p{random.between(-0.096, 0.096), random.between(-0.096, 0.096), random.between(0.004, 0.15)};
    if (p.x * p.x + p.y * p.y < 0.096 * 0.096) pile.push_back(p);
  }
  const auto level = [](const Vec3& p) { return p.z + 0.84 * std::sqrt((p.x + 0.03) * (p.x + 0.03) + p.y * p.y); };
  std::sort(pile.begin(), pile.end(), [&](const Vec3& a, const Vec3& b) { return level(a) < level(b); });
  while (hopper.size() < grains + grains / 4) {
    const Vec3 p{random.between(-0.096, 0.096), random.between(-0.096, 0.096), random.between(0.545, 0.85)};
    const double wall = p.z < 0.6 ? 0.02 : p.z < 0.76 ? 0.025 + (p.z - 0.6) * 0.075 / 0.16 - 0.005 : 0.095;
    if (p.x * p.x + p.y * p.y < wall * wall) hopper.push_back(p);
  }
  std::sort(hopper.begin(), hopper.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  for (std::size_t k = 0; k < hopper.size(); ++k) {
    Grain g;
    g.hopper = hopper[k];
    g.pile = pile[std::min(k, pile.size() - 1)];
    const double z = random.between(-1, 1), a = random.between(0, 2 * pi), s = std::sqrt(1 - z * z);
    g.tilt = 0.25 * radius * Vec3{s * std::cos(a), s * std::sin(a), z};
    // Equal shares per stroke, a little scattered, in the first half of each stroke.
    const double strokes =
        2.0 * sample_cycles * static_cast<double>(k) / static_cast<double>(grains) + random.between(-0.08, 0.08);
    const double stroke = std::max(0.0, std::floor(strokes));
    g.leaves = k < grains ? sample_start + (stroke + 0.7 * (strokes - stroke)) * sample_period / 2 : 1e9;
    grains_.push_back(g);
  }
  particles_.has_clumps = true;
  at(0);
}

double SampleWorld::canister_mass(double time) const {
  double landed = 0, all = 0;
  for (const Grain& g : grains_) {
    if (g.leaves < 1e8) all += 1, landed += g.leaves + fall <= time ? 1 : 0;
  }
  return sample_mass * landed / all;
}

double SampleWorld::rotor_angle(double time) const {
  const double t = std::fmod(
      std::max(0.0, std::min(time, sample_start + sample_cycles * sample_period - 1e-9) - sample_start), sample_period);
  if (t < 0.2) return pi * t / 0.2;
  if (t < 0.28) return pi;
  return t < 0.48 ? pi * (1 - (t - 0.28) / 0.2) : 0;
}

calx::Pose SampleWorld::part_pose(std::size_t part) const {
  calx::Pose pose;
  if (settings_.parts[part].name != "rotor") return pose;
  const double half = rotor_angle(time_) / 2;
  pose.turn = {std::cos(half), 0, std::sin(half), 0};
  pose.shift = rotor_axis;
  return pose;
}

void SampleWorld::at(double time) {
  time_ = time;
  particles_.body.clear();
  particles_.member.clear();
  particles_.owner.clear();
  particles_.id.clear();
  particles_.material.clear();
  particles_.sphere_id.clear();
  const double sunk = 0.09 * std::min(1.0, std::max(0.0, (time - sample_start) / (sample_end - sample_start)));
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    const Grain& g = grains_[k];
    Vec3 p = g.hopper, v;
    if (time >= g.leaves + fall) {
      p = g.pile;
    } else if (time >= g.leaves) {
      const double s = (time - g.leaves) / fall;
      const Vec3 from{0.6 * g.pile.x * 0.15, 0.6 * g.pile.y * 0.15, 0.48};
      p = from + s * s * (g.pile - from);
      v = 2 * s / fall * (g.pile - from);
    } else {
      p.z = std::max(0.545, p.z - sunk * (p.z > 0.6 ? 1 : 0.3));
      v = {0, 0, time > sample_start ? -0.004 : 0};
    }
    calx::Record body{p.x, p.y, p.z, 1.25 * radius, v.x, v.y, v.z, sample_mass / 6000, 0, 0, 0, 1};
    const std::uint32_t rank = static_cast<std::uint32_t>(k);
    particles_.body.push_back(body);
    particles_.id.push_back(rank);
    particles_.material.push_back(0);
    for (int s = 0; s < 2; ++s) {
      const Vec3 c = s == 0 ? p - g.tilt : p + g.tilt;
      body.x = c.x, body.y = c.y, body.z = c.z, body.r = radius;
      particles_.member.push_back(body);
      particles_.owner.push_back(rank);
      particles_.sphere_id.push_back(2 * rank + static_cast<std::uint32_t>(s));
    }
  }
}

}  // namespace calx_test
