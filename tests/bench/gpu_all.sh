#!/usr/bin/env bash
# Everything that is to be seen on a machine with a GPU, unattended; README.md, section GPU. --help lists the options.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)

usage() {
  cat <<'TEXT'
gpu_all.sh [--build DIR | --unpacked DIR] [options]     runs; a failed part does not keep the next one from running
gpu_all.sh --pack FILE.tar.gz [--build DIR]             packs a build for a machine where nothing can be installed

  --build DIR           build tree with bin/calx and plugins (default: build/release)
  --unpacked DIR        folder of an unpacked pack (default when this script lies in one)
  --device KIND[:i]     cuda (default), opencl or host
  --out DIR             logs, rows, runs (default: build/gpu); runs there are gone on with
  --results DIR         where MACHINE.jsonl grows (default: results beside this script; --small: nowhere)
  --only A,B            of digests,same,bench,paper (default: all)
  --cases A,B           of settled,pour,clumps,drum,fill (default: all)
  --sizes A,B           particles (default: 100000,1000000,3000000,10000000,30000000)
  --cpu-most N          the processor is timed up to so many (default: 1000000)
  --drum-most N         as the drum, whose whole bed is settled on the processor first (default: 100000)
  --bench-minutes M     no further timing is started after these (default: 25)
  --limit S             limit of each timing, s (default: 300)
  --until T             simulated time of the comparison, s (default: 0.3)
  --chunk-minutes M     wall time of a chunk of paper.json (default: 9; seconds as 20s)
  --chunks N            chunks of this call (default: 1)
  --machine NAME        name of the file of results (default: processor and GPU)
  --small               tiny sizes, nothing recorded: does it all start?
  --dry                 tinier still, without the program of tests, for ctest
TEXT
}

fail() { echo "gpu_all.sh: $*" >&2; exit 2; }

build=$root/build/release unpacked="" pack="" device=cuda out="" results=$here/results only=digests,same,bench,paper
cases=settled,pour,clumps,drum,fill sizes=100000,1000000,3000000,10000000,30000000 cpu_most=1000000 drum_most=100000
bench_minutes=25 limit=300 until=0.3 chunk=9m chunks=1 machine="" small="" dry=""
[[ ! -f $root/gpu-pack ]] || unpacked=$root
while [[ $# -gt 0 ]]; do
  case $1 in
    --help) usage; exit 0 ;;
    --small) small=1; shift; continue ;;
    --dry) small=1 dry=1; shift; continue ;;
    --build | --unpacked | --pack | --device | --out | --results | --only | --cases | --sizes | --cpu-most | --drum-most | \
      --bench-minutes | --limit | --until | --chunk-minutes | --chunks | --machine) ;;
    *) fail "$1: not known; --help lists the options" ;;
  esac
  [[ $# -ge 2 ]] || fail "$1: needs a value"
  case $1 in
    --build) build=$2 unpacked="" ;;
    --unpacked) unpacked=$2 ;;
    --pack) pack=$2 ;;
    --device) device=$2 ;;
    --out) out=$2 ;;
    --results) results=$2 ;;
    --only) only=$2 ;;
    --cases) cases=$2 ;;
    --sizes) sizes=$2 ;;
    --cpu-most) cpu_most=$2 ;;
    --drum-most) drum_most=$2 ;;
    --bench-minutes) bench_minutes=$2 ;;
    --limit) limit=$2 ;;
    --until) until=$2 ;;
    --chunk-minutes) chunk=$2; [[ $2 == *s ]] || chunk=$2m ;;
    --chunks) chunks=$2 ;;
    --machine) machine=$2 ;;
  esac
  shift 2
done

# --- packing -------------------------------------------------------------------------------------------------------------

# The C library belongs to the system and stays out; the C++ runtime goes apart, for a system whose own is older.
pack_build() {
  local file library target=$1 name=calx-gpu
  build=$(cd "$build" && pwd) || fail "$build: no such folder"
  [[ -x $build/bin/calx ]] || fail "$build/bin/calx: not built; ninja -C $build calx plugins/all test_scenes_devices"
  folder=$(mktemp -d) || exit 1
  trap 'rm -rf "$folder"' EXIT
  mkdir -p "$folder/$name"/{bin,lib,lib-cxx,plugins,tests/bench,tests/compute}
  cp "$build/bin/calx" "$folder/$name/bin/"
  if [[ -x $build/bin/test_scenes_devices ]]; then
    cp "$build/bin/test_scenes_devices" "$folder/$name/bin/"
  else
    echo "gpu_all.sh: no bin/test_scenes_devices in $build: the pack is without it" >&2
  fi
  cp "$build"/plugins/*.so "$build"/plugins/*.plugin.json "$folder/$name/plugins/"
  for file in "$build"/tests/compute/libcalx_stand_in_*.so; do
    [[ ! -f $file ]] || cp "$file" "$folder/$name/tests/compute/"
  done
  cp -r "$root/examples" "$folder/$name/"
  cp "$here"/{gpu_all.sh,gpu_rows.py,machine.py} "$folder/$name/tests/bench/"
  for file in "$folder/$name"/bin/* "$folder/$name"/plugins/*.so; do ldd "$file"; done | awk '$3 ~ /^\// {print $3}' | sort -u |
    while read -r library; do
      case ${library##*/} in
        libc.so.* | libm.so.* | libpthread.so.* | libdl.so.* | librt.so.* | libresolv.so.* | ld-linux*) ;;
        libstdc++.so.* | libgcc_s.so.*) cp -L "$library" "$folder/$name/lib-cxx/" ;;
        *) cp -L "$library" "$folder/$name/lib/" ;;
      esac
    done
  # Programs of tests look for plugins and keep compiled modules in the build tree by its full path.
  echo "$build" >"$folder/$name/gpu-pack"
  strip --strip-unneeded "$folder/$name"/bin/* 2>/dev/null || true
  tar -C "$folder" -czf "$target" "$name" || exit 1
  echo "$target: $(du -h "$target" | cut -f1), unpacks to $name/; then $name/tests/bench/gpu_all.sh" >&2
}

for word in ${only//,/ }; do
  [[ " digests same bench paper " == *" $word "* ]] || fail "--only $word: digests, same, bench or paper"
done
for word in ${cases//,/ }; do
  [[ " settled pour clumps drum fill " == *" $word "* ]] || fail "--cases $word: settled, pour, clumps, drum or fill"
done

if [[ -n $pack ]]; then pack_build "$pack"; exit; fi

# --- what runs -----------------------------------------------------------------------------------------------------------

# Chooses libraries of the pack: only those the system lacks, so that compilers started from here keep their own; else all;
# else with the C++ runtime, too.
choose_libraries() {
  local file have
  have=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null)
  mkdir -p "$build/lib-missing"
  for file in "$build"/lib/*; do
    [[ $have == *"${file##*/} "* ]] || ln -sf "$file" "$build/lib-missing/"
  done
  for have in "" "$build/lib-missing" "$build/lib" "$build/lib:$build/lib-cxx"; do
    if LD_LIBRARY_PATH=$have${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} "$build/bin/calx" --version >/dev/null 2>&1; then
      [[ -z $have ]] || export LD_LIBRARY_PATH=$have${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
      return
    fi
  done
  LD_LIBRARY_PATH=$build/lib:$build/lib-cxx "$build/bin/calx" --version
  fail "$build/bin/calx does not start here, with the libraries of the pack or without"
}

if [[ -n $unpacked ]]; then
  build=$(cd "$unpacked" && pwd) || fail "$unpacked: no such folder"
  root=$build
  [[ -x $build/bin/calx ]] || fail "$build/bin/calx: not there; unpack what --pack wrote"
  choose_libraries
  packed_from=$(cat "$build/gpu-pack") || fail "$build/gpu-pack: not there; unpack what --pack wrote"
  if [[ ! -e $packed_from ]]; then
    mkdir -p "$(dirname "$packed_from")" && ln -s "$build" "$packed_from"
  fi
fi
build=$(cd "$build" && pwd) || exit 2
calx=$build/bin/calx
[[ -x $calx ]] || fail "$calx: not built"
out=${out:-$root/build/gpu}
mkdir -p "$out/logs" || exit 2
out=$(cd "$out" && pwd)
python=$(command -v python3) || fail "python3 is needed for rows and tables"
cores=$(nproc)
if [[ -n $small ]]; then
  results="" sizes=1000,3000 cpu_most=3000 drum_most=1000 until=0.02 limit=60 chunk=${dry:+1.5s} chunks=2
  chunk=${chunk:-8s}
  [[ -z $dry ]] || sizes=300 cpu_most=300 drum_most=400 until=0.0004 cases=settled,drum
fi
# A module is compiled once for all parts; CALX_CACHE of the caller stays.
export CALX_CACHE=${CALX_CACHE:-$out/cache}
kind=${device%%:*}
if [[ -z $machine ]]; then machine=$("$python" "$here/gpu_rows.py" machine) || machine=unknown; fi
declare -a verdicts=()
failed=0

# verdict WHAT PASSED|FAILED|skipped TEXT
verdict() {
  verdicts+=("$(printf '%-34s %-8s %s' "$1" "$2" "$3")")
  printf '%s  %s\n' "$(date -u +%H:%M:%S)" "${verdicts[-1]}" >&2
  [[ $2 != FAILED ]] || failed=1
}

# step NAME SECONDS COMMAND...: both streams to logs/NAME.log; the exit code of the command, 124 at the limit.
step() {
  local name=$1 seconds=$2
  shift 2
  timeout --kill-after=20 "$seconds" "$@" >"$out/logs/$name.log" 2>&1 </dev/null
}

# Whether every command of a step went well; the last line of its log otherwise.
judge() {
  local name=$1 rc=$2 text
  if [[ $rc -eq 0 ]]; then verdict "$name" passed "${3:-}"; return; fi
  text=$(grep -v '^[[:space:]]*$' "$out/logs/$name.log" | tail -n 1 | cut -c1-200)
  [[ $rc -ne 124 ]] || text="over its limit; $text"
  verdict "$name" FAILED "exit code $rc: $text"
  return 1
}

wanted() { [[ ,$only, == *,$1,* ]]; }
row() { "$python" "$here/gpu_rows.py" row --out "$out" --results "$results" --machine "$machine" "$@"; }

# --- 1: devices, and the tests that compare every bit of whole scenes -----------------------------------------------------

digests() {
  step device 120 "$calx" check "$root/examples/canister_fill/first_fill.json" --device "$device"
  judge device $? "$(grep -iE '^ *device' "$out/logs/device.log" | head -n 1 | cut -c1-150)"
  if [[ $kind == cuda ]]; then
    step nvidia-smi 60 nvidia-smi
    judge nvidia-smi $?
  fi
  if [[ -n $dry ]]; then return; fi
  if [[ ! -x $build/bin/test_scenes_devices ]]; then
    verdict digests FAILED "no $build/bin/test_scenes_devices"
    return
  fi
  if [[ -n $small ]]; then
    step digests 200 "$build/bin/test_scenes_devices" --test-case='*frictional spheres*'
  elif [[ $kind == cuda ]]; then
    step digests 590 env CALX_TEST_CUDA=real "$build/bin/test_scenes_devices" --duration=true
  else
    step digests 590 "$build/bin/test_scenes_devices" --duration=true
  fi
  judge digests $? "$(grep -F 'assertions:' "$out/logs/digests.log" | tail -n 1)"
}

# --- 2: the same run on the processor and on the device -------------------------------------------------------------------

same() {
  local where case=$root/examples/canister_fill/first_fill.json rc=0
  for where in cpu "$device"; do
    step "same-${where//:/-}" 300 "$calx" run "$case" --until "$until" --device "$where" -o "$out/same/${where//:/-}" \
      --overwrite --no-report --quiet
    judge "same-${where//:/-}" $? || rc=1
  done
  if [[ $rc -ne 0 ]]; then verdict same FAILED "a run is missing"; return; fi
  step same 120 "$python" "$here/gpu_rows.py" same "$out/same/cpu" "$out/same/${device//:/-}" --device "$kind"
  judge same $? "$(tail -n 1 "$out/logs/same.log")"
}

# --- 3: timed scenes -------------------------------------------------------------------------------------------------------

# A start that all devices share: a settled tile, or the whole drum.
make_start() {
  local case=$1 size=$2 words=(--device cpu --threads "$cores" --steps 1 --warm-up 0)
  [[ -z $small ]] || words+=(--settle "$([[ -n $dry ]] && echo 0.002 || echo 0.02)")
  if [[ $case == drum ]]; then
    start=$out/starts/drum-$size
    [[ ! -f $start/case.json ]] || return 0
    words+=(--particles "$size" --save-start "$start")
  else
    start=$out/starts/${case/pour/settled}.csv
    [[ ! -f $start ]] || return 0
    words+=(--particles "$([[ -n $small ]] && echo 300 || echo 10000)" --save "$start")
    [[ $case != pour ]] || case=settled
  fi
  mkdir -p "$out/starts"
  step "start-$case-$size" "$limit" "$calx" bench "$case" "${words[@]}"
  judge "start-$case-$size" $? || { rm -rf "$start"; return 1; }
}

# time_case LABEL CASE WHERE SIZE WORDS...
time_case() {
  local label=$1 case=$2 where=$3 size=$4 threads=$cores warm_up=20 steps=100 name rc
  shift 4
  if [[ $SECONDS -gt $bench_end ]]; then verdict "$label $where" skipped "after --bench-minutes"; return; fi
  if [[ $size -le 200000 ]]; then warm_up=200 steps=1000; elif [[ $size -le 2000000 ]]; then warm_up=50 steps=300; fi
  [[ -z $small ]] || warm_up=2 steps=10
  [[ $where == cpu ]] || threads=1
  name="bench-${label// /-}-${where//:/-}"
  step "$name" "$limit" "$calx" bench "$case" --json --device "$where" --threads "$threads" --steps "$steps" \
    --warm-up "$warm_up" "$@"
  rc=$?
  if [[ $rc -eq 0 ]]; then
    row --log "$out/logs/$name.log" --case "$label" --device "$where" --warm-up "$warm_up" >"$out/logs/$name.row" 2>&1
    rc=$?
    [[ $rc -eq 0 ]] || cat "$out/logs/$name.row" >>"$out/logs/$name.log"
  fi
  judge "$name" "$rc" "$(cat "$out/logs/$name.row" 2>/dev/null)"
}

bench() {
  local case where size start first=1
  bench_end=$((SECONDS + 60 * bench_minutes))
  # Small sizes of all cases first: what the time runs out on are the largest.
  for size in ${sizes//,/ }; do
    for case in settled pour clumps drum; do
      [[ ,$cases, == *,$case,* ]] || continue
      if [[ $case == drum && $size -gt $drum_most ]]; then verdict "drum $size" skipped "over --drum-most"; continue; fi
      make_start "$case" "$size" || continue
      for where in cpu "$device"; do
        if [[ $where == cpu && $size -gt $cpu_most ]]; then continue; fi
        if [[ $case == drum ]]; then time_case "drum $size" drum "$where" "$size" --start "$start"
        else time_case "$case $size" "$case" "$where" "$size" --start "$start" --particles "$size"; fi
      done
    done
    if [[ -n $first && ,$cases, == *,fill,* ]]; then
      first=""
      for where in cpu "$device"; do
        time_case "fill first_fill" fill "$where" 10000 --case "$root/examples/canister_fill/first_fill.json" \
          --at "$([[ -n $small ]] && echo 0.0002 || echo 0.3)"
        [[ -n $small ]] || time_case "fill paper" fill "$where" 100000 --case "$root/examples/canister_fill/paper.json"
      done
    fi
  done
  "$python" "$here/gpu_rows.py" table --out "$out" | tee "$out/table.md"
}

# --- 4: the published process in chunks ------------------------------------------------------------------------------------

# timeout --foreground: only calx gets the signal, and once; a second one would end it without a checkpoint.
paper() {
  local k case=$root/examples/canister_fill/paper.json folder=$out/paper words rc name
  [[ -z $small ]] || case=$root/examples/canister_fill/first_fill.json
  for ((k = 1; k <= chunks; ++k)); do
    words=(--overwrite)
    [[ ! -f $folder/checkpoint.h5 && ! -f $folder/checkpoint.previous.h5 ]] || words=(--resume)
    name=paper-$(date -u +%Y%m%d-%H%M%S)-$k
    timeout --foreground --preserve-status --signal=INT --kill-after=90 "$chunk" "$calx" run "$case" --device "$device" \
      -o "$folder" --no-report --json "${words[@]}" >"$out/logs/$name.log" 2>&1 </dev/null
    rc=$?
    # 130: interrupted at its time, with a checkpoint.
    if [[ $rc -ne 0 && $rc -ne 130 ]]; then judge "$name" "$rc"; return; fi
    row --run "$folder" --case paper --device "$device" >"$out/logs/$name.row" 2>&1 || rc=1
    if [[ $rc -eq 1 ]]; then cp "$out/logs/$name.row" "$out/logs/$name.log"; judge "$name" 1; return; fi
    judge "$name" 0 "$(cat "$out/logs/$name.row")"
    [[ $rc -eq 130 ]] || break
  done
  step report 120 "$calx" report "$folder"
  judge report $?
}

SECONDS=0
if wanted digests; then digests; fi
if wanted same; then same; fi
if wanted bench; then bench; fi
if wanted paper; then paper; fi
{
  echo
  echo "$machine, $device, $SECONDS s${small:+, a check only: these times mean nothing}"
  printf '%s\n' "${verdicts[@]}"
} | tee "$out/verdicts.txt"
exit "$failed"
