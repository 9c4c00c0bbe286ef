/* SPDX-License-Identifier: MIT
 * calx/law/prelude.h: the dialect (number 1) a contact law is written in. One text serves C99, C++11, OpenCL C 1.2 and
 * CUDA C++. Include it once per precision, with CALX_BITS 32 or 64 defined; there is no include guard on purpose.
 *
 * A law text holds three lists (SYMBOL_pair_LIST, SYMBOL_prop_LIST, SYMBOL_state_LIST), a needs mask (SYMBOL_NEEDS) and
 * one body, CALX_LAW_EVAL(SYMBOL). It may use real, R(0.5) for literals, calx_sqrt calx_abs calx_min calx_max,
 * arithmetic, comparison and ?: with both sides safe to compute. No loop, if, index, cast, or name with two
 * underscores; every name it defines begins with its file's stem. A text may hold several laws that share functions.
 * Words that OpenCL C reserves (half, kernel, global, local, constant, private, generic, read_only, bool, ...) and words
 * of C++ are no names, not even inside of a body; nothing from outside of the text is used. On its main path a law does
 * not branch on which of two expressions is larger that are equal in exact arithmetic.
 *
 * sliding.h and rolling.h, in the same dialect, follow this header in that order: friction and rolling resistance that
 * several laws share. A host that compiles law texts puts the three before any law. */
#undef real
#undef R
#undef CALX_ID
#undef CALX_CAT
#undef CALX_CAT_
#undef CALX_FN
#undef CALX_UNUSED
#undef calx_sqrt
#undef calx_abs
#undef calx_min
#undef calx_max
#define CALX_CAT_(a, b) a##b
#define CALX_CAT(a, b) CALX_CAT_(a, b)

#if CALX_BITS == 32
#define real float
#define R(x) CALX_CAT(x, f)
#define CALX_ID(n) CALX_CAT(n, _f32)
#else
#define real double
#define R(x) x
#define CALX_ID(n) CALX_CAT(n, _f64)
#endif

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#ifndef CALX_FAST /* a host that trades equal bits for speed defines it; other languages have compiler options for this */
#pragma OPENCL FP_CONTRACT OFF
#endif
#define CALX_FN static inline
#define calx_sqrt(x) sqrt(x)
#define calx_abs(x) fabs(x)
#elif defined(__CUDACC_RTC__) || defined(__CUDACC__)
#define CALX_FN static __device__ __forceinline__
#if CALX_BITS == 32
#define calx_sqrt(x) sqrtf(x)
#define calx_abs(x) fabsf(x)
#else
#define calx_sqrt(x) sqrt(x)
#define calx_abs(x) fabs(x)
#endif
#else
#include <math.h>
#if defined(__GNUC__)
/* A long law that is not inlined is not vectorised. */
#define CALX_FN static inline __attribute__((always_inline))
#define CALX_UNUSED __attribute__((unused))
#else
#define CALX_FN static inline
#endif
#if CALX_BITS == 32
#define calx_sqrt(x) sqrtf(x)
#define calx_abs(x) fabsf(x)
#else
#define calx_sqrt(x) sqrt(x)
#define calx_abs(x) fabs(x)
#endif
#endif
#ifndef CALX_UNUSED
#define CALX_UNUSED
#endif
/* Ternaries, not fmin and fmax: same bits everywhere, a NaN in a comes through as b only by the comparison written,
 * and each is one instruction. */
#define calx_min(a, b) ((a) < (b) ? (a) : (b))
#define calx_max(a, b) ((a) > (b) ? (a) : (b))

#ifndef CALX_NEED_OVERLAP
#define CALX_NEED_OVERLAP (1u << 0)
#define CALX_NEED_NORMAL (7u << 1)
#define CALX_NEED_VELOCITY (7u << 4)
#define CALX_NEED_SPIN (7u << 7)
#define CALX_NEED_R_EFF (1u << 10)
#define CALX_NEED_M_EFF (1u << 11)
#define CALX_NEED_R_I (1u << 12)
#define CALX_NEED_R_J (1u << 13)
#define CALX_NEED_FN_BEFORE (1u << 14)
#endif

/* What a law may read, SI. n points from j to i; v and w are those of i relative to j, v at the contact point. */
typedef struct CALX_ID(calx_contact) {
  real overlap;    /* m */
  real nx, ny, nz; /* 1 */
  real vx, vy, vz; /* m/s */
  real wx, wy, wz; /* rad/s */
  real r_eff, m_eff; /* m, kg */
  real r_i, r_j;   /* m; r_j is 0 for a wall */
  real fn_before;  /* N */
  real dt;         /* s */
  real time;       /* s, of the run; in single precision good to 1e-7 of itself */
} CALX_ID(calx_contact);

/* What a law writes. All zero before the call. The host adds lever-arm torques itself. */
typedef struct CALX_ID(calx_wrench) {
  real fx, fy, fz; /* N, on i */
  real mx, my, mz; /* N m, extra moment on i */
  /* J; computed only when the host keeps an energy ledger, otherwise the compiler drops it. */
  real elastic, friction, damping, plastic;
} CALX_ID(calx_wrench);

#undef CALX_FIELD
#define CALX_FIELD(name, unit, lo, hi, preset, flags, doc) real name;
#define CALX_STRUCT(law, what)       \
  typedef struct CALX_ID(law##_##what) { \
    law##_##what##_LIST(CALX_FIELD) real calx_unused; \
  } CALX_ID(law##_##what);
/* Before the helper functions of a law, and before CALX_LAW_EVAL. */
#define CALX_LAW_DECLARE(law) CALX_STRUCT(law, pair) CALX_STRUCT(law, prop) CALX_STRUCT(law, state)
/* Instead of it, for a second law of the same text that shares the pair row and the particle columns of the first and
 * keeps another history. The text still defines law_pair_LIST and law_prop_LIST, as other names of base's lists. */
#define CALX_LAW_DECLARE_LIKE(law, base)                        \
  typedef CALX_ID(base##_pair) CALX_ID(law##_pair);             \
  typedef CALX_ID(base##_prop) CALX_ID(law##_prop);             \
  CALX_STRUCT(law, state)
/* Gives: c contact, p pair row, pi and pj particle columns, s history, out wrench. */
#define CALX_LAW_EVAL(law)                                                                           \
  CALX_FN void CALX_ID(law##_eval)(                                                                  \
      CALX_UNUSED const CALX_ID(calx_contact) * c, CALX_UNUSED const CALX_ID(law##_pair) * p,        \
      CALX_UNUSED const CALX_ID(law##_prop) * pi, CALX_UNUSED const CALX_ID(law##_prop) * pj,        \
      CALX_UNUSED CALX_ID(law##_state) * s, CALX_UNUSED CALX_ID(calx_wrench) * out)

/* A force on single particles, in the same dialect: one list (SYMBOL_row_LIST) and one body, CALX_FORCE_EVAL(SYMBOL). */
typedef struct CALX_ID(calx_body) {
  real x, y, z;      /* m, centre of mass, world frame */
  real vx, vy, vz;   /* m/s */
  real wx, wy, wz;   /* rad/s */
  real mass, radius; /* kg; m, of the sphere of equal volume */
  real dt, time;     /* s */
} CALX_ID(calx_body);
#define CALX_FORCE_DECLARE(force) CALX_STRUCT(force, row)
/* Gives: b the particle, p the numbers of the instance, out wrench, of which energies mean nothing. */
#define CALX_FORCE_EVAL(force)                                                                         \
  CALX_FN void CALX_ID(force##_eval)(CALX_UNUSED const CALX_ID(calx_body) * b,                         \
                                     CALX_UNUSED const CALX_ID(force##_row) * p,                       \
                                     CALX_UNUSED CALX_ID(calx_wrench) * out)
