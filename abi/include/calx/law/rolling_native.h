/* SPDX-License-Identifier: MIT
 * calx/law/rolling_native.h: the native side of rolling.h: the rows a law adds to its tables, and the numbers of the pair
 * row from what the user gave; its share in the stable step. C99 and C++98; include once, after the f64 prelude and rolling.h. */
#ifndef CALX_LAW_ROLLING_NATIVE_H
#define CALX_LAW_ROLLING_NATIVE_H
#include <calx/abi.h>
#include <math.h>

#define CALX_ROLLING_NONE 0
#define CALX_ROLLING_A 1
#define CALX_ROLLING_EPSD 2
#define CALX_ROLLING_EPSD2 3
#define CALX_ROLLING_SDS 4
#define CALX_ROLLING_CDT 5

/* Row of the instance's parameter table. */
#define CALX_ROLLING_OPTION                                                                                      \
  {"rolling", "none|a|epsd|epsd2|sds|cdt",                                                                       \
   "rolling resistance: a constant torque, epsd spring and dashpot (type C), epsd2 spring k_t R^2, sds given, "   \
   "cdt constant torque shared with twisting (LIGGGHTS)",                                                         \
   0.0, 5.0, 0.0, CALX_FIELD_CHOICE, 0},

/* Rows of the table of given values, in the order calx_rolling_derive reads them. */
#define CALX_ROLLING_GIVEN                                                                                        \
  {"rolling_friction", "1", "largest rolling torque over normal force and effective radius", 0.0, 10.0, 0.0, 0, 0}, \
      {"rolling_damping", "1", "rolling dashpot over the critical one, read by epsd", 0.0, 10.0, 0.3, 0, 0},       \
      {"rolling_stiffness", "N/m", "rolling spring, read by sds", 0.0, 1e15, 0.0, 0, 0},                           \
      {"rolling_viscosity", "kg/s", "rolling dashpot, read by sds", 0.0, 1e15, 0.0, 0, 0},
#define CALX_ROLLING_GIVEN_COUNT 4

/* Fills the seven rolling numbers of any pair row that holds calx_rolling_pair_LIST. */
#define CALX_ROLLING_DERIVE(model, given, pair)                                                         \
  do {                                                                                                  \
    const double mu_r = (given)[0];                                                                     \
    (pair).rolling_friction = (model) == CALX_ROLLING_NONE ? 0.0 : mu_r;                                \
    (pair).roll_of_kn = (model) == CALX_ROLLING_EPSD ? 2.25 * mu_r * mu_r : 0.0;                        \
    (pair).roll_of_kt = (model) == CALX_ROLLING_EPSD2 ? 1.0 : 0.0;                                      \
    (pair).roll_k = (model) == CALX_ROLLING_SDS ? (given)[2] : 0.0;                                     \
    (pair).roll_c = (model) == CALX_ROLLING_SDS ? (given)[3] : 0.0;                                     \
    (pair).roll_eta = (model) == CALX_ROLLING_EPSD ? (given)[1] : 0.0;                                  \
    (pair).roll_type_a = (model) == CALX_ROLLING_A ? 1.0 : (model) == CALX_ROLLING_CDT ? 2.0 : 0.0;     \
  } while (0)

/* Stiffness of the rolling spring over R*^2, N/m, where the contact has kn and kt. */
#define CALX_ROLLING_STIFFNESS(pair, kn, kt) ((pair).roll_of_kn * (kn) + (pair).roll_of_kt * (kt) + (pair).roll_k)

/* Stable step of a sphere held by many contacts: 0.17 sqrt(m / K), K the largest stiffness (O'Sullivan, Bray 2004), and
 * 0.17 2 m / c, which is the same at critical damping, for a dashpot c given outright. */
static inline double calx_stable_step(double mass, double stiffness, double dashpot) {
  const double by_spring = sqrt(mass / stiffness), by_dashpot = dashpot > 0 ? 2 * mass / dashpot : by_spring;
  return 0.17 * (by_spring < by_dashpot ? by_spring : by_dashpot);
}
#endif
