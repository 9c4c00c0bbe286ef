// Cases that extend others, overrides from the command line, and where messages then point.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "cases.hpp"
#include "config/config.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

// A folder of its own that goes away with the test.
struct Folder {
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path / "sub");
  }
  ~Folder() { fs::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  fs::path path = fs::current_path() / "config_document_test";
};

std::string message_of(const std::string& path,
                       const std::vector<std::pair<std::string, std::string>>& overrides = {}) {
  try {
    read_case(path, overrides);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

std::string set(const std::string& pointer, const std::string& value) {
  try {
    parse_case(full_case(), "case.json", {{pointer, value}});
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a chain of cases merges as RFC 7396 says: objects member by member, lists whole, null takes away") {
  const Folder f;
  f.write(
      "base.json",
      R"({"calx": 1, "title": "base", "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1, "step": 1e-5},
    "materials": {"glass": {"density": 2500, "young": 1e7}}, "assumptions": ["a", "b"]})");
  f.write(
      "middle.json",
      R"({"extends": "base.json", "time": {"end": 2}, "materials": {"glass": {"young": null}, "steel": {"density": 7800}}})");
  const std::string top = f.write("sub/top.json", R"({"extends": "../middle.json", "assumptions": ["c"], "seed": 3})");
  const CaseFile c = read_case(top);
  CHECK(c.settings.title == "base");
  CHECK(c.settings.time.end == 2);
  CHECK(c.settings.time.step == 1e-5);
  CHECK(c.settings.seed == 3);
  REQUIRE(c.settings.materials.size() == 2);
  CHECK(c.settings.materials[0].properties.json == "{\"density\":2500}");
  CHECK(c.settings.assumptions == std::vector<std::string>{"c"});
  CHECK(c.settings.folder == (f.path / "sub").string());
  CHECK(c.resolved.find("extends") == std::string::npos);
  CHECK(parse_case(c.resolved, "run/case.json").resolved == c.resolved);
}

TEST_CASE("a message names the file of the chain that holds the mistake") {
  const Folder f;
  const std::string base =
      f.write("base.json", R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": "x"}})");
  const std::string top = f.write("top.json", R"({"extends": "base.json", "sed": 3})");
  CHECK(message_of(top) == base + " /time/end: \"x\" is not a number; must be a number in s");
  CHECK(message_of(top, {{"/time/end", "1"}}) == top + " /sed: unknown key; did you mean \"seed\"?");
  CHECK(message_of(top, {{"/time/end", "late"}}) == "--set /time/end: \"late\" is not a number; must be a number in s");
}

TEST_CASE("a chain that leads back or to nothing is refused") {
  const Folder f;
  const std::string a = f.write("a.json", R"({"extends": "b.json"})"),
                    b = f.write("b.json", R"({"extends": "sub/../a.json"})");
  CHECK(message_of(a) ==
        b + " /extends: \"sub/../a.json\" leads back to itself; a chain of cases must end in one that extends none");
  const std::string c = f.write("c.json", R"({"extends": "none.json"})"), none = (f.path / "none.json").string();
  CHECK(message_of(c) == c + " /extends: " + none + ": cannot be read; No such file or directory");
  CHECK(message_of(none) == none + ": cannot be read; No such file or directory");
  CHECK(message_of((f.path / "sub").string()) == (f.path / "sub").string() + ": is a folder; a file is needed");
}

TEST_CASE("a file of positions is found from the folder of the case, also when its resolved text lies elsewhere") {
  const Folder f;
  f.write("sub/grains.csv", "x_m,y_m,z_m\n0,0,0\n");
  const std::string path =
      f.write("case.json", R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1},
    "materials": {"glass": {"density": 2500}}, "shapes": {"ball": {"sphere": {"radius": 0.001}}},
    "sources": [{"shape": "ball", "material": "glass", "file": "sub/grains.csv"}]})");
  const CaseFile c = read_case(path);
  CHECK(c.settings.sources.at(0).file == (f.path / "sub/grains.csv").string());
  CHECK(parse_case(c.resolved, "/elsewhere/case.json").settings.sources.at(0).file == c.settings.sources.at(0).file);
}

TEST_CASE("overrides set numbers, text, list entries and keys the file does not have") {
  const auto with = [](const std::string& pointer, const std::string& value) {
    return parse_case(full_case(), "case.json", {{pointer, value}}).settings;
  };
  CHECK(with("/time/end", "2.0").time.end == 2);
  CHECK(with("/title", "Slow fill").title == "Slow fill");
  CHECK(with("/sources/0/mass", "{\"value\": 300, \"unit\": \"g\"}").sources.at(0).mass == 0.3);
  CHECK(with("/materials/calcine/shear", "1e7").materials.at(1).properties.json.find("\"shear\":10000000.0") !=
        std::string::npos);
  CHECK(with("/assumptions/-", "second").assumptions.size() == 2);
  CHECK(with("/time/step", "null").time.step == 0);
  CHECK(parse_case(least_case(), "case.json", {{"/output/frames_every", "0.5"}}).settings.output.frames_every == 0.5);
}

TEST_CASE("an override that fits nowhere says which step of its pointer fails") {
  CHECK(set("time/end", "1") == "--set time/end=1: the name must be a JSON pointer such as /time/end");
  CHECK(set("/tme/end", "1") == "--set /tme: unknown key; did you mean \"time\"?");
  CHECK(set("/sources/9/mass", "1") ==
        "--set /sources/9/mass=1: /sources is a list of 6; \"9\" must be an index from 0, or - to append");
  CHECK(set("/seed/x", "1") == "--set /seed/x=1: /seed is 7, which has no \"x\" inside");
}
