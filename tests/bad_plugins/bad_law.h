/* bad_law.h: a correct contact law with a text, each part of which the including file may replace by a macro. After
 * each evaluation the native code may do BAD_AFTER(block, real), which the text knows nothing of. */
#include <calx/all.h>
#include <string.h>
// clang-format off
#define CALX_BITS 32
#include <calx/law/prelude.h>
#include "bad_spring.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(bad_spring)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include "bad_spring.law.h"
#include <calx/law/native.h>
// clang-format on
CALX_LAW_BATCH(bad_spring)
CALX_LAW_TABLES(bad_spring)

#ifndef BAD_AFTER
#define BAD_AFTER(block, scalar)
#endif
#ifndef BAD_STABLE
#define BAD_STABLE 0.1 * sqrt(m_eff / pair[0])
#endif
#ifndef BAD_REACH
#define BAD_REACH 0
#endif
#ifndef BAD_SHA256
#define BAD_SHA256 sha256
#endif

static const char source[] = {
#include "bad_spring.law.h.inc"
};
static const char sha256[] =
#include "bad_spring.law.h.sha256.inc"
    ;
static void CALX_CALL eval_f32(const calx_block_f32* block) {
  bad_spring_batch_f32(block);
  BAD_AFTER(block, float);
}
static void CALX_CALL eval_f64(const calx_block_f64* block) {
  bad_spring_batch_f64(block);
  BAD_AFTER(block, double);
}
static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) {
  (void)pair, (void)m_eff, (void)r_eff, (void)overlap, (void)sha256;
  return BAD_STABLE;
}
static const calx_contact_law law = {sizeof(calx_contact_law),
                                     CALX_ABI_DRAFT,
                                     1,
                                     CALX_LAW_EXACT,
                                     bad_spring_NEEDS,
                                     0,
                                     CALX_COUNT(bad_spring_pair_fields),
                                     CALX_COUNT(bad_spring_pair_fields),
                                     0,
                                     CALX_COUNT(bad_spring_state_fields),
                                     0,
                                     bad_spring_pair_fields,
                                     bad_spring_pair_fields,
                                     bad_spring_prop_fields,
                                     bad_spring_state_fields,
                                     0,
                                     stable_dt,
                                     BAD_REACH,
                                     "bad_spring",
                                     source,
                                     sizeof source - 1,
                                     BAD_SHA256,
                                     eval_f32,
                                     eval_f64};
#define BAD_KIND CALX_CONTACT_LAW
#define BAD_TABLE &law
#include "bad_plugin.h"
