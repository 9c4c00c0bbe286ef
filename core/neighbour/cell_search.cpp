#include "neighbour/cell_search.hpp"

#include <omp.h>

#include <algorithm>
#include <cstring>

#include "base/hot.hpp"
#include "neighbour/cell_compare.hpp"

namespace calx {
namespace {

using Eight = std::int32_t __attribute__((vector_size(32)));

/// Sorts rows of count[k] ranks from `rows` to `out`; eight more may be read. Ranks are below 2^31.
CALX_HOT void sort_rows(const std::uint32_t* rows, const std::uint32_t* count, std::size_t n, bool repeats,
                        std::uint32_t* out) {
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t length = count[k];
    if (length <= 8 && !repeats) {
      // The place of each is the number of smaller ones.
      Eight row, at{};
      std::memcpy(&row, rows, sizeof row);
      for (std::uint32_t m = 0; m < length; ++m) at -= row > static_cast<std::int32_t>(rows[m]);
      std::int32_t place[8];
      std::memcpy(place, &at, sizeof place);
      for (std::uint32_t m = 0; m < length; ++m) out[place[m]] = rows[m];
    } else {
      std::copy(rows, rows + length, out);
      std::sort(out, out + length);
    }
    rows += length;
    out += length;
  }
}

}  // namespace

void CellSearch::collect(std::size_t found, Scratch& scratch, Run& run) const {
  const std::size_t n = run.count.size();
  // Where the next partner of each sphere goes.
  scratch.next.resize(n);
  scratch.rows.resize(std::max(scratch.rows.size(), found + 8));
  std::uint32_t *const next = scratch.next.data(), *const rows = scratch.rows.data();
  const std::uint32_t* const count = run.count.data();
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    next[k] = sum;
    sum += count[k];
  }
  const std::uint32_t first = scratch.first;
  const std::uint64_t* const pairs = scratch.pairs.data();
  for (std::size_t e = 0; e < found; ++e)
    rows[next[static_cast<std::uint32_t>(pairs[e] >> 32) - first]++] = static_cast<std::uint32_t>(pairs[e]);
  run.partner.resize(found);
  sort_rows(rows, count, n, repeats_, run.partner.data());
}

void CellSearch::merge(const std::vector<std::uint64_t>& gained, std::uint32_t first, Run& run) {
  // From the last row to the first, so that each partner moves once: those from `end` on have moved up to `to`.
  std::size_t end = run.partner.size(), to = end + gained.size(), row_end = end, g = gained.size();
  run.partner.resize(to);
  const auto partner = run.partner.begin();
  auto at = [&](std::size_t k) { return partner + static_cast<std::ptrdiff_t>(k); };
  for (std::size_t k = run.count.size(); g > 0; --k) {
    const std::size_t row = row_end - run.count[k - 1];
    for (; g > 0 && gained[g - 1] >> 32 == first + k - 1; --g, ++run.count[k - 1]) {
      const auto j = static_cast<std::uint32_t>(gained[g - 1]);
      const auto above = std::lower_bound(at(row), at(std::min(row_end, end)), j);
      std::copy_backward(above, at(end), at(to));
      to -= static_cast<std::size_t>(at(end) - above) + 1;
      end = static_cast<std::size_t>(above - partner);
      *at(to) = j;
    }
    row_end = row;
  }
}

void CellSearch::drop_repeats(Run& run) {
  auto row = run.partner.begin(), to = row;
  for (auto& count : run.count) {
    const auto row_end = row + count;
    const auto end = std::unique(row, row_end);
    count = static_cast<std::uint32_t>(end - row);
    to = std::copy(row, end, to);
    row = row_end;
  }
  run.partner.erase(to, run.partner.end());
}

void CellSearch::find(const Particles& p, const Wrap& wrap, const Column<double>& margin,
                      const std::vector<std::uint32_t>& run_start, double gap) {
  const std::size_t runs = run_start.size() - 1;
  half_gap_ = 0.5 * gap;
  if (runs_.size() < runs) {
    runs_.resize(runs);
    foreign_.resize(runs);
  }
  if (p.sphere_count() == 0) return;
  measure(p, wrap, margin);
  bin(p, wrap, margin);
  const View view{x_.data(),
                  y_.data(),
                  z_.data(),
                  reach_.data(),
                  rank_.data(),
                  cell_start_.data(),
                  cell_of_.data(),
                  place_.data(),
                  p.has_clumps ? p.owner.data() : nullptr,
                  levels_.data(),
                  static_cast<std::uint32_t>(levels_.size()),
                  origin_,
                  wrap,
                  wrap.any()};
  scratch_.resize(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t r = 0; r < runs; ++r) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
    scratch.first = run_start[r];
    runs_[r].count.assign(run_start[r + 1] - run_start[r], 0);
    foreign_[r].clear();
    if (scratch.pairs.size() < kRoom) scratch.pairs.resize(kRoom);
    Found found{scratch.pairs, foreign_[r],          runs_[r].count.data(),
                scratch.first, scratch.pairs.data(), scratch.pairs.data() + (scratch.pairs.size() - kRoom)};
    search_own_level(view, run_start[r], run_start[r + 1], found);
    if (levels_.size() > 1 || view.wraps) search_windows(view, run_start[r], run_start[r + 1], found);
    collect(static_cast<std::size_t>(found.at - scratch.pairs.data()), scratch, runs_[r]);
    std::sort(foreign_[r].begin(), foreign_[r].end());
  }
  // Pairs found from the sphere of higher rank belong to the run of the other.
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t r = 0; r < runs; ++r) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
    auto& gained = scratch.pairs;
    gained.clear();
    for (std::size_t from = r + 1; from < runs; ++from) {
      const auto& all = foreign_[from];
      const auto begin = std::lower_bound(all.begin(), all.end(), static_cast<std::uint64_t>(run_start[r]) << 32);
      const auto end = std::lower_bound(begin, all.end(), static_cast<std::uint64_t>(run_start[r + 1]) << 32);
      gained.insert(gained.end(), begin, end);
    }
    std::sort(gained.begin(), gained.end());
    merge(gained, run_start[r], runs_[r]);
    if (repeats_) drop_repeats(runs_[r]);
  }
}

std::size_t CellSearch::memory_bytes() const {
  std::size_t bytes = (cell_start_.capacity() + cell_of_.capacity() + place_.capacity() + rank_.capacity()) * 4;
  bytes += (x_.capacity() + y_.capacity() + z_.capacity() + reach_.capacity()) * 8;
  for (const auto& r : runs_) bytes += (r.count.capacity() + r.partner.capacity()) * 4;
  for (const auto& f : foreign_) bytes += f.capacity() * 8;
  for (const auto& s : scratch_) bytes += s.pairs.capacity() * 8 + (s.next.capacity() + s.rows.capacity()) * 4;
  return bytes;
}

}  // namespace calx
