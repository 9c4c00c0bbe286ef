#!/usr/bin/env bash
# Installs the release build and uses it as a stranger would.
source "$(dirname "$0")/common.sh"
./calx.sh --version
ninja -C build/release -j "$cores"
tests/install/check.sh build/release
