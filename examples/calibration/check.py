"""Are the parameters that make_data.py hid inside the 90 % intervals? Usage: python3 check.py FOLDER_OF_THE_CALIBRATION"""
import json
import pathlib
import sys

HIDDEN = {"friction": 0.45, "rolling friction": 0.15}

status = 0
for p in json.loads(pathlib.Path(sys.argv[1], "calibration.json").read_text(encoding="ascii"))["parameters"]:
    inside = p["q05"] <= HIDDEN[p["name"]] <= p["q95"]
    print(f"{p['name']}: {p['q05']:.3f} to {p['q95']:.3f}, hidden {HIDDEN[p['name']]}, "
          f"sd {p['identifiability']:.2f} of the prior's: {'inside' if inside else 'OUTSIDE'}")
    # An interval that says nothing would hold the value, too.
    status |= not inside or p["identifiability"] > 0.7
sys.exit(status)
