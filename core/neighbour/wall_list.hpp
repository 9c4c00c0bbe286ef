// wall_list.hpp: which spheres may touch which parts before the next rebuild, with the surface elements near each and
// the contact history. One row per (sphere, part); a row holds up to kWallContacts contacts, told apart by their
// normals, so that a particle rolling from facet to facet or round an edge keeps its history.
#pragma once
#include <cstdint>
#include <vector>

#include "base/column.hpp"
#include "geometry/geometry.hpp"
#include "neighbour/pair_list.hpp"
#include "store/particles.hpp"

namespace calx {

/// Contacts of one sphere with one part at a time: three walls of a corner and one more.
constexpr std::uint32_t kWallContacts = 4;

/// A part as the search sees it.
struct PartPlace {
  const Surface* surface = nullptr;
  Quat turn;
  Vec3 shift;         // m
  double margin = 0;  // m, how far any point of it may move before the next rebuild
  bool present = true;
};

class WallList {
 public:
  Column<std::uint32_t> sphere, part;   // per row, rising (sphere, part)
  Column<std::uint32_t> first_element;  // per row, into elements; one more at the end
  std::vector<std::uint32_t> elements;
  std::vector<std::size_t> first_row;  // per chunk; one more at the end
  // Per contact slot, kWallContacts consecutive slots per row.
  Column<std::uint8_t> touching;  // or within the gap at which laws act
  Column<Vec3> normal;            // part frame, at the last evaluation
  Column<double> history;         // column k of slot c at history[k * stride + c]
  std::size_t stride = 0;
  std::size_t row_count() const { return sphere.size(); }
  static std::size_t stride_of(std::size_t rows) { return (rows * kWallContacts + 7) / 8 * 8 + 8; }

  /// old_rank as in PairList::build. Rows follow the chunks of pairs. margin_factor: 1 right after the pair list was
  /// built; 2 when particles may already have used up their margin and may go back as far. gap: m, the largest at which
  /// some law acts against a part.
  void build(const Particles& particles, const PairList& pairs, const std::vector<PartPlace>& parts,
             const Column<double>& margin, double margin_factor, const HistorySpec& spec, const std::uint32_t* old_rank,
             double gap = 0);
  std::size_t memory_bytes() const;

 private:
  struct ChunkWork {
    std::vector<std::uint32_t> sphere, part, first_element, elements;
    std::vector<std::uint32_t> near_group, near_few, probe;  // parts near runs of spheres; elements near a run
  };
  struct Search;
  std::vector<ChunkWork> work_;
  std::vector<std::uint32_t> row_of_sphere_;  // first row of each sphere; one more at the end
};

}  // namespace calx
