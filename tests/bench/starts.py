"""starts.py: the start all codes share. Calx writes it (calx bench CASE --save-start FOLDER: case.json and a CSV for each
source); here it becomes the text that LIGGGHTS and LAMMPS read. Clumps go the other way: LIGGGHTS, which cannot read
clumps from a file, settles them, and Calx takes over its positions. Starts are kept in build/bench/starts."""
import csv
import json
import pathlib
import subprocess
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
COLUMNS = ["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"]
SKIN = {"settled": 5e-4, "pour": 5e-4, "sizes": 2e-4, "clumps": 5e-4, "chute": 0.1}  # m


def run(command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode:
        sys.exit(f"{' '.join(str(word) for word in command)}\n{(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def write_csv(path, x, v, w=None, turn=None):
    columns = COLUMNS + (["qw_1", "qx_1", "qy_1", "qz_1"] if turn is not None else [])
    w = numpy.zeros_like(x) if w is None else w
    table = numpy.hstack([x, v, w] + ([turn] if turn is not None else []))
    with open(path, "w", newline="", encoding="ascii") as out:
        rows = csv.writer(out)
        rows.writerow(columns)
        rows.writerows([repr(float(value)) for value in row] for row in table)


def read_csv(path):
    """Names to columns."""
    with open(path, encoding="ascii") as file:
        names = file.readline().strip().split(",")
    return dict(zip(names, numpy.loadtxt(path, delimiter=",", skiprows=1, ndmin=2).T))


def write_data(path, rows, radius, density, box):
    """The text both peers read: id type diameter density x y z, then id velocity spin. box: x, y, z from and to."""
    scale = rows.get("scale", numpy.ones(len(rows["x_m"])))
    with open(path, "w", encoding="ascii") as out:
        out.write(f"start of the bench\n\n{len(scale)} atoms\n1 atom types\n")
        out.writelines(f"{low:.12g} {high:.12g} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", box))
        out.write("\nAtoms\n\n")
        out.writelines(f"{k + 1} 1 {2 * radius * s:.9g} {density:.12g} {x:.12g} {y:.12g} {z:.12g}\n" for k, (s, x, y, z) in
                       enumerate(zip(scale, rows["x_m"], rows["y_m"], rows["z_m"])))
        out.write("\nVelocities\n\n")
        out.writelines(f"{k + 1} " + " ".join(f"{value:.9g}" for value in row) + "\n" for k, row in
                       enumerate(zip(*(rows[name] for name in COLUMNS[3:]))))


def tile(state):
    """CSV of the 10 000 spheres of data/A10k_STATE.npz."""
    path = HERE.parent.parent / "build/bench/starts" / f"tile-{state}.csv"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        start = numpy.load(HERE / "data" / f"A10k_{state}.npz")
        write_csv(path, start["x"], start["v"].astype(float))
    return path


def settled_clumps(particles):
    """Clumps that LIGGGHTS has settled: the CSV for Calx; settled.restart for LIGGGHTS lies beside it."""
    folder = HERE.parent.parent / "build/bench/starts" / f"liggghts-clumps-{particles}"
    path = folder / "grains.csv"
    if path.exists():
        return path
    folder.mkdir(parents=True, exist_ok=True)
    side = 0.05 * (particles / 10000) ** (1 / 3) if particles < 10000 else 0.05
    height = 0.2 * side / 0.05 * max(1, particles / 10000)
    print(f"LIGGGHTS settles {particles} clumps once; that takes some minutes", file=sys.stderr)
    run(["liggghts", "-in", HERE / "decks/clumps_settle.liggghts", "-log", "none", "-var", "side", side, "-var", "count",
         particles, "-var", "height", height], cwd=folder)
    lines = (folder / "settled.dump").read_text().splitlines()
    spheres = numpy.array([line.split() for line in lines[9:]], dtype=float)
    spheres = spheres[numpy.lexsort((spheres[:, 0], spheres[:, 1]))]
    a, b = spheres[0::2], spheres[1::2]
    if len(a) != len(b) or (a[:, 1] != b[:, 1]).any():
        sys.exit("LIGGGHTS' dump does not hold clumps of two spheres")
    d, dv = b[:, 2:5] - a[:, 2:5], b[:, 5:8] - a[:, 5:8]
    axis = d / numpy.linalg.norm(d, axis=1)[:, None]
    # The turn that takes z to the axis, about z x axis; an axis near -z is turned round, since the clump has no ends.
    axis[axis[:, 2] < 0] *= -1
    turn = numpy.stack([1 + axis[:, 2], -axis[:, 1], axis[:, 0], numpy.zeros(len(axis))], 1)
    turn /= numpy.linalg.norm(turn, axis=1)[:, None]
    # Spin along the axis is not in the dump: it is small in a bed at rest.
    spin = numpy.cross(d, dv) / (d ** 2).sum(1)[:, None]
    write_csv(path, 0.5 * (a[:, 2:5] + b[:, 2:5]), 0.5 * (a[:, 5:8] + b[:, 5:8]), spin, turn)
    return path


def prepare(options, case, particles, rolling, law=""):
    """{"folder", "data", "lx", "ly", "step", "skin", "particles", "spheres"}: the start of a case, made once."""
    name = "-".join([case, options.state if case in ("settled", "pour") else "", str(particles), f"roll{rolling:g}", law])
    folder = HERE.parent.parent / "build/bench/starts" / name
    if not (folder / "case.json").exists():
        command = [options.calx, "bench", case, "--particles", particles, "--rolling", rolling, "--steps", 1, "--warm-up", 0,
                   "--save-start", folder, "--threads", options.threads[-1]]
        if case in ("settled", "pour"):
            command += ["--start", tile(options.state)]
        if case == "clumps":
            command += ["--law", law, "--start", settled_clumps(min(particles, 10000))]
        if case == "chute":
            command += ["--base", "plane"]
        run(command)
    scene = json.loads((folder / "case.json").read_text())
    source = scene["sources"][0]
    shape, density = scene["shapes"][source["shape"]], scene["materials"][source["material"]]["density"]
    rows = read_csv(folder / source["file"])
    files = {"folder": folder, "data": folder / "start.data", "step": scene["time"]["step"], "skin": SKIN[case],
             "particles": len(rows["x_m"]), "spheres": len(rows["x_m"]) * len(shape.get("spheres", [0]))}
    if case == "chute":
        files["lx"], files["ly"] = scene["domain"]["max"][:2]
        box = [(0, files["lx"]), (0, files["ly"]), (-1, rows["z_m"].max() + 10)]
    else:
        files["lx"], files["ly"] = scene["parts"][0]["parameters"]["max"][:2]
        edge = 2.5e-3
        box = [(-edge, files["lx"] + edge), (-edge, files["ly"] + edge), (-2 * edge, rows["z_m"].max() + 4 * edge)]
    if case == "clumps":
        files["restart"] = settled_clumps(min(particles, 10000)).parent / "settled.restart"
    elif not files["data"].exists():
        write_data(files["data"], rows, shape["sphere"]["radius"], density, box)
    return files
