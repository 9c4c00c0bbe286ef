"""Runs sample_run (argument 1) into a temporary folder; the facts of its world, said a second time."""
import contextlib
import subprocess
import sys
import tempfile

COUNTS = [0, 3, 2500, 5, 4]
TIMES = [0.0, 0.1, 0.2, 0.3, 0.4]
NONE = 2**32 - 1


@contextlib.contextmanager
def run():
    with tempfile.TemporaryDirectory(prefix="calx_io_") as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        yield folder


def expected(frame):
    """Columns of a frame as numpy arrays, named as in particles.h5."""
    import numpy as np

    k = np.arange(COUNTS[frame])
    particle = 100 + (k // 2 * 2 if frame == 4 else k)
    return {
        "position": np.stack([0.1 * k + TIMES[frame], 0.2 * k, 0.3 * k], axis=1),
        "velocity": np.stack([k, 2 * k, -2 * k], axis=1),
        "radius": 0.01 * (k + 1),
        "id": 500 + k,
        "particle": particle,
        "material": (particle - 100) % 2,
        "contacts": k % 7,
    }


def turned(points, frame):
    """Points of the rotor in the world."""
    import numpy as np

    a = frame / 4
    r = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    return points @ r.T + [frame, 0, 0]
