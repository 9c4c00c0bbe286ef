"""Every scene of calx bench starts with few particles, runs a few steps and prints a row whose figures are sound. Nothing is
timed."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CALX = os.environ["CALX"]
SOURCE = pathlib.Path(os.environ["CALX_SOURCE"])
KEYS = ["bench", "calx", "git", "precision", "particles", "spheres", "threads", "rolling", "steps", "step_s", "wall_s",
        "particle_steps_per_second", "ns_per_particle_step", "ns_per_contact", "pairs_per_particle", "walls_per_particle",
        "entries_per_particle", "wall_entries_per_particle", "rebuilds", "share_neighbour", "share_contacts",
        "share_integrate", "share_other", "bytes_per_sphere", "peak_bytes_per_sphere", "time_s", "coordination", "kinetic_J",
        "floor_over_weight", "largest_overlap"]


class BenchTest(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="calx_bench_test_"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def calx(self, *words):
        return subprocess.run([CALX, "bench", *(str(word) for word in words)], cwd=SOURCE, text=True, timeout=200,
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)

    def rows(self, *words):
        done = self.calx(*words, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return [json.loads(line) for line in done.stdout.splitlines()]

    def row(self, name, *words, steps=10):
        rows = self.rows(name, "--steps", steps, "--warm-up", 2, *words)
        self.assertEqual(len(rows), 1)
        row = rows[0]
        self.assertEqual([key for key in KEYS if key not in row], [])
        self.assertEqual((row["bench"], row["steps"]), (name, steps))
        shares = [row[key] for key in row if key.startswith("share_")]
        self.assertTrue(all(0 <= share <= 1 for share in shares), row)
        self.assertAlmostEqual(sum(shares), 1, places=1)
        self.assertGreater(row["particle_steps_per_second"], 0)
        self.assertGreater(row["bytes_per_sphere"], 96)  # one record
        self.assertTrue(math.isfinite(row["peak_bytes_per_sphere"]))
        self.assertTrue(0 <= row["largest_overlap"] < 0.1, row)
        self.assertTrue(math.isfinite(row["kinetic_J"]) and row["kinetic_J"] >= 0)
        return row

    def bed(self, row):
        """The particles lie on each other and on the floor."""
        self.assertTrue(2 < row["coordination"] < 7, row)
        self.assertTrue(0.8 < row["floor_over_weight"] < 1.2, row)
        self.assertGreaterEqual(row["entries_per_particle"], row["pairs_per_particle"])
        self.assertGreater(row["wall_entries_per_particle"], 0)
        self.assertLess(row["mean_height_m"], 0.03)

    def test_settled(self):
        row = self.row("settled", "--particles", 300, "--save-start", self.dir / "start", "--save", self.dir / "tile.csv",
                       steps=200)
        self.assertEqual(row["particles"], 300)
        self.assertAlmostEqual(row["coordination"], 2 * row["pairs_per_particle"], places=3)
        self.bed(row)
        again = self.row("settled", "--start", self.dir / "start", "--threads", 2, steps=200)
        for key in ("coordination", "kinetic_J", "floor_over_weight", "entries_per_particle", "rebuilds"):
            self.assertEqual(again[key], row[key], key)
        # Eight copies of the tile side by side, four as long as two are wide.
        tiled = self.row("settled", "--start", self.dir / "tile.csv", "--particles", 2400)
        self.assertEqual(tiled["particles"], 2400)
        self.assertAlmostEqual(tiled["mean_height_m"], row["mean_height_m"], places=4)

    def test_rolling_and_overrides(self):
        self.row("settled", "--particles", 100, "--settle", 0, "--save-start", self.dir / "a", "--rolling", 0.1)
        case = json.loads((self.dir / "a/case.json").read_text())
        parameters = case["contacts"][0]["parameters"]
        self.assertEqual((parameters["rolling"], parameters["rolling_friction"]), ("epsd2", 0.1))
        # A narrow margin lists fewer pairs.
        wide, narrow = (self.row("settled", "--start", self.dir / "a", "--set", f"/neighbour={{\"skin\": {skin}}}")
                        for skin in (1e-3, 1e-5))
        self.assertGreater(wide["entries_per_particle"], narrow["entries_per_particle"])

    def test_pour(self):
        row = self.row("pour", "--particles", 300, "--settle", 0.05)
        mass = 300 * 2100 * math.pi / 6 * 2.5e-3 ** 3
        # Half of it falls at 1.5 m/s.
        self.assertTrue(0.3 < row["kinetic_J"] / (0.25 * mass * 1.5 ** 2) < 1.7, row)

    def test_sizes(self):
        self.row("sizes", "--particles", 300, "--settle", 0.002, "--save-start", self.dir / "a")
        lines = (self.dir / "a/bed.csv").read_text().splitlines()
        scales = {float(line.split(",")[-1]) for line in lines[1:]}
        self.assertEqual(scales, {2, 1.4, 1, 0.6, 0.4})

    def test_clumps(self):
        for law in ("calx.epam", "calx.hertz-mindlin"):
            row = self.row("clumps", "--particles", 100, "--settle", 0.12, "--law", law, steps=50)
            self.assertEqual((row["particles"], row["spheres"]), (100, 200))
            self.assertTrue(1.5 < row["coordination"] < 7, row)
            # Two clumps may touch in several places.
            self.assertGreaterEqual(2 * row["pairs_per_particle"] + 1e-3, row["coordination"])

    def test_penetration(self):
        row = self.row("penetration", "--particles", 200, "--settle", 0.02)
        self.assertEqual(row["particles"], 201)
        fallen = row["time_s"]
        self.assertAlmostEqual(row["ball_vz_m_s"], -5 - 9.81 * fallen, places=4)
        self.assertAlmostEqual(row["ball_z_m"], 0.06 - 5 * fallen, places=6)

    def test_drum(self):
        row = self.row("drum", "--particles", 380, "--settle", 0.1)
        low = row["M1_x_below_z_below"] + row["M2_x_below_z_below"]
        high = row["M1_x_above_z_above"] + row["M2_x_above_z_above"]
        self.assertGreater(low, 100)
        self.assertLess(high, 20)

    def test_drum_turns(self):
        self.row("drum", "--particles", 380, "--settle", 0, "--save-start", self.dir / "a")
        case = json.loads((self.dir / "a/case.json").read_text())
        self.assertEqual(case["motions"]["turn"]["parameters"]["rows"][1], [1, 2, 0])
        triangles = (self.dir / "a/drum.stl").read_text().count("facet normal")
        self.assertEqual(triangles, 1200)

    def test_chute(self):
        # Gravity alone: sin 26 degrees along the slope.
        for base in ("bumps", "plane"):
            row = self.row("chute", "--particles", 200, "--settle", 0, "--base", base)
            self.assertAlmostEqual(row["flow_speed_m_s"] / (math.sin(math.radians(26)) * row["time_s"]), 1, places=1)
        row = self.row("chute", "--particles", 200, "--settle", 1)
        self.assertGreater(row["walls_per_particle"], 0)

    def test_fill(self):
        case = "examples/canister_fill/first_fill.json"
        row = self.row("fill", "--case", case, "--at", 0.0004, steps=5)
        self.assertGreaterEqual(row["time_s"], 0.0004)
        self.assertAlmostEqual(row["mass_in_hopper_kg"], 0.17, places=3)
        self.assertEqual(row["mass_in_canister_kg"], 0)
        self.assertIsNone(row["wall_s_per_cycle"])
        self.assertGreater(row["wall_s_per_simulated_s"], 0)

    def test_law(self):
        rows = self.rows("law", "--steps", 1, "--rolling", 0.1, "--save-start", self.dir / "bodies")
        head_on = [row for row in rows if row.get("gate", "").endswith(" 0 deg")]
        self.assertEqual(len(head_on), 12)
        for row in head_on:
            self.assertAlmostEqual(row["normal_ratio"], row["restitution_asked"], delta=0.002, msg=row["gate"])
            self.assertEqual(row["spin_rad_s"], [0, 0, 0])
        # Three angles, pairs and floor, three restitutions. Friction slows the slide and turns the ball.
        oblique = [row for row in rows if "tangential_ratio" in row]
        self.assertEqual(len(oblique), 18)
        for row in oblique:
            self.assertTrue(0.2 < row["tangential_ratio"] < 1, row)
            self.assertNotEqual(row["spin_rad_s"], [0, 0, 0])
        rolling = next(row for row in rows if row.get("gate") == "rolling")
        self.assertAlmostEqual(rolling["speed_after_m_s"], rolling["speed_expected_m_s"], delta=2e-4)
        timed = {(row["law"], row["scalar"], row["rows"]) for row in rows if "law" in row}
        self.assertEqual(timed, {(law, scalar, n) for law in ("calx.hertz-mindlin", "calx.epam") for scalar in ("f32", "f64")
                                 for n in (8, 64, 256, 1024)})
        self.assertEqual(len((self.dir / "bodies/bodies.csv").read_text().splitlines()), 16)

    def test_text(self):
        done = self.calx("settled", "--particles", 50, "--settle", 0, "--steps", 5)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?m)^  particles +50$")

    def test_refusals(self):
        for words, text in ((["nothing"], "nothing"), (["clumps", "--law", "calx.linear"], "--law calx.linear"),
                            (["chute", "--base", "sand"], "--base sand"), (["settled", "--set", "x"], "--set x"),
                            (["settled", "--precision", "half"], "--precision half"),
                            (["settled", "--start", "no-such-file"], "no-such-file"), (["fill", "--case", "no.json"], "no.json")):
            done = self.calx(*words)
            self.assertNotEqual(done.returncode, 0, words)
            self.assertIn(text, done.stderr)
        # Settings are the case's to accept or refuse.
        done = self.calx("settled", "--particles", 50, "--settle", 0, "--set", "/no_such_key=1")
        self.assertEqual(done.returncode, 3)
        self.assertIn("no_such_key", done.stderr)


if __name__ == "__main__":
    unittest.main()
