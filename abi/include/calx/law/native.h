/* SPDX-License-Identifier: MIT
 * calx/law/native.h: CALX_LAW_BATCH(SYMBOL) turns a law text into the block function of calx_contact_law, a loop over
 * columns that the compiler vectorises. Include after the law text, once per precision.
 * Measured: it needs -O3 -fno-math-errno -fno-trapping-math on the command line (they change no value), restrict on
 * every column, and an always-inlined body. calx_add_plugin() sets the flags. */
#include <calx/contact_law.h>

#ifndef CALX_LAW_NATIVE_MACROS
#define CALX_LAW_NATIVE_MACROS
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(CALX_NO_CLONES)
/* One text, three instruction sets, chosen when the library loads; without contraction the bits are the same. */
#define CALX_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CALX_CLONES
#endif
#define CALX_N_PAIR(name, u, lo, hi, d, fl, doc) pair.name = b->pair[k++];
#define CALX_N_PROP_POINTER(name, u, lo, hi, d, fl, doc)          \
  const real* __restrict pi_##name = b->prop_i + b->stride * k; \
  const real* __restrict pj_##name = b->prop_j + b->stride * k; \
  ++k;
#define CALX_N_STATE_POINTER(name, u, lo, hi, d, fl, doc) \
  real* __restrict st_##name = b->state + b->stride * k; \
  ++k;
#define CALX_N_PROP_LOAD(name, u, lo, hi, d, fl, doc) \
  pi.name = pi_##name[i];                             \
  pj.name = pj_##name[i];
#define CALX_N_STATE_LOAD(name, u, lo, hi, d, fl, doc) s.name = st_##name[i];
#define CALX_N_STATE_STORE(name, u, lo, hi, d, fl, doc) st_##name[i] = s.name;
#define CALX_N_ROW(name, unit, lo, hi, preset, flags, doc) {#name, unit, doc, lo, hi, preset, flags, 0},
#define CALX_COUNT(table) ((uint32_t)(sizeof(table) / sizeof((table)[0]) - 1))
#define CALX_N_END {0, 0, 0, 0.0, 0.0, 0.0, 0, 0}
/* Field tables of a law: SYMBOL_pair_fields, SYMBOL_prop_fields, SYMBOL_state_fields, each with one closing row. */
#define CALX_LAW_TABLES(law)                                                           \
  static const calx_field law##_pair_fields[] = {law##_pair_LIST(CALX_N_ROW) CALX_N_END};   \
  static const calx_field law##_prop_fields[] = {law##_prop_LIST(CALX_N_ROW) CALX_N_END};   \
  static const calx_field law##_state_fields[] = {law##_state_LIST(CALX_N_ROW) CALX_N_END};
/* Fills what a calx_contact_law takes from the lists and the two compilations of the text; material, given, derive,
 * stable_dt, reach, flags and the text itself stay with the author. */
#define CALX_LAW_FILL(table, law)                      \
  do {                                                 \
    (table).struct_size = sizeof(calx_contact_law);    \
    (table).draft = CALX_ABI_DRAFT;                    \
    (table).dialect = 1;                               \
    (table).needs = law##_NEEDS;                       \
    (table).pair_count = CALX_COUNT(law##_pair_fields);   \
    (table).prop_count = CALX_COUNT(law##_prop_fields);   \
    (table).state_count = CALX_COUNT(law##_state_fields); \
    (table).pair = law##_pair_fields;                  \
    (table).prop = law##_prop_fields;                  \
    (table).state = law##_state_fields;                \
    (table).symbol = #law;                             \
    (table).eval_f32 = law##_batch_f32;                \
    (table).eval_f64 = law##_batch_f64;                \
  } while (0)
#endif

#undef CALX_N_IN
#undef CALX_N_LOOP
#undef CALX_LAW_BATCH
#define CALX_N_IN(law, bit) (((law##_NEEDS) >> (bit)) & 1u)
#define CALX_N_LOOP(law, STORE_ENERGY)                                                               \
  _Pragma("omp simd") for (uint32_t i = 0; i < n; ++i) {                                             \
    CALX_ID(calx_contact) c;                                                                         \
    CALX_ID(law##_prop) pi, pj;                                                                      \
    CALX_ID(law##_state) s;                                                                          \
    CALX_ID(calx_wrench) o;                                                                          \
    c.overlap = CALX_N_IN(law, 0) ? ov[i] : R(0.0);                                                  \
    c.nx = CALX_N_IN(law, 1) ? nx[i] : R(0.0);                                                       \
    c.ny = CALX_N_IN(law, 2) ? ny[i] : R(0.0);                                                       \
    c.nz = CALX_N_IN(law, 3) ? nz[i] : R(0.0);                                                       \
    c.vx = CALX_N_IN(law, 4) ? vx[i] : R(0.0);                                                       \
    c.vy = CALX_N_IN(law, 5) ? vy[i] : R(0.0);                                                       \
    c.vz = CALX_N_IN(law, 6) ? vz[i] : R(0.0);                                                       \
    c.wx = CALX_N_IN(law, 7) ? wx[i] : R(0.0);                                                       \
    c.wy = CALX_N_IN(law, 8) ? wy[i] : R(0.0);                                                       \
    c.wz = CALX_N_IN(law, 9) ? wz[i] : R(0.0);                                                       \
    c.r_eff = CALX_N_IN(law, 10) ? re[i] : R(0.0);                                                   \
    c.m_eff = CALX_N_IN(law, 11) ? me[i] : R(0.0);                                                   \
    c.r_i = CALX_N_IN(law, 12) ? ri[i] : R(0.0);                                                     \
    c.r_j = CALX_N_IN(law, 13) ? rj[i] : R(0.0);                                                     \
    c.fn_before = CALX_N_IN(law, 14) ? fb[i] : R(0.0);                                               \
    c.dt = dt;                                                                                       \
    c.time = time;                                                                                   \
    o.fx = o.fy = o.fz = o.mx = o.my = o.mz = R(0.0);                                                \
    o.elastic = o.friction = o.damping = o.plastic = R(0.0);                                         \
    law##_prop_LIST(CALX_N_PROP_LOAD) law##_state_LIST(CALX_N_STATE_LOAD)                            \
    CALX_ID(law##_eval)(&c, &pair, &pi, &pj, &s, &o);                                                \
    law##_state_LIST(CALX_N_STATE_STORE)                                                             \
    fx[i] = o.fx;                                                                                    \
    fy[i] = o.fy;                                                                                    \
    fz[i] = o.fz;                                                                                    \
    mx[i] = o.mx;                                                                                    \
    my[i] = o.my;                                                                                    \
    mz[i] = o.mz;                                                                                    \
    STORE_ENERGY                                                                                     \
  }
#define CALX_LAW_BATCH(law)                                                                              \
  CALX_CLONES static void CALX_ID(law##_batch)(const CALX_ID(calx_block) * b) {                                   \
    const real *__restrict ov = b->in[0], *__restrict nx = b->in[1], *__restrict ny = b->in[2],          \
               *__restrict nz = b->in[3], *__restrict vx = b->in[4], *__restrict vy = b->in[5],          \
               *__restrict vz = b->in[6], *__restrict wx = b->in[7], *__restrict wy = b->in[8],          \
               *__restrict wz = b->in[9], *__restrict re = b->in[10], *__restrict me = b->in[11],        \
               *__restrict ri = b->in[12], *__restrict rj = b->in[13], *__restrict fb = b->in[14];       \
    real *__restrict fx = b->out[0], *__restrict fy = b->out[1], *__restrict fz = b->out[2],             \
         *__restrict mx = b->out[3], *__restrict my = b->out[4], *__restrict mz = b->out[5],             \
         *__restrict ee = b->out[6], *__restrict ef = b->out[7], *__restrict ed = b->out[8],             \
         *__restrict ep = b->out[9];                                                                     \
    const real dt = (real)b->dt, time = (real)b->time;                                                   \
    const uint32_t n = b->count;                                                                         \
    uint64_t k = 0;                                                                                      \
    CALX_ID(law##_pair) pair;                                                                            \
    law##_pair_LIST(CALX_N_PAIR) k = 0;                                                                  \
    law##_prop_LIST(CALX_N_PROP_POINTER) k = 0;                                                          \
    law##_state_LIST(CALX_N_STATE_POINTER)(void) k;                                                      \
    (void)nx, (void)ny, (void)nz, (void)vx, (void)vy, (void)vz, (void)wx, (void)wy, (void)wz;            \
    (void)ov, (void)re, (void)me, (void)ri, (void)rj, (void)fb, (void)time;                              \
    if (ee) {                                                                                            \
      CALX_N_LOOP(law, ee[i] = o.elastic; ef[i] = o.friction; ed[i] = o.damping; ep[i] = o.plastic;)     \
    } else {                                                                                             \
      CALX_N_LOOP(law, )                                                                                 \
    }                                                                                                    \
  }
