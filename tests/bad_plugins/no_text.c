/* A contact law with native code alone, which is allowed and keeps it on the processor. */
#define BAD_ID "test.no-text"
#define BAD_TEXT 0, 0
#include "leaning_text.c"
