"""calx compare: what two runs were given and what came out, the one difference named where it is one."""
import json
import shutil
import unittest

from calx import FILES, USAGE, CalxTest, cup


class Compare(CalxTest):
    def setUp(self):
        super().setUp()
        self.write(cup())
        self.runs("case.json", "-o", "a", "--quiet")

    def compared(self, other):
        result = self.calx("compare", "a", other)
        self.assertEqual(result.code, 0, result.err)
        return result.out, json.loads(self.calx("compare", "a", other, "--json").out)

    def test_the_same(self):
        self.runs("case.json", "-o", "b", "--quiet")
        text, found = self.compared("b")
        self.assertIn("Both runs were given the same. All series are the same to every digit written.\n", text)
        self.assertRegex(text, r"(?m)^A  a  done\nB  b  done$")
        self.assertEqual((found["provenance"], found["given"], found["only_a"], found["only_b"]), ([], [], [], []))
        self.assertTrue(all(s["same"] and s["largest"] == 0 and s["rows"] > 1 for s in found["series"]))
        self.assertTrue(all(f["difference"] == 0 and f["relative"] == 0 for f in found["figures"]))

    def test_threads_alone(self):
        self.runs("case.json", "-o", "b", "--quiet", "--threads", 2)
        text, found = self.compared("b")
        self.assertIn("The runs differ in threads alone, which change no bit. All series are the same", text)
        self.assertEqual(found["provenance"], [{"name": "threads", "a": "1", "b": "2"}])

    def test_seed_alone(self):
        self.runs("case.json", "-o", "b", "--quiet", "--seed", 2)
        text, found = self.compared("b")
        self.assertIn("The runs differ in the seed alone: what follows is the scatter of random choices. Series differ.", text)
        self.assertEqual(found["given"], [{"name": "/seed", "a": "1", "b": "2"}])
        figures = {f["name"]: f for f in found["figures"]}
        a, b = (self.summary(name)["energy"]["kinetic_translation"] for name in ("a", "b"))
        self.assertNotEqual(a, b)
        row = figures["energy kinetic_translation"]
        self.assertEqual((row["a"], row["b"], row["difference"]), (a, b, b - a))
        self.assertAlmostEqual(row["relative"], (b - a) / a, delta=1e-12)
        self.assertRegex(text, r"(?m)^  energy kinetic_translation +\S+ +\S+ +\S+ +\S+ %$")

    def test_time_step_alone(self):
        self.write(cup({"/time/rayleigh_fraction": 0.05}), "finer.json")
        self.runs("finer.json", "-o", "b", "--quiet", "--until", 0.01)
        self.runs("case.json", "-o", "a", "--quiet", "--until", 0.01, "--overwrite")
        text, found = self.compared("b")
        self.assertRegex(text, r"The runs differ in the time step alone \(\S+ us, \S+ us\)")
        steps = {f["name"]: f for f in found["figures"]}["time_step_s"]
        a, b = (self.summary(name)["time_step"] for name in ("a", "b"))
        self.assertEqual((steps["a"], steps["b"], steps["relative"]), (a, b, (b - a) / a))
        self.assertFalse(all(s["in_step"] for s in found["series"]))

    def test_several_causes(self):
        self.write(cup({"/contacts/0/parameters": {"restitution": 0.7, "friction": 0.4}}), "other.json")
        self.runs("other.json", "-o", "b", "--quiet", "--seed", 3)
        text, found = self.compared("b")
        self.assertIn("The runs differ in: case, seed. Series differ.", text)
        self.assertIn({"name": "/contacts/0/parameters/restitution", "a": "0.5", "b": "0.7"}, found["given"])

    def test_one_row_of_a_series(self):
        """A change put into one row of a copy is found: how large, where, of what."""
        shutil.copytree(self.dir / "a", self.dir / "b")
        path = self.dir / "b/series/energy.csv"
        head, *rows = path.read_text().splitlines()
        column = head.split(",").index("gravity_J")
        cells = rows[3].split(",")
        time, value = float(cells[0]), float(cells[column])
        cells[column] = repr(value * 1.5)
        rows[3] = ",".join(cells)
        path.write_text("\n".join([head, *rows]) + "\n")
        text, found = self.compared("b")
        self.assertIn("Both runs were given the same. Series differ. One of them", text)
        changed = [s for s in found["series"] if not s["same"]]
        self.assertEqual([(s["sensor"], s["column"], s["at_s"]) for s in changed], [("energy", "gravity_J", time)])
        self.assertAlmostEqual(changed[0]["largest"], 0.5 * abs(value), delta=1e-12)
        largest = max(abs(float(row.split(",")[column])) for row in (self.dir / "a/series/energy.csv").read_text().splitlines()[1:])
        self.assertEqual(changed[0]["range"], largest)
        self.assertRegex(text, r"(?m)^1 of \d+ columns of series differ$")

    def test_page(self):
        self.runs("case.json", "-o", "b", "--quiet", "--seed", 2)
        self.assertEqual(self.calx("compare", "a", "b", "--page", "both.html").code, 0)
        page = (self.dir / "both.html").read_text()
        for words in ("differ in the seed alone", "energy: kinetic translation", "Largest difference", "energy kinetic_translation"):
            self.assertIn(words, page)
        self.assertNotRegex(page, r"(src|href)=.https?:")

    def test_refusals(self):
        (self.dir / "empty").mkdir()
        self.fails(FILES, "empty: holds no run, neither summary.json nor case.json", result=self.calx("compare", "a", "empty"))
        self.fails(FILES, "nowhere", result=self.calx("compare", "a", "nowhere"))
        self.fails(USAGE, "compare", result=self.calx("compare", "a"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
