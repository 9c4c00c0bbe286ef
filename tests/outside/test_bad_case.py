"""Cases that are wrong: what is wrong, where, the value, what would be right; the exit code of each kind."""
import json
import os
import unittest

from calx import CASE, EPAM, FILES, CalxTest, cup, needs


class BadCase(CalxTest):
    def test_unknown_key(self):
        self.refuses(CASE, cup({"/materials/glass/yuong": 1e7}), r"case\.json /materials/glass/yuong: unknown key",
                     r'did you mean "young"\?')
        # Written in place of the right key, it is named before the key that is missing.
        self.refuses(CASE, cup({"/materials/glass/young": None, "/materials/glass/yuong": 1e7}),
                     r"case\.json /materials/glass/yuong: unknown key", r'did you mean "young"\?')
        self.refuses(CASE, cup({"/time/ende": 1}), r"case\.json /time/ende: unknown key; did you mean \"end\"\?")
        self.refuses(CASE, cup({"/contacts/0/parameters/friktion": 1}),
                     r"/contacts/0/parameters/friktion: unknown key for calx\.hertz-mindlin", r'did you mean "friction"\?')
        self.refuses(CASE, cup({"/parts/0/parameters/open_topp": "yes"}), r"/parts/0/parameters/open_topp", r'"open_top"')
        self.refuses(CASE, cup({"/sources/0/masse": 1}), r"/sources/0/masse", r'did you mean "mass"\?')

    def test_unknown_name(self):
        self.refuses(CASE, cup({"/sources/0/shape": "bal"}), r'/sources/0/shape: no shape is called "bal"; did you mean "ball"\?')
        self.refuses(CASE, cup({"/sources/0/material": "glas"}), r"/sources/0/material", r'did you mean "glass"\?')
        self.refuses(CASE, cup({"/sensors/0/region": "cap"}), r"/sensors/0/region", r'did you mean "cup"\?')
        self.refuses(CASE, cup({"/parts/0/motion": "stir"}), r"/parts/0/motion", r"stir")

    def test_missing_key(self):
        self.refuses(CASE, cup({"/time/end": None}), r"case\.json /time/end: is missing", "end of the run in s")
        self.refuses(CASE, cup({"/materials/glass/density": None}), "/materials/glass/density: is missing", r"kg/m\^3", "pour")
        self.refuses(CASE, cup({"/contacts/0/parameters": {"friction": 0.1}}), "/contacts/0/parameters", "restitution")
        glass_steel = cup()["contacts"][1]
        self.refuses(CASE, cup({"/contacts/1": cup()["contacts"][0] | {"between": ["steel", "steel"]}}),
                     'case\\.json /contacts: none is between "glass" and "steel"', 'source "pour" and part "cup" can meet')
        self.refuses(CASE, cup({"/contacts": [glass_steel]}), 'none is between "glass" and "glass"', 'source "pour" can meet')
        self.runs(self.write(cup({"/contacts": [glass_steel], "/sources/0/count": 1})))

    def test_wrong_unit(self):
        radius = "/shapes/ball/sphere/radius"
        self.refuses(CASE, cup({radius: {"value": 2, "unit": "kg"}}),
                     radius + '/unit: unit "kg" measures a mass; a length in m is needed')
        self.refuses(CASE, cup({radius: {"value": 2, "unit": "mmm"}}), radius + "/unit: ", r'"mmm" is not known; did you mean "mm"\?')
        self.refuses(CASE, cup({"/materials/glass/young": {"value": 10, "unit": "mm"}}), "/materials/glass/young", "Pa")

    def test_impossible_value(self):
        line = self.refuses(CASE, cup({"/materials/glass/young": -1}), "/materials/glass/young: -1 Pa is out of range")
        self.assertRegex(line, "must be|allows")
        self.refuses(CASE, cup({"/shapes/ball/sphere/radius": 0}), "/shapes/ball/sphere/radius: 0 m", "must be above 0")
        self.refuses(CASE, cup({"/materials/glass/poisson": 0.9}), "/materials/glass/poisson: 0.9", "0.5")
        self.refuses(CASE, cup({"/contacts/0/parameters/restitution": 1.5}), "/contacts/0/parameters/restitution: 1.5 is out of range",
                     "allows 0 to 1")
        self.refuses(CASE, cup({"/time/end": "soon"}), '/time/end: "soon"', "number")
        self.refuses(CASE, cup({"/domain/min": [0, 0]}), "/domain/min: ")
        self.refuses(CASE, cup({"/domain/min": [0.2, 0, 0]}), "/domain", "0.2", "0.05")

    def test_unloading_softer_than_loading(self):
        needs("calx.epam")
        # lambda = 1 - k1 / k2 is negative when k2 < k1.
        case = cup({"/contacts/0/law": "calx.epam", "/contacts/0/parameters": dict(EPAM, plasticity=-0.2)})
        self.refuses(CASE, case, "/contacts/0/parameters/plasticity: -0.2 is out of range", r"calx\.epam .* allows 0 to 0\.99")

    def test_overlapping_start(self):
        case = cup()
        case["sources"][0] = {"name": "two", "shape": "ball", "material": "glass", "positions": [[0, 0, 0.01], [0, 0.003, 0.01]]}
        self.refuses(CASE, case, r"case\.json /sources/0: particles number 0 and 1 overlap by 0\.001 m at the start", "50 % of the radius",
                     "move them apart")
        # A twentieth of the radius is accepted.
        case["sources"][0]["positions"][1] = [0, 0.00391, 0.01]
        self.runs(self.write(case))

    def test_overlap_with_a_wall(self):
        case = cup()
        case["sources"][0] = {"name": "one", "shape": "ball", "material": "glass", "positions": [[0, 0, 0.0005]]}
        self.refuses(CASE, case, r"/sources/0: particle number 0 at \(0, 0, 5e-04\) m overlaps a particle of another source or a part", "move it away")

    def test_region_too_small(self):
        self.refuses(CASE, cup({"/sources/0/count": None, "/sources/0/mass": 2}),
                     r"/sources/0: the region cannot hold 2 kg \(\d+ particles\); without overlaps about 0\.0\d+ kg",
                     "region larger, ask for less, or give a rate")

    def test_time_step_above_limit(self):
        self.refuses(CASE, cup({"/time/step": 1e-3}), r"/time/step: 0\.001 s is above the limit of \S+e-05 s", "rayleigh", "glass",
                     'is advised, or leave "step" out')

    def test_bad_json(self):
        text = json.dumps(cup(), indent=1)
        line = next(k for k, row in enumerate(text.split("\n"), 1) if '"end"' in row)
        self.refuses(CASE, text.replace('"end": 0.05', '"end": 0.05,,'), rf"case\.json line {line} column \d+: not valid JSON")
        self.refuses(CASE, text[:200], r"line \d+ column \d+: not valid JSON", "missing closing quote")
        self.refuses(CASE, '{"calx": 1 "title": "x"}', r"line 1 column 18: not valid JSON; unexpected string literal")
        self.refuses(CASE, text.replace('"calx": 1,', '"calx": 1, "calx": 1,'), "/calx: this key stands twice")
        self.refuses(CASE, "[]", "a case is one JSON object")
        self.refuses(CASE, "", "line 1 column 1: not valid JSON")

    def test_unreadable_case(self):
        self.fails(FILES, "none.json", "cannot be read", "No such file", result=self.calx("run", "none.json"))
        (self.dir / "folder.json").mkdir()
        self.fails(FILES, "folder.json", "is a folder; a file is needed", result=self.calx("check", "folder.json"))
        if os.geteuid() != 0:  # the superuser reads everything
            path = self.write(cup())
            path.chmod(0)
            self.fails(FILES, "case.json", "cannot be read", "Permission denied", result=self.calx("run", path.name))

    def test_extends(self):
        self.write(cup(), "base.json")
        self.refuses(FILES, {"extends": "bass.json"}, r"case\.json /extends: ", r"bass\.json", "cannot be read")
        self.refuses(CASE, {"extends": "base.json", "time": {"end": -1}}, r"case\.json /time/end: -1 s")
        self.write(cup({"/time/end": -2}), "base.json")
        self.refuses(CASE, {"extends": "base.json"}, r"base\.json /time/end: -2 s")

    def test_overrides(self):
        path = self.write(cup())
        for value, texts in (("/time/end=-1", ("--set /time/end: -1 s is out of range",)),
                             ("/time/ende=1", ("--set /time/ende: unknown key", "\"end\"")),
                             ("/sources/7/count=1", ("--set /sources/7/count=1", "list of 1"))):
            self.fails(CASE, *texts, result=self.calx("run", path, "--set", value))

    def test_corrected_case_needs_no_option(self):
        path = self.write(cup({"/sources/0/count": 100000}))
        self.fails(CASE, "cannot hold", result=self.calx("run", path))
        self.assertEqual(self.summary()["status"], "stopped")
        self.assertIn("cannot hold", self.summary()["reason"])
        self.write(cup())
        self.runs(path)
        self.assertEqual(self.summary()["status"], "done")


if __name__ == "__main__":
    unittest.main(verbosity=2)
