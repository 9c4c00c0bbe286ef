#!/usr/bin/env bash
# Thread sanitizer on lists, step and same bits for any number of threads. clang's OpenMP runtime tells the sanitizer
# about its barriers (libarcher, part of libomp-dev); gcc's does not, so every parallel loop would be reported.
source "$(dirname "$0")/common.sh"
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1"
# Threads that wait give their core away: tests ask for more threads than a small machine has cores.
export KMP_BLOCKTIME=0

mkdir -p build/tsan
clang++ -g -O1 -fopenmp=libomp -fsanitize=thread tests/ci/race.cpp -o build/tsan/race
build/tsan/race || { echo "FAIL the sanitizer reports a race where barriers stand"; exit 1; }
if build/tsan/race on-purpose 2>/dev/null; then echo "FAIL the sanitizer does not see a race"; exit 1; fi

build_and_test tsan '^(compute|neighbour)_|^(plugin_registry|sim_guards|step_integrate|scenes_determinism)$' \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
