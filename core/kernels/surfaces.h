/* surfaces.h: contacts of one sphere with candidate elements of a part, as core/geometry/closest.cpp finds them: a
 * feature is a contact where it is a local minimum of the distance. Part frame. */
#ifndef CALX_SURFACES_H
#define CALX_SURFACES_H

typedef struct triangle {
  vec3 corner0, corner1, corner2;
  vec3 normal;
  vec3 inward0, inward1, inward2;
  u32 edge0, edge1, edge2, vertex0, vertex1, vertex2;
} triangle;
typedef struct edge {
  vec3 start, direction;
  double span;
  vec3 normal;
  u32 first, count;
} edge;
typedef struct vertex {
  vec3 position, normal;
  u32 first, count;
} vertex;
typedef struct planar {
  double r, z;
} planar;
typedef struct axis {
  vec3 origin, direction, e1, e2;
} axis;
typedef struct segment {
  planar a, along, normal;
  double span;
  u32 axis, point0, point1;
} segment;
typedef struct profile_point {
  planar position, normal;
  u32 axis, first, count;
} profile_point;

/* Where the elements of a part's shape begin in the tables of all shapes. */
typedef struct shape {
  double size, tolerance; /* m */
  u32 triangles, triangle_count, edges, vertices, inwards, directions, axes, segments, points, alongs;
} shape;

/* Tables of all shapes. */
#define SHAPE_TABLES                                                                                                 \
  GLOBAL const shape *RESTRICT shapes, GLOBAL const triangle *RESTRICT triangles, GLOBAL const edge *RESTRICT edges, \
      GLOBAL const vertex *RESTRICT vertices, GLOBAL const vec3 *RESTRICT inwards,                                   \
      GLOBAL const vec3 *RESTRICT directions, GLOBAL const axis *RESTRICT axes,                                      \
      GLOBAL const segment *RESTRICT segments, GLOBAL const profile_point *RESTRICT points,                          \
      GLOBAL const planar *RESTRICT alongs

/* cos 15 degrees. */
#define CREASE_COSINE 0.96592582628906829
#define MINIMA 24

typedef struct minimum {
  vec3 point, normal;
  double distance;
  u32 element, rank; /* rank: 0 face, 1 edge, 2 vertex */
} minimum;
typedef struct minima {
  minimum found[MINIMA];
  double same2;
  u32 count;
} minima;

FN u32 nearer(const minimum* a, const minimum* b) {
  if (a->distance != b->distance) return a->distance < b->distance;
  if (a->rank != b->rank) return a->rank < b->rank;
  return a->element < b->element;
}

/* Deepest first; of those whose normals differ by less than the crease angle only the nearest stays. */
FN void merge_minima(minima* m) {
  if (m->count < 2) return;
  for (u32 k = 1; k < m->count; ++k) {
    const minimum one = m->found[k];
    u32 at = k;
    while (at > 0 && nearer(&one, &m->found[at - 1])) {
      m->found[at] = m->found[at - 1];
      --at;
    }
    m->found[at] = one;
  }
  u32 kept = 1;
  for (u32 k = 1; k < m->count; ++k) {
    u32 apart = 1;
    for (u32 j = 0; j < kept && apart; ++j) apart = dot3_f64(m->found[j].normal, m->found[k].normal) < CREASE_COSINE;
    if (apart) m->found[kept++] = m->found[k];
  }
  m->count = kept;
}

FN void add_minimum(minima* m, const minimum* f) {
  for (u32 k = 0; k < m->count; ++k) {
    const vec3 off = sub3_f64(m->found[k].point, f->point);
    if (dot3_f64(off, off) > m->same2) continue;
    if (nearer(f, &m->found[k])) m->found[k] = *f;
    return;
  }
  if (m->count == MINIMA) merge_minima(m);
  if (m->count < MINIMA) {
    m->found[m->count++] = *f;
    return;
  }
  u32 last = 0;
  for (u32 k = 1; k < m->count; ++k)
    if (nearer(&m->found[last], &m->found[k])) last = k;
  if (nearer(f, &m->found[last])) m->found[last] = *f;
}

FN void add_feature(minima* m, vec3 point, vec3 d, double span, double tolerance, vec3 fallback, u32 element,
                    u32 rank) {
  minimum f;
  f.point = point;
  f.normal = span > tolerance ? make3_f64(d.x / span, d.y / span, d.z / span) : fallback;
  f.distance = span;
  f.element = element;
  f.rank = rank;
  add_minimum(m, &f);
}

FN void edge_minimum(GLOBAL const edge* g, GLOBAL const vec3* inwards, vec3 p, double radius, double tolerance,
                     u32 element, minima* out) {
  const vec3 q = sub3_f64(p, g->start);
  const double t = dot3_f64(q, g->direction);
  if (t < -tolerance || t > g->span + tolerance) return;
  const vec3 d = sub3_f64(q, scale3_f64(t, g->direction));
  const double d2 = dot3_f64(d, d);
  if (d2 >= radius * radius) return;
  for (u32 k = 0; k < g->count; ++k)
    if (dot3_f64(inwards[g->first + k], q) > tolerance) return;
  add_feature(out, sub3_f64(p, d), d, sqrt_f64(d2), tolerance, g->normal, element, 1u);
}

FN void vertex_minimum(GLOBAL const vertex* v, GLOBAL const vec3* directions, vec3 p, double radius, double tolerance,
                       u32 element, minima* out) {
  const vec3 d = sub3_f64(p, v->position);
  const double d2 = dot3_f64(d, d);
  if (d2 >= radius * radius) return;
  for (u32 k = 0; k < v->count; ++k)
    if (dot3_f64(directions[v->first + k], d) > tolerance) return;
  add_feature(out, v->position, d, sqrt_f64(d2), tolerance, v->normal, element, 2u);
}

FN void triangle_minima(GLOBAL const triangle* t, GLOBAL const edge* edges, GLOBAL const vertex* vertices,
                        GLOBAL const vec3* inwards, GLOBAL const vec3* directions, u32 element, vec3 p, double radius,
                        double tolerance, minima* out) {
  const vec3 q = sub3_f64(p, t->corner0);
  const double h = dot3_f64(t->normal, q);
  if (h >= radius || -h >= radius) return;
  const double s0 = dot3_f64(t->inward0, q), s1 = dot3_f64(t->inward1, sub3_f64(p, t->corner1)),
               s2 = dot3_f64(t->inward2, q);
  if (s0 <= -radius || s1 <= -radius || s2 <= -radius) return;
  if (s0 >= -tolerance && s1 >= -tolerance && s2 >= -tolerance) {
    minimum f;
    f.point = sub3_f64(p, scale3_f64(h, t->normal));
    f.normal = h < -tolerance ? negative(t->normal) : t->normal;
    f.distance = h < 0.0 ? -h : h;
    f.element = element;
    f.rank = 0u;
    add_minimum(out, &f);
    return;
  }
  if (s0 <= tolerance) edge_minimum(edges + t->edge0, inwards, p, radius, tolerance, element, out);
  if (s1 <= tolerance) edge_minimum(edges + t->edge1, inwards, p, radius, tolerance, element, out);
  if (s2 <= tolerance) edge_minimum(edges + t->edge2, inwards, p, radius, tolerance, element, out);
  if (s0 <= tolerance || s2 <= tolerance)
    vertex_minimum(vertices + t->vertex0, directions, p, radius, tolerance, element, out);
  if (s1 <= tolerance || s0 <= tolerance)
    vertex_minimum(vertices + t->vertex1, directions, p, radius, tolerance, element, out);
  if (s2 <= tolerance || s1 <= tolerance)
    vertex_minimum(vertices + t->vertex2, directions, p, radius, tolerance, element, out);
}

/* The position of a point in the half plane of an axis, and the unit radial direction there. */
typedef struct on_axis {
  double r, z;
  vec3 radial;
} on_axis;
FN on_axis to_axis(GLOBAL const axis* a, vec3 p, double size) {
  const vec3 q = sub3_f64(p, a->origin);
  on_axis o;
  o.z = dot3_f64(q, a->direction);
  const vec3 across = sub3_f64(q, scale3_f64(o.z, a->direction));
  o.r = sqrt_f64(dot3_f64(across, across));
  o.radial = o.r > 1e-12 * size ? make3_f64(across.x / o.r, across.y / o.r, across.z / o.r) : a->e1;
  return o;
}

FN void add_in_space(minima* m, GLOBAL const axis* a, on_axis p, double at_r, double at_z, double normal_r,
                     double normal_z, double span, u32 element, u32 rank) {
  minimum f;
  f.point = add3_f64(add3_f64(a->origin, scale3_f64(at_r, p.radial)), scale3_f64(at_z, a->direction));
  f.normal = add3_f64(scale3_f64(normal_r, p.radial), scale3_f64(normal_z, a->direction));
  f.distance = span;
  f.element = element;
  f.rank = rank;
  add_minimum(m, &f);
}

FN void segment_minima(GLOBAL const segment* s, GLOBAL const axis* a, GLOBAL const profile_point* points,
                       GLOBAL const planar* alongs, u32 element, on_axis p, double radius, double tolerance,
                       minima* out) {
  const double qr = p.r - s->a.r, qz = p.z - s->a.z;
  const double h = s->normal.r * qr + s->normal.z * qz;
  if (h >= radius || -h >= radius) return;
  double t = s->along.r * qr + s->along.z * qz;
  if (t >= -tolerance && t <= s->span + tolerance) {
    t = t < 0.0 ? 0.0 : t;
    t = s->span < t ? s->span : t;
    const u32 turned = h < -tolerance;
    add_in_space(out, a, p, s->a.r + t * s->along.r, s->a.z + t * s->along.z, turned ? -s->normal.r : s->normal.r,
                 turned ? -s->normal.z : s->normal.z, h < 0.0 ? -h : h, element, 0u);
    return;
  }
  GLOBAL const profile_point* point = points + (t > 0.0 ? s->point1 : s->point0);
  const double dr = p.r - point->position.r, dz = p.z - point->position.z;
  const double d2 = dr * dr + dz * dz;
  if (d2 >= radius * radius) return;
  for (u32 k = 0; k < point->count; ++k)
    if (alongs[point->first + k].r * dr + alongs[point->first + k].z * dz > tolerance) return;
  const double span = sqrt_f64(d2);
  const u32 far = span > tolerance;
  add_in_space(out, a, p, point->position.r, point->position.z, far ? dr / span : point->normal.r,
               far ? dz / span : point->normal.z, span, element, 2u);
}

#endif
