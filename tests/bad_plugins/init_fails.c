/* init reports an error. */
#define BAD_ID "test.init-fails"
#define BAD_INIT return host->fail(host, CALX_E_IO, "no calibration file")
#include "bad_plugin.h"
