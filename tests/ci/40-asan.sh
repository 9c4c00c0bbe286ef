#!/usr/bin/env bash
# Address and undefined-behaviour sanitizers where foreign input and pointers are: texts of cases, plugins that lie, lists,
# the step, STL files.
source "$(dirname "$0")/common.sh"
build_and_test asan '^(base|config|store|plugin|neighbour)_|^(step_integrate|step_walls|sim_guards|geometry_mesh_plugin)$'
