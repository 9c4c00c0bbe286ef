/* rows.h: the wall list of core/neighbour on a device: rows of spheres near parts with the elements near each, in the
 * same order. */
#ifndef CALX_ROWS_H
#define CALX_ROWS_H

/* A part when the list is built. */
typedef struct part_place {
  quat turn;
  vec3 shift;    /* m */
  double margin; /* m */
  u32 present, shape;
} part_place;

/* A tree of boxes over the elements of a shape, parents before their children: after a box that is too far `skip` is
 * the next to look at. A leaf has the elements from first on. */
typedef struct tree_node {
  vec3 low, high; /* m, part frame */
  u32 skip, first, count, spare;
} tree_node;
/* Where the tree of a part's shape begins in the tables of all shapes. */
typedef struct tree_place {
  u32 first, last, elements, spare;
} tree_place;

FN double clamped(double x, double low, double high) {
  x = x < low ? low : x;
  return high < x ? high : x;
}
FN double gap2(double x, double low, double high) {
  const double d = x < low ? low - x : x > high ? x - high : 0.0;
  return d * d;
}
FN double box_distance2(GLOBAL const tree_node* b, vec3 p) {
  double sum = 0.0;
  sum += gap2(p.x, b->low.x, b->high.x);
  sum += gap2(p.y, b->low.y, b->high.y);
  sum += gap2(p.z, b->low.z, b->high.z);
  return sum;
}

FN double to_side(vec3 inward, vec3 corner, vec3 next, vec3 p, double best) {
  const vec3 q = sub3_f64(p, corner);
  if (dot3_f64(inward, q) >= 0.0) return best;
  const vec3 side = sub3_f64(next, corner);
  const double along = clamped(dot3_f64(q, side) / dot3_f64(side, side), 0.0, 1.0);
  const double distance = length3_f64(sub3_f64(q, scale3_f64(along, side)));
  return distance < best ? distance : best;
}
/* From p to one element, m; see core/geometry/elements.cpp. */
FN double element_distance(GLOBAL const shape* s, GLOBAL const triangle* triangles, GLOBAL const axis* axes,
                           GLOBAL const segment* segments, u32 element, vec3 p) {
  if (element < s->triangle_count) {
    GLOBAL const triangle* t = triangles + s->triangles + element;
    double best = to_side(t->inward0, t->corner0, t->corner1, p, 1e300);
    best = to_side(t->inward1, t->corner1, t->corner2, p, best);
    best = to_side(t->inward2, t->corner2, t->corner0, p, best);
    return best < 1e300 ? best : abs_f64(dot3_f64(t->normal, sub3_f64(p, t->corner0)));
  }
  GLOBAL const segment* g = segments + s->segments + (element - s->triangle_count);
  const on_axis o = to_axis(axes + s->axes + g->axis, p, s->size);
  const double qr = o.r - g->a.r, qz = o.z - g->a.z;
  const double along = clamped(qr * g->along.r + qz * g->along.z, 0.0, g->span);
  const double dr = qr - along * g->along.r, dz = qz - along * g->along.z;
  return sqrt_f64(dr * dr + dz * dz);
}

/* Rows and elements of sphere ITEM: counted where elements is null, else written from row_first and element_first on.
 * factor: of the margin of particles. */
KERNEL(search_parts, step_numbers n, double factor, GLOBAL const record* RESTRICT spheres,
       GLOBAL const u32* RESTRICT owner, GLOBAL const double* RESTRICT margin, GLOBAL const part_place* RESTRICT parts,
       GLOBAL const shape* RESTRICT shapes, GLOBAL const triangle* RESTRICT triangles, GLOBAL const axis* RESTRICT axes,
       GLOBAL const segment* RESTRICT segments, GLOBAL const tree_place* RESTRICT trees,
       GLOBAL const tree_node* RESTRICT nodes, GLOBAL const u32* RESTRICT tree_elements, GLOBAL u32* RESTRICT row_first,
       GLOBAL u32* RESTRICT element_first, GLOBAL u32* RESTRICT row_sphere, GLOBAL u32* RESTRICT row_part,
       GLOBAL u32* RESTRICT first_element, GLOBAL u32* RESTRICT elements) {
  const u32 s = ITEM;
  if (s >= n.spheres) return;
  const double reach = spheres[s].r + factor * margin[owner ? owner[s] : s] + n.wall_gap;
  const u32 write = elements != 0;
  u32 rows = 0, found = 0;
  const u32 first_row = write ? row_first[s] : 0u, first = write ? element_first[s] : 0u;
  for (u32 part = 0; part < n.parts; ++part) {
    GLOBAL const part_place* place = parts + part;
    if (!place->present) continue;
    GLOBAL const shape* own = shapes + place->shape;
    const tree_place tree = trees[place->shape];
    const vec3 p = rotate3(conjugate(place->turn), sub3_f64(position_of(spheres + s), place->shift));
    const double limit = reach + place->margin + own->tolerance;
    const u32 before = found;
    for (u32 node = tree.first; node < tree.last;) {
      GLOBAL const tree_node* at = nodes + node;
      if (box_distance2(at, p) > limit * limit) {
        node = at->skip;
        continue;
      }
      for (u32 k = 0; k < at->count; ++k) {
        const u32 element = tree_elements[tree.elements + at->first + k];
        if (!(element_distance(own, triangles, axes, segments, element, p) <= limit)) continue;
        if (write) elements[first + found] = element;
        ++found;
      }
      ++node;
    }
    if (found == before) continue;
    if (write) {
      sort_rising(elements + first + before, found - before);
      row_sphere[first_row + rows] = s;
      row_part[first_row + rows] = part;
      first_element[first_row + rows] = first + before;
    }
    ++rows;
  }
  if (!write) {
    row_first[s] = rows;
    element_first[s] = found;
  } else if (s == n.spheres - 1) {
    first_element[first_row + rows] = first + found;
  }
}

/* History of rows that were in the list before; see carry_pairs. Strides: of columns of history. */
KERNEL(carry_rows, step_numbers n, u32 old_spheres, GLOBAL const u32* RESTRICT list_rank,
       GLOBAL const u32* RESTRICT row_sphere, GLOBAL const u32* RESTRICT row_part, GLOBAL const u32* RESTRICT old_first,
       GLOBAL const u32* RESTRICT old_part, GLOBAL const u8* RESTRICT old_touching,
       GLOBAL const vec3* RESTRICT old_normals, GLOBAL const double* RESTRICT old_history, u64 old_stride,
       GLOBAL u8* RESTRICT touching, GLOBAL vec3* RESTRICT normals, GLOBAL double* RESTRICT history, u64 stride) {
  const u32 row = ITEM;
  if (row >= n.wall_rows) return;
  const u32 before = list_rank[row_sphere[row]], first = row * WALL_CONTACTS;
  u32 old = NO_SPHERE;
  for (u32 o = before < old_spheres ? old_first[before] : 0u; before < old_spheres && o < old_first[before + 1]; ++o)
    if (old_part[o] == row_part[row]) old = o;
  for (u32 c = 0; c < WALL_CONTACTS; ++c) {
    touching[first + c] = 0;
    normals[first + c] = make3_f64(0.0, 0.0, 0.0);
    if (old == NO_SPHERE) continue;
    const u32 from = old * WALL_CONTACTS + c;
    touching[first + c] = old_touching[from];
    normals[first + c] = old_normals[from];
    if (!old_touching[from]) continue;
    for (u32 k = 0; k < n.columns; ++k) history[k * stride + first + c] = old_history[k * old_stride + from];
  }
}

#endif
