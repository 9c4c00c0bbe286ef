// law_bench.hpp: the laws of one material pair alone: pressed, struck and sheared, two spheres or a sphere on a wall.
// Some 10 000 evaluations of one contact: a fraction of a second.
#pragma once
#include <string>
#include <vector>

#include "config/config.hpp"
#include "plugin/plugin.hpp"

namespace calx {

struct LawBenchOptions {
  double radius = 1e-3;       // m, of i and of a sphere j
  bool wall = false;          // j is a wall of its material
  double overlap = 0;         // m, of the deepest press; 0: that of an impact at 0.1 m/s
  double least_speed = 0.01;  // m/s, of the impacts
  double most_speed = 3;
};

/// Slow press and release of a fresh contact, dashpots at rest.
struct LawPress {
  std::vector<double> overlap, force;       // m; N on i along the normal, positive pushes apart
  double most = 0, least = 0;               // N, largest and lowest force
  double loading_work = 0, loss_share = 0;  // J; share of it that the release does not give back
};

struct LawBench {
  std::string pair;                  // "calcine-steel"
  std::vector<std::string> laws;     // "calx.epam 1.0.0", in order
  std::vector<std::string> presets;  // parameters left to presets
  double mass = 0;                   // kg, m_eff
  double radius = 0;                 // m, r_eff
  double reach = 0;                  // m, gap at which the laws still act
  std::vector<LawPress> press;       // three, to a third, two thirds and all of the overlap
  /// Head-on impacts, without gravity. restitution 0: the bodies stay together.
  std::vector<double> speed, restitution, deepest, contact_time;  // m/s, 1, m, s
  /// Sheared to, fro and to again at half of the overlap; force against the displacement.
  std::vector<double> displacement, tangential;   // m, N
  double sheared_overlap = 0, sheared_force = 0;  // m; N, normal, at the end
  /// The same for rolling: moment of the contact against the relative turn.
  std::vector<double> angle, torque;  // rad, N m
  double roll_spin = 0;               // rad/s
};

/// file: a case with both materials and a contact between them. i, j: their names. Throws Error(Fault::settings) where
/// there is no such contact, and what load_laws throws.
LawBench bench_law_list(const CaseFile& file, const std::string& i, const std::string& j,
                        const LawBenchOptions& options, PluginRegistry& registry);

/// A case for bench_law_list: materials "i" and "j" of 2500 kg/m^3 and a contact of the laws named, each parameter that
/// a law insists on given its table's value. Loads the laws. Throws Error(Fault::plugin).
std::string law_bench_case(const std::vector<std::string>& laws, PluginRegistry& registry);

}  // namespace calx
