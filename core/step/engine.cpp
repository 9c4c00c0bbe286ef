// engine.cpp: order of the passes of a step, and when neighbour lists are rebuilt.
#include "step/engine.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdio>

#include "base/error.hpp"
#include "step/on_device.hpp"
#include "step/rest.hpp"

namespace calx {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
/// Rebuilds between two reorderings along the Morton curve.
constexpr std::uint64_t kSortEvery = 10;

std::string format(const char* pattern, double a, double b, double c) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b, c);
  return text;
}

}  // namespace

Engine::Engine() = default;
Engine::~Engine() = default;

void Engine::prepare(int threads) {
  threads_ = std::max(1, threads);
  kernels_ = &step_kernels();
  particles.keeps_wrench = options.verlet;
  history_ = {};
  for (const LawList* list : laws)
    if (list && list->state_count > history_.columns) history_.columns = list->state_count;
  history_.materials = std::max(1u, material_count);
  history_.odd.assign(laws.size() * history_.columns, 0);
  for (std::size_t pair = 0; pair < laws.size(); ++pair)
    if (laws[pair]) std::copy(laws[pair]->odd.begin(), laws[pair]->odd.end(), &history_.odd[pair * history_.columns]);
  workers_.clear();
  for (int k = 0; k < threads_; ++k) workers_.push_back(std::make_unique<Worker>(history_.columns));
  rest_.reset();
  if (options.rest.on) rest_ = std::make_unique<Rest>();
  part_bounds_.clear();
  for (const auto& part : parts) part_bounds_.push_back(part.surface->bounds());
  stale_ = true;
}

bool Engine::one_material() const {
  const auto& m = particles.material;
  return std::all_of(m.begin(), m.end(), [&](std::uint32_t k) { return k == m[0]; });
}

int Engine::team() const { return std::max(1, std::min(threads_, static_cast<int>(pairs_.chunks.size()))); }

const LawList& Engine::law(std::uint32_t a, std::uint32_t b) const {
  const LawList* list = laws[a * material_count + b];
  if (!list) missing_law(a, b);
  return *list;
}

void Engine::missing_law(std::uint32_t a, std::uint32_t b) const {
  throw Error(Fault::settings, "/contacts: particles of \"" + material_names[a] + "\" touch \"" + material_names[b] +
                                   "\" but no law is given between them; add {\"between\": [\"" + material_names[a] +
                                   "\", \"" + material_names[b] + "\"], \"law\": ...}");
}

void Engine::inserted() {
  list_rank_.resize(particles.sphere_count(), kNone);
  reference_.resize(particles.sphere_count());
  if (rest_) rest_grow();
  if (device_) device_->particles_changed();
  stale_ = count_changed_ = true;
}

void Engine::edited() {
  if (particles.has_clumps) particles.refresh_members(0, particles.count());
  stale_ = true;
  if (device_) device_->particles_changed();
}

void Engine::remove(const std::vector<std::uint8_t>& mark, double dt) {
  fetch();
  if (rest_) rest_leave(mark, dt);
  Column<std::uint32_t> kept;
  for (std::size_t k = 0; k < particles.sphere_count(); ++k)
    if (!mark[particles.owner_of(k)]) kept.push_back(list_rank_[k]);
  list_rank_.swap(kept);
  particles.remove(mark);
  reference_.resize(particles.sphere_count());
  if (device_) device_->particles_changed();
  count_changed_ = true;
  rebuild(dt, true);
}

void Engine::place_parts(double dt, std::vector<PartPlace>& places) {
  places.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const EnginePart& part = parts[k];
    double speed = 0;
    if (part.moves) {
      const Box& b = part_bounds_[k];
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z};
        speed = std::max(speed, norm(part.pose.velocity_at(part.pose.to_world(p))));
      }
    }
    const double margin = part.moves ? std::clamp(kListSteps * dt * speed, smallest_margin_, largest_margin_) : 0;
    places[k] = {part.surface, part.pose.turn, part.pose.shift, margin, part.present};
  }
}

bool Engine::parts_left_margin() const {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const EnginePart& part = parts[k];
    const PartPlace& place = places_[k];
    if (part.present != place.present) return true;
    if (!part.moves || !part.present) continue;
    const Box& b = part_bounds_[k];
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p{corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z};
      const Vec3 moved = part.pose.to_world(p) - (place.shift + rotate(place.turn, p));
      if (norm2(moved) > place.margin * place.margin) return true;
    }
  }
  return false;
}

void Engine::wrap_positions() {
  // By spans, as sums of a chunk are.
  SpanSum<double> work;
  work.total = energy_.wrapped;
  for (std::size_t p = 0; p < particles.count(); ++p) {
    Record& b = particles.body[p];
    for (int k = 0; k < 3; ++k) {
      if (!options.wrap.periodic[static_cast<std::size_t>(k)]) continue;
      const double length = options.wrap.length[k];
      double& x = k == 0 ? b.x : k == 1 ? b.y : b.z;
      const double shift = x < options.wrap.lo[k] ? length : x >= options.wrap.lo[k] + length ? -length : 0;
      if (shift == 0) continue;
      x += shift;
      work.add(p / kSpan, b.m * options.gravity[k] * shift);
    }
  }
  energy_.wrapped = work.closed();
  if (particles.has_clumps) particles.refresh_members(0, particles.count());
}

// Two particles must not meet through two images at once, nor a particle itself; half a length is what the shortest
// image of a difference can tell apart while particles stand up to bound and margin outside the box.
void Engine::check_periodic_lengths() const {
  double bound = 0;
  for (const auto& b : particles.body) bound = std::max(bound, b.r);
  const double least = 4 * (bound + largest_margin_) + 2 * largest_pair_gap_;
  for (int k = 0; k < 3; ++k)
    if (options.wrap.periodic[static_cast<std::size_t>(k)] && options.wrap.length[k] < least)
      throw Error(Fault::settings, std::string("/domain: periodic along ") + "xyz"[k] +
                                       format(" over %.4g m; particles up to %.4g m across need at least %.4g m",
                                              options.wrap.length[k], 2 * bound, least));
}

// Beyond its own reach a law has no wrench and its history is as new, so that it shows nowhere that small spheres are
// looked at from as far as large ones.
void Engine::measure_gaps() {
  largest_pair_gap_ = largest_wall_gap_ = 0;
  pair_gaps_.assign(laws.size(), 0);
  wall_gaps_.assign(laws.size(), 0);
  if (std::none_of(laws.begin(), laws.end(), [](const LawList* list) { return list && list->reaches; })) return;
  std::vector<double> radius(material_count, 0);
  for (std::size_t k = 0; k < particles.sphere_count(); ++k) {
    double& largest = radius[particles.material[particles.owner_of(k)]];
    largest = std::max(largest, particles.spheres()[k].r);
  }
  for (std::uint32_t a = 0; a < material_count; ++a)
    for (std::uint32_t b = 0; b < material_count; ++b) {
      const LawList* list = laws[a * material_count + b];
      if (!list || !list->reaches || !(radius[a] > 0)) continue;
      const double on_part = wall_gaps_[a * material_count + b] = reach_of(*list, radius[a], 0);
      largest_wall_gap_ = std::max(largest_wall_gap_, on_part);
      if (!(radius[b] > 0)) continue;
      // A pair is found as (i, j) or (j, i).
      const double gap = reach_of(*list, radius[a], radius[b]);
      for (const std::uint32_t pair : {a * material_count + b, b * material_count + a})
        pair_gaps_[pair] = std::max(pair_gaps_[pair], gap);
      largest_pair_gap_ = std::max(largest_pair_gap_, gap);
    }
}

void Engine::rebuild(double dt, bool reorder) {
  if (rest_) rest_->listed = false;
  if (options.wrap.any() && !device_) wrap_positions();
  if (count_changed_) {
    double smallest = 1e300, largest = 0;
    const Record* s = particles.spheres();
    for (std::size_t k = 0; k < particles.sphere_count(); ++k) {
      smallest = std::min(smallest, s[k].r);
      largest = std::max(largest, s[k].r);
    }
    smallest_margin_ = options.skin > 0 ? options.skin : 0.1 * smallest;
    largest_margin_ = std::max(smallest, smallest_margin_);
    cell_ = 2 * (largest + smallest_margin_);
    measure_gaps();
    check_periodic_lengths();
    uniform_ = one_material();
  }
  if (reorder && particles.count() > 0) sorted_at_ = rebuilds_;
  place_parts(dt, places_);
  if (device_)
    device_->build_lists(dt, reorder);
  else
    build_lists(dt, reorder);
  ++rebuilds_;
  stale_ = count_changed_ = false;
  if (rest_) rest_relist(dt);
}

void Engine::build_lists(double dt, bool reorder) {
  const std::size_t spheres = particles.sphere_count();
  if (reorder && particles.count() > 0) {
    const auto order = morton_order(particles, cell_);
    Column<std::uint32_t> ranks;
    ranks.reserve(spheres);
    for (const auto k : order) {
      if (!particles.has_clumps) {
        ranks.push_back(list_rank_[k]);
        continue;
      }
      for (std::uint32_t m = particles.first_sphere[k]; m < particles.first_sphere[k + 1]; ++m)
        ranks.push_back(list_rank_[m]);
    }
    list_rank_.swap(ranks);
    particles.permute(order);
    if (rest_) rest_permute(order);
  }
  margin_.resize(particles.count());
  for (std::size_t p = 0; p < particles.count(); ++p)
    margin_[p] = std::clamp(kListSteps * dt * norm(velocity(particles.body[p])), smallest_margin_, largest_margin_);
  pairs_.build(particles, options.wrap, margin_, history_, list_rank_.data(), largest_pair_gap_);
  walls_.build(particles, pairs_, places_, margin_, 1, history_, list_rank_.data(), largest_wall_gap_);
  const Record* s = particles.spheres();
  for (std::uint32_t k = 0; k < spheres; ++k) {
    list_rank_[k] = k;
    reference_[k] = position(s[k]);
  }
  size_sums();
  set_haste();
  used_.assign(pairs_.chunks.size(), 0);
}

void Engine::size_sums() {
  const std::size_t spheres = particles.sphere_count();
  sphere_wrench_.resize(spheres);
  if (particles.has_clumps) sum_.resize(particles.count());
  results_.resize(pairs_.chunks.size());
  if (!options.mixed) return;
  lean_.resize(spheres);
  lean_wrench_.resize(spheres);
  lean_slot_.resize(pairs_.slot_wrench.size());
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) thin_pass(c);
}

void Engine::thin_pass(std::size_t c) {
  each_awake(c, [this](std::uint32_t first, std::uint32_t last) {
    const std::uint32_t from = first_sphere_of(first);
    kernels_->thin(particles.spheres() + from, first_sphere_of(last) - from, lean_.data() + from);
  });
}

void Engine::set_haste() {
  haste_.resize(particles.count());
  for (std::size_t p = 0; p < particles.count(); ++p)
    haste_[p] = static_cast<float>(1 / (margin_[p] * margin_[p])) * 1.000001f;
}

void Engine::rebuild_if_stale(double dt) {
  const double start = now_seconds();
  if (stale_) {
    rebuild(dt, count_changed_ || rebuilds_ - sorted_at_ >= kSortEvery);
  } else if (parts_left_margin()) {
    place_parts(dt, places_);
    if (device_)
      device_->build_walls(2);
    else
      walls_.build(particles, pairs_, places_, margin_, 2, history_, nullptr, largest_wall_gap_);
    if (rest_) rest_relist(dt);
  }
  times_.neighbour += now_seconds() - start;
}

void Engine::begin(double dt) {
  if (rest_) rest_watch_parts(dt);
  if (!options.verlet) return;
  if (stale_) rebuild(dt, count_changed_);
  const double start = now_seconds();
  for (auto& r : results_) r.gravity_work = {}, r.stale = false;
#pragma omp parallel for schedule(static) num_threads(team())
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) {
    drift_verlet(c, dt);
    if (options.mixed) thin_pass(c);
    guard_pass(c, dt);
  }
  for (auto& r : results_) {
    stale_ |= r.stale;
    energy_.gravity_work += r.gravity_work.closed();
    r.outside.clear();
  }
  times_.integrate += now_seconds() - start;
}

void Engine::step_on_host(double t, double dt, double& contacts_done) {
  const std::size_t chunk_count = pairs_.chunks.size();
  std::exception_ptr failure;
#pragma omp parallel num_threads(team())
  {
    Worker& worker = *workers_[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunk_count; ++c) {
      // Only a missing law throws; it must not leave the parallel region.
      try {
        if (options.mixed)
          pair_pass<InMixed>(c, worker, t, dt);
        else
          pair_pass<InDouble>(c, worker, t, dt);
        wall_pass(c, worker, t, dt);
      } catch (...) {
#pragma omp critical
        failure = std::current_exception();
      }
    }
#pragma omp single
    contacts_done = now_seconds();
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < chunk_count; ++c) {
      sum_pass(c);
      if (!forces.empty()) force_pass(c, worker, t, dt);
      if (options.verlet) {
        finish_verlet(c, dt);
        each_awake(c, [this](std::uint32_t first, std::uint32_t last) {
          std::copy(sums().begin() + first, sums().begin() + last, particles.wrench.begin() + first);
        });
      } else {
        integrate_euler(c, dt);
      }
      if (options.mixed) thin_pass(c);
      guard_pass(c, dt);
      if (rest_) rest_check_sleepers(c);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

GuardReport Engine::finish(double t, double dt) {
  omp_set_num_threads(threads_);
  time_ = t;
  if (rest_) rest_watch_parts(dt);
  rebuild_if_stale(dt);
  const double start = now_seconds();
  for (auto& r : results_) {
    r.energy = {};
    r.wall_work = {};
    r.force_work = {};
    r.kinetic_translation = r.kinetic_rotation = r.gravity = r.gravity_work = {};
    r.largest_overlap = 0;
    r.touching = 0;
    r.stale = r.bad = false;
    r.outside.clear();
  }
  double contacts_done = start;
  step_on_host(t, dt, contacts_done);
  times_.contacts += contacts_done - start;

  energy_.kinetic_translation = energy_.kinetic_rotation = energy_.gravity = energy_.elastic = 0;
  touching_ = 0;
  worst_ = {};
  std::vector<Wrench> load(parts.size());
  for (auto& r : results_) {
    energy_.kinetic_translation += r.kinetic_translation.closed();
    energy_.kinetic_rotation += r.kinetic_rotation.closed();
    energy_.gravity += r.gravity.closed();
    energy_.elastic += r.energy.total.elastic;
    energy_.friction += r.energy.total.friction;
    energy_.damping += r.energy.total.damping;
    energy_.plastic += r.energy.total.plastic;
    energy_.wall_work += r.wall_work.total;
    energy_.force_work += r.force_work.closed();
    energy_.gravity_work += r.gravity_work.closed();
    touching_ += r.touching;
    stale_ |= r.stale;
    if (r.largest_overlap > worst_.overlap) worst_ = {r.largest_overlap, r.overlap_i, r.overlap_j};
    for (std::size_t k = 0; k < load.size(); ++k) {
      load[k] += r.load[k];
    }
  }
  energy_.gravity += energy_.wrapped;
  if (rest_) rest_update(dt);
  for (std::size_t k = 0; k < load.size(); ++k) {
    parts[k].force = {load[k].fx, load[k].fy, load[k].fz};
    parts[k].torque = {load[k].tx, load[k].ty, load[k].tz};
  }
  largest_overlap_ = std::max(largest_overlap_, worst_.overlap);
  times_.integrate += now_seconds() - contacts_done;
  return guard_report(worst_);
}

/// What the guards of all chunks have found, and the largest overlap where it is beyond the limit.
GuardReport Engine::guard_report(const Worst& worst) const {
  GuardReport report;
  for (const auto& r : results_) {
    report.outside.insert(report.outside.end(), r.outside.begin(), r.outside.end());
    if (!r.bad || !report.message.empty()) continue;
    const std::uint32_t p = r.bad_particle, sphere = particles.has_clumps ? particles.first_sphere[p] : p;
    report.message = "non-finite motion of particle " + std::to_string(particles.id[p]) + ": " +
                     bad_motion(particles.body[p], reference_[sphere]) +
                     "; the time step is too large or a law returned a non-finite force";
  }
  if (!report.message.empty() || !(worst.overlap > options.overlap_limit)) return report;
  const std::uint32_t i = worst.i, j = worst.j;
  const Record& b = particles.spheres()[i];
  const bool wall = ~j < parts.size() && j >= particles.sphere_count();
  report.message = "overlap of " + format("%.3g of the radius at (%.4g, %.4g, ", worst.overlap, b.x, b.y) +
                   format("%.4g) m", b.z, 0, 0) + ", particle " + std::to_string(particles.id[particles.owner_of(i)]) +
                   (wall ? " with part \"" + parts[~j].name + "\""
                         : " with particle " + std::to_string(particles.id[particles.owner_of(j)])) +
                   format(
                       "; the limit is %.3g (\"overlap_limit\"): a time step too large, too soft a material, or a "
                       "particle squeezed between parts",
                       options.overlap_limit, 0, 0);
  return report;
}

std::vector<Engine::Touch> Engine::touches() const {
  fetch();
  pairs();  // brings both lists
  std::vector<Touch> out;
  const Record* s = particles.spheres();
  for (std::size_t e = 0; e < pairs_.entry_count(); ++e) {
    const std::uint32_t i = pairs_.i[e], j = pairs_.j[e];
    const Vec3 d = options.wrap.nearest(position(s[i]) - position(s[j]));
    const double distance = norm(d), overlap = s[i].r + s[j].r - distance;
    if (overlap > 0) out.push_back({i, j, -1, d / distance, overlap});
  }
  for (std::size_t row = 0; row < walls_.row_count(); ++row) {
    const EnginePart& part = parts[walls_.part[row]];
    const Record& a = s[walls_.sphere[row]];
    SurfacePoint found[kWallContacts];
    const std::uint32_t first = walls_.first_element[row];
    const std::size_t n = part.surface->closest(part.pose.to_part(position(a)), a.r, walls_.elements.data() + first,
                                                walls_.first_element[row + 1] - first, found, kWallContacts);
    for (std::size_t k = 0; k < n; ++k)
      out.push_back({walls_.sphere[row], 0, static_cast<int>(walls_.part[row]), rotate(part.pose.turn, found[k].normal),
                     a.r - found[k].distance});
  }
  return out;
}

std::size_t Engine::memory_bytes() const {
  const Particles& p = particles;
  std::size_t bytes = pairs_.memory_bytes() + walls_.memory_bytes();
  bytes += (p.body.capacity() + p.member.capacity()) * sizeof(Record) + p.turn.capacity() * sizeof(Quat);
  bytes +=
      lean_.capacity() * sizeof(LeanRecord) + (lean_wrench_.capacity() + lean_slot_.capacity()) * sizeof(LeanWrench);
  bytes += (p.wrench.capacity() + sphere_wrench_.capacity() + sum_.capacity()) * sizeof(Wrench);
  bytes += (p.id.capacity() + p.shape.capacity() + p.material.capacity() + p.first_sphere.capacity() +
            p.owner.capacity() + p.sphere_id.capacity() + list_rank_.capacity()) *
           4;
  if (rest_) bytes += rest_->memory_bytes();
  if (device_) bytes += device_->memory_bytes();
  return bytes + p.scale.capacity() * 8 + margin_.capacity() * 8 + haste_.capacity() * 4 +
         reference_.capacity() * sizeof(Vec3);
}

}  // namespace calx
