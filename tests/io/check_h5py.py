"""h5py reads particles.h5 and checkpoint.h5 as the documentation of particles_h5.hpp says."""
import os

import h5py
import numpy as np

import sample

UNITS = {"position": "m", "velocity": "m s-1", "radius": "m"}


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def check_particles(f):
    assert list(f["h5md"].attrs["version"]) == [1, 1]
    assert text(f["h5md/creator"].attrs["name"]) == "calx"
    assert text(f["h5md/author"].attrs["name"]) == "two materials"
    spheres = f["particles/spheres"]
    assert list(spheres["box"].attrs["boundary"].astype(str)) == ["periodic", "none", "none"]
    assert spheres["box"].attrs["dimension"] == 3
    assert list(spheres["box/edges"]) == [2, 2, 3] and list(spheres["box/origin"]) == [-1, -1, -1]
    assert list(spheres["material"].attrs["names"].astype(str)) == ["calcine", "steel"]
    assert list(spheres["count/value"]) == sample.COUNTS
    most = max(sample.COUNTS)
    for name in sample.expected(0):
        group = spheres[name]
        assert list(group["time"]) == sample.TIMES and list(group["step"]) == [0, 1000, 2000, 3000, 4000]
        assert text(group["time"].attrs["unit"]) == "s"
        value = group["value"]
        assert value.shape == (5, most, 3)[: value.ndim] and value.ndim == (3 if name in ("position", "velocity") else 2)
        if name in UNITS:
            assert text(value.attrs["unit"]) == UNITS[name]
        for frame, count in enumerate(sample.COUNTS):
            want = sample.expected(frame)[name]
            got = value[frame, :count]
            if name == "position":
                assert value.dtype == np.float64 and np.array_equal(got, want), frame
            elif value.dtype == np.float32:
                assert np.allclose(got, want, rtol=1e-6, atol=0), (name, frame)
            else:
                assert value.dtype == np.uint32 and np.array_equal(got, want), (name, frame)
            rest = value[frame, count:]
            assert np.all(np.isnan(rest)) if value.dtype.kind == "f" else np.all(rest == sample.NONE)


def check_parts(f):
    assert sorted(f["parts"]) == ["hopper__1_", "rotor_left"]
    for index, group in enumerate([f["parts/hopper__1_"], f["parts/rotor_left"]]):
        assert group.attrs["index"] == index
        assert text(group.attrs["name"]) == ["hopper <1>", "rotor/left"][index]
        assert text(group.attrs["geometry"]) == "calx.box" and text(group.attrs["material"]) == "steel"
        assert group["vertices"].shape == (8, 3) and group["triangles"].shape == (12, 3)
        assert text(group["vertices"].attrs["unit"]) == "m" == text(group["pose/shift"].attrs["unit"])
        assert list(group["pose/time"]) == sample.TIMES
    assert list(f["parts/hopper__1_/pose/present"]) == [1, 1, 1, 0, 1]
    rotor = f["parts/rotor_left"]
    points = rotor["vertices"][:].astype(float)
    for frame in range(5):
        w, *axis = rotor["pose/quaternion"][frame]
        t = 2 * np.cross(axis, points)
        moved = points + w * t + np.cross(axis, t) + rotor["pose/shift"][frame]
        assert np.allclose(moved, sample.turned(points, frame), rtol=0, atol=1e-12), frame


def check_checkpoint(f):
    assert f.attrs["schema"] == 1 and f.attrs["complete"] == 1 and f.attrs["dataset_count"] == 5
    assert text(f.attrs["calx_version"]).count(".") == 2
    position = f["particles/position"]
    assert position.dtype == np.float64 and list(position) == [0.25, -1.5, 1e-300]
    assert text(position.attrs["unit"]) == "m"
    assert f["particles/id"].dtype == np.uint32 and list(f["particles/id"]) == [7, sample.NONE]
    assert f["particles/flags"].dtype == np.uint8 and list(f["particles/flags"]) == [0, 255]
    assert f["step"].dtype == np.uint64 and f["step"][0] == 2**64 - 1
    assert text(f["plugin/state"][()]) == "phase=3"


with sample.run() as folder:
    with h5py.File(os.path.join(folder, "particles.h5"), "r") as file:
        check_particles(file)
        check_parts(file)
    with h5py.File(os.path.join(folder, "checkpoint.h5"), "r") as file:
        check_checkpoint(file)
print("particles.h5 and checkpoint.h5 read")
