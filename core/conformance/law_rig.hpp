// law_rig.hpp: a contact law alone: pair row from presets, blocks of contacts with guards around them, impacts of two
// spheres. Private to core/conformance.
#pragma once
#include <vector>

#include "base/vec3.hpp"
#include "conformance/subject.hpp"

namespace calx::conformance {

/// What a law reads of one contact, CALX_IN_*.
struct Contact {
  double in[CALX_IN_COUNT] = {};
};

/// Outputs and history of many contacts after evaluation, row after row; precise to the bits of either precision.
struct Evaluated {
  std::vector<double> out;    // CALX_OUT_COUNT a row
  std::vector<double> state;  // state_count a row
};

class LawRig {
 public:
  /// Throws Failed where the plugin refuses the variant.
  LawRig(Subject& subject, const Variant& variant);

  const ContactLaw& law() const { return law_; }
  const calx_contact_law& table() const { return law_.table(); }
  const std::vector<double>& pair() const { return pair_; }
  const std::string& name() const { return name_; }
  /// Radius of the spheres, mass of one, speed of an impact, overlap at its turning point, a step far below the stable
  /// one: SI, chosen from what the law does.
  static constexpr double radius = 1e-3, speed = 0.1;
  double mass() const { return 4.0 / 3.0 * 3.14159265358979324 * radius * radius * radius * 2500; }
  double overlap() const { return overlap_; }
  /// Gap up to which the law acts between two spheres of that radius, m; 0: only while touching.
  double reach() const { return law_.reach(pair_, radius, radius); }
  double dt() const { return dt_; }

  std::vector<double> fresh(std::size_t rows) const;
  /// Contacts of unlike spheres and of spheres with walls, with the velocities of a shaken bed. Of a law that reaches
  /// every third does not touch.
  std::vector<Contact> contacts(Subject& subject, std::size_t count) const;

  struct Block {
    std::size_t rows = 256;
    bool ledger = true;
    double dt = -1;  // below 0: dt()
  };
  /// Real: double or float. state: history before, row after row. Columns not asked for are null. Throws Failed where
  /// anything behind the rows of a block, rounded up to 16, or before them was written.
  template <class Real>
  Evaluated evaluate(const std::vector<Contact>& rows, const std::vector<double>& state, const Block& block) const;
  template <class Real>
  Evaluated evaluate(const std::vector<Contact>& rows, const std::vector<double>& state) const {
    return evaluate<Real>(rows, state, Block());
  }

  /// Force on i along a prescribed path, with fixed normal z: one step from where state is. Moves state.
  struct Wrench {
    Vec3 force, moment;
  };
  Wrench at(double overlap, const Vec3& velocity, const Vec3& spin, std::vector<double>& state, double dt) const;

  /// Head-on impact of two spheres, from reach to reach: speed after over speed before; below 0 where they stay
  /// together for `longest` s. spring: N/m, of a spring beside the law, for a term that does not push.
  struct Impact {
    double restitution = -1, overlap = 0, force = 0, time = 0;
  };
  Impact impact(double speed, double dt, double phase = 0.5, double longest = 1, double spring = 0) const;

 private:
  void find_scales();

  ContactLaw law_;
  std::string name_;
  std::vector<double> pair_;
  double overlap_ = 0, dt_ = 0;
};

/// A rig for each variant that the law takes. Throws Failed where it takes none.
std::vector<LawRig> rigs(Subject& subject);
/// "3 configurations".
std::string variants_text(std::size_t count);

}  // namespace calx::conformance
