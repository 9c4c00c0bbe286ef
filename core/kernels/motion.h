/* motion.h: sums of wrenches in the order that all backends share, the two integrators, and guards.
 *
 * The order, for each sphere: entries whose first sphere lies in its own chunk, by rising first sphere; its own row, by
 * rising partner; parts, by row and depth; entries whose first sphere lies in an earlier chunk, by rising first sphere.
 */
#ifndef CALX_MOTION_H
#define CALX_MOTION_H

/* in_entry: entries of which a sphere is the second, rising; those of chunks before its own from in_first[s] to
 * in_middle[s], those of its own up to in_first[s + 1]. Macros, because w is of either precision. */
#define TAKE_REACTIONS(w, from, to)   \
  for (u32 k = from; k < to; ++k) {   \
    const u32 e = in_entry[k];        \
    if (!touching[e]) continue;       \
    w.fx -= pair_out[e];              \
    w.fy -= pair_out[stride + e];     \
    w.fz -= pair_out[2 * stride + e]; \
    w.tx -= pair_out[6 * stride + e]; \
    w.ty -= pair_out[7 * stride + e]; \
    w.tz -= pair_out[8 * stride + e]; \
  }
#define ADD_OWN_ENTRIES(w)                                \
  TAKE_REACTIONS(w, in_middle[s], in_first[s + 1])        \
  for (u32 e = row_first[s]; e < row_first[s + 1]; ++e) { \
    if (!touching[e]) continue;                           \
    w.fx += pair_out[e];                                  \
    w.fy += pair_out[stride + e];                         \
    w.fz += pair_out[2 * stride + e];                     \
    w.tx += pair_out[3 * stride + e];                     \
    w.ty += pair_out[4 * stride + e];                     \
    w.tz += pair_out[5 * stride + e];                     \
  }

FN void add_walls(wrench* w, u32 first, u32 last, GLOBAL const u32* counts, GLOBAL const double* out, u64 stride) {
  for (u32 row = first; row < last; ++row)
    for (u32 k = 0; k < counts[row]; ++k) {
      const u64 at = (u64)row * WALL_CONTACTS + k;
      w->fx += out[at];
      w->fy += out[stride + at];
      w->fz += out[2 * stride + at];
      w->tx += out[3 * stride + at];
      w->ty += out[4 * stride + at];
      w->tz += out[5 * stride + at];
    }
}

#define SUM_ARGUMENTS(scalar)                                                                                        \
  step_numbers n, GLOBAL const u32 *RESTRICT row_first, GLOBAL const u32 *RESTRICT in_first,                         \
      GLOBAL const u32 *RESTRICT in_middle, GLOBAL const u32 *RESTRICT in_entry, GLOBAL const u8 *RESTRICT touching, \
      GLOBAL const scalar *RESTRICT pair_out, GLOBAL const u32 *RESTRICT wall_first,                                 \
      GLOBAL const u32 *RESTRICT wall_counts, GLOBAL const double *RESTRICT wall_out, GLOBAL wrench *RESTRICT sums,  \
      GLOBAL const u32 *RESTRICT flags

KERNEL(sum_contacts, SUM_ARGUMENTS(double)) {
  const u32 s = ITEM;
  if (s >= n.spheres || flags[FLAG_STOP]) return;
  const u64 stride = n.entries;
  wrench w;
  w.fx = w.fy = w.fz = w.tx = w.ty = w.tz = 0.0;
  ADD_OWN_ENTRIES(w)
  add_walls(&w, wall_first[s], wall_first[s + 1], wall_counts, wall_out, (u64)n.wall_rows * WALL_CONTACTS);
  TAKE_REACTIONS(w, in_first[s], in_middle[s])
  sums[s] = w;
}

/* Mixed precision: what the own chunk's entries do is a sum of single precision, added last. */
typedef struct lean_wrench {
  float fx, fy, fz, tx, ty, tz; /* N, N m */
} lean_wrench;
KERNEL(sum_contacts_mixed, SUM_ARGUMENTS(float)) {
  const u32 s = ITEM;
  if (s >= n.spheres || flags[FLAG_STOP]) return;
  const u64 stride = n.entries;
  lean_wrench own;
  own.fx = own.fy = own.fz = own.tx = own.ty = own.tz = 0.0f;
  ADD_OWN_ENTRIES(own)
  wrench w;
  w.fx = w.fy = w.fz = w.tx = w.ty = w.tz = 0.0;
  add_walls(&w, wall_first[s], wall_first[s + 1], wall_counts, wall_out, (u64)n.wall_rows * WALL_CONTACTS);
  TAKE_REACTIONS(w, in_first[s], in_middle[s])
  w.fx += own.fx;
  w.fy += own.fy;
  w.fz += own.fz;
  w.tx += own.tx;
  w.ty += own.ty;
  w.tz += own.tz;
  sums[s] = w;
}

/* Energies of a particle, J, in columns `particles` apart: translation and rotation before the kick, gravity before;
 * translation and rotation after; its momentum after, kg m/s; work of forces on single particles. */
#define PARTICLE_ENERGIES 9u

FN double translation_of(GLOBAL const record* b) {
  const vec3 v = velocity_of(b);
  return 0.25 * b->m * dot3_f64(v, v);
}
FN double rotation_of(GLOBAL const record* b) {
  const vec3 w = spin_of(b);
  return 0.25 * dot3_f64(w, w) / b->aux;
}

/* Sums of a particle with the forces on single particles, whose work is booked at the mean velocity of the kick. */
FN wrench with_forces(wrench w, GLOBAL const wrench* added, u32 p, GLOBAL const record* b, GLOBAL double* energy,
                      step_numbers n) {
  if (!n.forces) return w;
  const wrench add = added[p];
  w.fx += add.fx;
  w.fy += add.fy;
  w.fz += add.fz;
  w.tx += add.tx;
  w.ty += add.ty;
  w.tz += add.tz;
  const vec3 pull =
      add3_f64(scale3_f64(1.0 / b->m, make3_f64(w.fx, w.fy, w.fz)), make3_f64(n.gravity_x, n.gravity_y, n.gravity_z));
  const vec3 v = add3_f64(velocity_of(b), scale3_f64(0.5 * n.dt, pull));
  energy[8 * (u64)n.particles + p] =
      (dot3_f64(make3_f64(add.fx, add.fy, add.fz), v) + dot3_f64(make3_f64(add.tx, add.ty, add.tz), spin_of(b))) * n.dt;
  return w;
}

FN void kick_and_drift(GLOBAL record* b, double fx, double fy, double fz, step_numbers n) {
  const double share = n.dt / b->m;
  b->vx = b->vx + (share * fx + n.gravity_x * n.dt);
  b->vy = b->vy + (share * fy + n.gravity_y * n.dt);
  b->vz = b->vz + (share * fz + n.gravity_z * n.dt);
  b->x = b->x + n.dt * b->vx;
  b->y = b->y + n.dt * b->vy;
  b->z = b->z + n.dt * b->vz;
}

FN void book_before(GLOBAL double* energy, u64 stride, u32 p, GLOBAL const record* b, step_numbers n) {
  energy[p] = translation_of(b);
  energy[2 * stride + p] = b->m * (n.gravity_x * b->x + n.gravity_y * b->y + n.gravity_z * b->z);
}
FN void book_after(GLOBAL double* energy, u64 stride, u32 p, GLOBAL const record* b) {
  energy[3 * stride + p] = translation_of(b);
  energy[5 * stride + p] = b->m * b->vx;
  energy[6 * stride + p] = b->m * b->vy;
  energy[7 * stride + p] = b->m * b->vz;
}

/* Numbers that are none, a place outside the domain, or a sphere that has used up its margin. A NaN counts as bad. */
FN void guard_particle(GLOBAL const record* b, step_numbers n, GLOBAL u32* flags) {
  const double size = abs_f64(b->x) + abs_f64(b->y) + abs_f64(b->z) + abs_f64(b->vx) + abs_f64(b->vy) + abs_f64(b->vz) +
                      abs_f64(b->wx) + abs_f64(b->wy) + abs_f64(b->wz);
  const u32 inside = (n.periodic_x || (b->x >= n.low_x && b->x <= n.high_x)) &&
                     (n.periodic_y || (b->y >= n.low_y && b->y <= n.high_y)) &&
                     (n.periodic_z || (b->z >= n.low_z && b->z <= n.high_z));
  if (!(size < 1e30) || !inside) ATOMIC_OR(flags + FLAG_GUARD, 1u);
}
FN void guard_margin(GLOBAL const record* s, GLOBAL const vec3* listed, double margin, GLOBAL u32* flags) {
  const vec3 moved = sub3_f64(position_of(s), *listed);
  if (dot3_f64(moved, moved) > margin * margin) ATOMIC_OR(flags + FLAG_STALE, 1u);
}

/* Particles of one sphere each. */
KERNEL(move_spheres, step_numbers n, GLOBAL record* RESTRICT body, GLOBAL const wrench* RESTRICT sums,
       GLOBAL const wrench* RESTRICT added, GLOBAL const vec3* RESTRICT listed, GLOBAL const double* RESTRICT margin,
       GLOBAL double* RESTRICT energy, GLOBAL u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL record* b = body + p;
  const wrench w = with_forces(sums[p], added, p, b, energy, n);
  const u64 stride = n.particles;
  if (n.ledger) {
    book_before(energy, stride, p, b, n);
    energy[stride + p] = rotation_of(b);
  }
  kick_and_drift(b, w.fx, w.fy, w.fz, n);
  const double turning = n.dt * b->aux;
  b->wx = b->wx + turning * w.tx;
  b->wy = b->wy + turning * w.ty;
  b->wz = b->wz + turning * w.tz;
  if (n.ledger) {
    book_after(energy, stride, p, b);
    energy[4 * stride + p] = rotation_of(b);
  }
  guard_particle(b, n, flags);
  guard_margin(b, listed + p, margin[p], flags);
}

FN quat times(quat a, quat b) {
  quat q;
  q.w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z;
  q.x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y;
  q.y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x;
  q.z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w;
  return q;
}
/* Turns q by spin w over dt: Cayley's map. */
FN quat turned(quat q, vec3 w, double dt) {
  quat turn;
  turn.w = 1.0;
  turn.x = 0.5 * dt * w.x;
  turn.y = 0.5 * dt * w.y;
  turn.z = 0.5 * dt * w.z;
  quat now = times(turn, q);
  const double s = 1.0 / sqrt_f64(now.w * now.w + now.x * now.x + now.y * now.y + now.z * now.z);
  now.w = now.w * s;
  now.x = now.x * s;
  now.y = now.y * s;
  now.z = now.z * s;
  return now;
}
FN vec3 each_times(vec3 a, vec3 b) { return make3_f64(a.x * b.x, a.y * b.y, a.z * b.z); }
FN vec3 each_over(vec3 a, vec3 b) { return make3_f64(a.x / b.x, a.y / b.y, a.z / b.z); }

/* Force and torque on a clump from its spheres. */
FN wrench clump_wrench(GLOBAL const record* b, GLOBAL const record* spheres, GLOBAL const wrench* sums, u32 first,
                       u32 last) {
  wrench total;
  total.fx = total.fy = total.fz = total.tx = total.ty = total.tz = 0.0;
  const vec3 centre = position_of(b);
  for (u32 k = first; k < last; ++k) {
    const wrench w = sums[k];
    const vec3 t = cross3_f64(sub3_f64(position_of(spheres + k), centre), make3_f64(w.fx, w.fy, w.fz));
    total.fx += w.fx;
    total.fy += w.fy;
    total.fz += w.fz;
    total.tx += w.tx + t.x;
    total.ty += w.ty + t.y;
    total.tz += w.tz + t.z;
  }
  return total;
}

/* A turn by the midpoint rule: angular momentum gets torque * kick, then the body turns freely over dt. */
typedef struct turning {
  quat turn;
  vec3 spin, before, after; /* angular momentum before the kick and after it */
} turning;
FN turning turn_body(quat q, vec3 i, vec3 w, vec3 torque, double dt, double kick) {
  turning t;
  const vec3 inverse = make3_f64(1.0 / i.x, 1.0 / i.y, 1.0 / i.z);
  t.before = rotate3(q, each_times(i, rotate3(conjugate(q), w)));
  const vec3 l = add3_f64(t.before, scale3_f64(kick, torque));
  const quat middle = turned(q, rotate3(q, each_times(rotate3(conjugate(q), l), inverse)), 0.5 * dt);
  t.turn = turned(q, rotate3(middle, each_times(rotate3(conjugate(middle), l), inverse)), dt);
  /* The host's loop can kick once more, here with nothing. */
  t.after = add3_f64(l, scale3_f64(0.0, torque));
  t.spin = rotate3(t.turn, each_times(rotate3(conjugate(t.turn), t.after), inverse));
  return t;
}

/* Clumps: sums of their spheres, midpoint rule for the turn, spheres put where the bodies are. inertia: principal
 * moments, kg m^2; arms: of spheres, m, principal frame. */
KERNEL(move_clumps, step_numbers n, GLOBAL record* RESTRICT body, GLOBAL record* RESTRICT spheres,
       GLOBAL quat* RESTRICT turns, GLOBAL const vec3* RESTRICT inertia, GLOBAL const u32* RESTRICT first_sphere,
       GLOBAL const vec3* RESTRICT arms, GLOBAL const wrench* RESTRICT sums, GLOBAL const wrench* RESTRICT added,
       GLOBAL const vec3* RESTRICT listed, GLOBAL const double* RESTRICT margin, GLOBAL double* RESTRICT energy,
       GLOBAL u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL record* b = body + p;
  const u32 first = first_sphere[p], last = first_sphere[p + 1];
  const wrench w = with_forces(clump_wrench(b, spheres, sums, first, last), added, p, b, energy, n);
  const u64 stride = n.particles;
  if (n.ledger) book_before(energy, stride, p, b, n);
  kick_and_drift(b, w.fx, w.fy, w.fz, n);
  const vec3 spin = spin_of(b);
  const turning t = turn_body(turns[p], inertia[p], spin, make3_f64(w.tx, w.ty, w.tz), n.dt, n.dt);
  turns[p] = t.turn;
  set_spin(b, t.spin);
  if (n.ledger) {
    energy[stride + p] = 0.5 * dot3_f64(t.before, spin);
    energy[4 * stride + p] = 0.5 * dot3_f64(t.after, t.spin);
    book_after(energy, stride, p, b);
  }
  place_spheres(b, t.turn, spheres, arms, first, last);
  guard_particle(b, n, flags);
  for (u32 k = first; k < last; ++k) guard_margin(spheres + k, listed + k, margin[p], flags);
}

/* Velocity Verlet, first half: kick by the forces of the last step, then drift. energy, column 0: work of gravity. */
FN void drift(GLOBAL record* b, GLOBAL const wrench* w, GLOBAL double* energy, u32 p, step_numbers n) {
  const double half_step = 0.5 * n.dt, inverse = 1.0 / b->m;
  const double vx = b->vx + half_step * (inverse * w->fx + n.gravity_x),
               vy = b->vy + half_step * (inverse * w->fy + n.gravity_y),
               vz = b->vz + half_step * (inverse * w->fz + n.gravity_z);
  b->x += vx * n.dt;
  b->y += vy * n.dt;
  b->z += vz * n.dt;
  b->vx = vx;
  b->vy = vy;
  b->vz = vz;
  energy[p] = b->m * (n.gravity_x * vx + n.gravity_y * vy + n.gravity_z * vz) * n.dt;
}

KERNEL(drift_spheres, step_numbers n, GLOBAL record* RESTRICT body, GLOBAL const wrench* RESTRICT sums,
       GLOBAL const vec3* RESTRICT listed, GLOBAL const double* RESTRICT margin, GLOBAL double* RESTRICT energy,
       GLOBAL u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL record* b = body + p;
  GLOBAL const wrench* w = sums + p;
  drift(b, w, energy, p, n);
  const double turning = 0.5 * n.dt * b->aux;
  set_spin(b, add3_f64(spin_of(b), scale3_f64(turning, make3_f64(w->tx, w->ty, w->tz))));
  guard_margin(b, listed + p, margin[p], flags);
}

KERNEL(drift_clumps, step_numbers n, GLOBAL record* RESTRICT body, GLOBAL record* RESTRICT spheres,
       GLOBAL quat* RESTRICT turns, GLOBAL const vec3* RESTRICT inertia, GLOBAL const u32* RESTRICT first_sphere,
       GLOBAL const vec3* RESTRICT arms, GLOBAL const wrench* RESTRICT sums, GLOBAL const vec3* RESTRICT listed,
       GLOBAL const double* RESTRICT margin, GLOBAL double* RESTRICT energy, GLOBAL u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL record* b = body + p;
  GLOBAL const wrench* w = sums + p;
  drift(b, w, energy, p, n);
  const turning t = turn_body(turns[p], inertia[p], spin_of(b), make3_f64(w->tx, w->ty, w->tz), n.dt, 0.5 * n.dt);
  turns[p] = t.turn;
  set_spin(b, t.spin);
  const u32 first = first_sphere[p], last = first_sphere[p + 1];
  place_spheres(b, t.turn, spheres, arms, first, last);
  for (u32 k = first; k < last; ++k) guard_margin(spheres + k, listed + k, margin[p], flags);
}

/* Second half: kick by the forces of this step. sphere_sums: of spheres; sums: of particles, kept for the next step. */
KERNEL(kick_particles, step_numbers n, u32 clumps, GLOBAL record* RESTRICT body, GLOBAL record* RESTRICT spheres,
       GLOBAL const quat* RESTRICT turns, GLOBAL const vec3* RESTRICT inertia, GLOBAL const u32* RESTRICT first_sphere,
       GLOBAL const vec3* RESTRICT arms, GLOBAL const wrench* RESTRICT sphere_sums, GLOBAL const wrench* RESTRICT added,
       GLOBAL wrench* RESTRICT sums, GLOBAL const vec3* RESTRICT listed, GLOBAL const double* RESTRICT margin,
       GLOBAL double* RESTRICT energy, GLOBAL u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL record* b = body + p;
  const u32 first = clumps ? first_sphere[p] : p, last = clumps ? first_sphere[p + 1] : p + 1;
  wrench w = sphere_sums[p];
  if (clumps) w = clump_wrench(b, spheres, sphere_sums, first, last);
  w = with_forces(w, added, p, b, energy, n);
  sums[p] = w;
  const double half_step = 0.5 * n.dt, inverse = 1.0 / b->m;
  b->vx = b->vx + half_step * (inverse * w.fx + n.gravity_x);
  b->vy = b->vy + half_step * (inverse * w.fy + n.gravity_y);
  b->vz = b->vz + half_step * (inverse * w.fz + n.gravity_z);
  const vec3 change = scale3_f64(half_step, make3_f64(w.tx, w.ty, w.tz));
  const quat q = turns[p];
  if (clumps) {
    const vec3 i = inertia[p];
    const vec3 l = add3_f64(rotate3(q, each_times(i, rotate3(conjugate(q), spin_of(b)))), change);
    set_spin(b, rotate3(q, each_over(rotate3(conjugate(q), l), i)));
    place_spheres(b, q, spheres, arms, first, last);
  } else {
    set_spin(b, add3_f64(spin_of(b), scale3_f64(b->aux, change)));
  }
  if (n.ledger) {
    const u64 stride = n.particles;
    const vec3 v = velocity_of(b), i = inertia[p], turn = rotate3(conjugate(q), spin_of(b));
    const double translation = 0.5 * b->m * dot3_f64(v, v);
    const double all = translation + 0.5 * (i.x * turn.x * turn.x + i.y * turn.y * turn.y + i.z * turn.z * turn.z);
    for (u32 k = 0; k < 8u; ++k) energy[k * stride + p] = 0.0;
    energy[2 * stride + p] = b->m * (n.gravity_x * b->x + n.gravity_y * b->y + n.gravity_z * b->z);
    energy[3 * stride + p] = translation;
    energy[4 * stride + p] = all - translation;
  }
  guard_particle(b, n, flags);
  for (u32 k = first; k < last; ++k) guard_margin((clumps ? spheres : body) + k, listed + k, margin[p], flags);
}

#endif
