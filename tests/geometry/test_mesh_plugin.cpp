// calx.mesh: STL files of both kinds, units, and every fault by name.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "geometry/shapes.hpp"

using namespace calx;
using doctest::Approx;

namespace {

struct Triangle {
  Vec3 a, b, c;
};

std::vector<Triangle> box_triangles(double s) {
  const Tessellation t = cube(s).tessellate(1);
  std::vector<Triangle> out;
  for (std::size_t k = 0; k < t.triangles.size(); k += 3)
    out.push_back({t.vertices[t.triangles[k]], t.vertices[t.triangles[k + 1]], t.vertices[t.triangles[k + 2]]});
  return out;
}

/// A file that is gone at the end of the test.
struct File {
  std::string path;
  explicit File(const std::string& bytes, const std::string& name = "mesh.stl")
      : path("/tmp/calx_test_" + std::to_string(getpid()) + "_" + name) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  ~File() { std::remove(path.c_str()); }
  std::string json() const { return "{\"file\": \"" + path + "\"}"; }
};

std::string ascii(const std::vector<Triangle>& triangles) {
  std::string text = "solid a box with spaces\n";
  char line[200];
  for (const Triangle& t : triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const Vec3* v : {&t.a, &t.b, &t.c}) {
      std::snprintf(line, sizeof line, "      vertex %.6e %.6e %.6e\n", v->x, v->y, v->z);
      text += line;
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid\n";
}

std::string binary(const std::vector<Triangle>& triangles) {
  // Some programs begin binary files with "solid" too.
  std::string bytes = "solid by a program";
  bytes.resize(80, ' ');
  const auto put = [&](const void* p, std::size_t n) { bytes.append(static_cast<const char*>(p), n); };
  const std::uint32_t count = static_cast<std::uint32_t>(triangles.size());
  put(&count, 4);
  for (const Triangle& t : triangles) {
    const float zero[3] = {0, 0, 0};
    put(zero, 12);
    for (const Vec3* v : {&t.a, &t.b, &t.c}) {
      const float f[3] = {static_cast<float>(v->x), static_cast<float>(v->y), static_cast<float>(v->z)};
      put(f, 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

PluginProbe& probe() {
  static PluginProbe p("calx_mesh");
  return p;
}

Surface read(const File& f, const char* unit = "mm", const char* allow = "no", double scale = 1) {
  ProbeValues v = probe().presets("calx.mesh");
  return build(probe(), "calx.mesh", v.set("unit", unit).set("allow_open", allow).set("scale", scale), f.json());
}

std::string refusal(const std::vector<Triangle>& triangles) {
  const File f(ascii(triangles));
  try {
    read(f);
  } catch (const std::runtime_error& e) {
    CHECK(probe().status() == CALX_E_CONFIG);
    const std::string text = e.what(), begin = "file: " + f.path + ": ";
    CHECK(text.compare(0, begin.size(), begin) == 0);
    return text.substr(begin.size());
  }
  return "accepted";
}

const std::string advice = "; repair the mesh, or set \"allow_open\": \"yes\" if these do not matter";

}  // namespace

TEST_CASE("ASCII and binary files of a box give the same sound surface") {
  const auto box = box_triangles(100.1);
  const File text(ascii(box)), bytes(binary(box));
  for (const File* f : {&text, &bytes}) {
    const Surface s = read(*f);
    CHECK(s.element_count() == 12);
    CHECK(s.faults().describe() == "");
    CHECK(s.bounds().hi.x == Approx(0.1001).epsilon(1e-6));
    const auto c = contacts(s, {0.03, 0.02, 0.001}, 0.0015);
    REQUIRE(c.size() == 1);
    CHECK(c[0].distance == Approx(0.001).epsilon(1e-6));
  }
}

TEST_CASE("units, scale and position are applied") {
  const File f(ascii(box_triangles(2)));
  CHECK(read(f, "m").bounds().hi.z == Approx(2));
  CHECK(read(f, "mm").bounds().hi.z == Approx(0.002));
  CHECK(read(f, "cm").bounds().hi.z == Approx(0.02));
  CHECK(read(f, "inch").bounds().hi.z == Approx(0.0508));
  CHECK(read(f, "cm", "no", 2.5).bounds().hi.z == Approx(0.05));
  ProbeValues v = probe().presets("calx.mesh");
  v.set("unit", "m").set("position", Vec3{1, 2, 3});
  CHECK(build(probe(), "calx.mesh", v, f.json()).bounds().lo.y == Approx(2));
  const calx_descriptor& d = probe().descriptor("calx.mesh");
  CHECK((d.parameter[0].flags & CALX_FIELD_REQUIRED) != 0);
  CHECK(std::string(d.extra_schema).find("\"required\": [\"file\"]") != std::string::npos);
}

TEST_CASE("each fault is refused by name, number and first place in metres") {
  auto box = box_triangles(100);
  auto open = box;
  open.resize(10);
  CHECK(refusal(open) == "4 open edges (first at (0, 0.05, 0.1) m)" + advice);
  auto degenerate = box;
  degenerate.push_back({{0, 0, 0}, {30, 0, 0}, {60, 0, 0}});
  CHECK(refusal(degenerate) == "1 degenerate triangle (first at (0.03, 0, 0) m)" + advice);
  auto duplicate = box;
  duplicate.push_back({box[3].b, box[3].c, box[3].a});
  CHECK(refusal(duplicate).find("1 duplicate triangle (first at (0.1, ") == 0);
  auto inverted = box;
  std::swap(inverted[0].a, inverted[0].b);
  CHECK(refusal(inverted).find("3 inverted edges (first at (0, ") == 0);
  auto inside_out = box;
  for (Triangle& t : inside_out) std::swap(t.a, t.b);
  CHECK(refusal(inside_out).find("12 inverted triangles (first at ") == 0);
  auto fin = box;
  fin.push_back({box[0].a, box[0].b, {-50, 0, 50}});
  CHECK(refusal(fin).find("2 open edges") == 0);
  CHECK(refusal(fin).find("1 non-manifold edge") != std::string::npos);
  CHECK(refusal(box) == "accepted");
}

TEST_CASE("allow_open takes a faulty mesh and leaves out what cannot be a wall") {
  auto box = box_triangles(100);
  box.resize(10);
  box.push_back({{0, 0, 0}, {30, 0, 0}, {60, 0, 0}});
  box.push_back(box[3]);
  const Surface s = read(File(binary(box)), "mm", "yes");
  CHECK(s.element_count() == 10);
  CHECK(s.faults().open_edges == 4);
  CHECK(s.faults().degenerate == 0);
}

TEST_CASE("files that cannot be read are refused with the reason") {
  const auto message = [](const File& f) -> std::string {
    try {
      read(f);
    } catch (const std::runtime_error& e) {
      return std::string(e.what()).substr(f.path.size() + 8);
    }
    return "accepted";
  };
  const auto box = box_triangles(100);
  CHECK(message(File(binary(box).substr(0, 500))) ==
        "is no STL file, or a binary one cut short: it announces 12 triangles, which needs 684 bytes; it has 500");
  CHECK(message(File("ply\n")) ==
        "is no STL file: it begins neither with \"solid\" nor with the 84 bytes of a binary header");
  CHECK(message(File("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n")) ==
        "triangle 1: \"vertex\" is not followed by three numbers");
  CHECK(message(File("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n")) ==
        "a facet has 2 vertices; STL facets have 3");
  CHECK(message(File("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n")) ==
        "the text ends within a facet; the file is cut short");
  CHECK(message(File("solid x\nendsolid x\n")) == "holds no triangle");
  auto wild = box;
  wild[5].b.y = 1e60;  // beyond single precision
  CHECK(message(File(binary(wild))) == "triangle 6 has a coordinate that is not finite");
  ProbeValues v = probe().presets("calx.mesh");
  CHECK_THROWS_WITH(
      build(probe(), "calx.mesh", v, "{\"file\": \"/nowhere/a.stl\"}"),
      "file: /nowhere/a.stl: cannot be opened; give the path of an STL file, relative to the case file or absolute");
  CHECK_THROWS_WITH(build(probe(), "calx.mesh", v), "file: missing; give the path of an STL file");
}

TEST_CASE("paths may hold escaped and non-ASCII characters") {
  const File f(ascii(box_triangles(100)),
               "gr\xC3\xB6\xC3\x9F"
               "e \"1\".stl");
  std::string json = "{\"file\": \"" + f.path + "\"}";
  const auto replace = [&](const std::string& what, const std::string& with) {
    json.replace(json.find(what), what.size(), with);
  };
  replace("\xC3\xB6", "\\u00f6");
  replace("\"1\"", "\\\"1\\\"");
  ProbeValues v = probe().presets("calx.mesh");
  CHECK(build(probe(), "calx.mesh", v.set("unit", "mm"), json).element_count() == 12);
}
