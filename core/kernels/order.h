/* order.h: particles before a search: back into a periodic box, along a Morton curve, in a new order. Places and orders
 * are those of core/neighbour/morton.cpp and Engine::rebuild. */
#ifndef CALX_ORDER_H
#define CALX_ORDER_H

#define WRAP_SPAN 64u

FN double into_box(GLOBAL record* b, double x, double low, double period, double pull, double* work) {
  const double shift = x < low ? period : x >= low + period ? -period : 0.0;
  if (shift == 0.0) return x;
  *work += b->m * pull * shift;
  return x + shift;
}

/* work: of gravity that the faces took, J, by spans of particles. arms, turns, spheres: of clumps. */
KERNEL(wrap_particles, step_numbers n, u32 clumps, GLOBAL record* RESTRICT body, GLOBAL record* RESTRICT spheres,
       GLOBAL const quat* RESTRICT turns, GLOBAL const u32* RESTRICT first_sphere, GLOBAL const vec3* RESTRICT arms,
       GLOBAL double* RESTRICT work) {
  const u32 span = ITEM;
  if (span >= (n.particles + WRAP_SPAN - 1) / WRAP_SPAN) return;
  double sum = 0.0;
  for (u32 p = span * WRAP_SPAN; p < MIN(n.particles, (span + 1) * WRAP_SPAN); ++p) {
    GLOBAL record* b = body + p;
    if (n.periodic_x) b->x = into_box(b, b->x, n.low_x, n.length_x, n.gravity_x, &sum);
    if (n.periodic_y) b->y = into_box(b, b->y, n.low_y, n.length_y, n.gravity_y, &sum);
    if (n.periodic_z) b->z = into_box(b, b->z, n.low_z, n.length_z, n.gravity_z, &sum);
    if (clumps) place_spheres(b, turns[p], spheres, arms, first_sphere[p], first_sphere[p + 1]);
  }
  work[span] = sum;
}

/* One item. total: what faces took so far, J. */
KERNEL(add_wrapped, u32 spans, GLOBAL const double* RESTRICT work, GLOBAL double* RESTRICT totals, u32 place) {
  if (ITEM > 0) return;
  double sum = totals[place];
  for (u32 s = 0; s < spans; ++s) sum += work[s];
  totals[place] = sum;
}

/* Corners of all places, m, then the smallest and the largest reach. */
#define EXTENT_RUN 64u
typedef struct extent {
  double low_x, low_y, low_z, high_x, high_y, high_z, smallest, largest;
} extent;
FN void join_extent(extent* a, extent b) {
  a->low_x = b.low_x < a->low_x ? b.low_x : a->low_x;
  a->low_y = b.low_y < a->low_y ? b.low_y : a->low_y;
  a->low_z = b.low_z < a->low_z ? b.low_z : a->low_z;
  a->high_x = b.high_x > a->high_x ? b.high_x : a->high_x;
  a->high_y = b.high_y > a->high_y ? b.high_y : a->high_y;
  a->high_z = b.high_z > a->high_z ? b.high_z : a->high_z;
  a->smallest = b.smallest < a->smallest ? b.smallest : a->smallest;
  a->largest = b.largest > a->largest ? b.largest : a->largest;
}
FN extent no_extent(void) {
  extent e;
  e.low_x = e.low_y = e.low_z = e.smallest = 1e300;
  e.high_x = e.high_y = e.high_z = -1e300;
  e.largest = 0.0;
  return e;
}

/* A coordinate in the box; see Wrap::inside. */
FN double inside_period(double x, double low, double period) {
  if (x >= low && x < low + period) return x;
  return x - period * floor_f64((x - low) / period);
}
FN vec3 inside_box(GLOBAL const record* s, step_numbers n) {
  vec3 p = position_of(s);
  if (n.periodic_x) p.x = inside_period(p.x, n.low_x, n.length_x);
  if (n.periodic_y) p.y = inside_period(p.y, n.low_y, n.length_y);
  if (n.periodic_z) p.z = inside_period(p.z, n.low_z, n.length_z);
  return p;
}

/* Of runs of count spheres, inside the box. owner: null where each sphere is a particle. */
KERNEL(measure_spheres, step_numbers n, u32 count, GLOBAL const record* RESTRICT spheres,
       GLOBAL const u32* RESTRICT owner, GLOBAL const double* RESTRICT margin, GLOBAL extent* RESTRICT out) {
  const u32 run = ITEM;
  if (run >= (count + EXTENT_RUN - 1) / EXTENT_RUN) return;
  extent all = no_extent();
  for (u32 k = run * EXTENT_RUN; k < MIN(count, (run + 1) * EXTENT_RUN); ++k) {
    const vec3 p = inside_box(spheres + k, n);
    extent one;
    one.low_x = one.high_x = p.x;
    one.low_y = one.high_y = p.y;
    one.low_z = one.high_z = p.z;
    one.smallest = one.largest = spheres[k].r + margin[owner ? owner[k] : k] + n.half_pair_gap;
    join_extent(&all, one);
  }
  out[run] = all;
}
/* Of particles as they stand. */
KERNEL(measure_particles, u32 count, GLOBAL const record* RESTRICT body, GLOBAL extent* RESTRICT out) {
  const u32 run = ITEM;
  if (run >= (count + EXTENT_RUN - 1) / EXTENT_RUN) return;
  extent all = no_extent();
  for (u32 k = run * EXTENT_RUN; k < MIN(count, (run + 1) * EXTENT_RUN); ++k) {
    extent one;
    one.low_x = one.high_x = body[k].x;
    one.low_y = one.high_y = body[k].y;
    one.low_z = one.high_z = body[k].z;
    one.smallest = one.largest = 0.0;
    join_extent(&all, one);
  }
  out[run] = all;
}
KERNEL(join_extents, u32 count, GLOBAL const extent* RESTRICT in, GLOBAL extent* RESTRICT out) {
  const u32 run = ITEM;
  if (run >= (count + EXTENT_RUN - 1) / EXTENT_RUN) return;
  extent all = no_extent();
  for (u32 k = run * EXTENT_RUN; k < MIN(count, (run + 1) * EXTENT_RUN); ++k) join_extent(&all, in[k]);
  out[run] = all;
}

/* Bits 0 .. 20 of v, two zeros after each. */
FN u64 spread_bits(u64 v) {
  v &= 0x1FFFFFul;
  v = (v | v << 32) & 0x1F00000000FFFFul;
  v = (v | v << 16) & 0x1F0000FF0000FFul;
  v = (v | v << 8) & 0x100F00F00F00F00Ful;
  v = (v | v << 4) & 0x10C30C30C30C30C3ul;
  v = (v | v << 2) & 0x1249249249249249ul;
  return v;
}
FN u64 cell_number(double x) { return (u64)(x < 9e18 ? x : 9e18); }

/* inverse: of the width of a cell, 1/m; corner: of all particles; used: bits that some key has, two words. */
KERNEL(morton_keys, u32 count, double inverse, GLOBAL const record* RESTRICT body, GLOBAL const extent* RESTRICT corner,
       GLOBAL u64* RESTRICT keys, GLOBAL u32* RESTRICT order, GLOBAL u32* RESTRICT used) {
  const u32 p = ITEM;
  if (p >= count) return;
  const u64 key = spread_bits(cell_number((body[p].x - corner->low_x) * inverse)) |
                  spread_bits(cell_number((body[p].y - corner->low_y) * inverse)) << 1 |
                  spread_bits(cell_number((body[p].z - corner->low_z) * inverse)) << 2;
  keys[p] = key;
  order[p] = p;
  ATOMIC_OR(used, (u32)key);
  ATOMIC_OR(used + 1, (u32)(key >> 32));
}

/* A stable sort by eight bits of the key from `shift` on: blocks of the list count and move their own entries. counts:
 * of a digit and a block at digit * blocks + block; scanned in between. */
#define SORT_BLOCK 512u
#define SORT_DIGITS 256u
KERNEL(count_digits, u32 count, u32 blocks, u32 shift, GLOBAL const u64* RESTRICT keys, GLOBAL u32* RESTRICT counts) {
  const u32 block = ITEM;
  if (block >= blocks) return;
  for (u32 d = 0; d < SORT_DIGITS; ++d) counts[d * blocks + block] = 0;
  for (u32 k = block * SORT_BLOCK; k < MIN(count, (block + 1) * SORT_BLOCK); ++k)
    counts[(u32)(keys[k] >> shift & 255u) * blocks + block] += 1u;
}
KERNEL(move_by_digit, u32 count, u32 blocks, u32 shift, GLOBAL const u64* RESTRICT keys,
       GLOBAL const u32* RESTRICT order, GLOBAL u32* RESTRICT next, GLOBAL u64* RESTRICT to_keys,
       GLOBAL u32* RESTRICT to_order) {
  const u32 block = ITEM;
  if (block >= blocks) return;
  for (u32 k = block * SORT_BLOCK; k < MIN(count, (block + 1) * SORT_BLOCK); ++k) {
    const u32 digit = (u32)(keys[k] >> shift & 255u) * blocks + block;
    const u32 at = next[digit];
    next[digit] = at + 1u;
    to_keys[at] = keys[k];
    to_order[at] = order[k];
  }
}

/* Rows of `words` u32 each: row k of `to` is row order[k] of `from`. One item for each word. */
KERNEL(take_rows, u32 items, u32 words, GLOBAL const u32* RESTRICT order, GLOBAL const u32* RESTRICT from,
       GLOBAL u32* RESTRICT to) {
  if (ITEM >= items) return;
  const u32 item = ITEM, row = item / words;
  to[item] = from[(u64)order[row] * words + (item - row * words)];
}

/* Numbers of spheres of particles in a new order. */
KERNEL(count_members, u32 count, GLOBAL const u32* RESTRICT order, GLOBAL const u32* RESTRICT first_sphere,
       GLOBAL u32* RESTRICT members) {
  if (ITEM >= count) return;
  const u32 p = order[ITEM];
  members[ITEM] = first_sphere[p + 1] - first_sphere[p];
}
/* Where each sphere of the new order stood, and whose it is. */
KERNEL(order_members, u32 count, GLOBAL const u32* RESTRICT order, GLOBAL const u32* RESTRICT old_first,
       GLOBAL const u32* RESTRICT new_first, GLOBAL u32* RESTRICT sphere_order, GLOBAL u32* RESTRICT owner) {
  if (ITEM >= count) return;
  const u32 p = ITEM, from = old_first[order[p]], first = new_first[p];
  for (u32 k = first; k < new_first[p + 1]; ++k) {
    sphere_order[k] = from + (k - first);
    owner[k] = p;
  }
}

/* Margins from speeds, m: share is kListSteps * dt, s. */
KERNEL(set_margins, u32 count, double share, double smallest, double largest, GLOBAL const record* RESTRICT body,
       GLOBAL double* RESTRICT margin) {
  if (ITEM >= count) return;
  const double way = share * length3_f64(velocity_of(body + ITEM));
  margin[ITEM] = way < smallest ? smallest : (largest < way ? largest : way);
}

/* After lists were built: where spheres stood, and that each has the rank it had then. */
KERNEL(keep_places, u32 count, GLOBAL const record* RESTRICT spheres, GLOBAL vec3* RESTRICT listed,
       GLOBAL u32* RESTRICT list_rank) {
  if (ITEM >= count) return;
  listed[ITEM] = position_of(spheres + ITEM);
  list_rank[ITEM] = ITEM;
}

#endif
