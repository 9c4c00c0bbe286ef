// Effects on parts, motions and grains: what they change in the case, closed forms where there are, and the sign of
// what follows on a tiny case.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "effects/machine.hpp"
#include "support/case.hpp"
#include "support/plugin_probe.hpp"

using namespace calx;
using Json = nlohmann::ordered_json;

namespace {

Json machine_json(const std::string& effects) {
  const PluginEffects library({CALX_PLUGIN_DIR});
  return Json::parse(parse_case(machine_text(effects), "machine.json", {}, &library).resolved);
}

std::string fault(const std::string& effects) {
  try {
    machine(effects);
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

/// Smallest and largest distance from the y axis through `centre` of the corners whose direction from the top towards
/// +x lies within half a radian of `angle`.
std::pair<double, double> radii(const std::function<void(ProbeValues&)>& set, const Vec3& centre, double angle) {
  PluginProbe probe("calx_rotary_valve");
  ProbeValues values = probe.presets("calx.rotary-valve");
  set(values);
  const auto instance = probe.create("calx.rotary-valve", values);
  std::vector<double> corners;
  calx_shape_sink sink{};
  sink.struct_size = sizeof sink;
  sink.self = &corners;
  sink.triangles = [](const calx_shape_sink* s, std::uint64_t n, const double* xyz, std::uint64_t,
                      const std::uint32_t*) {
    static_cast<std::vector<double>*>(s->self)->assign(xyz, xyz + 3 * n);
    return calx_status(CALX_OK);
  };
  REQUIRE(instance->table<calx_geometry>(CALX_GEOMETRY).build(instance->get(), probe.host(), &sink) == CALX_OK);
  std::pair<double, double> out{1e9, 0};
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    const double x = corners[k] - centre.x, z = corners[k + 2] - centre.z, r = std::hypot(x, z);
    if (std::fabs(std::remainder(std::atan2(x, z) - angle, 2 * 3.141592653589793)) > 0.5) continue;
    out.first = std::min(out.first, r);
    out.second = std::max(out.second, r);
  }
  return out;
}

/// Grains at or near the rotor that are below the height z after t seconds; the rotor stands still with a pocket on
/// top.
std::size_t below(double z, const std::string& effects, double t) {
  const PluginEffects library({CALX_PLUGIN_DIR});
  const CaseFile file = parse_case(machine_text(effects), "machine.json",
                                   {{"/parts/1/motion", "null"},
                                    {"/shapes/grain/sphere/radius", "0.0012"},
                                    {"/sources/0/count", "150"},
                                    {"/sources/1/count", "1"}},
                                   &library);
  Simulation sim(file, test_options());
  while (sim.time() < t) sim.step();
  std::size_t n = 0;
  for (const Record& b : sim.world().particles().body) n += b.x > 0.03 && b.z > 0.1 && b.z < z;
  return n;
}
std::size_t below_rotor(const std::string& effects, double t) { return below(0.53, effects, t); }

}  // namespace

TEST_CASE("a tilted floor is a rotated gravity: a ball rolls down with 5/7 g sin(tilt) towards the azimuth") {
  CaseText t;
  t.gravity = "[0, 0, -10]";
  t.contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                    "parameters": {"restitution": 0.1, "friction": 1}}])";
  t.parts =
      R"([{"name": "canister", "geometry": "calx.plane", "material": "sand", "parameters": {"half_u": 1, "half_v": 1}}])";
  t.more = R"("effects": [{"effect": "calx.canister-tilt", "parameters": {"tilt_deg": 3, "azimuth_deg": 90}}])";
  const PluginEffects library({CALX_PLUGIN_DIR});
  CaseFile file = parse_case(t.text(), "test.json", {}, &library);
  file.settings.sources.push_back(
      given_source("ball", {{{0, 0, 0.001 / std::cos(3 * 3.141592653589793 / 180)}, {}, {}, {}}}));
  Simulation sim(file, test_options());
  advance(sim, 10000);  // rolling without sliding
  const double before = body_of(sim, 0).vy;
  advance(sim, 20000);
  const double slope = 3 * 3.141592653589793 / 180;
  // Along y the acceleration down the slope has the share cos(slope). Hertz contacts creep by 1e-3 of it.
  CHECK((body_of(sim, 0).vy - before) / 0.2 ==
        doctest::Approx(10.0 * 5 / 7 * std::sin(slope) * std::cos(slope)).epsilon(2e-3));
  CHECK(std::fabs(body_of(sim, 0).vx) < 1e-9);
}

TEST_CASE("a tilt carries the motion that the canister has") {
  const Json c = machine_json(R"([{"effect": "calx.canister-tilt", "parameters": {"tilt_deg": 2}}])");
  CHECK(c["parts"][4]["motion"] == "shake");
  CHECK(c["motions"]["shake"]["carried_by"] == "tilt of canister");
  CHECK(c["motions"]["tilt of canister"]["parameters"]["tilt_deg"] == 2);
  CHECK(c["motions"]["tilt of canister"]["parameters"]["pivot"] == Json::parse("[0, 0, 0]"));  // "from" of the cylinder
}

TEST_CASE("a leak lets grains through a rotor that stands still, a gap below a grain does not") {
  CHECK(below_rotor("", 0.25) == 0);
  CHECK(below_rotor(R"([{"effect": "calx.rotor-leak", "parameters": {"gap": 0.0005}}])", 0.25) == 0);
  CHECK(below_rotor(R"([{"effect": "calx.rotor-leak", "parameters": {"gap": 0.005}}])", 0.25) > 10);
  const Json c = machine_json(R"([{"effect": "calx.rotor-leak", "parameters": {"gap": 0.002}}])");
  CHECK(c["parts"][1]["parameters"]["outer_radius"] == 0.025 - 0.002);
  CHECK(c["parts"][0]["parameters"]["length"] == 0.041 + 2 * 0.002);
}

TEST_CASE("an eccentric rotor is drawn beside its axis, towards the phase") {
  const Vec3 axis{0.0577, 0, 0.535};
  const auto set = [](ProbeValues& v) { v.set("eccentricity", 0.001).set("eccentricity_angle", 0.5235987755982988); };
  // A vane stands 30 degrees from the top: its tip is 1 mm further out there and 1 mm less on the other side.
  const double pi = 3.141592653589793;
  CHECK(radii(set, axis, pi / 6).second == doctest::Approx(0.026).epsilon(1e-3));
  CHECK(radii(set, axis, pi / 6 + pi).second == doctest::Approx(0.024).epsilon(1e-3));
  const Json c = machine_json(
      R"([{"effect": "calx.rotor-eccentricity", "parameters": {"eccentricity": 0.001, "phase_deg": 30}}])");
  CHECK(c["parts"][1]["parameters"]["eccentricity"] == 0.001);
  CHECK(c["parts"][1]["parameters"]["eccentricity_angle_deg"] == 30);
}

TEST_CASE("a blocked pocket has a share of its cross-section less, the others none") {
  const Vec3 axis{0.0577, 0, 0.535};
  const auto set = [](ProbeValues& v) { v.set("blocked_share", 0.5).set("blocked_pocket", 2); };
  const double pi = 3.141592653589793, full = std::sqrt(0.01 * 0.01 + 0.5 * (0.025 * 0.025 - 0.01 * 0.01));
  for (int k = 0; k < 6; ++k)
    CHECK(radii(set, axis, k * pi / 3).first == doctest::Approx(k == 2 ? full : 0.01).epsilon(1e-12));
  // The pocket on top takes in less of what is poured on it: 0.557 m is 3 mm below the vane tips.
  const std::size_t open = below(0.557, "", 0.2);
  CHECK(open > 60);
  CHECK(below(0.557, R"([{"effect": "calx.blocked-pocket", "parameters": {"share": 0.9}}])", 0.2) < open / 2);
  CHECK(below(0.557, R"([{"effect": "calx.blocked-pocket", "parameters": {"share": 0.9, "pocket": 3}}])", 0.2) == open);
  CHECK(fault(R"([{"effect": "calx.blocked-pocket", "parameters": {"share": 0.5, "pocket": 6}}])") ==
        "machine.json /parts/1/parameters: calx.rotary-valve 1.0.0: blocked_pocket: 6 of a rotor of 6 pockets, which "
        "count "
        "from 0");
}

TEST_CASE("timing and opening turn by degrees, whatever form the case gives the angle in") {
  const double pi = 3.141592653589793;
  const Json timed = machine_json(R"([{"effect": "calx.valve-timing", "parameters": {"offset_deg": -15}}])");
  CHECK(timed["parts"][1]["parameters"]["angle"].get<double>() == doctest::Approx(-pi / 12).epsilon(1e-15));
  const Json part = machine_json(R"([{"effect": "calx.butterfly-opening", "parameters": {"shortfall_deg": 30}}])");
  CHECK(part["motions"]["motion"]["parameters"]["angle_to"].get<double>() == doctest::Approx(pi / 3).epsilon(1e-15));
  CHECK(!part["motions"]["motion"]["parameters"].contains("angle_to_deg"));
}

TEST_CASE("a valve that opens less lets less through") {
  // Grains on the disc, which has no bore round it; those above its axis are still on it.
  const auto held = [](const std::string& shortfall) {
    const PluginEffects library({CALX_PLUGIN_DIR});
    const std::string use =
        R"([{"effect": "calx.butterfly-opening", "parameters": {"shortfall_deg": )" + shortfall + "}}]";
    const std::string box = R"({"box": {"min": [0.05, -0.01, 0.593], "max": [0.065, 0.01, 0.61]}})";
    Simulation sim(
        parse_case(machine_text(use), "machine.json",
                   {{"/sources/0/region", box}, {"/sources/0/count", "30"}, {"/sources/1/count", "1"}}, &library),
        test_options());
    while (sim.time() < 0.3) sim.step();
    std::size_t n = 0;
    for (const Record& b : sim.world().particles().body) n += b.z > 0.59;
    return n;
  };
  CHECK(held("0") == 0);
  CHECK(held("90") > 15);
}

TEST_CASE("attrition and finer grains scale the shape; fines are a second size") {
  const Json worn = machine_json(R"([{"effect": "calx.attrition", "parameters": {"loss": 0.25}}])");
  CHECK(worn["shapes"]["grain"]["sphere"]["radius"] == 0.0015);
  CHECK(worn["sources"][0]["count"] == 40);
  const PluginEffects library({CALX_PLUGIN_DIR});
  std::string text = machine_text(R"([{"effect": "calx.coarse-grain", "parameters": {"finer": 0.5}}])");
  const std::string base = R"("calx.hertz-mindlin", "parameters": {"restitution": 0.4, "friction": 0.5})";
  text.replace(text.find(base), base.size(), R"("calx.epam", "parameters": {"surface_energy": 0.1, "friction": 0.5})");
  const Json finer = Json::parse(parse_case(text, "machine.json", {}, &library).resolved);
  CHECK(finer["shapes"]["grain"]["sphere"]["radius"] == 0.001);
  CHECK(finer["contacts"][0]["parameters"]["surface_energy"].get<double>() == doctest::Approx(0.025));
  CHECK(finer["contacts"][0]["parameters"]["friction"] == 0.5);
  const Json mixed = machine_json(
      R"([{"effect": "calx.bimodal-size", "on": {"fill": "bed"}, "parameters": {"fines": 0.3, "ratio": 0.5}}])");
  CHECK(mixed["sources"][1]["size"] ==
        Json::parse(R"({"distribution": "list", "scales": [1, 0.5], "shares": [1, 0.3]})"));
  CHECK(!mixed["sources"][0].contains("size"));
}

TEST_CASE("a lip catches grains that fall along the wall of the bore") {
  const auto caught = [](const std::string& width) {
    CaseText t;
    t.gravity = "[0, 0, -10]";
    t.parts =
        R"([{"name": "nozzle", "geometry": "calx.nozzle-port", "material": "sand", "parameters": {"piece": "nozzle"}}])";
    t.more = R"("effects": [{"effect": "calx.nozzle-lip", "parameters": {"width": )" + width + "}}]";
    const PluginEffects library({CALX_PLUGIN_DIR});
    CaseFile file = parse_case(t.text(), "test.json", {}, &library);
    file.settings.sources.push_back(
        given_source("ball", {{{0.0165, 0, 0.32}, {}, {}, {}}, {{0, 0, 0.32}, {}, {}, {}}}));
    Simulation sim(file, test_options());
    advance(sim, 20000);
    return std::pair<double, double>{body_of(sim, 0).z, body_of(sim, 1).z};
  };
  CHECK(caught("0").first < 0.2);
  CHECK(caught("0.003").first > 0.306);
  CHECK(caught("0.003").second < 0.2);
  CHECK(fault(R"([{"effect": "calx.nozzle-lip", "parameters": {"width": 0.02}}])")
            .find("calx.nozzle-lip 1.0.0: width: 0.020000 m closes the bore of radius 0.018000 m; give less") !=
        std::string::npos);
}
