/* A contact law that reads moisture, which the spring law reads in 1, in another unit. */
#include <calx/contact_law.h>
#define BAD_ID "test.other-unit"
#define BAD_KIND CALX_CONTACT_LAW
#define BAD_TABLE &law
static const calx_field material[] = {{"moisture", "kg/m^3", "mass of water per volume", 0.0, 1000.0, 0.0, 0, 0}};
static void CALX_CALL eval_block(const calx_block_f64* block) { (void)block; }
static const calx_contact_law law = {sizeof(calx_contact_law),
                                     CALX_ABI_DRAFT,
                                     1,
                                     0,
                                     0,
                                     1,
                                     0,
                                     0,
                                     0,
                                     0,
                                     material,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     eval_block};
#include "bad_plugin.h"
