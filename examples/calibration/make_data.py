"""Makes the "measured" data of study.json: runs of slot_hopper.json at parameters and with seeds that the calibration does
not know, as five repeats of a laboratory. Usage: python3 make_data.py CALX [FRICTION ROLLING_FRICTION]; writes
discharge.csv, density.csv and rest.csv beside this file. The committed files were made with 0.45 and 0.15."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SEEDS = range(90001, 90006)
TIMES = [0.30, 0.40, 0.50, 0.60, 0.78]
FULL = 0.19  # s, just before the gate opens


def run(calx, seed, friction, rolling, folder):
    values = {"/seed": seed, "/output": {"frames_every": 0}}
    for contact in (0, 1):
        values[f"/contacts/{contact}/parameters/friction"] = friction
        values[f"/contacts/{contact}/parameters/rolling_friction"] = rolling
    sets = [word for key, value in values.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    subprocess.run([calx, "run", str(HERE / "slot_hopper.json"), "-o", folder, "--threads", "1", "--quiet", "--no-report",
                    "--overwrite", *sets], check=True)


def column(folder, sensor, name):
    with open(pathlib.Path(folder, "series", sensor + ".csv"), encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    return [float(r["time_s"]) for r in rows], [float(r[name]) for r in rows]


def at(series, when):
    times, values = series
    k = next(k for k, t in enumerate(times) if t >= when)
    share = (when - times[k - 1]) / (times[k] - times[k - 1])
    return values[k - 1] + share * (values[k] - values[k - 1])


def main():
    calx = sys.argv[1]
    friction, rolling = (float(v) for v in sys.argv[2:4]) if len(sys.argv) > 3 else (0.45, 0.15)
    discharge, density, rest = [], [], []
    for repeat, seed in enumerate(SEEDS, 1):
        with tempfile.TemporaryDirectory() as folder:
            run(calx, seed, friction, rolling, folder)
            mass = column(folder, "in hopper", "mass_kg")
            discharge += [(repeat, t, f"{1000 * at(mass, t):.3f}") for t in TIMES]
            density.append((repeat, FULL, f"{at(column(folder, 'bed', 'density_kg_m3'), FULL) / 1000:.4f}"))
            rest.append((repeat, f"{1000 * column(folder, 'in hopper', 'centre_x_m')[1][-1]:.2f}"))
    for name, header, rows in (("discharge", "run,time_s,mass_g", discharge), ("density", "run,time_s,density_g_cm3", density),
                               ("rest", "run,centre_mm", rest)):
        (HERE / f"{name}.csv").write_text("\n".join([header, *(",".join(map(str, r)) for r in rows)]) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
