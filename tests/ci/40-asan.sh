#!/usr/bin/env bash
# Address and undefined-behaviour sanitizers on unit tests, bad plugins included.
source "$(dirname "$0")/../common.sh"
build_and_test asan '^(base|config|store|geometry|motion|plugin|plugins|plugins_motion|neighbour|measure)_'
