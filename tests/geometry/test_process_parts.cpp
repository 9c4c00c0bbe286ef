// The parts of the canister-filling process with their presets: sizes, clearances, and that neighbours leave no gap.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <set>

#include "geometry/shapes.hpp"

using namespace calx;
using doctest::Approx;

namespace {

const double pi = 3.141592653589793, deg = pi / 180;
const double axis_x = 0.0577, axis_z = 0.535;

PluginProbe& probe(const std::string& library) {
  static std::map<std::string, std::unique_ptr<PluginProbe>> open;
  auto& p = open[library];
  if (!p) p.reset(new PluginProbe(library));
  return *p;
}

Surface part(const std::string& library, const std::string& id) {
  return build(probe(library), id, probe(library).presets(id));
}

Surface piece(const char* name, double retracted = 0.04) {
  ProbeValues v = probe("calx_nozzle_port").presets("calx.nozzle-port");
  return build(probe("calx_nozzle_port"), "calx.nozzle-port", v.set("piece", name).set("retracted", retracted));
}

Surface throat() { return part("calx_butterfly_valve", "calx.butterfly-housing"); }
Surface rotor_housing() { return part("calx_rotary_valve", "calx.rotary-housing"); }

double largest_distance(const Surface& s, const std::vector<Vec3>& ring) {
  double largest = 0;
  for (const Vec3& p : ring) largest = std::max(largest, distance_to(s, p, 0.01));
  return largest;
}

std::vector<Vec3> circle(double x, double z, double r) {
  std::vector<Vec3> out;
  for (int k = 0; k < 360; ++k) out.push_back({x + r * std::cos(k * deg), r * std::sin(k * deg), z});
  return out;
}

/// The joint of a port: on the rotor bore over the ends of the port, straight along its sides. up: 1 inlet, -1 outlet.
std::vector<Vec3> port_joint(double up) {
  std::vector<Vec3> out;
  const double half_width = 0.0255 * std::sin(60 * deg), z = axis_z + up * (0.0255 * std::cos(60 * deg) + 0.0008);
  for (int k = -100; k <= 100; ++k)
    for (const double side : {1.0, -1.0}) {
      out.push_back({axis_x + side * half_width, 0.0002 * k, z});
      const double a = 60 * deg * k / 100;
      out.push_back({axis_x + 0.0255 * std::sin(a), side * 0.02, axis_z + up * 0.0255 * std::cos(a)});
    }
  return out;
}

double signed_prism_area(const Tessellation& t, double length) {
  double sum = 0;
  for (std::size_t k = 0; k < t.triangles.size(); k += 3) {
    const Vec3 a = t.vertices[t.triangles[k]], b = t.vertices[t.triangles[k + 1]], c = t.vertices[t.triangles[k + 2]];
    const Vec3 n = 0.5 * cross(b - a, c - a), m = (a + b + c) / 3 - Vec3{axis_x, 0, axis_z};
    sum += 0.5 * (m.x * n.x + m.z * n.z);  // area of the cross-section: half the flux of (x, z) through its sides
  }
  return sum / length;
}

double volume(const Tessellation& t) {
  double sum = 0;
  for (std::size_t k = 0; k < t.triangles.size(); k += 3)
    sum += dot(t.vertices[t.triangles[k]], cross(t.vertices[t.triangles[k + 1]], t.vertices[t.triangles[k + 2]])) / 6;
  return sum;
}

}  // namespace

TEST_CASE("every joint from hopper to canister lies within 0.6 mm of both neighbours") {
  const Surface hopper = part("calx_hopper", "calx.hopper"), upper = throat(), housing = rotor_housing();
  const Surface chute = piece("chute"), pipe = piece("pipe"), nozzle = piece("nozzle"), port = piece("port");
  const Surface canister = part("calx_canister", "calx.canister");
  const double tilt = std::atan(57.7 / 100), slope = std::tan(tilt / 2);
  std::vector<Vec3> elbow = circle(axis_x, 0.480, 0.018), bend = circle(0, 0.380, 0.018);
  for (Vec3& p : elbow) p.z -= (p.x - axis_x) * slope;
  for (Vec3& p : bend) p.z -= p.x * slope;
  const struct {
    std::string name;
    const Surface *one, *other;
    std::vector<Vec3> ring;
  } joints[] = {
      {"hopper-valve", &hopper, &upper, circle(axis_x, 0.670, 0.025)},
      {"throat-housing", &upper, &housing, port_joint(1)},
      {"housing-chute", &housing, &chute, port_joint(-1)},
      {"chute-pipe", &chute, &pipe, elbow},
      {"pipe-nozzle", &pipe, &nozzle, circle(0, 0.380 - 0.018 * slope, 0.018)},
      {"nozzle-port", &nozzle, &port, circle(0, 0.306, 0.018)},
      {"nozzle lip-collar rim", &nozzle, &port, circle(0, 0.306, 0.024)},
      {"port-canister", &port, &canister, circle(0, 0.260, 0.018)},
  };
  for (const auto& j : joints) {
    const double one = largest_distance(*j.one, j.ring), other = largest_distance(*j.other, j.ring);
    INFO(j.name, ": ", one, " and ", other, " m");
    CHECK(one < 0.6e-3);
    CHECK(other < 0.6e-3);
  }
  // The pipe itself bends within its own part.
  CHECK(largest_distance(pipe, bend) < 0.03e-3);
}

namespace {

struct Flood {
  double lowest = 1;    // m, the lowest centre reached
  bool leaked = false;  // a centre outside the envelope of the process was reached
};

/// Moves a small ball about between the fixed walls, from the throat down to the lid, on a grid of 1.5 mm and 0.75 mm
/// away from every wall: a hole that lets a ball of 2.25 mm through at a grid point leaks.
Flood flood(const std::vector<std::string>& pieces) {
  std::vector<Surface> walls;
  walls.push_back(throat());
  walls.push_back(rotor_housing());
  for (const std::string& name : pieces) walls.push_back(piece(name.c_str()));
  const double step = 1.5e-3, clear = 0.75e-3;
  using Cell = std::array<int, 3>;
  std::set<Cell> seen{{0, 0, 0}};
  std::deque<Cell> open{{0, 0, 0}};
  Flood result;
  while (!open.empty() && !result.leaked) {
    const Cell c = open.front();
    open.pop_front();
    const Vec3 p{axis_x + step * c[0], step * c[1], 0.590 + step * c[2]};
    if (p.z > 0.668 || p.z < 0.262) continue;
    bool is_free = true;
    for (const Surface& w : walls) is_free = is_free && contacts(w, p, clear).empty();
    if (!is_free) continue;
    result.lowest = std::min(result.lowest, p.z);
    result.leaked = std::abs(p.y) > 0.027 || p.x < -0.025 || p.x > axis_x + 0.027;
    for (int k = 0; k < 6; ++k) {
      Cell next = c;
      next[static_cast<std::size_t>(k / 2)] += k % 2 ? 1 : -1;
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a small ball finds its way from the throat to the lid and no way out") {
  const Flood whole = flood({"chute", "pipe", "nozzle", "port"});
  CHECK(!whole.leaked);
  CHECK(whole.lowest < 0.264);
  // Without the pipe it escapes, so the search can find holes.
  CHECK(flood({"chute", "nozzle", "port"}).leaked);
}

TEST_CASE("vane tips clear the housing by 0.5 mm wherever the bore is closed, and never by less") {
  const Surface housing = rotor_housing();
  std::size_t sealed = 0;
  for (const double angle : {0.0, 7.0, 13.0, 29.0, 45.0}) {
    ProbeValues v = probe("calx_rotary_valve").presets("calx.rotary-valve");
    const Surface rotor = build(probe("calx_rotary_valve"), "calx.rotary-valve", v.set("angle", angle * deg));
    for (const Vec3& p : rotor.tessellate(1e-5).vertices) {
      const double x = p.x - axis_x, z = p.z - axis_z, r = std::sqrt(x * x + z * z);
      const double away = distance_to(housing, {p.x, 0.97 * p.y, p.z}, 0.01);
      CHECK(away > 0.49e-3);
      if (r < 0.0249 || std::abs(std::atan2(z, std::abs(x))) > 28 * deg) continue;
      ++sealed;
      CHECK(r == Approx(0.025).epsilon(1e-9));
      CHECK(away == Approx(0.5e-3).epsilon(0.01));
      // And from the end plates.
      CHECK(0.0205 - std::abs(p.y) == Approx(0.5e-3));
    }
  }
  CHECK(sealed > 40);
}

TEST_CASE("a pocket holds 9.79 cm3 and stands on top at rest") {
  const Surface rotor = part("calx_rotary_valve", "calx.rotary-valve");
  const double area = signed_prism_area(rotor.tessellate(1e-5), 0.040);
  const double pocket = (pi * 0.025 * 0.025 - area) / 6 * 0.040;
  CHECK(pocket == Approx(9.7948e-6).epsilon(0.001));
  CHECK(contacts(rotor, {axis_x, 0, axis_z + 0.02}, 0.008).empty());
  CHECK(distance_to(rotor, {axis_x, 0, axis_z + 0.013}, 0.01) == Approx(0.003).epsilon(0.01));
  // Vanes lie at 30 and 90 degrees, 2 mm thick.
  CHECK(distance_to(rotor, {axis_x + 0.02, 0, axis_z + 0.003}, 0.01) == Approx(0.002));
  const Vec3 beside =
      Vec3{axis_x, 0, axis_z} + 0.02 * Vec3{0.5, 0, std::sqrt(0.75)} + 0.003 * Vec3{-std::sqrt(0.75), 0, 0.5};
  CHECK(distance_to(rotor, beside, 0.01) == Approx(0.002));
  CHECK_THROWS_WITH(build(probe("calx_rotary_valve"), "calx.rotary-valve",
                          probe("calx_rotary_valve").presets("calx.rotary-valve").set("vane_thickness", 0.011)),
                    "vane_thickness: 6 vanes of 0.011000 m leave no pocket at the hub; give less than 0.010000 m");
}

TEST_CASE("port edges: sharp, round and bevelled ones leave the opening and shorten the closed arc as stated") {
  const struct {
    const char* edges;
    double arc_begin_deg;
  } shapes[] = {{"sharp", 60}, {"round", 61.66}, {"bevel", 60 + 3 / 25.5 / deg}};
  for (const auto& s : shapes) {
    ProbeValues v = probe("calx_rotary_valve").presets("calx.rotary-housing");
    const Surface housing = build(probe("calx_rotary_valve"), "calx.rotary-housing", v.set("edges", s.edges));
    INFO(s.edges);
    const auto on_bore = [&](double a) {
      return distance_to(housing, {axis_x + 0.0255 * std::sin(a * deg), 0, axis_z + 0.0255 * std::cos(a * deg)}, 0.01);
    };
    CHECK(on_bore(s.arc_begin_deg + 0.3) < 5e-6);
    CHECK(on_bore(s.arc_begin_deg - 5) > 0.3e-3);
    CHECK(on_bore(180 - s.arc_begin_deg - 0.3) < 5e-6);
    CHECK(on_bore(-s.arc_begin_deg - 0.3) < 5e-6);
    CHECK(contacts(housing, {axis_x, 0, axis_z + 0.0255}, 0.0195).empty());
    // The strip beyond the port's end remains: half a millimetre of bore at full height.
    CHECK(distance_to(housing, {axis_x, 0.0203, axis_z + 0.0255}, 0.01) < 5e-6);
    CHECK(distance_to(housing, {axis_x, 0.0205, axis_z + 0.01}, 0.01) < 1e-9);
  }
  ProbeValues v = probe("calx_rotary_valve").presets("calx.rotary-housing");
  CHECK_THROWS_WITH(build(probe("calx_rotary_valve"), "calx.rotary-housing", v.set("port_length", 0.05)),
                    "port_length: 0.050000 m is more than length = 0.041000 m between the end plates");
}

TEST_CASE("the butterfly disc turns freely in its bore, seals closed and leaves 23 mm open") {
  const Surface housing = throat();
  for (const double angle : {0.0, 20.0, 45.0, 90.0}) {
    ProbeValues v = probe("calx_butterfly_valve").presets("calx.butterfly-valve");
    const Surface disc = build(probe("calx_butterfly_valve"), "calx.butterfly-valve", v.set("angle", angle * deg));
    double nearest = 1;
    for (const Vec3& p : disc.tessellate(1e-5).vertices) nearest = std::min(nearest, distance_to(housing, p, 0.03));
    CHECK(nearest > 0.4e-3);
    CHECK(nearest < 0.51e-3);
    // 0 closes the bore, 90 degrees stands on edge.
    const double above = distance_to(disc, {axis_x + 0.0125, 0, 0.640}, 0.03);
    if (angle == 0) CHECK(above <= 0.002 + 1e-12);
    if (angle == 90.0) CHECK(above == Approx(0.0105));
  }
}

TEST_CASE("throat and chute have the rectangle's sides, the bores their radius") {
  const Surface upper = throat(), chute = piece("chute"), pipe = piece("pipe"), nozzle = piece("nozzle");
  CHECK(distance_to(upper, {axis_x + 0.0221, 0.005, 0.565}, 0.01) < 1e-9);
  CHECK(distance_to(upper, {axis_x + 0.005, -0.020, 0.565}, 0.01) < 1e-9);
  CHECK(distance_to(upper, {axis_x, 0, 0.640}, 0.03) == Approx(0.025));
  CHECK(upper.faults().inverted == 0);
  CHECK(chute.faults().inverted == 0);
  CHECK(pipe.faults().inverted == 0);
  CHECK(chute.faults().non_manifold == 0);
  // The middle of the pipe is 18 mm from its wall all round, less the chords of 72 facets.
  const double wall = distance_to(pipe, {axis_x / 2, 0, 0.430}, 0.03);
  CHECK(wall <= 0.018);
  CHECK(wall > 0.018 * std::cos(pi / 72) - 1e-9);
  CHECK(distance_to(nozzle, {0, 0, 0.340}, 0.03) == Approx(0.018));
  CHECK_THROWS_WITH(build(probe("calx_nozzle_port"), "calx.nozzle-port",
                          probe("calx_nozzle_port").presets("calx.nozzle-port").set("rim_radius", 0.01)),
                    "rim_radius: 0.010000 m is not above bore_radius");
}

TEST_CASE("a straight pipe and other tilts fit as well") {
  for (const double x : {0.0, 0.0268, -0.1}) {
    ProbeValues v = probe("calx_nozzle_port").presets("calx.nozzle-port");
    v.set("pipe_bottom_x", axis_x - x);
    const auto make = [&](const char* name) {
      return build(probe("calx_nozzle_port"), "calx.nozzle-port", v.set("piece", name));
    };
    const Surface chute = make("chute"), pipe = make("pipe"), nozzle = make("nozzle");
    const double slope = std::tan(0.5 * std::atan(std::abs(x) / 0.1));
    std::vector<Vec3> elbow = circle(axis_x, 0.480, 0.018);
    for (Vec3& p : elbow) p.z -= (p.x - axis_x) * (x < 0 ? -slope : slope);
    CHECK(largest_distance(chute, elbow) < 0.03e-3);
    CHECK(largest_distance(pipe, elbow) < 0.03e-3);
    const std::vector<Vec3> end = circle(axis_x - x, 0.380 - 0.018 * slope, 0.018);
    CHECK(largest_distance(pipe, end) < 0.03e-3);
    CHECK(largest_distance(nozzle, end) < 1e-9);
  }
}

TEST_CASE("gates: retracted they clear the bore, shut they leave 2 mm and a recess of 6 mm") {
  const Surface open = piece("nozzle-gate"), shut = piece("nozzle-gate", 0), port_gate = piece("port-gate", 0);
  CHECK(shut.faults().describe() == "");
  CHECK(open.bounds().hi.y < -0.018);
  CHECK(shut.bounds().hi.y == Approx(0.016));
  CHECK(shut.bounds().lo.y < -0.018);
  CHECK(shut.bounds().lo.z == Approx(0.306));
  CHECK(shut.bounds().hi.z == Approx(0.308));
  CHECK(port_gate.bounds().hi.z == Approx(0.300));
  CHECK(port_gate.bounds().lo.z == Approx(0.298));
  // The tip is bevelled upwards: a ball before it is pushed up and forward.
  const auto c = contacts(shut, {0, 0.0157, 0.3077}, 0.0015);
  REQUIRE(c.size() == 1);
  CHECK(norm(c[0].normal - Vec3{0, std::sqrt(0.5), std::sqrt(0.5)}) < 1e-9);
}

TEST_CASE("canister, false floor and hopper have the stated volumes and heights") {
  PluginProbe& can = probe("calx_canister");
  const Surface closed = build(can, "calx.canister", can.presets("calx.canister").set("lid", "closed"));
  CHECK(volume(closed.tessellate(1e-6)) == Approx(8.168e-3).epsilon(0.001));
  const Surface lid = part("calx_canister", "calx.canister");
  CHECK(distance_to(lid, {0, 0, 0.260}, 0.03) == Approx(0.018));
  CHECK(distance_to(lid, {0.05, 0, 0.255}, 0.03) == Approx(0.005));
  CHECK(contacts(build(can, "calx.canister", can.presets("calx.canister").set("lid", "none")), {0.05, 0, 0.26}, 0.04)
            .empty());
  const Surface floor = part("calx_false_floor", "calx.false-floor");
  CHECK(distance_to(floor, {0.03, 0.02, 0.240}, 0.01) == Approx(0.005));
  CHECK(distance_to(floor, {0.03, 0.02, 0.230}, 0.01) == Approx(0.005));
  CHECK(floor.bounds().hi.x == Approx(0.1));
  PluginProbe& false_floor = probe("calx_false_floor");
  const Surface thick =
      build(false_floor, "calx.false-floor", false_floor.presets("calx.false-floor").set("thickness", 0.01));
  CHECK(volume(thick.tessellate(1e-6)) == Approx(pi * 0.01 * 0.01).epsilon(0.001));

  PluginProbe& hop = probe("calx_hopper");
  const Surface hopper = part("calx_hopper", "calx.hopper");
  // Half angle of the cone 25.1 degrees.
  const double half = std::atan(75.0 / 160);
  CHECK(half / deg == Approx(25.1).epsilon(0.002));
  const auto c = contacts(hopper, {axis_x, 0.05, 0.750}, 0.02);
  REQUIRE(c.size() == 1);
  CHECK(c[0].distance == Approx((0.0625 - 0.05) * std::cos(half)));
  CHECK(c[0].normal.z == Approx(std::sin(half)));
  CHECK(hopper.bounds().hi.z == Approx(1.0));
  CHECK(hopper.bounds().lo.z == Approx(0.670));
  CHECK_THROWS_WITH(build(hop, "calx.hopper", hop.presets("calx.hopper").set("bore_radius", 0.2)),
                    "bore_radius: 0.200000 m is larger than top_radius = 0.100000 m; a hopper narrows downwards");
}

TEST_CASE("descriptors: presets build, vector rows come in threes, ranges hold the presets") {
  const std::pair<const char*, const char*> all[] = {{"calx_plane", "calx.plane"},
                                                     {"calx_box", "calx.box"},
                                                     {"calx_cylinder", "calx.cylinder"},
                                                     {"calx_hopper", "calx.hopper"},
                                                     {"calx_canister", "calx.canister"},
                                                     {"calx_false_floor", "calx.false-floor"},
                                                     {"calx_butterfly_valve", "calx.butterfly-valve"},
                                                     {"calx_butterfly_valve", "calx.butterfly-housing"},
                                                     {"calx_rotary_valve", "calx.rotary-valve"},
                                                     {"calx_rotary_valve", "calx.rotary-housing"},
                                                     {"calx_nozzle_port", "calx.nozzle-port"}};
  for (const auto& p : all) {
    INFO(p.second);
    const calx_descriptor& d = probe(p.first).descriptor(p.second);
    CHECK(std::string(d.kind) == CALX_GEOMETRY);
    for (std::uint32_t k = 0; k < d.parameter_count; ++k) {
      const calx_field& f = d.parameter[k];
      CHECK(f.lowest <= f.preset);
      CHECK(f.preset <= f.highest);
      const std::string name = f.name;
      if ((f.flags >> 8 & 255) == 0) continue;
      std::uint32_t same = 0;
      for (std::uint32_t i = 0; i < d.parameter_count; ++i) same += (d.parameter[i].flags >> 8) == (f.flags >> 8);
      CHECK(same == 3);
      if (name.substr(name.size() - 2) == "_x") {
        CHECK(std::string(d.parameter[k + 1].name) == name.substr(0, name.size() - 1) + "y");
        CHECK(std::string(d.parameter[k + 2].name) == name.substr(0, name.size() - 1) + "z");
      }
    }
    CHECK(part(p.first, p.second).element_count() > 0);
  }
}
