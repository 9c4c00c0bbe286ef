// pair_list.hpp: which spheres may touch before the next rebuild, in chunks, with the contact history of each pair.
//
// Entries stand in the order of rising (i, j) ranks, i < j. A chunk is a run of consecutive particles whose length
// depends on the particle count alone, never on threads; a thread sums forces of a chunk's own entries directly, and
// what leaves the chunk goes through slots that the receiving chunk adds in a fixed order. So sums have one order.
//
// Margins: each particle may move by its own margin before the list is stale; a fast particle gets a wide one, so that
// a thin falling stream does not force a rebuild of the whole bed every few steps.
#pragma once
#include <cstdint>
#include <vector>

#include "base/column.hpp"
#include "neighbour/cell_search.hpp"
#include "neighbour/morton.hpp"
#include "neighbour/wrap.hpp"
#include "store/particles.hpp"

namespace calx {

/// History columns of contacts: how to start, turn round and end a row.
struct HistorySpec {
  std::uint32_t columns = 0;    // the largest count over all law lists
  std::uint32_t materials = 1;  // number of materials that odd tells apart
  /// Changes sign when i and j trade places: of the ordered material pair (a, b) from (a * materials + b) * columns on.
  std::vector<std::uint8_t> odd;
};

struct Chunk {
  std::uint32_t first_particle = 0, last_particle = 0, first_sphere = 0, last_sphere = 0;
  std::size_t first_entry = 0, last_entry = 0;
  std::size_t first_slot = 0, last_slot = 0;  // of contributions that leave this chunk
  struct Incoming {
    std::size_t first = 0, last = 0;  // slots of another chunk meant for this one
  };
  std::vector<Incoming> incoming;  // in the order of the sending chunks
};

/// Particles of a chunk in a world of so many.
std::uint32_t chunk_length(std::size_t particle_count);

class PairList {
 public:
  std::vector<Chunk> chunks;
  Column<std::uint32_t> i, j;     // sphere ranks
  Column<std::uint8_t> touching;  // at the last evaluation, or within the gap at which the laws of the pair act
  Column<double> history;         // value k of entry e at history[e * columns + k]; a few spare values at the end
  std::uint32_t columns = 0;
  Column<std::uint32_t> cross;           // slot of the n-th entry of a chunk that leaves it, entries in order
  std::vector<std::size_t> first_cross;  // per chunk, into cross
  Column<std::uint32_t> slot_sphere;     // receiving sphere of each slot
  Column<Wrench> slot_wrench;
  Column<std::uint8_t> slot_used;
  std::size_t entry_count() const { return i.size(); }

  /// Builds the list for particles as they stand. margin: m, one per particle. old_rank: for each sphere its rank when
  /// the present history was written, or 0xFFFFFFFF for a new sphere; null keeps ranks. gap: m, the largest at which
  /// some law acts. Threads: OpenMP.
  void build(const Particles& particles, const Wrap& wrap, const Column<double>& margin, const HistorySpec& spec,
             const std::uint32_t* old_rank, double gap = 0);
  /// Chunks alone, without entries. For lists that were built elsewhere.
  void make_chunks(const Particles& particles);
  std::size_t memory_bytes() const;

 private:
  void link_chunks();
  void carry_history(const Particles& particles, const HistorySpec& spec, const std::uint32_t* old_rank,
                     const Column<std::size_t>& old_row, const Column<std::uint32_t>& old_j,
                     const Column<std::uint8_t>& old_touching, const Column<double>& old_history);
  Column<std::size_t> row_;  // first entry of each sphere; one more at the end
  CellSearch search_;
  std::vector<std::uint32_t> run_start_;  // first sphere of each chunk; one more at the end
};

}  // namespace calx
