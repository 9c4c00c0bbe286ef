// Every mistake in a case gets a message that names file, pointer, value and what would be right.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "cases.hpp"
#include "config/config.hpp"

using namespace calx;

namespace {

std::string message_of(const std::string& text,
                       const std::vector<std::pair<std::string, std::string>>& overrides = {}) {
  try {
    parse_case(text, "case.json", overrides);
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
    return e.what();
  }
  return "no error";
}

// The full case with one text replaced by another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = full_case();
  const std::size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.replace(at, from.size(), to);
}

struct Row {
  const char *from, *to, *message;
};

void check(const std::vector<Row>& rows) {
  for (const Row& r : rows) CHECK(message_of(changed(r.from, r.to)) == std::string("case.json ") + r.message);
}

}  // namespace

TEST_CASE("bad syntax gives file, line and column") {
  CHECK(message_of("{\n  \"calx\": 1,\n}") ==
        "case.json line 3 column 1: not valid JSON; unexpected '}'; expected string literal; is there a comma too many "
        "before it?");
  CHECK(message_of("{\n  \"calx\" 1}") ==
        "case.json line 2 column 10: not valid JSON; unexpected number literal; expected ':'");
  CHECK(
      message_of("{\"time\": {\"end\": NaN}}") ==
      "case.json line 1 column 18: not valid JSON; invalid literal; JSON has no NaN or infinity, give a finite number");
  CHECK(message_of("{\"seed\": 1e999}") ==
        "case.json: not valid JSON; number overflow parsing '1e999'; numbers must lie within +-1.797e308");
  CHECK(message_of("[1]") == "case.json: holds a list of 1 value; a case is one JSON object");
  CHECK(message_of("{\"parts\": [{}, {\"name\": 1, \"name\": 2}]}") ==
        "case.json /parts/1/name: this key stands twice in its object; keep one of them");
}

TEST_CASE("a misspelt or foreign key is found and the nearest key offered") {
  check({{"\"overlap_limit\"", "\"overlap_limt\"", "/overlap_limt: unknown key; did you mean \"overlap_limit\"?"},
         {"\"time\": {", "\"tme\": {", "/tme: unknown key; did you mean \"time\"?"},
         {"\"frames_every\"", "\"frames\"", "/output/frames: unknown key; did you mean \"frames_every\"?"},
         {"\"rate\": 0.1", "\"rat\": 0.1", "/sources/0/rat: unknown key; did you mean \"rate\"?"},
         {"\"skin\"", "\"colour\"", "/neighbour/colour: unknown key; known is \"skin\""},
         {"\"end\": 12.0", "\"ned\": 12.0", "/time/ned: unknown key; did you mean \"end\"?"},
         {"\"from\": [0, 0, 0.2]", "\"form\": [0, 0, 0.2]",
          "/regions/hopper/cone/form: unknown key; did you mean \"from\"?"}});
}

TEST_CASE("a missing key is named with what it means") {
  CHECK(message_of("{}") == "case.json /calx: is missing; must be 1, the version of the format");
  check(
      {{"\"end\": 12.0, ", "", "/time/end: is missing; the end of the run in s"},
       {"\"min\": [-0.1, -0.1, 0], ", "", "/domain/min: is missing; the lowest corner of the domain, m"},
       {"\"density\": {\"value\": 2.017, \"unit\": \"g/cm^3\"}, ", "",
        "/materials/calcine/density: is missing; the density in kg/m^3 of particles of source \"hopper fill\""},
       {"\"law\": \"calx.epam\", \"parameters\": {\"k1\": 2e5}", "\"parameters\": {}",
        "/contacts/0/law: is missing; the id of a contact law, such as \"calx.epam\""},
       {"\"region\": \"hopper\", \"mass\": 0.6", "\"region\": \"hopper\"",
        "/sources/0/mass: is missing; the mass to make in kg, or \"count\", the number of particles"},
       {"\"kind\": \"mass\", ", "", "/sensors/0/kind: is missing; the kind of sensor, such as \"mass\", or \"plugin\""},
       {"\"until\": \"full\", ", "",
        "/stages/0/until: is missing; the event or condition that ends it; only the last stage may last to the end"}});
}

TEST_CASE("a value of the wrong type or shape says what is needed") {
  check(
      {{"\"end\": 12.0", "\"end\": \"soon\"", "/time/end: \"soon\" is not a number; must be a number in s"},
       {"\"gravity\": [0, 0, -9.81]", "\"gravity\": [0, 0]",
        "/gravity: a list of 2 values; must be three numbers in m/s^2"},
       {"\"gravity\": [0, 0, -9.81]", "\"gravity\": [0, 0, true]",
        "/gravity/2: true is not a number; must be a number in m/s^2"},
       {"\"seed\": 7", "\"seed\": 1.5", "/seed: 1.5; must be a whole number, 0 or more"},
       {"\"seed\": 7", "\"seed\": -1", "/seed: -1; must be a whole number, 0 or more"},
       {"\"energy\": true", "\"energy\": 1", "/energy: 1; must be true or false"},
       {"\"title\": \"Canister fill\"", "\"title\": 3", "/title: 3 is not text; must be a line of text"},
       {"\"output\": {", "\"output\": [], \"x\": {", "/output: a list of 0 values; must be output settings, an object"},
       {"\"calx\": 1", "\"calx\": 2", "/calx: 2 is not a version this program reads; must be 1"},
       {"\"assumptions\": [", "\"assumptions\": [7, ",
        "/assumptions/0: 7 is not text; must be one assumption in words"},
       {"[true, false, false]", "[true]",
        "/domain/periodic: a list of 1 value; must be three times true or false, for x, y and z"}});
}

TEST_CASE("a number out of range is shown as the user wrote it") {
  check(
      {{"{\"value\": 2.017, \"unit\": \"g/cm^3\"}", "-2017",
        "/materials/calcine/density: -2017 kg/m^3 is out of range; must be above 0"},
       {"{\"value\": 25, \"unit\": \"MPa\"}", "{\"value\": -25, \"unit\": \"MPa\"}",
        "/materials/calcine/young: -25 MPa is out of range; must be above 0"},
       {"\"poisson\": 0.25", "\"poisson\": 0.6",
        "/materials/calcine/poisson: 0.6 is out of range; must be above -1 and at most 0.5"},
       {"{\"radius\": 0.002}", "{\"radius\": 0}", "/shapes/ball/sphere/radius: 0 m is out of range; must be above 0"},
       {"\"step\": 1e-6", "\"step\": -1", "/time/step: -1 s is out of range; must be 0 or more"},
       {"\"rayleigh_fraction\": 0.2", "\"rayleigh_fraction\": 1.5",
        "/time/rayleigh_fraction: 1.5 is out of range; must be above 0 and at most 1"},
       {"\"min\": [-0.1, -0.1, 0]", "\"min\": [-0.1, 0.2, 0]",
        "/domain: min y = 0.2 m is not below max y = 0.1 m; every min must be below its max"},
       {"\"to\": [0, 0, 0.1]", "\"to\": [0, 0, 0]",
        "/regions/canister/cylinder: \"from\" and \"to\" are the same point; the axis must have a length"},
       {"\"lowest\": 0.9", "\"lowest\": 2",
        "/sources/4/size: lowest 2 is not below highest 1.3; lowest must be below highest"},
       {"\"deviation\": 0.1", "\"deviation\": 0.5",
        "/sources/0/size: three deviations below the mean is a scale of -0.3999999999999999; give \"lowest\" above 0"},
       {"\"shares\": [3, 1]", "\"shares\": [3]",
        "/sources/3/size/shares: a list of 1 value for 2 scales; must be one share for each"},
       {"[0.6, 0.8, 0, 0]", "[0.6, 0.6, 0, 0]",
        "/sources/2/orientations/1: the quaternion has length 0.848528137423857; must have length 1"},
       {"\"count\": 10", "\"count\": 0", "/sources/1/count: 0; must be a whole number, 1 or more"}});
}

TEST_CASE("a unit of another dimension names the dimension that is needed") {
  check({{"\"unit\": \"cm\"", "\"unit\": \"kg\"",
          "/domain/max/2/unit: unit \"kg\" measures a mass; a length in m is needed"},
         {"\"unit\": \"MPa\"", "\"unit\": \"mpa\"",
          "/materials/calcine/young/unit: unit \"mpa\": \"mpa\" is not known; did you mean \"MPa\"?"},
         {"{\"value\": 40, \"unit\": \"cm\"}", "{\"value\": 40}",
          "/domain/max/2/unit: is missing; a quantity is {\"value\": 2.5, \"unit\": \"mm\"}"},
         {"{\"value\": 40, \"unit\": \"cm\"}", "{\"value\": 40, \"unit\": \"cm\", \"x\": 1}",
          "/domain/max/2/x: unknown key; known are \"value\", \"unit\""}});
}

TEST_CASE("a name that nothing has is refused with the nearest one") {
  check({{"\"between\": [\"calcine\", \"steel\"]", "\"between\": [\"calcine\", \"stel\"]",
          "/contacts/1/between/1: no material is called \"stel\"; did you mean \"steel\"?"},
         {"\"shape\": \"grain\"", "\"shape\": \"grains\"",
          "/sources/0/shape: no shape is called \"grains\"; did you mean \"grain\"?"},
         {"\"region\": \"hopper\", \"mass\"", "\"region\": \"hoper\", \"mass\"",
          "/sources/0/region: no region is called \"hoper\"; did you mean \"hopper\"?"},
         {"\"motion\": \"lift\"", "\"motion\": \"lft\"",
          "/parts/0/motion: no motion is called \"lft\"; did you mean \"lift\"?"},
         {"\"start\": \"valve open\"", "\"start\": \"valve opens\"",
          "/motions/rotor turn/start: no event is called \"valve opens\"; did you mean \"valve open\"?"},
         {"\"remove\": [\"rotor\"]", "\"remove\": [\"rotr\"]",
          "/stages/0/remove/0: no part is called \"rotr\"; did you mean \"rotor\"?"},
         {"\"follows\": \"canister\"", "\"follows\": \"lid\"",
          "/regions/canister/follows: no part is called \"lid\"; known are \"canister\", \"rotor\""},
         {"\"on_leave\": \"delete\"", "\"on_leave\": \"remove\"",
          "/domain/on_leave: \"remove\" is not a way to treat particles that leave; known are \"error\", \"delete\", "
          "\"count\""},
         {"\"verlet\"", "\"verlt\"", "/time/integrator: \"verlt\" is not an integrator; did you mean \"verlet\"?"}});
}

TEST_CASE("things that may stand once are refused when they stand twice") {
  check(
      {{"\"between\": [\"calcine\", \"steel\"]", "\"between\": [\"calcine\", \"calcine\"]",
        "/contacts/1/between: \"calcine\" and \"calcine\" already have the contact /contacts/0; a pair has one, with "
        "several "
        "\"laws\" where they add"},
       {"\"name\": \"extra cohesion\"", "\"name\": \"calx.epam\"",
        "/contacts/1/laws/1: a law before it is called \"calx.epam\" too; give one of them another \"name\""},
       {"\"name\": \"rotor\"", "\"name\": \"canister\"",
        "/parts/1/name: another part is called \"canister\"; names of parts must differ"},
       {"\"name\": \"inline\"", "\"name\": \"canister mass\"",
        "/sensors/1/name: another sensor is called \"canister mass\"; names of sensors must differ"},
       {"\"name\": \"inline\"", "\"name\": \"a/b\"",
        "/sensors/1/name: \"a/b\" cannot be a name; must not hold slashes, line ends or tabs, since files are named "
        "after it"},
       {"\"count\": 10", "\"count\": 10, \"mass\": 1",
        "/sources/1/count: a source has a \"mass\" or a \"count\"; must have one"},
       {"\"size\": {\"scale\": 2}", "\"count\": 2", "/sources/2/count: does not go with given positions; leave it out"},
       {"\"laws\": [", "\"law\": \"x\", \"laws\": [",
        "/contacts/1: holds \"laws\" and \"law\"; must hold one law or a list of laws"}});
}

TEST_CASE("conditions that cannot be or never happen are refused") {
  check({{"{\"time\": 9}", "{\"time\": 9, \"event\": \"full\"}",
          "/parts/1/vanishes: holds \"time\" and \"event\"; must hold one; put several into \"all\" or \"any\""},
         {"{\"time\": 9}", "{\"tim\": 9}", "/parts/1/vanishes/tim: unknown key; did you mean \"time\"?"},
         {"{\"time\": 9}", "{}",
          "/parts/1/vanishes: is no condition; must hold one of \"time\", \"mass\", \"count\", \"settled\", \"cycle\", "
          "\"after\", "
          "\"event\", \"all\", \"any\""},
         {"\"at_most\": 3", "\"at_most\": 3, \"at_least\": 1",
          "/events/full/when/any/1/all/0/count: holds \"at_least\" and \"at_most\"; must hold one of them"},
         {"{\"settled\": {\"region\": \"hopper\", \"kinetic_per_particle\": 1e-9, \"hold\": 0.1, \"not_before\": 0.2}}",
          "{\"after\": {\"event\": \"full\"}}",
          "/events/valve open/when: \"valve open\" waits for \"full\" waits for \"valve open\"; events that wait for "
          "each other "
          "never happen"},
         {"\"lift\": {\"plugin\": \"calx.linear\"}",
          "\"lift\": {\"plugin\": \"calx.linear\", \"carried_by\": \"rotor turn\"}",
          "/motions/lift/carried_by: \"lift\" is carried by \"rotor turn\" is carried by \"lift\"; a motion must not "
          "carry itself"}});
}

TEST_CASE("a pin that is no hash and a list of positions that do not match are refused") {
  check({{"{\"sha256\": \"ba78", "{\"sha256\": \"ba7",
          "/plugins/org.example.sensor/sha256: \"ba716bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\"; "
          "must be 64 "
          "hexadecimal digits"},
         {"\"spins\": [[1, 0, 0], [2, 0, 0]]", "\"spins\": [[1, 0, 0]]",
          "/sources/2/spins: a list of 1 value for 2 positions; must be one for each position"}});
}

TEST_CASE("a file of positions that is not there is a file error") {
  try {
    parse_case(changed("\"region\": \"hopper\", \"mass\": 0.6, \"rate\": 0.1", "\"file\": \"none.csv\""),
               "/no/folder/case.json");
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::files);
    CHECK(std::string(e.what()) ==
          "/no/folder/case.json /sources/0/file: /no/folder/none.csv does not exist; must be the path of "
          "a CSV file, relative to /no/folder");
  }
}
