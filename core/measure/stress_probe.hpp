// stress_probe.hpp: the stress that particles put on parts, for the sensors stress, wall-friction and yield-locus.
// Private to measure/.
#pragma once
#include <string>
#include <vector>

#include "measure/options.hpp"
#include "measure/region_ref.hpp"
#include "measure/windows.hpp"

namespace calx {

/// Force of the particles on "parts" over "area": normal stress along "normal", the way the powder presses (preset
/// [0, 0, -1]), shear stress along "shear" (preset [1, 0, 0]). Parts that are not in the world carry nothing.
/// "below": a region of particles that stand between the plane of the stress and the parts; their weight is taken off.
/// "slider": the part whose speed along "shear" is the speed of shear.
class StressProbe {
 public:
  explicit StressProbe(SensorOptions& options);
  /// Of the last step. The weight below is looked up when weigh() was called last.
  StressState state(const WorldView& world) const;
  /// Adds up the particles below; they hardly change, so once a row is enough.
  void weigh(const WorldView& world);
  double below() const { return below_weight_; }
  void set_below(double weight) { below_weight_ = weight; }

  /// Inertial number of a shear zone ten particles wide: shear rate * d * sqrt(density / stress), where the rate is
  /// speed / (10 d), so that d drops out. haste: Windows::haste.
  static double inertial(const WorldView& world, double haste);

 private:
  std::vector<std::string> parts_;
  std::string slider_;
  double area_;
  Vec3 normal_, shear_;
  RegionRef below_;
  bool has_below_;
  double below_weight_ = 0;  // N along normal
};

}  // namespace calx
