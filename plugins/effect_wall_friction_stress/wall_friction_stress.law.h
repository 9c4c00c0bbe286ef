/* wall_friction_stress.law.h: wall friction that is higher where the wall is lightly loaded, a term after any contact
 * law. Equation and symbols: README.md. */
#define wall_friction_stress_pair_LIST(X)                                                                           \
  X(rise, "1", 0, 2, 0, 0, "friction at no stress over that at high stress, added to the friction of the base law") \
  X(stress, "Pa", 1, 1e9, 2000, 0, "contact stress at which half of it is left")
#define wall_friction_stress_prop_LIST(X)
#define wall_friction_stress_state_LIST(X)                                         \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x") \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y") \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define wall_friction_stress_NEEDS \
  (CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_M_EFF | CALX_NEED_R_I | CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(wall_friction_stress)

CALX_LAW_EVAL(wall_friction_stress) {
  CALX_ID(calx_spring) spring;
  const real fn = calx_max(c->fn_before, R(0.0));
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real stress = fn / (R(3.141592653589793) * c->r_i * c->r_i);
  const real limit = fn * (p->rise / (R(1.0) + stress / p->stress));
  /* The spring slips after a hundredth of the radius, whatever the load: no stiffness of the base law is known here. */
  const real kt = limit / (R(0.01) * c->r_i);
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(calx_slide)(c, vn, kt, kt, R(1.0), R(1.0), R(0.0), limit, &spring);
  s->spring_x = p->rise > R(0.0) ? spring.x : R(0.0);
  s->spring_y = p->rise > R(0.0) ? spring.y : R(0.0);
  s->spring_z = p->rise > R(0.0) ? spring.z : R(0.0);
  out->fx = spring.fx;
  out->fy = spring.fy;
  out->fz = spring.fz;
  out->elastic = spring.elastic;
  out->friction = spring.friction;
}
