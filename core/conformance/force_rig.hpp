// force_rig.hpp: a particle force alone, with guards around its block. Private to core/conformance.
#pragma once
#include <array>
#include <vector>

#include "conformance/subject.hpp"

namespace calx::conformance {

class ForceRig {
 public:
  /// Throws Failed where the plugin refuses the variant.
  ForceRig(Subject& subject, const Variant& variant);

  static constexpr double dt = 1e-5, time = 0.25;  // s
  /// x y z, vx vy vz, wx wy wz, mass, radius.
  using Columns = std::array<std::vector<double>, 11>;

  const calx_particle_force& table() const { return *table_; }
  const calx_instance* instance() const { return instance_->get(); }
  const std::string& name() const { return name_; }
  Columns particles(Subject& subject, std::size_t count) const;
  /// Force and moment, column after column, of blocks of the size given. before: what stands there already. Throws
  /// Failed where anything outside of the rows was written, or a column that may only be read.
  std::vector<double> evaluate(const Columns& columns, std::size_t block, double before = 0) const;

 private:
  InstancePtr instance_;
  const calx_particle_force* table_;
  std::string name_;
};

/// A rig for each variant that the force takes. Throws Failed where it takes none.
std::vector<ForceRig> force_rigs(Subject& subject);

}  // namespace calx::conformance
