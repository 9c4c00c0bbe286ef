// calx.plane, calx.box and calx.cylinder as a host sees them.
#include <doctest/doctest.h>

#include "geometry/shapes.hpp"

using namespace calx;
using doctest::Approx;

TEST_CASE("plane: its cuts do not change contacts, its sides lie where they should") {
  PluginProbe probe("calx_plane");
  ProbeValues v = probe.presets("calx.plane");
  v.set("point", Vec3{0.1, 0.2, 0.3}).set("normal", Vec3{0, 2, 2}).set("half_u", 0.05).set("half_v", 0.02);
  const Surface one = build(probe, "calx.plane", v), many = build(probe, "calx.plane", v.set("divisions", 10));
  CHECK(one.element_count() == 2);
  CHECK(many.element_count() == 200);
  const Vec3 n = normalized(Vec3{0, 1, 1}), w = normalized(Vec3{0, 1, -1});
  for (int i = -9; i <= 9; ++i)
    for (int j = -9; j <= 9; ++j)
      for (const Surface* s : {&one, &many}) {
        const auto c =
            contacts(*s, Vec3{0.1, 0.2, 0.3} + i * 0.005 * Vec3{1, 0, 0} + j * 0.002 * w + 0.001 * n, 0.00125);
        REQUIRE(c.size() == 1);
        CHECK(std::abs(c[0].distance - 0.001) < 1e-15);
        CHECK(norm(c[0].normal - n) < 1e-7);
      }
  CHECK(one.bounds().hi.x == Approx(0.15));
  CHECK(one.bounds().hi.z == Approx(0.3 + 0.02 / std::sqrt(2.0)));
  CHECK_THROWS_WITH(build(probe, "calx.plane", v.set("normal", Vec3{})),
                    "normal: [0, 0, 0] has no direction; give a vector such as [0, 0, 1]");
  CHECK(probe.status() == CALX_E_CONFIG);
}

TEST_CASE("box: closed it is sound, each open face leaves four open edges and nothing to touch") {
  PluginProbe probe("calx_box");
  ProbeValues v = probe.presets("calx.box");
  v.set("min", Vec3{-0.1, -0.2, 0}).set("max", Vec3{0.1, 0.2, 0.3});
  const Surface closed = build(probe, "calx.box", v);
  CHECK(closed.faults().describe() == "");
  const struct {
    const char* name;
    Vec3 at;
  } faces[] = {{"open_left", {-0.1, 0, 0.15}}, {"open_right", {0.1, 0, 0.15}}, {"open_front", {0, -0.2, 0.15}},
               {"open_back", {0, 0.2, 0.15}},  {"open_bottom", {0, 0, 0}},     {"open_top", {0, 0, 0.3}}};
  for (const auto& f : faces) {
    CHECK(distance_to(closed, f.at, 0.01) == 0);
    ProbeValues open = v;
    const Surface s = build(probe, "calx.box", open.set(f.name, "yes"));
    CHECK(s.faults().open_edges == 4);
    CHECK(s.faults().inverted == 0);
    CHECK(contacts(s, f.at, 0.05).empty());
    for (const auto& other : faces)
      if (other.name != f.name) CHECK(distance_to(s, other.at, 0.01) == 0);
  }
  CHECK_THROWS_WITH(build(probe, "calx.box", v.set("max_y", -0.3)),
                    "min and max: along y min = -0.200000 m is not below max = -0.300000 m");
  for (const auto& f : faces) v.set(f.name, "yes");
  CHECK_THROWS_WITH(build(probe, "calx.box", v),
                    "open_left to open_top: all six faces are open; leave at least one closed");
}

TEST_CASE("cylinder: caps close the ends named, smooth and faceted") {
  PluginProbe probe("calx_cylinder");
  for (const double facets : {0.0, 64.0})
    for (const char* caps : {"none", "bottom", "top", "both"}) {
      ProbeValues v = probe.presets("calx.cylinder");
      v.set("from", Vec3{0, 0.1, 0})
          .set("to", Vec3{0, 0.4, 0})
          .set("radius", 0.05)
          .set("caps", caps)
          .set("facets", facets);
      const Surface s = build(probe, "calx.cylinder", v);
      const std::string c = caps;
      CHECK(contacts(s, {0.01, 0.1, 0.02}, 0.01).empty() == (c == "none" || c == "top"));
      CHECK(contacts(s, {0.01, 0.4, 0.02}, 0.01).empty() == (c == "none" || c == "bottom"));
      CHECK(contacts(s, {0.046, 0.2, 0}, 0.01).size() == 1);
      if (facets > 0) CHECK(s.faults().open_edges == (c == "none" ? 128u : c == "both" ? 0u : 64u));
    }
  ProbeValues v = probe.presets("calx.cylinder");
  CHECK_THROWS_WITH(build(probe, "calx.cylinder", v.set("facets", 2)),
                    "facets: 2 is too few; give 0 (smooth) or 3 and more");
  CHECK_THROWS_WITH(build(probe, "calx.cylinder", v.set("facets", 0.0).set("to", Vec3{})),
                    "from and to: both ends are the same point; give a cylinder some length");
}
