"""Studies that are wrong: what is wrong stands in the message, with file and place, and the exit code is 3."""
import copy
import json
import unittest

from calx import CASE, FILES, PLUGIN, CalxTest, cup

STUDY = {
    "calx_study": 1, "title": "balls in a cup",
    "cases": {"cup": {"case": "case.json", "set": {"/time/end": 0.01}}},
    "parameters": [{"name": "friction", "unit": "1", "range": [0.1, 0.9], "set": ["/contacts/0/parameters/friction"]},
                   {"name": "stiffness", "unit": "MPa", "range": [1, 10], "set": ["/materials/glass/young"]}],
    "observables": [{"name": "mass", "kind": "other", "case": "cup", "sensor": "in cup", "column": "mass_kg", "unit": "g",
                     "measured": {"value": 4.0, "sd": 0.1, "repeats": 3}},
                    {"name": "curve", "kind": "load-cell", "case": "cup", "sensor": "in cup", "column": "mass_kg",
                     "against": "time_s", "unit": "g",
                     "measured": {"file": "curve.csv", "x": "time_ms", "y": "mass_g", "repeat": "run"}}],
    "seeds": 1, "budget": {"runs": 12}, "executor": {"kind": "local", "jobs": 2},
}
CURVE = "run,time_ms,mass_g\n1,2,4.0\n1,6,4.1\n2,2,4.2\n2,6,4.1\n"


def changed(pointer, value):
    study = copy.deepcopy(STUDY)
    here = study
    *way, last = pointer.strip("/").split("/")
    for key in way:
        here = here[int(key)] if isinstance(here, list) else here[key]
    if value is None:
        del here[last]
    elif isinstance(here, list):
        here[int(last)] = value
    else:
        here[last] = value
    return study


class BadStudy(CalxTest):
    def setUp(self):
        super().setUp()
        self.write(cup())
        (self.dir / "curve.csv").write_text(CURVE)

    def bad(self, study, *texts, code=CASE, words=()):
        self.write(study, "study.json")
        line = self.fails(code, *texts, result=self.calx("calibrate", "study.json", *words))
        self.assertFalse((self.dir / "study.out").exists(), "a study that is wrong must leave nothing")
        return line

    def test_parts_of_the_study(self):
        for pointer, value, *texts in (
                ("/calx_study", 2, "study.json /calx_study: 2 is not a version"),
                ("/title", 3, "study.json /title: 3 is not text"),
                ("/observabels", [], 'study.json /observabels: unknown key; did you mean "observables"\\?'),
                ("/parameters", [], "study.json /parameters: is empty; at least one parameter is needed"),
                ("/cases", {}, "study.json /cases: is empty"),
                ("/observables/0/kind", "residu", 'no kind of observable is called "residu"; did you mean "residue"\\?'),
                ("/observables/0/case", "cap", '/observables/0/case: no case is called "cap"; did you mean "cup"\\?'),
                ("/observables/0/sensor", "in cap", '/observables/0/sensor: case "cup" has no sensor "in cap"; did you mean "in cup"\\?'),
                ("/observables/0/column", "mass_g", 'sensor "in cup" has no column "mass_g"; did you mean "mass_kg"\\?'),
                ("/observables/1/against", "tme_s", '/observables/1/against: sensor "in cup" has no column "tme_s"; did you mean "time_s"\\?'),
                ("/observables/0/unit", "mm", '/observables/0/unit: column "mass_kg" of the sensor is in kg, which measures a mass; a length in mm is needed'),
                ("/observables/0/unit", "gr", '/observables/0/unit: unit "gr"'),
                ("/observables/0/use", "holdout", '/observables/0/use: "holdout" is not a use; did you mean "hold-out"\\?'),
                ("/observables/0/measured", {"value": 4}, "an sd cannot be estimated from 1 repeat; at least 2 are needed"),
                ("/observables/0/measured", {"values": [4, 4]}, "all repeats are equal"),
                ("/observables/0/measured", {"sd": 4}, 'holds no "value", "values" or "file"'),
                ("/observables/0/measured/sd", 0, "/observables/0/measured/sd: 0 g is out of range; must be above 0"),
                ("/observables/0/measured/sd", {"value": 1, "unit": "s"}, "/observables/0/measured/sd/unit: .*measures a time"),
                ("/observables/1/name", "mass", '/observables/1/name: "mass" stands twice'),
                ("/observables/1/measured/autocorrelation", 1, "/observables/1/measured/autocorrelation: 1 is out of range"),
                ("/parameters/0/range", [0.9, 0.1], "/parameters/0/range: the lowest value 0.9 is not below the highest 0.1"),
                ("/parameters/0/range", [0.9], "/parameters/0/range: a list of 1 value"),
                ("/parameters/0/range", [-0.5, 0.9], "study.json /cases/cup/case: with all parameters at their lowest value: .*friction.*out of range"),
                ("/parameters/1/unit", "MPaa", '/parameters/1/unit: unit "MPaa"'),
                ("/parameters/0/set", ["/contacts/0/parameters/frictoin"], '/contacts/0/parameters/frictoin: unknown key .*did you mean "friction"\\?'),
                ("/parameters/0/set", ["contacts"], '/parameters/0/set/0: "contacts" is no JSON pointer'),
                ("/parameters/0/prior", "flat", '/parameters/0/prior: "flat" is not a prior'),
                ("/parameters/0/prior", {"normal": {"mean": 1.5, "sd": 0.1}}, "/parameters/0/prior/normal/mean: 1.5 is outside of the range 0.1 to 0.9"),
                ("/parameters/0/cases", ["cap"], '/parameters/0/cases/0: no case is called "cap"'),
                ("/seeds", 0, "/seeds: 0 is out of range|/seeds: 0"),
                ("/budget/runs", 6, "/budget/runs: 6 runs are too few; 1 case with 1 seed at 7 places needs 7"),
                ("/executor/kind", "cloud", '/executor/kind: "cloud" is not an executor')):
            with self.subTest(pointer + " " + json.dumps(value)):
                study = changed(pointer, value)
                self.write(study, "study.json")
                self.fails(CASE, *texts, result=self.calx("calibrate", "study.json"))

    def test_nothing_is_fitted(self):
        study = copy.deepcopy(STUDY)
        for o in study["observables"]:
            o["use"] = "hold-out"
        self.bad(study, "study.json /observables: holds no observable of \"use\": \"fit\"")

    def test_measured_files(self):
        for text, *texts in (
                ("", "curve.csv: is empty; a header of column names and rows of numbers are needed"),
                ("run,time_ms,mass_g\n", "curve.csv: holds a header but no rows"),
                ("run,time_ms,mass_g\n1,2,4\n1,6,nan\n", 'curve.csv line 3: column "mass_g" holds no finite number'),
                ("run,time_ms,mass_g\n1,2,4\n1,6,\n", 'curve.csv line 3: column "mass_g" holds no finite number'),
                ("run,time_ms,mass_g\n1,2,4\n1,6,four\n", 'curve.csv line 3: "four" in column "mass_g" is not a number'),
                ("run,time_ms,mass_g\n1,2,4\n1,6\n", "curve.csv line 3: holds 2 values; the header names 3 columns"),
                ("run,time_ms,mass_g,run\n1,2,4,1\n", 'curve.csv line 1: column "run" stands twice'),
                ("# lab\nrun,time_ms,mass_g\n1,6,4\n1,2,4.1\n", 'curve.csv line 4: "time_ms" falls below the value of the row before'),
                ("run,time_ms,mass_g\n1,2,4\n1,2,4.1\n", 'curve.csv line 3: "time_ms" repeats the value of the row before'),
                ("run,time_ms,mass_g\n1,2,4\n1,6,4.1\n", "/observables/1/measured/file: an sd cannot be estimated from 1 repeat"),
                ("run,time_ms,mass_g\n1,2,4\n1,6,4.1\n2,2,4\n2,7,4.1\n", "repeat 2 of curve.csv is measured at other places than the first"),
                ("run,time_ms,mass\n1,2,4\n", '/observables/1/measured/y: "mass_g" is no column of curve.csv; did you mean "mass"\\?')):
            with self.subTest(text):
                (self.dir / "curve.csv").write_text(text)
                self.bad(STUDY, *texts)
        (self.dir / "curve.csv").write_text("run,time_kg,mass_mm\n1,2,4\n1,6,4.1\n2,2,4\n2,6,4.2\n")
        self.bad(changed("/observables/1/measured/x", "time_kg"), '"mass_g" is no column')
        study = changed("/observables/1/measured/y", "mass_mm")
        study["observables"][1]["measured"]["x"] = "time_kg"
        self.bad(study, '/observables/1/measured/y: column "mass_mm" is in mm, which measures a length; a mass in g is needed')

    def test_files_that_are_not_there(self):
        self.bad(changed("/observables/1/measured/file", "none.csv"), "study.json /observables/1/measured/file: .*none.csv: cannot be read", code=FILES)
        self.bad(changed("/cases/cup/case", "none.json"), "study.json /cases/cup/case: .*none.json: cannot be read", code=FILES)
        self.bad("{", "study.json line 1 column 2: not valid JSON")
        self.bad("[1]", "study.json: a study is one JSON object")

    def test_plugin_of_the_case(self):
        self.write(cup({"/contacts/0/law": "calx.hertz"}))
        self.bad(STUDY, "study.json /cases/cup/case: .*no plugin calx.hertz", code=PLUGIN)

    def test_run_that_ends_before_the_measured_place(self):
        (self.dir / "curve.csv").write_text(CURVE.replace(",6,", ",60,"))
        self.write(STUDY, "study.json")
        self.fails(5, 'observable "curve": only 0 of .* places gave it; the figure is not a number there: the series of sensor ".*" does not reach every measured place',
                   result=self.calx("calibrate", "study.json"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
