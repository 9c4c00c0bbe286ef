"""The same bits again: another run, other numbers of threads, the resolved case; and other bits where they should differ."""
import json
import shutil
import unittest

from calx import EPAM, USAGE, CalxTest, busy, cup, differences, needs


class Repeat(CalxTest):
    def checkpoint(self, folder):
        return self.dir / folder / "checkpoint.h5"

    def assert_same(self, a, b, but=()):
        self.assertEqual([n for n in differences(self.checkpoint(a), self.checkpoint(b)) if n not in but], [])
        one, two = self.summary(a), self.summary(b)
        for key in ("time", "steps", "mass", "energy", "sensors", "events"):
            self.assertEqual(one[key], two[key], key)

    def test_again(self):
        path = self.write(busy())
        self.runs(path, "-o", "first")
        self.runs(path, "-o", "second")
        self.assert_same("first", "second")
        for name in ("frames.pvd", "case.json"):
            self.assertEqual((self.dir / "first" / name).read_bytes(), (self.dir / "second" / name).read_bytes())

    def crowd(self):
        """More particles than one chunk of work, in motion and in contact."""
        needs("calx.epam")
        case = cup({"/sources/0/count": 900, "/sources/0/region": {"box": {"min": [-0.019, -0.019, 0.002], "max": [0.019, 0.019, 0.075]}},
                    "/shapes/ball/sphere/radius": 0.0017, "/time/end": 0.03, "/output": {}})
        for contact in case["contacts"]:
            contact.update(law="calx.epam", parameters=EPAM)
        return self.write(case)

    def test_threads(self):
        path = self.crowd()
        for threads in (1, 2, 3, 8):
            self.runs(path, "-o", f"by {threads}", "--threads", threads)
            self.assertEqual(self.summary(f"by {threads}")["provenance"]["threads"], threads)
        self.assertEqual(self.summary("by 1")["particles"], 900)
        self.assertGreater(self.summary("by 1")["energy"]["plastic"], 0)
        for threads in (2, 3, 8):
            self.assert_same("by 1", f"by {threads}")

    def test_instruction_sets(self):
        path = self.crowd()
        wrong = self.calx("run", path, env={"CALX_INSTRUCTION_SET": "x86-64-v9"})
        self.fails(USAGE, "CALX_INSTRUCTION_SET=x86-64-v9", "plain", result=wrong)
        known = wrong.err.split("it has ")[1].strip().split(", ")
        self.assertEqual(known[0], "plain")
        for precision in ("double", "mixed"):
            for name in known:
                self.runs(path, "-o", f"{precision} {name}", "--precision", precision, env={"CALX_INSTRUCTION_SET": name})
                self.assert_same(f"{precision} plain", f"{precision} {name}")
            self.assertEqual(self.summary(f"{precision} plain")["provenance"]["precision"], precision)
        self.runs(path, "-o", "mixed by 3", "--precision", "mixed", "--threads", 3)
        self.assert_same("mixed plain", "mixed by 3")
        self.assertNotEqual(differences(self.checkpoint("double plain"), self.checkpoint("mixed plain")), [])

    def test_resolved_case(self):
        path = self.write(busy())
        self.runs(path, "-o", "first", "--set", "/contacts/0/parameters/friction=0.3", "--seed", 7)
        resolved = self.dir / "first" / "case.json"
        # Wherever the copy stands, and whatever the original has become.
        (self.dir / "elsewhere").mkdir()
        shutil.copy(resolved, self.dir / "elsewhere" / "copy.json")
        path.write_text("{}")
        self.runs("elsewhere/copy.json")
        self.assert_same("first", "elsewhere/copy.out")
        self.assertEqual(resolved.read_text(), (self.dir / "elsewhere" / "copy.out" / "case.json").read_text())
        self.assertEqual(self.summary("first")["provenance"]["case_sha256"], self.summary("elsewhere/copy.out")["provenance"]["case_sha256"])

    def test_relative_files_of_the_resolved_case(self):
        case = cup()
        case["sources"][0] = {"name": "given", "shape": "ball", "material": "glass", "file": "balls.csv"}
        (self.dir / "cases").mkdir()
        (self.dir / "cases" / "balls.csv").write_text("x_m,y_m,z_m\n0,0,0.01\n0.005,0,0.012\n")
        self.runs(self.write(case, "cases/case.json"), "-o", "first")
        self.runs("first/case.json", "-o", "second")
        self.assert_same("first", "second")
        self.assertEqual(self.summary("second")["particles"], 2)

    def test_override_is_a_change_of_the_file(self):
        self.runs(self.write(cup()), "-o", "set", "--set", "/materials/glass/young=2e7", "--set", "/title=stiffer",
                  "--set", '/gravity=[0, 0, -1.62]', "--set", "/output/frames_every=0")
        self.runs(self.write(cup({"/materials/glass/young": 2e7, "/title": "stiffer", "/gravity": [0, 0, -1.62],
                                  "/output/frames_every": 0})), "-o", "written")
        self.assert_same("set", "written", but=("case",))
        resolved = json.loads((self.dir / "set" / "case.json").read_text())
        self.assertEqual((resolved["materials"]["glass"]["young"], resolved["title"], resolved["gravity"]), (2e7, "stiffer", [0, 0, -1.62]))
        self.assertFalse((self.dir / "set" / "frames").exists())

    def test_seed(self):
        path = self.write(cup())
        for folder, words in (("preset", ()), ("one", ("--seed", 1)), ("two", ("--seed", 2)), ("two again", ("--set", "/seed=2"))):
            self.runs(path, "-o", folder, *words)
        self.assert_same("preset", "one", but=("case",))
        self.assert_same("two", "two again", but=("case",))
        changed = differences(self.checkpoint("one"), self.checkpoint("two"))
        self.assertTrue(any("position" in n or "body" in n or "particle" in n for n in changed), changed)
        self.assertNotEqual(self.rows("in cup", "one")[1], self.rows("in cup", "two")[1])
        self.assertEqual(self.summary("two")["provenance"]["seed"], 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
