"""calx law as a user meets it: its files, what stands on stdout, refusals, and the pictures of docs/laws."""
import json
import subprocess
import sys
import unittest

from calx import CALX, CASE, PLUGIN, PLUGINS, SOURCE, USAGE, CalxTest, cup, needs


class Law(CalxTest):
    def table(self, name):
        head, *rows = (self.dir / name).read_text().splitlines()
        return head, [[float(x) for x in row.split(",")] for row in rows]

    def test_files_and_figures(self):
        needs("calx.linear")
        out = self.calx("law", "calx.linear", "--set", "/parameters/kn=2e4", "--set", "/parameters/friction=0.3", "-o", "bench").out
        self.assertRegex(out, r"(?m)^  effective mass +5\.236e-06 kg$")
        # What the user did not give is told.
        self.assertRegex(out, r"^calx\.linear, i-j: the materials of the bench, to be changed by --set /materials/KEY=value\n")
        self.assertRegex(out, r'(?m)^  material i +\{"density":2500')
        self.assertRegex(out, r'(?m)^  given to calx\.linear +\{.*"kn":2e4|20000')
        self.assertRegex(out, r"(?m)^  largest tangential force .*, 0\.3 of the normal force$")
        self.assertTrue(out.endswith("bench/law.html\n"), out)
        head, rows = self.table("bench/press.csv")
        self.assertEqual(head, "loop_1,overlap_m,force_N")
        self.assertEqual({row[0] for row in rows}, {1, 2, 3})
        for _, overlap, force in rows:
            self.assertAlmostEqual(force / (2e4 * overlap), 1, delta=1e-8)  # nine digits are written
        head, rows = self.table("bench/restitution.csv")
        self.assertEqual(head, "speed_m_s,restitution_1,overlap_m,contact_time_s")
        self.assertEqual(len(rows), 16)
        head, rows = self.table("bench/shear.csv")
        self.assertEqual(head, "displacement_m,force_N")
        self.assertEqual(self.table("bench/roll.csv")[0], "angle_rad,torque_N_m")
        page = (self.dir / "bench/law.html").read_text()
        for words in ("Force over overlap", "Restitution over speed", "Tangential loop", "calx.linear"):
            self.assertIn(words, page)
        self.assertNotRegex(page, r"(src|href)=.https?:")
        self.assertIn("<polyline", (self.dir / "bench/law.svg").read_text())
        # What was benched can be benched again, from its own case.
        again = self.calx("law", "--case", "bench/case.json", "--between", "i,j", "-o", "again").out
        self.assertEqual((self.dir / "again/press.csv").read_bytes(), (self.dir / "bench/press.csv").read_bytes())
        self.assertEqual(again.splitlines()[1:-1], out.splitlines()[1:-1])

    def test_materials_are_chosen(self):
        needs("calx.hertz-mindlin")
        force = {}
        for name, words in {"both": ["--set", "/materials/young=4e7"], "one": ["--set", "/materials/j/young=4e7"], "none": []}.items():
            result = self.calx("law", "calx.hertz-mindlin", "--overlap", "1e-5", "--json", "-o", name, *words)
            force[name] = json.loads(result.out)["most_force_N"]
        self.assertAlmostEqual(force["both"] / force["none"], 4, delta=1e-7)  # nine digits are written
        self.assertAlmostEqual(force["one"] / force["none"], 1.6, delta=1e-7)  # 2 / (1 + 1/4)

    def test_pair_of_a_case(self):
        needs("calx.hertz-mindlin")
        case = self.write(cup()).name
        self.assertIn("glass-steel", self.calx("law", "--case", case, "--between", "glass,steel", "--wall", "-o", "x").out)
        self.fails(CASE, r'no material "glas"; did you mean "glass"', result=self.calx("law", "--case", case, "--between", "glas,steel"))
        self.fails(CASE, r'/contacts: none is between "steel" and "steel"; known are "glass,glass", "glass,steel"',
                   result=self.calx("law", "--case", case, "--between", "steel,steel"))

    def test_refusals(self):
        needs("calx.linear")
        self.fails(USAGE, "the id of a contact law is needed", result=self.calx("law"))
        self.fails(USAGE, "not both", result=self.calx("law", "calx.linear", "--case", "x.json"))
        self.fails(USAGE, "expected two materials of the case", result=self.calx("law", "--case", "x.json"))
        self.fails(USAGE, "for instance /parameters/friction=0.3", result=self.calx("law", "calx.linear", "--set", "kn=3"))
        self.fails(PLUGIN, 'did you mean "calx.linear"', result=self.calx("law", "calx.liner"))
        self.fails(CASE, r'/contacts/0/laws/0/parameters/frictoin: unknown key .*did you mean "friction"',
                   result=self.calx("law", "calx.linear", "--set", "/parameters/frictoin=3"))

    def test_pictures_of_the_docs(self):
        for plugin in ("hertz-mindlin", "linear", "epam", "contact-plasticity", "load-cohesion", "moisture-cohesion",
                       "rolling-resistance", "wall-charge", "wall-friction-stress"):
            needs("calx." + plugin)
        done = subprocess.run([sys.executable, f"{SOURCE}/docs/laws/figures", "--calx", CALX, "--check"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertEqual((done.returncode, done.stdout), (0, "nothing changed\n"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
