# common.sh: read by the rows in this folder. Each row is a script that also runs alone, from anywhere; it leaves its
# build tree in build/ and ends with status 0 only if all is well.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
cores=$(nproc)

# build_and_test PRESET TESTS [OPTIONS FOR CMAKE...]: builds engine, plugins and the tests whose names match the regular
# expression TESTS, and runs these. Tests labelled slow, hygiene or bench are left to the release build.
build_and_test() {
  local preset=$1 tests=$2 tree=build/$1 name targets=()
  shift 2
  cmake --preset "$preset" "$@"
  for name in $(ctest --test-dir "$tree" -N -R "$tests" -LE 'slow|hygiene|bench' | sed -n 's/^ *Test *#[0-9]*: *//p'); do
    # A test that is not a program of its own name is made of targets that the other tests and plugins bring.
    if ninja -C "$tree" -t query "test_$name" >/dev/null 2>&1; then targets+=("test_$name"); fi
  done
  ninja -C "$tree" -j "$cores" core/all plugins/all "${targets[@]}"
  ctest --test-dir "$tree" -R "$tests" -LE 'slow|hygiene|bench' --output-on-failure --no-tests=error -j "$cores"
}
