"""gpu_all.sh from end to end with tiny sizes on an OpenCL device, its packs, and what it says when something fails. Nothing
is timed."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

CALX = pathlib.Path(os.environ["CALX"])
SCRIPT = pathlib.Path(__file__).resolve().parent / "gpu_all.sh"
ROWS = SCRIPT.with_name("gpu_rows.py")
CASE = pathlib.Path(os.environ["CALX_SOURCE"]) / "examples/canister_fill/first_fill.json"


def call(*words):
    return subprocess.run([str(word) for word in words], text=True, timeout=250, stdin=subprocess.DEVNULL, capture_output=True,
                          check=False)


class GpuAllTest(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="calx_gpu_test_"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def test_dry(self):
        done = call(SCRIPT, "--build", CALX.parent.parent, "--device", "opencl", "--dry", "--out", self.dir)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for part in ("device", "same", "bench-settled-300-opencl", "bench-drum-300-opencl", "report"):
            self.assertRegex(done.stdout, rf"(?m)^{part} +passed")
        self.assertIn("same bits: 9 series, checkpoint.h5, particles.h5;", done.stdout)
        rows = [json.loads(line) for line in (self.dir / "rows.jsonl").read_text().splitlines()]
        timed = [(row["case"], row["asked"]) for row in rows if "calx" in row]
        self.assertEqual(timed, [(case, where) for case in ("settled 300", "drum 300") for where in ("cpu", "opencl")])
        for row in rows:
            self.assertTrue(row["device"].startswith(row["asked"]), row["device"])
            self.assertGreater(row["rate"], 0)
        # The second chunk goes on where the first was interrupted.
        chunks = [row for row in rows if row["case"] == "paper"]
        self.assertEqual([row["status"] for row in chunks], ["interrupted"] * 2)
        self.assertGreater(chunks[1]["time_s"], chunks[0]["time_s"])

    def test_a_failure_is_told_and_the_rest_goes_on(self):
        done = call("env", "CALX_LIBOPENCL=/nowhere/libOpenCL.so", SCRIPT, "--build", CALX.parent.parent, "--device", "opencl",
                    "--dry", "--only", "same,bench", "--cases", "settled", "--out", self.dir)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r"(?m)^same-opencl +FAILED +exit code 2: calx: .*/nowhere/libOpenCL.so")
        self.assertRegex(done.stdout, r"(?m)^same +FAILED")
        self.assertRegex(done.stdout, r"(?m)^bench-settled-300-cpu +passed")
        self.assertRegex(done.stdout, r"(?m)^bench-settled-300-opencl +FAILED")

    def test_differences_are_found(self):
        for name, seed in (("a", 1), ("b", 1), ("c", 2)):
            done = call(CALX, "run", CASE, "--until", "0.0002", "--device", "cpu", "--seed", seed, "-o", self.dir / name,
                        "--no-report")
            self.assertEqual(done.returncode, 0, done.stderr)
        done = call(sys.executable, ROWS, "same", self.dir / "a", self.dir / "b", "--device", "cpu")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = call(sys.executable, ROWS, "same", self.dir / "a", self.dir / "c", "--device", "cpu")
        self.assertIn("not the same bits: ", done.stderr)
        # One bit of one file, in a place that is no time.
        path = self.dir / "b/checkpoint.h5"
        data = bytearray(path.read_bytes())
        data[-1000] ^= 1
        whole = path.read_bytes()
        path.write_bytes(data)
        done = call(sys.executable, ROWS, "same", self.dir / "a", self.dir / "b", "--device", "cpu")
        self.assertIn("not the same bits: checkpoint.h5", done.stderr)
        path.write_bytes(whole)
        done = call(sys.executable, ROWS, "same", self.dir / "a", self.dir / "b", "--device", "cuda")
        self.assertIn("asked for cuda, ran on cpu", done.stderr)

    def test_pack(self):
        pack = self.dir / "pack.tar.gz"
        done = call(SCRIPT, "--pack", pack, "--build", CALX.parent.parent)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("gpu_all.sh: line", done.stderr)
        shutil.unpack_archive(pack, self.dir)
        done = call(self.dir / "calx-gpu/tests/bench/gpu_all.sh", "--device", "host", "--dry", "--only", "same", "--out",
                    self.dir / "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("same bits: ", done.stdout)
        names = {path.name for path in (self.dir / "calx-gpu/lib").iterdir()}
        self.assertFalse([name for name in names if name.startswith(("libc.so", "libm.so", "libstdc++"))], names)

    def test_refusals(self):
        for words, text in ((["--sice", "1"], "--sice: not known"), (["--only", "all"], "--only all"),
                            (["--cases", "law"], "--cases law"), (["--out"], "--out: needs a value"),
                            (["--build", "/nowhere"], "/nowhere")):
            done = call(SCRIPT, *words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    probe = call(CALX, "check", CASE, "--device", "opencl")
    if probe.returncode != 0:
        print("skipped: no OpenCL device: " + probe.stderr.strip())
        sys.exit(77)
    unittest.main()
