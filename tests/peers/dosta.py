"""dosta.py: cases of the open-source comparison of Dosta et al. 2024 (Comput. Phys. Commun. 296, 109066) from its own start
files, which are not kept here: MercuryDPM's Drivers/Papers/OSBenchmark has them. Radius, x, y, z in m per line, one header.

penetration: a steel ball of 20 mm at 5 m/s into 25 000 grains of 2 mm. drum: 8000 grains of 4 mm and 30 000 of 2 mm turn at
2 rad/s; its soft variant has moduli of 2 and 1 MPa (its step of 1e-4 s is
beyond half of the Rayleigh time, which Calx refuses: 4e-5 s). Hertz-Mindlin without rolling resistance; MercuryDPM takes g = 9.8.
"""
import gzip
import json
import pathlib

import numpy as np

RESTITUTION = {"M1 M1": 0.5, "M1 M2": 0.45, "M1 steel": 0.4, "M2 M2": 0.4, "M2 steel": 0.4, "steel steel": 0.6}
FRICTION = {"M1 M1": 0.3, "M1 M2": 0.2, "M1 steel": 0.2, "M2 M2": 0.4, "M2 steel": 0.2, "steel steel": 0.5}


def read_start(path):
    """Radius, x, y, z per row, m."""
    with (gzip.open(path, "rt") if str(path).endswith(".gz") else open(path, encoding="ascii")) as lines:
        return np.loadtxt(lines, skiprows=1, usecols=(0, 1, 2, 3))


def write_seeds(path, rows, radius):
    """A source's CSV of the rows with that radius."""
    chosen = rows[np.isclose(rows[:, 0], radius)]
    with open(path, "w", encoding="ascii") as out:
        out.write("x_m,y_m,z_m\n")
        out.writelines(f"{x!r},{y!r},{z!r}\n" for x, y, z in chosen[:, 1:].tolist())
    return len(chosen)


def base(title, end, step, young):
    materials = {name: {"density": density, "young": modulus, "poisson": 0.2}
                 for name, density, modulus in (("M1", 2500, young[0]), ("M2", 2000, young[1]), ("steel", 7200, 210e9))}
    contacts = [{"between": pair.split(), "law": "calx.hertz-mindlin",
                 "parameters": {"restitution": RESTITUTION[pair], "friction": FRICTION[pair]}} for pair in RESTITUTION]
    return {"calx": 1, "title": title, "gravity": [0, 0, -9.8], "time": {"step": step, "end": end}, "materials": materials,
            "contacts": contacts,
            "assumptions": ["Materials, friction and restitution of the comparison; walls as shapes instead of its triangles."]}


def penetration(start, folder):
    case = base("Peers: penetration, 25 000 grains", 0.1, 5e-7, (1e9, 0.5e9))
    count = write_seeds(folder / "bed.csv", read_start(start), 0.001)
    case.update({
        "domain": {"min": [-0.06, -0.04, -0.1], "max": [0.06, 0.04, 0.3], "on_leave": "count"},
        "shapes": {"grain": {"sphere": {"radius": 0.001}}, "ball": {"sphere": {"radius": 0.01}}},
        "sources": [{"name": "bed", "shape": "grain", "material": "M1", "file": str(folder / "bed.csv")},
                    {"name": "ball", "shape": "ball", "material": "steel", "positions": [[0, 0, 0.06]], "velocities": [[0, 0, -5]]}],
        "parts": [{"name": "box", "geometry": "calx.box", "material": "steel",
                   "parameters": {"min": [-0.049, -0.03, -0.0902431], "max": [0.049, 0.03, 0.107757], "open_top": "yes"}}],
        "sensors": [{"name": "load", "kind": "part-load", "part": "box", "every": 0.001}],
        "output": {"frames_every": 0.005, "checkpoint_every_wall": 120}})
    return case, count


def drum(start, folder, soft):
    case = base("Peers: drum, two sizes" + (", soft" if soft else ""), 5.0, 4e-5 if soft else 8e-7,
                (2e6, 1e6) if soft else (1e9, 0.5e9))
    if soft:
        case["materials"]["steel"]["young"] = 2e6  # else the step is too long for contacts with the wall
    rows = read_start(start)
    counts = [write_seeds(folder / f"{name}.csv", rows, radius) for name, radius in (("large", 0.002), ("small", 0.001))]
    quadrant = {"lower left": [[-0.11, -0.04, -0.11], [0, 0.04, 0]], "upper right": [[0, -0.04, 0], [0.11, 0.04, 0.11]]}
    case.update({
        "domain": {"min": [-0.11, -0.04, -0.11], "max": [0.11, 0.04, 0.11]},
        "shapes": {"large": {"sphere": {"radius": 0.002}}, "small": {"sphere": {"radius": 0.001}}},
        "regions": {name: {"box": {"min": box[0], "max": box[1]}} for name, box in quadrant.items()},
        "sources": [{"name": name, "shape": name, "material": material, "file": str(folder / f"{name}.csv")}
                    for name, material in (("large", "M2"), ("small", "M1"))],
        "parts": [{"name": "drum", "geometry": "calx.cylinder", "material": "steel", "motion": "turn",
                   "parameters": {"from": [0, -0.03, 0], "to": [0, 0.03, 0], "radius": 0.1, "caps": "both"}}],
        "motions": {"turn": {"plugin": "calx.open-close", "parameters": {"axis": [0, 1, 0], "angle_to": -10.0, "duration": 5.0}}},
        "sensors": [{"name": name, "kind": "mass", "region": name, "every": 0.1} for name in quadrant],
        "output": {"frames_every": 0.1, "checkpoint_every_wall": 120}})
    return case, sum(counts)


def write_case(kind, start, folder):
    """Path of the case, number of grains. kind: "penetration", "full-drum" or "soft-drum"."""
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    case, count = penetration(start, folder) if kind == "penetration" else drum(start, folder, kind == "soft-drum")
    path = folder / f"{kind}.json"
    path.write_text(json.dumps(case, indent=1), encoding="ascii")
    return path, count
