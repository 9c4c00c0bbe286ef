// rest_change.cpp: what follows when particles fall asleep or wake: who else wakes, the wrenches sleepers keep, and the
// lists of what a step has still to visit.
//
// Particles of a chunk are touched by entries of that chunk and of those that send to it; only these are gone through.
#include <omp.h>

#include <algorithm>
#include <type_traits>

#include "step/rest.hpp"

namespace calx {

void Engine::rest_near(const std::vector<std::uint32_t>& some) {
  Rest& rest = *rest_;
  rest.near.assign(pairs_.chunks.size(), 0);
  const std::uint32_t length = pairs_.chunks[0].last_particle;
  for (const std::uint32_t p : some) rest.near[p / length] = 2;
  for (std::size_t c = 0; c < rest.near.size(); ++c)
    if (rest.near[c] == 2)
      for (const std::uint32_t sender : rest.walks[c].senders) rest.near[sender] |= 1;
}

void Engine::rest_change(std::vector<std::uint32_t>& wake, const std::vector<std::uint32_t>& sleep,
                         const std::vector<std::uint32_t>& touched, double dt) {
  Rest& rest = *rest_;
  const std::size_t chunks = pairs_.chunks.size();
  const auto each_touch = [&](std::size_t c, const auto& visit) {
    for (std::size_t e = pairs_.chunks[c].first_entry; e < pairs_.chunks[c].last_entry; ++e)
      if (pairs_.touching[e]) visit(particles.owner_of(pairs_.i[e]), particles.owner_of(pairs_.j[e]));
  };
  // Appends the sleepers that touch one that changed, each once and only those not yet marked, and marks them. changed:
  // near these such contacts may stand.
  const auto gather = [&](const std::vector<std::uint32_t>& changed, std::vector<std::uint32_t>& to,
                          std::uint8_t mark) {
    rest_near(changed);
#pragma omp parallel for schedule(dynamic, 1) num_threads(team())
    for (std::size_t c = 0; c < chunks; ++c) {
      if (!rest.near[c]) continue;
      auto& found = rest.walks[c].found;
      found.clear();
      each_touch(c, [&](std::uint32_t a, std::uint32_t b) {
        if (rest.mark[a] & Rest::changed && rest.asleep[b]) found.push_back(b);
        if (rest.mark[b] & Rest::changed && rest.asleep[a]) found.push_back(a);
      });
    }
    for (std::size_t c = 0; c < chunks; ++c) {
      if (!rest.near[c]) continue;
      for (const std::uint32_t p : rest.walks[c].found) {
        if (rest.mark[p] & mark) continue;
        rest.mark[p] |= mark;
        to.push_back(p);
      }
    }
  };

  // Whoever touches one that wakes wakes too.
  for (const std::uint32_t p : wake) rest.mark[p] = Rest::changed;
  if (!wake.empty()) {
    const std::vector<std::uint32_t> first = wake;
    gather(first, wake, Rest::changed);
  }
  for (const std::uint32_t p : wake) {
    rest.asleep[p] = rest.quiet[p] = 0;
    rest.reference[p] = position(particles.body[p]);
    if (options.verlet) {
      Vec3 torque;
      const Vec3 force = rest_unbalanced(p, torque) - particles.body[p].m * options.gravity;
      particles.wrench[p] = wrench_of(force, torque);
    }
  }
  for (const std::uint32_t p : sleep) {
    rest.mark[p] = Rest::changed;
    rest.asleep[p] = 1;
    energy_.damping += particles.kinetic_energy(p);
    Record& b = particles.body[p];
    b.vx = b.vy = b.vz = b.wx = b.wy = b.wz = 0;
  }
  rest.sleepers += sleep.size();
  rest.sleepers -= wake.size();
  std::vector<std::uint32_t> all = wake;
  all.insert(all.end(), sleep.begin(), sleep.end());
  for (const std::uint32_t p : all) {
    if (particles.has_clumps) particles.refresh_members(p, p + 1);
    const std::uint32_t first = first_sphere_of(p);
    if (options.mixed)
      kernels_->thin(particles.spheres() + first, first_sphere_of(p + 1) - first, lean_.data() + first);
  }

  // The sums of all sleepers that touch one that changed are taken anew.
  std::vector<std::uint32_t> affected;
  const auto add = [&](std::uint32_t p) {
    if (rest.mark[p] & Rest::affected || !rest.asleep[p]) return;
    rest.mark[p] |= Rest::affected;
    affected.push_back(p);
  };
  for (const std::uint32_t p : sleep) add(p);
  for (const std::uint32_t p : touched) add(p);
  gather(all, affected, Rest::affected);
  std::vector<std::uint8_t> stale = rest.near;
  if (!rest.listed) stale.assign(chunks, 1);
  if (rest.sleepers > 0) rest_capture(affected, all, dt);
  for (const std::uint32_t p : all) rest.mark[p] = 0;
  for (const std::uint32_t p : affected) rest.mark[p] = 0;
  rest.listed = rest.sleepers > 0;
  if (!rest.listed) return;
#pragma omp parallel num_threads(team())
  {
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunks; ++c)
      if (stale[c]) rest_entries(c);
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunks; ++c) rest_runs(c);
  }
}

bool Engine::nearer_than(std::size_t e, double gap) const {
  const Record &a = particles.spheres()[pairs_.i[e]], &b = particles.spheres()[pairs_.j[e]];
  const double limit = a.r + b.r + gap;
  return norm2(options.wrap.nearest(position(a) - position(b))) < limit * limit;
}

void Engine::rest_capture(const std::vector<std::uint32_t>& some, const std::vector<std::uint32_t>& changed,
                          double dt) {
  Rest& rest = *rest_;
  for (const std::uint32_t p : some) {
    rest.frozen[p] = {};
    rest.elastic[p] = 0;
  }
  rest_near(some);
  const std::uint32_t length = pairs_.chunks[0].last_particle;
  for (const std::uint32_t p : changed) rest.near[p / length] = 2;
  if (!rest.listed) rest.near.assign(pairs_.chunks.size(), 2);
#pragma omp parallel for schedule(dynamic, 1) num_threads(team())
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c)
    if (rest.near[c]) rest_capture_pairs(c, *workers_[static_cast<std::size_t>(omp_get_thread_num())], dt);
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) {
    if (!rest.near[c]) continue;
    for (const RestWalk::Share& share : rest.walks[c].shares) {
      rest.frozen[share.particle] += share.wrench;
      rest.elastic[share.particle] += share.elastic;
    }
  }
#pragma omp parallel for schedule(dynamic, 1) num_threads(team())
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c)
    if (rest.near[c] == 2) rest_capture_walls(c, *workers_[static_cast<std::size_t>(omp_get_thread_num())], dt);
}

template <class Precision>
void Engine::rest_take_pairs(std::size_t c, Worker& w, const LawList& list, double dt) {
  const PairBlock& block = w.picked;
  law_of_pairs<Precision>(c, w, block, list, 1e300, time_, dt);
  auto& work = w.pair_work<Precision>();
  auto& out = work.scratch;
  const Record* s = particles.spheres();
  RestWalk& walk = rest_->walks[c];
  const auto give = [&](std::uint32_t sphere, const Vec3& f, const Vec3& m, double elastic) {
    const std::uint32_t p = particles.owner_of(sphere);
    if (!(rest_->mark[p] & Rest::affected)) return;
    const Vec3 t = particles.has_clumps ? m + cross(position(s[sphere]) - position(particles.body[p]), f) : m;
    walk.shares.push_back({p, wrench_of(f, t), elastic});
  };
  for (std::uint32_t k = 0; k < block.count; ++k) {
    const Vec3 n{out.in(CALX_IN_NX)[k], out.in(CALX_IN_NY)[k], out.in(CALX_IN_NZ)[k]};
    const Vec3 f{out.out(CALX_OUT_FX)[k], out.out(CALX_OUT_FY)[k], out.out(CALX_OUT_FZ)[k]};
    const Vec3 m{out.out(CALX_OUT_MX)[k], out.out(CALX_OUT_MY)[k], out.out(CALX_OUT_MZ)[k]};
    const Vec3 turning = cross(n, f);
    give(block.i[k], f, m - work.arm_i[k] * turning, options.ledger ? out.out(CALX_OUT_ELASTIC)[k] : 0);
    give(block.j[k], -f, -(m + work.arm_j[k] * turning), 0);
  }
}

// Contacts between sleepers of which one at least is affected, evaluated with history read only.
void Engine::rest_capture_pairs(std::size_t c, Worker& w, double dt) {
  const Rest& rest = *rest_;
  const Chunk& chunk = pairs_.chunks[c];
  rest_->walks[c].shares.clear();
  PairBlock& block = w.picked;
  const LawList* list = nullptr;
  block.count = 0;
  const auto flush = [&] {
    if (block.count == 0) return;
    block.repeat_last_row();
    if (options.mixed)
      rest_take_pairs<InMixed>(c, w, *list, dt);
    else
      rest_take_pairs<InDouble>(c, w, *list, dt);
    block.count = 0;
  };
  for (std::size_t e = chunk.first_entry; e < chunk.last_entry; ++e) {
    if (!pairs_.touching[e]) continue;
    const std::uint32_t i = pairs_.i[e], j = pairs_.j[e], a = particles.owner_of(i), b = particles.owner_of(j);
    if (!((rest.mark[a] | rest.mark[b]) & Rest::affected) || !rest.asleep[a] || !rest.asleep[b]) continue;
    if (!nearer_than(e, pair_gaps_[particles.material[a] * material_count + particles.material[b]])) continue;
    const LawList& own = law(particles.material[a], particles.material[b]);
    if (block.count == kBlockRows || &own != list) flush();
    list = &own;
    const std::uint32_t n = block.count++;
    block.i[n] = i;
    block.j[n] = j;
    block.entry[n] = static_cast<std::uint32_t>(e - chunk.first_entry);
  }
  flush();
}

void Engine::rest_capture_walls(std::size_t c, Worker& w, double dt) {
  RestWalk& walk = rest_->walks[c];
  walk.load.assign(parts.size(), Wrench{});
  walk.wall_elastic = 0;
  walk.wall_contacts = 0;
  wall_pass(c, w, time_, dt, true);
}

void Engine::rest_take_walls(std::size_t c, Worker& w, std::uint32_t n) {
  RestWalk& walk = rest_->walks[c];
  BlockScratch& block = w.in_double.scratch;
  walk.wall_contacts += touching_rows(block, n);
  for (std::uint32_t k = 0; k < n; ++k) {
    if (options.ledger) walk.wall_elastic += block.out(CALX_OUT_ELASTIC)[k];
    Wrench on_sphere;
    add_wall_contact(w, k, on_sphere, walk.load[w.wall_part[k]]);
    const std::uint32_t sphere = w.wall_sphere[k], p = particles.owner_of(sphere);
    if (!(rest_->mark[p] & Rest::affected)) continue;
    const Vec3 f = force_of(on_sphere);
    Vec3 t = torque_of(on_sphere);
    if (particles.has_clumps) t += cross(position(particles.member[sphere]) - position(particles.body[p]), f);
    rest_->frozen[p] += wrench_of(f, t);
  }
}

// Entries that are left: all but those between sleepers.
void Engine::rest_entries(std::size_t c) {
  const Chunk& chunk = pairs_.chunks[c];
  const auto& asleep = rest_->asleep;
  RestWalk& walk = rest_->walks[c];
  walk.i.clear();
  walk.j.clear();
  walk.entry.clear();
  walk.ordinal.clear();
  walk.out_slots.clear();
  walk.pair_contacts = 0;
  std::fill(pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.first_slot),
            pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.last_slot), std::uint8_t{0});
  std::fill(rest_->open.begin() + static_cast<std::ptrdiff_t>(chunk.first_slot),
            rest_->open.begin() + static_cast<std::ptrdiff_t>(chunk.last_slot), std::uint8_t{0});
  std::uint32_t crossed = 0;
  for (std::size_t e = chunk.first_entry; e < chunk.last_entry; ++e) {
    const std::uint32_t i = pairs_.i[e], j = pairs_.j[e];
    const bool leaves = j >= chunk.last_sphere;
    if (asleep[particles.owner_of(i)] && asleep[particles.owner_of(j)]) {
      walk.pair_contacts += pairs_.touching[e] && (largest_pair_gap_ == 0 || nearer_than(e, 0));
    } else {
      walk.i.push_back(i);
      walk.j.push_back(j);
      walk.entry.push_back(static_cast<std::uint32_t>(e - chunk.first_entry));
      walk.ordinal.push_back(crossed);
      if (leaves) walk.out_slots.push_back(pairs_.cross[pairs_.first_cross[c] + crossed]);
    }
    crossed += leaves;
  }
  walk.count = walk.i.size();
  walk.whole = walk.count == chunk.last_entry - chunk.first_entry;
  for (auto* list : {&walk.i, &walk.j, &walk.entry, &walk.ordinal}) list->resize(walk.count + 3, 0);
  for (const std::size_t slot : walk.out_slots) rest_->open[slot] = 1;
}

// Runs of particles that are awake or reached, once the entries of all chunks are known.
void Engine::rest_runs(std::size_t c) {
  Rest& rest = *rest_;
  const Chunk& chunk = pairs_.chunks[c];
  RestWalk& walk = rest.walks[c];
  std::vector<std::uint8_t>& live = walk.reached;
  live.assign(chunk.last_particle - chunk.first_particle, forces.empty() ? 0 : 1);
  const auto reach = [&](std::uint32_t sphere) { live[particles.owner_of(sphere) - chunk.first_particle] = 1; };
  walk.in_slots.clear();
  for (const auto& in : chunk.incoming)
    for (std::size_t slot = in.first; slot < in.last; ++slot) {
      if (!rest.open[slot]) continue;
      walk.in_slots.push_back(slot);
      reach(pairs_.slot_sphere[slot]);
    }
  for (std::size_t k = 0; k < walk.count; ++k) {
    reach(walk.i[k]);
    if (walk.j[k] < chunk.last_sphere) reach(walk.j[k]);
  }
  for (std::size_t row = walls_.first_row[c]; rest.parts_move && row < walls_.first_row[c + 1]; ++row)
    if (rest.parts[walls_.part[row]].moving) reach(walls_.sphere[row]);
  walk.awake.clear();
  walk.live.clear();
  walk.border.clear();
  const auto append = [](std::vector<RestWalk::Run>& runs, std::uint32_t p) {
    if (!runs.empty() && runs.back().last == p)
      ++runs.back().last;
    else
      runs.push_back({p, p + 1});
  };
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    const bool asleep = rest.asleep[p], reached = live[p - chunk.first_particle];
    if (!asleep) append(walk.awake, p);
    if (!asleep || reached) append(walk.live, p);
    if (asleep && reached) walk.border.push_back(p);
    if (asleep && !reached) {
      sums()[p] = {};
      for (std::uint32_t k = first_sphere_of(p); k < first_sphere_of(p + 1); ++k) sphere_wrench_[k] = {};
    }
  }
}

void Engine::rest_relist(double dt) {
  Rest& rest = *rest_;
  rest_grow();
  const std::size_t chunks = pairs_.chunks.size();
  rest.walks.resize(chunks);
  rest.open.assign(pairs_.slot_used.size(), 0);
  for (RestWalk& walk : rest.walks) {
    walk.senders.clear();
    walk.found.clear();
  }
  rest.sleepers = 0;
  for (const std::uint8_t asleep : rest.asleep) rest.sleepers += asleep;
  for (std::uint32_t c = 0; c < chunks; ++c)
    for (const auto& in : pairs_.chunks[c].incoming) {
      const auto after = std::upper_bound(pairs_.chunks.begin(), pairs_.chunks.end(), in.first,
                                          [](std::size_t slot, const Chunk& k) { return slot < k.last_slot; });
      rest.walks[c].senders.push_back(static_cast<std::uint32_t>(after - pairs_.chunks.begin()));
    }
  rest.listed = rest.sleepers > 0;
  if (!rest.listed) return;
#pragma omp parallel num_threads(team())
  {
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunks; ++c) {
      rest_entries(c);
      rest_capture_walls(c, *workers_[static_cast<std::size_t>(omp_get_thread_num())], dt);
    }
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunks; ++c) rest_runs(c);
  }
}

}  // namespace calx
