"""What a finished run leaves: every figure of summary.json, series, frames that open with VTK, particles.h5."""
import hashlib
import json
import re
import unittest

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from calx import CalxTest, busy, cup


class Files(CalxTest):
    def test_summary(self):
        path = self.write(cup())
        self.runs(path, "--threads", 2)
        summary = self.summary()
        self.assertLessEqual({"status", "time", "steps", "particles", "mass", "energy", "sensors", "wall_seconds",
                              "particle_steps_per_second", "provenance", "assumptions"}, summary.keys())
        self.assertEqual((summary["status"], summary["particles"], summary["title"]), ("done", 60, "balls in a cup"))
        self.assertNotIn("reason", summary)
        self.assertAlmostEqual(summary["time"], 0.05, delta=1e-5)
        self.assertAlmostEqual(summary["time"], summary["steps"] * summary["time_step"], delta=1e-12)
        each = 2500 * 4 / 3 * numpy.pi * 0.002**3
        mass = summary["mass"]
        self.assertAlmostEqual(mass["inserted"], 60 * each, delta=1e-9)
        self.assertAlmostEqual(mass["regions"]["cup"], 60 * each, delta=1e-9)
        self.assertEqual((mass["left"], mass["inserted_particles"], mass["inside_particles"], mass["closes"]), (0, 60, 60, True))
        energy = summary["energy"]
        parts = sum(energy[k] for k in ("kinetic_translation", "kinetic_rotation", "gravity", "elastic", "friction", "damping", "plastic"))
        self.assertAlmostEqual(energy["inserted"] + energy["wall_work"] + energy["force_work"] - energy["removed"] - parts,
                               energy["remainder"], delta=1e-12)
        self.assertLess(abs(energy["remainder"]), 0.01 * energy["inserted"])
        self.assertEqual(summary["sensors"].keys(), {"in cup", "energy"})
        self.assertAlmostEqual(summary["sensors"]["in cup"]["last"]["mass_kg"], 60 * each, delta=1e-9)
        self.assertGreater(summary["wall_seconds"], 0)
        self.assertAlmostEqual(summary["particle_steps_per_second"] * summary["wall_seconds"], 60 * summary["steps"], delta=1)
        self.assertEqual(summary["assumptions"], ["every value is made up"])
        proof = summary["provenance"]
        self.assertRegex(proof["calx"], r"^\d+\.\d+\.\d+$")
        self.assertRegex(proof["git"], r"^([0-9a-f]{9}\+?|unknown)$")
        self.assertRegex(proof["abi"], r"^\d+\.\d+$")
        self.assertEqual((proof["seed"], proof["precision"], proof["threads"]), (1, "double", 2))
        self.assertRegex(proof["device"], "^cpu")
        self.assertEqual([p["id"] for p in proof["plugins"]], ["calx.box", "calx.hertz-mindlin"])
        for plugin in proof["plugins"]:
            self.assertRegex(plugin["version"], r"^\d+\.\d+\.\d+$")
            with open(plugin["path"], "rb") as file:
                self.assertEqual(plugin["sha256"], hashlib.sha256(file.read()).hexdigest())
        case = (self.dir / "case.out" / "case.json").read_bytes()
        self.assertEqual(proof["case_sha256"], hashlib.sha256(case).hexdigest())
        # Defaults are filled in.
        resolved = json.loads(case)
        self.assertEqual((resolved["gravity"], resolved["seed"], resolved["time"]["integrator"]), ([0, 0, -9.81], 1, "euler"))

    def test_series(self):
        self.runs(self.write(cup()))
        rows = self.rows("in cup")
        self.assertEqual(rows[0][:3], ["time_s", "mass_kg", "particles_1"])
        times = [float(r[0]) for r in rows[1:]]
        self.assertEqual(len(times), 11)
        for k, t in enumerate(times):
            self.assertAlmostEqual(t, 0.005 * k, delta=2e-5)
        heights = [float(r[rows[0].index("centre_z_m")]) for r in rows[1:]]
        # Free fall at first: the first rows tell the acceleration.
        t, z = times[:4], heights[:4]
        self.assertAlmostEqual(2 * numpy.polyfit(t, z, 2)[0], -9.81, delta=0.05)

    def test_frames(self):
        self.runs(self.write(busy()))
        folder = self.dir / "case.out"
        entries = re.findall(r'<DataSet timestep="([^"]+)" group="" part="(\d+)" name="([^"]+)" file="([^"]+)"/>',
                             (folder / "frames.pvd").read_text())
        balls = [(float(t), file) for t, _, name, file in entries if name == "particles"]
        self.assertEqual(len(balls), 26)  # 0 to 0.25 s in steps of 0.0103 s, and the end
        for k, (t, _) in enumerate(balls[:-1]):
            self.assertAlmostEqual(t, 0.0103 * k, delta=2e-5)
        with h5py.File(folder / "particles.h5", "r") as file:
            group = file["particles/spheres"]
            self.assertEqual(group["position/value"].attrs["unit"].decode() if isinstance(group["position/value"].attrs["unit"], bytes)
                             else group["position/value"].attrs["unit"], "m")
            times = group["position/time"][:]
            self.assertTrue(numpy.array_equal(times, [t for t, _ in balls]))
            self.assertEqual(len(set(group["position/step"][:])), len(balls))
            positions, counts = group["position/value"][:], group["count/value"][:]
        for k, (t, name) in enumerate(balls):
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(str(folder / name))
            reader.Update()
            data = reader.GetOutput()
            n = data.GetNumberOfPoints()
            self.assertEqual((n, data.GetNumberOfVerts()), (counts[k], counts[k]))
            columns = data.GetPointData()
            for column, width in (("radius", 1), ("diameter", 1), ("clump", 1), ("velocity", 3), ("material", 1), ("contacts", 1)):
                array = columns.GetArray(column)
                self.assertIsNotNone(array, column)
                self.assertEqual((array.GetNumberOfTuples(), array.GetNumberOfComponents()), (n, width), column)
            points = vtk_to_numpy(data.GetPoints().GetData())
            self.assertTrue(numpy.isfinite(points).all())
            if positions.ndim == 2:  # rows of all frames one after another
                start = int(counts[:k].sum())
                self.assertTrue(numpy.array_equal(points, positions[start:start + n].astype(numpy.float32)))
            else:
                self.assertTrue(numpy.array_equal(points, positions[k][:n].astype(numpy.float32)))
        # Walls: the paddle moves, the lid is gone from 0.06 s on.
        lids = [float(t) for t, _, name, _ in entries if name == "lid"]
        self.assertLess(max(lids), 0.0601)
        self.assertGreater(max(lids), 0.04)
        paddles = {file for _, _, name, file in entries if name == "paddle"}
        self.assertGreater(len(paddles), 5)
        for _, _, _, file in entries:
            self.assertTrue((folder / file).exists(), file)


if __name__ == "__main__":
    unittest.main(verbosity=2)
