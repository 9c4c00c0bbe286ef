"""Every effect that is a contact law or a particle force, on devices: its text gives the bits of its native code."""
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["CALX_SOURCE"], "tests", "outside")))
from calx import cup, needs  # noqa: E402
from devices import DeviceTest  # noqa: E402

EFFECTS = {"calx.moisture-cohesion": {"tension": 0.03, "time": 0.02}, "calx.wall-friction-stress": {"rise": 0.3},
           "calx.wall-charge": {"start": 0, "end": 50, "time": 0.02}, "calx.rolling-resistance": {"friction": 0.2},
           "calx.load-cohesion": {"ratio": 0.1}, "calx.contact-plasticity": {"plasticity": 0.5},
           "calx.vent-pressure": {"gradient": 5000, "period": 0.01, "vent": 0.006}, "calx.counterflow": {"speed": 0.2},
           "calx.powder-drag": {"viscosity": 1.8e-5}}


class EffectsOnDevices(DeviceTest):
    def test_same_bits(self):
        for effect in EFFECTS:
            needs(effect)
        case = self.write(cup({"/time/end": 0.04, "/effects": [{"effect": e, "parameters": p} for e, p in EFFECTS.items()]})).name
        plain = self.write(cup({"/time/end": 0.04}), "plain.json").name
        self.runs_on("cpu", case, "cpu")
        self.runs_on("cpu", plain, "without")
        self.assertNotEqual((self.dir / "cpu/series/energy.csv").read_text(), (self.dir / "without/series/energy.csv").read_text())
        for kind in ("host", "opencl"):
            with self.subTest(kind):
                self.needs_device(kind, case)
                self.runs_on(kind, case, kind)
                self.assertRegex(self.summary(kind)["provenance"]["device"], f"^{kind}: ")
                self.assert_same_run("cpu", kind)


if __name__ == "__main__":
    unittest.main(verbosity=2)
