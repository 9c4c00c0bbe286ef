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

for file in bin/calx include/calx/abi.h include/calx/plugin.hpp lib/cmake/CalxAbi/CalxAbiConfig.cmake lib/pkgconfig/calx-abi.pc; do
  [[ -e $prefix/$file ]] || fail "$file is not installed"
done
if grep -rIl -e "$build" -e "$root" -e "$scratch/first" "$prefix"; then fail "the files above name the build machine"; fi
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

# It runs on every device of the machine, to the bits of its native code; a device that is not there is named and skipped.
env PYTHONDONTWRITEBYTECODE=1 CALX="$prefix/bin/calx" CALX_PLUGINS="$prefix/lib/calx/plugins" CALX_SOURCE="$root" \
  CALX_LAW="$scratch/law/build/plugins" CALX_DEVICE_CACHE="$scratch/device_cache" \
  CALX_STAND_IN_CUDA="$build/tests/compute/libcalx_stand_in_cuda.so" \
  CALX_STAND_IN_NVRTC="$build/tests/compute/libcalx_stand_in_nvrtc.so" \
  /usr/bin/python3 "$root/tests/outside/test_third_party_law.py" ThirdPartyLaw.test_same_bits >"$scratch/devices.txt" 2>&1 ||
  fail "third-party law on devices: $(cat "$scratch/devices.txt")"
grep -i 'skip' "$scratch/devices.txt" || true

echo "installed, moved, $(grep -c . "$scratch/list.txt") lines of plugins, third-party law described and run on devices"
