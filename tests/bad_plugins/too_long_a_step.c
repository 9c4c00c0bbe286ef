/* States a stable step ten times too long. */
#define BAD_ID "test.too-long-a-step"
#define BAD_STABLE 10 * sqrt(m_eff / pair[0])
#include "bad_law.h"
