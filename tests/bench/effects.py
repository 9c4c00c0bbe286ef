"""effects.py: what mixed precision or rest changes in figures, beside what another seed changes; effects calls it.

Each scene (effects_cases/SCENE.json; figures in effects_scenes.py) runs with several seeds, each without and with the feature
from the same start. Ways of grains that collide part within milliseconds, so the two runs of a seed differ as two seeds do and
the error of the mean difference comes from the scatter of both sides ("unpaired", Welch); only the scenes in PAIRED, whose
figures follow the start, are compared seed by seed. The scene decides, not the result. "differs" is a mean difference outside
the interval of LEVEL around 0 by Student's t: one row in a hundred does so by chance. "seen from" is half that interval:
less would not show. Each run is a line in results/effects.jsonl; the same run of the same program is taken from there.
"""
import argparse
import concurrent.futures
import datetime
import hashlib
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

import effects_scenes
from effects_plot import plot

HERE = pathlib.Path(__file__).resolve().parent
LEVEL = 0.99
PAIRED = {"gas"}
SCENES = {"precision": ["gas", "bed", "hopper", "pile", "drum", "silo", "canister"],
          "rest": ["bed", "hopper", "pile", "silo", "canister"]}


def student(freedom, level=LEVEL):
    """t with which |T| <= t has the probability level, by Simpson's rule over x = t / sqrt(freedom) = tan(angle)."""
    def below(t):
        end, n = math.atan(t / math.sqrt(freedom)), 100
        h = end / n
        weights = [1, *([4, 2] * (n // 2))[:n - 1], 1]
        area = h / 3 * sum(w * math.cos(k * h) ** (freedom - 1) for k, w in enumerate(weights))
        scale = math.gamma((freedom + 1) / 2) / math.gamma(freedom / 2) / math.sqrt(math.pi)
        return 2 * scale * area

    low, high = 0.0, 1.0
    while below(high) < level and high < 1e6:
        high *= 2
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if below(middle) < level else (low, middle)
    return 0.5 * (low + high)


def compare(off, on, paired):
    """Means, scatter of the seeds, difference on - off, its standard error and verdict."""
    n = len(off)
    row = {"seeds": n, "off": statistics.mean(off), "on": statistics.mean(on), "sd_off": statistics.stdev(off),
           "sd_on": statistics.stdev(on), "paired": paired}
    row["difference"] = row["on"] - row["off"]
    if paired:
        row["error"], freedom = statistics.stdev([b - a for a, b in zip(off, on)]) / math.sqrt(n), n - 1
    else:
        a, b = row["sd_off"] ** 2 / n, row["sd_on"] ** 2 / n
        row["error"] = math.sqrt(a + b)
        freedom = (a + b) ** 2 * (n - 1) / (a * a + b * b) if a + b > 0 else 1
    # Figures of the files have nine digits.
    row["limit"] = student(freedom) * row["error"] + 1e-8 * abs(row["off"])
    row["verdict"] = "differs" if abs(row["difference"]) > row["limit"] else "within scatter"
    return row


def identity(options, scene, seed, feature):
    """What makes two runs the same. feature: empty for a run without."""
    digest = hashlib.sha256((options.cases / f"{scene}.json").read_bytes()).hexdigest()
    return {"scene": scene, "seed": seed, "feature": feature, "set": options.set, "program": options.version,
            "case_sha256": digest}


def recorded(options, key):
    """The line of such a run in the results, or None."""
    return next((line for line in options.known if all(line.get(name) == value for name, value in key.items())), None)


def simulate(options, scene, seed, feature):
    """One run, or the line of an equal one in the results."""
    case = options.cases / f"{scene}.json"
    changes = effects_scenes.FEATURES[feature] if feature else []
    key = identity(options, scene, seed, feature)
    line = recorded(options, key)
    if line:
        return line
    with tempfile.TemporaryDirectory(prefix="calx_effects_") as folder:
        out = pathlib.Path(folder) / "out"
        command = [options.calx, "run", case, "-o", out, "--seed", seed, "--threads", 1, "--no-report", "--quiet", *changes]
        for value in options.set:
            command += ["--set", value]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{' '.join(str(word) for word in command)}\n{(done.stdout + done.stderr)[-2000:]}")
        run = effects_scenes.Run(out)
        figures = {name: figure(run) for name, _, figure, _ in effects_scenes.SCENES[scene]}
        # JSON has no NaN.
        figures = {name: None if math.isnan(value) else value for name, value in figures.items()}
        line = {"time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), **key,
                "git": run.summary["provenance"]["git"], "particles": run.summary["mass"]["inserted_particles"],
                "steps": run.summary["steps"], "figures": figures}
        if feature == "rest":
            line["asleep"] = run.asleep()
    print(f"{scene}, seed {seed}, {feature or 'without'}: done", file=sys.stderr, flush=True)
    if not options.dry:
        options.results.parent.mkdir(exist_ok=True)
        with open(options.results, "a", encoding="ascii") as lines:
            lines.write(json.dumps(line) + "\n")
    return line


def number(value):
    """Five digits, without an exponent where that is readable."""
    return f"{value:.4e}" if value and not 1e-4 <= abs(value) < 1e6 else f"{value:.5g}"


def table(rows, feature):
    """Markdown."""
    head = ["scene", "figure", "unit", "seeds", f"without {feature}" if feature == "rest" else "double", "seeds' sd",
            "with rest" if feature == "rest" else "mixed", "difference", "its error", "seen from", "verdict"]
    cells = [head, ["-" * len(word) for word in head]]
    for row in rows:
        cells.append([row["scene"], row["figure"], row["unit"], str(row["seeds"]),
                      *(number(row[key]) for key in ("off", "sd_off", "on", "difference", "error", "limit")), row["verdict"]])
    widths = [max(len(line[k]) for line in cells) for k in range(len(head))]
    return "\n".join("| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths)) + " |" for line in cells)


def sleepers(lines):
    """One line of text about the sleepers in the runs of a scene."""
    def mean(key):
        return 100 * statistics.mean(line["asleep"][key] for line in lines)
    first = lines[0]
    return (f"{first['scene']}: {first['particles']} particles, {first['steps']} steps; {mean('steps_skipped'):.0f} % of the "
            f"particle-steps slept through, most asleep at a time {mean('most'):.0f} %, at the end {mean('at_the_end'):.0f} %")


def measure(options, feature):
    """Runs what is missing; rows of the table, in order of scenes and figures, and the lines with the feature by scene."""
    scenes = [name for name in SCENES[feature] if name in (options.scenes or SCENES[feature])]
    seeds = {scene: [seed for seed in range(1, options.seeds + 1) if not options.recorded or
                     all(recorded(options, identity(options, scene, seed, kind)) for kind in ("", feature))]
             for scene in scenes}
    scenes = [scene for scene in scenes if len(seeds[scene]) >= 2]
    jobs = [(scene, seed, kind) for scene in scenes for seed in seeds[scene] for kind in ("", feature)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        lines = dict(zip(jobs, pool.map(lambda job: simulate(options, *job), jobs)))
    rows, with_feature = [], {}
    for scene in scenes:
        off, on = ([lines[scene, seed, kind] for seed in seeds[scene]] for kind in ("", feature))
        with_feature[scene] = on
        for name, unit, _, shown in effects_scenes.SCENES[scene]:
            if shown and feature not in shown:
                continue
            pairs = [(a["figures"][name], b["figures"][name]) for a, b in zip(off, on)]
            # A flank that the sensor finds too short to fit has no angle; such a pair is left out.
            pairs = [pair for pair in pairs if None not in pair]
            if len(pairs) >= 2:
                rows.append({"scene": scene, "figure": name, "unit": unit, **compare(*zip(*pairs), scene in PAIRED)})
            else:
                print(f"left out: {scene}, {name}: {len(pairs)} pairs of runs have it", file=sys.stderr)
    return rows, with_feature


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("feature", choices=sorted(SCENES))
    parser.add_argument("--calx", required=True, help="the program")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--scenes", nargs="+", choices=sorted(effects_scenes.SCENES), help="default: all of the feature")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time, each on one thread")
    parser.add_argument("--set", action="append", default=[], help="/json/pointer=value, of both sides")
    parser.add_argument("--cases", type=pathlib.Path, default=HERE / "effects_cases")
    parser.add_argument("--results", type=pathlib.Path, default=HERE / "results/effects.jsonl")
    parser.add_argument("--json", action="store_true", help="one JSON line a row instead of the table")
    parser.add_argument("--recorded", action="store_true",
                        help="run nothing: what the results hold of the program that wrote their last line, up to --seeds")
    parser.add_argument("--dry", action="store_true", help="record nothing, take nothing from earlier runs, draw nothing")
    options = parser.parse_args(words)
    if options.seeds < 2:
        parser.error("scatter needs at least two seeds")
    options.calx = str(pathlib.Path(options.calx).resolve())
    # Other bits of the program and its plugins may give other figures.
    parts = [pathlib.Path(options.calx), *sorted((pathlib.Path(options.calx).parent.parent / "plugins").glob("*.so"))]
    options.version = hashlib.sha256(b"".join(part.read_bytes() for part in parts)).hexdigest()[:16]
    options.known = []
    if not options.dry and options.results.exists():
        options.known = [json.loads(line) for line in options.results.read_text(encoding="ascii").splitlines()]
    if options.recorded and options.known:
        options.version = options.known[-1]["program"]
    rows, with_feature = measure(options, options.feature)
    if options.json:
        print("\n".join(json.dumps(row) for row in rows))
        return
    print(table(rows, options.feature))
    differ = sum(row["verdict"] == "differs" for row in rows)
    print(f"\n{differ} of {len(rows)} rows differ, {(1 - LEVEL) * len(rows):.1f} would by chance")
    if options.feature == "rest":
        for lines in with_feature.values():
            print(sleepers(lines))
    if not options.dry:
        picture = options.results.parent / f"effects_{options.feature}.svg"
        picture.write_text(plot(rows, options.feature), encoding="ascii")
        print(f"drawn in {picture}")


if __name__ == "__main__":
    main()
