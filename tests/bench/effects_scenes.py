"""effects_scenes.py: what is read from the folder of a run of effects_cases/SCENE.json, and how the sleepers are counted.

An observable is (name, unit, function of a Run, features): features names those whose table shows it; empty: all. Times are
those of the cases: when the gate opens, when a portion has settled, and so on."""
import csv
import json
import math
import pathlib

GRAVITY = 9.81  # m/s^2, of every case
FEATURES = {"precision": ["--precision", "mixed"], "rest": ["--set", "/rest={}"]}


class Run:
    """The folder of a finished run."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.summary = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        self.read = {}

    def series(self, sensor):
        """{column: values} of series/SENSOR.csv."""
        if sensor not in self.read:
            with open(self.folder / "series" / f"{sensor}.csv", encoding="ascii") as file:
                names, *rows = list(csv.reader(file))
            self.read[sensor] = {name: [float(row[k]) for row in rows] for k, name in enumerate(names)}
        return self.read[sensor]

    def last(self, sensor, column):
        return self.series(sensor)[column][-1]

    def at(self, sensor, column, time):
        """Linear between the rows."""
        t, y = self.series(sensor)["time_s"], self.series(sensor)[column]
        k = next((k for k in range(1, len(t)) if t[k] >= time), len(t) - 1)
        return y[k - 1] + (y[k] - y[k - 1]) * (time - t[k - 1]) / (t[k] - t[k - 1])

    def mean(self, sensor, column, start, end=math.inf):
        """Mean of the rows from start to end; a negative start counts from the end of the run."""
        rows = self.series(sensor)
        start += self.summary["time"] if start < 0 else 0
        values = [y for t, y in zip(rows["time_s"], rows[column]) if start < t <= end]
        return sum(values) / len(values)

    def weight(self):
        return self.summary["mass"]["inserted"] * GRAVITY

    def asleep(self):
        """Share of all particle-steps that sleepers make up, largest share at one time, share at the end. A sleeper has no
        velocity at all, which moving grains never have; frames are equally far apart in time."""
        import h5py  # pylint: disable=import-outside-toplevel
        with h5py.File(self.folder / "particles.h5", "r") as file:
            group = file["particles/spheres"]
            still, there = [], []
            for count, velocity in zip(group["count/value"][:], group["velocity/value"][:]):
                still.append(int((velocity[:int(count)] == 0).all(axis=1).sum()))
                there.append(int(count))
        # At time 0 nothing moves and nobody sleeps.
        still, there = still[1:], there[1:]
        shares = [a / b for a, b in zip(still, there) if b]
        return {"steps_skipped": sum(still) / sum(there), "most": max(shares), "at_the_end": shares[-1]}


def remainder(run):
    """Percent of the work done that the energy ledger does not account for."""
    return 100 * run.last("energy", "remainder_J") / run.last("energy", "work_done_J")


def lost(run):
    """Energy lost in contacts, mJ."""
    return 1e3 * sum(run.last("energy", name) for name in ("friction_J", "damping_J", "plastic_J"))


def still(run):
    """log10 of the kinetic energy at the end, mean of 0.05 s, over what lifts the bed by a radius of 1.25 mm."""
    kinetic = sum(run.mean("energy", f"kinetic_{kind}_J", -0.05) for kind in ("translation", "rotation"))
    return math.log10(max(kinetic / (run.weight() * 0.00125), 1e-20))


def discharged(after):
    """Grams out of the hopper so long after the gate vanished."""
    return lambda run: 1e3 * (run.at("hopper mass", "mass_kg", 0.35) - run.at("hopper mass", "mass_kg", 0.35 + after))


def rate(run):
    """g/s between a quarter and three quarters of what leaves the hopper."""
    rows = run.series("hopper mass")
    start, end = run.at("hopper mass", "mass_kg", 0.35), rows["mass_kg"][-1]
    times = []
    for share in (0.25, 0.75):
        level = start - share * (start - end)
        k = next(k for k, (t, m) in enumerate(zip(rows["time_s"], rows["mass_kg"])) if t > 0.35 and m <= level)
        before, after = rows["mass_kg"][k - 1], rows["mass_kg"][k]
        step = rows["time_s"][k] - rows["time_s"][k - 1]
        times.append(rows["time_s"][k - 1] + (before - level) / (before - after) * step)
    return 1e3 * 0.5 * (start - end) / (times[1] - times[0])


def lean(run):
    """Degrees by which the centre of the drum's bed hangs off the vertical, mean while it turns."""
    rows = run.series("bed")
    angles = [math.degrees(math.atan2(-x, -z)) for t, x, z in zip(rows["time_s"], rows["centre_x_m"], rows["centre_z_m"])
              if t > 0.8]
    return sum(angles) / len(angles)


def cycle(number):
    """Grams the canister gained in a cycle of the valve."""
    def found(run):
        rows = run.series("dispensed")
        return 1e3 * next(m for c, m in zip(rows["cycle_1"], rows["mass_kg"]) if c == number)
    return found


def torque(run):
    """Mean size of the torque about the rotor's axis while it turns to and fro, N m."""
    rows = run.series("rotor load")
    values = [abs(m) for t, m in zip(rows["time_s"], rows["torque_y_N_m"]) if 0.36 < t <= 3.3]
    return sum(values) / len(values)


def load(part, axis, start, end=math.inf):
    """Mean load on a part, mN."""
    return lambda run: 1e3 * run.mean(f"{part} load", f"force_{axis}_N", start, end)


def last(sensor, column, scale=1.0):
    return lambda run: scale * run.last(sensor, column)


ENERGY = [("energy lost in contacts", "mJ", lost, ()), ("ledger remainder, of the work", "%", remainder, ())]
# Sleepers have none at all.
KINETIC = ("kinetic energy at rest, log10", "m g r", still, ("precision",))

SCENES = {
    "gas": [
        ("sum of energies, change", "ppm",
         lambda run: 1e6 * run.last("energy", "remainder_J") / run.last("energy", "inserted_J"), ()),
        ("kinetic energy, mean", "mJ", lambda run: 1e3 * run.mean("energy", "kinetic_translation_J", 0.2), ())],
    "bed": [
        ("bulk density", "kg/m3", lambda run: run.mean("bulk density", "density_kg_m3", 0.5), ()),
        ("coordination number", "1", lambda run: run.mean("coordination", "coordination_1", 0.5), ()),
        ("height of the centre", "mm", last("all", "centre_z_m", 1e3), ()),
        ("load on the floor, of the weight", "1", lambda run: -run.mean("floor load", "force_z_N", 0.5) / run.weight(), ()),
        KINETIC, *ENERGY],
    "hopper": [
        *((f"discharged {after} s after opening", "g", discharged(after), ()) for after in (0.1, 0.2, 0.3)),
        ("discharge rate, middle half", "g/s", rate, ()),
        ("retained", "g", last("hopper mass", "mass_kg", 1e3), ()),
        ("angle of the retained wedge", "deg", last("wedge", "angle_deg"), ()),
        ("load on the floor at the end", "mN", load("floor", "z", -0.2), ()), *ENERGY],
    "pile": [
        ("angle of repose", "deg", last("angle", "angle_deg"), ()),
        ("height of the apex", "mm", last("angle", "apex_z_m", 1e3), ()),
        ("height of the centre", "mm", last("pile mass", "centre_z_m", 1e3), ()),
        ("load on the floor, of the weight", "1", lambda run: -run.mean("floor load", "force_z_N", 1.6) / run.weight(), ()),
        KINETIC, *ENERGY],
    "drum": [
        ("lean of the bed", "deg", lean, ()),
        ("torque on the drum", "mN m", lambda run: 1e3 * run.mean("drum load", "torque_y_N_m", 0.8), ()),
        ("kinetic energy", "uJ", lambda run: 1e6 * run.mean("energy", "kinetic_translation_J", 0.8), ()), *ENERGY],
    "silo": [
        *((f"{name}, portion {n}", "mN", load(part, axis, end - 0.1, end), ())
          for name, part, axis in (("floor", "floor", "z"), ("side wall", "left", "x"))
          for n, end in ((1, 0.44), (2, 0.89), (3, 1.5))),
        ("all walls, vertical", "mN", lambda run: load("left", "z", 1.4)(run) + load("walls", "z", 1.4)(run), ()),
        ("bulk density", "kg/m3", lambda run: run.mean("bulk density", "density_kg_m3", 1.4), ()),
        ("coordination number", "1", lambda run: run.mean("coordination", "coordination_1", 1.4), ()),
        ("height of the centre", "mm", last("bed", "centre_z_m", 1e3), ()),
        KINETIC, *ENERGY],
    "canister": [
        *((f"mass of cycle {n}", "g", cycle(n), ()) for n in (1, 2, 3)),
        ("mass at the end", "g", last("canister mass", "mass_kg", 1e3), ()),
        ("angle of the pile", "deg", last("angle", "angle_deg"), ()),
        ("centre of the pile, x", "mm", last("canister mass", "centre_x_m", 1e3), ()),
        ("centre of the pile, z over the floor", "mm", lambda run: 1e3 * (run.last("canister mass", "centre_z_m") - 0.405), ()),
        ("floor", "mN", load("floor", "z", -0.15), ()),
        ("right wall, across", "mN", load("right", "x", -0.15), ()),
        ("all walls, vertical", "mN", lambda run: load("right", "z", -0.15)(run) + load("walls", "z", -0.15)(run), ()),
        ("torque on the rotor, mean size", "mN m", lambda run: 1e3 * torque(run), ()), *ENERGY],
}
