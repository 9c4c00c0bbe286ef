#!/usr/bin/env bash
# Second compiler: engine and plugins, warnings as errors; tests of laws, boundary and base.
source "$(dirname "$0")/../common.sh"
build_and_test clang '^(base|abi|plugins|plugin|compute|step)_'
