// my_plugin.cpp: the force my_plugin.law.h as the plugin org.example.my-plugin, a hidden cause of a diagnosis.
#define CALX_TERM my_plugin
#define CALX_TERM_TEXT "my_plugin.law.h"
#define CALX_TERM_BYTES "my_plugin.law.h.inc"
#define CALX_TERM_SHA256 "my_plugin.law.h.sha256.inc"
#include <calx/force_term.hpp>

const calx_descriptor calx::ForceTerm::descriptor =
    calx::force_term("org.example.my-plugin", "my-plugin", "0.1.0", "Example", "MIT",
                     "Air that escapes upwards carries a part of the weight.");

CALX_PLUGIN(calx::ForceTerm)
