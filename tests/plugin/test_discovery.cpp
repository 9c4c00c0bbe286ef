// Manifests and search folders: what is found, in which order, what is refused and why, and that nothing is executed.
#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.hpp"
#include "plugin/plugin.hpp"
#include "scratch.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

/// Sets an environment variable for one test case.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    const char* old = std::getenv(name);
    if (old) old_ = old;
    had_ = old != nullptr;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (had_)
      setenv(name_, old_.c_str(), 1);
    else
      unsetenv(name_);
  }

 private:
  const char* name_;
  std::string old_;
  bool had_;
};

/// The reason the one manifest of that text is refused, without "bad manifest PATH".
std::string refusal(const std::string& text) {
  Scratch scratch;
  scratch.write("x.so", "");
  const std::string path = scratch.write("x.plugin.json", text);
  const auto found = discover_plugins({scratch.path()});
  REQUIRE(found.size() == 1);
  CHECK(found[0].path == path);
  const std::string start = "bad manifest " + path;
  const std::string& reason = found[0].refused;
  return reason.compare(0, start.size(), start) == 0 ? reason.substr(start.size()) : reason;
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = manifest("test.x", "x.so");
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a manifest gives id, kind, version and absolute paths") {
  Scratch scratch;
  scratch.write("x.so", "");
  scratch.write("x.plugin.json", manifest("org.example.x", "x.so"));
  const auto found = discover_plugins({scratch.path()});
  REQUIRE(found.size() == 1);
  CHECK(found[0].id == "org.example.x");
  CHECK(found[0].kind == "calx.particle-force/1");
  CHECK(found[0].version == "1.0.0");
  CHECK(found[0].license == "MIT");
  CHECK(found[0].summary == "A plugin for tests.");
  CHECK(found[0].library == scratch.path("x.so"));
  CHECK(found[0].path == scratch.path("x.plugin.json"));
  CHECK(found[0].refused == "");
}

TEST_CASE("manifests are sorted by name within a folder, folders keep their order") {
  Scratch a, b;
  for (const char* name : {"zeta", "alpha", "mid"}) {
    b.write(std::string(name) + ".so", "");
    b.write(std::string(name) + ".plugin.json", manifest(std::string("test.b-") + name, std::string(name) + ".so"));
  }
  a.write("z.so", "");
  a.write("z.plugin.json", manifest("test.a", "z.so"));
  a.write("notes.json", "{}");
  a.write("deeper/y.plugin.json", manifest("test.deeper", "y.so"));
  std::vector<std::string> ids;
  for (const PluginManifest& m : discover_plugins({b.path(), a.path(), b.path()})) ids.push_back(m.id);
  CHECK(ids == std::vector<std::string>{"test.b-alpha", "test.b-mid", "test.b-zeta", "test.a"});
}

TEST_CASE("of a duplicate id the first usable one wins and both paths are told") {
  Scratch broken, first, second;
  broken.write("x.plugin.json", manifest("test.x", "missing.so"));
  for (const Scratch* s : {&first, &second}) {
    s->write("x.so", "");
    s->write("x.plugin.json", manifest("test.x", "x.so"));
  }
  const auto found = discover_plugins({broken.path(), first.path(), second.path()});
  REQUIRE(found.size() == 3);
  CHECK(found[0].refused.find("missing.so does not exist") != std::string::npos);
  CHECK(found[1].refused == "");
  CHECK(found[2].refused == "id test.x is provided by " + first.path("x.plugin.json") + " already, so " +
                                second.path("x.plugin.json") + " is not used");
}

TEST_CASE("a bad manifest is refused with the place and the reason") {
  CHECK(refusal("{\"calx_plugin\": 1,") == ": is not JSON: error at byte 19");
  CHECK(refusal("[]") == ": is not a JSON object");
  CHECK(refusal("{}") == ": has no \"calx_plugin\"");
  CHECK(refusal(changed("\"calx_plugin\": 1", "\"calx_plugin\": 2")) ==
        " /calx_plugin: manifest of schema 2, this host reads schema 1");
  CHECK(refusal(changed("\"version\": \"1.0.0\"", "\"version\": 1")) == " /version: 1 is not a text");
  CHECK(refusal(changed("\"version\"", "\"verison\"")) == " /verison: unknown key; did you mean \"version\"?");
  CHECK(refusal(changed("\"major\": 1, ", "")) == " /abi has no \"major\"");
  CHECK(refusal(changed("\"minor\": 0", "\"minor\": -1")) == " /abi/minor: -1 is not a whole number from 0 to 65535");
  CHECK(refusal(changed("\"summary\"", "\"sumary\"")) == " /plugins/0/sumary: unknown key; did you mean \"summary\"?");
  CHECK(refusal(changed("test.x", "x/../y")) ==
        " /plugins/0/id: \"x/../y\" is not an id such as \"org.example.wet-hertz\"");
  CHECK(refusal(changed("}]", "}], \"sha256\": \"ABC\"")) == " /sha256: not 64 lower-case hexadecimal digits");
  CHECK(refusal(changed("}]", "}, {\"id\": \"test.x\", \"kind\": \"calx.motion/1\", \"summary\": \"Again.\"}]")) ==
        " /plugins/1/id: \"test.x\" stands twice in this manifest");
  CHECK(refusal(changed("}]", "}], \"requires\": \"calx.host.log/1\"")) ==
        " /requires: \"calx.host.log/1\" is not a list");
}

TEST_CASE("what this host cannot run is refused before anything is loaded") {
  CHECK(refusal(changed("\"major\": 1", "\"major\": 2")) == "built for ABI 2.0, this host speaks ABI 1.0: rebuild it");
  CHECK(refusal(changed("\"minor\": 0", "\"minor\": 0, \"draft\": 2")) ==
        "built against draft 2 of the interface, this host speaks the released ABI 1.0: rebuild it, and take \"draft\" "
        "out of the manifest");
  CHECK(refusal(changed("\"minor\": 0", "\"minor\": 0, \"draft\": 0")).empty());
  CHECK(refusal(changed("\"minor\": 0", "\"minor\": 7")).empty());
  CHECK(refusal(changed("calx.particle-force/1", "calx.weather/1")) ==
        "of the kind calx.weather/1, which this host does not know; it knows \"calx.contact-law/1\", "
        "\"calx.geometry/1\", "
        "\"calx.motion/1\", \"calx.particle-force/1\", \"calx.sensor/1\", \"calx.servo/1\"");
  CHECK(refusal(changed("}]", "}], \"requires\": [\"calx.host.log/1\", \"calx.host.query/1\"]")) ==
        "needs the host extension calx.host.query/1, which this host lacks; it has \"calx.host.log/1\"");
  CHECK(refusal(changed("\"x.so\"", "{\"linux-riscv99\": \"x.so\"}")).find("; it has \"linux-riscv99\"") !=
        std::string::npos);
}

TEST_CASE("keys of a newer minor version are passed over") {
  CHECK(refusal(changed("\"minor\": 0", "\"minor\": 7, \"patch\": 3").replace(1, 0, "\"novelty\": true, ")) == "");
}

TEST_CASE("a library must stay inside the folder of its manifest") {
  Scratch scratch, elsewhere;
  scratch.write("out.so", "");
  elsewhere.write("out.so", "");
  fs::create_directory(scratch.path("in"));
  fs::create_directory_symlink(elsewhere.path(), scratch.path("in/link"));
  for (const std::string& library : {std::string("../out.so"), elsewhere.path("out.so"), std::string("link/out.so"),
                                     std::string("../in/../out.so")}) {
    const std::string path = scratch.write("in/x.plugin.json", manifest("test.x", library));
    const auto found = discover_plugins({scratch.path("in")});
    REQUIRE(found.size() == 1);
    CHECK(found[0].id == "test.x");
    CHECK(found[0].refused ==
          "bad manifest " + path + " /library: \"" + library + "\" lies outside the manifest's folder");
  }
  scratch.write("in/lib/x.so", "");
  scratch.write("in/x.plugin.json", manifest("test.x", "lib/./x.so"));
  CHECK(discover_plugins({scratch.path("in")})[0].library == scratch.path("in/lib/x.so"));
}

TEST_CASE("discovery and listing execute nothing") {
  const fs::path before = fs::current_path();
  Scratch here;
  fs::current_path(here.path());
  CHECK(discover_plugins({bad_folder("trap")}).size() == 1);
  const std::string list = plugin_list_text({bad_folder("trap"), bad_folder("changes_rounding")});
  fs::current_path(before);
  CHECK(list.find("test.trap") != std::string::npos);
  CHECK_FALSE(fs::exists(here.path("trap-was-executed")));
}

TEST_CASE("search folders: given ones first, then the environment, then the user's, each once") {
  Scratch given, listed, data;
  fs::create_directories(data.path("calx/plugins"));
  const Environment path("CALX_PLUGIN_PATH", ":" + listed.path() + "::" + given.path() + ":" + listed.path("missing"));
  const Environment home("XDG_DATA_HOME", data.path());
  const auto folders = plugin_search_path({given.path()});
  REQUIRE(folders.size() >= 3);
  CHECK(folders[0] == given.path());
  CHECK(folders[1] == listed.path());
  CHECK(folders[2] == data.path("calx/plugins"));
  CHECK(std::count(folders.begin(), folders.end(), given.path()) == 1);
  const std::string here = fs::current_path().string();
  CHECK(std::count(folders.begin(), folders.end(), here) == 0);
}

TEST_CASE("a missing given folder and a relative one in the environment are errors") {
  CHECK(message_of([] { plugin_search_path({"/no/such/folder"}); }) ==
        "plugin folder \"/no/such/folder\" does not exist; give a folder that holds *.plugin.json");
  CHECK(message_of([] { plugin_search_path({""}); }) ==
        "plugin folder \"\" does not exist; give a folder that holds *.plugin.json");
  const Environment path("CALX_PLUGIN_PATH", "plugins");
  CHECK(message_of([] { plugin_search_path({}); }) ==
        "CALX_PLUGIN_PATH: \"plugins\" is not an absolute path; plugins are never looked for relative to the working "
        "directory");
}
