"""What a first fill must show, read from the run's folder: first_fill.py FOLDER."""
import csv
import json
import pathlib
import sys

folder = pathlib.Path(sys.argv[1])
summary = json.loads((folder / "summary.json").read_text())
mass, energy = summary["mass"], summary["energy"]
with open(folder / "series" / "dispensed per cycle.csv", encoding="ascii") as file:
    cycles = {float(row["cycle_1"]): float(row["mass_kg"]) for row in csv.DictReader(file) if float(row["cycle_1"]) > 0}
with open(folder / "series" / "mass ledger.csv", encoding="ascii") as file:
    last = list(csv.DictReader(file))[-1]
located = sum(float(last[f"in_{name}_1"]) for name in ("hopper", "throat", "rotor", "piping", "canister"))

claims = {
    "every particle that came is there": mass["inserted_particles"] == mass["inside_particles"] and mass["closes"],
    "every particle is in a place where powder may be": located == mass["inserted_particles"],
    "the mass delivered is the mass asked for within one grain": abs(mass["delivered"] - mass["requested"]) < 2.3e-5,
    "energy remainder below 1 % of the work done": energy["remainder_share"] < 0.01,
    "three cycles, each dispensing at least 20 g": len(cycles) == 3 and min(cycles.values()) > 0.02,
    "the canister holds what the cycles dispensed or more": mass["regions"]["canister"] >= sum(cycles.values()) - 1e-9,
    "no grain went deeper than its radius into another or a wall": summary["largest_overlap_share"] < 1,
    "powder, valves and walls came through plugins": len(summary["provenance"]["plugins"]) >= 9,
}
for claim, holds in claims.items():
    print("ok  " if holds else "FAIL", claim)
print(f"cycles {[round(1000 * m, 2) for m in cycles.values()]} g, canister {1000 * mass['regions']['canister']:.2f} g, "
      f"energy remainder {100 * energy['remainder_share']:.3f} %, largest overlap {summary['largest_overlap_share']:.3f} R, "
      f"{summary['wall_seconds']:.0f} s")
sys.exit(not all(claims.values()))
