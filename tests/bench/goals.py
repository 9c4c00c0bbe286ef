"""goals.py: the goals of speed and memory, each measured with few rounds: goal, median, spread, met or not."""
import concurrent.futures
import json
import pathlib
import shutil
import statistics
import tempfile

import codes
import starts

ROUNDS = 3
LATE = 2.2                        # s, in the third cycle of the example
REST = "/rest={}"                 # how a case asks for quiescent regions to be skipped


PHASES = {"share_neighbour": "lists", "share_contacts": "contacts and sums", "share_integrate": "integration and guards"}


def profile(rows):
    """Where the time of runs goes, and what the force loop has to do; rows: their JSON lines."""
    rows = [row if "share_neighbour" in row else row["calx"] for row in rows]
    middle = {key: statistics.median(row[key] for row in rows)
              for key in (*PHASES, "rebuilds", "entries_per_particle", "pairs_per_particle", "walls_per_particle")}
    phases = ", ".join(f"{100 * middle[key]:.0f} % {name}" for key, name in PHASES.items())
    return (f"{phases}; {middle['rebuilds']:g} rebuilds; a particle has {middle['entries_per_particle']:.2f} list entries, "
            f"{middle['pairs_per_particle']:.2f} contacts with others, {middle['walls_per_particle']:.2f} with parts")


class Table:
    def __init__(self):
        self.rows = []
        self.profiles = []  # of goals not met

    def add(self, goal, values, limit, unit, at_least=True, note="", runs=()):
        """values: one a round; empty: not measured, and note says why. runs: JSON lines of the runs behind them."""
        if not values:
            self.rows.append((goal, "-", "-", "not measured", note))
            return
        middle = statistics.median(values)
        met = middle >= limit if at_least else middle <= limit
        self.rows.append((goal, f"{middle:.3g} {unit}".strip(), f"{min(values):.3g} to {max(values):.3g}",
                          "met" if met else "not met", note))
        if not met and runs:
            self.profiles.append((goal, profile(runs)))

    def show(self):
        head = ("goal", "median", "spread", "met", "note")
        widths = [max(len(row[k]) for row in [head, *self.rows]) for k in range(len(head))]
        for row in [head, tuple("-" * w for w in widths), *self.rows]:
            print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |")
        if self.profiles:
            print("\nWhere the time goes in what is not met (tests/bench/README.md counts instructions):")
        for goal, text in self.profiles:
            print(f"- {goal}: {text}")


def millions(job):
    return [value / 1e6 for value in job.values()]


def over_best(ours, peers):
    """Calx over the fastest peer of each round, and that peer's name."""
    peers = [peer for peer in peers if peer.results]
    if not peers or not ours.results:
        return [], "no peer ran"
    best = max(peers, key=lambda peer: statistics.median(peer.values()))
    return [a / b for a, b in zip(ours.values(), best.values())], f"against {best.name}"


def beds(table, options, job, rounds, passing, size):
    """B1 with and without rolling resistance, two threads, mixed precision; B2."""
    two = {}
    for rolling, goal, ratio in ((0.0, 20, 3.3), (0.1, 14, 3.0)):
        wanted = [c for c in passing(["liggghts", "lammps"], "settled", rolling, options)]
        ours = job("settled", "calx", size, rolling=rolling)
        peers = [job("settled", code, size, rolling=rolling) for code in wanted]
        jobs = [ours, *peers]
        if rolling == 0:
            two = {"double": job("settled", "calx", size, threads=2, name="calx, 2 threads"),
                   "mixed": job("settled", "calx", size, threads=2, extra=["--precision", "mixed"],
                                name="calx, mixed, 2 threads")}
            jobs += two.values()
        rounds(jobs, options, options.table_rounds)
        name = "B1" + (", rolling resistance" if rolling else "")
        table.add(f"{name}: at least {goal} M particle-steps/s on one core", millions(ours), goal, "M/s",
                  runs=ours.results)
        values, note = over_best(ours, peers)
        table.add(f"{name}: at least {ratio} times the best peer", values, ratio, "", note=note)
        if rolling == 0:
            table.add("B1: two threads at least 1.9 times one", [a / b for a, b in zip(two["double"].values(), ours.values())],
                      1.9, "", runs=two["double"].results)
            table.add("B1 mixed, two threads: at least 70 M particle-steps/s", millions(two["mixed"]), 70, "M/s",
                      note="" if two["mixed"].results else "mixed precision is refused", runs=two["mixed"].results)
    ours = job("pour", "calx", size)
    peers = [job("pour", code, size) for code in passing(["liggghts", "lammps"], "pour", 0.0, options)]
    rounds([ours, *peers], options, options.table_rounds)
    values, note = over_best(ours, peers)
    table.add("B2: at least 3.3 times the best peer", values, 3.3, "", note=note)
    table.add("B2: list work at most 5 % of the time", [100 * v for v in ours.values("share_neighbour")], 5, "%", False,
              runs=ours.results)


def clumps(table, options, job, rounds, passing):
    size = options.table_clumps
    epam, hertz = (job("clumps", "calx", size, law=law) for law in ("calx.epam", "calx.hertz-mindlin"))
    peers = [job("clumps", code, size, law="calx.hertz-mindlin") for code in passing(["liggghts"], "clumps", 0.0, options)]
    rounds([epam, hertz, *peers], options, options.table_rounds)
    table.add("B9 EpAM: at least 6 M clump-steps/s on one core", millions(epam), 6, "M/s")
    values, note = over_best(epam, peers)
    table.add("B9 EpAM: at least 3 times LIGGGHTS multisphere", values, 3, "", note=note + ", which runs Hertz")
    values, note = over_best(hertz, peers)
    table.add("B9 Hertz-Mindlin, beside the goal", values, 3, "", note=note)


def growth(table, options, job, rounds):
    jobs = [job("settled", "calx", size) for size in options.table_sizes]
    rounds(jobs, options, options.table_rounds)
    table.add(f"ns per particle-step from {options.table_sizes[0]} to {options.table_sizes[-1]}: grows at most 1.3 times",
              [small / large for small, large in zip(jobs[0].values(), jobs[-1].values())], 1.3, "", False,
              ", ".join(f"{n:g}: {1e9 / statistics.median(j.values()):.1f} ns" for n, j in zip(options.table_sizes, jobs)))
    table.add(f"bytes per sphere at {options.table_sizes[-1]}: at most 400, peak of the process",
              jobs[-1].values("peak_bytes_per_sphere"), 400, "", False,
              f"{statistics.median(jobs[-1].values('bytes_per_sphere')):.0f} counted", runs=jobs[-1].results)


def law(table, options):
    try:
        text, _ = codes.output([options.law_inlined, 3 if options.dry else 1000])
    except (OSError, codes.Refused) as reason:
        table.add("law through the ABI at most 1.03 times the law compiled in", [], 1.03, "", False, str(reason)[:60])
        return
    for line in map(json.loads, text.splitlines()):
        table.add(f"{line['law']} {line['scalar']} through the ABI at most 1.03 times the law compiled in", [line["ratio"]],
                  1.03, "", False, f"one loop over all rows: {line['ratio_to_one_loop']:.3f}")


def late_in_a_fill(options, folder, name, extra, at):
    """Runs the example up to `at` s, untimed; returns the command that goes on from there and its folder."""
    case = starts.HERE.parent.parent / "examples/canister_fill/first_fill.json"
    out = folder / name
    command = [options.calx, "run", case, "--quiet", "--no-report", "--threads", 1, *extra]
    codes.output([*command, "-o", out, "--overwrite", "--until", at])
    return command, out


def rest(table, options):
    """B10 with quiescent regions skipped and without, both gone on with from checkpoints, interleaved."""
    at = 0.001 if options.dry else LATE
    until = at + (0.001 if options.dry else 0.03)
    rates, mass = {"off": [], "on": []}, {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        with concurrent.futures.ThreadPoolExecutor() as both:
            late = dict(zip(rates, both.map(lambda kind: late_in_a_fill(options, folder, kind[0], kind[1], at),
                                            [("off", []), ("on", ["--set", REST])])))
        for _ in range(options.table_rounds):
            for kind, (command, out) in late.items():
                shutil.rmtree(folder / "next", ignore_errors=True)
                shutil.copytree(out, folder / "next")
                codes.output([*command, "-o", folder / "next", "--resume", "--until", until])
                summary = json.loads((folder / "next" / "summary.json").read_text())
                rates[kind].append(summary["particle_steps_per_second"])
                mass[kind] = summary["mass"]["regions"].get("canister", 0)
    table.add("B10 with rest on, late in a fill: at least 3 times off",
              [on / off for on, off in zip(rates["on"], rates["off"])], 3, "",
              note=f"{statistics.median(rates['on']) / 1e6:.2f} and {statistics.median(rates['off']) / 1e6:.2f} M/s; "
                   f"canister {1e3 * mass['on']:.1f} g with, {1e3 * mass['off']:.1f} g without")


def table(options, job, rounds, passing):
    """Measures all and prints the table."""
    options.table_rounds = 1 if options.dry else min(options.rounds, ROUNDS)
    options.table_sizes = [10000] if options.dry else [10000, 100000, 1000000]
    options.table_clumps = 300 if options.dry else 10000
    out = Table()
    parts = {"beds": lambda: beds(out, options, job, rounds, passing, 10000 if options.dry else 100000),
             "clumps": lambda: clumps(out, options, job, rounds, passing),
             "growth": lambda: growth(out, options, job, rounds),
             "law": lambda: law(out, options),
             "rest": lambda: rest(out, options)}
    for name, part in parts.items():
        if not options.parts or name in options.parts:
            part()
    print(f"\n{options.machine}, {options.table_rounds} rounds" + (", a check only: these times mean nothing" if options.dry
                                                                  else ""))
    out.show()
