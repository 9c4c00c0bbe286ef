/* world.h: what kernels of a step see of the world. Structures have the layout of their namesakes in core/store,
 * core/motion and core/geometry; every operation stands in the order that the host's code has, so that both give the
 * same bits. SI units, world frame unless said. */
#ifndef CALX_WORLD_H
#define CALX_WORLD_H

typedef vec3_f64 vec3;

/* A sphere, or a particle (r: bounding radius); see Record. */
typedef struct record {
  double x, y, z, r;    /* m */
  double vx, vy, vz, m; /* m/s; kg */
  double wx, wy, wz;    /* rad/s */
  double aux;           /* particle of one sphere: 1 / moment of inertia */
} record;

typedef struct quat {
  double w, x, y, z;
} quat;

/* Numbers of a step. */
typedef struct step_numbers {
  double dt;                              /* s */
  double overlap_limit;                   /* of the radius */
  double gravity_x, gravity_y, gravity_z; /* m/s^2 */
  double low_x, low_y, low_z;             /* m, of the domain */
  double high_x, high_y, high_z;
  double length_x, length_y, length_z; /* m, of a period */
  double half_pair_gap, wall_gap;      /* m, half of the largest gap at which laws act between spheres; with parts */
  u32 periodic_x, periodic_y, periodic_z;
  u32 spheres, particles, entries, wall_rows, chunks, parts;
  u32 materials, columns; /* columns of history */
  u32 ledger;             /* energies are kept */
  u32 forces;             /* there are forces on single particles */
  u32 part_stride;        /* from the parts of a step to those of the next: parts, or 0 where none moves */
} step_numbers;

/* Contacts of one row of the wall list, at most. */
#define WALL_CONTACTS 4u

/* Flags. Steps follow each other without the host until STOP is raised, which ends all kernels after it at once. */
#define FLAG_STALE 0u
#define FLAG_GUARD 1u       /* a number that is not finite, or a particle outside */
#define FLAG_MISSING_LAW 2u /* 1 + number of the material pair */
#define FLAG_OVERLAP 3u     /* an overlap beyond the limit */
#define FLAG_DONE 4u        /* steps done since the host looked */
#define FLAG_DRIFTED 5u     /* verlet: the step after those has had its first half */
#define FLAG_STOP 6u

typedef struct wrench {
  double fx, fy, fz, tx, ty, tz; /* N, N m */
} wrench;

#define position_of(b) make3_f64((b)->x, (b)->y, (b)->z)
#define velocity_of(b) make3_f64((b)->vx, (b)->vy, (b)->vz)
#define spin_of(b) make3_f64((b)->wx, (b)->wy, (b)->wz)

FN vec3 negative(vec3 a) { return make3_f64(-a.x, -a.y, -a.z); }

FN quat conjugate(quat q) {
  quat c;
  c.w = q.w;
  c.x = -q.x;
  c.y = -q.y;
  c.z = -q.z;
  return c;
}
FN vec3 rotate3(quat q, vec3 v) {
  const vec3 u = make3_f64(q.x, q.y, q.z);
  const vec3 t = scale3_f64(2.0, cross3_f64(u, v));
  return add3_f64(add3_f64(v, scale3_f64(q.w, t)), cross3_f64(u, t));
}

FN void set_spin(GLOBAL record* b, vec3 w) {
  b->wx = w.x;
  b->wy = w.y;
  b->wz = w.z;
}

/* Puts the spheres of a clump where its body is. arms: of the spheres, m, principal frame. */
FN void place_spheres(GLOBAL const record* b, quat turn, GLOBAL record* spheres, GLOBAL const vec3* arms, u32 first,
                      u32 last) {
  const vec3 spin = spin_of(b);
  for (u32 k = first; k < last; ++k) {
    const vec3 arm = rotate3(turn, arms[k]), v = cross3_f64(spin, arm);
    GLOBAL record* m = spheres + k;
    m->x = b->x + arm.x;
    m->y = b->y + arm.y;
    m->z = b->z + arm.z;
    m->vx = b->vx + v.x;
    m->vy = b->vy + v.y;
    m->vz = b->vz + v.z;
    set_spin(m, spin);
  }
}

/* Shortest image of a difference along one direction. */
FN double nearest_image(double d, double period) {
  d = d > 0.5 * period ? d - period : d;
  return d < -0.5 * period ? d + period : d;
}

#endif
