/* Leaves a file in the working directory when its code runs. */
#define BAD_ID "test.trap"
#include <stdio.h>
__attribute__((constructor)) static void spring_shut(void) {
  FILE* file = fopen("trap-was-executed", "w");
  if (file) fclose(file);
}
#include "bad_plugin.h"
