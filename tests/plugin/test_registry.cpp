// From ids to instances: what is found, what is told when nothing is, counted init, provenance, messages of plugins.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/sha256.hpp"
#include "plugin/plugin.hpp"
#include "scratch.hpp"

using namespace calx;

namespace {

const char* const force = CALX_PARTICLE_FORCE;

InstancePtr make(PluginRegistry& registry, const std::string& id, const std::string& json = "{}") {
  Parameters parameters;
  parameters.json = json;
  parameters.pointer = "/forces/0";
  return registry.create(id, force, parameters, "case.json");
}

/// What tests/bad_plugins/counts.c tells: init calls less deinit calls.
double users(const PluginInstance& instance) {
  double fx = -1;
  calx_particle_block block{};
  block.struct_size = sizeof block;
  block.count = 1;
  block.fx = &fx;
  static_cast<const calx_particle_force*>(instance.table(force))->eval(instance.get(), &block);
  return fx;
}

}  // namespace

TEST_CASE("init and deinit are paired, once per registry that uses the library") {
  PluginRegistry outer({bad_folder("counts")});
  const InstancePtr kept = make(outer, "test.counts");
  CHECK(users(*kept) == 1);
  const InstancePtr again = make(outer, "test.counts");
  CHECK(users(*again) == 1);
  InstancePtr survivor;
  {
    PluginRegistry inner({bad_folder("counts")});
    survivor = make(inner, "test.counts");
    CHECK(users(*kept) == 2);
  }
  CHECK(users(*kept) == 2);  // the instance outlives its registry and keeps the library
  survivor.reset();
  CHECK(users(*kept) == 1);
}

TEST_CASE("an unknown id is answered with the nearest one and the folders searched") {
  PluginRegistry registry({bad_folder("good"), bad_folder("counts")});
  CHECK(message_of([&] { make(registry, "test.god"); }) ==
        "case.json /forces/0: no plugin test.god of the kind calx.particle-force/1 found in " + bad_folder("good") +
            ", " + bad_folder("counts") + "; did you mean \"test.good\"?");
}

TEST_CASE("a plugin of another kind is not taken") {
  PluginRegistry registry({bad_folder("good")});
  CHECK(message_of([&] { registry.load("test.good", CALX_MOTION, "case.json", "/motions/turn/plugin"); }) ==
        "case.json /motions/turn/plugin: plugin test.good is of the kind calx.particle-force/1, but calx.motion/1 is "
        "wanted here");
  CHECK(registry.provenance().empty());
}

TEST_CASE("a parameter the plugin does not have is an error of the case") {
  PluginRegistry registry({bad_folder("good")});
  try {
    make(registry, "test.good", "{\"gain\": 2}");
    FAIL("accepted");
  } catch (const Error& e) {
    CHECK(e.exit_code() == 3);
    CHECK(std::string(e.what()).find("case.json /forces/0/gain: unknown key") == 0);
  }
  CHECK(message_of([&] { registry.create_with_values("test.good", force, "case.json", "/forces/0", {1.0}); }) ==
        "case.json /forces/0: plugin test.good takes 0 values, 1 given");
}

TEST_CASE("exceptions of a C++ plugin become messages; the two plugins of one library are told apart") {
  PluginRegistry registry({bad_folder("throws")});
  CHECK(message_of([&] { make(registry, "test.confused"); }) ==
        "case.json /forces/0: plugin test.confused refused: " + bad_library("throws") +
            ": create failed with CALX_E_INTERNAL: table of moments is empty");
  CHECK(message_of([&] { make(registry, "test.strict", "{\"gain\": 3}"); }) ==
        "case.json /forces/0: test.strict 1.0.0: gain is above 2; give at most 2");
  CHECK(message_of([&] { make(registry, "test.strict", "{\"gain\": 2}"); }) == "no error");
  CHECK(message_of([&] { make(registry, "test.strict"); }) == "no error");
}

TEST_CASE("provenance names what was loaded, sorted by id, and nothing else") {
  PluginRegistry registry({bad_folder("good"), bad_folder("counts"), bad_folder("trap")});
  CHECK(registry.manifests().size() == 3);
  CHECK(std::string(registry.load("test.good", force, "case.json", "").version) == "1.0.0");
  make(registry, "test.counts");
  const auto from = registry.provenance();
  REQUIRE(from.size() == 2);
  CHECK(from[0].id == "test.counts");
  CHECK(from[1].id == "test.good");
  CHECK(from[1].version == "1.0.0");
  CHECK(from[1].path == bad_library("good"));
  CHECK(from[1].sha256 == sha256_file(bad_library("good")));
}

TEST_CASE("a plugin's failure after creation is told with its own message, once") {
  PluginRegistry registry({bad_folder("good")});
  const InstancePtr instance = make(registry, "test.good");
  const calx_host* host = instance->host();
  CHECK(std::string(host->name) == "calx");
  CHECK(host->struct_size == sizeof(calx_host));
  CHECK(message_of([&] { instance->check(CALX_OK, "case.json", "/parts/0", "build"); }) == "no error");
  const auto fail = [&](calx_status code, const char* text) {
    return message_of([&] { instance->check(host->fail(host, code, text), "case.json", "/parts/0", "build"); });
  };
  CHECK(fail(CALX_E_CONFIG, "pockets = 1; give 2 or more") ==
        "case.json /parts/0: test.good 1.0.0: pockets = 1; give 2 or more");
  CHECK(fail(CALX_E_IO, "mesh.stl: no such file") ==
        "case.json /parts/0: test.good 1.0.0: build failed with CALX_E_IO: mesh.stl: no such file");
  CHECK(message_of([&] { instance->check(CALX_E_IO, "case.json", "/parts/0", "build"); }) ==
        "case.json /parts/0: test.good 1.0.0: build failed with CALX_E_IO: no message");
  CHECK(fail(-77, nullptr) == "case.json /parts/0: test.good 1.0.0: build failed with status -77: no message");
}

TEST_CASE("a plugin writes into the run's log through the host extension, under its library's name") {
  Scratch scratch;
  LogSettings settings;
  settings.file = scratch.path("run.log");
  open_log(settings);
  PluginRegistry registry({bad_folder("speaks")});
  make(registry, "test.speaks");
  close_log();
  const std::string text = read_text(scratch.path("run.log"));
  CHECK(text.find(" warning bad_speaks: hello\n") != std::string::npos);
}
