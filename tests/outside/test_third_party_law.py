"""A law from the template, built out of the tree, on every device: one text, and the bits of its native code."""
import os
import subprocess
import unittest

from calx import PLUGIN, SOURCE, cup
from devices import KINDS, DeviceTest

LAW = {"kn": 2e3, "gn": 0.005, "kt": 1.6e3, "mu": 0.4}


def spring_cup():
    pairs = [{"between": ["glass", other], "law": "org.example.spring", "parameters": LAW} for other in ("glass", "steel")]
    case = cup({"/contacts": pairs, "/time/end": 0.1})
    for material in case["materials"].values():
        material.update(moisture=0.05)
    return case


class ThirdPartyLaw(DeviceTest):
    def setUp(self):
        super().setUp()
        self.plugins = os.environ.get("CALX_LAW")  # where it was built before
        if not self.plugins:
            build = self.dir / "law"
            for words in (["-S", f"{SOURCE}/examples/third_party_law", "-B", build, f"-DCALX_ABI={SOURCE}/abi",
                           f"-DCMAKE_C_COMPILER={os.environ['CC']}"], ["--build", build]):
                done = subprocess.run(["cmake", *words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                self.assertEqual(done.returncode, 0, done.stdout)
            self.plugins = build / "plugins"
        self.case = self.write(spring_cup()).name
        self.words = ("--plugin-path", self.plugins)

    def test_same_bits(self):
        self.runs_on("cpu", self.case, "cpu", *self.words)
        summary = self.summary("cpu")
        self.assertEqual((summary["status"], summary["particles"]), ("done", 60))
        # There was something to compute: contacts, and friction in them.
        self.assertGreater(summary["energy"]["friction"], 0)
        self.assertGreater(summary["energy"]["damping"], 0)
        for kind in KINDS:
            with self.subTest(kind):
                self.needs_device(kind, self.case, *self.words)
                self.runs_on(kind, self.case, kind, *self.words)
                self.assertRegex(self.summary(kind)["provenance"]["device"], f"^{kind}: ")
                self.assert_same_run("cpu", kind)

    def test_reserved_name(self):
        """What abi/README.md warns of: a name that is fine in C and reserved in OpenCL C."""
        if os.environ.get("CALX_LAW"):
            self.skipTest("the law is not built here")
        self.needs_device("opencl", self.case, *self.words)
        law = self.dir / "other"
        subprocess.run(["cp", "-r", f"{SOURCE}/examples/third_party_law", law], check=True)
        text = (law / "spring.law.h").read_text()
        self.assertEqual(text.count("limit"), 3)
        line = 1 + text[:text.index("limit")].count("\n")
        (law / "spring.law.h").write_text(text.replace("limit", "global"))
        for words in (["-S", law, "-B", law / "build", f"-DCALX_ABI={SOURCE}/abi"], ["--build", law / "build"]):
            subprocess.run(["cmake", *words], stdout=subprocess.DEVNULL, check=True)
        words = (self.case, "--plugin-path", law / "build" / "plugins")
        self.assertEqual(self.on("cpu", "check", *words).code, 0)
        refused = self.on("opencl", "check", *words)
        self.assertEqual(refused.code, PLUGIN, refused.err)
        self.assertRegex(refused.err, r"the error is in org\.example\.spring:")
        self.assertRegex(refused.err, rf"org\.example\.spring:{line}:")


if __name__ == "__main__":
    unittest.main(verbosity=2)
