"""peers.py: particle-steps per second of Calx, LIGGGHTS and LAMMPS on the same bed, in interleaved rounds.

Case: spheres of 2.5 mm, 2100 kg/m3, E = 1e7 Pa, nu = 0.25, restitution 0.3, friction 0.5, in a box; step 9.8e-6 s (10 %
of the Rayleigh time). A start file holds 10 000 spheres on 50 x 50 mm; 100 000 are 5 x 2 copies of it side by side.
Spins start at zero in all codes. The peers run as Debian packages them (x86-64 baseline, MPI); a code compiled for this
processor would be faster, so a ratio holds for the Debian build only.

Every round runs all codes once, in an order that rotates, so that slow drift of the machine meets all alike. Timed is the
second of two runs: the peers' own "Loop time", which leaves out the list built at its start, and Calx's own figure.
Each result is a line in results/MACHINE.jsonl.
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
import sys
import tempfile
import time

import numpy

HERE = pathlib.Path(__file__).resolve().parent
DIAMETER, DENSITY, STEP, SKIN = 2.5e-3, 2100.0, 9.8e-6, 5e-4
TILES = {10000: (1, 1), 100000: (5, 2)}
STEPS = {10000: (500, 2000), 100000: (100, 300)}  # warm-up, timed


def write_csv(start, path):
    with open(path, "w", newline="", encoding="ascii") as out:
        rows = csv.writer(out)
        rows.writerow(["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"])
        rows.writerows([repr(float(value)) for value in row] for row in numpy.hstack([start["x"], start["v"]]))


def tiled(start, nx, ny):
    """nx by ny copies side by side: positions, velocities, footprint."""
    lx, ly = start["box"][1], start["box"][3]
    shifts = [(a * lx, b * ly, 0.0) for a in range(nx) for b in range(ny)]
    return (numpy.vstack([start["x"] + numpy.array(shift) for shift in shifts]),
            numpy.vstack([start["v"].astype(float)] * len(shifts)), nx * lx, ny * ly)


def write_data(x, v, lx, ly, path):
    """The text form that both peers read: id type diameter density x y z, then id velocity spin."""
    with open(path, "w", encoding="ascii") as out:
        out.write(f"start of the bench\n\n{len(x)} atoms\n1 atom types\n"
                  f"{-DIAMETER:.9g} {lx + DIAMETER:.9g} xlo xhi\n{-DIAMETER:.9g} {ly + DIAMETER:.9g} ylo yhi\n"
                  f"-0.005 {x[:, 2].max() + 4 * DIAMETER:.9g} zlo zhi\n\nAtoms\n\n")
        out.writelines(f"{k + 1} 1 {DIAMETER:.9g} {DENSITY:.9g} {p[0]:.12g} {p[1]:.12g} {p[2]:.12g}\n"
                       for k, p in enumerate(x))
        out.write("\nVelocities\n\n")
        out.writelines(f"{k + 1} {p[0]:.9g} {p[1]:.9g} {p[2]:.9g} 0 0 0\n" for k, p in enumerate(v))


def busy_seconds():
    """CPU seconds of the whole machine that were not idle."""
    fields = [int(word) for word in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:]]
    return (sum(fields[:8]) - fields[3] - fields[4]) / os.sysconf("SC_CLK_TCK")


def wait_until_quiet(limit):
    """Waits until less than 0.15 of one processor is busy, at most limit seconds; returns what was busy last."""
    end, load = time.monotonic() + limit, 0.0
    while True:
        before = busy_seconds()
        time.sleep(1.0)
        load = busy_seconds() - before
        if load < 0.15 or time.monotonic() > end:
            return load


def run_peer(code, threads, files, options):
    program = {"liggghts": "liggghts", "lammps": "lmp"}[code]
    roll = "off" if code == "liggghts" else "none"
    if options.rolling > 0:
        roll = "epsd2" if code == "liggghts" else "sds"
    variables = {"data": files["data"], "lx": files["lx"], "ly": files["ly"], "dt": STEP, "skin": SKIN,
                 "warm": options.warm_up, "steps": options.steps, "px": threads, "py": 1, "roll": roll,
                 "mur": options.rolling}
    command = [program, "-in", str(HERE / "decks" / f"box.{code}"), "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    if threads > 1:
        command = ["mpirun", "--allow-run-as-root", "--bind-to", "none", "-np", str(threads), *command]
    env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_MCA_btl_vader_single_copy_mechanism="none")
    run = subprocess.run(command, capture_output=True, text=True, env=env, cwd=files["folder"], check=False)
    loops = re.findall(r"^Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", run.stdout, re.M)
    if run.returncode or len(loops) != 2 or int(loops[1][2]) != options.particles:
        sys.exit(f"{' '.join(command)}\n{(run.stdout + run.stderr)[-2000:]}")
    wall = float(loops[1][0])
    version = re.search(r"^(LIGGGHTS|LAMMPS)[^\n]*", run.stdout, re.M)
    return {"wall_s": wall, "rate": options.particles * int(loops[1][1]) / wall, "version": version[0] if version else ""}


def run_calx(threads, files, options):
    command = [options.calx, "bench", "settled", "--particles", str(options.particles), "--threads", str(threads),
               "--start", files["csv"], "--warm-up", str(options.warm_up), "--steps", str(options.steps), "--json"]
    if options.rolling > 0:
        command += ["--rolling", str(options.rolling)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{' '.join(command)}\n{run.stderr}")
    line = json.loads(run.stdout.strip().splitlines()[-1])
    if line["particles"] != options.particles:
        sys.exit(f"{' '.join(command)}\nran {line['particles']} particles, not {options.particles}")
    return {"wall_s": line["wall_s"], "rate": line["particle_steps_per_second"],
            "version": f"Calx {line['calx']} ({line['git']})", "calx": line}


def machine_name():
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    model = re.search(r"^model name\s*:\s*(.*)$", text, re.M)
    words = re.sub(r"\((R|TM)\)|CPU|@.*", "", model[1] if model else "unknown")
    return re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-") + f"-{os.cpu_count()}"


def table(results, codes, threads):
    """Median and spread per code, and the median over rounds of Calx against each peer."""
    lines = []
    for n in threads:
        rate = {code: [r["rate"] for r in results if r["code"] == code and r["threads"] == n] for code in codes}
        for code in codes:
            middle = statistics.median(rate[code])
            line = (f"{n} thread{'s' if n > 1 else ' '}  {code:9s} {middle / 1e6:8.3f} M particle-steps/s"
                    f"  from {min(rate[code]) / 1e6:.3f} to {max(rate[code]) / 1e6:.3f} in {len(rate[code])}")
            if code != "calx" and "calx" in codes:
                ratios = [a / b for a, b in zip(rate["calx"], rate[code])]
                line += f"  Calx/{code} {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})"
            lines.append(line)
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calx", required=True, help="the program")
    parser.add_argument("--data", default=str(HERE / "data"), help="folder of start files A10k_STATE.npz")
    parser.add_argument("--state", default="settled", help="settled or mid (filling)")
    parser.add_argument("--particles", type=int, default=10000, choices=sorted(TILES))
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--rolling", type=float, default=0.0, help="rolling friction; 0 for none")
    parser.add_argument("--codes", nargs="+", default=["calx", "liggghts", "lammps"],
                        choices=["calx", "liggghts", "lammps"])
    parser.add_argument("--steps", type=int, help="timed steps (default 2000, or 300 for 100 000 particles)")
    parser.add_argument("--warm-up", type=int, help="steps before (default 500, or 100)")
    parser.add_argument("--quiet", type=float, default=60, help="seconds to wait for an idle machine before each run")
    parser.add_argument("--machine", default=machine_name())
    parser.add_argument("--dry", action="store_true", help="few steps, one round, nothing recorded: only a check")
    options = parser.parse_args()
    warm_up, steps = STEPS[options.particles]
    options.warm_up, options.steps = options.warm_up or warm_up, options.steps or steps
    if options.dry:
        options.warm_up, options.steps, options.rounds, options.quiet = 2, 10, 1, 0

    results = []
    with tempfile.TemporaryDirectory() as folder:
        start = numpy.load(pathlib.Path(options.data, f"A10k_{options.state}.npz"))
        x, v, lx, ly = tiled(start, *TILES[options.particles])
        files = {"folder": folder, "csv": f"{folder}/start.csv", "data": f"{folder}/start.data", "lx": lx, "ly": ly}
        write_csv(start, files["csv"])
        write_data(x, v, lx, ly, files["data"])
        for number in range(options.rounds):
            order = options.codes[number % len(options.codes):] + options.codes[:number % len(options.codes)]
            for threads in options.threads:
                for code in order:
                    load = wait_until_quiet(options.quiet)
                    found = run_calx(threads, files, options) if code == "calx" else run_peer(code, threads, files, options)
                    results.append({"time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
                                    "machine": options.machine, "round": number, "code": code, "threads": threads,
                                    "particles": options.particles, "state": options.state, "rolling": options.rolling,
                                    "steps": options.steps, "warm_up": options.warm_up, "busy_before": round(load, 2),
                                    **found})
                    print(f"round {number + 1}, {threads} threads, {code}: {found['rate'] / 1e6:.3f} M particle-steps/s"
                          f" (busy before: {load:.2f} processors)", file=sys.stderr)
                    if not options.dry:
                        out = HERE / "results" / f"{options.machine}.jsonl"
                        out.parent.mkdir(exist_ok=True)
                        with open(out, "a", encoding="ascii") as lines:
                            lines.write(json.dumps(results[-1]) + "\n")
    print(f"{options.particles} spheres, {options.state}, rolling friction {options.rolling:g}, {options.machine}")
    print(table(results, options.codes, options.threads))


if __name__ == "__main__":
    main()
