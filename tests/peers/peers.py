#!/usr/bin/env python3
"""peers.py: points that other codes and an experiment gave, run with Calx; results beside the source's own scatter.

  peers.py lift N        row N (from 1) of tests/data/wheat/cylinder_lift.csv
  peers.py column N      the same until the bed has settled: its bulk density alone, a sixteenth of the run
  peers.py liggghts N    the same column, from the same places, with LIGGGHTS on this machine
  peers.py discharge N   row N of tests/data/wheat/discharge.csv
  peers.py drum RPM      GranuDrum with MCC pellets (tests/data/granudrum), with the friction given
  peers.py penetration --start FILE, soft-drum --start FILE, full-drum --start FILE
                         set-ups of Dosta et al. from their own start files (dosta.py); their curves are not kept here, so
                         the row holds our figure alone; --end shortens the run
  peers.py all           every wheat point, one after the other
  peers.py table         results.jsonl as a table: ours, theirs, the error, their scatter and our seeds' scatter

Each run adds a line to results.jsonl with the command that made it. --step and --seed are kept in it; --step 8e-6 is what the
source used, 7 % of the Rayleigh time.
"""
import argparse
import csv
import datetime
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

import h5py
import numpy as np

import dosta
import evaluate
import wheat_fill

HERE = pathlib.Path(__file__).resolve().parent
DATA = HERE.parent / "data"
RESULTS = HERE / "results.jsonl"
SETTLED = 0.4  # s, when the cylinder is lifted or the orifice opened
START = ("penetration", "soft-drum", "full-drum")


def rows(path):
    with open(path, encoding="ascii") as lines:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


def frame(folder, time):
    """Columns x, y, z, r of the last frame at or before that time."""
    with h5py.File(folder / "particles.h5", "r") as f:
        spheres = f["particles/spheres"]
        k = int(np.searchsorted(spheres["position/time"][:], time + 1e-9)) - 1
        count = int(spheres["count/value"][k])
        xyz = spheres["position/value"][k, :count]
        return xyz[:, 0], xyz[:, 1], xyz[:, 2], spheres["radius/value"][k, :count].astype(float)


def run_case(options, case, changes, folder):
    command = [options.calx, "run", str(HERE / "cases" / case), "-o", str(folder), "--overwrite", "--quiet", "--threads",
               str(options.threads), "--seed", str(options.seed)]
    for pointer, value in changes.items():
        command += ["--set", f"{pointer}={value}"]
    subprocess.run(command, check=True)
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def wheat_changes(options, row, folder):
    start = folder.with_name(folder.name + "-start.csv").resolve()
    start.parent.mkdir(parents=True, exist_ok=True)
    wheat_fill.write(start, options.seed)
    at = "/contacts/0/parameters/"
    return {at + "friction": row["mu"], at + "rolling_friction": row["mu_r"], at + "restitution": row["restitution"],
            "/time/step": options.step,
            "/sources": json.dumps([{"name": "fill", "shape": "grain", "material": "wheat", "file": str(start)}])}


def density_figure(row, z, r, name="bulk_density_kg_m3"):
    return {"figure": name, "ours": evaluate.column_density(z, r, wheat_fill.DENSITY, np.pi * 0.04**2),
            "theirs": row["bulk_density_kg_m3"], "their_sd": 4.0}


def column_figure(row, folder):
    _, _, z, r = frame(folder, SETTLED)
    return density_figure(row, z, r)


def liggghts(options, number, folder):
    row = rows(DATA / "wheat" / "cylinder_lift.csv")[number - 1]
    folder.mkdir(parents=True, exist_ok=True)
    wheat_fill.write_liggghts(folder / "start.data", options.seed)
    variables = {"start": "start.data", "end": "end.txt", "friction": row["mu"], "rolling": row["mu_r"],
                 "restitution": row["restitution"], "step": options.step, "count": round(SETTLED / options.step)}
    command = ["liggghts", "-in", str(HERE / "cases" / "wheat_column.liggghts")]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    subprocess.run(command, check=True, cwd=folder, stdout=subprocess.DEVNULL)
    _, _, z, r = np.loadtxt(folder / "end.txt", skiprows=9).T
    summary = {"time_step": options.step, "particles": len(z), "provenance": {"git": "Debian liggghts"}}
    return [density_figure(row, z, r, "bulk_density_kg_m3 of LIGGGHTS here")], summary


def column(options, number, folder):
    row = rows(DATA / "wheat" / "cylinder_lift.csv")[number - 1]
    changes = {**wheat_changes(options, row, folder), "/time/end": SETTLED}
    summary = run_case(options, "wheat_lift.json", changes, folder)
    return [column_figure(row, folder)], summary


def lift(options, number, folder):
    row = rows(DATA / "wheat" / "cylinder_lift.csv")[number - 1]
    summary = run_case(options, "wheat_lift.json", wheat_changes(options, row, folder), folder)
    own = summary["sensors"]["angle of repose"]["last"]
    return [{"figure": "angle_deg", "ours": evaluate.pile_angle(*frame(folder, summary["time"])), "theirs": row["angle_deg"],
             "their_sd": row["angle_sd_deg"], "sensor": own["angle_deg"], "sensor_sd": own["sd_deg"]},
            column_figure(row, folder)], summary


def discharge(options, number, folder):
    row = rows(DATA / "wheat" / "discharge.csv")[number - 1]
    summary = run_case(options, "wheat_discharge.json", wheat_changes(options, row, folder), folder)
    with open(folder / "series" / "mass out.csv", encoding="ascii") as lines:
        table = list(csv.DictReader(lines))
    time, mass = (np.array([float(r[name]) for r in table]) for name in ("time_s", "mass_kg"))
    sensor = summary["sensors"]["discharge"]["last"]
    return [{"figure": "rate_g_s", "ours": 1e3 * evaluate.rate(time, mass), "theirs": row["rate_g_s"],
             "their_sd": row["rate_sd_g_s"], "sensor": 1e3 * sensor["rate_kg_s"],
             "beverloo": 1e3 * sensor["beverloo_kg_s"]}], summary


def surface_errors(ours, theirs, radius):
    """RMS distance along z over the columns both have, m, and the area between the curves inside sqrt(0.6) R, m2."""
    inside = (theirs[:, 0] >= ours[0].min()) & (theirs[:, 0] <= ours[0].max())
    difference = np.interp(theirs[inside, 0], *ours) - theirs[inside, 1]
    core = np.hypot(theirs[inside, 0], theirs[inside, 1]) < np.sqrt(0.6) * radius
    step = np.gradient(theirs[inside, 0])
    return float(np.sqrt(np.mean(difference**2))), float(np.sum(np.abs(difference * step)[core]))


def drum(options, rpm, folder):
    summary = run_case(options, "granudrum.json",
                       {"/contacts/0/parameters/friction": options.friction,
                        "/contacts/0/parameters/rolling_friction": options.rolling_friction,
                        "/sources/0/count": options.pellets, "/time/step": options.step,
                        "/motions/turn/parameters/duration": 25 * 60 / rpm,
                        "/events/steady/when/after/delay": options.spin_up,
                        "/time/end": 0.3 + options.spin_up + 0.3}, folder)
    last = summary["sensors"]["surface"]["last"]
    given = next(r for r in rows(DATA / "granudrum" / "free_surface_summary.csv") if r["rpm"] == rpm)
    curves = json.loads((folder / "fields.json").read_text(encoding="utf-8"))["curves"]
    curve = next(c for c in curves if c["name"] == "surface")
    photograph = rows(DATA / "granudrum" / "free_surface_15_45rpm.csv")
    table = np.array([[r["x_mm"], r["z_mm"]] for r in photograph if r["rpm"] == rpm])
    rms, area = surface_errors((np.array(curve["x"]), np.array(curve["y"])), table * 1e-3, 0.042)
    extra = {"their_sd": None, "rms_mm": 1e3 * rms, "area_mm2": 1e6 * area, "fill_ours": last["fill_1"],
             "fill_theirs": given["dark_area_fraction_r_lt_0.96R"]}
    return [{"figure": "near_angle_deg", "ours": last["angle_deg"], "theirs": given["angle_deg_absx_lt_12mm"], **extra},
            {"figure": "far_angle_deg", "ours": last["far_deg"], "theirs": given["angle_deg_absx_lt_25mm"], **extra}], summary


def start_file(options, kind, folder):
    """The figure at the end of a set-up of Dosta et al.: height of the ball, or grains in two quadrants of the drum."""
    case, _ = dosta.write_case(kind, options.start, folder.with_name(folder.name + "-case"))
    summary = run_case(options, case, {} if options.end is None else {"/time/end": options.end}, folder)
    if kind == "penetration":
        *_, z, r = frame(folder, summary["time"])
        found = {"ball_height_m": float(z[np.argmax(r)])}
    else:
        found = {f"{name.replace(' ', '_')}_1": summary["sensors"][name]["last"]["particles_1"]
                 for name in ("lower left", "upper right")}
    return [{"figure": name, "ours": value, "theirs": None, "their_sd": None, "at_s": summary["time"]}
            for name, value in found.items()], summary


def command_of(options, kind, number):
    """What repeats the run, without folders of the machine."""
    if kind in START:
        end = "" if options.end is None else f" --end {options.end:g}"
        return f"peers.py {kind} --start {pathlib.Path(options.start).name}{end}"
    words = f"peers.py {kind} {number} --seed {options.seed} --step {options.step:g}"
    if kind == "drum":
        words += f" --friction {options.friction} --rolling-friction {options.rolling_friction}"
        words += f" --pellets {options.pellets} --spin-up {options.spin_up:g}"
    return words


def one(options, kind, number):
    with tempfile.TemporaryDirectory() as scratch:
        words = [str(word) for word in (kind, number, f"seed{options.seed}") if word is not None]
        folder = pathlib.Path(options.keep or scratch) / "-".join(words)
        make = {"lift": lift, "column": column, "liggghts": liggghts, "discharge": discharge, "drum": drum}
        found, summary = start_file(options, kind, folder) if kind in START else make[kind](options, number, folder)
    for figure in found:
        line = {"time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
                "point": kind if kind in START else f"{'lift' if kind in ('column', 'liggghts') else kind} {number}", "seed": options.seed, "step": summary["time_step"],
                "particles": summary["particles"], "git": summary["provenance"]["git"],
                "command": command_of(options, kind, number), "note": options.note, **figure}
        if options.write:
            with open(RESULTS, "a", encoding="ascii") as out:
                out.write(json.dumps(line) + "\n")
        print(json.dumps(line), flush=True)


def setting(r):
    """Point of a result, with the friction, rolling friction and pellets of a drum, which are choices."""
    chosen = re.search(r"--friction (\S+) --rolling-friction (\S+) --pellets (\S+)", r["command"])
    return r["point"] + (", friction {}, rolling {}, {} pellets".format(*chosen.groups()) if chosen else "")


def table():
    """One line a setting and figure: mean over seeds and steps."""
    groups = {}
    for line in RESULTS.read_text(encoding="ascii").splitlines():
        r = json.loads(line)
        groups.setdefault((setting(r), r["figure"]), []).append(r)
    print("| point | figure | Calx | sd of our seeds (n) | source | sd of its seeds | difference |")
    print("|---|---|---|---|---|---|---|")
    for (point, figure), found in sorted(groups.items()):
        # A column is the beginning of a lift of the same seed, and no second one.
        ours = list({(r["seed"], r["step"]): r["ours"] for r in found}.values())
        mean, theirs, sd = statistics.mean(ours), found[0]["theirs"], found[0]["their_sd"]
        if theirs is None:
            print(f"| {point}, {found[0]['at_s']:g} s | {figure} | {mean:.4g} | - ({len(ours)}) | not kept here | - | - |")
            continue
        spread = f"{statistics.stdev(ours):.2f} ({len(ours)})" if len(ours) > 1 else f"- ({len(ours)})"
        share = "" if figure.endswith("_deg") else f" ({100 * (mean - theirs) / theirs:+.1f} %)"
        print(f"| {point} | {figure} | {mean:.2f} | {spread} | {theirs:.2f} | {'-' if sd is None else format(sd, '.2f')} "
              f"| {mean - theirs:+.2f}{share} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["lift", "column", "liggghts", "discharge", "drum", *START, "all", "table"])
    parser.add_argument("number", nargs="?", type=int)
    parser.add_argument("--calx", default=os.environ.get("CALX", str(HERE.parent.parent / "build/release/bin/calx")))
    parser.add_argument("--start", help="start file of penetration and drums")
    parser.add_argument("--end", type=float, help="s, of those")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--step", type=float, default=8e-6, help="s")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--keep", help="folder that keeps the runs")
    parser.add_argument("--note", default="")
    parser.add_argument("--friction", type=float, default=0.5, help="drum only")
    parser.add_argument("--rolling-friction", type=float, default=0.1, help="drum only")
    parser.add_argument("--pellets", type=int, default=30000, help="drum only")
    parser.add_argument("--spin-up", type=float, default=1.5, help="drum only, s; then 0.3 s are averaged")
    parser.add_argument("--dry", dest="write", action="store_false", help="print, do not add to results.jsonl")
    options = parser.parse_args()
    if options.kind == "table":
        return table()
    if options.kind == "all":
        for kind, name in (("lift", "cylinder_lift.csv"), ("discharge", "discharge.csv")):
            for number in range(1, len(rows(DATA / "wheat" / name)) + 1):
                one(options, kind, number)
        return None
    if options.kind in START:
        if options.start is None:
            parser.error(f"{options.kind} needs --start FILE")
        return one(options, options.kind, None)
    if options.number is None:
        parser.error(f"{options.kind} needs a number")
    return one(options, options.kind, options.number)


if __name__ == "__main__":
    main()
