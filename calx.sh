#!/usr/bin/env bash
# Installs what is missing (packages.txt), builds Calx, and runs it with the arguments given:
#   ./calx.sh run CASE.json      any command of calx; "./calx.sh --help" lists them
#   ./calx.sh test               builds and runs every test
#   ./calx.sh packages           only installs what the build and the tests need
# For Debian 12 and Ubuntu 24.04. Root rights are asked for only when a package is missing.
set -euo pipefail
home=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cores=$(nproc)

# names GROUP: package names; "run" stops before the tests' own, "all" has every one.
names() {
  if [[ $1 == run ]]; then sed '/^# Tests/,$d' "$home/packages.txt"; else cat "$home/packages.txt"; fi |
    sed 's/#.*//' | grep -o '[^[:space:]]*' || true
}

has() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

missing() { for name in $(names "$1"); do has "$name" || echo "$name"; done; }

install_packages() {
  command -v dpkg-query >/dev/null || { echo "calx.sh: not a Debian system; see packages.txt for what is needed" >&2; return; }
  local wanted needed name root=() known=()
  wanted=$(missing "$1" | tr '\n' ' ')
  [[ -z $wanted ]] && return
  echo "calx.sh: installing $wanted" >&2
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null || { echo "calx.sh: needs root: apt-get install $wanted" >&2; exit 6; }
    root=(sudo)
  fi
  "${root[@]}" apt-get update -qq >&2
  # A name that this system does not have at all can only be one of the tests' tools: for the build it is an error.
  needed=" $(names run | tr '\n' ' ') "
  for name in $wanted; do
    if [[ $needed == *" $name "* || $(LC_ALL=C apt-cache policy "$name") == *"Candidate: "[!\(]* ]]; then
      known+=("$name")
    else
      echo "calx.sh: no package $name here; tests that need it are skipped" >&2
    fi
  done
  [[ ${#known[@]} -eq 0 ]] ||
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${known[@]}" >&2
}

# build TARGETS...: all output to stderr, so that calx alone writes to stdout. Shows progress of a first build only.
build() {
  local tree=$home/build/release how=()
  mkdir -p "$tree"
  if [[ ! -f $tree/build.ninja || $home/CMakePresets.json -nt $tree/build.ninja ]]; then
    (cd "$home" && cmake --preset release) >"$tree/configure.log" 2>&1 || { cat "$tree/configure.log" >&2; exit 1; }
  fi
  [[ $1 == all || ! -x $tree/bin/calx ]] || how=(--quiet)
  ninja -C "$tree" -j "$cores" "${how[@]}" "$@" | { grep -v 'no work to do' || true; } >&2
}

run_tests() {
  local start=$SECONDS log status=0
  install_packages all
  build all
  log=$home/build/release/tests.log
  ctest --test-dir "$home/build/release" --output-on-failure -j "$cores" | tee "$log" || status=$?
  local total failed skipped
  total=$(sed -n 's/.* tests failed out of \([0-9]*\)$/\1/p' "$log")
  failed=$(sed -n 's/.*tests passed, \([0-9]*\) tests failed.*/\1/p' "$log")
  skipped=$(grep -c '\*\*\*Skipped' "$log" || true)
  [[ -n $total ]] || { echo "calx.sh: ctest did not finish; see $log" >&2; exit 1; }
  echo
  echo "Tests: $((total - failed - skipped)) passed, $failed failed, $skipped skipped, $((SECONDS - start)) s with the build; log in $log"
  exit "$status"
}

case ${1:-} in
  test) run_tests ;;
  packages) install_packages all ;;
  *)
    install_packages run
    build calx plugins/all
    exec "$home/build/release/bin/calx" "$@"
    ;;
esac
