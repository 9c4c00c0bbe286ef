#!/bin/sh
# build.sh OUT: how golden_law.so was built, on Debian 12 with gcc 12.2 for x86-64. It writes OUT/golden_law.so and leaves
# the one in the tree alone, which is never built again. The library needs no other library and exports one symbol.
set -eu
out=${1:?"usage: build.sh OUT"}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
od -An -v -tx1 "$here/golden_law.law.h" | sed 's/ \([0-9a-f][0-9a-f]\)/0x\1,/g' > "$out/golden_law.law.h.inc"
echo 0 >> "$out/golden_law.law.h.inc"
sha256sum "$here/golden_law.law.h" | sed 's/\([0-9a-f]*\).*/"\1"/' > "$out/golden_law.law.h.sha256.inc"
gcc -std=c99 -shared -fPIC -O2 -fno-math-errno -fno-trapping-math -ffp-contract=off -fvisibility=hidden \
  -fno-stack-protector -fno-asynchronous-unwind-tables -DCALX_NO_CLONES -I "$here/../../abi/include" -I "$here" -I "$out" \
  -nostdlib -s -Wl,-z,defs -Wl,-z,now -Wl,-z,relro -Wl,-z,noseparate-code -Wl,--build-id=none \
  "$here/golden_law.c" -o "$out/golden_law.so"
