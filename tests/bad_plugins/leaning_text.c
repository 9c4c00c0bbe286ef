/* A contact law whose native code works, and whose text compiles on no device. */
#ifndef BAD_ID
#define BAD_ID "test.leaning-text"
#define BAD_TEXT source, sizeof source - 1
#endif
#include <calx/all.h>
#define CALX_BITS 64
#define LEANING_TEXT_STIFFER R(2.0)
// clang-format off
#include <calx/law/prelude.h>
#include "leaning_text.law.h"
#include <calx/law/native.h>
// clang-format on
CALX_LAW_BATCH(leaning_text)
static const calx_field pair[] = {leaning_text_pair_LIST(CALX_N_ROW) CALX_N_END};

static const char source[] = {
#include "leaning_text.law.h.inc"
};
static double CALX_CALL stable_dt(const double* numbers, double m_eff, double r_eff, double overlap) {
  (void)r_eff, (void)overlap, (void)source;
  return 0.1 * sqrt(m_eff / numbers[0]);
}
static const calx_contact_law law = {sizeof(calx_contact_law),
                                     CALX_ABI_DRAFT,
                                     1,
                                     CALX_LAW_EXACT,
                                     leaning_text_NEEDS,
                                     0,
                                     CALX_COUNT(pair),
                                     CALX_COUNT(pair),
                                     0,
                                     0,
                                     0,
                                     pair,
                                     pair,
                                     0,
                                     0,
                                     0,
                                     stable_dt,
                                     0,
                                     "leaning_text",
                                     BAD_TEXT,
#include "leaning_text.law.h.sha256.inc"
                                     ,
                                     0,
                                     leaning_text_batch_f64};
#define BAD_KIND CALX_CONTACT_LAW
#define BAD_TABLE &law
#include "bad_plugin.h"
