// on_device.hpp: steps and lists of the engine on a device, with the bits of the host. Particles, contacts, lists and
// ledgers stay there; the host gets flags after each batch of steps, and the rest when it looks. Private to step/.
#pragma once
#include <memory>
#include <vector>

#include "compute/device.hpp"
#include "step/engine_detail.hpp"

namespace calx {

struct Engine::OnDevice {
  /// fast: a * b + c may be contracted in steps, and the bits are the device's own.
  OnDevice(std::unique_ptr<Device> device, Engine& engine, bool fast);
  ~OnDevice();

  /// How a batch of steps ended.
  struct Outcome {
    std::size_t done = 0;           // steps, all of them to their end
    bool drifted = false;           // verlet: the step after those has had its first half
    bool stale = false;             // lists must be built before the next contacts
    bool spoken = false;            // a guard: numbers that are none, particles outside, or an overlap beyond the limit
    std::uint32_t missing_law = 0;  // 1 + number of the material pair; 0: none
  };
  /// Steps number first .. first + count of the table, at most kBatch; the last ones are left out where a flag stops
  /// them. drifted: the first of them has had its first half already.
  Outcome run(const StepTable& table, std::size_t first, std::size_t count, bool drifted, double dt);
  /// Verlet: the first half of a step alone.
  Outcome drift(double dt);
  /// Pair and wall lists for particles as they stand, after periodic faces and, if asked to, in Morton order.
  void build_lists(double dt, bool reorder);
  /// The wall list alone; margin_factor as in WallList::build.
  void build_walls(double margin_factor);

  /// Bring particles; lists with history; energies, loads and counters to the host, unless it has them.
  void fetch();
  void fetch_lists();
  void fetch_sums();
  /// The host has changed particles, all of which it had fetched. Its list_rank_ says where each stands in the lists.
  void particles_changed() { particles_sent_ = false; }
  /// The host has loaded everything anew.
  void all_changed();

  std::size_t entry_count() const { return entries_; }
  std::size_t wall_row_count() const { return rows_; }
  const Device& device() const { return *device_; }
  std::size_t memory_bytes() const;

  /// Steps between two looks at the flags. Those after a flag cost launches that end at once.
  static constexpr std::size_t kBatch = 16;

 private:
  struct Numbers;
  struct Memory;
  // on_device.cpp
  void build(bool fast);
  Numbers numbers(double dt) const;
  std::size_t result_width() const { return kSums + 6 * engine_.parts.size(); }
  // on_device_send.cpp
  void send();
  void send_shapes();
  void send_particles();
  void send_gaps();
  void send_lists();
  void send_sums();
  void send_table(const StepTable& table, std::size_t first, std::size_t count);
  // on_device_step.cpp
  void record(double dt);
  void launch_drift(const Numbers& n);
  void launch_rest_of_step(const Numbers& n);
  void launch_integration(const Numbers& n);
  Outcome take_flags();
  // on_device_order.cpp
  void wrap(const Numbers& n);
  void sort_particles(const Numbers& n);
  void reorder(const DeviceBuffer& buffer, const DeviceBuffer& order, std::size_t rows, std::size_t bytes);
  /// Launches join_extents until one is left; which of the two buffers it is in.
  const DeviceBuffer& join_extents(std::size_t runs);
  // on_device_lists.cpp
  std::size_t make_levels(const Numbers& n, Vec3& origin);
  void search_pairs(const Numbers& n);
  void link_entries(const Numbers& n);
  void make_chunks(const Numbers& n);
  void size_step();

  /// Numbers of a chunk before the loads on parts; see fold.h.
  static constexpr std::size_t kSums = 14;

  std::unique_ptr<Device> device_;
  Engine& engine_;
  std::unique_ptr<Memory> memory_;
  std::size_t entries_ = 0, rows_ = 0, elements_ = 0, wall_stride_ = 0;
  std::uint32_t listed_spheres_ = 0;  // when lists were built
  std::uint32_t level_count_ = 0;     // of the search
  // What the device holds of the host's, and the host of the device's.
  bool particles_sent_ = false, lists_sent_ = true, sums_sent_ = false;
  bool fetched_ = true, lists_fetched_ = true, sums_fetched_ = true;
  bool permuted_ = false;  // ranks differ; see Memory::host_rank
  bool moving_ = false;    // a part moves: tables hold its poses step by step
};

}  // namespace calx
