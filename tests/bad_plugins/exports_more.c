/* Exports a symbol besides its entry, as a build without hidden visibility does. */
#define BAD_ID "test.exports-more"
#include "bad_plugin.h"
CALX_EXPORT int bad_helper(void);
int bad_helper(void) { return 1; }
