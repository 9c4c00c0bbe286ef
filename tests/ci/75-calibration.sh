#!/usr/bin/env bash
# The study of examples/calibration from scratch, with real runs: it finds the parameters that its data were made at.
source "$(dirname "$0")/common.sh"
for plugin in hertz-mindlin plane; do
  grep -q "\"calx.$plugin\"" plugins/*/*.plugin.json.in || { echo "left out: there is no plugin calx.$plugin"; exit 0; }
done
out=build/examples/calibration
./calx.sh calibrate examples/calibration/study.json -o "$out" --overwrite --quiet
[[ -s $out/report.html ]] || { echo "no report.html"; exit 1; }
python3 examples/calibration/check.py "$out"
# Once more costs nothing.
./calx.sh calibrate examples/calibration/study.json -o "$out" --quiet >/dev/null
grep -q '"computed": 0' "$out/cost.json"
