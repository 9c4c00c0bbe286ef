// sample_world.hpp: a made-up fill of the canister: grains leave a hopper through a turning rotor and build a pile. No
// physics; positions are plausible, so that pictures of a report can be judged by eye.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "measure/world.hpp"

namespace calx_test {

constexpr double sample_start = 0.6, sample_period = 0.56;  // s: rotor starts; one cycle of two strokes
constexpr int sample_cycles = 40;
constexpr double sample_end = sample_start + sample_cycles * sample_period + 0.5;  // s
constexpr double sample_mass = 2.1828;                                             // kg, dispensed in all

class SampleWorld : public calx::WorldView {
 public:
  /// grains: clumps of two spheres.
  explicit SampleWorld(std::size_t grains);
  void at(double time);
  double canister_mass(double time) const;  // kg
  double rotor_angle(double time) const;    // rad

  const calx::CaseSettings& settings() const override { return settings_; }
  double time() const override { return time_; }
  std::uint64_t step() const override { return static_cast<std::uint64_t>(time_ / 6.05e-6); }
  double time_step() const override { return 6.05e-6; }
  const calx::Particles& particles() const override { return particles_; }
  std::size_t part_count() const override { return surfaces_.size(); }
  const std::string& part_name(std::size_t part) const override { return settings_.parts[part].name; }
  bool part_present(std::size_t) const override { return true; }
  const calx::Surface& part_surface(std::size_t part) const override { return surfaces_[part]; }
  calx::Pose part_pose(std::size_t part) const override;
  calx::PartLoad part_load(std::size_t) const override { return {}; }
  std::vector<calx::ContactRow> contacts() const override { return {}; }
  std::vector<std::uint32_t> contact_counts() const override {
    return std::vector<std::uint32_t>(particles_.sphere_count(), 4);
  }
  calx::EnergyLedger energy() const override { return {}; }
  calx::MassLedger mass() const override { return {}; }
  double cycles_of(const std::string&) const override { return 0; }
  double event_time(const std::string&) const override { return -1; }
  bool in_region(const std::string&, const calx::Vec3&) const override { return false; }

 private:
  struct Grain {
    calx::Vec3 hopper, pile, tilt;  // tilt: half the distance between the two spheres
    double leaves = 0;              // s; beyond the end: stays in the hopper
  };
  void add_part(const std::string& name, const std::vector<calx::Vec3>& vertices,
                const std::vector<std::uint32_t>& triangles);
  calx::CaseSettings settings_;
  std::vector<calx::Surface> surfaces_;
  std::vector<Grain> grains_;
  calx::Particles particles_;
  double time_ = 0;
};

}  // namespace calx_test
