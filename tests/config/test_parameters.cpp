// Parameter tables out of JSON: presets, units, angles, vectors, choices, ranges and what the extra schema adds.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "config/config.hpp"

using namespace calx;
using doctest::Approx;

namespace {

const double pi = 3.141592653589793;
const double big = 1e300;

const calx_field motion[] = {
    {"swing", "rad", "angle of a swing", 0, 2 * pi, pi, 0, 0},
    {"speed", "rad/s", "angular speed", -100, 100, 0, 0, 0},
    {"stroke", "m", "length of a stroke", 0, 1, 0, CALX_FIELD_REQUIRED, 0},
    {"cycles", "1", "number of cycles", 1, 1000, 1, CALX_FIELD_INTEGER, 0},
    {"base_x", "m", "point on the axis", -big, big, 0, CALX_VEC(1), 0},
    {"base_y", "m", "point on the axis", -big, big, 0, CALX_VEC(1), 0},
    {"base_z", "m", "point on the axis", -1, big, 0.5, CALX_VEC(1), 0},
    {"profile", "trapezoid|cosine|constant", "course of the speed", 0, 2, 1, CALX_FIELD_CHOICE, 0},
    {"k", "N/m^1.5", "stiffness", 0, big, 3, 0, 0},
    {"closed", "1", "closed at the end", 0, 1, 0, CALX_FIELD_INTEGER, 0},
};
const FieldTable table{motion, 10};
enum { swing, speed, stroke, cycles, base, profile = 7, k, closed };

std::vector<double> values(const std::string& json) {
  return resolve_parameters({json, "/motions/a/parameters", ""}, {table}, nullptr, "calx.turn 1.0.0", "case.json")
      .values.at(0);
}

std::string message(const std::string& json, const char* extra = nullptr) {
  try {
    resolve_parameters({json, "/motions/a/parameters", "/folder"}, {table}, extra, "calx.turn 1.0.0", "case.json");
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

const std::string at = "case.json /motions/a/parameters";

}  // namespace

TEST_CASE("what the user leaves out gets its preset and is listed") {
  const ResolvedParameters r = resolve_parameters({R"({"stroke": 0.2, "swing": 1})", "/p", ""}, {table}, nullptr,
                                                  "calx.turn 1.0.0", "case.json");
  CHECK(r.values.at(0) == std::vector<double>{1, 0, 0.2, 1, 0, 0, 0.5, 1, 3, 0});
  CHECK(r.presets_used == std::vector<std::string>{"speed", "cycles", "base", "profile", "k", "closed"});
  CHECK(r.extra_json == "{}");
}

TEST_CASE("degrees, units, vectors, choices and switches arrive in SI and table order") {
  const std::vector<double> v = values(R"({"swing_deg": 180, "speed": {"value": 30, "unit": "rpm"}, "cycles": 40,
    "stroke": {"value": 200, "unit": "mm"}, "base": [1, {"value": 2, "unit": "cm"}, -0.5], "profile": "constant", "closed": true})");
  CHECK(v[swing] == pi);
  CHECK(v[speed] == Approx(pi));
  CHECK(v[stroke] == 0.2);
  CHECK(v[cycles] == 40);
  CHECK(v[base] == 1);
  CHECK(v[base + 1] == 0.02);
  CHECK(v[base + 2] == -0.5);
  CHECK(v[profile] == 2);
  CHECK(v[closed] == 1);
  CHECK(values(R"({"stroke": 0, "speed_deg": 360})")[speed] == Approx(2 * pi));
  CHECK(values(R"({"stroke": 0, "base": {"value": [1, 2, 3], "unit": "mm"}})")[base + 2] == 0.003);
  CHECK(values(R"({"stroke": 0, "swing_deg": 360})")[swing] == 2 * pi);  // the bound itself, whatever the rounding
}

TEST_CASE("a value out of range is shown with the allowed range in its unit") {
  CHECK(message(R"({"stroke": -1})") == at + "/stroke: -1 m is out of range; calx.turn 1.0.0 allows 0 to 1 m");
  CHECK(message(R"({"stroke": {"value": 1500, "unit": "mm"}})") ==
        at + "/stroke: 1500 mm is out of range; calx.turn 1.0.0 allows 0 to 1 m");
  CHECK(message(R"({"stroke": 0, "swing_deg": 400})") ==
        at + "/swing_deg: 400 deg is out of range; calx.turn 1.0.0 allows 0 to 360 deg");
  CHECK(message(R"({"stroke": 0, "k": -5})") ==
        at + "/k: -5 N/m^1.5 is out of range; calx.turn 1.0.0 allows 0 N/m^1.5 or more");
  CHECK(message(R"({"stroke": 0, "base": [0, 0, -2]})") ==
        at + "/base/2: -2 m is out of range; calx.turn 1.0.0 allows -1 m or more");
  CHECK(message(R"({"stroke": 0, "cycles": 0})") ==
        at + "/cycles: 0 is out of range; calx.turn 1.0.0 allows 1 to 1000");
  CHECK(message(R"({"stroke": 0, "cycles": 1.5})") ==
        at + "/cycles: 1.5 is not a whole number; calx.turn 1.0.0 allows whole numbers, 1 to 1000");
}

TEST_CASE("unknown, missing, doubled and unfit values say what would be right") {
  CHECK(message(R"({"stroke": 0, "cycels": 3})") ==
        at + "/cycels: unknown key for calx.turn 1.0.0; did you mean \"cycles\"?");
  CHECK(message(R"({"stroke": 0, "base_x": 3})") ==
        at + "/base_x: unknown key for calx.turn 1.0.0; did you mean \"base\"?");
  CHECK(message("{}") == at + "/stroke: is missing; calx.turn 1.0.0 needs stroke, m: length of a stroke");
  const calx_field choice[] = {
      {"profile", "trapezoid|cosine", "course of the speed", 0, 1, 0, CALX_FIELD_CHOICE | CALX_FIELD_REQUIRED, 0}};
  CHECK_THROWS_WITH(resolve_parameters({"{}", "/p", ""}, {{choice, 1}}, nullptr, "calx.turn 1.0.0", "case.json"),
                    "case.json /p/profile: is missing; calx.turn 1.0.0 needs profile, one of \"trapezoid\", "
                    "\"cosine\": course of the speed");
  CHECK(message(R"({"stroke": 0, "swing": 1, "swing_deg": 1})") ==
        at + "/swing_deg: stands beside \"swing\"; give one of them");
  CHECK(message(R"({"stroke": 0, "profile": "cosin"})") ==
        at + "/profile: \"cosin\" is not a choice of calx.turn 1.0.0; did you mean \"cosine\"?");
  CHECK(message(R"({"stroke": 0, "base": [1, 2]})") == at + "/base: a list of 2 values; must be three numbers in m");
  CHECK(message(R"({"stroke": "far"})") == at + "/stroke: \"far\" is not a number; must be a number in m");
  CHECK(message(R"({"stroke": {"value": 1, "unit": "s"}})") ==
        at + "/stroke/unit: unit \"s\" measures a time; a length in m is needed");
  CHECK(message(R"({"stroke": 0, "stroke": 1})") ==
        "case.json /motions/a/parameters/stroke: this key stands twice in its object; keep one of them");
}

TEST_CASE("tables share an object, and keys of others are ignored when named") {
  const calx_field a[] = {{"k1", "N/m", "stiffness", 0, big, 1, 0, 0}},
                   b[] = {{"e", "1", "restitution", 0, 1, 0.5, 0, 0}};
  const std::vector<FieldTable> both = {{a, 1}, {b, 1}};
  const ResolvedParameters r = resolve_parameters({R"({"k1": 5, "e": 0.3, "density": 1})", "/p", ""}, both, nullptr,
                                                  "x", "case.json", {"density"});
  CHECK(r.values.at(0).at(0) == 5);
  CHECK(r.values.at(1).at(0) == 0.3);
  CHECK_THROWS_WITH(resolve_parameters({R"({"density": 1})", "/p", ""}, both, nullptr, "x", "case.json"),
                    "case.json /p/density: unknown key for x; known are \"k1\", \"e\"");
}

TEST_CASE("the extra schema checks lists and files, fills defaults and makes paths absolute") {
  const char* schema = R"({"properties": {
    "file": {"type": "string", "format": "path"}, "mode": {"enum": ["open", "shut"], "default": "open"},
    "points": {"type": "array", "minItems": 2, "items": {"type": "object", "required": ["t"], "properties": {
       "t": {"type": "number", "unit": "s", "minimum": 0}, "angle": {"type": "number", "unit": "rad", "default": 0}}}}},
    "required": ["file"]})";
  const auto extra = [&](const std::string& json) {
    return resolve_parameters({json, "/p", "/folder"}, {}, schema, "org.x 1", "case.json").extra_json;
  };
  CHECK(extra(R"({"file": "a/b.stl"})") == R"({"file":"/folder/a/b.stl","mode":"open"})");
  CHECK(
      extra(
          R"({"file": "/b.stl", "mode": "shut", "points": [{"t": {"value": 5, "unit": "ms"}, "angle_deg": 180}, {"t": 1}]})") ==
      R"({"file":"/b.stl","mode":"shut","points":[{"t":0.005,"angle":3.141592653589793},{"t":1.0,"angle":0}]})");
  CHECK_THROWS_WITH(extra("{}"), "case.json /p/file: is missing; org.x 1 needs it");
  CHECK_THROWS_WITH(extra(R"({"file": 3})"), "case.json /p/file: 3; org.x 1 needs text");
  CHECK_THROWS_WITH(extra(R"({"file": "a", "mode": "opn"})"),
                    "case.json /p/mode: \"opn\" is not one of the choices of org.x 1; did you mean \"open\"?");
  CHECK_THROWS_WITH(extra(R"({"file": "a", "points": [{"t": 1}]})"),
                    "case.json /p/points: a list of 1 value; org.x 1 needs at least 2");
  CHECK_THROWS_WITH(extra(R"({"file": "a", "points": [{"t": -1}, {"t": 1}]})"),
                    "case.json /p/points/0/t: -1 s is out of range; org.x 1 needs at least 0 s");
  CHECK_THROWS_WITH(extra(R"({"file": "a", "points": [{"t": 1, "angel": 2}, {"t": 1}]})"),
                    "case.json /p/points/0/angel: unknown key for org.x 1; did you mean \"angle\"?");
  CHECK_THROWS_WITH(extra(R"({"fil": "a"})"), "case.json /p/fil: unknown key for org.x 1; did you mean \"file\"?");
}

TEST_CASE("a schema that asks for more than the host can check is the plugin's fault") {
  try {
    resolve_parameters({"{}", "/p", ""}, {}, R"({"properties": {"a": {"oneOf": []}}})", "org.x 1", "case.json");
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::plugin);
    CHECK(std::string(e.what()).find("org.x 1: extra_schema /properties/a: keyword \"oneOf\" is not supported; ") == 0);
  }
  CHECK(message(R"({"stroke": 0})", "{") ==
        "calx.turn 1.0.0: extra_schema is not JSON; must be an object with \"properties\"");
}

TEST_CASE("keys of a material are checked against what the laws know") {
  const Parameters p{R"({"density": 1, "yuong": 2})", "/materials/calcine", ""};
  const auto keys = parameter_keys(p);
  REQUIRE(keys.size() == 2);
  CHECK(keys[1].first == "yuong");
  CHECK(keys[1].second == "/materials/calcine/yuong");
  CHECK_THROWS_WITH(check_keys(p, {"density", "young", "poisson"}, "case.json"),
                    "case.json /materials/calcine/yuong: unknown key; did you mean \"young\"?");
  CHECK(table_keys(table) == std::vector<std::string>{"swing", "swing_deg", "speed", "speed_deg", "stroke", "cycles",
                                                      "base", "profile", "k", "closed"});
}
