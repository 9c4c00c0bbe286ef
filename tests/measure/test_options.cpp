#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "measure/fake_world.hpp"

using namespace calx;

namespace {

FakeWorld small_world() {
  FakeWorld world;
  world.add_box("hopper", {0, 0, 0}, {1, 1, 1});
  world.add_box("canister", {0, 0, -1}, {1, 1, 0});
  world.add_part("rotor");
  world.add_motion("rotor turn", "");
  return world;
}

/// What stands between ` and ` of text, "pre-shear" and the like left out.
std::set<std::string> quoted_words(const std::string& text) {
  std::set<std::string> words;
  std::istringstream in(text);
  std::string part;
  for (bool inside = false; std::getline(in, part, '`'); inside = !inside)
    if (inside && part.front() != '"') words.insert(part);
  return words;
}

/// The row of a sensor kind in docs/case.md: keys, columns.
std::pair<std::set<std::string>, std::set<std::string>> documented(const std::string& kind) {
  std::ifstream page(CALX_SOURCE_DIR "/docs/case.md");
  for (std::string line; std::getline(page, line);) {
    const std::string start = "| `" + kind + "` |";
    if (line.compare(0, start.size(), start) != 0) continue;
    const std::size_t bar = line.find('|', start.size());
    return {quoted_words(line.substr(start.size(), bar - start.size())), quoted_words(line.substr(bar))};
  }
  return {};
}

}  // namespace

TEST_CASE("every built-in kind is known and makes a sensor with columns that end in a unit") {
  FakeWorld world = small_world();
  world.add_cylinder("drum", {0, 0, 0}, {0, 1, 0}, 0.5);
  const std::map<std::string, std::string> kinds = {
      {"mass", R"({"region": "hopper"})"},
      {"cycle-mass", R"({"region": "canister", "motion": "rotor turn"})"},
      {"flow", R"({"point": [0, 0, 0], "normal": [0, 0, -1]})"},
      {"bulk-density", R"({"region": "hopper"})"},
      {"coordination", "{}"},
      {"height-map", R"({"region": "hopper", "cell": 0.1})"},
      {"angle-of-repose", R"({"region": "hopper"})"},
      {"discharge", R"({"region": "hopper", "bed": "hopper", "width": 0.1, "length": 0.5})"},
      {"drum-surface", R"({"region": "drum"})"},
      {"inertial-number", R"({"region": "hopper"})"},
      {"residue", R"({"part": "rotor"})"},
      {"part-load", R"({"part": "rotor"})"},
      {"stress", R"({"parts": ["rotor"], "area": 0.1})"},
      {"cell-density", R"({"motion": "rotor turn", "area": 0.1, "lid": "rotor", "height": 0.1})"},
      {"wall-friction", R"({"motion": "rotor turn", "parts": ["rotor"], "area": 0.1})"},
      {"yield-locus", R"({"motion": "rotor turn", "parts": ["rotor"], "area": 0.1})"},
      {"energy", "{}"},
      {"mass-ledger", "{}"}};
  CHECK(kinds.size() == sensor_kinds().size());
  for (const SensorKind& kind : sensor_kinds()) {
    CAPTURE(std::string(kind.name));
    CHECK(is_builtin_sensor(kind.name));
    const std::string json = kinds.at(kind.name);
    const auto sensor = world.sensor(json, kind.name);
    CHECK(sensor->name() == "probe");
    CHECK(sensor->kind() == kind.name);
    CHECK(sensor->every() == 0.01);
    const std::vector<std::string> columns = sensor->columns();
    CHECK(sensor->sample(world).size() == columns.size());
    for (const std::string& column : columns) CHECK(column.find('_') != std::string::npos);

    // The page and the list name its columns, and the keys it reads, which the message of a wrong key lists.
    const auto [keys, named] = documented(kind.name);
    for (const std::string& column : columns)
      CHECK((named.count(column) == 1 || (column.compare(0, 3, "in_") == 0 && named.count("in_<region>_kg"))));
    if (std::string(kind.name) != "mass-ledger") CHECK(named.size() == columns.size());
    std::string wrong = json;
    wrong.insert(1, wrong == "{}" ? "\"zzzzzzzzzzzzzzzzzzzz\": 1" : "\"zzzzzzzzzzzzzzzzzzzz\": 1, ");
    const std::string message = world.error_of(wrong, kind.name);
    std::istringstream listed(message.substr(message.find("known are") + 9));
    std::string words;
    for (std::string word; listed >> word;) {
      word.erase(std::remove_if(word.begin(), word.end(), [](char c) { return c == '"' || c == ','; }), word.end());
      if (word == "name" || word == "kind" || word == "every") continue;
      CHECK(keys.count(word) == 1);
      words += word + " ";
    }
    std::string told = std::string(kind.keys) + " ";
    told.erase(std::remove(told.begin(), told.end(), ','), told.end());
    for (const std::string& key : keys) CHECK((" " + told).find(" " + key + " ") != std::string::npos);
    CHECK(std::count(told.begin(), told.end(), ' ') == std::max<long>(1, std::count(words.begin(), words.end(), ' ')));
  }
  CHECK_FALSE(is_builtin_sensor("calx.sensor"));
}

TEST_CASE("an unknown kind names the nearest one") {
  CHECK(
      small_world().error_of("{}", "bulk-densty") ==
      "case.json /sensors/0/kind: unknown kind of sensor \"bulk-densty\"; did you mean \"bulk-density\"? Built in are "
      "mass, cycle-mass, flow, bulk-density, coordination, height-map, angle-of-repose, discharge, drum-surface, "
      "inertial-number, residue, part-load, stress, cell-density, wall-friction, yield-locus, energy, mass-ledger; "
      "others "
      "are named by their plugin's id");
}

TEST_CASE("wrong keys and values say where, what and what would be right") {
  const FakeWorld world = small_world();
  CHECK(world.error_of(R"({"name": "probe", "kind": "mass", "every": 1, "regoin": "hopper"})", "mass") ==
        "case.json /sensors/0/regoin: unknown key of a sensor of kind mass; did you mean \"region\"?");
  CHECK(world.error_of(R"({"region": "hoper"})", "mass") ==
        "case.json /sensors/0/region: unknown region \"hoper\"; did you mean \"hopper\"?");
  CHECK(world.error_of(R"({"region": 3})", "mass") == "case.json /sensors/0/region: 3 is not the name of a region");
  CHECK(world.error_of("{}", "bulk-density") ==
        "case.json /sensors/0: sensor \"probe\" of kind bulk-density needs \"region\", one of the regions \"hopper\", "
        "\"canister\"");
  CHECK(world.error_of(R"({"region": "hopper", "motion": "rotor trun"})", "cycle-mass") ==
        "case.json /sensors/0/motion: unknown motion \"rotor trun\"; did you mean \"rotor turn\"?");
  CHECK(world.error_of(R"({"part": "rotr"})", "part-load") ==
        "case.json /sensors/0/part: unknown part \"rotr\"; did you mean \"rotor\"?");
  CHECK(world.error_of("{}", "part-load") == "case.json /sensors/0: sensor \"probe\" of kind part-load needs \"part\"");
  CHECK(world.error_of(R"({"part": "rotor", "every_step": 1})", "part-load") ==
        "case.json /sensors/0/every_step: 1 is neither true nor false");
  CHECK(world.error_of(R"({"region": "hopper", "sectors": 13})", "angle-of-repose") ==
        "case.json /sensors/0/sectors: 13 is outside 8 to 12");
  CHECK(world.error_of(R"({"region": "hopper", "sectors": 8.5})", "angle-of-repose") ==
        "case.json /sensors/0/sectors: 8.5 is not a whole number");
  CHECK(world.error_of(R"({"region": "hopper", "shape": "wegde"})", "angle-of-repose") ==
        "case.json /sensors/0/shape: unknown choice \"wegde\"; did you mean \"wedge\"?");
  CHECK(world.error_of(R"({"region": "hopper", "direction": [0, 0, 1]})", "angle-of-repose") ==
        "case.json /sensors/0/direction: has no horizontal part; give [x, y, 0]");
  CHECK(world.error_of(R"({"region": "hopper"})", "height-map") ==
        "case.json /sensors/0: sensor \"probe\" of kind height-map needs \"cell\", a number in m");
  CHECK(world.error_of(R"({"region": "hopper", "cell": "fine"})", "height-map") ==
        "case.json /sensors/0/cell: \"fine\" is not a number in m or {\"value\": ..., \"unit\": ...}");
  CHECK(world.error_of(R"({"region": "hopper", "cell": {"value": 1, "unit": "kg"}})", "height-map")
            .find("case.json /sensors/0/cell: unit \"kg\"") == 0);
  CHECK(world.error_of(R"({"region": "hopper", "cell": 1e-4})", "height-map").find("need more than 4000000 of them") !=
        std::string::npos);
  CHECK(world.error_of("{}", "residue") ==
        "case.json /sensors/0: sensor \"probe\" of kind residue needs \"part\", \"region\" or both");
}

TEST_CASE("flow refuses half a plane, two places and a normal without direction") {
  const FakeWorld world = small_world();
  CHECK(
      world.error_of(R"({"point": [0, 0, 0]})", "flow") ==
      "case.json /sensors/0: sensor \"probe\" of kind flow needs \"point\" and \"normal\" of a plane, or a \"region\"");
  CHECK(world.error_of(R"({"region": "hopper", "point": [0, 0, 0]})", "flow") ==
        "case.json /sensors/0/region: a flow sensor watches a region or a plane (point, normal), not both");
  CHECK(world.error_of(R"({"point": [0, 0, 0], "normal": [0, 0, 0]})", "flow") ==
        "case.json /sensors/0/normal: a normal of length 0 has no direction");
  CHECK(world.error_of(R"({"point": [0], "normal": [0, 0, 1]})", "flow") ==
        "case.json /sensors/0/point: [0] is not an array of two or three numbers");
  CHECK(world.error_of(R"({"point": [0, "x", 0], "normal": [0, 0, 1]})", "flow").find("/sensors/0/point/1: \"x\"") !=
        std::string::npos);
}

TEST_CASE("a length may carry its unit") {
  FakeWorld world = small_world();
  world.add_sphere({0.5, 0.5, 0.5}, 0.01);
  const auto sensor = world.sensor(R"({"region": "hopper", "cell": {"value": 100, "unit": "mm"}})", "height-map");
  sensor->sample(world);
  CHECK(sensor->fields().at(0).nx == 10);
  CHECK(sensor->fields().at(0).cell == doctest::Approx(0.1));
}
