"""The part of the tier that the gate runs: one hidden effect, one control, the same bytes whatever happens on the way, and the
scorer itself. The full tier is tier.py."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from hidden import STUDIES  # noqa: E402
from score import interval, outcome, score  # noqa: E402
from tier import make, solve  # noqa: E402

CALX = os.environ["CALX"]
SEED = 7  # not that of the table
CONTROL = "control_pile"
HIDDEN = "blocked"  # a pocket of the rotor


class Tier(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.temporary.name)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def diagnosed(self, name, budget):
        """Folder of a study, made and diagnosed once."""
        folder = self.dir / name
        make(next(s for s in STUDIES if s.name == name), folder, SEED, CALX, budget)
        solve(folder, CALX, 1)
        return folder

    def test_nothing_is_named_where_nothing_is_hidden(self):
        s = score(self.diagnosed(CONTROL, 40))
        self.assertEqual(s["outcome"], "quiet", s["line"])

    def test_a_hidden_effect_is_named(self):
        s = score(self.diagnosed(HIDDEN, 100))
        self.assertEqual((s["outcome"], s["named"]), ("right", ["calx.blocked-pocket"]), s["line"])

    def test_the_public_folder_does_not_tell(self):
        folder = self.dir / "told"
        make(next(s for s in STUDIES if s.name == CONTROL), folder, SEED, CALX, 40)
        other = self.dir / "told_other"
        make(next(s for s in STUDIES if s.name == "tilt"), other, SEED, CALX, 40)
        for name in ("study.json", "case.json"):
            self.assertEqual((folder / "public" / name).read_text(), (other / "public" / name).read_text(), name)
        self.assertNotEqual((folder / "public" / "fit_0.csv").read_text(), (other / "public" / "fit_0.csv").read_text())

    def test_same_bytes_in_another_order_with_other_jobs_and_after_a_kill(self):
        first = self.diagnosed(CONTROL, 40)
        effects = [{"effect": "calx." + name} for name in ("canister-tilt", "attrition", "rolling-resistance")]
        found = []
        for name, order, jobs in (("killed", effects, 2), ("turned", effects[::-1], 1)):
            folder = self.dir / name
            shutil.copytree(first / "public", folder / "public")
            path = folder / "public" / "study.json"
            path.write_text(json.dumps(dict(json.loads(path.read_text()), effects=order)))
            if name == "killed":
                self.kill_under_way(folder)
            solve(folder, CALX, jobs)
            found.append((folder / "diagnosis" / "diagnosis.json").read_bytes())
        self.assertEqual(found[0], found[1])

    def kill_under_way(self, folder):
        """A diagnosis that is ended by SIGKILL, with all its runs, once it has finished five of them."""
        words = [CALX, "diagnose", folder / "public" / "study.json", "-o", folder / "diagnosis", "--jobs", "2", "--quiet"]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as child:
            runs = folder / "diagnosis" / "runs"
            while len([f for f in runs.glob("*/summary.json") if f.parent.suffix != ".part"]) < 5:
                self.assertIsNone(child.poll(), "ended before it could be killed")
                time.sleep(0.02)
            os.killpg(child.pid, signal.SIGKILL)
        self.assertFalse((folder / "diagnosis" / "diagnosis.json").exists())


class Scorer(unittest.TestCase):
    def says(self, kind, truth, verdict, named, left):
        return outcome({"kind": kind, "truth": truth}, verdict, set(named), set(left))

    def test_outcomes(self):
        a, b, c = "calx.rotor-leak", "calx.load-cell-lag", "calx.attrition"
        self.assertEqual(self.says("effect", [a], "named", [a], [a]), "right")
        self.assertEqual(self.says("effect", [a], "named", [b], [b]), "wrong")
        self.assertEqual(self.says("effect", [a], "named", [a, b], [a, b]), "wrong")
        self.assertEqual(self.says("effect", [a], "ambiguous", [], [a, b, "unknown"]), "in group")
        self.assertEqual(self.says("effect", [a], "ambiguous", [], [a, "none"]), "undecided")
        self.assertEqual(self.says("effect", [a], "ambiguous", [], [b, c]), "undecided")
        self.assertEqual(self.says("effect", [a], "none", [], ["none"]), "missed")
        self.assertEqual(self.says("pair", [a, b], "named", [b], [b]), "half")
        self.assertEqual(self.says("pair", [a, b], "named", [a, c], [a, c]), "wrong")
        self.assertEqual(self.says("control", [], "named", [a], [a]), "false name")
        self.assertEqual(self.says("control", [], "ambiguous", [], [a, "none"]), "quiet")
        self.assertEqual(self.says("outside", [], "unknown", [], ["unknown"]), "flagged")

    def test_interval(self):
        # 0 of 10: 1 - 0.025^(1/10); 8 of 10: Clopper and Pearson's chart gives 0.444 to 0.975.
        self.assertAlmostEqual(interval(0, 10)[1], 1 - 0.025**0.1, places=9)
        self.assertAlmostEqual(interval(8, 10)[0], 0.444, places=3)
        self.assertAlmostEqual(interval(8, 10)[1], 0.975, places=3)


if __name__ == "__main__":
    unittest.main()
