/* hertz_mindlin.law.h: Hertz contact with dashpot, Mindlin tangential spring with history, Coulomb limit.
 * Two laws: hertz_mindlin (3 history values, no spin) and hertz_mindlin_rolling (6, with rolling resistance).
 * Columns: name, unit, lowest, highest, preset, flags, meaning. Equations and symbols: README.md. */
#define hertz_mindlin_pair_LIST(X)                                                                                \
  X(two_e, "Pa", 0, 1e14, 2e7, 0, "twice the effective Young's modulus, 2 E*")                                     \
  X(eight_g, "Pa", 0, 1e14, 2e7, 0, "eight times the effective shear modulus times tangential_ratio")              \
  X(dash_n, "Pa^0.5", 0, 1e8, 0, 0, "normal dashpot: 2 sqrt(5/6) beta sqrt(2 E*)")                                 \
  X(dash_t, "Pa^0.5", 0, 1e8, 0, 0, "tangential dashpot: 2 sqrt(5/6) beta sqrt(8 G*)")                             \
  X(friction, "1", 0, 10, 0.5, 0, "sliding friction")                                                              \
  X(lowest, "N", -1e30, 0, -1e30, 0, "lowest normal force: 0 where tension is clipped, else far below any force") \
  X(pull_grip, "1", 0, 1, 0, 0, "1: friction acts on a pulling dashpot, too")                                         \
  X(grow_keeps, "1", 0, 1, 1, 0, "1: a growing contact keeps its tangential force, 0: its tangential displacement")   \
  X(shrink_keeps, "1", 0, 1, 0, 0, "1: a shrinking contact keeps its tangential force, 0: its displacement")          \
  calx_rolling_pair_LIST(X)
#define hertz_mindlin_prop_LIST(X)
#define hertz_mindlin_state_LIST(X)                                                                  \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x")                    \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y")                    \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define hertz_mindlin_NEEDS \
  (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF)

#define hertz_mindlin_rolling_pair_LIST(X) hertz_mindlin_pair_LIST(X)
#define hertz_mindlin_rolling_prop_LIST(X) hertz_mindlin_prop_LIST(X)
#define hertz_mindlin_rolling_state_LIST(X) hertz_mindlin_state_LIST(X) calx_rolling_state_LIST(X)
#define hertz_mindlin_rolling_NEEDS (hertz_mindlin_NEEDS | CALX_ROLLING_NEEDS)

CALX_LAW_DECLARE(hertz_mindlin)
CALX_LAW_DECLARE_LIKE(hertz_mindlin_rolling, hertz_mindlin)

/* What the rolling resistance wants to know of the contact. */
typedef struct CALX_ID(hertz_mindlin_load) {
  real elastic;            /* N, Hertz force */
  real kn, kn_before;      /* N/m, secant stiffness F / overlap now and one step earlier */
  real kt, kt_before;      /* N/m */
} CALX_ID(hertz_mindlin_load);

/* Force and history of both laws. Four square roots and two divisions in all: the contact radius, the dashpot, the turn
 * of the spring and the slip; everything else is a number of the pair row. */
CALX_FN void CALX_ID(hertz_mindlin_force)(const CALX_ID(calx_contact) * c, const CALX_ID(hertz_mindlin_pair) * p,
                                          CALX_ID(calx_spring) * spring, CALX_ID(calx_wrench) * out,
                                          CALX_ID(hertz_mindlin_load) * load) {
  const real overlap = calx_max(c->overlap, R(0.0));
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  /* Where the overlap was one step ago: positions move with the velocity seen here. It spares a history column. */
  const real before = calx_max(overlap + vn * c->dt, R(0.0));

  /* Contact radius a = sqrt(R* overlap), S_n = 2 E* a, S_t = 8 G* a; F = 4/3 E* a overlap = 2/3 S_n overlap. */
  const real a = calx_sqrt(c->r_eff * overlap);
  const real sn = p->two_e * a;
  const real st = p->eight_g * a;
  const real elastic = R(0.66666666666666667) * sn * overlap;
  /* 2 sqrt(5/6) beta sqrt(S m*): gives the restitution asked for at any speed (Tsuji et al. 1992, eq. of the form). */
  const real root = calx_sqrt(a * c->m_eff);
  const real fn = calx_max(elastic - p->dash_n * root * vn, p->lowest);

  const real a_before = calx_sqrt(c->r_eff * before);
  load->elastic = elastic;
  load->kn = R(0.66666666666666667) * sn;
  load->kn_before = R(0.66666666666666667) * p->two_e * a_before;
  load->kt = st;
  load->kt_before = p->eight_g * a_before;

  /* S_t grows with the root of the overlap, so (kt_before / kt)^2 is the ratio of the overlaps. */
  const real num = before < overlap ? (p->grow_keeps > R(0.5) ? before : overlap)
                                    : (p->shrink_keeps > R(0.5) ? before : overlap);
  CALX_ID(calx_slide)(c, vn, st, load->kt_before, num, overlap, p->dash_t * root,
                      p->friction * calx_max(fn, -p->pull_grip * fn), spring);
  out->fx = fn * c->nx + spring->fx;
  out->fy = fn * c->ny + spring->fy;
  out->fz = fn * c->nz + spring->fz;

  /* Hertz: integral of F = 2/5 F overlap. The dashpot works on the mean velocity of the step, which the force of this
   * contact changes by fn dt / m*; without that half step the loss is a few per cent off at 30 steps a contact. */
  out->elastic = R(0.4) * elastic * overlap + spring->elastic;
  out->friction = spring->friction;
  out->damping = (elastic - fn) * (vn + R(0.5) * fn * c->dt / c->m_eff) * c->dt + spring->damping;
}

CALX_LAW_EVAL(hertz_mindlin) {
  CALX_ID(calx_spring) spring;
  CALX_ID(hertz_mindlin_load) load;
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(hertz_mindlin_force)(c, p, &spring, out, &load);
  s->spring_x = spring.x;
  s->spring_y = spring.y;
  s->spring_z = spring.z;
}

CALX_LAW_EVAL(hertz_mindlin_rolling) {
  CALX_ID(calx_spring) spring;
  CALX_ID(calx_roller) roll;
  CALX_ID(hertz_mindlin_load) load;
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(hertz_mindlin_force)(c, p, &spring, out, &load);
  s->spring_x = spring.x;
  s->spring_y = spring.y;
  s->spring_z = spring.z;

  roll.x = s->roll_x;
  roll.y = s->roll_y;
  roll.z = s->roll_z;
  CALX_ID(calx_roll)(c, CALX_ROLLING(p), load.kn, load.kn_before, load.kt, load.kt_before, load.elastic, &roll);
  s->roll_x = roll.x;
  s->roll_y = roll.y;
  s->roll_z = roll.z;
  out->mx = roll.mx;
  out->my = roll.my;
  out->mz = roll.mz;
  out->elastic = out->elastic + roll.elastic;
  out->friction = out->friction + roll.friction;
  out->damping = out->damping + roll.damping;
}
