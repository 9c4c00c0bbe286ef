/* epam.law.h: elasto-plastic adhesive contact. Six laws from one text: exponent 1 or 1.5, without and with rolling
 * resistance, and with an adhesive exponent of its own (always with the rolling columns).
 *   epam_n1, epam_n15                   7 history values
 *   epam_n1_rolling, epam_n15_rolling   10
 *   epam_n1_chi, epam_n15_chi           10
 * Columns: name, unit, lowest, highest, preset, flags, meaning. Equations and symbols: README.md. n is the exponent of
 * the loading branches, chi that of the adhesive branch, delta_p the plastic overlap. */
#define epam_pair_ROWS(X, k1_unit)                                                                                  \
  X(k1_given, k1_unit, 0, 1e15, 0, 0, "virgin stiffness given outright, 0 where it follows from the materials")       \
  X(k1_size, "1", 0, 1e15, 1e5, 0, "virgin stiffness over sqrt(R*) for exponent 1.5, over R* for exponent 1")         \
  X(unload, "1", 1, 101, 2, 0, "k2 / k1 = 1 / (1 - lambda)")                                                          \
  X(lambda, "1", 0, 0.99, 0.5, 0, "plasticity ratio 1 - k1 / k2")                                                     \
  X(lambda_root, "1", 0, 1, 0.5, 0, "lambda^(1/n)")                                                                   \
  X(adhesion, "J/m^2", 0, 1e9, 0, 0, "3/2 pi surface energy; 0: fixed adhesive stiffness")                            \
  X(k_adh_given, "1", 0, 1e30, 0, 0, "fixed adhesive stiffness, N/m^chi")                                             \
  X(cap_share, "1", 0, 1, 0.5, 0, "delta_min^n over delta_p^n at the adhesion cap: 1/2 or, literal, 2^-n")            \
  X(cap_root, "1", 0, 1, 0.63, 0, "its root: delta_min over delta_p at the cap")                                      \
  X(pull_off, "N", 0, 1e6, 0, 0, "constant pull-off force f0")                                                        \
  X(retrace, "1", 0, 1, 0, 0, "1: a reload goes back along the adhesive branch")                                      \
  X(chi_half, "1", 0, 1, 0, 0, "binary digit of chi: 1/2")                                                            \
  X(chi_1, "1", 0, 1, 0, 0, "binary digit of chi: 1")                                                                 \
  X(chi_2, "1", 0, 1, 0, 0, "binary digit of chi: 2")                                                                 \
  X(chi_4, "1", 0, 1, 0, 0, "binary digit of chi: 4")                                                                 \
  X(dash, "1", 0, 10, 0.3, 0, "normal dashpot over sqrt(k m*), k the stiffness that damping names")                   \
  X(dash_t, "1", 0, 10, 0.3, 0, "tangential dashpot over sqrt(kt m*)")                                                \
  X(tsuji, "1", 0, 1, 1, 0, "1: the dashpot follows the tangent stiffness of the virgin line; 0: k1 as a number")     \
  X(dash_always, "1", 0, 1, 0, 0, "1: the dashpot acts in the dead zone and on the tensile side, too")                \
  X(clipped, "1", 0, 1, 0, 0, "1: the dashpot never makes a compressive contact pull")                                \
  X(kt_share, "1", 0, 1e3, 0.5, 0, "tangential stiffness over k1 delta^(n-1)")                                        \
  X(grow_keeps, "1", 0, 1, 1, 0, "1: a growing contact keeps its tangential force, 0: its tangential displacement")    \
  X(shrink_keeps, "1", 0, 1, 0, 0, "1: a shrinking contact keeps its tangential force, 0: its displacement")           \
  X(friction, "1", 0, 10, 0.5, 0, "sliding friction")                                                                 \
  calx_rolling_pair_LIST(X)
#define epam_state_ROWS(X, plastic_unit, k_adh_unit)                                                        \
  X(plastic, plastic_unit, 0, 1e6, 0, 0, "plastic overlap to the power n")                                    \
  X(k_adh, k_adh_unit, 0, 1e30, 0, 0, "stiffness of the adhesive branch")                                     \
  X(overlap_before, "m", 0, 1e3, 0, 0, "overlap one step earlier")                                            \
  X(on_adhesion, "1", 0, 1, 0, 0, "1 on the adhesive branch")                                                 \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x")                            \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y")                            \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define epam_NEEDS                                                                                          \
  (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF | CALX_NEED_R_I | \
   CALX_NEED_R_J)

#define epam_n1_pair_LIST(X) epam_pair_ROWS(X, "N/m")
#define epam_n1_prop_LIST(X)
#define epam_n1_state_LIST(X) epam_state_ROWS(X, "m", "N/m")
#define epam_n1_NEEDS epam_NEEDS
#define epam_n15_pair_LIST(X) epam_pair_ROWS(X, "N/m^1.5")
#define epam_n15_prop_LIST(X)
#define epam_n15_state_LIST(X) epam_state_ROWS(X, "m^1.5", "N/m^1.5")
#define epam_n15_NEEDS epam_NEEDS
#define epam_n1_rolling_pair_LIST(X) epam_n1_pair_LIST(X)
#define epam_n1_rolling_prop_LIST(X)
#define epam_n1_rolling_state_LIST(X) epam_n1_state_LIST(X) calx_rolling_state_LIST(X)
#define epam_n1_rolling_NEEDS (epam_NEEDS | CALX_ROLLING_NEEDS)
#define epam_n15_rolling_pair_LIST(X) epam_n15_pair_LIST(X)
#define epam_n15_rolling_prop_LIST(X)
#define epam_n15_rolling_state_LIST(X) epam_n15_state_LIST(X) calx_rolling_state_LIST(X)
#define epam_n15_rolling_NEEDS (epam_NEEDS | CALX_ROLLING_NEEDS)
/* With an exponent of its own the adhesive branch is k_adh (delta / L)^chi, L = 0.01 R*, so that no power leaves the range
 * of single precision; its stiffness is a force. */
#define epam_n1_chi_pair_LIST(X) epam_n1_pair_LIST(X)
#define epam_n1_chi_prop_LIST(X)
#define epam_n1_chi_state_LIST(X) epam_state_ROWS(X, "m", "N") calx_rolling_state_LIST(X)
#define epam_n1_chi_NEEDS epam_n1_rolling_NEEDS
#define epam_n15_chi_pair_LIST(X) epam_n15_pair_LIST(X)
#define epam_n15_chi_prop_LIST(X)
#define epam_n15_chi_state_LIST(X) epam_state_ROWS(X, "m^1.5", "N") calx_rolling_state_LIST(X)
#define epam_n15_chi_NEEDS epam_n15_rolling_NEEDS

CALX_LAW_DECLARE(epam_n1)
CALX_LAW_DECLARE_LIKE(epam_n15, epam_n1)
CALX_LAW_DECLARE_LIKE(epam_n1_rolling, epam_n1)
CALX_LAW_DECLARE_LIKE(epam_n15_rolling, epam_n1)
CALX_LAW_DECLARE_LIKE(epam_n1_chi, epam_n1)
CALX_LAW_DECLARE_LIKE(epam_n15_chi, epam_n1)

/* History of the normal branch, shared by the six laws. */
typedef struct CALX_ID(epam_memory) {
  real plastic, k_adh, before, on_adhesion;
} CALX_ID(epam_memory);

/* What the rolling resistance wants to know of the contact. */
typedef struct CALX_ID(epam_load) {
  real compressive;   /* N, branch force where it pushes */
  real kn, kn_before; /* N/m, secant stiffness of the virgin line now and one step earlier */
  real kt, kt_before; /* N/m */
} CALX_ID(epam_load);

/* Four steps of Halley from sqrt(y): each triples the number of digits. Good to rounding for 1e-3 < y < 1e2; beyond,
 * only the energy outputs use it. */
CALX_FN void CALX_ID(epam_cube_root)(const real y, real* root) {
  const real a = calx_sqrt(y);
  const real a3 = a * a * a;
  const real b = a * (a3 + R(2.0) * y) / (R(2.0) * a3 + y);
  const real b3 = b * b * b;
  const real d = b * (b3 + R(2.0) * y) / (R(2.0) * b3 + y);
  const real d3 = d * d * d;
  const real e = d * (d3 + R(2.0) * y) / (R(2.0) * d3 + y);
  const real e3 = e * e * e;
  *root = e * (e3 + R(2.0) * y) / (R(2.0) * e3 + y);
}

/* x^chi for chi = 1, 1.5, ... 5 from its binary digits. */
CALX_FN void CALX_ID(epam_power)(const CALX_ID(epam_n1_pair) * p, const real x, real* power) {
  const real x2 = x * x;
  *power = (p->chi_half > R(0.5) ? calx_sqrt(x) : R(1.0)) * (p->chi_1 > R(0.5) ? x : R(1.0)) *
           (p->chi_2 > R(0.5) ? x2 : R(1.0)) * (p->chi_4 > R(0.5) ? x2 * x2 : R(1.0));
}

/* Energy of the k2 line that passes through overlap d with force f: the integral of k2 (x^n - dp^n) from dp to d, where
 * dp^n = d^n - f/k2. At least 0, and 0 where f is. For exponent 1 it is f^2 / (2 k2). */
CALX_FN void CALX_ID(epam_stored)(const real hertz, const real d, const real dn, const real k2, const real f,
                                  real* energy) {
  const real y = calx_max(R(1.0) - f / (k2 * calx_max(dn, R(1e-30))), R(1e-12));
  real root;
  CALX_ID(epam_cube_root)(y, &root);
  *energy = hertz > R(0.5) ? k2 * dn * d * (R(0.4) * (R(1.0) - y * root * root) - y * (R(1.0) - root * root))
                           : R(0.5) * f * f / k2;
}

/* Force and history. hertz is 1 for exponent 1.5, own_chi 1 for a separate adhesive exponent: constants of each law, so
 * that the compiler keeps one side of every choice. */
CALX_FN void CALX_ID(epam_force)(const CALX_ID(calx_contact) * c, const CALX_ID(epam_n1_pair) * p, const real hertz,
                                 const real own_chi, CALX_ID(epam_memory) * m, CALX_ID(calx_spring) * spring,
                                 CALX_ID(calx_wrench) * out, CALX_ID(epam_load) * load) {
  const real tiny = R(1e-30);
  const real d = calx_max(c->overlap, R(0.0));
  const real root_d = calx_sqrt(d);
  const real root_b = calx_sqrt(m->before);
  const real dn = hertz > R(0.5) ? d * root_d : d;
  const real bn = hertz > R(0.5) ? m->before * root_b : m->before;
  const real k1 = p->k1_given + p->k1_size * (hertz > R(0.5) ? calx_sqrt(c->r_eff) : c->r_eff);
  const real k2 = k1 * p->unload;

  /* delta^chi now and before; with chi = n it is delta^n. */
  const real per_length = R(100.0) / c->r_eff;
  real chi_now;
  real chi_before;
  CALX_ID(epam_power)(p, d * per_length, &chi_now);
  CALX_ID(epam_power)(p, m->before * per_length, &chi_before);
  const real dchi = own_chi > R(0.5) ? chi_now : dn;
  const real bchi = own_chi > R(0.5) ? chi_before : bn;

  /* A reload that starts on the adhesive branch follows a new k2 line through the point where it starts; k_adh stays. */
  const real was_on = m->on_adhesion;
  const real reload = was_on * (d > m->before ? R(1.0) : R(0.0)) * (R(1.0) - p->retrace);
  const real plastic = reload > R(0.5) ? bn + m->k_adh * bchi / k2 : m->plastic;

  /* Virgin loading: the plastic history grows. Tested on the overlap and not on the forces, which are equal there. */
  const real grown = p->lambda * dn;
  const real virgin = grown >= plastic ? R(1.0) : R(0.0);
  const real dpn = calx_max(grown, plastic);

  /* Adhesion of the plastic overlap dp = lambda^(1/n) d. Patch radius a: where the undeformed spheres, or sphere and
   * plane, would cut at overlap dp. The radicand is 0 or more but for rounding. */
  const real dp = p->lambda_root * d;
  const real sum = c->r_i + c->r_j;
  const real centres = calx_max(sum - dp, tiny);
  const real pair_a2 = dp * ((R(2.0) * c->r_i - dp) * (R(2.0) * c->r_j - dp)) * (sum + sum - dp) /
                       (R(4.0) * calx_max(centres * centres, tiny));
  const real wall_a2 = dp * (R(2.0) * c->r_i - dp);
  const real patch = calx_sqrt(calx_max(c->r_j > R(0.0) ? pair_a2 : wall_a2, R(0.0)));
  const real wanted = p->adhesion * patch;
  const real cap = R(0.5) * k2 * grown;
  const real capped = wanted > cap ? R(1.0) : R(0.0);
  const real f_min = calx_min(wanted, cap);
  /* delta_min^n = delta_p^n - f_min/k2, or its value at the cap; never below 2^-n delta_p^n. */
  const real min_n = capped > R(0.5) ? p->cap_share * grown : grown - f_min / k2;
  real min_root;
  real min_chi;
  CALX_ID(epam_cube_root)(calx_max(min_n, tiny) / calx_max(grown, tiny), &min_root);
  const real d_min = capped > R(0.5) ? p->cap_root * dp : (hertz > R(0.5) ? dp * min_root * min_root : min_n);
  CALX_ID(epam_power)(p, d_min * per_length, &min_chi);
  const real from_energy = f_min / calx_max(own_chi > R(0.5) ? min_chi : min_n, tiny);
  /* A given stiffness is per m^chi; the own-exponent laws measure the overlap in L. */
  real length_chi;
  CALX_ID(epam_power)(p, R(1.0) / per_length, &length_chi);
  const real fixed = own_chi > R(0.5) ? p->k_adh_given * length_chi : p->k_adh_given;
  const real k_new = p->adhesion > R(0.0) ? from_energy : fixed;
  const real k_adh = virgin > R(0.5) ? k_new : m->k_adh;

  /* Three branches. */
  const real f_unload = k2 * (dn - dpn);
  const real f_adhesion = -k_adh * dchi;
  const real on_adhesion = virgin > R(0.5) ? R(0.0) : (f_unload > f_adhesion ? R(0.0) : R(1.0));
  const real branch = virgin > R(0.5) ? k1 * dn : (on_adhesion > R(0.5) ? f_adhesion : f_unload);
  const real compressive = calx_max(branch, R(0.0));

  /* Dashpot. k1 delta^(n-1) is a stiffness; the literal form takes the number k1 alone. */
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real secant = hertz > R(0.5) ? k1 * root_d : k1;
  const real cn = p->dash * calx_sqrt(c->m_eff * (p->tsuji > R(0.5) ? secant : k1));
  const real acts = branch > R(0.0) ? R(1.0) : p->dash_always;
  const real damped = branch - acts * cn * vn;
  const real total = p->clipped > R(0.5) ? calx_max(damped, calx_min(branch, R(0.0))) : damped;
  const real fn = total - p->pull_off;

  /* Tangential limit: mu (F + k_adh delta^chi), so adhesion adds to friction and the adhesive branch carries none. */
  const real kt = p->kt_share * secant;
  const real kt_before = p->kt_share * (hertz > R(0.5) ? k1 * root_b : k1);
  const real limit = p->friction * calx_max(branch + k_adh * dchi, R(0.0));
  /* (kt_before / kt)^2 is the ratio of the overlaps for exponent 1.5, else 1. */
  const real ratio = m->before < d ? (p->grow_keeps > R(0.5) ? m->before : d) : (p->shrink_keeps > R(0.5) ? m->before : d);
  const real num = hertz > R(0.5) ? ratio : R(1.0);
  const real den = hertz > R(0.5) ? d : R(1.0);
  CALX_ID(calx_slide)(c, vn, kt, kt_before, num, den, p->dash_t * calx_sqrt(kt * c->m_eff), limit, spring);
  out->fx = fn * c->nx + spring->fx;
  out->fy = fn * c->ny + spring->fy;
  out->fz = fn * c->nz + spring->fz;
  load->compressive = compressive;
  load->kn = secant;
  load->kn_before = hertz > R(0.5) ? k1 * root_b : k1;
  load->kt = kt;
  load->kt_before = kt_before;

  /* Ledger. Stored is the energy of the k2 line through the present point, less the work f0 gives back on parting. Work
   * by the trapezoid from the point before, whose force follows from the old history; what is not stored is lost. */
  real stored;
  real stored_before;
  const real f_before = was_on > R(0.5) ? -m->k_adh * bchi : k2 * (bn - m->plastic);
  CALX_ID(epam_stored)(hertz, d, dn, k2, branch, &stored);
  CALX_ID(epam_stored)(hertz, m->before, bn, k2, f_before, &stored_before);
  out->elastic = stored - p->pull_off * d + spring->elastic;
  out->plastic = R(0.5) * (branch + f_before) * (d - m->before) - (stored - stored_before);
  out->friction = spring->friction;
  out->damping = (branch - total) * (vn + R(0.5) * fn * c->dt / c->m_eff) * c->dt + spring->damping;

  m->plastic = dpn;
  m->k_adh = k_adh;
  m->before = d;
  m->on_adhesion = on_adhesion;
}

#define epam_LOAD                       \
  CALX_ID(epam_memory) memory;          \
  CALX_ID(calx_spring) spring;          \
  CALX_ID(epam_load) load;              \
  memory.plastic = s->plastic;          \
  memory.k_adh = s->k_adh;              \
  memory.before = s->overlap_before;    \
  memory.on_adhesion = s->on_adhesion;  \
  spring.x = s->spring_x;               \
  spring.y = s->spring_y;               \
  spring.z = s->spring_z;
#define epam_STORE                      \
  s->plastic = memory.plastic;          \
  s->k_adh = memory.k_adh;              \
  s->overlap_before = memory.before;    \
  s->on_adhesion = memory.on_adhesion;  \
  s->spring_x = spring.x;               \
  s->spring_y = spring.y;               \
  s->spring_z = spring.z;
#define epam_ROLL                                                                                            \
  CALX_ID(calx_roller) roll;                                                                                 \
  roll.x = s->roll_x;                                                                                        \
  roll.y = s->roll_y;                                                                                        \
  roll.z = s->roll_z;                                                                                        \
  CALX_ID(calx_roll)(c, CALX_ROLLING(p), load.kn, load.kn_before, load.kt, load.kt_before, load.compressive, &roll); \
  s->roll_x = roll.x;                                                                                        \
  s->roll_y = roll.y;                                                                                        \
  s->roll_z = roll.z;                                                                                        \
  out->mx = roll.mx;                                                                                         \
  out->my = roll.my;                                                                                         \
  out->mz = roll.mz;                                                                                         \
  out->elastic = out->elastic + roll.elastic;                                                                \
  out->friction = out->friction + roll.friction;                                                             \
  out->damping = out->damping + roll.damping;

CALX_LAW_EVAL(epam_n1) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(0.0), R(0.0), &memory, &spring, out, &load);
  epam_STORE
}

CALX_LAW_EVAL(epam_n15) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(1.0), R(0.0), &memory, &spring, out, &load);
  epam_STORE
}

CALX_LAW_EVAL(epam_n1_rolling) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(0.0), R(0.0), &memory, &spring, out, &load);
  epam_STORE
  epam_ROLL
}

CALX_LAW_EVAL(epam_n15_rolling) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(1.0), R(0.0), &memory, &spring, out, &load);
  epam_STORE
  epam_ROLL
}

CALX_LAW_EVAL(epam_n1_chi) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(0.0), R(1.0), &memory, &spring, out, &load);
  epam_STORE
  epam_ROLL
}

CALX_LAW_EVAL(epam_n15_chi) {
  epam_LOAD
  CALX_ID(epam_force)(c, p, R(1.0), R(1.0), &memory, &spring, out, &load);
  epam_STORE
  epam_ROLL
}
