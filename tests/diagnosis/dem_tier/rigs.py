"""rigs.py: the cases of the tier: what is read from each, what is uncertain about it, how it is run and read.

A reading is one observable of a study. Places are in the SI unit of the column it is read against; "noise" is the standard
deviation of the instrument, in the unit of the reading."""
import csv
import dataclasses
import json
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass
class Reading:
    name: str
    kind: str
    sensor: str
    column: str
    unit: str
    per_si: float   # value in unit = per_si * value of the column
    noise: float
    against: str = ""
    at: tuple = ()  # places; empty: the last value


@dataclasses.dataclass
class Rig:
    readings: list
    parameters: list  # of the study: what is uncertain, with priors
    roles: dict = dataclasses.field(default_factory=dict)
    effects: list = dataclasses.field(default_factory=list)  # what the study says of effects: the same for every truth


def parameter(name, mean, sd, low, high, *pointers, unit="1"):
    return {"name": name, "unit": unit, "range": [low, high], "prior": {"normal": {"mean": mean, "sd": sd}},
            "set": list(pointers)}


GRAINS = parameter("friction", 0.5, 0.05, 0.25, 0.75, "/contacts/0/parameters/friction")
WALLS = parameter("wall friction", 0.35, 0.04, 0.15, 0.55, "/contacts/1/parameters/friction")
ROLLING = parameter("rolling friction", 0.1, 0.02, 0.02, 0.2, "/contacts/0/parameters/rolling_friction")
DENSITY = parameter("grain density", 2017, 10, 1950, 2080, "/materials/powder/density", unit="kg/m^3")

# Grains of 0.4 of their size make runs 40 times as long, so that changes of size are tried weaker than usual.
SIZES = [{"effect": "calx.coarse-grain", "scale": 0.12}, {"effect": "calx.attrition", "scale": 0.1}]
# A run takes half a second, so that drifts and lags of a plant are scaled to that, in each study alike.
CELL = [{"effect": "calx.load-cell-drift", "scale": {"gain_rate": 0.05, "zero_rate": 0.004}},
        {"effect": "calx.load-cell-lag", "scale": 0.02}, {"effect": "calx.load-cell-gain", "scale": 0.03},
        {"effect": "calx.load-cell-tare", "scale": 0.0005},
        {"effect": "calx.vibration-pickup", "scale": 0.0005}]

RIGS = {
    "valve": Rig(
        [Reading("mass in the canister", "load-cell", "cell", "mass_kg", "g", 1e3, 0.06, "time_s",
                 (0.27, 0.3, 0.32, 0.34, 0.36, 0.38, 0.41, 0.44, 0.46, 0.48, 0.51, 0.56)),
         Reading("mass left in the throat", "load-cell", "throat", "mass_kg", "g", 1e3, 0.06, "time_s",
                 (0.2, 0.24, 0.28, 0.32, 0.36, 0.4, 0.46, 0.55)),
         Reading("centre of the bed across", "other", "bed", "x_m", "mm", 1e3, 0.2),
         Reading("centre of the bed, height", "other", "bed", "z_m", "mm", 1e3, 0.1)],
        [GRAINS, WALLS], {"cell": "cell", "region": "region", "canister": "canister", "nozzle": "nozzle"},
        SIZES + CELL + [{"effect": "calx.nozzle-lip", "scale": 0.006,
                 "parameters": {"bore_radius": 0.027, "x": 0.0577, "z": 0.475}}]),
    "hopper": Rig(
        [Reading("mass in the hopper", "hopper-discharge", "cell", "mass_kg", "g", 1e3, 0.06, "time_s",
                 (0.21, 0.24, 0.27, 0.3, 0.33, 0.36, 0.4, 0.44, 0.48, 0.53, 0.59)),
         Reading("mass received", "load-cell", "received", "mass_kg", "g", 1e3, 0.06, "time_s",
                 (0.3, 0.32, 0.34, 0.36, 0.4, 0.46))],
        [GRAINS, WALLS], {"cell": "cell", "region": "region"}, SIZES + CELL),
    "pile": Rig(
        [Reading("surface", "pile-profile", "surface", "height_m", "mm", 1e3, 0.2, "x_m",
                 (-0.0315, -0.0225, -0.0135, -0.0045, 0.0045, 0.0135, 0.0225, 0.0315)),
         Reading("mean height", "fill-height", "surface", "height_mean_m", "mm", 1e3, 0.1)],
        [GRAINS, ROLLING], {"canister": "canister"}, SIZES[1:] + [{"effect": "calx.canister-tilt", "scale": 4}]),
    "drum": Rig(
        [Reading("surface of the bed", "dynamic-angle", "surface", "height_m", "mm", 1e3, 0.1, "u_m",
                 (-0.0175, -0.0145, -0.0115, -0.0085, -0.0055, -0.0025, 0.0005, 0.0035, 0.0065, 0.0095, 0.0125)),
         Reading("slope of the surface", "dynamic-angle", "surface", "angle_deg", "deg", 1, 0.3),
         Reading("dark share", "bulk-density", "surface", "fill_1", "1", 1, 0.001)],
        [GRAINS, WALLS], {}, SIZES[1:]),
    "bed": Rig(
        [Reading("density pressed", "compressibility", "compression", "density_kg_m3", "kg/m^3", 1, 2, "step_1",
                 (1, 2, 3, 4, 5, 6)),
         Reading("height of the bed at the end", "fill-height", "compression", "height_m", "mm", 1e3, 0.05)],
        [GRAINS, ROLLING, DENSITY], {}, SIZES[1:]),
}


def load_case(path):
    """A case with what it extends, as one object."""
    text = re.sub(r"^\s*//.*$", "", pathlib.Path(path).read_text(encoding="ascii"), flags=re.MULTILINE)
    case = json.loads(text)
    if "extends" in case:
        base = load_case(pathlib.Path(path).parent / case.pop("extends"))
        base.update(case)
        case = base
    return case


def at(case, pointer):
    """The list or object that holds the last key of a JSON pointer, and that key."""
    *way, last = pointer.strip("/").split("/")
    for key in way:
        case = case[int(key)] if isinstance(case, list) else case[key]
    return case, int(last) if isinstance(case, list) else last


def put(case, pointer, value):
    holder, key = at(case, pointer)
    holder[key] = value


def entry(case, section, name):
    """The object called so in a list of the case."""
    return next(e for e in case[section] if e["name"] == name)


def run(calx, case, folder, seed):
    """Runs a case, given as an object."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "world.json").write_text(json.dumps(case), encoding="ascii")
    subprocess.run([calx, "run", folder / "world.json", "-o", folder / "out", "--seed", str(seed), "--threads", "1",
                    "--no-report", "--quiet", "--overwrite"], check=True)
    return folder / "out"


def series(folder, sensor):
    """{column: values} of a sensor."""
    with open(pathlib.Path(folder) / "series" / f"{sensor}.csv", encoding="ascii") as file:
        names, *rows = list(csv.reader(file))
    return {name: [float(row[k]) for row in rows] for k, name in enumerate(names)}


def curve(folder, reading):
    """x and y of a reading, both SI."""
    columns = series(folder, reading.sensor)
    if reading.against in columns and reading.column in columns:
        return columns[reading.against], columns[reading.column]
    for c in json.loads((pathlib.Path(folder) / "fields.json").read_text(encoding="utf-8"))["curves"]:
        if (c["sensor"], c["x_name"], c["y_name"]) == (reading.sensor, reading.against, reading.column):
            return c["x"], c["y"]
    raise KeyError(f"{reading.sensor}: no {reading.column} against {reading.against}")


def between(xs, ys, x):
    """Linear between the points; the value of the first point that stands at x. The last sample of a run may stand a little
    before its end, so that half an interval beyond the ends counts as the end."""
    for k, here in enumerate(xs):
        if here == x:
            return ys[k]
        if k and xs[k - 1] < x < here:
            return ys[k - 1] + (ys[k] - ys[k - 1]) * (x - xs[k - 1]) / (here - xs[k - 1])
    for end, next_to_it in ((0, 1), (-1, -2)):
        if abs(x - xs[end]) <= 0.5 * abs(xs[end] - xs[next_to_it]):
            return ys[end]
    raise ValueError(f"{x} lies outside of {xs[0]} to {xs[-1]}")


def read(folder, reading, instrument=None):
    """Numbers of a reading in its unit. instrument: what a faulty instrument makes of a series, f(times, values)."""
    if not reading.at:
        return [reading.per_si * series(folder, reading.sensor)[reading.column][-1]]
    xs, ys = curve(folder, reading)
    if instrument:
        ys = instrument(xs, ys)
    return [reading.per_si * between(xs, ys, x) for x in reading.at]
