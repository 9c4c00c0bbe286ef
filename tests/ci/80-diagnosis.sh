#!/usr/bin/env bash
# The studies of examples/diagnosis: the planted leak is found from scratch, confirmed by runs with new seeds, and its extended
# case runs; the publication's numbers name no cause, and contradict the one it claims.
source "$(dirname "$0")/common.sh"
for plugin in hertz-mindlin plane box cylinder rotary-valve rotary-housing open-close reciprocate centroid rotor-leak \
  rolling-resistance; do
  grep -q "\"calx.$plugin\"" plugins/*/*.plugin.json.in || { echo "left out: there is no plugin calx.$plugin"; exit 0; }
done
for study in leaky_rotor paper; do
  ./calx.sh diagnose examples/diagnosis/$study/study.json -o build/diagnosis/$study --overwrite || exit 1
  [[ -s build/diagnosis/$study/report.html ]] || { echo "FAIL $study: no report.html"; exit 1; }
done
python3 - <<'END' || exit 1
import json
leak = json.load(open("build/diagnosis/leaky_rotor/diagnosis.json"))
cause = leak["causes"][0]
gap = cause["parameters"][0]
assert leak["verdict"] == "named" and [c["id"] for c in leak["causes"] if c["named"]] == ["calx.rotor-leak"], leak["sentence"]
# make_data.py planted 2.6 mm; three standard deviations.
assert abs(gap["value"] - 0.0026) < 3 * gap["sd"], gap
assert leak["confirmation"]["passed"] and leak["gain"]["held_out_log_score"] > 3, leak["confirmation"]
assert leak["runs"]["used"] <= leak["runs"]["budget"], leak["runs"]
paper = json.load(open("build/diagnosis/paper/diagnosis.json"))
residue = next(o for o in paper["observables"] if o["kind"] == "residue")
assert paper["verdict"] in ("none", "ambiguous") and paper["extension"] is None, paper["sentence"]
assert residue["signed_error"] < -0.5, residue  # the simulation is low, whatever the text says
assert paper["claims"][0]["verdict"] == "contradicted" and paper["next"], paper["claims"]
print(leak["sentence"], paper["sentence"], paper["claims"][0]["sentence"], sep="\n")
END
./calx.sh run build/diagnosis/leaky_rotor/extension/fast.json -o build/diagnosis/extended --overwrite --quiet
