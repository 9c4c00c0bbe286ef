/* my_plugin.law.h: air that escapes upwards carries a part of the weight. */
#define my_plugin_row_LIST(X)                                              \
  X(share, "1", 0, 1, 0, 0, "part of the weight that is carried; 0: none") \
  X(gravity_x, "m/s^2", -1e6, 1e6, 0, CALX_VEC(1), "as in the case, x")    \
  X(gravity_y, "m/s^2", -1e6, 1e6, 0, CALX_VEC(1), "as in the case, y")    \
  X(gravity_z, "m/s^2", -1e6, 1e6, -9.81, CALX_VEC(1), "as in the case, z")

CALX_FORCE_DECLARE(my_plugin)

/* b: the particle, p: the numbers above, out: force and moment on it. At share 0 nothing may change. */
CALX_FORCE_EVAL(my_plugin) {
  const real carried = p->share * b->mass;
  out->fx = -carried * p->gravity_x;
  out->fy = -carried * p->gravity_y;
  out->fz = -carried * p->gravity_z;
}
