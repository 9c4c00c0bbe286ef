"""codes.py: one timed run of Calx, LIGGGHTS, LAMMPS or Yade, and what it says beside its time.

Timed is the second of two runs: the peers' own "Loop time", which leaves out the list built at its start, and Calx's own
figure. Peers are the Debian packages: baseline x86-64, MPI for two processes, OpenMP in Yade."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PEERS = {"settled": ["liggghts", "lammps", "yade"], "pour": ["liggghts", "lammps", "yade"], "sizes": ["liggghts", "lammps"],
         "clumps": ["liggghts"], "chute": ["lammps"]}
PROGRAMS = {"liggghts": "liggghts", "lammps": "lmp", "yade": "yade"}


class Refused(Exception):
    """The code does not offer what was asked."""


def output(command, env=None, cwd=None):
    """What the command prints, and the peak memory of its largest process, bytes."""
    words = [str(word) for word in command]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen(words, stdout=out, stderr=err, env=env, cwd=cwd)  # pylint: disable=consider-using-with
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        text, messages = out.read(), err.read()
    if process.returncode:
        raise Refused(f"{' '.join(words)}\n{(text + messages)[-2000:]}")
    return text, 1024 * usage.ru_maxrss


def thermo(text, before):
    """{column: value} of the last row of the table that ends where `before` begins."""
    lines = [line.split() for line in text[:before].rstrip().splitlines()]
    row = next(line for line in reversed(lines) if line and re.fullmatch(r"\d+", line[0]))
    head = next(line for line in reversed(lines) if line and line[0] == "Step")
    return dict(zip(head, (float(word) for word in row)))


def run_peer(code, case, threads, files, options, steps, warm_up, rolling):
    deck = {"clumps": "clumps", "chute": "chute"}.get(case, "box")
    roll = "off" if code == "liggghts" else "none"
    if rolling > 0:
        roll = "epsd2" if code == "liggghts" else "sds"
    variables = {"data": files.get("restart", files["data"]), "lx": files["lx"], "ly": files["ly"], "dt": files["step"],
                 "skin": files["skin"], "warm": warm_up, "steps": steps, "px": threads, "py": 1, "roll": roll, "mur": rolling,
                 "sizes": 1 if case == "sizes" else 0}
    command = [PROGRAMS[code], "-in", HERE / "decks" / f"{deck}.{code}", "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, value]
    if threads > 1:
        command = ["mpirun", "--allow-run-as-root", "--bind-to", "none", "-np", threads, *command]
    env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_MCA_btl_vader_single_copy_mechanism="none")
    text, memory = output(command, env, options.scratch)
    loops = list(re.finditer(r"^Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text, re.M))
    if len(loops) != 2 or int(loops[1][3]) != files["spheres"]:
        raise Refused(f"{code}: not two runs of {files['spheres']} spheres\n{text[-2000:]}")
    wall, last = float(loops[1][1]), thermo(text, loops[1].start())
    rebuilds = re.findall(r"^Neighbor list builds = (\d+)", text, re.M)
    entries = re.findall(r"^Ave neighs/atom = (\S+)", text, re.M)
    version = re.search(r"^(LIGGGHTS|LAMMPS)[^\n]*", text, re.M)
    found = {"wall_s": wall, "rate": files["particles"] * int(loops[1][2]) / wall, "peak_bytes": memory,
             "rebuilds": int(rebuilds[-1]), "entries_per_particle": float(entries[-1]) * files["spheres"] / files["particles"],
             "kinetic_translation_J": last["KinEng"], "version": version[0] if version else ""}
    touch = last.get("c_touch", last.get("touch"))
    if touch is not None:
        found["coordination"] = touch
    return found


def run_yade(threads, files, options, steps, warm_up, rolling):
    env = dict(os.environ, START=str(files["folder"]), STEPS=str(steps), WARM_UP=str(warm_up), ROLLING=str(rolling))
    text, memory = output(["yade", "-n", "-x", "-j", threads, HERE / "decks/box_yade.py"], env, options.scratch)
    line = json.loads(next(row for row in text.splitlines() if row.startswith("{\"yade\"")))
    return {"wall_s": line["wall_s"], "rate": files["particles"] * steps / line["wall_s"], "peak_bytes": memory,
            "coordination": line["coordination"], "version": f"Yade {line['yade']}"}


def run_calx(case, threads, files, options, steps, warm_up, rolling, extra=()):
    command = [options.calx, "bench", case, "--start", files["folder"], "--threads", threads, "--steps", steps, "--warm-up",
               warm_up, "--rolling", rolling, "--json", *extra]
    text, _ = output(command)
    line = json.loads(text.strip().splitlines()[-1])
    if line["particles"] != files["particles"]:
        sys.exit(f"calx ran {line['particles']} particles, not {files['particles']}")
    return {"wall_s": line["wall_s"], "rate": line["particle_steps_per_second"], "coordination": line["coordination"],
            "entries_per_particle": line["entries_per_particle"], "rebuilds": line["rebuilds"],
            "version": f"Calx {line['calx']} ({line['git']})", "calx": line}


def run(code, case, threads, files, options, steps, warm_up, rolling, extra=()):
    if code == "calx":
        return run_calx(case, threads, files, options, steps, warm_up, rolling, extra)
    if code == "yade":
        return run_yade(threads, files, options, steps, warm_up, rolling)
    return run_peer(code, case, threads, files, options, steps, warm_up, rolling)
