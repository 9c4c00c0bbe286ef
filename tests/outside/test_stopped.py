"""Runs that go wrong on the way: exit code 5, which particle, where and when; what was computed before stays."""
import unittest

import h5py

from calx import NUMERICS, CalxTest, cup
from test_bad_plugin import build_force

# A force that is wrong from t = 0.02 s on, for the first particle of each block.
BAD_FORCE = """#define BAD_OWN_EVAL
#include <math.h>
#include <calx/particle_force.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  (void)self;
  if (block->time > 0.02) block->%s
}"""


class Stopped(CalxTest):
    def stops(self, path, *texts, words=(), at):
        """The run stops at about that time with exit code 5, and keeps what it had; gives the summary."""
        result = self.calx("run", path, "-o", "out", *words)
        line = self.fails(NUMERICS, r"run stopped at t = [\d.]+ s: ", *texts, r"last checkpoint at t = \S+ s", result=result)
        summary = self.summary("out")
        self.assertEqual(summary["status"], "stopped")
        self.assertTrue(line.startswith("calx: " + summary["reason"]), line)
        self.assertAlmostEqual(summary["time"], at, delta=1e-3)
        # Every row up to the stop, whole lines only.
        rows = self.rows("in cup", "out")
        self.assertEqual(len(rows), 2 + int(summary["time"] / 0.005))
        self.assertEqual({len(r) for r in rows}, {6})
        # Every frame up to the stop, and the last checkpoint before it.
        with h5py.File(self.dir / "out" / "particles.h5", "r") as file:
            times = file["particles/spheres/position/time"][:]
        self.assertGreaterEqual(len(times), 1 + int(summary["time"] / 0.01))
        with h5py.File(self.dir / "out" / "checkpoint.h5", "r") as file:
            saved = int(file["steps"][()].item()) * float(file["time_step"][()].item())
        self.assertAlmostEqual(saved, 0.01 * int(summary["time"] / 0.01), delta=2e-5)
        log = (self.dir / "out" / "run.log").read_text()
        self.assertIn("error run stopped at t = ", log)
        self.assertTrue((self.dir / "out" / "report.html").exists())
        return summary

    def test_particle_leaves_the_domain(self):
        # The floor is missing, so all fall out.
        path = self.write(cup({"/parts/0/parameters/open_bottom": "yes", "/domain/min": [-0.05, -0.05, -0.003]}))
        self.stops(path, r"particle \d+ left the domain at \(.* m with velocity \(.* m/s", 'make "domain" larger', '"on_leave"', at=0.0438)
        # As the message says.
        self.runs(path, "-o", "out", "--overwrite", "--set", "/domain/on_leave=delete")
        self.assertGreater(self.summary("out")["mass"]["left_particles"], 3)
        self.assertTrue(self.summary("out")["mass"]["closes"])

    def test_not_a_number(self):
        build_force(self.dir / "mine", BAD_FORCE % "fx[0] += sqrt(-1.0 - block->time);")
        path = self.write(cup({"/forces": [{"plugin": "test.force"}]}))
        self.stops(path, r"non-finite motion of particle \d+: position x, velocity x, last known at \([-\d., e]+\) m; ",
                   words=("--plugin-path", "mine"), at=0.02)

    def test_blow_up(self):
        # 40 N on a ball of 0.08 g.
        build_force(self.dir / "mine", BAD_FORCE % "fz[0] -= 40;")
        path = self.write(cup({"/forces": [{"plugin": "test.force"}]}))
        self.stops(path, r"overlap of [\d.]+ of the radius at \(", r"particle \d+", 'the limit is 0.5 \\("overlap_limit"\\)',
                   words=("--plugin-path", "mine"), at=0.0203)

    def test_go_on_after_a_stop(self):
        build_force(self.dir / "mine", BAD_FORCE % "fx[0] += sqrt(-1.0 - block->time);")
        path = self.write(cup({"/forces": [{"plugin": "test.force"}]}))
        self.stops(path, "non-finite", words=("--plugin-path", "mine"), at=0.02)
        # Repaired, the run goes on from the last good checkpoint to the same end as if nothing had been.
        build_force(self.dir / "mine", "")
        self.runs(path, "-o", "out", "--plugin-path", "mine", "--resume")
        self.runs(path, "-o", "good", "--plugin-path", "mine")
        self.assertEqual(self.summary("out")["energy"], self.summary("good")["energy"])
        self.assertEqual(self.rows("energy", "out"), self.rows("energy", "good"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
