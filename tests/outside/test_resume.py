"""A run that was stopped and gone on with is the run that was never stopped: same bits, same rows, same frames."""
import os
import random
import re
import signal
import subprocess
import time
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from calx import CALX, INTERRUPTED, CalxTest, busy, cup, differences


def read_points(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    points = reader.GetOutput().GetPoints()
    return vtk_to_numpy(points.GetData()) if points and points.GetNumberOfPoints() else numpy.zeros((0, 3))


def frames(folder):
    """[(time, name, file)] of frames.pvd."""
    text = (folder / "frames.pvd").read_text()
    return [(float(t), name, file)
            for t, name, file in re.findall(r'timestep="([^"]+)".*? name="([^"]+)" file="([^"]+)"', text)]


class Resume(CalxTest):
    def start(self, *words):
        """calx run in the background, with one thread so that a busy machine does not matter."""
        process = subprocess.Popen([CALX, "run", *map(str, words), "--no-report", "--quiet", "--threads", "1"], cwd=self.dir,
                                   stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def stop_after_checkpoint(self, process, folder, how, wait):
        """Sends the signal `how` some time after a new checkpoint; returns the exit code."""
        path = self.dir / folder / "checkpoint.h5"
        before = path.stat().st_mtime_ns if path.exists() else 0
        limit = time.monotonic() + 60
        while not path.exists() or path.stat().st_mtime_ns == before:
            if process.poll() is not None:
                self.fail("the run ended before it was stopped: " + process.stderr.read())
            self.assertLess(time.monotonic(), limit, "no checkpoint within a minute")
            time.sleep(0.002)
        time.sleep(wait)
        process.send_signal(how)
        return process.wait(60)

    def assert_same_run(self, a, b):
        one, two = self.dir / a, self.dir / b
        self.assertEqual(differences(one / "checkpoint.h5", two / "checkpoint.h5"), [])
        self.assertEqual(differences(one / "particles.h5", two / "particles.h5"), [])
        names = sorted(p.name for p in (one / "series").iterdir())
        self.assertEqual(names, sorted(p.name for p in (two / "series").iterdir()))
        for name in names:
            self.assertEqual((one / "series" / name).read_text(), (two / "series" / name).read_text(), name)
        first, second = frames(one), frames(two)
        self.assertEqual([f[:2] for f in first], [f[:2] for f in second])
        self.assertEqual(len(first), len({f[:2] for f in first}), "a frame stands twice")
        for (t, name, file), (_, _, other) in zip(first, second):
            if name == "particles":
                self.assertEqual(file, other)
                self.assertEqual((one / file).read_bytes(), (two / other).read_bytes(), file)
            else:  # a part at rest is drawn again after a resume
                self.assertTrue(numpy.array_equal(read_points(one / file), read_points(two / other)), f"{name} at {t}")
        left, right = self.summary(a), self.summary(b)
        for key in ("status", "time", "steps", "particles", "mass", "energy", "sensors", "events"):
            self.assertEqual(left[key], right[key], key)

    def test_killed_three_times(self):
        seed = random.randrange(10**6)
        print("random moments from seed", seed)
        moments = random.Random(seed)
        case = self.write(busy())
        self.runs(case, "-o", "straight")
        straight = self.summary("straight")
        # The case does what it is for: everything it holds has happened, and contacts have a history.
        self.assertEqual({e["name"] for e in straight["events"]}, {"stirred", "opened"})
        self.assertGreater(straight["mass"]["left_particles"], 0)
        self.assertGreater(straight["particles"], 80)
        self.assertGreater(straight["energy"]["plastic"], 0)
        words = [case, "-o", "killed"]
        for _ in range(3):
            code = self.stop_after_checkpoint(self.start(*words), "killed", signal.SIGKILL, moments.uniform(0, 0.08))
            self.assertEqual(code, -signal.SIGKILL)
            words = [case, "-o", "killed", "--resume"]
        self.runs(*words)
        self.assert_same_run("straight", "killed")

    def test_interrupted(self):
        case = self.write(busy())
        self.runs(case, "-o", "straight")
        for how, folder in ((signal.SIGINT, "by hand"), (signal.SIGTERM, "by the system")):
            process = self.start(case, "-o", folder)
            self.assertEqual(self.stop_after_checkpoint(process, folder, how, 0.03), INTERRUPTED)
            message = process.stderr.read()
            found = re.fullmatch(r"calx: interrupted at t = (\S+) s; last checkpoint at t = (\S+) s, go on with --resume\n", message)
            self.assertTrue(found, message)
            self.assertEqual(found[1], found[2])
            summary = self.summary(folder)
            self.assertEqual(summary["status"], "interrupted")
            self.assertAlmostEqual(summary["time"], float(found[1]), delta=1e-4)
            self.assertIn("interrupted at t =", summary["reason"])
            self.runs(case, "-o", folder, "--resume")
            self.assert_same_run("straight", folder)

    def test_until(self):
        case = self.write(busy())
        self.runs(case, "-o", "straight")
        # Moments on no multiple of any interval, and one on many.
        for until in (0.01234, 0.04, 0.0777):
            result = self.runs(case, "-o", "in parts", "--until", until, *(["--resume"] if until > 0.02 else []))
            self.assertRegex(result.err, r"done \(reached --until; go on with --resume\): t = ")
            self.assertAlmostEqual(self.summary("in parts")["time"], until, delta=2e-5)
            self.assertIn("--until", self.summary("in parts")["reason"])
        self.runs(case, "-o", "in parts", "--resume")
        self.assertNotIn("reason", self.summary("in parts"))
        self.assert_same_run("straight", "in parts")

    def test_checkpoint_in_the_step_of_a_row(self):
        # The step ends before the multiple that the row stands for, nearer than half a step.
        case = cup({"/time/step": 1.3e-5, "/output": {"frames_every": 0.005, "checkpoint_every": 0.005}})
        path = self.write(case)
        self.runs(path, "-o", "straight")
        for k in range(1, 10):
            self.runs(path, "-o", "in parts", "--until", 0.005 * k, *(["--resume"] if k > 1 else []))
        self.runs(path, "-o", "in parts", "--resume")
        self.assert_same_run("straight", "in parts")
        self.assertEqual(len(self.rows("in cup", "straight")), 1 + 11)

    def test_finished_run_is_left_as_it_is(self):
        # 0.0441 is a multiple of no interval, so the last row and frame are extra ones.
        path = self.write(cup({"/time/end": 0.0441}))
        self.runs(path, "-o", "once")
        self.runs(path, "-o", "twice")
        self.runs(path, "-o", "twice", "--resume")
        self.assert_same_run_within_digits("once", "twice")
        self.assertEqual(len(self.rows("in cup", "once")), 1 + 10)

    def assert_same_run_within_digits(self, a, b):
        # The last row of a sensor is read back from its series, which keeps nine digits.
        one, two = self.summary(a), self.summary(b)
        for name, sensor in one["sensors"].items():
            self.assertEqual(sensor["last"].keys(), two["sensors"][name]["last"].keys())
            for column, value in sensor["last"].items():
                self.assertAlmostEqual(value, two["sensors"][name]["last"][column], delta=1e-8 * abs(value))
        self.assertEqual(differences(self.dir / a / "checkpoint.h5", self.dir / b / "checkpoint.h5"), [])
        self.assertEqual(differences(self.dir / a / "particles.h5", self.dir / b / "particles.h5"), [])
        self.assertEqual([f[:2] for f in frames(self.dir / a)], [f[:2] for f in frames(self.dir / b)])
        for name in one["sensors"]:
            self.assertEqual(self.rows(name, a), self.rows(name, b))

    def test_changed_case_is_said(self):
        path = self.write(cup())
        self.runs(path, "-o", "out", "--until", 0.02)
        changed = ["--set", "/time/end=0.03", "--set", "/contacts/0/parameters/friction=0.1"]
        result = self.runs(path, "-o", "out", "--resume", *changed)
        self.assertIn("the case is not the one of the checkpoint any more: /contacts/0/parameters/friction, /time/end\n", result.err)
        self.assertIn("not the one of the checkpoint", self.summary("out")["notes"][0])
        self.assertAlmostEqual(self.summary("out")["time"], 0.03, delta=2e-5)


if __name__ == "__main__":
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    unittest.main(verbosity=2)
