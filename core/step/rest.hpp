// rest.hpp: particles that no longer move and are left out of a step. Private to step/.
//
// A sleeper keeps its place, has no velocity, and is still for all that touch it. Contacts between sleepers, and of
// sleepers with parts that stand still, are not evaluated: each sleeper keeps the sum of their wrenches (frozen), taken
// with both sides still. All its other contacts are evaluated as ever. So its unbalanced wrench is known at every step,
// and it wakes as soon as that exceeds the tolerance.
#pragma once
#include <cstdint>
#include <vector>

#include "step/engine_detail.hpp"

namespace calx {

/// What a step has to visit of a chunk while particles sleep.
struct Engine::RestWalk {
  /// Consecutive particles, ranks.
  struct Run {
    std::uint32_t first, last;
  };
  bool whole = true;      // no entry is left out
  std::size_t count = 0;  // entries to look at; lists of them, see PairScan
  std::vector<std::uint32_t> i, j, entry, ordinal;
  std::vector<std::size_t> out_slots, in_slots;  // slots that such entries may write, and that may be read
  std::vector<Run> awake, live;                  // live: awake, or reached by contacts that are evaluated
  std::vector<std::uint32_t> border;             // sleepers that are live
  std::uint64_t pair_contacts = 0;               // between sleepers
  // Contacts of sleepers with parts that stand still.
  std::vector<Wrench> load;
  double wall_elastic = 0;
  std::uint64_t wall_contacts = 0;
  std::vector<std::uint32_t> senders;  // chunks whose entries reach into this one
  // Results of a chunk, taken up in the order of chunks.
  struct Share {
    std::uint32_t particle;
    Wrench wrench;
    double elastic;
  };
  std::vector<std::uint32_t> found;
  std::vector<std::uint8_t> reached;  // work space
  std::vector<Share> shares;
};

struct Engine::Rest {
  struct PartState {
    Quat turn;
    Vec3 shift;
    bool present = false, moving = true;
  };
  enum Mark : std::uint8_t { changed = 1, affected = 2 };

  // One row per particle.
  Column<std::uint8_t> asleep, quiet;  // quiet: consecutive checks passed
  Column<Vec3> reference;              // m, position at the last check
  Column<Wrench> frozen;
  Column<double> elastic;          // J, of contacts between sleepers, kept with the owner of the first sphere
  Column<std::uint8_t> mark;       // all zero between calls
  std::vector<RestWalk> walks;     // per chunk
  bool listed = false;             // walks hold what the lists and the sleepers ask for
  Column<std::uint8_t> open;       // per slot: some contact that is evaluated may write it
  std::vector<std::uint8_t> near;  // per chunk, work space
  std::vector<PartState> parts;    // at the last step
  bool parts_move = true;
  std::uint64_t sleepers = 0, clock = 0;  // clock: steps since the start

  std::size_t memory_bytes() const {
    std::size_t bytes = asleep.capacity() + quiet.capacity() + mark.capacity() + open.capacity();
    bytes += reference.capacity() * sizeof(Vec3) + frozen.capacity() * sizeof(Wrench) + elastic.capacity() * 8;
    for (const RestWalk& w : walks)
      bytes += (w.i.capacity() + w.j.capacity() + w.entry.capacity() + w.ordinal.capacity()) * 4 +
               (w.out_slots.capacity() + w.in_slots.capacity()) * 8;
    return bytes;
  }
};

/// The walk of chunk c, or null while nothing sleeps.
inline const Engine::RestWalk* Engine::walk(std::size_t c) const {
  return rest_ && rest_->listed ? &rest_->walks[c] : nullptr;
}

/// Calls visit(first, last) for each of the runs of particles of chunk c.
template <class Runs, class Visit>
void Engine::each_run(std::size_t c, Runs RestWalk::*runs, const Visit& visit) {
  if (const RestWalk* w = walk(c))
    for (const RestWalk::Run& run : w->*runs) visit(run.first, run.last);
  else
    visit(pairs_.chunks[c].first_particle, pairs_.chunks[c].last_particle);
}
/// Particles that are awake.
template <class Visit>
void Engine::each_awake(std::size_t c, const Visit& visit) {
  each_run(c, &RestWalk::awake, visit);
}
/// Particles whose sums may change.
template <class Visit>
void Engine::each_live(std::size_t c, const Visit& visit) {
  each_run(c, &RestWalk::live, visit);
}

}  // namespace calx
