"""Makes the "measured" data of study.json: runs of valve.json with a leaking rotor, at parameters, a time step and seeds
that the diagnosis does not know, as five repeats with the noise of a balance. Usage: python3 make_data.py CALX [GAP_M];
writes fast.csv and slow.csv beside this file. The committed files were made with a gap of 2.6 mm; 0 makes a line that
does not leak."""
import csv
import json
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SEEDS = range(81001, 81006)
STROKES = {"fast": 0.1, "slow": 0.14}  # s
TIMES = {"fast": [0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.7, 0.8, 0.88],
         "slow": [0.25, 0.32, 0.4, 0.48, 0.56, 0.64, 0.72, 0.8, 0.88]}
BALANCE = 0.05  # g, standard deviation


def run(calx, seed, gap, stroke, folder):
    values = {"/seed": seed, "/output": {"frames_every": 0}, "/time/step": 1.8e-5, "/materials/powder/density": 2010,
              "/motions/rotor turn/parameters/stroke": stroke,
              "/contacts/0/parameters/friction": 0.53, "/contacts/1/parameters/friction": 0.33,
              "/contacts/0/parameters/restitution": 0.45, "/contacts/1/parameters/restitution": 0.45,
              "/effects": [{"effect": "calx.rotor-leak", "parameters": {"gap": gap}}]}
    sets = [word for key, value in values.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    subprocess.run([calx, "run", str(HERE / "valve.json"), "-o", folder, "--threads", "1", "--quiet", "--no-report",
                    "--overwrite", *sets], check=True)


def mass(folder, sensor, when):
    with open(pathlib.Path(folder, "series", sensor + ".csv"), encoding="ascii") as file:
        rows = [(float(r["time_s"]), 1000 * float(r["mass_kg"])) for r in csv.DictReader(file)]
    k = next(k for k, row in enumerate(rows) if row[0] >= when)
    share = (when - rows[k - 1][0]) / (rows[k][0] - rows[k - 1][0])
    return rows[k - 1][1] + share * (rows[k][1] - rows[k - 1][1])


def main():
    calx = sys.argv[1]
    gap = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0026
    for speed, stroke in STROKES.items():
        noise = random.Random(speed)
        lines = ["run,time_s,hopper_g,canister_g"]
        for repeat, seed in enumerate(SEEDS, 1):
            with tempfile.TemporaryDirectory() as folder:
                run(calx, seed, gap, stroke, folder)
                for t in TIMES[speed]:
                    shown = [mass(folder, s, t) + noise.gauss(0, BALANCE) for s in ("throat", "cell")]
                    lines.append(f"{repeat},{t},{shown[0]:.3f},{shown[1]:.3f}")
        (HERE / f"{speed}.csv").write_text("\n".join(lines) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
