"""What the tests of the program share: small cases, running calx, comparing the folders of two runs."""
import copy
import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CALX = os.environ["CALX"]
PLUGINS = pathlib.Path(os.environ["CALX_PLUGINS"])
SOURCE = pathlib.Path(os.environ["CALX_SOURCE"])

USAGE, CASE, PLUGIN, NUMERICS, FILES, INTERRUPTED = 2, 3, 4, 5, 6, 130

LAW = {"restitution": 0.5, "friction": 0.4}
EPAM = dict(LAW, plasticity=0.4, surface_energy=0.1)

# Balls fall into an open box: 0.05 s, some 3000 steps.
CUP = {
    "calx": 1, "title": "balls in a cup",
    "domain": {"min": [-0.05, -0.05, -0.01], "max": [0.05, 0.05, 0.2]},
    "time": {"end": 0.05},
    "energy": True,
    "materials": {"glass": {"density": 2500, "young": 1e7, "poisson": 0.25},
                  "steel": {"density": 7850, "young": 1e8, "poisson": 0.3}},
    "contacts": [{"between": ["glass", "glass"], "law": "calx.hertz-mindlin", "parameters": LAW},
                 {"between": ["glass", "steel"], "law": "calx.hertz-mindlin", "parameters": LAW}],
    "shapes": {"ball": {"sphere": {"radius": 0.002}}},
    "regions": {"cup": {"box": {"min": [-0.02, -0.02, 0], "max": [0.02, 0.02, 0.1]}}},
    "sources": [{"name": "pour", "shape": "ball", "material": "glass", "count": 60,
                 "region": {"box": {"min": [-0.015, -0.015, 0.003], "max": [0.015, 0.015, 0.05]}}}],
    "parts": [{"name": "cup", "geometry": "calx.box", "material": "steel",
               "parameters": {"min": [-0.02, -0.02, 0], "max": [0.02, 0.02, 0.1], "open_top": "yes"}}],
    "sensors": [{"name": "in cup", "kind": "mass", "region": "cup", "every": 0.005},
                {"name": "energy", "kind": "energy", "every": 0.01}],
    "output": {"frames_every": 0.01, "checkpoint_every": 0.01},
    "assumptions": ["every value is made up"],
}


def cup(changes=None):
    """CUP with some values replaced: {"/time/end": 0.1}; None takes a key away."""
    case = copy.deepcopy(CUP)
    for pointer, value in (changes or {}).items():
        here = case
        *way, last = pointer.strip("/").split("/")
        for key in way:
            here = here[int(key)] if isinstance(here, list) else here.setdefault(key, {})
        if value is None:
            del here[last]
        else:
            here[int(last) if isinstance(here, list) else last] = value
    return case


def needs(plugin):
    """Leaves the test out where the build has no such plugin: any folder of plugins/ may be deleted."""
    for path in PLUGINS.glob("*.plugin.json"):
        if any(p["id"] == plugin for p in json.loads(path.read_text())["plugins"]):
            return
    raise unittest.SkipTest(f"there is no plugin {plugin}")


def busy():
    """Nearly everything that a run has to remember: two materials, clumps, a rate, plastic contacts with history, a part
    that an event sets in motion, a force, a part that vanishes, particles that leave, sensors with windows."""
    needs("calx.epam")
    case = cup({"/time/end": 0.25, "/title": "everything at once", "/domain/on_leave": "delete",
                "/output": {"frames_every": 0.0103, "checkpoint_every": 0.003, "checkpoint_every_wall": 0}})
    case["contacts"] = [{"between": ["glass", other], "law": "calx.epam", "parameters": EPAM} for other in ("glass", "steel")]
    case["shapes"]["pair"] = {"spheres": [{"at": [0, 0, -0.0008], "radius": 0.0015}, {"at": [0, 0, 0.0008], "radius": 0.0015}]}
    case["sources"][0]["size"] = {"distribution": "uniform", "lowest": 0.8, "highest": 1.0}
    case["sources"].append({"name": "rain", "shape": "pair", "material": "glass", "mass": 0.004, "rate": 0.06,
                            "velocity": [0.2, 0, -0.6], "when": "stirred",
                            "region": {"box": {"min": [-0.012, -0.012, 0.08], "max": [0.012, 0.012, 0.1]}}})
    case["sources"].append({"name": "stray", "shape": "pair", "material": "glass",
                            "positions": [[0.03, 0, 0.1], [0.03, 0.01, 0.1], [-0.03, 0, 0.1]],
                            "velocities": [[1, 0, 0], [0.5, 0, 1], [0.3, 0, 0]]})
    case["parts"].append({"name": "paddle", "geometry": "calx.plane", "material": "steel", "motion": "stir",
                          "parameters": {"point": [0, 0, 0.015], "normal": [0, 1, 0], "half_u": 0.01, "half_v": 0.01}})
    case["parts"].append({"name": "lid", "geometry": "calx.plane", "material": "steel", "vanishes": "opened",
                          "parameters": {"point": [0, 0, 0.07], "half_u": 0.008, "half_v": 0.008}})
    case["motions"] = {"stir": {"plugin": "calx.reciprocate", "start": "stirred",
                                "parameters": {"origin": [0, 0, 0], "axis": [0, 0, 1], "swing_deg": 180, "stroke": 0.02,
                                               "dwell": 0.005}}}
    case["events"] = {"stirred": {"when": {"time": 0.0201}},
                      "opened": {"when": {"any": [{"settled": {"region": "cup", "hold": 0.01}}, {"time": 0.06}]}}}
    case["forces"] = [{"plugin": "calx.stokes-drag", "parameters": {"fluid_velocity": [3, 0, 4]}}]
    case["sensors"] += [{"name": "turns", "kind": "cycle-mass", "region": "cup", "motion": "stir", "every": 0.01},
                        {"name": "stream", "kind": "flow", "point": [0, 0, 0.04], "normal": [0, 0, -1], "every": 0.004},
                        {"name": "neighbours", "kind": "coordination", "region": "cup", "every": 0.007},
                        {"name": "push", "kind": "part-load", "part": "paddle", "every": 0.002}]
    return case


class Result:
    def __init__(self, done):
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr


class CalxTest(unittest.TestCase):
    """A test in a folder of its own, which is gone afterwards."""

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="calx_outside_"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def write(self, case, name="case.json"):
        path = self.dir / name
        path.write_text(case if isinstance(case, str) else json.dumps(case, indent=1), encoding="utf-8")
        return path

    def calx(self, *words, plugins=None, **options):
        """Runs calx in the test's folder. plugins: the folders to search instead of those of the build."""
        program = CALX
        if plugins is not None:
            # Plugins beside the program are always searched, so the program stands elsewhere.
            program = self.dir / "bin" / "calx"
            program.parent.mkdir(exist_ok=True)
            if not program.exists():
                shutil.copy(CALX, program)
            words = (*words, *(w for p in plugins for w in ("--plugin-path", p)))
        env = {k: v for k, v in os.environ.items() if k not in ("CALX_PLUGIN_PATH", "XDG_DATA_HOME")}
        env.update(HOME=str(self.dir), OMP_NUM_THREADS="2", **options.pop("env", {}))
        return Result(subprocess.run([str(w) for w in (program, *words)], cwd=self.dir, env=env, text=True, timeout=120,
                                     stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options))

    def runs(self, *words, **options):
        """calx run that ends well, with one thread unless told otherwise."""
        if "--threads" not in words:
            words += ("--threads", 1)
        result = self.calx("run", *words, "--no-report", **options)
        self.assertEqual(result.code, 0, result.err)
        return result

    def fails(self, code, *texts, result):
        """The exit code, and every text in the message, which is one line that begins with the program's name."""
        self.assertEqual(result.code, code, result.out + result.err)
        line = result.err.strip().split("\n")[-1]
        self.assertTrue(line.startswith("calx: "), result.err)
        for text in texts:
            self.assertRegex(line, text)
        self.assertNotIn("terminate called", result.err)
        return line

    def refuses(self, code, case, *texts):
        """calx run and calx check of a case that is wrong: the same message, and nothing of a run written."""
        path = self.write(case)
        checked = self.fails(code, *texts, result=self.calx("check", path.name))
        self.assertEqual(self.fails(code, *texts, result=self.calx("run", path.name, "-o", "out")), checked)
        return checked

    def summary(self, folder="case.out"):
        return json.loads((self.dir / folder / "summary.json").read_text())

    def rows(self, sensor, folder="case.out"):
        with open(self.dir / folder / "series" / f"{sensor}.csv", encoding="ascii") as file:
            return list(csv.reader(file))


def datasets(path):
    """{name: (type, shape, bytes)} of every dataset of an HDF5 file."""
    import h5py  # pylint: disable=import-outside-toplevel
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            value = item[()]
            found[name] = (str(item.dtype), item.shape, value.tobytes() if hasattr(value, "tobytes") else value)

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found


def differences(a, b):
    """Names of datasets that differ between two HDF5 files, at least in one bit."""
    one, two = datasets(a), datasets(b)
    assert one, f"{a} holds nothing"
    return sorted(name for name in {*one, *two} if one.get(name) != two.get(name))


if __name__ == "__main__":
    unittest.main()
