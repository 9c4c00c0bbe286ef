"""What peers.py makes of starts, gate rows and results, with a program in the place of the peers. Nothing is timed."""
import contextlib
import io
import json
import os
import pathlib
import sys
import tempfile
import types
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
try:
    import numpy
except ImportError:
    sys.exit(77)
import codes  # noqa: E402 pylint: disable=wrong-import-position
import gate  # noqa: E402 pylint: disable=wrong-import-position
import goals  # noqa: E402 pylint: disable=wrong-import-position
import peers  # noqa: E402 pylint: disable=wrong-import-position
import starts  # noqa: E402 pylint: disable=wrong-import-position

LOG = """LIGGGHTS (Version TEST)
    Step    Atoms         KinEng          touch
       0       3            1.5            2.0
Loop time of 9.0 on 1 procs for 2 steps with 3 atoms
Ave neighs/atom = 9
Neighbor list builds = 9
    Step    Atoms         KinEng          touch
       2       3            1.5            2.0
      12       3           0.25            4.5
Loop time of 0.5 on 1 procs for 10 steps with 3 atoms
Ave neighs/atom = 4.25
Neighbor list builds = 7
"""


def options(folder, **more):
    return types.SimpleNamespace(scratch=str(folder), calx=os.environ["CALX"], threads=[1], state="settled", quiet=0, dry=True,
                                 machine="test", rounds=1, steps=None, warm_up=None, codes=None, done=[], **more)


class PeersTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def program(self, name, text):
        """A program of that name, first on the path, that prints the text."""
        path = self.dir / name
        path.write_text(f"#!/bin/sh\ncat <<'END'\n{text}END\n")
        path.chmod(0o755)
        before = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", before)
        os.environ["PATH"] = f"{self.dir}:{before}"

    def test_start_files(self):
        x, v = numpy.array([[1, 2, 3.0], [4, 5, 6]]), numpy.array([[0, 0, -1.5], [0.5, 0, 0]])
        starts.write_csv(self.dir / "a.csv", x, v)
        rows = starts.read_csv(self.dir / "a.csv")
        rows["scale"] = numpy.array([1.0, 0.4])
        starts.write_data(self.dir / "a.data", rows, 1.25e-3, 2100, [(0, 5), (0, 6), (0, 7)])
        lines = (self.dir / "a.data").read_text().splitlines()
        self.assertIn("2 atoms", lines)
        self.assertIn("0 6 ylo yhi", lines)
        self.assertIn("1 1 0.0025 2100 1 2 3", lines)
        self.assertIn("2 1 0.001 2100 4 5 6", lines)
        self.assertIn("1 0 0 -1.5 0 0 0", lines)

    def test_the_tile_is_what_is_stored(self):
        rows = starts.read_csv(starts.tile("settled"))
        stored = numpy.load(HERE / "data/A10k_settled.npz")
        self.assertEqual(len(rows["x_m"]), 10000)
        self.assertTrue((rows["z_m"] == stored["x"][:, 2]).all())

    def test_the_second_run_is_the_one_that_counts(self):
        self.program("liggghts", LOG)
        files = {"data": "a", "lx": 1, "ly": 1, "step": 1e-5, "skin": 1e-4, "spheres": 3, "particles": 3}
        found = codes.run("liggghts", "settled", 1, files, options(self.dir), 10, 2, 0.0)
        self.assertEqual((found["wall_s"], found["rate"], found["rebuilds"]), (0.5, 60, 7))
        self.assertEqual((found["coordination"], found["kinetic_translation_J"], found["entries_per_particle"]),
                         (4.5, 0.25, 4.25))
        self.assertGreater(found["peak_bytes"], 0)

    def test_lost_particles_are_noticed(self):
        self.program("liggghts", LOG)
        files = {"data": "a", "lx": 1, "ly": 1, "step": 1e-5, "skin": 1e-4, "spheres": 4, "particles": 4}
        with self.assertRaisesRegex(codes.Refused, "not two runs of 4 spheres"):
            codes.run("liggghts", "settled", 1, files, options(self.dir), 10, 2, 0.0)

    def test_a_code_that_fails_the_gate_is_not_timed(self):
        rows = gate.calx_rows(options(self.dir), self.dir / "gate", 0.0, "liggghts", "settled")
        bodies = {e: [row for row in rows if row["restitution_asked"] == e] for e in (0.3, 0.5, 0.9)}

        def answer(wrong):
            def bodies_of(code, folder, ours, *_):
                v, w = numpy.zeros((15, 3)), numpy.zeros((15, 3))
                for row in bodies[ours[0]["restitution_asked"]]:
                    v[row["body"]], w[row["body"]] = row["velocity_m_s"], row["spin_rad_s"]
                v[11] *= wrong  # head-on, on the floor, at 1 m/s
                return v, w
            return bodies_of

        real = gate.peer_bodies
        self.addCleanup(setattr, gate, "peer_bodies", real)
        for wrong, passes in ((1.0, True), (1.02, False), (float("nan"), False)):
            gate.peer_bodies = answer(wrong)
            passed, lines = gate.check("liggghts", "settled", 0.0, options(self.dir))
            self.assertEqual(passed, passes, lines)
            self.program("liggghts", LOG)
            with contextlib.redirect_stdout(io.StringIO()) as text:
                wanted = peers.passing(["calx", "liggghts"], "settled", 0.0, options(self.dir))
            self.assertEqual(wanted, ["calx", "liggghts"] if passes else ["calx"])
            self.assertEqual("does not pass the gate" in text.getvalue(), not passes)

    def test_refused_jobs_are_left_out_and_orders_rotate(self):
        order = []

        class Job(peers.Job):
            def run(self, _, number):
                if self.code == "refuses":
                    raise codes.Refused("no")
                order.append(self.name)
                self.results.append({"rate": 10.0 * (number + 1)})

        jobs = [Job("settled", "a", 1), Job("settled", "refuses", 1), Job("settled", "b", 1)]
        with contextlib.redirect_stderr(io.StringIO()):
            peers.rounds(jobs, options(self.dir), 3)
        self.assertEqual(order, ["a", "b", "b", "a", "a", "b"])
        self.assertEqual(jobs[1].results, [])
        self.assertEqual(jobs[0].values(), [10, 20, 30])

    def test_table(self):
        table = goals.Table()
        table.add("fast", [10.0, 30.0, 25.0], 20, "M/s")
        table.add("small", [450.0], 400, "", False)
        table.add("absent", [], 1, "", note="why")
        with contextlib.redirect_stdout(io.StringIO()) as text:
            table.show()
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.getvalue().splitlines()]
        self.assertEqual(rows[2][:4], ["fast", "25 M/s", "10 to 30", "met"])
        self.assertEqual(rows[3][:4], ["small", "450", "450 to 450", "not met"])
        self.assertEqual(rows[4], ["absent", "-", "-", "not measured", "why"])

    def test_best_peer(self):
        def job(name, rates):
            return types.SimpleNamespace(name=name, results=[{"rate": r} for r in rates], values=lambda: rates)
        values, note = goals.over_best(job("calx", [30.0, 40.0]), [job("slow", [1.0, 1.0]), job("best", [10.0, 8.0])])
        self.assertEqual((values, note), ([3.0, 5.0], "against best"))
        self.assertEqual(goals.over_best(job("calx", [1.0]), [])[1], "no peer ran")

    def test_rows_of_calx_are_read(self):
        files = {"folder": self.dir / "start", "particles": 50}
        codes.output([os.environ["CALX"], "bench", "settled", "--particles", 50, "--settle", 0, "--steps", 1, "--save-start",
                      files["folder"]])
        job = peers.Job("settled", "calx", 50)
        found = codes.run("calx", "settled", 1, files, options(self.dir), 5, 1, 0.0)
        job.results = [json.loads(json.dumps(found))]
        self.assertEqual(job.values(), [found["rate"]])
        self.assertEqual(job.values("bytes_per_sphere"), [found["calx"]["bytes_per_sphere"]])
        with contextlib.redirect_stdout(io.StringIO()) as text:
            peers.show([job])
        self.assertIn("list entries; 0 rebuilds", text.getvalue())


if __name__ == "__main__":
    unittest.main()
