#!/usr/bin/env python3
"""Blind studies of `calx diagnose` on real runs: makes worlds with a hidden cause, has them diagnosed, scores the verdicts.

tests/diagnosis/dem_tier/tier.py --keep DIR [--calx PROGRAM] [--studies N] [--only NAME ...] [--jobs N] [--seed N] [--budget N]

Makes DIR/NAME/public (case, study, data), DIR/NAME/sealed (truth), DIR/NAME/diagnosis and DIR/table.md. What is there already
is not made again, so that a run that was stopped goes on. The diagnosis sees the public folder alone."""
import argparse
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from hidden import STUDIES, world_of  # noqa: E402
from rigs import HERE, RIGS, load_case, put, read, run  # noqa: E402
from score import score, table  # noqa: E402

REPEATS = 4  # of each campaign


def heavy_tailed(rng):
    """Unit variance, tails of Student's t with 5 degrees of freedom."""
    return rng.gauss(0, 1) / rng.gammavariate(2.5, 0.4) ** 0.5 * (3 / 5) ** 0.5


def make_study(hidden, rig, budget):
    """study.json of the public folder: it holds nothing of what is hidden."""
    observables = []
    for k, reading in enumerate(rig.readings):
        for use in ("fit", "hold-out"):
            data = {"file": f"{use}_{k}.csv", "y": "value", "repeat": "run"}
            if reading.at:
                data["x"] = "place"
            o = {"name": reading.name + (", later" if use == "hold-out" else ""), "kind": reading.kind, "case": "rig",
                 "sensor": reading.sensor, "column": reading.column, "unit": reading.unit, "use": use, "measured": data}
            if reading.at:
                o["against"] = reading.against
            observables.append(o)
    return {"calx_study": 1, "title": f"Blind study on the {hidden.rig} rig", "cases": {"rig": {"case": "case.json"}},
            "parameters": rig.parameters, "observables": observables, "roles": rig.roles, "effects": rig.effects,
            "budget": {"runs": budget}, "assumptions": ["Simulated data of a hidden world."]}


def make(hidden, folder, seed, calx, budget):
    """Both folders of a study."""
    public, sealed = folder / "public", folder / "sealed"
    if (sealed / "truth.json").exists():
        return
    shutil.rmtree(public, ignore_errors=True)
    public.mkdir(parents=True)
    sealed.mkdir(parents=True, exist_ok=True)
    rig = RIGS[hidden.rig]
    base = load_case(HERE / "rigs" / f"{hidden.rig}.json")
    rng = random.Random(f"{seed} {hidden.name}")
    case, strengths, values = world_of(hidden, base, rng, rig.parameters)
    for p in rig.parameters:
        for pointer in p["set"]:
            put(case, pointer, values[p["name"]])
    if hidden.edit:
        hidden.edit(case, strengths[0])
    instrument = hidden.instrument(strengths[-1]) if hidden.instrument else None
    rows = {}
    for use in ("fit", "hold-out"):
        for repeat in range(1, REPEATS + 1):
            out = run(calx, case, sealed / "run", rng.randrange(10**6, 10**9))
            for k, reading in enumerate(rig.readings):
                faulty = instrument if reading.sensor == "cell" else None
                shown = [v + reading.noise * heavy_tailed(rng) for v in read(out, reading, faulty)]
                for x, v in zip(reading.at or ("",), shown):
                    rows.setdefault((use, k), []).append(f"{repeat},{x},{v:.5g}" if reading.at else f"{repeat},{v:.5g}")
    for (use, k), lines in rows.items():
        head = "run,place,value" if rig.readings[k].at else "run,value"
        (public / f"{use}_{k}.csv").write_text("\n".join([head, *lines]) + "\n", encoding="ascii")
    (public / "case.json").write_text(json.dumps(base, indent=1), encoding="ascii")
    (public / "study.json").write_text(json.dumps(make_study(hidden, rig, budget), indent=1), encoding="ascii")
    shutil.rmtree(sealed / "run")
    truth = {"name": hidden.name, "rig": hidden.rig, "kind": hidden.kind, "truth": hidden.truth, "strengths": strengths,
             "form": hidden.form, "parameters": values, "time_step": case["time"]["step"], "seed": seed}
    text = json.dumps(truth, indent=1)
    (sealed / "truth.json").write_text(text, encoding="ascii")
    # Published before the diagnosis starts, so that the truth cannot be fitted to the verdict.
    (folder / "truth.sha256").write_text(hashlib.sha256(text.encode()).hexdigest() + "\n", encoding="ascii")


def solve(folder, calx, jobs):
    """The diagnosis of the public folder; a killed one goes on with the runs it has."""
    out = folder / "diagnosis"
    if (out / "diagnosis.json").exists():
        return
    start = time.monotonic()
    done = subprocess.run([calx, "diagnose", folder / "public" / "study.json", "-o", out, "--jobs", str(jobs), "--quiet"],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    (folder / "said.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode:
        raise SystemExit(f"{folder}: calx diagnose failed with {done.returncode}:\n{done.stderr}")
    print(f"  {time.monotonic() - start:.0f} s of wall time", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("dem_tier.out"))
    parser.add_argument("--calx", default=os.environ.get("CALX", str(HERE.parents[2] / "build/release/bin/calx")))
    parser.add_argument("--studies", type=int, default=len(STUDIES))
    parser.add_argument("--only", nargs="+", metavar="NAME", choices=[s.name for s in STUDIES])
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=500001)
    parser.add_argument("--budget", type=int, default=100)
    options = parser.parse_args()
    chosen = [s for s in STUDIES if not options.only or s.name in options.only][:options.studies]
    scores = []
    for hidden in chosen:
        folder = options.keep.resolve() / hidden.name
        print(f"{hidden.name} ({hidden.rig})", flush=True)
        make(hidden, folder, options.seed, options.calx, options.budget)
        solve(folder, options.calx, options.jobs)
        scores.append(score(folder))
        print("  " + scores[-1]["line"], flush=True)
    text = table(scores)
    (options.keep / "table.md").write_text(text, encoding="ascii")
    print(text)


if __name__ == "__main__":
    main()
