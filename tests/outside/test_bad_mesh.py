"""Faults of STL files, as calx.mesh and the command line report them."""
import struct
import unittest

from calx import CASE, CalxTest, cup

S = 20.0  # mm, side of the box
CORNERS = [(x, y, z) for x in (0, S) for y in (0, S) for z in (0, S)]
# Two triangles a face, outward normals.
BOX = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def ascii_stl(triangles):
    rows = ["solid box"]
    for triangle in triangles:
        rows += ["facet normal 0 0 0", "outer loop"]
        rows += ["vertex {:g} {:g} {:g}".format(*(c if isinstance(c, tuple) else CORNERS[c])) for c in triangle]
        rows += ["endloop", "endfacet"]
    return "\n".join(rows + ["endsolid box", ""])


def binary_stl(triangles):
    data = b" " * 80 + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(v for c in triangle for v in CORNERS[c]), 0)
    return data


class BadMesh(CalxTest):
    def case(self, **parameters):
        return cup({"/parts/0/geometry": "calx.mesh",
                    "/parts/0/parameters": dict({"file": "box.stl", "unit": "mm", "position": [-0.01, -0.01, 0]}, **parameters),
                    "/sources/0/count": 4, "/sources/0/region": {"box": {"min": [-0.008, -0.008, 0.002], "max": [0.008, 0.008, 0.018]}}})

    def refuses_mesh(self, triangles, *texts):
        (self.dir / "box.stl").write_text(ascii_stl(triangles))
        return self.refuses(CASE, self.case(), "/parts/0/parameters", r"box\.stl", *texts)

    def test_sound_mesh(self):
        path = self.write(self.case())
        (self.dir / "box.stl").write_text(ascii_stl(BOX))
        self.runs(path, "-o", "ascii")
        (self.dir / "box.stl").write_bytes(binary_stl(BOX))
        self.runs(path, "-o", "binary")
        self.assertEqual(self.summary("ascii")["mass"], self.summary("binary")["mass"])
        self.assertEqual(self.summary("ascii")["particles"], 4)

    def test_open(self):
        self.refuses_mesh(BOX[:-1], "3 open edges", r"first at \(", "allow_open")

    def test_degenerate(self):
        self.refuses_mesh(BOX + [(0, 1, (0.0, 0.0, S / 2))], "1 degenerate triangle")

    def test_duplicate(self):
        self.refuses_mesh(BOX + [BOX[3]], "1 duplicate triangle")

    def test_inverted(self):
        self.refuses_mesh(BOX[:5] + [BOX[5][::-1]] + BOX[6:], "inverted")
        self.refuses_mesh([t[::-1] for t in BOX], "12 inverted triangles")

    def test_units_and_files(self):
        self.refuses(CASE, {**self.case(), "parts": [dict(self.case()["parts"][0], parameters={"file": "box.stl"})]},
                     "/parts/0/parameters/unit: is missing", "STL files do not say it")
        self.refuses(CASE, self.case(file="bix.stl"), "bix\\.stl: cannot be opened; give the path of an STL file")
        (self.dir / "box.stl").write_bytes(binary_stl(BOX)[:-20])
        self.refuses(CASE, self.case(), r"box\.stl", "bytes|ends|short|truncated")
        (self.dir / "box.stl").write_text("these are notes\n")
        self.refuses(CASE, self.case(), r"box\.stl", "STL")

    def test_open_on_purpose(self):
        (self.dir / "box.stl").write_text(ascii_stl(BOX[:-1]))
        self.runs(self.write(self.case(allow_open="yes")))


if __name__ == "__main__":
    unittest.main(verbosity=2)
