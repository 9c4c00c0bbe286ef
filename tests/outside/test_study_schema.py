"""The JSON Schema of studies and the reader agree: what one takes or refuses, the other does, too."""
import json
import pathlib
import re
import sys
import unittest

from calx import CASE, SOURCE, CalxTest, cup
from test_bad_study import CURVE, STUDY, changed

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

NORMAL = {"normal": {"mean": 0.4, "sd": {"value": 10, "unit": "%"}}}
# Every key of a study stands in one of these.
FULL = {
    **STUDY, "$schema": "study.schema.json", "seed": 3, "assumptions": ["all of it"], "library": "calx", "roles": {"cell": "in cup"},
    "effects": [{"effect": "calx.load-cell-lag", "on": {"cell": "in cup"}, "parameters": {}, "scale": {"lag": 0.1}, "cases": ["cup"]}],
    "experiments": [{"name": "again", "cost": 2, "case": "cup", "sensor": "in cup", "column": "mass_kg", "against": "time_s",
                     "at": [0.002], "unit": "g", "sd": 0.1, "tolerance": 0.05},
                    {"name": "weight", "known_load": {"sensor": "in cup", "time_s": [0, 1], "value": [1, 1]}, "at": [0.5], "sd": 0.001}],
    "claims": [{"effect": "calx.load-cell-lag", "observable": "mass", "simulation": "lacks it", "says": "the cell is slow"}],
    "executor": {"kind": "local", "jobs": 2, "options": ["--time=60"]},
    "cases": {"cup": {"case": "case.json", "set": {"/time/end": 0.01}, "reduced": "case.json", "reduced_tolerance": 0.2}},
    "parameters": [{**STUDY["parameters"][0], "prior": NORMAL, "cases": ["cup"]}, {**STUDY["parameters"][1], "prior": "uniform"}],
    "observables": [
        {**STUDY["observables"][0], "use": "fit", "tolerance": 0.1, "conditions": {"fill": 1}, "simulated": {"value": 4.1, "sd": 0.1},
         "measured": {"value": 4.0, "sd": 0.1, "relative": 0.01, "repeats": 3}},
        {**STUDY["observables"][1], "measured": {**STUDY["observables"][1]["measured"], "autocorrelation": 0.3}},
        {**STUDY["observables"][1], "name": "elsewhere", "simulated": {"values": [4.0, 4.1]}},
        {**STUDY["observables"][1], "name": "places", "at": [{"value": 2, "unit": "ms"}, 0.006],
         "measured": {"values": [4.0, 4.1], "sd": 0.1}},
        {"name": "scan", "kind": "pile-profile", "case": "cup", "sensor": "surface", "field": "height", "unit": "mm",
         "measured": {"file": "scan.csv", "x": "x_mm", "y": "y_mm", "z": "z_mm", "repeat": "run"}}],
    "generic_terms": ["drag", {"name": "own", "on": "grain pull", "formula": "time", "scale": 0.1}]}


def keys_of_schema(schema):
    """All property names of a schema, by the description of their object."""
    found = {}
    if isinstance(schema, dict):
        if "properties" in schema:
            found.setdefault(schema.get("description", "value and unit"), set()).update(schema["properties"])
        for item in schema.values():
            for name, keys in keys_of_schema(item).items():
                found.setdefault(name, set()).update(keys)
    elif isinstance(schema, list):
        for item in schema:
            for name, keys in keys_of_schema(item).items():
                found.setdefault(name, set()).update(keys)
    return found


def keys_of(value):
    if isinstance(value, dict):
        yield from value
        for item in value.values():
            yield from keys_of(item)
    elif isinstance(value, list):
        for item in value:
            yield from keys_of(item)


class Schema(CalxTest):
    def setUp(self):
        super().setUp()
        case = cup()
        case["sensors"].append({"name": "surface", "kind": "height-map", "region": "cup", "cell": 0.002, "every": 0.01})
        self.write(case)
        (self.dir / "scan.csv").write_text("run,x_mm,y_mm,z_mm\n" + "".join(
            f"{run},{x},{y},{run + x + y}\n" for run in (1, 2) for x in range(-3, 4) for y in range(-3, 4)))
        (self.dir / "curve.csv").write_text(CURVE)
        printed = self.calx("calibrate", "--print-schema")
        self.assertEqual((printed.code, printed.err), (0, ""))
        self.schema = json.loads(printed.out)
        jsonschema.Draft202012Validator.check_schema(self.schema)
        self.valid = jsonschema.Draft202012Validator(self.schema).is_valid

    def read(self, study):
        """What the reader says of a study whose budget is too small to run anything."""
        self.write({**study, "budget": {"runs": 4}} if study.get("budget") == STUDY["budget"] else study, "study.json")
        result = self.calx("calibrate", "study.json")
        self.assertEqual(result.code, CASE, result.err)
        return result.err

    def test_examples_are_valid(self):
        for path in sorted(pathlib.Path(SOURCE).glob("examples/**/*.json")):
            text = re.sub(r"(?m)^\s*//.*$", "", path.read_text(encoding="utf-8"))
            if '"calx_study"' in text:
                jsonschema.validate(json.loads(text), self.schema, jsonschema.Draft202012Validator)

    def test_every_key_is_known_to_both(self):
        jsonschema.validate(FULL, self.schema, jsonschema.Draft202012Validator)
        self.assertIn("/budget/runs: 4 runs are too few", self.read(FULL))
        used = set(keys_of(FULL))
        for where, names in keys_of_schema(self.schema).items():
            self.assertLessEqual(names, used, where)

    def test_a_key_too_many_is_refused_by_both(self):
        for pointer in ("", "/cases/cup", "/parameters/0", "/parameters/0/prior", "/parameters/0/prior/normal", "/observables/0",
                        "/observables/0/measured", "/executor", "/budget"):
            study = json.loads(json.dumps(FULL))
            here = study
            for key in pointer.split("/")[1:]:
                here = here[int(key)] if isinstance(here, list) else here[key]
            here["zzz"] = 1
            self.assertFalse(self.valid(study), pointer)
            self.assertIn(f"{pointer}/zzz: unknown key", self.read(study))

    def test_what_the_reader_refuses_the_schema_refuses(self):
        for pointer, value in (("/calx_study", 2), ("/title", 3), ("/cases", {}), ("/observables", []),
                               ("/observables/0/kind", "residu"), ("/observables/0/use", "holdout"),
                               ("/observables/0/measured", {"sd": 4}), ("/observables/0/measured/sd", 0),
                               ("/observables/0/unit", None), ("/observables/1/measured/autocorrelation", 1),
                               ("/parameters/0/range", [0.9]), ("/parameters/0/set", ["friction"]), ("/parameters/0/set", []),
                               ("/parameters/0/prior", "flat"), ("/cases/cup/set", {"time/end": 1}),
                               ("/cases/cup/reduced_tolerance", 0), ("/seeds", 0), ("/seed", -1), ("/budget/runs", 3),
                               ("/executor/kind", "cloud"), ("/executor/jobs", 0)):
            study = changed(pointer, value)
            self.assertFalse(self.valid(study), (pointer, value))
            self.assertNotIn("runs are too few", self.read(study), (pointer, value))


if __name__ == "__main__":
    unittest.main(verbosity=2)
