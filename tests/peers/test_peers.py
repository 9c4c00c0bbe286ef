"""The evaluation rules on piles, beds and curves whose answers are known, and the cases of the points pass calx check."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
try:
    import numpy as np

    import evaluate
    import peers
    import wheat_fill
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

D = 0.0037


def cone(degrees, seed, diameters=12):
    """Spheres of one size below the surface of a cone so many diameters high, as dense as a packing."""
    random = np.random.default_rng(seed)
    height = diameters * D
    reach = height / np.tan(np.radians(degrees))
    box = (2 * reach) ** 2 * height
    count = int(0.6 * box / (np.pi / 6 * D**3))
    x, y = random.uniform(-reach, reach, (2, count))
    z = random.uniform(D / 2, height, count)
    inside = z + D / 2 <= height - np.tan(np.radians(degrees)) * np.hypot(x, y)
    return x[inside], y[inside], z[inside], np.full(inside.sum(), D / 2)


class Rules(unittest.TestCase):
    def test_cones_have_their_angles(self):
        for degrees in (15, 25, 35):
            found = evaluate.pile_angle(*cone(degrees, 1))
            self.assertLess(abs(found - degrees), 0.9, (degrees, found))

    def test_piles_may_stand_aside_and_be_low(self):
        x, y, z, r = cone(25, 1)
        self.assertAlmostEqual(evaluate.pile_angle(x + 0.02, y - 0.01, z, r), evaluate.pile_angle(x, y, z, r), delta=0.1)
        # Below 4 d the source's rule reads 0.7 of the slope: measured over five seeds 0.70 to 0.73 of 3 degrees.
        found = [evaluate.pile_angle(*cone(3, seed, 3.5)) / 3 for seed in range(1, 6)]
        self.assertAlmostEqual(np.mean(found), 0.716, delta=0.02)

    def test_a_column_counts_centres_between_2_d_and_2_d_below_the_99th_percentile(self):
        # Layers of one sphere 1 d apart, centres at 0.5 d ... 99.5 d: tops at 1 d ... 100 d, their 99th percentile 99.01 d.
        # Centres from 2.5 d to 96.5 d lie between 2 d and 97.01 d: 95 spheres.
        r = np.full(100, 0.5)
        found = evaluate.column_density(np.arange(100) + 0.5, r, 1000, 2.0)
        self.assertAlmostEqual(found, 1000 * 95 * np.pi / 6 / (2.0 * (97.01 - 2)), delta=1e-9)

    def test_the_free_choices_of_a_drum_tell_its_results_apart(self):
        words = "peers.py drum 15 --seed 1 --friction {} --rolling-friction 0.1 --pellets 31100 --spin-up 1.5"
        names = [peers.setting({"point": "drum 15", "command": words.format(f)}) for f in (0.5, 0.8)]
        self.assertEqual(names[1], "drum 15, friction 0.8, rolling 0.1, 31100 pellets")
        self.assertNotEqual(*names)
        self.assertEqual(peers.setting({"point": "lift 1", "command": "peers.py lift 1 --seed 1"}), "lift 1")

    def test_rate_is_the_slope_of_the_middle(self):
        time = np.linspace(0, 10, 1001)
        mass = np.clip(0.05 * (time - 2), 0, 0.3)
        self.assertAlmostEqual(evaluate.rate(time, mass), 0.05, delta=1e-12)

    def test_curves_a_millimetre_apart_are_a_millimetre_apart(self):
        x = np.linspace(-0.03, 0.03, 601)
        theirs = np.column_stack([x, -0.5 * x])
        rms, area = peers.surface_errors((x, -0.5 * x + 1e-3), theirs, 0.042)
        self.assertAlmostEqual(rms, 1e-3, delta=1e-12)
        # Inside sqrt(0.6) R the line reaches sqrt(0.6) R / sqrt(1.25) to either side.
        self.assertAlmostEqual(area, 1e-3 * 2 * np.sqrt(0.6 / 1.25) * 0.042, delta=1e-7)


class Starts(unittest.TestCase):
    def test_the_wheat_starts_inside_without_overlaps_in_the_shares_given(self):
        r = wheat_fill.radii(400)
        places = wheat_fill.places(r, 1)
        self.assertLessEqual((np.hypot(places[:, 0], places[:, 1]) + r).max(), 0.0375)
        self.assertGreaterEqual((places[:, 2] - r).min(), 0.003)
        self.assertLessEqual((places[:, 2] + r).max(), 0.085)
        apart = np.linalg.norm(places[:, None] - places[None], axis=2) - (r[:, None] + r[None])
        self.assertGreaterEqual(apart[~np.eye(len(r), dtype=bool)].min(), 0)
        shares = [np.sum(r[r == one] ** 3) / np.sum(r**3) for one in (0.0017, 0.00185, 0.0020)]
        # Half a sphere in 400 is half a percent of the mass at most.
        np.testing.assert_allclose(shares, [0.25, 0.5, 0.25], atol=0.005)
        self.assertTrue((places == wheat_fill.places(r, 1)).all())

    def test_a_start_file_becomes_a_case_that_passes_the_check(self):
        with tempfile.TemporaryDirectory() as folder:
            start = pathlib.Path(folder) / "start.txt"
            start.write_text("Radius[m] PosX[m] PosY[m] PosZ[m]\n 0.002 0 0 -0.05\n 0.001 0.01 0 -0.05\n 0.001 0.02 0 -0.05\n"
                             " 5 0.01 0.01 0 0 0.06\n")
            for kind, count in (("penetration", 2), ("soft-drum", 3), ("full-drum", 3)):
                path, found = peers.dosta.write_case(kind, start, folder)
                self.assertEqual(found, count)
                done = subprocess.run([os.environ["CALX"], "check", str(path)], capture_output=True, text=True)
                if done.returncode == 4:
                    self.skipTest(done.stderr)
                self.assertEqual(done.returncode, 0, (kind, done.stderr))


class Cases(unittest.TestCase):
    def test_every_case_passes_the_check(self):
        for path in sorted((HERE / "cases").glob("*.json")):
            done = subprocess.run([os.environ["CALX"], "check", str(path)], capture_output=True, text=True)
            if done.returncode == 4:  # a plugin folder was deleted, as any may be
                self.skipTest(done.stderr)
            self.assertEqual(done.returncode, 0, (path, done.stderr))

    def test_results_name_the_command_that_made_them(self):
        for line in peers.RESULTS.read_text(encoding="ascii").splitlines():
            row = peers.json.loads(line)
            self.assertTrue(row["command"].startswith("peers.py "), row)
            self.assertIn("theirs", row)


if __name__ == "__main__":
    unittest.main(verbosity=2)
