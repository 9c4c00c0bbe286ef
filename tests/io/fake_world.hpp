// fake_world.hpp: a world of a few spheres and one box, set by hand.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "measure/world.hpp"

namespace calx_test {

/// A cube of edge 0.2 m about the origin, as 12 triangles.
inline calx::Surface box_surface() {
  std::vector<calx::Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? 0.1 : -0.1, k & 2 ? 0.1 : -0.1, k & 4 ? 0.1 : -0.1});
  calx::Surface surface;
  surface.add_triangles(corners, {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
  surface.finish();
  return surface;
}

class FakeWorld : public calx::WorldView {
 public:
  FakeWorld() {
    settings_.title = "two materials";
    settings_.domain.box.add({-1, -1, -1});
    settings_.domain.box.add({1, 1, 2});
    settings_.domain.periodic[0] = true;
    settings_.materials.resize(2);
    settings_.materials[0].name = "calcine";
    settings_.materials[1].name = "steel";
    for (const char* name : {"hopper <1>", "rotor/left"}) {
      calx::PartSettings part;
      part.name = name;
      part.geometry = "calx.box";
      part.material = "steel";
      settings_.parts.push_back(part);
      surfaces_.push_back(box_surface());
    }
    poses.resize(2);
    present = {true, true};
  }

  /// n spheres on a line; sphere k: radius 0.01 (k + 1), material k % 2, id 100 + k; clumps: each two consecutive
  /// spheres belong to one particle.
  void fill(std::size_t n, bool clumps = false) {
    particles_ = calx::Particles{};
    particles_.has_clumps = clumps;
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k);
      const calx::Record s{0.1 * x + time_, 0.2 * x, 0.3 * x, 0.01 * (x + 1), x, 2 * x, -2 * x, 1, 0, 0, 0, 1};
      particles_.sphere_id.push_back(static_cast<std::uint32_t>(500 + k));
      if (clumps) {
        particles_.member.push_back(s);
        particles_.owner.push_back(static_cast<std::uint32_t>(k / 2));
        if (k % 2 != 0) continue;
      }
      particles_.body.push_back(s);
      particles_.id.push_back(static_cast<std::uint32_t>(100 + k));
      particles_.material.push_back(static_cast<std::uint32_t>(k % 2));
    }
  }
  void at(double time, std::uint64_t step) {
    time_ = time;
    step_ = step;
  }

  std::vector<calx::Pose> poses;
  std::vector<bool> present;

  const calx::CaseSettings& settings() const override { return settings_; }
  double time() const override { return time_; }
  std::uint64_t step() const override { return step_; }
  double time_step() const override { return 1e-5; }
  const calx::Particles& particles() const override { return particles_; }
  std::size_t part_count() const override { return surfaces_.size(); }
  const std::string& part_name(std::size_t part) const override { return settings_.parts[part].name; }
  bool part_present(std::size_t part) const override { return present[part]; }
  const calx::Surface& part_surface(std::size_t part) const override { return surfaces_[part]; }
  calx::Pose part_pose(std::size_t part) const override { return poses[part]; }
  calx::PartLoad part_load(std::size_t) const override { return {}; }
  std::vector<calx::ContactRow> contacts() const override { return {}; }
  std::vector<std::uint32_t> contact_counts() const override {
    std::vector<std::uint32_t> out;
    for (std::size_t k = 0; k < particles_.sphere_count(); ++k) out.push_back(static_cast<std::uint32_t>(k % 7));
    return out;
  }
  calx::EnergyLedger energy() const override { return {}; }
  calx::MassLedger mass() const override { return {}; }
  double cycles_of(const std::string&) const override { return 0; }
  double event_time(const std::string&) const override { return -1; }
  bool in_region(const std::string&, const calx::Vec3&) const override { return false; }

 private:
  calx::CaseSettings settings_;
  std::vector<calx::Surface> surfaces_;
  calx::Particles particles_;
  double time_ = 0;
  std::uint64_t step_ = 0;
};

/// A turn about z by the angle given, rad.
inline calx::Quat about_z(double angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

}  // namespace calx_test
