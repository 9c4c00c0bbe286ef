"""calx calibrate as a user meets it: results, resuming after a kill, the same bytes for any number of jobs."""
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from calx import CALX, CASE, FILES, INTERRUPTED, USAGE, CalxTest, cup

# What is fitted is of no matter here: the runs are short, the figures answer to both parameters.
STUDY = {
    "calx_study": 1, "title": "balls in a cup",
    "cases": {"cup": {"case": "case.json"}},
    "parameters": [{"name": "restitution", "unit": "1", "range": [0.2, 0.9],
                    "set": ["/contacts/0/parameters/restitution", "/contacts/1/parameters/restitution"]},
                   {"name": "density", "unit": "g/cm^3", "range": [1.5, 4], "set": ["/materials/glass/density"],
                    "prior": {"normal": {"mean": 2.5, "sd": 0.5}}}],
    "observables": [{"name": "mass", "kind": "other", "case": "cup", "sensor": "in cup", "column": "mass_kg", "unit": "g",
                     "measured": {"value": 5.0, "sd": 0.2, "repeats": 3}},
                    {"name": "kinetic energy", "kind": "other", "case": "cup", "sensor": "energy",
                     "column": "kinetic_translation_J", "against": "time_s", "at": [0.02, 0.03, 0.04], "unit": "mJ",
                     "measured": {"values": [0.097, 0.217, 0.308], "relative": 0.05, "repeats": 2}},
                    {"name": "height", "kind": "fill-height", "case": "cup", "sensor": "in cup", "column": "centre_z_m",
                     "unit": "mm", "use": "hold-out", "measured": {"values": [18, 19, 20]}}],
    "seeds": 2, "budget": {"runs": 20}, "assumptions": ["every measured value is made up"],
}


def processes(text):
    """Numbers of the running processes whose command line holds text."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes()
        except OSError:
            continue
        if text.encode() in words:
            found.append(int(path.parent.name))
    return found


class Calibrate(CalxTest):
    def setUp(self):
        super().setUp()
        self.write(cup({"/time/end": 0.04}))
        self.write(STUDY, "study.json")

    def calibrate(self, *words):
        result = self.calx("calibrate", "study.json", *words)
        self.assertEqual(result.code, 0, result.err)
        return result

    def read(self, name, folder="study.out"):
        return json.loads((self.dir / folder / name).read_text())

    def finished(self, folder):
        """{run: time of its summary} of the finished runs."""
        return {p.name: (p / "summary.json").stat().st_mtime_ns for p in (self.dir / folder / "runs").glob("*")
                if p.is_dir() and p.suffix != ".part"}

    def start(self, *words):
        process = subprocess.Popen([CALX, "calibrate", "study.json", "--jobs", "2", *words], cwd=self.dir,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def assert_drawn(self, path, charts):
        """A browser draws every chart of the page."""
        self.assertGreater(charts, 5)
        if not shutil.which("chromium"):
            print("no chromium: the page was not opened")
            return
        done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.dir}/browser",
                               "--dump-dom", path.as_uri()], text=True, capture_output=True, timeout=100, check=False)
        self.assertEqual(done.stdout.count('role="img"'), charts, done.stderr[-2000:])

    def wait_for_runs(self, process, folder, count):
        limit = time.monotonic() + 60
        while not (self.dir / folder / "runs").exists() or len(self.finished(folder)) < count:
            self.assertIsNone(process.poll(), "the study ended before it was stopped")
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.005)

    def test_results(self):
        result = self.calibrate("--jobs", "2")
        self.assertRegex(result.out, r"restitution +0\.\d+ +0\.\d+")
        self.assertRegex(result.out, r"height \(held out\): (agrees|does not agree), z = ")
        c = self.read("calibration.json")
        self.assertEqual([p["name"] for p in c["parameters"]], ["restitution", "density"])
        for p in c["parameters"]:
            self.assertLess(p["range"][0], p["q05"])
            self.assertLess(p["q05"], p["q50"])
            self.assertLess(p["q50"], p["q95"])
            self.assertLess(p["q95"], p["range"][1])
            self.assertAlmostEqual(p["identifiability"], p["sd"] / p["prior_sd"])
        # The mass of a ball grows with its density: 60 balls of 2 mm radius in the cup weigh 5 g at 2.49 g/cm^3.
        self.assertLess(c["parameters"][1]["q05"], 2.49)
        self.assertGreater(c["parameters"][1]["q95"], 2.49)
        self.assertLess(c["parameters"][1]["identifiability"], 0.4)
        # The waves may end before the budget does.
        spent = c["runs"]["spent"]
        self.assertEqual(c["runs"], {"budget": 20, "spent": spent, "failed": 0, "seeds": 2})
        self.assertGreater(spent, 12)
        self.assertLessEqual(spent, 20)
        self.assertEqual(self.read("cost.json")["computed"], spent)
        by_name = {o["name"]: o for o in c["observables"]}
        self.assertEqual(by_name["kinetic energy"]["x"], [0.02, 0.03, 0.04])
        self.assertEqual(len(by_name["kinetic energy"]["predicted"]["q95"]), 3)
        self.assertAlmostEqual(by_name["mass"]["measured_sd"][0], 0.2 / 3 ** 0.5)
        self.assertAlmostEqual(by_name["height"]["measured"][0], 19)
        self.assertTrue(by_name["mass"]["agrees"])
        with open(self.dir / "study.out" / "samples.csv", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), c["sampler"]["draws"])
        mean = sum(float(r["density"]) for r in rows) / len(rows)
        self.assertAlmostEqual(mean, c["parameters"][1]["mean"], places=6)
        with open(self.dir / "study.out" / "runs.csv", encoding="ascii") as file:
            runs = list(csv.DictReader(file))
        self.assertEqual(len({r["seed"] for r in runs}), spent)
        page = (self.dir / "study.out" / "report.html").read_text()
        for text in ("What the data tell", "kinetic energy", "every measured value is made up", "Emulators"):
            self.assertIn(text, page)
        self.assertNotIn("src=\"http", page)
        self.assert_drawn(self.dir / "study.out" / "report.html", page.count("class=\"plot\""))
        self.assertEqual(self.calx("report", "study.out").code, 0)

    def test_a_case_extends_the_material(self):
        self.calibrate("--budget", "14")
        mean = {p["name"]: p["mean"] for p in self.read("calibration.json")["parameters"]}
        case = cup()
        del case["materials"], case["contacts"], case["assumptions"]
        self.write(dict(case, extends="study.out/material.json"), "next.json")
        self.runs("next.json", "-o", "next", "--until", 0.001)
        used = self.read("case.json", "next")
        self.assertAlmostEqual(used["materials"]["glass"]["density"], 1000 * mean["density"])
        self.assertAlmostEqual(used["contacts"][1]["parameters"]["restitution"], mean["restitution"])
        self.assertRegex(self.read("summary.json", "next")["assumptions"][-1], r"density = .* g/cm\^3 \+- .*: calibrated by study")

    def test_jobs_and_a_kill_change_nothing(self):
        self.calibrate("--jobs", "1", "-o", "one")
        straight = (self.dir / "one" / "calibration.json").read_bytes()
        spent = self.read("calibration.json", "one")["runs"]["spent"]
        process = self.start("-o", "killed")
        self.wait_for_runs(process, "killed", 5)
        process.send_signal(signal.SIGKILL)
        process.wait(60)
        before = self.finished("killed")
        self.assertLess(len(before), spent)
        self.assertFalse((self.dir / "killed" / "calibration.json").exists())
        self.calibrate("-o", "killed", "--jobs", "2")
        after = self.finished("killed")
        self.assertEqual({k: after[k] for k in before}, before, "a finished run was computed again")
        cost = self.read("cost.json", "killed")
        self.assertEqual((cost["cached"], cost["computed"]), (len(before), spent - len(before)))
        self.assertEqual(list((self.dir / "killed" / "runs").glob("*.part")), [])
        self.assertEqual((self.dir / "killed" / "calibration.json").read_bytes(), straight)
        self.assertEqual((self.dir / "killed" / "samples.csv").read_bytes(), (self.dir / "one" / "samples.csv").read_bytes())
        # Once more costs nothing, and a changed case costs every run.
        self.calibrate("-o", "killed")
        self.assertEqual(self.read("cost.json", "killed")["computed"], 0)
        self.write(cup({"/time/end": 0.041}))
        self.calibrate("-o", "killed")
        self.assertEqual(self.read("cost.json", "killed")["cached"], 0)

    def test_runs_of_a_killed_study_end_with_it(self):
        # Each run would take minutes.
        self.write(cup({"/time/end": 60}))
        process = self.start("-o", "out")
        limit = time.monotonic() + 60
        running = lambda: processes(str(self.dir / "out"))
        while len(running()) < 2:
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait(60)
        limit = time.monotonic() + 10
        while running():
            self.assertLess(time.monotonic(), limit, "runs go on after their study was killed")
            time.sleep(0.02)

    def test_interrupted(self):
        process = self.start("-o", "out")
        self.wait_for_runs(process, "out", 2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), INTERRUPTED)
        self.assertIn("finished runs are kept, the same command goes on", process.stderr.read())
        self.assertEqual(processes(str(self.dir / "out")), [])
        done = len(self.finished("out"))
        self.calibrate("-o", "out", "--resume")
        self.assertEqual(self.read("cost.json", "out")["cached"], done)

    def test_two_at_once(self):
        process = self.start("-o", "out")
        self.wait_for_runs(process, "out", 1)
        self.fails(FILES, "another study works in this folder", result=self.calx("calibrate", "study.json", "-o", "out"))
        process.send_signal(signal.SIGKILL)
        process.wait(60)

    def test_runs_that_fail(self):
        # Grains that are too soft sink into each other: those runs stop by themselves and are not tried again.
        study = json.loads(json.dumps(STUDY))
        study["parameters"][1] = {"name": "stiffness", "unit": "MPa", "range": [0.001, 10], "set": ["/materials/glass/young"]}
        self.write(study, "study.json")
        self.write(cup({"/time/end": 0.04, "/overlap_limit": 0.02, "/time/step": 1e-5}))
        result = self.calx("calibrate", "study.json")
        if result.code == 0:
            self.assertGreater(self.read("calibration.json")["runs"]["failed"], 0)
        else:
            self.fails(5, 'only .* places gave it; one run says: run stopped at t = .*overlap', result=result)
        failed = list((self.dir / "study.out" / "runs").glob("*/failed.txt"))
        self.assertGreater(len(failed), 0)
        self.assertIn("overlap", failed[0].read_text())

    def test_options(self):
        self.fails(USAGE, "--jobs: \"0\" is not a whole number above 0", result=self.calx("calibrate", "study.json", "--jobs", "0"))
        self.fails(USAGE, "cloud", result=self.calx("calibrate", "study.json", "--executor", "cloud"))
        result = self.calx("calibrate", "study.json", "--budget", "14", "--json", "--seed", "5")
        self.assertEqual(result.code, 0, result.err)
        events = [json.loads(line) for line in result.err.splitlines()]
        self.assertIn("progress", {e["event"] for e in events})
        self.assertEqual({e["total"] for e in events if e["event"] == "progress"}, {14})
        self.assertEqual(self.read("calibration.json")["seed"], 5)
        # Without Slurm's programs the message says so.
        empty = self.dir / "empty"
        empty.mkdir()
        result = self.calx("calibrate", "study.json", "--executor", "slurm", env={"PATH": str(empty)})
        self.fails(CASE, 'executor "slurm": sbatch cannot be run', result=result)


if __name__ == "__main__":
    os.environ.pop("CALX_PLUGIN_PATH", None)
    unittest.main(verbosity=2)
