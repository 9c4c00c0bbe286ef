#!/usr/bin/env bash
# The whole tree with g++, warnings as errors, and every test: the second command of the README.
source "$(dirname "$0")/common.sh"
./calx.sh test
