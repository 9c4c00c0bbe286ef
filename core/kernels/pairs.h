/* pairs.h: the pair list of core/neighbour on a device: the same entries in the same order.
 *
 * Spheres of like reach share a level, a grid whose cells are as wide as its largest pair distance. A sphere looks at
 * the cells of its own level and of coarser ones within reach, first to count, then to note; atomics only count, and
 * rows are sorted by rank afterwards, so that nothing shows in which order items ran. */
#ifndef CALX_PAIRS_H
#define CALX_PAIRS_H

typedef struct level {
  double reach;                                    /* m, the largest of its spheres */
  double inverse;                                  /* 1/m, of the width of a cell */
  u32 low_x, low_y, low_z, high_x, high_y, high_z; /* cells of all spheres */
  u32 stride_y, stride_z, mask; /* number of a cell: x + stride_y y + stride_z z from the low corner, modulo mask + 1 */
  u32 start;                    /* its first cell in the table of all levels */
  u32 folded;                   /* cells far apart share a number */
  u32 spare;
} level;

/* What a cell holds. */
typedef struct seat {
  double x, y, z, reach; /* m, inside the box */
  u32 rank, owner;
} seat;

#define CELL_RANGE 1e9 /* cell coordinates are counted from so many cells before the origin */
#define CELL_SLACK 1e-6
#define NO_SPHERE 0xFFFFFFFFu

FN double cell_coordinate(double x, double origin, double inverse) {
  double c = (x - origin) * inverse;
  c = c < CELL_RANGE ? c : CELL_RANGE;
  c = c > -CELL_RANGE ? c : -CELL_RANGE;
  return c + CELL_RANGE;
}
FN u32 cell_at(double x, double origin, double inverse) { return (u32)cell_coordinate(x, origin, inverse); }
FN u32 cell_place(GLOBAL const level* g, u32 x, u32 y, u32 z) {
  return g->start + (((x - g->low_x) + (y - g->low_y) * g->stride_y + (z - g->low_z) * g->stride_z) & g->mask);
}

/* Numbers of spheres by reach. bounds: lower ends of rising classes, m. */
KERNEL(count_classes, step_numbers n, GLOBAL const record* RESTRICT spheres, GLOBAL const u32* RESTRICT owner,
       GLOBAL const double* RESTRICT margin, u32 classes, GLOBAL const double* RESTRICT bounds,
       GLOBAL u32* RESTRICT counts) {
  const u32 s = ITEM;
  if (s >= n.spheres) return;
  const double reach = spheres[s].r + margin[owner ? owner[s] : s] + n.half_pair_gap;
  u32 c = 0;
  for (u32 k = 1; k < classes; ++k) c = reach >= bounds[k] ? k : c;
  ATOMIC_ADD(counts + c, 1u);
}

KERNEL(count_cells, step_numbers n, vec3 origin, GLOBAL const record* RESTRICT spheres,
       GLOBAL const u32* RESTRICT owner, GLOBAL const double* RESTRICT margin, GLOBAL const level* RESTRICT levels,
       GLOBAL u32* RESTRICT counts, GLOBAL u32* RESTRICT cell_of, GLOBAL u32* RESTRICT level_of) {
  const u32 s = ITEM;
  if (s >= n.spheres) return;
  const vec3 p = inside_box(spheres + s, n);
  const double reach = spheres[s].r + margin[owner ? owner[s] : s] + n.half_pair_gap;
  u32 l = 0;
  while (reach > levels[l].reach) ++l;
  GLOBAL const level* g = levels + l;
  const u32 cell = cell_place(g, cell_at(p.x, origin.x, g->inverse), cell_at(p.y, origin.y, g->inverse),
                              cell_at(p.z, origin.z, g->inverse));
  cell_of[s] = cell;
  level_of[s] = l;
  ATOMIC_ADD(counts + cell, 1u);
}
/* Takes a seat in the cell; counts go back to zero. */
KERNEL(fill_cells, step_numbers n, GLOBAL const record* RESTRICT spheres, GLOBAL const u32* RESTRICT owner,
       GLOBAL const double* RESTRICT margin, GLOBAL const u32* RESTRICT cell_of, GLOBAL const u32* RESTRICT cell_start,
       GLOBAL u32* RESTRICT counts, GLOBAL seat* RESTRICT seats) {
  const u32 s = ITEM;
  if (s >= n.spheres) return;
  const u32 cell = cell_of[s], at = cell_start[cell] + ATOMIC_ADD(counts + cell, 0xFFFFFFFFu) - 1u;
  const vec3 p = inside_box(spheres + s, n);
  seat one;
  one.owner = owner ? owner[s] : s;
  one.x = p.x;
  one.y = p.y;
  one.z = p.z;
  one.reach = spheres[s].r + margin[one.owner] + n.half_pair_gap;
  one.rank = s;
  seats[at] = one;
}

/* What a search reads and writes. partner null: pairs are counted only. */
typedef struct search {
  double x, y, z, reach;
  u32 rank, owner;
} search;

FN void compare_seats(search q, u32 begin, u32 end, u32 only_higher, GLOBAL const level* g, vec3 origin, u32 cx, u32 cy,
                      u32 cz, GLOBAL const seat* seats, GLOBAL u32* counts, GLOBAL const u32* row_first,
                      GLOBAL u32* partner) {
  for (u32 k = begin; k < end; ++k) {
    GLOBAL const seat* b = seats + k;
    const double x = q.x - b->x, y = q.y - b->y, z = q.z - b->z, cut = q.reach + b->reach;
    if (!(x * x + y * y + z * z < cut * cut)) continue;
    if (b->owner == q.owner || (only_higher && b->rank <= q.rank)) continue;
    if (g->folded && (cell_at(b->x, origin.x, g->inverse) != cx || cell_at(b->y, origin.y, g->inverse) != cy ||
                      cell_at(b->z, origin.z, g->inverse) != cz))
      continue;
    const u32 lower = MIN(q.rank, b->rank), higher = MAX(q.rank, b->rank);
    const u32 at = ATOMIC_ADD(counts + lower, 1u);
    if (partner) partner[row_first[lower] + at] = higher;
  }
}

FN u32 window_low(double at, double far, u32 low) {
  const double first = at - far;
  return first > (double)low ? (u32)first : low;
}
FN u32 window_high(double at, double far, u32 high) {
  const double last = at + far;
  return last < (double)high ? (u32)(last > 0.0 ? last : 0.0) : high;
}

/* All cells of a level that q can reach. */
FN void search_window(search q, u32 only_higher, GLOBAL const level* g, vec3 origin, GLOBAL const u32* cell_start,
                      GLOBAL const seat* seats, GLOBAL u32* counts, GLOBAL const u32* row_first, GLOBAL u32* partner) {
  /* In cells, with slack for the rounding of both spheres' coordinates. */
  const double far = (q.reach + g->reach) * g->inverse + CELL_SLACK;
  const double at_x = cell_coordinate(q.x, origin.x, g->inverse), at_y = cell_coordinate(q.y, origin.y, g->inverse),
               at_z = cell_coordinate(q.z, origin.z, g->inverse);
  const u32 x0 = window_low(at_x, far, g->low_x), x1 = window_high(at_x, far, g->high_x);
  const u32 y0 = window_low(at_y, far, g->low_y), y1 = window_high(at_y, far, g->high_y);
  const u32 z0 = window_low(at_z, far, g->low_z), z1 = window_high(at_z, far, g->high_z);
  if (x0 > x1) return;
  for (u32 z = z0; z <= z1; ++z)
    for (u32 y = y0; y <= y1; ++y) {
      if (!g->folded) {
        const u32 first = cell_place(g, x0, y, z);
        compare_seats(q, cell_start[first], cell_start[first + (x1 - x0) + 1u], only_higher, g, origin, 0u, 0u, 0u,
                      seats, counts, row_first, partner);
        continue;
      }
      for (u32 x = x0; x <= x1; ++x) {
        const u32 cell = cell_place(g, x, y, z);
        compare_seats(q, cell_start[cell], cell_start[cell + 1u], only_higher, g, origin, x, y, z, seats, counts,
                      row_first, partner);
      }
    }
}

/* Shifts by -1, 0, 1 periods whose image can reach the box: first << 2 | last, each plus one. */
FN u32 image_range(u32 periodic, double x, double low, double period, double far) {
  if (!periodic) return 1u << 2 | 1u;
  const double below = x - low;
  return (period - below < far ? 0u : 1u) << 2 | (below < far ? 2u : 1u);
}

/* Pairs of sphere ITEM. counts: of each lower sphere, zero before; row_first, partner: null when pairs are counted. */
KERNEL(search_pairs, step_numbers n, vec3 origin, GLOBAL const record* RESTRICT spheres,
       GLOBAL const u32* RESTRICT owner, GLOBAL const double* RESTRICT margin, u32 level_count,
       GLOBAL const level* RESTRICT levels, GLOBAL const u32* RESTRICT level_of, GLOBAL const u32* RESTRICT cell_start,
       GLOBAL const seat* RESTRICT seats, GLOBAL u32* RESTRICT counts, GLOBAL const u32* RESTRICT row_first,
       GLOBAL u32* RESTRICT partner) {
  const u32 s = ITEM;
  if (s >= n.spheres) return;
  const vec3 p = inside_box(spheres + s, n);
  search q;
  q.owner = owner ? owner[s] : s;
  q.reach = spheres[s].r + margin[q.owner] + n.half_pair_gap;
  q.rank = s;
  for (u32 l = level_of[s]; l < level_count; ++l) {
    GLOBAL const level* g = levels + l;
    const u32 own = l == level_of[s];
    const double far = (q.reach + g->reach) * (1.0 + CELL_SLACK);
    const u32 range_x = image_range(n.periodic_x, p.x, n.low_x, n.length_x, far),
              range_y = image_range(n.periodic_y, p.y, n.low_y, n.length_y, far),
              range_z = image_range(n.periodic_z, p.z, n.low_z, n.length_z, far);
    for (u32 c = range_z >> 2; c <= (range_z & 3u); ++c)
      for (u32 b = range_y >> 2; b <= (range_y & 3u); ++b)
        for (u32 a = range_x >> 2; a <= (range_x & 3u); ++a) {
          q.x = a == 1u ? p.x : p.x + ((double)a - 1.0) * n.length_x;
          q.y = b == 1u ? p.y : p.y + ((double)b - 1.0) * n.length_y;
          q.z = c == 1u ? p.z : p.z + ((double)c - 1.0) * n.length_z;
          search_window(q, own, g, origin, cell_start, seats, counts, row_first, partner);
        }
  }
}

/* Shell's sort: rows are short, and a large sphere among many small ones has a long one. */
FN void sort_rising(GLOBAL u32* row, u32 count) {
  for (u32 gap = count > 40u ? 121u : count > 13u ? 13u : count > 4u ? 4u : 1u; gap > 0; gap /= 3u)
    for (u32 k = gap; k < count; ++k) {
      const u32 one = row[k];
      u32 at = k;
      for (; at >= gap && row[at - gap] > one; at -= gap) row[at] = row[at - gap];
      row[at] = one;
    }
}

/* Rows in rising order; how often each sphere is the second is counted. */
KERNEL(sort_pairs, u32 count, GLOBAL const u32* RESTRICT row_first, GLOBAL u32* RESTRICT first,
       GLOBAL u32* RESTRICT second, GLOBAL u32* RESTRICT in_count) {
  const u32 s = ITEM;
  if (s >= count) return;
  const u32 begin = row_first[s], end = row_first[s + 1];
  sort_rising(second + begin, end - begin);
  for (u32 e = begin; e < end; ++e) {
    first[e] = s;
    ATOMIC_ADD(in_count + second[e], 1u);
  }
}
KERNEL(note_incoming, u32 entries, GLOBAL const u32* RESTRICT second, GLOBAL const u32* RESTRICT in_first,
       GLOBAL u32* RESTRICT in_count, GLOBAL u32* RESTRICT in_entry) {
  const u32 e = ITEM;
  if (e >= entries) return;
  const u32 j = second[e];
  in_entry[in_first[j] + ATOMIC_ADD(in_count + j, 0xFFFFFFFFu) - 1u] = e;
}
/* chunk_length: particles. */
KERNEL(sort_incoming, u32 count, u32 chunk_length, GLOBAL const u32* RESTRICT owner,
       GLOBAL const u32* RESTRICT first_sphere, GLOBAL const u32* RESTRICT first, GLOBAL const u32* RESTRICT in_first,
       GLOBAL u32* RESTRICT in_middle, GLOBAL u32* RESTRICT in_entry) {
  const u32 s = ITEM;
  if (s >= count) return;
  const u32 begin = in_first[s], end = in_first[s + 1];
  sort_rising(in_entry + begin, end - begin);
  const u32 chunk_particle = (owner ? owner[s] : s) / chunk_length * chunk_length;
  const u32 chunk_sphere = owner ? first_sphere[chunk_particle] : chunk_particle;
  u32 middle = begin;
  while (middle < end && first[in_entry[middle]] < chunk_sphere) ++middle;
  in_middle[s] = middle;
}

/* History of entries that were in the list before. list_rank: of each sphere in that list, NO_SPHERE for a new one;
 * odd: columns that change sign with the order of the two, for each material pair. */
KERNEL(carry_pairs, step_numbers n, u32 old_spheres, GLOBAL const u32* RESTRICT list_rank,
       GLOBAL const u32* RESTRICT material, GLOBAL const u32* RESTRICT odd, GLOBAL const u32* RESTRICT old_first,
       GLOBAL const u32* RESTRICT old_second, GLOBAL const u8* RESTRICT old_touching,
       GLOBAL const double* RESTRICT old_history, GLOBAL const u32* RESTRICT first, GLOBAL const u32* RESTRICT second,
       GLOBAL u8* RESTRICT touching, GLOBAL double* RESTRICT history) {
  const u32 e = ITEM;
  if (e >= n.entries) return;
  const u32 i = first[e], j = second[e], a = list_rank[i], b = list_rank[j];
  touching[e] = 0;
  if (a >= old_spheres || b >= old_spheres) return;
  const u32 low = MIN(a, b), high = MAX(a, b);
  u32 from = old_first[low], to = old_first[low + 1];
  const u32 end = to;
  while (from < to) {
    const u32 middle = from + (to - from) / 2u;
    if (old_second[middle] < high)
      from = middle + 1u;
    else
      to = middle;
  }
  if (from == end || old_second[from] != high || !old_touching[from]) return;
  touching[e] = 1;
  const u64 pair = (u64)(material[i] * n.materials + material[j]) * n.columns;
  for (u32 k = 0; k < n.columns; ++k) {
    const double value = old_history[(u64)from * n.columns + k];
    history[(u64)e * n.columns + k] = a > b && odd[pair + k] ? -value : value;
  }
}

#endif
