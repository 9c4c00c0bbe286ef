"""VTK 9 reads every .vtp of a run; frames.pvd lists them with their times."""
import os
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkThreshold
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import sample

CUBE = np.array([[x, y, z] for z in (-0.1, 0.1) for y in (-0.1, 0.1) for x in (-0.1, 0.1)])


def read(path):
    errors = []
    reader = vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    assert reader.CanReadFile(path), path
    reader.SetFileName(path)
    reader.Update()
    assert not errors and reader.GetErrorCode() == 0, path
    out = vtkPolyData()
    out.DeepCopy(reader.GetOutput())
    return out


def columns(data):
    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def time_of(mesh):
    return mesh.GetFieldData().GetArray("TimeValue").GetValue(0)


def check_spheres(mesh, frame):
    want = sample.expected(frame)
    count = sample.COUNTS[frame]
    assert mesh.GetNumberOfPoints() == mesh.GetNumberOfVerts() == mesh.GetNumberOfCells() == count
    assert time_of(mesh) == sample.TIMES[frame]
    got = columns(mesh.GetPointData())
    assert set(got) == {"radius", "diameter", "clump", "velocity", "speed", "material", "contacts"}, set(got)
    if count == 0:
        return
    assert np.allclose(vtk_to_numpy(mesh.GetPoints().GetData()), want["position"], rtol=1e-6, atol=0)
    for name, values in [("radius", want["radius"]), ("diameter", 2 * want["radius"]), ("velocity", want["velocity"]),
                         ("speed", 3 * np.arange(count))]:
        assert got[name].dtype == np.float32 and np.allclose(got[name], values, rtol=1e-6, atol=0), name
    for name, values in [("clump", want["particle"]), ("material", want["material"]), ("contacts", want["contacts"])]:
        assert got[name].dtype == np.uint32 and np.array_equal(got[name], values), name
    # Each vertex cell holds its own point.
    assert [mesh.GetCell(k).GetPointId(0) for k in range(count)] == list(range(count))


def check_filters(mesh):
    """Glyphs of the spheres' size, and a filter by cell, as a user of ParaView applies them."""
    count = mesh.GetNumberOfPoints()
    mesh.GetPointData().SetActiveScalars("diameter")
    ball = vtkSphereSource()  # diameter 1
    glyph = vtkGlyph3D()
    glyph.SetInputData(mesh)
    glyph.SetSourceConnection(ball.GetOutputPort())
    glyph.SetScaleModeToScaleByScalar()
    glyph.Update()
    balls = glyph.GetOutput().GetNumberOfPoints()
    ball.Update()
    assert balls == count * ball.GetOutput().GetNumberOfPoints()
    last = sample.expected(2)
    lowest = -last["radius"][0]
    assert abs(glyph.GetOutput().GetBounds()[4] - lowest) < 1e-6
    some = vtkThreshold()
    some.SetInputData(mesh)
    some.SetInputArrayToProcess(0, 0, 0, 0, "material")
    some.SetLowerThreshold(1)
    some.SetUpperThreshold(1)
    some.Update()
    assert some.GetOutput().GetNumberOfCells() == count // 2


def check_part(mesh, part, frame):
    assert mesh.GetNumberOfPoints() == 8 and mesh.GetNumberOfPolys() == mesh.GetNumberOfCells() == 12
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    want = sample.turned(CUBE, frame) if part == 1 else CUBE
    assert np.allclose(points, want, rtol=0, atol=1e-6), (part, frame)
    got = columns(mesh.GetCellData())
    assert np.array_equal(got["part"], [part] * 12) and np.array_equal(got["material"], [1] * 12)


with sample.run() as folder:
    collection = ElementTree.parse(os.path.join(folder, "frames.pvd")).getroot()
    assert collection.get("type") == "Collection"
    seen = {}
    files = set()
    for entry in collection.iter("DataSet"):
        frame = sample.TIMES.index(float(entry.get("timestep")))
        part = int(entry.get("part"))
        seen.setdefault(frame, []).append(part)
        files.add(entry.get("file"))
        mesh = read(os.path.join(folder, entry.get("file")))
        if part == 0:
            assert entry.get("name") == "particles"
            check_spheres(mesh, frame)
            if frame == 2:
                check_filters(mesh)
        else:
            assert entry.get("name") == ["hopper <1>", "rotor/left"][part - 1]
            check_part(mesh, part - 1, frame)
    assert seen == {0: [0, 1, 2], 1: [0, 1, 2], 2: [0, 1, 2], 3: [0, 2], 4: [0, 1, 2]}, seen
    on_disk = {"frames/" + name for name in os.listdir(os.path.join(folder, "frames"))}
    assert files == on_disk, files ^ on_disk
    # The hopper stands still: one file for all its frames.
    assert sorted(f for f in files if "hopper" in f) == ["frames/hopper__1__000000.vtp"], files
    assert len([f for f in files if "rotor" in f]) == 5
print("all .vtp read")
