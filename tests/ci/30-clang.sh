#!/usr/bin/env bash
# Second compiler, warnings as errors: engine, plugins and program; fast tests of what depends on the compiler.
source "$(dirname "$0")/common.sh"
build_and_test clang '^(base|abi|config|plugins|plugin|compute|neighbour)_|^step_(integrate|walls)$'
ninja -C build/clang -j "$cores" hosts/calx/all
