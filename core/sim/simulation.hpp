// simulation.hpp: builds the world from a case and moves it through time. The command line and the C API sit on it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/state.hpp"
#include "config/config.hpp"
#include "measure/measure.hpp"
#include "plugin/plugin.hpp"

namespace calx {

struct SimulationOptions {
  int threads = 0;             // 0: all
  bool mixed = false;          // pair contacts in single precision, from exact positions; all else in double
  std::string device = "cpu";  // "auto", "cpu", "opencl", "cuda" or "host", the last three also with ":ordinal"
  bool fast = false;           // devices may contract a * b + c: other last digits than the processor's
  std::vector<std::string> plugin_path;
  bool require_pins = false;               // refuse plugins whose hash the case does not give
  bool safe_mode = false;                  // plugins that came with the program only, whatever plugin_path holds
  std::vector<const calx_entry*> plugins;  // in this program; used before any of the same id in a folder
};

/// Folders in which plugins of a simulation are looked for.
std::vector<std::string> plugin_folders_of(const SimulationOptions& options);

/// One time-step limit and where it comes from.
struct StepLimit {
  std::string name, where;   // "rayleigh", "10 % of 60.5 us, calcine sphere of radius 1.25 mm"
  double seconds = 0;        // advised, s
  double refused_above = 0;  // a step given by the case may be as long as this, s
  bool binds = false;
};

class Simulation {
 public:
  /// Loads plugins, builds parts, materials, laws. Throws Error. [main]
  Simulation(CaseFile input, const SimulationOptions& options);
  ~Simulation();

  const CaseSettings& settings() const;
  /// Where steps run, and why there.
  const std::string& device() const;
  bool fast() const;  // on a device that may contract a * b + c
  std::size_t particle_count() const;
  const WorldView& world() const;
  double time() const;
  std::uint64_t step_count() const;
  double time_step() const;
  std::vector<StepLimit> step_limits() const;
  /// The smallest limit of a law at the largest overlap of the run so far; seconds 0: no law states one, or no contact.
  StepLimit law_limit_seen() const;
  /// Law parameters the case left to their presets, one line each.
  std::vector<std::string> presets() const;
  /// Law parameters that particle scaling changed, before and after, one line each.
  std::vector<std::string> scaled() const;
  bool finished() const;  // end time or end event reached

  /// One time step; on a device up to `most`, as many as nothing in the case has to look at the world between. Returns
  /// how many. Throws Error(Fault::numerics) on a blow-up, a lost particle or a non-finite number, the world being left
  /// as it was before the guard spoke.
  std::uint64_t step(std::uint64_t most = 1);

  std::vector<std::unique_ptr<Sensor>>& sensors();
  /// Particles to be written from outside between steps (position, velocity, spin, turn; nothing may come or go).
  /// particles_written must follow before the next step: it throws Error(Fault::settings) in a case with "rest" and
  /// Error(Fault::numerics) for a number that is not finite.
  Particles& edit_particles();
  void particles_written();
  /// The caller moves a part from now on: its pose at the contacts of the next steps, until it is set anew.
  void drive_part(std::size_t part, const Pose& pose);
  std::vector<PluginProvenance> provenance() const;
  /// Bytes of all arrays that grow with the number of particles and contacts.
  std::size_t memory_bytes() const;
  struct Counters {
    std::uint64_t rebuilds = 0, pair_entries = 0, touching = 0, wall_entries = 0, asleep = 0;
    std::uint64_t bytes_fetched = 0;  // from a device
    double seconds_neighbour = 0, seconds_contacts = 0, seconds_integrate = 0, seconds_other = 0;
    double largest_overlap = 0;  // share of the radius, over the run
  };
  Counters counters() const;
  /// Messages of the run log since the last call (events fired, sources exhausted, warnings).
  std::vector<std::string> take_messages();

  void save(StateWriter& out) const;
  void load(const StateReader& in);
  /// Hash of positions, velocities, spins, orientations by id, and contact history: equal bits give equal digests.
  std::string digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace calx
