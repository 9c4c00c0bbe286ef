/* walls.h: contacts between spheres and parts: first where they touch, then what the laws say. */
#ifndef CALX_WALLS_H
#define CALX_WALLS_H

/* A part at the instant of the contacts; tables hold the parts of the steps to come one after the other. */
typedef struct part_state {
  quat turn;
  vec3 shift, centre, velocity, spin;
  u32 shape, material;
} part_state;

/* A contact keeps its history while its normal turns by less than about 45 degrees in one step. */
#define SAME_CONTACT 0.7
/* Values of a contact, in columns 4 * wall_rows apart, contacts of a row in the order found: force and torque on the
 * sphere, torque on the part, work done by the part. */
#define WALL_VALUES 10u

/* Where the spheres touch: contacts of each row, deepest first, at row * WALL_CONTACTS + number, and the slot of
 * history that each has. */
typedef struct wall_touch {
  vec3 normal;     /* part frame */
  double distance; /* m, of the sphere's centre */
  u32 slot, old;   /* old: it touched at the last step */
} wall_touch;

KERNEL(find_wall_contacts, step_numbers n, GLOBAL const record* RESTRICT spheres, GLOBAL const u32* RESTRICT material,
       GLOBAL const u32* RESTRICT row_sphere, GLOBAL const u32* RESTRICT row_part,
       GLOBAL const u32* RESTRICT first_element, GLOBAL const u32* RESTRICT elements,
       GLOBAL const part_state* RESTRICT parts, GLOBAL const double* RESTRICT gaps, SHAPE_TABLES,
       GLOBAL u8* RESTRICT touching, GLOBAL vec3* RESTRICT normals, GLOBAL u32* RESTRICT counts,
       GLOBAL wall_touch* RESTRICT touches, GLOBAL const u32* RESTRICT flags) {
  const u32 row = ITEM;
  if (row >= n.wall_rows || flags[FLAG_STOP]) return;
  GLOBAL const record* a = spheres + row_sphere[row];
  GLOBAL const part_state* part = parts + ((u64)flags[FLAG_DONE] * n.part_stride + row_part[row]);
  GLOBAL const shape* s = shapes + part->shape;
  const vec3 centre = position_of(a);
  const vec3 at_part = rotate3(conjugate(part->turn), sub3_f64(centre, part->shift));
#ifdef CALX_REACHES
  const u32 pair = material[row_sphere[row]] * n.materials + part->material;
  const double radius = a->r + gaps[n.materials * n.materials + pair];
#else
  const double radius = a->r;
#endif
  minima m;
  m.count = 0;
  m.same2 = 16.0 * s->tolerance * s->tolerance;
  on_axis place;
  place.r = 0.0;
  place.z = 0.0;
  place.radial = make3_f64(0.0, 0.0, 0.0);
  u32 known = 0xFFFFFFFFu;
  for (u32 k = first_element[row]; k < first_element[row + 1]; ++k) {
    const u32 element = elements[k];
    if (element < s->triangle_count) {
      triangle_minima(triangles + s->triangles + element, edges + s->edges, vertices + s->vertices,
                      inwards + s->inwards, directions + s->directions, element, at_part, radius, s->tolerance, &m);
      continue;
    }
    GLOBAL const segment* piece = segments + s->segments + (element - s->triangle_count);
    GLOBAL const axis* own_axis = axes + s->axes + piece->axis;
    if (piece->axis != known) place = to_axis(own_axis, at_part, s->size);
    known = piece->axis;
    segment_minima(piece, own_axis, points + s->points, alongs + s->alongs, element, place, radius, s->tolerance, &m);
  }
  merge_minima(&m);
  const u32 count = m.count < WALL_CONTACTS ? m.count : WALL_CONTACTS;
  const u32 slot0 = row * WALL_CONTACTS;
  counts[row] = count;
  if (count == 0) {
    for (u32 k = 0; k < WALL_CONTACTS; ++k) touching[slot0 + k] = 0;
    return;
  }
  /* Each contact takes the slot whose normal of the last step is nearest; what is left over starts afresh. */
  u32 slot_of[WALL_CONTACTS];
  u32 taken = 0, old = 0; /* bits */
  for (u32 k = 0; k < count; ++k) {
    slot_of[k] = WALL_CONTACTS;
    double best = SAME_CONTACT;
    for (u32 q = 0; q < WALL_CONTACTS; ++q) {
      if (!touching[slot0 + q] || (taken >> q & 1u)) continue;
      const double alike = dot3_f64(normals[slot0 + q], m.found[k].normal);
      if (alike > best) {
        best = alike;
        slot_of[k] = q;
      }
    }
    if (slot_of[k] < WALL_CONTACTS) taken |= 1u << slot_of[k];
  }
  old = taken;
  for (u32 k = 0; k < count; ++k) {
    for (u32 q = 0; q < WALL_CONTACTS && slot_of[k] == WALL_CONTACTS; ++q)
      if (!(taken >> q & 1u)) {
        slot_of[k] = q;
        taken |= 1u << q;
      }
    normals[slot0 + slot_of[k]] = m.found[k].normal;
  }
  for (u32 q = 0; q < WALL_CONTACTS; ++q) touching[slot0 + q] = (u8)(taken >> q & 1u);
  for (u32 k = 0; k < count; ++k) {
    GLOBAL wall_touch* t = touches + (slot0 + k);
    t->normal = m.found[k].normal;
    t->distance = m.found[k].distance;
    t->slot = slot_of[k];
    t->old = old >> slot_of[k] & 1u;
  }
}

/* Laws of the contacts found, one item for each place of a contact; times: of the steps to come, s. */
KERNEL(wall_contacts, step_numbers n, GLOBAL const record* RESTRICT spheres, GLOBAL const u32* RESTRICT material,
       GLOBAL const u32* RESTRICT row_sphere, GLOBAL const u32* RESTRICT row_part,
       GLOBAL const part_state* RESTRICT parts, GLOBAL const u32* RESTRICT counts,
       GLOBAL const wall_touch* RESTRICT touches, GLOBAL double* RESTRICT history, u64 history_stride,
       GLOBAL const u32* RESTRICT law_of, GLOBAL const double* RESTRICT law_numbers,
       GLOBAL const double* RESTRICT times, GLOBAL double* RESTRICT out, GLOBAL double* RESTRICT share,
       GLOBAL double* RESTRICT energy, GLOBAL u32* RESTRICT flags) {
  const u32 at = ITEM, row = at / WALL_CONTACTS, slot0 = row * WALL_CONTACTS;
  if (row >= n.wall_rows || flags[FLAG_STOP] || at - slot0 >= counts[row]) return;
  GLOBAL const record* a = spheres + row_sphere[row];
  GLOBAL const part_state* part = parts + ((u64)flags[FLAG_DONE] * n.part_stride + row_part[row]);
  GLOBAL const wall_touch* t = touches + at;
  const vec3 centre = position_of(a);
  const u32 pair = material[row_sphere[row]] * n.materials + part->material;
  const u64 stride = (u64)n.wall_rows * WALL_CONTACTS;
  const double distance = t->distance;
  const vec3 normal = rotate3(part->turn, t->normal);
  const vec3 arm = scale3_f64(-distance, normal);
  const vec3 point = add3_f64(centre, arm);
  const vec3 lever = sub3_f64(point, part->centre);
  const vec3 wall = add3_f64(part->velocity, cross3_f64(part->spin, lever));
  const vec3 v = sub3_f64(add3_f64(velocity_of(a), cross3_f64(spin_of(a), arm)), wall);
  const vec3 spin = sub3_f64(spin_of(a), part->spin);
  calx_contact_f64 c;
  c.overlap = a->r - distance;
  c.nx = normal.x;
  c.ny = normal.y;
  c.nz = normal.z;
  c.vx = v.x;
  c.vy = v.y;
  c.vz = v.z;
  c.wx = spin.x;
  c.wy = spin.y;
  c.wz = spin.z;
  c.r_eff = a->r;
  c.m_eff = a->m;
  c.r_i = a->r;
  c.r_j = 0.0;
  c.dt = n.dt;
  c.time = times[flags[FLAG_DONE]];
  for (u32 k = 0; !t->old && k < n.columns; ++k) history[k * history_stride + slot0 + t->slot] = 0.0;
  calx_wrench_f64 w;
  if (!calx_contact_laws_f64(law_of[pair], &c, history + (slot0 + t->slot), history_stride, !t->old, law_numbers, &w)) {
    ATOMIC_MAX(flags + FLAG_MISSING_LAW, pair + 1u);
    return;
  }
  const vec3 f = make3_f64(w.fx, w.fy, w.fz), moment = make3_f64(w.mx, w.my, w.mz);
  const vec3 on_sphere = add3_f64(cross3_f64(arm, f), moment), on_part = add3_f64(cross3_f64(lever, f), moment);
  out[at] = f.x;
  out[stride + at] = f.y;
  out[2 * stride + at] = f.z;
  out[3 * stride + at] = on_sphere.x;
  out[4 * stride + at] = on_sphere.y;
  out[5 * stride + at] = on_sphere.z;
  out[6 * stride + at] = on_part.x;
  out[7 * stride + at] = on_part.y;
  out[8 * stride + at] = on_part.z;
  out[9 * stride + at] = (dot3_f64(f, wall) + dot3_f64(moment, part->spin)) * n.dt;
  share[at] = c.overlap / a->r;
  if (n.ledger) {
    energy[at] = w.elastic;
    energy[stride + at] = w.friction;
    energy[2 * stride + at] = w.damping;
    energy[3 * stride + at] = w.plastic;
  }
}

#endif
