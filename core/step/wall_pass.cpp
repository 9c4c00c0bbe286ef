// wall_pass.cpp: contacts between spheres and parts, by the same laws.
#include "step/rest.hpp"

namespace calx {
namespace {

/// A contact keeps its history while its normal turns by less than about 45 degrees in one step.
constexpr double kSameContact = 0.7;

}  // namespace

void Engine::wall_pass(std::size_t c, Worker& w, double t, double dt, bool capture) {
  ChunkResult& result = results_[c];
  const RestWalk* const rest = capture ? &rest_->walks[c] : walk(c);
  if (!capture) {
    result.energy.close();  // of the pairs
    result.load_span = 0;
    result.span_load.assign(parts.size(), Wrench{});
    if (rest) {
      result.load = rest->load;
      result.touching += rest->wall_contacts;
      if (rest->awake.empty() && !rest_->parts_move) return;
    } else {
      result.load.assign(parts.size(), Wrench{});
    }
  }
  const Record* s = particles.spheres();
  BlockScratch& block = w.in_double.scratch;
  w.wall_count = 0;
  w.wall_law = nullptr;
  for (std::size_t row = walls_.first_row[c]; row < walls_.first_row[c + 1]; ++row) {
    const std::uint32_t sphere = walls_.sphere[row], part_number = walls_.part[row];
    const EnginePart& part = parts[part_number];
    if (rest && capture != (rest_->asleep[particles.owner_of(sphere)] && !rest_->parts[part_number].moving)) continue;
    const Record& a = s[sphere];
    const Vec3 centre = position(a);
    const Vec3 local = part.pose.to_part(centre);
    SurfacePoint* found = w.found_points;
    const std::uint32_t first = walls_.first_element[row];
    const double gap = largest_wall_gap_ > 0
                           ? wall_gaps_[particles.material[particles.owner_of(sphere)] * material_count + part.material]
                           : 0;
    const std::size_t count = part.surface->closest(local, a.r + gap, walls_.elements.data() + first,
                                                    walls_.first_element[row + 1] - first, found, kWallContacts);
    const std::size_t slot0 = row * kWallContacts;
    std::uint8_t* touch = walls_.touching.data() + slot0;
    if (count == 0) {
      for (std::uint32_t k = 0; k < kWallContacts && !capture; ++k) touch[k] = 0;
      continue;
    }
    // Each contact takes the slot whose normal of the last step is nearest; what is left over starts afresh.
    int slot_of[kWallContacts];
    bool taken[kWallContacts] = {false, false, false, false};
    for (std::size_t k = 0; k < count; ++k) {
      slot_of[k] = -1;
      double best = kSameContact;
      for (std::uint32_t m = 0; m < kWallContacts; ++m) {
        if (!touch[m] || taken[m]) continue;
        const double alike = dot(walls_.normal[slot0 + m], found[k].normal);
        if (alike > best) {
          best = alike;
          slot_of[k] = static_cast<int>(m);
        }
      }
      if (slot_of[k] >= 0) taken[slot_of[k]] = true;
    }
    for (std::uint32_t m = 0; m < kWallContacts && !capture; ++m)
      if (!taken[m]) touch[m] = 0;
    for (std::size_t k = 0; k < count && !capture; ++k) {
      if (slot_of[k] < 0)
        for (int m = 0; m < static_cast<int>(kWallContacts); ++m)
          if (!taken[m]) {
            slot_of[k] = m;
            taken[m] = true;
            break;
          }
      walls_.normal[slot0 + static_cast<std::size_t>(slot_of[k])] = found[k].normal;
    }
    const LawList& list = law(particles.material[particles.owner_of(sphere)], part.material);
    for (std::size_t k = 0; k < count; ++k) {
      if (slot_of[k] < 0) continue;
      if (w.wall_count > 0 && (w.wall_count == kBlockRows || w.wall_law != &list))
        evaluate_walls(c, w, *w.wall_law, t, dt, capture);
      w.wall_law = &list;
      const std::uint32_t n = w.wall_count++;
      const Vec3 normal = rotate(part.pose.turn, found[k].normal);
      const double overlap = a.r - found[k].distance;
      const Vec3 arm = -found[k].distance * normal;
      const Vec3 point = centre + arm;
      const Vec3 wall = part.pose.velocity_at(point);
      const Vec3 v = velocity(a) + cross(spin(a), arm) - wall, spin_relative = spin(a) - part.pose.spin;
      w.wall_sphere[n] = sphere;
      w.wall_part[n] = part_number;
      w.wall_slot[n] = slot0 + static_cast<std::size_t>(slot_of[k]);
      w.wall_arm[n] = arm;
      w.wall_lever[n] = point - part.pose.centre;
      w.wall_velocity[n] = wall;
      w.wall_spin[n] = part.pose.spin;
      block.in(CALX_IN_OVERLAP)[n] = overlap;
      block.in(CALX_IN_NX)[n] = normal.x;
      block.in(CALX_IN_NY)[n] = normal.y;
      block.in(CALX_IN_NZ)[n] = normal.z;
      block.in(CALX_IN_VX)[n] = v.x;
      block.in(CALX_IN_VY)[n] = v.y;
      block.in(CALX_IN_VZ)[n] = v.z;
      block.in(CALX_IN_WX)[n] = spin_relative.x;
      block.in(CALX_IN_WY)[n] = spin_relative.y;
      block.in(CALX_IN_WZ)[n] = spin_relative.z;
      block.in(CALX_IN_R_EFF)[n] = a.r;
      block.in(CALX_IN_M_EFF)[n] = a.m;
      block.in(CALX_IN_R_I)[n] = a.r;
      block.in(CALX_IN_R_J)[n] = 0;
      if (!capture && overlap / a.r > result.largest_overlap) {
        result.largest_overlap = overlap / a.r;
        result.overlap_i = sphere;
        result.overlap_j = ~part_number;
      }
    }
  }
  if (w.wall_count > 0) evaluate_walls(c, w, *w.wall_law, t, dt, capture);
  if (capture) return;
  result.energy.close();
  result.wall_work.close();
  close_load_span(result);
}

void Engine::close_load_span(ChunkResult& result) {
  for (std::size_t k = 0; k < result.load.size(); ++k) result.load[k] += result.span_load[k];
  result.span_load.assign(result.span_load.size(), Wrench{});
}

/// Adds what row k of the wall block does to its sphere and to its part.
void Engine::add_wall_contact(Worker& w, std::uint32_t k, Wrench& sphere, Wrench& load) const {
  BlockScratch& block = w.in_double.scratch;
  const Vec3 f{block.out(CALX_OUT_FX)[k], block.out(CALX_OUT_FY)[k], block.out(CALX_OUT_FZ)[k]};
  const Vec3 m{block.out(CALX_OUT_MX)[k], block.out(CALX_OUT_MY)[k], block.out(CALX_OUT_MZ)[k]};
  const Vec3 on_i = cross(w.wall_arm[k], f) + m, on_part = cross(w.wall_lever[k], f) + m;
  sphere += wrench_of(f, on_i);
  load += wrench_of(-f, -on_part);
}

void Engine::evaluate_walls(std::size_t c, Worker& w, const LawList& list, double t, double dt, bool capture) {
  ChunkResult& result = results_[c];
  BlockScratch& block = w.in_double.scratch;
  const std::uint32_t n = w.wall_count;
  w.wall_count = 0;
  block.count = n;
  if (!capture) result.touching += touching_rows(block, n);
  for (std::uint32_t h = 0; h < list.state_count; ++h) {
    const double* column = walls_.history.data() + h * walls_.stride;
    double* state = block.state(h);
    for (std::uint32_t k = 0; k < n; ++k)
      state[k] = walls_.touching[w.wall_slot[k]] ? column[w.wall_slot[k]] : list.preset[h];
  }
  if (capture) {
    evaluate_block(list, block, dt, t, options.ledger);
    rest_take_walls(c, w, n);
    return;
  }
  for (std::uint32_t k = 0; k < n; ++k) walls_.touching[w.wall_slot[k]] = 1;
  evaluate_block(list, block, dt, t, options.ledger);
  for (std::uint32_t h = 0; h < list.state_count; ++h) {
    double* column = walls_.history.data() + h * walls_.stride;
    const double* state = block.state(h);
    for (std::uint32_t k = 0; k < n; ++k) column[w.wall_slot[k]] = state[k];
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::size_t span = (w.wall_sphere[k] - pairs_.chunks[c].first_sphere) / kSpan;
    if (span != result.load_span) close_load_span(result);
    result.load_span = span;
    add_wall_contact(w, k, sphere_wrench_[w.wall_sphere[k]], result.span_load[w.wall_part[k]]);
    const Vec3 f{block.out(CALX_OUT_FX)[k], block.out(CALX_OUT_FY)[k], block.out(CALX_OUT_FZ)[k]};
    const Vec3 m{block.out(CALX_OUT_MX)[k], block.out(CALX_OUT_MY)[k], block.out(CALX_OUT_MZ)[k]};
    result.wall_work.add(span, (dot(f, w.wall_velocity[k]) + dot(m, w.wall_spin[k])) * dt);
    if (!options.ledger) continue;
    result.energy.add(span, {block.out(CALX_OUT_ELASTIC)[k], block.out(CALX_OUT_FRICTION)[k],
                             block.out(CALX_OUT_DAMPING)[k], block.out(CALX_OUT_PLASTIC)[k]});
  }
}

}  // namespace calx
