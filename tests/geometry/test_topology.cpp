// Mesh faults and refused shapes.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "geometry/shapes.hpp"

using namespace calx;

namespace {

const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
const std::vector<std::uint32_t> sides = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};

MeshFaults faults_of(std::vector<std::uint32_t> index, std::vector<Vec3> v = corners) {
  return mesh(v, index).faults();
}

}  // namespace

TEST_CASE("a closed outward box has no fault, also when every triangle brings its own vertices") {
  CHECK(faults_of(sides).describe() == "");
  std::vector<Vec3> loose;
  std::vector<std::uint32_t> index;
  for (const std::uint32_t k : sides) {
    // Single-precision noise, as files have it.
    loose.push_back(corners[k] + 3e-8 * Vec3{loose.size() % 3 - 1.0, loose.size() % 2 - 0.5, loose.size() % 5 - 2.0});
    index.push_back(static_cast<std::uint32_t>(index.size()));
  }
  CHECK(faults_of(index, loose).describe() == "");
}

TEST_CASE("each fault is counted and its first place named") {
  auto open = sides;
  open.resize(30);  // without the top
  CHECK(faults_of(open).open_edges == 4);
  CHECK(faults_of(open).describe() == "4 open edges (first at (0.5, 0, 1) m)");

  auto degenerate = sides;
  degenerate.insert(degenerate.end(), {0, 1, 1});
  CHECK(faults_of(degenerate).describe() == "1 degenerate triangle (first at (0.666667, 0, 0) m)");

  auto duplicate = sides;
  duplicate.insert(duplicate.end(), {6, 0, 4});
  CHECK(faults_of(duplicate).describe() == "1 duplicate triangle (first at (0, 0.333333, 0.666667) m)");
  CHECK(mesh(corners, duplicate).element_count() == 12);

  auto inverted = sides;
  std::swap(inverted[6], inverted[7]);
  CHECK(faults_of(inverted).describe() == "1 inverted triangle (first at (1, 0.666667, 0.333333) m)");

  auto inside_out = sides;
  for (std::size_t k = 0; k < inside_out.size(); k += 3) std::swap(inside_out[k], inside_out[k + 1]);
  CHECK(faults_of(inside_out).inverted == 12);

  auto fin = sides;
  auto fin_corners = corners;
  fin_corners.push_back({-1, 0, 0.5});
  fin.insert(fin.end(), {0, 4, 8});
  const MeshFaults f = faults_of(fin, fin_corners);
  CHECK(f.non_manifold == 1);
  CHECK(f.open_edges == 2);
  CHECK(f.describe().find("1 non-manifold edge (first at (0, 0, 0.5) m)") != std::string::npos);
}

TEST_CASE("a cavity within a closed shell is not inside out") {
  auto v = corners;
  auto t = sides;
  for (const Vec3& p : corners) v.push_back(Vec3{0.25, 0.25, 0.25} + 0.5 * p);
  for (std::size_t k = 0; k < sides.size(); k += 3)
    t.insert(t.end(), {sides[k] + 8, sides[k + 2] + 8, sides[k + 1] + 8});
  CHECK(faults_of(t, v).describe() == "");
}

TEST_CASE("bad input is refused with the reason") {
  Surface s;
  CHECK_THROWS_WITH_AS(s.finish(), "the shape has no triangle and no surface of revolution", Error);
  CHECK_THROWS_WITH_AS(s.add_triangles({{0, 0, 0}, {1, 0, 0}}, {0, 1, 2}), "a triangle names vertex 2 of 2", Error);
  CHECK_THROWS_WITH_AS(s.add_triangles({{0, 0, std::nan("")}}, {}),
                       "vertex 0 is not finite; coordinates are numbers in m", Error);
  CHECK_THROWS_WITH_AS(mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2}),
                       "all triangles of the shape are degenerate: 1 degenerate triangle (first at (1, 0, 0) m)",
                       Error);
}

namespace {

calx_status CALX_CALL refuse(const calx_instance*, const calx_host* host, const calx_shape_sink*) {
  return host->fail(host, CALX_E_CONFIG, "radius: too small");
}
calx_status CALX_CALL send_nothing(const calx_instance*, const calx_host*, const calx_shape_sink*) { return CALX_OK; }
calx_status CALX_CALL send_sliver(const calx_instance*, const calx_host*, const calx_shape_sink* sink) {
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0};
  const uint32_t index[] = {0, 1, 2, 0, 1, 3};
  return sink->triangles(sink, 4, xyz, 2, index);
}
calx_status CALX_CALL send_nan(const calx_instance*, const calx_host*, const calx_shape_sink* sink) {
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, std::nan(""), 0};
  const uint32_t index[] = {0, 1, 2};
  return sink->triangles(sink, 3, xyz, 1, index);
}
Surface run(calx_status(CALX_CALL* build)(const calx_instance*, const calx_host*, const calx_shape_sink*)) {
  const calx_geometry table = {sizeof(calx_geometry), CALX_ABI_DRAFT, build};
  return Surface::build(table, nullptr, nullptr, "wall");
}

}  // namespace

TEST_CASE("build names the part and quotes the plugin") {
  CHECK_THROWS_WITH_AS(run(&refuse), "part 'wall': its geometry plugin could not build the shape: radius: too small",
                       Error);
  CHECK_THROWS_WITH_AS(run(&send_nothing), "part 'wall': the shape has no triangle and no surface of revolution",
                       Error);
  CHECK_THROWS_WITH_AS(run(&send_sliver),
                       "part 'wall': 1 degenerate triangle (first at (1, 0, 0) m); a wall needs triangles with an area",
                       Error);
  CHECK_THROWS_WITH_AS(
      run(&send_nan),
      "part 'wall': its geometry plugin sent a bad shape: vertex 2 is not finite; coordinates are numbers in m", Error);
  try {
    run(&refuse);
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::plugin);
  }
  try {
    run(&send_nan);
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
  }
}

TEST_CASE(
    "an edge that meets two others halfway counts as a rim, lets nothing through and is felt by deep overlaps only") {
  // A plate of one square beside two half as wide: the corner (0, 0.5) lies on the square's edge.
  const Surface s = mesh({{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {1, 0, 0}, {1, 0.5, 0}, {0, 0.5, 0}, {1, 1, 0}},
                         {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 6, 6, 5, 7, 6, 7, 2});
  CHECK(s.faults().open_edges == 10);  // seven of the outline, and three of the seam
  const double r = 0.1;
  const auto most = [&](double overlap) {
    std::size_t out = 0;
    for (int k = -100; k <= 100; ++k)
      for (const double y : {0.3, 0.5, 0.507}) {
        const auto c = contacts(s, {0.002 * k, y, r - overlap}, r);
        REQUIRE(c.size() > 0);
        CHECK(c[0].normal.z == doctest::Approx(1).epsilon(1e-9));
        CHECK(c[0].distance == doctest::Approx(r - overlap).epsilon(1e-9));
        out = std::max(out, c.size());
      }
    return out;
  };
  // A rim within the radius is seen under acos(1 - overlap / r) at most; below the 15 degrees of a crease, that is
  // below 3.4 % of the radius, it is one contact with the face.
  CHECK(most(0.01 * r) == 1);
  CHECK(most(0.033 * r) == 1);
  CHECK(most(0.1 * r) == 2);
}
