// source.hpp: where particles come from: a region filled at once, a rate, given positions.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "base/state.hpp"
#include "config/settings.hpp"
#include "store/particles.hpp"

namespace calx {

/// One particle to be.
struct Seed {
  Vec3 x;
  Quat turn;  // of the user's shape frame
  Vec3 v, w;
  double scale = 1;
};

/// What a source asks of the world before it places a particle.
class Obstacles {
 public:
  virtual ~Obstacles() = default;
  /// True when a sphere of that centre and radius touches no particle and no part.
  virtual bool free(const Vec3& x, double radius) const = 0;
  /// Shortest image of a difference of positions in a periodic domain.
  virtual Vec3 nearest(const Vec3& d) const { return d; }
  /// x and its periodic images within reach of the domain, m.
  virtual std::vector<Vec3> images(const Vec3& x, double) const { return {x}; }
};

class Source {
 public:
  /// shape_index, density: of the case. stream: number of the source, for its random numbers.
  Source(const SourceSettings& settings, const std::string& file, const Shape& shape, std::uint32_t shape_index,
         std::uint32_t material, double density, std::uint64_t seed, std::uint64_t stream);

  const SourceSettings& settings() const { return settings_; }
  std::uint32_t shape_index() const { return shape_index_; }
  std::uint32_t material() const { return material_; }
  bool started() const { return start_ >= 0; }
  bool exhausted() const { return exhausted_; }
  void start(double t) {
    if (start_ < 0) start_ = t;
  }
  /// True when new particles are due at time t.
  bool due(double t) const;
  /// Largest sphere about a particle of this source, m.
  double largest_bound() const;
  double smallest_scale() const;
  /// Particles given outright, by the case or its file; none for a source with a region.
  const std::vector<Seed>& given() const { return given_; }
  /// Where centres of new particles may be.
  Box bounds() const;
  /// Particles to insert now. Throws Error(Fault::settings) when the region cannot hold the mass, or given particles
  /// overlap each other, particles of other sources or a part by more than a twentieth of their radius.
  std::vector<Seed> make(double t, const Obstacles& obstacles);

  double requested_mass() const;  // kg
  double delivered_mass() const { return delivered_; }
  std::uint64_t delivered_count() const { return delivered_count_; }

  void save(StateWriter& out, const std::string& name) const;
  void load(const StateReader& in, const std::string& name);

 private:
  double draw_scale();
  Quat draw_turn();
  Vec3 draw_point();
  double mass_of(double scale) const;
  bool wants_more(double next_mass) const;
  bool is_given() const { return !settings_.file.empty() || !settings_.positions.empty(); }
  void read_given();
  void check_given(const Obstacles& obstacles) const;
  std::vector<Seed> fill(const Obstacles& obstacles);
  std::vector<Seed> rain(double t, const Obstacles& obstacles);

  SourceSettings settings_;
  std::string file_;
  const Shape* shape_;
  std::uint32_t shape_index_, material_;
  double density_;
  Random random_;
  std::vector<Seed> given_;
  double start_ = -1, next_ = 0, delivered_ = 0, pending_scale_ = 0;
  std::uint64_t delivered_count_ = 0;
  bool exhausted_ = false;
};

/// Rows of a CSV with header x_m,y_m,z_m and optionally vx_m_s.. , wx_rad_s.., qw_1.., scale. Throws
/// Error(Fault::files) with the line number.
std::vector<Seed> read_seeds(const std::string& path);

}  // namespace calx
