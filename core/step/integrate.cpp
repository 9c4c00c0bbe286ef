// integrate.cpp: sums of wrenches per particle, particle forces, and the two integrators.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "step/rest.hpp"

namespace calx {
namespace {

/// Angular momentum from spin, and back, world frame; i: principal moments.
Vec3 momentum(const Quat& q, const Vec3& i, const Vec3& w) {
  const Vec3 b = rotate(conjugate(q), w);
  return rotate(q, {i.x * b.x, i.y * b.y, i.z * b.z});
}
Vec3 spin_of(const Quat& q, const Vec3& i, const Vec3& l) {
  const Vec3 b = rotate(conjugate(q), l);
  return rotate(q, {b.x / i.x, b.y / i.y, b.z / i.z});
}

/// A place, speed or spin beyond this is no number any more, SI units.
constexpr double kHuge = 1e30;

/// Energies of rotation before and after a turn, J.
struct TurnSums {
  double before = 0, after = 0;
  TurnSums& operator+=(const TurnSums& b) { return before += b.before, after += b.after, *this; }
};

/// turn_bodies for particles first .. last; wrench: their torques. chunk_first: first particle of the chunk.
void turn_particles(const StepKernels& kernels, Particles& p, const Column<Wrench>& wrench, std::uint32_t chunk_first,
                    std::uint32_t first, std::uint32_t last, double dt, double kick, double late_kick,
                    SpanSum<TurnSums>& energy) {
  TurnTile t;
  for (std::uint32_t start = first; start < last; start += kTurnRows) {
    const std::uint32_t n = std::min(kTurnRows, last - start);
    for (std::uint32_t k = 0; k < n; ++k) {
      const Record& b = p.body[start + k];
      const Quat& q = p.turn[start + k];
      const Wrench& w = wrench[start + k];
      const Vec3 i = p.inertia(start + k);
      t.qw[k] = q.w;
      t.qx[k] = q.x;
      t.qy[k] = q.y;
      t.qz[k] = q.z;
      t.wx[k] = b.wx;
      t.wy[k] = b.wy;
      t.wz[k] = b.wz;
      t.tx[k] = w.tx;
      t.ty[k] = w.ty;
      t.tz[k] = w.tz;
      t.ix[k] = i.x;
      t.iy[k] = i.y;
      t.iz[k] = i.z;
    }
    kernels.turn_bodies(n, t, dt, kick, late_kick);
    for (std::uint32_t k = 0; k < n; ++k) {
      p.turn[start + k] = {t.qw[k], t.qx[k], t.qy[k], t.qz[k]};
      Record& b = p.body[start + k];
      b.wx = t.wx[k];
      b.wy = t.wy[k];
      b.wz = t.wz[k];
      energy.add((start + k - chunk_first) / kSpan, {t.before[k], t.after[k]});
    }
  }
}

void set_velocity(Record& b, const Vec3& v) {
  b.vx = v.x;
  b.vy = v.y;
  b.vz = v.z;
}
void set_spin(Record& b, const Vec3& w) {
  b.wx = w.x;
  b.wy = w.y;
  b.wz = w.z;
}
void move(Record& b, const Vec3& v, double dt) {
  b.x += v.x * dt;
  b.y += v.y * dt;
  b.z += v.z * dt;
}

}  // namespace

void Engine::sum_pass(std::size_t c) {
  const Chunk& chunk = pairs_.chunks[c];
  const auto take = [this](std::size_t slot) {
    if (!pairs_.slot_used[slot]) return;
    Wrench& a = sphere_wrench_[pairs_.slot_sphere[slot]];
    if (options.mixed) {
      kernels_->widen(&lean_slot_[slot], 1, &a);
      return;
    }
    const Wrench& b = pairs_.slot_wrench[slot];
    a += b;
  };
  if (const RestWalk* w = walk(c))
    for (const std::size_t slot : w->in_slots) take(slot);
  else
    for (const auto& in : chunk.incoming)
      for (std::size_t slot = in.first; slot < in.last; ++slot) take(slot);
  if (options.mixed)
    each_live(c, [this](std::uint32_t first, std::uint32_t last) {
      const std::uint32_t from = first_sphere_of(first);
      kernels_->widen(lean_wrench_.data() + from, first_sphere_of(last) - from, sphere_wrench_.data() + from);
    });
  if (particles.has_clumps) each_live(c, [this](std::uint32_t first, std::uint32_t last) { sum_spheres(first, last); });
}

void Engine::sum_spheres(std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t p = first; p < last; ++p) {
    Wrench sum;
    const Vec3 centre = position(particles.body[p]);
    for (std::uint32_t k = particles.first_sphere[p]; k < particles.first_sphere[p + 1]; ++k) {
      const Wrench& w = sphere_wrench_[k];
      const Vec3 t = cross(position(particles.member[k]) - centre, force_of(w));
      sum += wrench_of(force_of(w), torque_of(w) + t);
    }
    sum_[p] = sum;
  }
}

void Engine::force_pass(std::size_t c, Worker& w, double t, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  const std::uint32_t n = chunk.last_particle - chunk.first_particle;
  constexpr int kColumns = 17;
  w.columns.resize(static_cast<std::size_t>(kColumns) * n);
  double* column[kColumns];
  for (int k = 0; k < kColumns; ++k) column[k] = w.columns.data() + static_cast<std::size_t>(k) * n;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t p = chunk.first_particle + k;
    const Record& b = particles.body[p];
    const double values[11] = {b.x, b.y, b.z, b.vx, b.vy, b.vz, b.wx, b.wy, b.wz, b.m, particles.equal_radius(p)};
    for (int m = 0; m < 11; ++m) column[m][k] = values[m];
    for (int m = 11; m < kColumns; ++m) column[m][k] = 0;
  }
  calx_particle_block block{};
  block.struct_size = sizeof block;
  block.count = n;
  block.dt = dt;
  block.time = t;
  const double** in[] = {&block.x,  &block.y,  &block.z,  &block.vx,   &block.vy,    &block.vz,
                         &block.wx, &block.wy, &block.wz, &block.mass, &block.radius};
  for (int m = 0; m < 11; ++m) *in[m] = column[m];
  double** out[] = {&block.fx, &block.fy, &block.fz, &block.mx, &block.my, &block.mz};
  for (int m = 0; m < 6; ++m) *out[m] = column[11 + m];
  for (const auto& force : forces) force.table->eval(force.instance, &block);
  for (std::uint32_t k = 0; k < n; ++k) {
    const Record& b = particles.body[chunk.first_particle + k];
    Wrench& sum = sums()[chunk.first_particle + k];
    const Wrench add{column[11][k], column[12][k], column[13][k], column[14][k], column[15][k], column[16][k]};
    sum += add;
    if (rest_ && rest_->asleep[chunk.first_particle + k]) continue;
    // The mean velocity of the kick; the spin's own change is left out, for such forces seldom turn anything.
    const Vec3 v = velocity(b) + 0.5 * dt * ((1 / b.m) * force_of(sum) + options.gravity);
    results_[c].force_work.add(k / kSpan, (dot(force_of(add), v) + dot(torque_of(add), spin(b))) * dt);
  }
}

// Velocities of euler stand half a step from positions, so energy at an instant is the mean of both sides of the kick;
// half is booked before the kick and half after it.
void Engine::book_half(std::size_t c, double dt, bool before) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  SpanSum<Vec3> momentum;
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    const std::size_t span = (p - chunk.first_particle) / kSpan;
    const Record& b = particles.body[p];
    result.kinetic_translation.add(span, 0.25 * b.m * norm2(velocity(b)));
    if (!particles.has_clumps) result.kinetic_rotation.add(span, 0.25 * norm2(spin(b)) / b.aux);
    if (before)
      result.gravity.add(span, -(b.m * dot(options.gravity, position(b))));
    else
      momentum.add(span, b.m * velocity(b));
  }
  // What follows starts with the first span again.
  result.kinetic_translation.close();
  result.kinetic_rotation.close();
  result.gravity.close();
  result.gravity_work.total += dot(options.gravity, momentum.closed()) * dt;
}

void Engine::integrate_euler(std::size_t c, double dt) {
  const double gravity[3] = {options.gravity.x, options.gravity.y, options.gravity.z};
  if (options.ledger) book_half(c, dt, true);
  SpanSum<TurnSums> turning;
  const auto move = particles.has_clumps ? kernels_->move_clumps : kernels_->move_spheres;
  each_awake(c, [&](std::uint32_t first, std::uint32_t last) {
    move(particles.body.data() + first, sums().data() + first, last - first, gravity, dt);
    if (!particles.has_clumps) return;
    turn_particles(*kernels_, particles, sums(), pairs_.chunks[c].first_particle, first, last, dt, dt, 0, turning);
    particles.refresh_members(first, last);
  });
  const TurnSums turned = turning.closed();
  if (options.ledger) results_[c].kinetic_rotation.total += 0.5 * (turned.before + turned.after);
  if (options.ledger) book_half(c, dt, false);
}

void Engine::drift_verlet(std::size_t c, double dt) {
  each_awake(c, [&](std::uint32_t first, std::uint32_t last) { drift_run(c, first, last, dt); });
}

void Engine::drift_run(std::size_t c, std::uint32_t first, std::uint32_t last, double dt) {
  const Vec3 g = options.gravity;
  const std::uint32_t chunk_first = pairs_.chunks[c].first_particle;
  for (std::uint32_t p = first; p < last; ++p) {
    Record& b = particles.body[p];
    const Wrench& old = particles.wrench[p];
    const Vec3 half = velocity(b) + 0.5 * dt * ((1 / b.m) * force_of(old) + g);
    move(b, half, dt);
    set_velocity(b, half);
    results_[c].gravity_work.add((p - chunk_first) / kSpan, b.m * dot(g, half) * dt);
    if (!particles.has_clumps) set_spin(b, spin(b) + 0.5 * dt * b.aux * torque_of(old));
  }
  if (!particles.has_clumps) return;
  SpanSum<TurnSums> unused;
  turn_particles(*kernels_, particles, particles.wrench, chunk_first, first, last, dt, 0.5 * dt, 0, unused);
  particles.refresh_members(first, last);
}

void Engine::finish_verlet(std::size_t c, double dt) {
  each_awake(c, [&](std::uint32_t first, std::uint32_t last) { finish_run(c, first, last, dt); });
}

void Engine::finish_run(std::size_t c, std::uint32_t first, std::uint32_t last, double dt) {
  ChunkResult& result = results_[c];
  for (std::uint32_t p = first; p < last; ++p) {
    Record& b = particles.body[p];
    const Wrench& now = sums()[p];
    set_velocity(b, velocity(b) + 0.5 * dt * ((1 / b.m) * force_of(now) + options.gravity));
    const Vec3 change = 0.5 * dt * torque_of(now);
    if (!particles.has_clumps) {
      set_spin(b, spin(b) + b.aux * change);
    } else {
      const Vec3 i = particles.inertia(p);
      const Quat& q = particles.turn[p];
      set_spin(b, spin_of(q, i, momentum(q, i, spin(b)) + change));
    }
    if (!options.ledger) continue;
    const std::size_t span = (p - pairs_.chunks[c].first_particle) / kSpan;
    const double translation = 0.5 * b.m * norm2(velocity(b));
    result.kinetic_translation.add(span, translation);
    result.kinetic_rotation.add(span, particles.kinetic_energy(p) - translation);
    result.gravity.add(span, -(b.m * dot(options.gravity, position(b))));
  }
  if (particles.has_clumps) particles.refresh_members(first, last);
}

std::string bad_motion(const Record& b, const Vec3& listed) {
  const std::pair<const char*, Vec3> kinds[] = {
      {"position", position(b)}, {"velocity", velocity(b)}, {"spin", spin(b)}};
  std::string out;
  for (const auto& kind : kinds)
    for (int k = 0; k < 3; ++k)
      if (!(std::fabs(kind.second[k]) < kHuge))
        out += (out.empty() ? "" : ", ") + std::string(kind.first) + ' ' + "xyz"[k];
  const auto place = [](const Vec3& x) { return std::fabs(x.x) + std::fabs(x.y) + std::fabs(x.z) < kHuge; };
  const bool now = place(position(b));
  const Vec3 x = now ? position(b) : listed;
  if (!place(x)) return out;
  char text[96];
  std::snprintf(text, sizeof text, ", %s (%.6g, %.6g, %.6g) m", now ? "at" : "last known at", x.x, x.y, x.z);
  return out + text;
}

void Engine::guard_pass(std::size_t c, double dt) {
  double pace2 = 0, squares = 0;
  bool inside = true;
  each_awake(c, [&](std::uint32_t first, std::uint32_t last) {
    Survey seen;
    kernels_->survey(particles.body.data() + first, haste_.data() + first, last - first, particles.has_clumps, seen);
    // Written so that a NaN stays.
    pace2 = seen.pace2 < pace2 ? pace2 : seen.pace2;
    squares += seen.squares;
    for (int k = 0; k < 3; ++k)
      inside &= options.wrap.periodic[static_cast<std::size_t>(k)] ||
                (seen.lo[k] >= options.domain.lo[k] && seen.hi[k] <= options.domain.hi[k]);
  });
  used_[c] += dt * std::sqrt(pace2);
  // Written so that a NaN counts as bad.
  if (!inside || !(squares < 1e50) || !(used_[c] < 1 - 1e-9)) guard_each(c);
}

// What the bounds of guard_pass cannot tell.
void Engine::guard_each(std::size_t c) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  const Box& box = options.domain;
  const auto& periodic = options.wrap.periodic;
  const Record* s = particles.spheres();
  double used = 0;  // squared
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    const Record& b = particles.body[p];
    const double size = std::fabs(b.x) + std::fabs(b.y) + std::fabs(b.z) + std::fabs(b.vx) + std::fabs(b.vy) +
                        std::fabs(b.vz) + std::fabs(b.wx) + std::fabs(b.wy) + std::fabs(b.wz);
    // Written so that a NaN counts as bad.
    if (!(size < kHuge)) {
      if (!result.bad) result.bad_particle = p;
      result.bad = true;
      continue;
    }
    const bool inside = (periodic[0] || (b.x >= box.lo.x && b.x <= box.hi.x)) &&
                        (periodic[1] || (b.y >= box.lo.y && b.y <= box.hi.y)) &&
                        (periodic[2] || (b.z >= box.lo.z && b.z <= box.hi.z));
    if (!inside) result.outside.push_back(p);
    const double limit = margin_[p] * margin_[p];
    double moved = 0;
    const std::uint32_t first = particles.has_clumps ? particles.first_sphere[p] : p;
    const std::uint32_t last = particles.has_clumps ? particles.first_sphere[p + 1] : p + 1;
    for (std::uint32_t k = first; k < last; ++k) moved = std::max(moved, norm2(position(s[k]) - reference_[k]));
    result.stale |= moved > limit;
    used = std::max(used, moved / limit);
  }
  used_[c] = std::sqrt(used);
}

}  // namespace calx
