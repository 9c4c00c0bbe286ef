// hot.hpp: functions compiled for several instruction sets.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(CALX_NO_CLONES)
/// Chosen when the program loads; without contraction every instruction set gives the same bits.
#define CALX_HOT __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CALX_HOT
#endif
