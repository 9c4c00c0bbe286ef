"""calx paper on tiny runs: what is computed, what is kept, what a changed or stopped run leads to, and bad requests."""
import fcntl
import json
import signal
import subprocess
import time
import unittest

from calx import CALX, CASE, FILES, INTERRUPTED, NUMERICS, USAGE, CalxTest, cup

ROW = {"name": "mass in the cup", "group": "cup", "unit": "g", "measured": {"value": 5, "where": "made up"},
       "calx": {"run": "pour", "sensor": "in cup", "column": "mass_kg"}}


class Paper(CalxTest):
    def rows(self, end=0.02, seeds=(1, 2), rows=(ROW,), **more):
        """A rows file about CUP, whose full form lasts longer."""
        self.write(cup({"/time/end": end}))
        runs = {"pour": {"seeds": list(seeds), "full": {"case": "case.json"},
                         "reduced": {"case": "case.json", "set": {"/sources/0/count": 20}, "reduced": ["20 balls"]}}}
        return self.write({"calx_paper": 1, "title": "Cup", "source": "nobody", "runs": {**runs, **more}, "rows": list(rows)},
                          "rows.json")

    def paper(self, *words):
        return self.calx("paper", "rows.json", *words)

    def summary_of(self, seed, form="reduced", run="pour"):
        return self.dir / "paper.out/runs" / run / form / f"seed-{seed}" / "summary.json"

    def page(self):
        return (self.dir / "paper.out/paper.html").read_text()

    def test_runs_are_computed_once_and_again_when_their_case_changes(self):
        self.rows()
        first = self.paper()
        self.assertEqual(first.code, 0, first.err)
        self.assertIn("0 of 2 runs are finished and kept; 2 to compute", first.err)
        self.assertEqual(first.out.strip(), "paper.out/paper.html")
        masses = [json.loads(self.summary_of(s).read_text())["sensors"]["in cup"]["last"]["mass_kg"] for s in (1, 2)]
        # 20 balls of glass of 2 mm radius.
        self.assertAlmostEqual(masses[0], 20 * 2500 * 4 / 3 * 3.14159265 * 0.002**3, 9)
        self.assertEqual(*masses)
        # 20 * 83.78 mg = 1.6755 g against 5 g
        self.assertIn("1.6755\u00a0g", self.page())
        self.assertIn("underestimate, -3.32\u00a0g (-66.5\u00a0%)", self.page())
        self.assertIn("20 balls", self.page())

        before = [self.summary_of(s).stat().st_mtime_ns for s in (1, 2)]
        self.assertIn("2 of 2 runs are finished and kept; 0 to compute", self.paper().err)
        self.assertEqual(before, [self.summary_of(s).stat().st_mtime_ns for s in (1, 2)])

        self.rows(end=0.025)
        self.paper("--page-only")
        self.assertIn("its case has changed since it ran with seed 1, 2", self.page())
        self.assertIn("1 to compute", self.paper("--seeds", 1).err)
        self.assertNotEqual(before[0], self.summary_of(1).stat().st_mtime_ns)
        self.assertEqual(before[1], self.summary_of(2).stat().st_mtime_ns)

    def test_rows_and_forms_are_chosen(self):
        other = {"other": {"seeds": [7], "reduced": {"case": "case.json", "set": {"/sources/0/count": 5}, "reduced": ["5 balls"]}}}
        self.rows(rows=(ROW, {**ROW, "name": "second", "calx": {**ROW["calx"], "run": "other"}}), **other)
        self.assertEqual(self.paper("--rows", "second", "--quiet").code, 0)
        self.assertFalse(self.summary_of(1).exists())
        self.assertTrue(self.summary_of(7, run="other").exists())
        self.assertEqual(self.paper("--full", "--seeds", 1, "--threads", 1, "--quiet").code, 0)
        self.assertEqual(json.loads(self.summary_of(1, "full").read_text())["particles"], 60)
        self.assertFalse(self.summary_of(2, "full").exists())
        self.fails(USAGE, 'no such row in rows.json; did you mean "second"', result=self.paper("--rows", "secnd"))

    def test_an_interrupted_paper_goes_on_and_repeats_nothing(self):
        self.rows(end=30, seeds=(1,))
        process = subprocess.Popen([CALX, "paper", "rows.json"], cwd=self.dir, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        checkpoint = self.summary_of(1).parent / "checkpoint.h5"
        limit = time.monotonic() + 60
        while not checkpoint.exists():
            self.assertLess(time.monotonic(), limit, "no checkpoint within a minute")
            time.sleep(0.01)
        self.fails(FILES, "another calx paper computes runs there", result=self.paper())
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), INTERRUPTED)
        self.assertIn("interrupted; the same command goes on", process.stderr.read())
        stopped = json.loads(self.summary_of(1).read_text())
        self.assertEqual(stopped["status"], "interrupted")
        self.assertIn("not finished (interrupted", self.page())
        # The run goes on where it was: killed with the whole command, it is there to be gone on with as well.
        process = subprocess.Popen([CALX, "paper", "rows.json", "--quiet"], cwd=self.dir, stderr=subprocess.DEVNULL)
        log = self.summary_of(1).parent / "run.log"
        while "resumed at t = " not in log.read_text():
            self.assertLess(time.monotonic(), limit, "not resumed within a minute")
            time.sleep(0.01)
        process.kill()
        process.wait(60)
        # The children end with their parent; then the folder is free.
        with open(self.dir / "paper.out/lock", encoding="ascii") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        while json.loads(self.summary_of(1).read_text())["status"] != "interrupted":
            self.assertLess(time.monotonic(), limit, "a run went on without its parent")
            time.sleep(0.02)
        self.assertGreaterEqual(json.loads(self.summary_of(1).read_text())["steps"], stopped["steps"])

    def test_a_run_that_fails_is_named_and_the_others_are_kept(self):
        bad = {"bad": {"seeds": [1], "reduced": {"case": "case.json", "set": {"/overlap_limit": 1e-9, "/time/end": 0.05}, "reduced": ["nothing"]}}}
        self.rows(seeds=(1,), rows=(ROW, {**ROW, "name": "second", "calx": {**ROW["calx"], "run": "bad"}}), **bad)
        result = self.paper()
        self.assertEqual(result.code, NUMERICS, result.err)
        self.assertRegex(result.err, r"not every run ended well:\n  bad, seed 1: .*overlap")
        self.assertTrue(self.summary_of(1).exists())
        self.assertIn("1.676\u00a0g", self.page())
        self.assertIn("not finished (stopped", self.page())

    def test_bad_requests(self):
        self.fails(USAGE, "examples/paper/rows.json is not below the working directory", result=self.calx("paper"))
        self.fails(FILES, "none.json", result=self.calx("paper", "none.json"))
        self.rows(rows=({**ROW, "calx": {**ROW["calx"], "run": "por"}},))
        self.fails(CASE, r'rows.json /rows/0/calx/run: no run is called "por"; did you mean "pour"\?', result=self.paper())
        self.rows()
        self.write("{", "case.json")
        self.fails(CASE, "case.json", result=self.paper())


if __name__ == "__main__":
    unittest.main()
