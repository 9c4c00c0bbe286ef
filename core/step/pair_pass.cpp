// pair_pass.cpp: contacts between spheres: search of touching pairs, block of columns, laws, scatter.
#include <tuple>
#include <type_traits>

#include "step/rest.hpp"

namespace calx {

template <class Precision>
void Engine::pair_pass(std::size_t c, Worker& w, double t, double dt) {
  constexpr bool mixed = std::is_same_v<Precision, InMixed>;
  const auto& kernels = [this]() -> const PairKernels<Precision>& {
    if constexpr (mixed)
      return kernels_->in_mixed;
    else
      return kernels_->in_double;
  }();
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  each_live(c, [this](std::uint32_t first, std::uint32_t last) {
    const std::uint32_t from = first_sphere_of(first), to = first_sphere_of(last);
    std::fill(sphere_wrench_.begin() + from, sphere_wrench_.begin() + to, Wrench{});
    if (mixed) std::fill(lean_wrench_.begin() + from, lean_wrench_.begin() + to, LeanWrench{});
  });
  const RestWalk* const walk = this->walk(c);
  const bool chooses = walk && !walk->whole;
  if (chooses)
    for (const std::size_t slot : walk->out_slots) pairs_.slot_used[slot] = 0;
  else
    std::fill(pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.first_slot),
              pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.last_slot), std::uint8_t{0});
  PairScan& scan = w.scan;
  scan.spheres = mixed ? static_cast<const void*>(lean_.data()) : particles.spheres();
  scan.sums = mixed ? static_cast<const void*>(lean_wrench_.data()) : sphere_wrench_.data();
  scan.i = pairs_.i.data();
  scan.j = pairs_.j.data();
  scan.touching = pairs_.touching.data();
  scan.history = pairs_.history.data();
  scan.width = history_.columns;
  scan.wrap = options.wrap.any() ? &options.wrap : nullptr;
  const bool reaches = largest_pair_gap_ > 0;
  scan.gaps = reaches ? pair_gaps_.data() : nullptr;
  scan.materials = material_count;
  scan.material = particles.material.data();
  scan.owner = particles.has_clumps ? particles.owner.data() : nullptr;
  scan.first_entry = scan.next_entry = chunk.first_entry;
  scan.last_entry = chunk.last_entry;
  scan.last_sphere = chunk.last_sphere;
  scan.crossed = 0;
  scan.chosen = scan.chosen_ordinal = nullptr;
  if (chooses) {
    result.touching += walk->pair_contacts;
    scan.i = walk->i.data();
    scan.j = walk->j.data();
    scan.chosen = walk->entry.data();
    scan.chosen_ordinal = walk->ordinal.data();
    scan.next_entry = 0;
    scan.last_entry = walk->count;
  }
  for (bool more = true; more;) {
    more = kernels.find(scan, w.found);
    if (!reaches) result.touching += w.found.count;
    if (w.found.count == 0) continue;
    auto list_of = [&](std::uint32_t row) -> const LawList& {
      return law(particles.material[particles.owner_of(w.found.i[row])],
                 particles.material[particles.owner_of(w.found.j[row])]);
    };
    // A new contact starts from what its law asks for.
    for (std::uint32_t k = 0; k < scan.started; ++k) {
      const LawList& list = list_of(scan.fresh[k]);
      double* history = pairs_.history.data() + (chunk.first_entry + w.found.entry[scan.fresh[k]]) * history_.columns;
      std::copy(list.preset.begin(), list.preset.end(), history);
    }
    if (uniform_) {
      const LawList& list = law(particles.material[0], particles.material[0]);
      const bool record = solve_pairs<Precision>(c, w, w.found, list, t, dt);
      take_pairs<Precision>(c, w.found, w.pair_work<Precision>(), record);
      continue;
    }
    // Rows of one law list at a time; then all rows together, so that sums have the order of the entries.
    auto& solved = w.pair_work<Precision>();
    auto& all = w.assembled<Precision>();
    for (std::uint32_t k = 0; k < w.found.count; ++k) w.list_of_row[k] = &list_of(k);
    for (const LawList* list : laws) {
      PairBlock& picked = w.picked;
      std::uint32_t n = 0;
      for (std::uint32_t k = 0; k < w.found.count; ++k) {
        picked.i[n] = w.found.i[k];
        picked.j[n] = w.found.j[k];
        picked.entry[n] = w.found.entry[k];
        w.row_of[n] = k;
        n += w.list_of_row[k] == list;
      }
      picked.count = n;
      if (n == 0) continue;
      picked.repeat_last_row();
      solve_pairs<Precision>(c, w, picked, *list, t, dt);
      solved.each_column(all, options.ledger, [&](const auto* from, auto* to) {
        for (std::uint32_t k = 0; k < n; ++k) to[w.row_of[k]] = from[k];
      });
    }
    take_pairs<Precision>(c, w.found, all, true);
  }
}

template <class Precision>
bool Engine::law_of_pairs(std::size_t c, Worker& w, const PairBlock& pairs, const LawList& list, double largest,
                          double t, double dt) {
  using Real = typename Precision::Real;
  const auto& [kernels, spheres] = [&] {
    if constexpr (std::is_same_v<Precision, InMixed>)
      return std::tie(kernels_->in_mixed, lean_);
    else
      return std::tie(kernels_->in_double, particles.has_clumps ? particles.member : particles.body);
  }();
  auto& work = w.pair_work<Precision>();
  BlockScratchOf<Real>& block = work.scratch;
  block.count = pairs.count;
  const bool spin = list.needs & 7u << CALX_IN_WX, radii = list.needs & 3u << CALX_IN_R_I;
  auto column = [&](int k, bool wanted) { return wanted ? block.in(k) : nullptr; };
  const PairColumns<Real> columns{block.in(CALX_IN_OVERLAP),
                                  block.in(CALX_IN_NX),
                                  block.in(CALX_IN_NY),
                                  block.in(CALX_IN_NZ),
                                  block.in(CALX_IN_VX),
                                  block.in(CALX_IN_VY),
                                  block.in(CALX_IN_VZ),
                                  column(CALX_IN_WX, spin),
                                  column(CALX_IN_WY, spin),
                                  column(CALX_IN_WZ, spin),
                                  block.in(CALX_IN_R_EFF),
                                  block.in(CALX_IN_M_EFF),
                                  column(CALX_IN_R_I, radii),
                                  column(CALX_IN_R_J, radii),
                                  work.arm_i,
                                  work.arm_j};
  const bool record =
      kernels.kinematics(spheres.data(), options.wrap.any() ? &options.wrap : nullptr, pairs, largest, columns);
  kernels.read_history(pairs_.history.data() + pairs_.chunks[c].first_entry * history_.columns, history_.columns, pairs,
                       list.state_count, block.state(0));
  evaluate_block(list, block, dt, t, options.ledger);
  return record;
}

template <class Precision>
bool Engine::solve_pairs(std::size_t c, Worker& w, const PairBlock& pairs, const LawList& list, double t, double dt) {
  const auto& kernels = [this]() -> const PairKernels<Precision>& {
    if constexpr (std::is_same_v<Precision, InMixed>)
      return kernels_->in_mixed;
    else
      return kernels_->in_double;
  }();
  // A little less than the largest share: the question there is asked without a division.
  const double largest = results_[c].largest_overlap * (1 - 1e-6);
  const bool record = law_of_pairs<Precision>(c, w, pairs, list, largest, t, dt);
  kernels.write_history(pairs_.history.data() + pairs_.chunks[c].first_entry * history_.columns, history_.columns,
                        pairs, list.state_count, w.pair_work<Precision>().scratch.state(0));
  return record;
}

template <class Precision>
void Engine::take_pairs(std::size_t c, const PairBlock& pairs, PairWork<Precision>& work, bool record) {
  const auto& [kernels, sums, slots] = [&] {
    if constexpr (std::is_same_v<Precision, InMixed>)
      return std::tie(kernels_->in_mixed, lean_wrench_, lean_slot_);
    else
      return std::tie(kernels_->in_double, sphere_wrench_, pairs_.slot_wrench);
  }();
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  auto& block = work.scratch;
  const std::uint32_t n = pairs.count;
  if (largest_pair_gap_ > 0) result.touching += touching_rows(block, n);
  for (std::uint32_t k = 0; record && k < n; ++k) {
    const double share = 0.5 * block.in(CALX_IN_OVERLAP)[k] / block.in(CALX_IN_R_EFF)[k];
    if (share <= result.largest_overlap) continue;
    result.largest_overlap = share;
    result.overlap_i = pairs.i[k];
    result.overlap_j = pairs.j[k];
  }
  kernels.scatter(pairs,
                  {block.in(CALX_IN_NX), block.in(CALX_IN_NY), block.in(CALX_IN_NZ), block.out(CALX_OUT_FX),
                   block.out(CALX_OUT_FY), block.out(CALX_OUT_FZ), block.out(CALX_OUT_MX), block.out(CALX_OUT_MY),
                   block.out(CALX_OUT_MZ), work.arm_i, work.arm_j, sums.data(), chunk.last_sphere,
                   pairs_.cross.data() + pairs_.first_cross[c], slots.data(), pairs_.slot_used.data()});
  if (!options.ledger) return;
  for (std::uint32_t k = 0; k < n; ++k) {
    const EnergySums row{block.out(CALX_OUT_ELASTIC)[k], block.out(CALX_OUT_FRICTION)[k],
                         block.out(CALX_OUT_DAMPING)[k], block.out(CALX_OUT_PLASTIC)[k]};
    result.energy.add((pairs.i[k] - chunk.first_sphere) / kSpan, row);
  }
}

template void Engine::pair_pass<InDouble>(std::size_t, Worker&, double, double);
template void Engine::pair_pass<InMixed>(std::size_t, Worker&, double, double);
template bool Engine::law_of_pairs<InDouble>(std::size_t, Worker&, const PairBlock&, const LawList&, double, double,
                                             double);
template bool Engine::law_of_pairs<InMixed>(std::size_t, Worker&, const PairBlock&, const LawList&, double, double,
                                            double);

}  // namespace calx
