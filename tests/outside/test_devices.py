"""--device as a user meets it: the same results, what ran where, and what is said when a device, its compiler, its memory or
its cache fails."""
import os
import pathlib
import re
import shutil
import unittest

from calx import CASE, PLUGIN, USAGE, cup
from devices import KINDS, DeviceTest, stand_in

NOT_THERE = {"OCL_ICD_VENDORS": "/nowhere"}


def with_law(law, parameters=None):
    pairs = [{"between": ["glass", other], "law": law, "parameters": parameters or {}} for other in ("glass", "steel")]
    return cup({"/contacts": pairs, "/time/end": 0.01, "/time/step": 1e-5})


class Devices(DeviceTest):
    def plugin(self, name):
        return ("--plugin-path", pathlib.Path(os.environ["CALX_BAD_PLUGINS"]) / name)

    def kept(self):
        """Every file below the test's folder but the caches of drivers, with its bytes."""
        return {p: p.read_bytes() for p in sorted(self.dir.rglob("*")) if p.is_file() and ".cache" not in p.parts}

    def changes_nothing(self, code, *texts, words, kind="opencl", env=None):
        """calx run fails before it touches a file, even with --overwrite, and calx check says the same."""
        before = self.kept()
        line = self.fails(code, *texts, result=self.on(kind, "run", *words, "--overwrite", env=env))
        self.assertEqual(self.kept(), before)
        self.assertEqual(line, self.fails(code, result=self.on(kind, "check", *words, env=env)))
        return line

    def test_same_results(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "cpu")
        self.assertEqual(self.summary("cpu")["provenance"]["device"], "cpu")
        for kind in KINDS:
            with self.subTest(kind):
                checked = self.needs_device(kind, path)
                named = re.search(rf"(?m)^Device: {kind}: ([^;]+)", checked.out)
                self.assertTrue(named, checked.out)
                result = self.runs_on(kind, path, kind)
                self.assertNotIn("runs on the cpu", result.err)
                device = self.summary(kind)["provenance"]["device"]
                self.assertEqual(device.split(";")[0], f"{kind}: {named[1]}")
                self.assertRegex(device, rf"^{kind}: .+, .+")
                self.assert_same_run("cpu", kind)

    def test_resume_elsewhere(self):
        """A run that starts on one device and goes on on another is the run on the processor."""
        path = self.write(cup()).name
        self.runs_on("cpu", path, "straight")
        self.needs_device("host", path)
        self.runs_on("host", path, "mixed", "--until", 0.023)
        self.runs_on("cpu", path, "mixed", "--until", 0.037, "--resume")
        self.runs_on("cuda", path, "mixed", "--resume")
        self.assertRegex(self.summary("mixed")["provenance"]["device"], r"^cuda: Stand-in GPU 0, CUDA driver 12\.4, NVRTC")
        self.assert_same_run("straight", "mixed")

    def test_no_such_device(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "case.out")
        self.changes_nothing(USAGE, r"there is no CUDA device 7; there are 0: Stand-in GPU 0 \(4 GB\), 1: Stand-in GPU 1",
                             words=[path], kind="cuda:7")
        self.changes_nothing(USAGE, "there is no host device 1; there is 0: ", words=[path], kind="host:1")
        self.runs_on("cuda:1", path, "second", "--until", 0.001)
        self.assertRegex(self.summary("second")["provenance"]["device"], "^cuda: Stand-in GPU 1, ")
        for wrong in ("gpu", "cuda:", "cuda:-1", "cuda:1x", "auto:1", "cpu:0", "", "OpenCL"):
            with self.subTest(wrong):
                self.changes_nothing(USAGE, rf"--device {wrong}: expected auto, cpu, opencl, cuda or host", words=[path], kind=wrong)

    def test_no_driver(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "case.out")
        self.changes_nothing(USAGE, "device kind opencl needs the OpenCL loader, which does not open", "pocl-opencl-icd",
                             words=[path], env={"CALX_LIBOPENCL": "/nowhere/libOpenCL.so"})
        self.changes_nothing(USAGE, "device kind cuda needs an NVIDIA driver, whose library does not open",
                             words=[path], kind="cuda", env={"CALX_LIBCUDA": "/nowhere/libcuda.so"})
        self.changes_nothing(USAGE, "which does not open", "NVRTC", words=[path], kind="cuda",
                             env={"CALX_LIBNVRTC": "/nowhere/libnvrtc.so"})
        self.changes_nothing(USAGE, '"no-such-compiler" does not start; install g\\+\\+ or clang', words=[path], kind="host",
                             env={"CALX_CXX": "no-such-compiler"})
        # Left to choose, calx takes the processor and says why.
        checked = self.on("auto", "check", path, env={"CALX_LIBCUDA": "/nowhere/libcuda.so"})
        self.assertRegex(checked.out, r"(?m)^Device: cpu; no CUDA device; double precision")

    def test_no_opencl_driver(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "case.out")
        self.needs_device("opencl", path)
        line = self.changes_nothing(USAGE, "finds no device; no driver is registered: /nowhere holds no usable .icd file",
                                    "pocl-opencl-icd", words=[path], env=NOT_THERE)
        self.assertTrue(line.startswith("calx: device kind opencl: "), line)
        self.fails(USAGE, r"there is no OpenCL device 99; there are 0: ", result=self.on("opencl:99", "check", path))

    def test_unwritable_driver_cache(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "case.out")
        checked = self.needs_device("opencl", path)
        if "Portable Computing Language" not in checked.out:
            self.skipTest("the OpenCL device is not of PoCL: " + checked.out)
        self.changes_nothing(USAGE, 'POCL_CACHE_DIR is "/dev/null/pocl", which cannot; name another folder or unset it',
                             words=[path], env={"POCL_CACHE_DIR": "/dev/null/pocl"})

    def test_unwritable_cache(self):
        """Kernels are compiled for this run alone, which is the same run."""
        path = self.write(cup({"/time/end": 0.005})).name
        self.runs_on("cpu", path, "cpu")
        self.needs_device("host", path)
        self.runs_on("host", path, "out", env={"CALX_CACHE": "/dev/null/calx"})
        self.assert_same_run("cpu", "out")

    def test_broken_text(self):
        """The law works natively; on a device its text does not compile: which law, and which line of its own text."""
        path = self.write(with_law("test.leaning-text")).name
        words = self.plugin("leaning_text")
        self.runs_on("cpu", path, "case.out", *words)
        text = pathlib.Path(os.environ["CALX_SOURCE"], "tests/bad_plugins/leaning_text.law.h").read_text()
        line = 1 + text[:text.index("LEANING_TEXT_STIFFER")].count("\n")
        for kind in KINDS:
            with self.subTest(kind):
                if kind == "opencl":
                    self.needs_device(kind, self.write(cup(), "cup.json").name)
                logs = self.dir / ("logs " + kind)
                before = self.kept()
                result = self.on(kind, "run", path, "--overwrite", *words, env={"CALX_CACHE": str(logs)})
                self.assertEqual(result.code, PLUGIN, result.err)
                self.assertRegex(result.err, r"(?m)^calx: .* does not compile for .*; the error is in test\.leaning-text:")
                self.assertRegex(result.err, rf"test\.leaning-text:{line}:")
                self.assertIn("LEANING_TEXT_STIFFER", result.err)
                kept = re.search(r"the whole log: (.+)", result.err)
                self.assertTrue(kept, result.err)
                self.assertEqual(pathlib.Path(kept[1]).parent, logs)
                self.assertIn("LEANING_TEXT_STIFFER", pathlib.Path(kept[1]).read_text())
                shutil.rmtree(logs)
                self.assertEqual(self.kept(), before)

    def test_law_without_text(self):
        path = self.write(with_law("test.no-text")).name
        words = self.plugin("no_text")
        why = r'cpu, because of 1 obstacle to devices: law "test\.no-text" has no law text, only native code'
        self.runs_on("cpu", path, "cpu", *words)
        for kind in ("opencl", "cuda:7"):
            with self.subTest(kind):
                # No device is looked for, so a missing one does not matter.
                result = self.runs_on(kind, path, kind, *words, env=NOT_THERE)
                self.assertRegex(result.err.split("\n")[0], rf"--device {kind}: runs on the {why}")
                self.assertRegex(self.summary(kind)["provenance"]["device"], why)
                self.assert_same_run("cpu", kind)
        checked = self.on("opencl", "check", path, *words)
        self.assertRegex(checked.out, rf"(?m)^Device: {why}")
        # Who asks for nothing is told nothing.
        self.assertNotIn("obstacle", self.runs_on("auto", path, "auto", *words).err)

    def test_out_of_memory(self):
        """The device is full when more particles come; what was written stays, and the processor goes on from there."""
        case = cup()
        case["sources"].append({"name": "more", "shape": "ball", "material": "glass", "count": 400, "when": "late",
                                "region": {"box": {"min": [-0.018, -0.018, 0.06], "max": [0.018, 0.018, 0.095]}}})
        case["events"] = {"late": {"when": {"time": 0.025}}}
        path = self.write(case).name
        self.runs_on("cpu", path, "straight")
        self.needs_device("cuda", path)
        limit = stand_in(CALX_STAND_IN_MEMORY="120000")
        result = self.on("cuda", "run", path, "-o", "out", "--threads", 2, env=limit)
        self.fails(CASE, r"Stand-in GPU 0 has no memory left: asked for [\d.]+ kB, free [\d.]+ kB, in all 120 kB",
                   "use fewer particles, a device with more memory, or --device cpu", "last checkpoint at t = (0.02|0.01999) s, go on with --resume",
                   result=result)
        summary = self.summary("out")
        self.assertEqual(summary["status"], "stopped")
        self.assertIn("has no memory left", summary["reason"])
        self.assertGreater(summary["time"], 0.024)
        self.runs_on("cpu", path, "out", "--resume")
        self.assert_same_run("straight", "out")

    def test_too_small_from_the_start(self):
        path = self.write(cup()).name
        self.runs_on("cpu", path, "case.out")
        self.needs_device("cuda", path)
        self.changes_nothing(CASE, "Stand-in GPU 0 has no memory left: asked for ", "in all 1 kB", words=[path], kind="cuda",
                             env=stand_in(CALX_STAND_IN_MEMORY="1000"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
