"""hidden.py: the worlds of the tier: what is hidden in which rig, how strong, and in which form.

A world differs from the case of its study in every run: smaller time step, grains of several sizes, another restitution and
form of rolling resistance, parameters drawn from their priors, other seeds. Strengths are such that signal over noise after
recalibration is 3 and more, as in the cheap tier. The form of an effect differs from that of the
library wherever a case can say so."""
import copy
import dataclasses
import math
import typing

from rigs import entry


@dataclasses.dataclass
class Hidden:
    name: str
    rig: str
    truth: tuple                                # ids of effects; empty: nothing, or nothing in the library
    low: float = 0                              # strength, drawn log-uniformly
    high: float = 0
    edit: typing.Callable = None                # edit(case, strength)
    instrument: typing.Callable = None          # instrument(strength) -> f(times, values), on the sensor called cell
    kind: str = "effect"                        # effect, control, outside, pair
    form: str = ""                              # how the world differs from the library's formula
    low2: float = 0                             # of the second effect of a pair
    high2: float = 0


def effect(case, name, **parameters):
    case.setdefault("effects", []).append({"effect": name, "parameters": parameters})


def leak(case, gap):
    """Less room at the tips, more at the plates."""
    rotor, housing = entry(case, "parts", "rotor"), entry(case, "parts", "housing")
    rotor["parameters"]["outer_radius"] = 0.025 - 0.7 * gap
    housing["parameters"]["length"] += 2.8 * gap


def blocked(case, share):
    effect(case, "calx.blocked-pocket", share=share, pocket=0)


def opening(case, shortfall):
    motion = case["motions"]["motion"]["parameters"]
    motion["angle_to_deg"] -= shortfall
    motion["duration"] *= 1.1


def timing(case, offset):
    effect(case, "calx.valve-timing", offset_deg=offset)


def lip(case, width):
    """A tube in place of the ring: the bore is narrower over 3 mm of its length."""
    case["parts"].append({"name": "gasket", "geometry": "calx.cylinder", "material": "steel",
                          "parameters": {"from": [0.0577, 0, 0.4735], "to": [0.0577, 0, 0.4765], "radius": 0.027 - width}})
    effect(case, "calx.nozzle-lip", width=width, bore_radius=0.027, x=0.0577, z=0.4765)


def two_poles(lag):
    """Two first-order lags in a row, of 0.7 and 0.3 of the sum."""
    def pole(times, values, tau):
        out = [values[0]]
        for k in range(1, len(times)):
            keep = math.exp(-(times[k] - times[k - 1]) / tau)
            out.append(keep * out[-1] + (1 - keep) * 0.5 * (values[k - 1] + values[k]))
        return out
    return lambda times, values: pole(times, pole(times, values, 0.7 * lag), 0.3 * lag)


def bent_gain(error):
    """A gain error that is a tenth larger at the upper end."""
    return lambda times, values: [v * (1 + error * (0.95 + 0.1 * v / 0.01)) for v in values]


def warming(rate):
    """The zero runs away fast at first, as electronics that warm up: time constant 0.8 s."""
    return lambda times, values: [v + rate * 0.8 * (1 - math.exp(-t / 0.8)) for t, v in zip(times, values)]


def moisture(case, tension):
    """Grows over 0.3 s instead of being there at once."""
    effect(case, "calx.moisture-cohesion", tension=tension, time=0.3)


def rolling(case, friction):
    """More of the base law's rolling resistance, in its own form."""
    case["contacts"][0]["parameters"]["rolling_friction"] += friction


def drag(case, viscosity):
    """The drag of Schiller and Naumann on the coarse grain, its viscosity such that both agree at low speed."""
    radius = case["shapes"]["grain"]["sphere"]["radius"]
    case["forces"] = [{"plugin": "calx.stokes-drag",
                       "parameters": {"viscosity": viscosity * (2 * radius / 1e-4) ** 2, "fluid_density": 10,
                                      "correction": "schiller-naumann"}}]


def smaller(case, loss):
    case["shapes"]["grain"]["sphere"]["radius"] *= 1 - loss


def tilt(case, angle):
    effect(case, "calx.canister-tilt", tilt_deg=angle, azimuth_deg=0)


def plastic(case, plasticity):
    """The law of Edinburgh instead of a Hertzian one with a correction."""
    pair = case["contacts"][0]
    parameters = pair["parameters"]
    parameters.update(plasticity=plasticity, exponent="1.5")
    pair["law"] = "calx.epam"


def sticking_flap(case, angle):
    """The flap opens, falls shut half-way through the run and opens again."""
    rows = [[0, 0, 0], [0.05, 90, 0], [0.16, 90, 0], [0.2, angle, 0], [0.3, angle, 0], [0.34, 90, 0]]
    old = case["motions"]["motion"]
    case["motions"]["motion"] = {"plugin": "calx.motion-table", "start": old["start"],
                                 "parameters": {"origin": old["parameters"]["origin"], "axis": old["parameters"]["axis"],
                                                "rows_deg": rows, "curve": "linear"}}


def moved_nozzle(case, shift):
    """A baffle has come loose and lies under one half of the outlet."""
    case["parts"].append({"name": "baffle", "geometry": "calx.plane", "material": "steel",
                          "parameters": {"point": [0.0577 - 0.021, 0, 0.468], "normal": [0.64, 0, 0.77], "half_u": shift,
                                         "half_v": 0.02}})


STUDIES = [
    Hidden("leak", "valve", ("calx.rotor-leak",), 0.0028, 0.0045, leak, form="tips 0.7, plates 1.4 of the gap"),
    Hidden("tilt", "pile", ("calx.canister-tilt",), 10, 16, tilt, form="the library's"),
    Hidden("control_valve", "valve", (), kind="control"),
    Hidden("lag", "valve", ("calx.load-cell-lag",), 0.02, 0.05, instrument=two_poles, form="two poles"),
    Hidden("plasticity", "bed", ("calx.contact-plasticity",), 0.3, 0.6, plastic, form="calx.epam"),
    Hidden("rolling", "drum", ("calx.rolling-resistance",), 0.03, 0.07, rolling, form="the base law's own"),
    Hidden("coarse_grain", "hopper", ("calx.coarse-grain", "calx.attrition"), 0.2, 0.35, smaller, form="the library's"),
    Hidden("control_hopper", "hopper", (), kind="control"),
    Hidden("gain", "valve", ("calx.load-cell-gain",), 0.08, 0.15, instrument=bent_gain, form="a tenth more at the upper end"),
    Hidden("blocked", "valve", ("calx.blocked-pocket",), 0.4, 0.75, blocked, form="the library's"),
    Hidden("drag", "hopper", ("calx.powder-drag",), 5e-6, 1e-5, drag, form="Schiller and Naumann"),
    Hidden("moisture", "hopper", ("calx.moisture-cohesion",), 0.04, 0.1, moisture, form="grows over 0.3 s"),
    Hidden("opening", "valve", ("calx.butterfly-opening",), 35, 50, opening, form="slower by a tenth, too"),
    Hidden("control_pile", "pile", (), kind="control"),
    Hidden("drift", "valve", ("calx.load-cell-drift",), 0.005, 0.01, instrument=warming, form="levels off within 0.8 s"),
    Hidden("lip", "valve", ("calx.nozzle-lip",), 0.01, 0.015, lip, form="3 mm long"),
    Hidden("attrition", "bed", ("calx.attrition", "calx.coarse-grain"), 0.2, 0.35, smaller, form="the library's"),
    Hidden("timing", "valve", ("calx.valve-timing",), 18, 30, timing, form="the library's"),
    Hidden("control_drum", "drum", (), kind="control"),
    Hidden("outside_flap", "valve", (), 20, 35, sticking_flap, kind="outside", form="the flap falls shut for 0.1 s"),
    Hidden("outside_baffle", "valve", (), 0.012, 0.018, moved_nozzle, kind="outside", form="a loose baffle under the outlet"),
    Hidden("pair", "valve", ("calx.rotor-leak", "calx.load-cell-gain"), 0.003, 0.0045, leak, bent_gain, kind="pair",
           form="as alone", low2=0.08, high2=0.15),
]


def world_of(hidden, base, rng, parameters):
    """The case of a world, its strengths and the values of its uncertain parameters."""
    case = copy.deepcopy(base)
    values = {p["name"]: rng.gauss(p["prior"]["normal"]["mean"], p["prior"]["normal"]["sd"]) for p in parameters}
    case["time"]["step"] *= rng.uniform(0.6, 0.75)
    for contact in case["contacts"]:
        contact["parameters"]["restitution"] = rng.uniform(0.3, 0.5)
        contact["parameters"]["rolling"] = "epsd2"
    width = rng.uniform(0.04, 0.1)
    for source in case["sources"]:
        source["size"] = {"distribution": "uniform", "lowest": 1 - width, "highest": 1 + width}
    strengths = [math.exp(rng.uniform(math.log(a), math.log(b)))
                 for a, b in ((hidden.low, hidden.high), (hidden.low2, hidden.high2)) if a > 0]
    return case, strengths, values
