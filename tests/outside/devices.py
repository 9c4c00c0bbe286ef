"""What the tests of devices share: opening each kind, and skipping where the machine has none."""
import os
import pathlib

from calx import CalxTest, differences

CACHE = pathlib.Path(os.environ["CALX_DEVICE_CACHE"])
KINDS = ("host", "opencl", "cuda")


def pocl():
    """A folder that PoCL can write."""
    folder = CACHE / "pocl"
    folder.mkdir(parents=True, exist_ok=True)
    return {"POCL_CACHE_DIR": str(folder)}


def stand_in(**more):
    """The stand-ins for the CUDA driver and its compiler; more: what they should do, CALX_STAND_IN_*."""
    return {"CALX_LIBCUDA": os.environ["CALX_STAND_IN_CUDA"], "CALX_LIBNVRTC": os.environ["CALX_STAND_IN_NVRTC"], **more}


class DeviceTest(CalxTest):
    def on(self, kind, *words, env=None, **options):
        """calx with --device kind; compiled kernels are kept for the next run of the tests."""
        env = {"CALX_CACHE": str(CACHE), **pocl(), **(stand_in() if kind.startswith("cuda") else {}), **(env or {})}
        return self.calx(*words, "--device", kind, env=env, **options)

    def needs_device(self, kind, path, *words):
        """Leaves the test out where the machine has no such device, and says why."""
        if kind == "cuda" and not os.path.exists(os.environ["CALX_STAND_IN_CUDA"]):
            self.skipTest("no stand-in for CUDA is built")
        checked = self.on(kind, "check", path, *words)
        if kind == "opencl" and "device kind opencl" in checked.err:
            self.skipTest(checked.err.strip())
        self.assertEqual(checked.code, 0, checked.err)
        return checked

    def runs_on(self, kind, path, folder, *words, **options):
        result = self.on(kind, "run", path, "-o", folder, "--threads", 2, "--no-report", *words, **options)
        self.assertEqual(result.code, 0, result.err)
        return result

    def assert_same_run(self, a, b):
        """Particles, contacts and history of the last checkpoint, particles of every frame, and every series, bit for bit."""
        one, two = self.dir / a, self.dir / b
        for name in ("checkpoint.h5", "particles.h5"):
            self.assertEqual(differences(one / name, two / name), [], name)
        names = sorted(p.name for p in (one / "series").iterdir())
        self.assertEqual(names, sorted(p.name for p in (two / "series").iterdir()))
        for name in names:
            self.assertEqual((one / "series" / name).read_bytes(), (two / "series" / name).read_bytes(), name)
