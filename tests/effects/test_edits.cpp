// The key "effects" of a case: roles, parameters, edits, the record in the resolved case, and error texts.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "config/config.hpp"
#include "effects/sample_effect.hpp"

using namespace calx;
using Json = nlohmann::ordered_json;

namespace {

const char* const half_mm =
    R"([{"effect": "org.example.leak", "parameters": {"gap": {"value": 0.5, "unit": "mm"}, "turn_deg": 90}}])";

CaseFile expanded(const std::string& text) {
  const SampleLibrary library;
  return parse_case(text, "case.json", {}, &library);
}

std::string fault(const std::string& text) {
  try {
    expanded(text);
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("edits reach parameters, presets, contacts, forces, shapes and motions") {
  const Json c = Json::parse(expanded(sample_case(half_mm)).resolved);
  const Json& rotor = c["parts"][0];
  CHECK(rotor["parameters"]["radius"] == 0.025 - 2 * 0.0005);  // the plugin's preset
  CHECK(rotor["parameters"]["angle"].get<double>() == doctest::Approx(3.141592653589793).epsilon(1e-15));
  CHECK(!rotor["parameters"].contains("angle_deg"));
  const Json& laws = c["contacts"][1]["laws"];
  REQUIRE(laws.size() == 2);
  CHECK(laws[0] == Json::parse(R"({"law": "calx.linear", "parameters": {"kn": 1000}})"));
  CHECK(laws[1]["parameters"]["k"] == 0.0005);
  CHECK(!c["contacts"][1].contains("law"));
  CHECK(c["contacts"][0]["law"] == "calx.linear");
  CHECK(c["forces"][0]["parameters"]["min"] == Json::parse("[-0.05, -0.05, 0.1]"));
  // 1 - 100 * 0.0005
  CHECK(c["shapes"]["grain"]["spheres"][0]["radius"]["value"] == 0.95 * 2);
  CHECK(c["shapes"]["grain"]["spheres"][0]["at"][2] == 0.95 * 0.001);
  CHECK(rotor["motion"] == "turn");
  CHECK(c["motions"]["turn"]["carried_by"] == "shift of rotor");
}

TEST_CASE("a part without a motion is given the one that carries it") {
  std::string text = sample_case(half_mm);
  text.replace(text.find("\"motion\": \"turn\", "), 18, "");
  CHECK(Json::parse(expanded(text).resolved)["parts"][0]["motion"] == "shift of rotor");
}

TEST_CASE("at the off value numbers are the case's own, and what must not be there is left out") {
  const Json c =
      Json::parse(expanded(sample_case(R"([{"effect": "org.example.leak", "parameters": {"gap": 0}}])")).resolved);
  CHECK(c["parts"][0]["parameters"]["radius"] == 0.025);
  CHECK(c["parts"][0]["parameters"]["angle"] == 90 * 3.141592653589793 / 180);
  CHECK(c["shapes"]["grain"]["spheres"][0]["radius"]["value"] == 2);
  CHECK(!c.contains("forces"));
}

TEST_CASE("the resolved case records the effect, and is not expanded again") {
  const CaseFile once = expanded(sample_case(half_mm));
  REQUIRE(once.settings.effects.size() == 1);
  CHECK(once.settings.effects[0].effect == "org.example.leak");
  CHECK(Json::parse(once.settings.effects[0].on) ==
        Json::parse(R"({"rotor": "rotor", "powder": "sand", "wall": "steel"})"));
  REQUIRE(once.settings.assumptions.size() == 1);
  CHECK(once.settings.assumptions[0] ==
        "Effect org.example.leak 1.0.0 on rotor \"rotor\", powder \"sand\", wall \"steel\": gap = 5e-04 m, turn_deg = "
        "90 "
        "deg.");
  const CaseFile again = parse_case(once.resolved, "elsewhere/case.json");  // without any library
  CHECK(again.resolved == once.resolved);
  CHECK(again.settings.effects.size() == 1);
}

TEST_CASE("two effects on the same number add up, in the order given") {
  const std::string one = R"({"effect": "org.example.leak", "parameters": {"gap": 0.001}})";
  const std::string second = R"({"effect": "org.example.leak", "parameters": {"gap": 0.002}})";
  const SampleLibrary library(R"({
    "parameters": [{"name": "gap", "unit": "m", "off": 0, "scale": 0.001, "range": [0, 0.01], "doc": "gap"}],
    "touches": ["torque"],
    "edits": [{"op": "add", "at": "/parts/rotor/parameters/radius", "value": "{gap}", "times": -2, "unit": "m"}]})");
  const CaseFile c = parse_case(sample_case("[" + one + ", " + second + "]"), "case.json", {}, &library);
  CHECK(Json::parse(c.resolved)["parts"][0]["parameters"]["radius"] == 0.025 - 0.002 - 0.004);
}

TEST_CASE("errors name effect, role or parameter, place, value, and what would be right") {
  CHECK(fault(sample_case(R"([{"effect": "org.example.leek", "parameters": {"gap": 0}}])")) ==
        "case.json /effects/0/effect: no effect \"org.example.leek\" among the plugins found; did you mean "
        "\"org.example.leak\"?");
  CHECK(
      fault(sample_case(R"([{"effect": "org.example.leak"}])")) ==
      "case.json /effects/0/parameters/gap: is missing; effect org.example.leak needs its strength: width of the gap; "
      "off is 0 m, typical are 0.001 m");
  CHECK(fault(sample_case(R"([{"effect": "org.example.leak", "parameters": {"gap": -0.001}}])")) ==
        "case.json /effects/0/parameters/gap: -0.001 m is out of range; effect org.example.leak allows 0 to 0.01 m");
  CHECK(fault(sample_case(R"([{"effect": "org.example.leak", "parameters": {"gap": {"value": 1, "unit": "kg"}}}])"))
            .find("case.json /effects/0/parameters/gap/unit: unit \"kg\" measures a mass") == 0);
  CHECK(fault(sample_case(R"([{"effect": "org.example.leak", "parameters": {"gap": 0, "trun_deg": 1}}])")) ==
        "case.json /effects/0/parameters/trun_deg: unknown key; did you mean \"turn_deg\"?");
  CHECK(fault(sample_case(R"([{"effect": "org.example.leak", "on": {"roter": "rotor"}, "parameters": {"gap": 0}}])")) ==
        "case.json /effects/0/on/roter: effect org.example.leak has no role \"roter\"; did you mean \"rotor\"?");
  CHECK(fault(sample_case(R"([{"effect": "org.example.leak", "on": {"rotor": "rota"}, "parameters": {"gap": 0}}])")) ==
        "case.json /effects/0/on/rotor: no part is called \"rota\"; did you mean \"rotor\"?");
  CHECK(fault(sample_case(half_mm, R"("parameters": {})"))
            .find("case.json /effects/0: effect org.example.leak, edit 1 (add): the case gives no "
                  "/parts/rotor/parameters/angle, and its plugin has no preset of it") == 0);
  std::string other = sample_case(half_mm);
  other.replace(other.find("org.example.rotor"), 17, "org.example.hub");
  CHECK(fault(other) ==
        "case.json /effects/0/on/rotor: effect org.example.leak needs a rotor (the rotor): the case has no part of "
        "\"org.example.rotor\"");
  try {
    parse_case(sample_case(half_mm), "case.json");
    FAIL("accepted without a library");
  } catch (const Error& e) {
    CHECK(
        std::string(e.what()) ==
        "case.json /effects/0: effects come from plugins, and this reader was given none; read the case with plugins");
  }
}

TEST_CASE("a role with several candidates must be named, unless one is called like it") {
  const std::string twin =
      R"("parameters": {"angle": 0}}, {"name": "other", "geometry": "org.example.rotor", "material": "steel")";
  CHECK(fault(sample_case(half_mm, twin)) == "accepted");
  std::string text = sample_case(half_mm, twin);
  text.replace(text.find("\"name\": \"rotor\""), 15, "\"name\": \"first\"");
  CHECK(fault(text) ==
        "case.json /effects/0/on/rotor: effect org.example.leak needs a rotor (the rotor): the case has several; name "
        "one "
        "of \"first\", \"other\"");
}
