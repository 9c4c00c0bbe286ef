// integrate.cpp: sums of wrenches per particle, particle forces, and the two integrators.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "step/engine_detail.hpp"

namespace calx {
namespace {

/// Turns q by spin w over dt: Cayley's map, exact to third order in w dt, built from + - * / and sqrt.
__attribute__((always_inline)) inline Quat turned(const Quat& q, const Vec3& w, double dt) {
  const Quat step{1, 0.5 * dt * w.x, 0.5 * dt * w.y, 0.5 * dt * w.z};
  return normalized(step * q);
}

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

/// Rows of a tile of the rotation loop; its columns stay in the first-level cache.
constexpr std::uint32_t kTurnRows = 128;

struct TurnTile {
  alignas(64) double qw[kTurnRows], qx[kTurnRows], qy[kTurnRows], qz[kTurnRows];
  alignas(64) double wx[kTurnRows], wy[kTurnRows], wz[kTurnRows];  // spin, world frame
  alignas(64) double tx[kTurnRows], ty[kTurnRows], tz[kTurnRows];  // torque
  alignas(64) double ix[kTurnRows], iy[kTurnRows], iz[kTurnRows];  // principal moments
  alignas(64) double before[kTurnRows], after[kTurnRows];          // energy of rotation, J
};

/// Turns the bodies of a tile over dt by the midpoint rule: angular momentum gets torque * kick, the body turns freely
/// (momentum kept exactly), then momentum gets torque * late_kick. Columns, so that the compiler works on eight at
/// once.
CALX_HOT void turn_bodies(std::uint32_t n, TurnTile& t, double dt, double kick, double late_kick) {
#pragma omp simd
  for (std::uint32_t k = 0; k < n; ++k) {
    const Quat q{t.qw[k], t.qx[k], t.qy[k], t.qz[k]};
    const Vec3 i{t.ix[k], t.iy[k], t.iz[k]}, inverse{1 / i.x, 1 / i.y, 1 / i.z};
    const Vec3 w{t.wx[k], t.wy[k], t.wz[k]}, torque{t.tx[k], t.ty[k], t.tz[k]};
    const Vec3 b = rotate(conjugate(q), w);
    const Vec3 l0 = rotate(q, {i.x * b.x, i.y * b.y, i.z * b.z});
    const Vec3 l = l0 + kick * torque;
    const Vec3 b0 = rotate(conjugate(q), l);
    const Quat half = turned(q, rotate(q, {b0.x * inverse.x, b0.y * inverse.y, b0.z * inverse.z}), 0.5 * dt);
    const Vec3 b1 = rotate(conjugate(half), l);
    const Quat now = turned(q, rotate(half, {b1.x * inverse.x, b1.y * inverse.y, b1.z * inverse.z}), dt);
    const Vec3 l1 = l + late_kick * torque;
    const Vec3 b2 = rotate(conjugate(now), l1);
    const Vec3 w1 = rotate(now, {b2.x * inverse.x, b2.y * inverse.y, b2.z * inverse.z});
    t.before[k] = 0.5 * dot(l0, w);
    t.after[k] = 0.5 * dot(l1, w1);
    t.qw[k] = now.w;
    t.qx[k] = now.x;
    t.qy[k] = now.y;
    t.qz[k] = now.z;
    t.wx[k] = w1.x;
    t.wy[k] = w1.y;
    t.wz[k] = w1.z;
  }
}

/// turn_bodies for particles first .. last; wrench: their torques. Returns the sums of the energies of rotation before
/// and after, J.
std::pair<double, double> turn_particles(Particles& p, const Column<Wrench>& wrench, std::uint32_t first,
                                         std::uint32_t last, double dt, double kick, double late_kick) {
  TurnTile t;
  std::pair<double, double> energy{0, 0};
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
    turn_bodies(n, t, dt, kick, late_kick);
    for (std::uint32_t k = 0; k < n; ++k) {
      p.turn[start + k] = {t.qw[k], t.qx[k], t.qy[k], t.qz[k]};
      Record& b = p.body[start + k];
      b.wx = t.wx[k];
      b.wy = t.wy[k];
      b.wz = t.wz[k];
      energy.first += t.before[k];
      energy.second += t.after[k];
    }
  }
  return energy;
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
Vec3 force_of(const Wrench& w) { return {w.fx, w.fy, w.fz}; }
Vec3 torque_of(const Wrench& w) { return {w.tx, w.ty, w.tz}; }

}  // namespace

void Engine::sum_pass(std::size_t c) {
  const Chunk& chunk = pairs_.chunks[c];
  for (const auto& in : chunk.incoming)
    for (std::size_t slot = in.first; slot < in.last; ++slot) {
      if (!pairs_.slot_used[slot]) continue;
      Wrench& a = sphere_wrench_[pairs_.slot_sphere[slot]];
      const Wrench& b = pairs_.slot_wrench[slot];
      a.fx += b.fx;
      a.fy += b.fy;
      a.fz += b.fz;
      a.tx += b.tx;
      a.ty += b.ty;
      a.tz += b.tz;
    }
  if (!particles.has_clumps) return;
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    Wrench sum;
    const Vec3 centre = position(particles.body[p]);
    for (std::uint32_t k = particles.first_sphere[p]; k < particles.first_sphere[p + 1]; ++k) {
      const Wrench& w = sphere_wrench_[k];
      const Vec3 t = cross(position(particles.member[k]) - centre, force_of(w));
      sum.fx += w.fx;
      sum.fy += w.fy;
      sum.fz += w.fz;
      sum.tx += w.tx + t.x;
      sum.ty += w.ty + t.y;
      sum.tz += w.tz + t.z;
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
    sum.fx += add.fx;
    sum.fy += add.fy;
    sum.fz += add.fz;
    sum.tx += add.tx;
    sum.ty += add.ty;
    sum.tz += add.tz;
    // The mean velocity of the kick; the spin's own change is left out, for such forces seldom turn anything.
    const Vec3 v = velocity(b) + 0.5 * dt * ((1 / b.m) * force_of(sum) + options.gravity);
    results_[c].force_work += (dot(force_of(add), v) + dot(torque_of(add), spin(b))) * dt;
  }
}

void Engine::integrate_euler(std::size_t c, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  const Vec3 g = options.gravity;
  const Column<Wrench>& total = sums();
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    Record& b = particles.body[p];
    const Wrench& sum = total[p];
    const double f = dt / b.m;
    const Vec3 v{b.vx + (f * sum.fx + g.x * dt), b.vy + (f * sum.fy + g.y * dt), b.vz + (f * sum.fz + g.z * dt)};
    if (options.ledger) {
      // Velocities of euler stand half a step from positions, so energy at this instant is the mean of both sides.
      result.kinetic_translation += 0.25 * b.m * (norm2(velocity(b)) + norm2(v));
      result.gravity -= b.m * dot(g, position(b));
    }
    set_velocity(b, v);
    move(b, v, dt);
    result.gravity_work += b.m * dot(g, v) * dt;
    if (particles.has_clumps) continue;
    const double before = norm2(spin(b)) / b.aux;
    set_spin(b, spin(b) + dt * b.aux * torque_of(sum));
    result.kinetic_rotation += 0.25 * (before + norm2(spin(b)) / b.aux);
  }
  if (!particles.has_clumps) return;
  const auto energy = turn_particles(particles, total, chunk.first_particle, chunk.last_particle, dt, dt, 0);
  result.kinetic_rotation += 0.5 * (energy.first + energy.second);
  particles.refresh_members(chunk.first_particle, chunk.last_particle);
}

void Engine::drift_verlet(std::size_t c, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  const Vec3 g = options.gravity;
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
    Record& b = particles.body[p];
    const Wrench& old = particles.wrench[p];
    const Vec3 half = velocity(b) + 0.5 * dt * ((1 / b.m) * force_of(old) + g);
    move(b, half, dt);
    set_velocity(b, half);
    results_[c].gravity_work += b.m * dot(g, half) * dt;
    if (!particles.has_clumps) set_spin(b, spin(b) + 0.5 * dt * b.aux * torque_of(old));
  }
  if (!particles.has_clumps) return;
  turn_particles(particles, particles.wrench, chunk.first_particle, chunk.last_particle, dt, 0.5 * dt, 0);
  particles.refresh_members(chunk.first_particle, chunk.last_particle);
}

void Engine::finish_verlet(std::size_t c, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  for (std::uint32_t p = chunk.first_particle; p < chunk.last_particle; ++p) {
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
    const double translation = 0.5 * b.m * norm2(velocity(b));
    result.kinetic_translation += translation;
    result.kinetic_rotation += particles.kinetic_energy(p) - translation;
    result.gravity -= b.m * dot(options.gravity, position(b));
  }
  if (particles.has_clumps) particles.refresh_members(chunk.first_particle, chunk.last_particle);
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

void Engine::guard_pass(std::size_t c) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  const Box& box = options.domain;
  const auto& periodic = options.wrap.periodic;
  const Record* s = particles.spheres();
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
    const std::uint32_t first = particles.has_clumps ? particles.first_sphere[p] : p;
    const std::uint32_t last = particles.has_clumps ? particles.first_sphere[p + 1] : p + 1;
    for (std::uint32_t k = first; k < last; ++k) result.stale |= norm2(position(s[k]) - reference_[k]) > limit;
  }
}

}  // namespace calx
