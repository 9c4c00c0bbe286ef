/* SPDX-License-Identifier: MIT
 * calx/contact_law.h: the function table of a contact law, "calx.contact-law/1". C99 and C++98.
 *
 * A law sees one contact at a time, in blocks of rows that share one pair row. Unit normal n points from j to i;
 * velocity and spin are those of i relative to j, velocity at the contact point. It returns the force on i and an
 * extra moment on i; the host gives j the opposite and adds the lever-arm torques, so momentum and angular momentum
 * hold for every law. Against a wall i is the particle, j the wall: r_eff = r_i, m_eff = m_i, r_j = 0.
 *
 * A law with `reach` also gets contacts that do not touch: overlap is then minus the gap, the contact point lies in the
 * middle of the gap or on the wall. It may get rows beyond its reach, too; there its wrench and energies are 0 and its
 * history has the presets of a new contact. While the spheres do not touch, only history that is CALX_FIELD_KEEP_APART
 * lasts: all other columns hold their presets before and after the call. */
#ifndef CALX_CONTACT_LAW_H
#define CALX_CONTACT_LAW_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_CONTACT_LAW "calx.contact-law/1"
#define CALX_LAW_EXACT (1u << 0)  /* only + - * / sqrt and comparisons: same bits on every backend */
#define CALX_LAW_ACTIVE (1u << 1) /* may create energy on purpose */

/* Input columns; bit k of needs asks for in[k]. A column not asked for is null. */
#define CALX_IN_OVERLAP 0   /* m, positive when touching; minus the gap for a law with reach */
#define CALX_IN_NX 1        /* 1, from j to i */
#define CALX_IN_NY 2
#define CALX_IN_NZ 3
#define CALX_IN_VX 4        /* m/s, i relative to j at the contact point */
#define CALX_IN_VY 5
#define CALX_IN_VZ 6
#define CALX_IN_WX 7        /* rad/s, i relative to j */
#define CALX_IN_WY 8
#define CALX_IN_WZ 9
#define CALX_IN_R_EFF 10    /* m, r_i r_j / (r_i + r_j) */
#define CALX_IN_M_EFF 11    /* kg, masses of the whole clumps */
#define CALX_IN_R_I 12      /* m */
#define CALX_IN_R_J 13      /* m; 0 for a wall */
#define CALX_IN_FN_BEFORE 14 /* N, normal force of the laws before this one in the list, positive pushes apart */
#define CALX_IN_COUNT 15

/* Output columns. The first six are always given. The energy columns are null unless the host keeps a ledger. */
#define CALX_OUT_FX 0       /* N, force on i */
#define CALX_OUT_FY 1
#define CALX_OUT_FZ 2
#define CALX_OUT_MX 3       /* N m, extra moment on i */
#define CALX_OUT_MY 4
#define CALX_OUT_MZ 5
#define CALX_OUT_ELASTIC 6  /* J, recoverable energy stored in the contact after this evaluation */
#define CALX_OUT_FRICTION 7 /* J, lost to sliding and rolling friction in this step */
#define CALX_OUT_DAMPING 8  /* J, lost to dashpots in this step */
#define CALX_OUT_PLASTIC 9  /* J, lost to plastic flow and adhesion in this step */
#define CALX_OUT_COUNT 10

#define CALX_DEFINE_BLOCK(bits, scalar)                                                       \
  typedef struct calx_block_f##bits {                                                         \
    uint32_t struct_size, count;                                                              \
    uint64_t stride; /* rows between two columns of prop, add and state */                    \
    double dt, time; /* s */                                                                  \
    const scalar* in[32];                                                                     \
    scalar* out[16];                                                                          \
    const scalar* pair;            /* pair_count values, one row for the block */             \
    const scalar *prop_i, *prop_j; /* prop_count columns each */                              \
    scalar *add_i, *add_j;         /* shares of accumulated particle columns */               \
    scalar* state;                 /* state_count columns, this law's only, read and written */ \
  } calx_block_f##bits;                                                                       \
  typedef void(CALX_CALL* calx_eval_f##bits)(const calx_block_f##bits* block);
CALX_DEFINE_BLOCK(32, float)
CALX_DEFINE_BLOCK(64, double)

typedef struct calx_contact_law {
  uint32_t struct_size, draft, dialect, flags; /* draft: CALX_ABI_DRAFT; dialect: 1 */
  uint32_t needs;                              /* bit k: in[k] is read */
  uint32_t material_count, given_count, pair_count, prop_count, state_count;
  const calx_field* material; /* asked of the user once per material */
  const calx_field* given;    /* asked of the user once per material pair */
  const calx_field* pair;     /* what the law reads: one row per ordered material pair */
  const calx_field* prop;     /* particle columns it reads or adds to */
  const calx_field* state;    /* contact history; presets are the values of a new contact */
  /* Fills one pair row from two material rows and the given row; null: the given row is the pair row. The instance
   * carries the options of the descriptor's parameter table. Set-up only. [main] */
  calx_status(CALX_CALL* derive)(const calx_instance* self, const calx_host* host, const double* material_i,
                                 const double* material_j, const double* given, double* pair);
  /* Largest stable step of one contact, s; kg, m; overlap, m: that of the fastest impact expected. Or null. [main] */
  double(CALX_CALL* stable_dt)(const double* pair, double m_eff, double r_eff, double overlap);
  /* Largest gap at which the wrench can be non-zero, m, finite; null: acts only while touching. r_j is 0 for a wall; of
   * two spheres it does not fall when a radius grows. [main] */
  double(CALX_CALL* reach)(const double* pair, double r_i, double r_j);
  const char* symbol; /* "spring": prefix of every name in the text */
  const char* source; /* law text, source_size bytes */
  uint64_t source_size;
  const char* source_sha256; /* hex; the functions below were compiled from this very text */
  calx_eval_f32 eval_f32;    /* [worker], pure */
  calx_eval_f64 eval_f64;
} calx_contact_law;

#ifdef __cplusplus
}
#endif
#endif
