"""peers.py: particle-steps per second of Calx and its peers on the same start, in interleaved rounds; against_peers calls it.

First the gate (gate.py): a code whose impacts differ from Calx's by more than its limit is not timed. Then every round runs
all codes once, in an order that rotates, so that slow drift of the machine meets all alike; ratios are taken within a round.
Each result is a line in results/MACHINE.jsonl. --table measures what the goals name and prints goal beside measurement, then
the profile of each case.
"""
import argparse
import datetime
import json
import pathlib
import shutil
import statistics
import sys
import tempfile

import codes
import gate
import goals
import starts
from machine import machine_name, wait_until_quiet

HERE = pathlib.Path(__file__).resolve().parent
PARTICLES = {"settled": 100000, "pour": 100000, "sizes": 100000, "clumps": 10000, "chute": 32000}
STEPS = [(20000, 500, 2000), (200000, 100, 300), (1e300, 20, 100)]  # up to so many particles: warm-up, timed


def record(options, result):
    if options.dry:
        return
    out = HERE / "results" / f"{options.machine}.jsonl"
    out.parent.mkdir(exist_ok=True)
    with open(out, "a", encoding="ascii") as lines:
        lines.write(json.dumps(result) + "\n")


class Job:
    """One cell of a table: a code on a case. name: how it is called in the table."""

    def __init__(self, case, code, particles, threads=1, rolling=0.0, law="", extra=(), name=""):
        self.case, self.code, self.particles, self.threads, self.rolling = case, code, particles, threads, rolling
        self.law, self.extra = law, tuple(extra)
        self.name = name or (code + (f" {law}" if law and code == "calx" else ""))
        self.results = []

    def run(self, options, number):
        files = starts.prepare(options, self.case, self.particles, self.rolling, self.law)
        warm_up, steps = next((w, s) for most, w, s in STEPS if self.particles <= most)
        if self.code == "yade":
            warm_up, steps = warm_up // 10, steps // 10
        warm_up, steps = options.warm_up or warm_up, options.steps or steps
        load = wait_until_quiet(options.quiet)
        found = codes.run(self.code, self.case, self.threads, files, options, steps, warm_up, self.rolling, self.extra)
        self.results.append({"time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
                             "machine": options.machine, "round": number, "case": self.case, "code": self.code,
                             "threads": self.threads, "particles": files["particles"], "state": options.state,
                             "rolling": self.rolling, "law": self.law, "extra": list(self.extra), "steps": steps,
                             "warm_up": warm_up, "busy_before": round(load, 2), **found})
        record(options, self.results[-1])
        print(f"round {number + 1}, {self.case}, {files['particles']} particles, {self.threads} threads, {self.name}: "
              f"{found['rate'] / 1e6:.3f} M particle-steps/s (busy before: {load:.2f} processors)", file=sys.stderr)

    def values(self, key="rate"):
        return [r["calx"][key] if key not in r and "calx" in r else r[key] for r in self.results]


def rounds(jobs, options, number):
    """Runs the jobs number times, interleaved, and keeps them in options.done. A job that its code refuses is left out, with the reason on stderr."""
    options.__dict__.setdefault("done", []).append(jobs)
    alive = list(jobs)
    for n in range(number):
        for job in alive[n % max(1, len(alive)):] + alive[:n % max(1, len(alive))]:
            try:
                job.run(options, n)
            except codes.Refused as reason:
                print(f"left out: {job.name}: {reason}", file=sys.stderr)
                job.results = []
                alive = [other for other in alive if other is not job]
    return jobs


def passing(wanted, case, rolling, options):
    """Codes that come through the gate; Calx always does. Prints the gate, once for each law."""
    out, checked = [], options.__dict__.setdefault("checked", {})
    for code in wanted:
        if code != "calx" and code in codes.PEERS[case]:
            if shutil.which(codes.PROGRAMS[code]) is None:
                print(f"left out: {code} is not installed")
                continue
            law = "linear" if case == "chute" else "hertz"
            if (code, law, rolling) not in checked:
                checked[code, law, rolling] = gate.check(code, case, rolling, options)
                print("\n".join(checked[code, law, rolling][1]), flush=True)
            passed, _ = checked[code, law, rolling]
            if not passed:
                print(f"left out: {code} does not pass the gate")
                continue
        if code == "calx" or code in codes.PEERS[case]:
            out.append(code)
    return out


def spread(values):
    return f"{statistics.median(values) / 1e6:8.3f} M/s  from {min(values) / 1e6:.3f} to {max(values) / 1e6:.3f}"


def show(jobs):
    """Median and spread of each job, Calx over each peer round by round, and what stands beside speed."""
    ours = next((job for job in jobs if job.code == "calx" and job.results), None)
    for job in jobs:
        if not job.results:
            continue
        line = (f"{job.threads} thread{'s' if job.threads > 1 else ' '}  {job.particles:8d}  {job.name:24s} "
                f"{spread(job.values())}")
        if job.code != "calx" and ours:
            ratios = [a / b for a, b in zip(ours.values(), job.values())]
            line += f"  Calx/{job.name} {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})"
        last = job.results[-1]
        print(line)
        if "calx" in last:
            c = last["calx"]
            print(f"      per particle: {c['pairs_per_particle']:.3f} pair contacts, {c['walls_per_particle']:.3f} wall contacts, "
                  f"{c['entries_per_particle']:.2f} list entries; {c['rebuilds']} rebuilds; bytes per sphere "
                  f"{c['bytes_per_sphere']:.0f} counted, {c['peak_bytes_per_sphere']:.0f} at the peak")
            print("      shares: " + ", ".join(f"{k[6:]} {100 * v:.1f} %" for k, v in c.items() if k.startswith("share_")) +
                  f"; coordination {c['coordination']:.3f}, floor force / weight {c['floor_over_weight']:.3f}")
        else:
            note = [f"{last['entries_per_particle']:.2f} list entries per particle" if "entries_per_particle" in last else "",
                    f"{last['rebuilds']} rebuilds" if "rebuilds" in last else "",
                    f"coordination {last['coordination']:.3f}" if "coordination" in last else "",
                    f"peak {last['peak_bytes'] / 1e6:.0f} MB a process"]
            print("      " + "; ".join(word for word in note if word))


def compare(options):
    particles = options.particles or PARTICLES[options.case]
    wanted = passing(options.codes or ["calx", *codes.PEERS[options.case]], options.case, options.rolling, options)
    if "yade" in wanted and options.codes is None and (options.case != "settled" or particles > 10000):
        wanted.remove("yade")  # far behind, so minutes a run; --codes asks for it
    laws = ["calx.hertz-mindlin", "calx.epam"] if options.case == "clumps" else [""]
    for threads in options.threads:
        jobs = [Job(options.case, code, particles, threads, options.rolling, law) for code in wanted
                for law in (laws if code == "calx" else laws[:1])]
        rounds(jobs, options, options.rounds)
        print(f"{options.case}, {particles} particles, rolling friction {options.rolling:g}, {options.machine}")
        show(jobs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calx", required=True, help="the program")
    parser.add_argument("--case", default="settled", choices=sorted(PARTICLES))
    parser.add_argument("--state", default="settled", choices=["settled", "mid"],
                        help="tile of settled and pour: at rest, or 43 %% packed and falling")
    parser.add_argument("--particles", type=int, help="default: 100 000; clumps 10 000, chute 32 000")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--rolling", type=float, default=0.0, help="rolling friction; 0 for none")
    parser.add_argument("--codes", nargs="+", choices=["calx", "liggghts", "lammps", "yade"],
                        help="default: all that can do the case; Yade, if installed, for settled with 10 000 "
                        "particles only")
    parser.add_argument("--steps", type=int, help="timed steps")
    parser.add_argument("--warm-up", type=int, help="steps before")
    parser.add_argument("--quiet", type=float, default=60, help="seconds to wait for an idle machine before each run")
    parser.add_argument("--machine", default=machine_name())
    parser.add_argument("--gate", action="store_true", help="the gate only")
    parser.add_argument("--table", action="store_true", help="measure every goal, with few rounds, and print the table")
    parser.add_argument("--parts", nargs="+", choices=["beds", "clumps", "growth", "law", "rest"], default=[],
                        help="only these parts of the table")
    parser.add_argument("--law-inlined", help="the program bench_law_inlined (default: beside calx)")
    parser.add_argument("--dry", action="store_true", help="few steps, one round, nothing recorded: only a check")
    options = parser.parse_args()
    options.done = []
    options.calx = str(pathlib.Path(options.calx).resolve())
    options.law_inlined = options.law_inlined or str(pathlib.Path(options.calx).parent / "bench_law_inlined")
    if options.dry:
        options.warm_up, options.steps, options.rounds, options.quiet = 2, 10, 1, 0
        print("a check only: these times mean nothing")
    with tempfile.TemporaryDirectory() as scratch:
        options.scratch = scratch
        if options.gate:
            passing(options.codes or codes.PEERS[options.case], options.case, options.rolling, options)
        elif options.table:
            goals.table(options, Job, rounds, passing)
            for jobs in options.done:
                if any(job.results for job in jobs):
                    print(f"\n{jobs[0].case}, rolling friction {jobs[0].rolling:g}")
                    show(jobs)
        else:
            compare(options)


if __name__ == "__main__":
    main()
