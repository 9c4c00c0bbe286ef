/* SPDX-License-Identifier: MIT
 * calx/geometry.h: the shape of a rigid part, "calx.geometry/1". C99 and C++98.
 *
 * A shape is handed to the host once, as triangles and as smooth surfaces of revolution, in the part's own frame,
 * which is the world frame at the moment no motion has begun. Surfaces are two-sided: a particle touches whichever
 * side its centre is on. The host finds closest points, merges shared edges and keeps history. */
#ifndef CALX_GEOMETRY_H
#define CALX_GEOMETRY_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_GEOMETRY "calx.geometry/1"

/* Receives the shape during build(); every call copies. Returns below 0 after bad input: stop and return it. [main] */
typedef struct calx_shape_sink calx_shape_sink;
struct calx_shape_sink {
  uint32_t struct_size, reserved;
  void* self;
  /* Triangles: xyz holds 3 * vertex_count coordinates, m; index holds 3 * triangle_count vertex numbers, counter-
   * clockwise seen from the side the normal points to. Equal vertices are welded by the host across calls, so edges
   * shared by two calls are one edge. */
  calx_status(CALX_CALL* triangles)(const calx_shape_sink* sink, uint64_t vertex_count, const double* xyz,
                                    uint64_t triangle_count, const uint32_t* index);
  /* A profile turned about an axis: point k of the profile is at distance r_z[2k] >= 0 from the axis and r_z[2k+1]
   * along it from origin, m; axis need not be unit length. closed != 0 joins the last point to the first. */
  calx_status(CALX_CALL* revolution)(const calx_shape_sink* sink, const double origin[3], const double axis[3],
                                     uint64_t point_count, const double* r_z, uint32_t closed);
};

typedef struct calx_geometry {
  uint32_t struct_size, draft; /* draft: CALX_ABI_DRAFT */
  /* Sends the whole shape. The same instance sends the same shape each time. [main] */
  calx_status(CALX_CALL* build)(const calx_instance* self, const calx_host* host, const calx_shape_sink* sink);
} calx_geometry;

#ifdef __cplusplus
}
#endif
#endif
