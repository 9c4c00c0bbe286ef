// engine.hpp: one time step of the world: contacts, sums in a fixed order, integration, guards.
//
// Every pass runs over fixed chunks of particles; each chunk's result depends on its inputs alone, so the same bits
// come out for any number of threads. The law sees the velocity of a particle before the kick of the step, which has
// moved it to where it is; a law that adds half of its own kick finds the mean velocity of the step, and the energy
// ledger closes to second order in dt:
//   euler (semi-implicit): forces at t(n) from x(n), v(n), then v(n+1) = v + a dt, x(n+1) = x + v(n+1) dt;
//   verlet: x(n+1) from v(n+1/2), forces at t(n+1) from x(n+1) and v(n+1/2), then v(n+1) = v(n+1/2) + a dt/2.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compute/force_text.hpp"
#include "compute/law_list.hpp"
#include "geometry/geometry.hpp"
#include "motion/motion.hpp"
#include "neighbour/pair_list.hpp"
#include "neighbour/wall_list.hpp"
#include "store/particles.hpp"

namespace calx {

class Device;
struct LeanRecord;
struct LeanWrench;
struct PairBlock;
struct StepKernels;

/// A wall part in the world.
struct EnginePart {
  std::string name;
  const Surface* surface = nullptr;
  std::uint32_t material = 0;
  bool present = true;
  bool moves = false;
  Pose pose;           // at the instant of the contacts
  Vec3 force, torque;  // N, N m about the pivot, by particles on the part, of the last step
};

/// When particles that no longer move are left out; see rest.hpp.
struct RestOptions {
  bool on = false;
  double after = 0;         // s
  double displacement = 0;  // of the radius, within after
  double force = 0;         // of the weight
};

struct EngineOptions {
  Vec3 gravity;
  Wrap wrap;
  Box domain;
  bool verlet = false;
  bool ledger = false;
  bool mixed = false;          // pair contacts in single precision, from exact positions
  double skin = 0;             // m, smallest margin of a particle; 0: 0.1 of the smallest radius
  double overlap_limit = 0.5;  // of the radius
  RestOptions rest;
};

/// Energies at the instant of the last contacts, J, and what has been lost or put in since the start.
struct EngineEnergy {
  double kinetic_translation = 0, kinetic_rotation = 0, gravity = 0, elastic = 0;
  double friction = 0, damping = 0, plastic = 0, wall_work = 0, force_work = 0, gravity_work = 0;
  /// Part of gravity: what particles lost when they were put back across a periodic face, so that gravity along a
  /// periodic direction does its work for ever.
  double wrapped = 0;
};

struct EngineTimes {
  double neighbour = 0, contacts = 0, integrate = 0;  // s of wall time
};

/// What a guard found; message names particle and numbers. Empty: all is well.
struct GuardReport {
  std::string message;
  std::vector<std::uint32_t> outside;  // ranks of particles beyond the domain
};

/// Steps that follow each other without a look at the world in between.
struct StepTable {
  std::vector<double> time;  // s, of the contacts of each step
  std::vector<Pose> poses;   // there: of part k at step j, poses[j * parts + k]
};

class Engine {
 public:
  Engine();
  ~Engine();
  Particles particles;
  std::vector<EnginePart> parts;
  std::vector<ParticleForce> forces;
  EngineOptions options;
  /// Laws of the ordered material pair (a, b) at [a * material_count + b]; null where the case gives none.
  std::vector<const LawList*> laws;
  std::uint32_t material_count = 0;
  std::vector<std::string> material_names;

  /// Sizes work spaces. Call once materials, laws and parts are known, before the first step.
  void prepare(int threads);
  /// Why this case cannot step on a device, one reason each; empty: it can. Call after prepare.
  std::vector<std::string> device_obstacles() const;
  /// Steps run on the device from now on, with the same bits unless fast. Call after prepare, without device_obstacles.
  /// Throws Error for a law text that the device's compiler refuses.
  void use_device(std::unique_ptr<Device> device, bool fast);
  bool on_device() const { return device_ != nullptr; }
  /// Bring from the device what is to be looked at: particles; loads on parts. Nothing to do without one. What
  /// functions below return is brought by them.
  void fetch() const;
  void fetch_loads() const;
  /// First half of a step: verlet moves particles to t + dt; euler does nothing.
  void begin(double dt);
  /// Second half: list check, contacts at time t (parts must hold their poses of t), sums, integration.
  GuardReport finish(double t, double dt);
  /// On a device, instead of begin and finish: steps through the table until its end or until a guard speaks. Returns
  /// how many were done; parts have the poses of the last.
  std::size_t run(const StepTable& table, double dt, GuardReport& report);

  /// Tells the engine that particles were appended since the last step.
  void inserted();
  /// Tells the engine that positions, velocities, spins or turns were written from outside. Not with rest.
  void edited();
  /// Removes the particles marked (rank order) and builds the lists anew.
  void remove(const std::vector<std::uint8_t>& mark, double dt);

  const PairList& pairs() const;
  const WallList& walls() const;
  std::size_t pair_entry_count() const;
  std::size_t wall_row_count() const;
  const EngineEnergy& energy() const;
  const EngineTimes& times() const { return times_; }
  std::uint64_t rebuilds() const { return rebuilds_; }
  std::uint64_t touching() const;
  std::uint64_t asleep() const;    // particles that rest
  double largest_overlap() const;  // share of the radius, over the run
  std::size_t memory_bytes() const;
  /// Bytes that came back from the device so far.
  std::uint64_t bytes_fetched() const;
  std::uint32_t history_columns() const { return history_.columns; }

  /// Text that says what each history column is, per material pair; a checkpoint of another layout is refused.
  std::string history_layout() const;
  void save(StateWriter& out) const;
  void load(const StateReader& in);

  /// Contacts of the last step with forces are recomputed for output only: geometry now, history as it stands.
  struct Touch {
    std::uint32_t i, j;
    int part;
    Vec3 normal;  // towards i
    double overlap;
  };
  std::vector<Touch> touches() const;

 private:
  struct OnDevice;
  struct Worker;
  struct ChunkResult;
  struct Rest;
  /// The largest overlap of a step, share of the radius, and whose it is; j = ~part for a wall.
  struct Worst {
    double overlap = 0;
    std::uint32_t i = 0, j = 0;
  };
  GuardReport guard_report(const Worst& worst) const;
  void place(const StepTable& table, std::size_t step);
  std::size_t steps_in_margin(const StepTable& table, std::size_t first);
  void rebuild_if_stale(double dt);
  void step_on_host(double t, double dt, double& contacts_done);
  void rebuild(double dt, bool reorder);
  void build_lists(double dt, bool reorder);
  void wrap_positions();
  void check_periodic_lengths() const;
  /// Of the spheres there are: gaps at which laws act.
  void measure_gaps();
  void place_parts(double dt, std::vector<PartPlace>& places);
  bool parts_left_margin() const;
  template <class Precision>
  void pair_pass(std::size_t chunk, Worker& worker, double t, double dt);
  template <class Precision>
  struct PairWork;
  /// Law and history of a block. True if some row may have the largest overlap.
  template <class Precision>
  bool solve_pairs(std::size_t chunk, Worker& worker, const PairBlock& pairs, const LawList& list, double t, double dt);
  /// Adds a block to the sums of its spheres and of the chunk. record: some row may have the largest overlap.
  template <class Precision>
  void take_pairs(std::size_t chunk, const PairBlock& pairs, PairWork<Precision>& work, bool record);
  /// Geometry and law of a block; nothing is written but the work space. True if some row may have overlap / (2 r_eff)
  /// above largest.
  template <class Precision>
  bool law_of_pairs(std::size_t chunk, Worker& worker, const PairBlock& pairs, const LawList& list, double largest,
                    double t, double dt);
  void thin_pass(std::size_t chunk);
  void size_sums();
  /// capture: contacts of sleepers with still parts, read only; else all others.
  void wall_pass(std::size_t chunk, Worker& worker, double t, double dt, bool capture = false);
  void add_wall_contact(Worker& worker, std::uint32_t row, Wrench& sphere, Wrench& load) const;
  static void close_load_span(ChunkResult& result);
  void evaluate_walls(std::size_t chunk, Worker& worker, const LawList& list, double t, double dt, bool capture);
  void sum_pass(std::size_t chunk);
  void force_pass(std::size_t chunk, Worker& worker, double t, double dt);
  void integrate_euler(std::size_t chunk, double dt);
  void book_half(std::size_t chunk, double dt, bool before);
  void sum_spheres(std::uint32_t first, std::uint32_t last);
  void drift_verlet(std::size_t chunk, double dt);
  void drift_run(std::size_t chunk, std::uint32_t first, std::uint32_t last, double dt);
  void finish_verlet(std::size_t chunk, double dt);
  void finish_run(std::size_t chunk, std::uint32_t first, std::uint32_t last, double dt);
  void guard_pass(std::size_t chunk, double dt);
  void guard_each(std::size_t chunk);
  void set_haste();
  // rest.cpp, rest_change.cpp
  struct RestWalk;
  const RestWalk* walk(std::size_t chunk) const;
  template <class Runs, class Visit>
  void each_run(std::size_t chunk, Runs RestWalk::*runs, const Visit& visit);
  template <class Visit>
  void each_awake(std::size_t chunk, const Visit& visit);
  template <class Visit>
  void each_live(std::size_t chunk, const Visit& visit);
  std::uint32_t first_sphere_of(std::uint32_t p) const { return particles.has_clumps ? particles.first_sphere[p] : p; }
  /// Rows for particles that have come.
  void rest_grow();
  /// Wakes what touches parts that move, come or go.
  void rest_watch_parts(double dt);
  /// Of the wakers and the sleepers to be: changes their state and all that follows from it.
  void rest_change(std::vector<std::uint32_t>& wake, const std::vector<std::uint32_t>& sleep,
                   const std::vector<std::uint32_t>& touched, double dt);
  void rest_near(const std::vector<std::uint32_t>& particles);
  void rest_capture(const std::vector<std::uint32_t>& affected, const std::vector<std::uint32_t>& changed, double dt);
  void rest_capture_pairs(std::size_t chunk, Worker& worker, double dt);
  template <class Precision>
  void rest_take_pairs(std::size_t chunk, Worker& worker, const LawList& list, double dt);
  void rest_capture_walls(std::size_t chunk, Worker& worker, double dt);
  void rest_take_walls(std::size_t chunk, Worker& worker, std::uint32_t count);
  void rest_entries(std::size_t chunk);
  void rest_runs(std::size_t chunk);
  Vec3 rest_unbalanced(std::uint32_t p, Vec3& torque) const;
  void rest_kick(std::uint32_t p, double dt);
  void rest_check_sleepers(std::size_t chunk);
  void rest_check_awake(std::size_t chunk);
  void rest_calm(std::vector<std::uint32_t>& sleep);
  void rest_update(double dt);
  /// Before the particles marked go: what touches them wakes.
  void rest_leave(const std::vector<std::uint8_t>& mark, double dt);
  void rest_permute(const std::vector<std::uint32_t>& order);
  /// After lists were built.
  void rest_relist(double dt);
  void rest_save(StateWriter& out) const;
  void rest_load(const StateReader& in);
  bool one_material() const;
  /// The spheres of entry e are less than that gap apart, m; 0: they touch.
  bool nearer_than(std::size_t e, double gap) const;
  /// Threads worth waking: no more than there are chunks.
  int team() const;
  const LawList& law(std::uint32_t a, std::uint32_t b) const;
  [[noreturn]] void missing_law(std::uint32_t a, std::uint32_t b) const;

  PairList pairs_;
  WallList walls_;
  HistorySpec history_;
  Column<Wrench> sphere_wrench_;
  Column<Wrench> sum_;  // per clump, of this step
  // Mixed precision only: spheres as the pair loop sees them, its sums, and what leaves chunks.
  Column<LeanRecord> lean_;
  Column<LeanWrench> lean_wrench_, lean_slot_;
  /// Sums per particle of this step: a particle of one sphere is its sphere.
  Column<Wrench>& sums() { return particles.has_clumps ? sum_ : sphere_wrench_; }
  const StepKernels* kernels_ = nullptr;
  Column<double> margin_;            // per particle, m
  Column<float> haste_;              // per particle, 1 / margin^2 rounded up, 1/m^2
  std::vector<double> used_;         // per chunk: share of the margins used up since the lists were built, at most
  Column<Vec3> reference_;           // per sphere, position when the pair list was built
  Column<std::uint32_t> list_rank_;  // per sphere, its rank in the present list
  std::vector<PartPlace> places_;    // parts when the wall list was built
  std::vector<ChunkResult> results_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Box> part_bounds_;
  EngineEnergy energy_;
  EngineTimes times_;
  bool stale_ = true, uniform_ = false;
  double smallest_margin_ = 0, largest_margin_ = 0, cell_ = 0;
  // Gaps at which laws act between spheres, and spheres and parts, of the largest spheres: m, in the order of laws.
  std::vector<double> pair_gaps_, wall_gaps_;
  double largest_pair_gap_ = 0, largest_wall_gap_ = 0;
  std::uint64_t rebuilds_ = 0, sorted_at_ = 0, touching_ = 0;
  bool count_changed_ = true;
  double largest_overlap_ = 0;
  Worst worst_;                       // of the last step
  std::unique_ptr<Rest> rest_;        // null: off
  std::unique_ptr<OnDevice> device_;  // null: this processor
  double time_ = 0;                   // s, of the last contacts
  int threads_ = 1;
};

}  // namespace calx
