/* A library that is no plugin. */
__attribute__((visibility("default"))) int some_other_symbol = 1;
