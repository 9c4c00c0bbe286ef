#!/usr/bin/env bash
# check.sh BUILD: installs a finished build into an empty folder, moves that folder, and uses it without the source tree:
# program, plugins, and a third party's law built against the installed package with plain make and run on devices.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
  echo "FAIL $*" >&2
  exit 1
}

cmake --install "$build" --prefix "$scratch/first" >"$scratch/install.log" || fail "cmake --install: $(tail -3 "$scratch/install.log")"
mv "$scratch/first" "$scratch/prefix"
prefix=$scratch/prefix
unset CALX_PLUGIN_PATH

for file in bin/calx share/calx/template/sensor/try.json share/doc/calx/kinds.md share/doc/calx/case.md share/calx/examples/plugins/drag/stokes_drag.law.h share/calx/examples/two_balls.json include/calx/abi.h include/calx/plugin.hpp lib/cmake/CalxAbi/CalxAbiConfig.cmake lib/pkgconfig/calx-abi.pc; do
  [[ -e $prefix/$file ]] || fail "$file is not installed"
done
if grep -rIl -e "$build" -e "$root" -e "$scratch/first" "$prefix"; then fail "the files above name the build machine"; fi
env PYTHONDONTWRITEBYTECODE=1 python3 "$root/tests/hygiene/links.py" "$prefix" >"$scratch/links.txt" ||
  fail "links of installed pages: $(cat "$scratch/links.txt")"
if ldd "$prefix/bin/calx" | grep 'not found'; then fail "bin/calx lacks libraries"; fi
"$prefix/bin/calx" --version

# Every plugin of the build is found from where the program now lies.
"$prefix/bin/calx" plugin list >"$scratch/list.txt"
while read -r id; do
  grep -q -- "$id" "$scratch/list.txt" || fail "calx plugin list does not show $id"
done < <(grep -ho '"id": *"[^"]*"' "$build"/plugins/*.plugin.json | cut -d'"' -f4)

# A third party's law.
cp -r "$root/examples/third_party_law" "$scratch/law"
cmake -G "Unix Makefiles" -S "$scratch/law" -B "$scratch/law/build" -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/law.log" 2>&1 ||
  fail "third-party law: $(cat "$scratch/law.log")"
cmake --build "$scratch/law/build" >>"$scratch/law.log" 2>&1 || fail "third-party law: $(cat "$scratch/law.log")"
python3 "$root/tests/hygiene/exports.py" "$scratch/law/build/plugins"
"$prefix/bin/calx" plugin describe org.example.spring --plugin-path "$scratch/law/build/plugins" >"$scratch/describe.txt" ||
  fail "calx plugin describe org.example.spring"
grep -q 'normal stiffness' "$scratch/describe.txt" || fail "calx plugin describe org.example.spring does not show its parameters"

# Plugins of Calx that its guide names as examples, built from what is installed.
{ cmake -S "$prefix/share/calx/examples/plugins" -B "$scratch/examples" -DCMAKE_PREFIX_PATH="$prefix" &&
  cmake --build "$scratch/examples"; } >"$scratch/examples.log" 2>&1 || fail "examples/plugins: $(tail -20 "$scratch/examples.log")"
"$prefix/bin/calx" plugin list --plugin-path "$scratch/examples/plugins" >"$scratch/list.txt" || fail "calx plugin list: $(cat "$scratch/list.txt")"
grep -q calx.stokes-drag "$scratch/list.txt" || fail "calx.stokes-drag of examples/plugins is not listed"

# A plugin of the templates, begun, built and checked with what is installed alone.
"$prefix/bin/calx" plugin new my-force --kind particle-force --in "$scratch" >"$scratch/new.log"
grep -qF -- "-DCMAKE_PREFIX_PATH=$prefix" "$scratch/new.log" || fail "calx plugin new does not say where Calx is installed"
{ cmake -S "$scratch/my-force" -B "$scratch/my-force/build" -DCMAKE_PREFIX_PATH="$prefix" &&
  cmake --build "$scratch/my-force/build" &&
  ctest --test-dir "$scratch/my-force/build" --output-on-failure --no-tests=error; } >>"$scratch/new.log" 2>&1 ||
  fail "calx plugin new: $(cat "$scratch/new.log")"
"$prefix/bin/calx" plugin check "$prefix/lib/calx/plugins" --only creates >"$scratch/creates.txt" ||
  fail "calx plugin check of the installed plugins: $(grep -A1 FAILED "$scratch/creates.txt")"

# The law runs on every device of the machine, to the bits of its native code; a device that is not there is named and skipped.
env PYTHONDONTWRITEBYTECODE=1 CALX="$prefix/bin/calx" CALX_PLUGINS="$prefix/lib/calx/plugins" CALX_SOURCE="$root" \
  CALX_LAW="$scratch/law/build/plugins" CALX_DEVICE_CACHE="$scratch/device_cache" \
  CALX_STAND_IN_CUDA="$build/tests/compute/libcalx_stand_in_cuda.so" \
  CALX_STAND_IN_NVRTC="$build/tests/compute/libcalx_stand_in_nvrtc.so" \
  /usr/bin/python3 "$root/tests/outside/test_third_party_law.py" ThirdPartyLaw.test_same_bits >"$scratch/devices.txt" 2>&1 ||
  fail "third-party law on devices: $(cat "$scratch/devices.txt")"
grep -i 'skip' "$scratch/devices.txt" || true

# Programs around the library, against the installed package; the same bits as calx run.
cmake -G "Unix Makefiles" -S "$root/examples/embed" -B "$scratch/embed" -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/embed.log" 2>&1 &&
  cmake --build "$scratch/embed" >>"$scratch/embed.log" 2>&1 || fail "examples/embed: $(cat "$scratch/embed.log")"
if nm -D --defined-only "$prefix/lib/libcalx.so" | grep -v ' calx_sim_'; then fail "libcalx.so exports the names above"; fi
case=$root/examples/two_balls.json
mkdir "$scratch/state"
"$prefix/bin/calx" run "$case" --until 0.1 --quiet --no-report -o "$scratch/run" >"$scratch/run.txt" 2>&1 || fail "$(cat "$scratch/run.txt")"
for program in hopper turbine own_sensor "two_balls $case $scratch/state"; do
  "$scratch/embed/"$program >"$scratch/out.txt" 2>"$scratch/err.txt" || fail "examples/embed: $program: $(cat "$scratch/err.txt")"
  [[ ! -s $scratch/err.txt ]] || fail "examples/embed: $program writes to stderr"
done
digest=$(tail -1 "$scratch/out.txt")
/usr/bin/python3 "$root/examples/embed/portal.py" "$prefix/lib/libcalx.so" "$case" >"$scratch/portal.txt" || fail "portal.py"
[[ $(tail -1 "$scratch/portal.txt") == "$digest" ]] || fail "portal.py ends with other bits than two_balls.c"
env PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$root/tests/outside" CALX="$prefix/bin/calx" CALX_PLUGINS="$prefix/lib/calx/plugins" \
  CALX_SOURCE="$root" \
  /usr/bin/python3 -c 'import calx, sys; sys.exit([n for n in calx.differences(*sys.argv[1:]) if n[:7] != "sensors"] or None)' \
  "$scratch/run/checkpoint.h5" "$scratch/state/checkpoint.h5" ||
  fail "libcalx gives other bits than calx run"

echo "installed, moved, $(grep -c . "$scratch/list.txt") lines of plugins, third-party law run on devices, programs around libcalx"
