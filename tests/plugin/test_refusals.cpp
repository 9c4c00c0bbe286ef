// Every plugin of tests/bad_plugins is refused with its own message; the good one is not.
#include <doctest/doctest.h>

#include <cfenv>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "plugin/plugin.hpp"
#include "scratch.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

const char* const force = CALX_PARTICLE_FORCE;

struct Outcome {
  std::string text = "no error";
  int code = 0;
};

Outcome create(const std::string& id, const std::string& folder,
               const std::vector<std::pair<std::string, std::string>>& pins = {}, const std::string& kind = force) {
  try {
    PluginRegistry(std::vector<std::string>{folder}, pins).create_with_values(id, kind, "case.json", "/forces/0", {});
  } catch (const Error& e) {
    return {e.what(), e.exit_code()};
  }
  return {};
}

/// The outcome for a bad plugin without "case.json /forces/0: plugin ID refused: " and its library's path.
std::string reason(const std::string& name) {
  std::string id = "test." + name;
  for (char& c : id)
    if (c == '_') c = '-';
  const Outcome outcome = create(id, bad_folder(name));
  const std::string expected = "case.json /forces/0: plugin " + id + " refused: " + bad_library(name);
  INFO(outcome.text);
  CHECK(outcome.code == 4);
  REQUIRE(outcome.text.compare(0, expected.size(), expected) == 0);
  return outcome.text.substr(expected.size());
}

}  // namespace

TEST_CASE("the good plugin is created") { CHECK(create("test.good", bad_folder("good")).text == "no error"); }

TEST_CASE("the entry is checked before anything of it is called") {
  CHECK(reason("missing_symbol") == " exports no calx_plugin_entry, the one symbol of a Calx plugin");
  CHECK(reason("wrong_magic") ==
        ": calx_plugin_entry begins with 0x12345678 instead of 0x314c4143; it is no Calx plugin, or built for another "
        "byte order");
  CHECK(reason("other_major") == " was built for ABI 2.0, this host speaks ABI 1.0: rebuild it");
  CHECK(reason("small_struct") == ": calx_plugin_entry has 24 bytes, ABI 1.0 needs 40: rebuild it");
}

TEST_CASE("failures on the way to an instance are told with the plugin's own words") {
  CHECK(reason("init_fails") == ": init failed with CALX_E_IO: no calibration file");
  CHECK(reason("null_factory") == ": has no factory calx.factory/1");
  CHECK(reason("needs_extension") ==
        ": test.needs-extension needs the host extension calx.host.query/1, which this host lacks; it has "
        "\"calx.host.log/1\"");
  CHECK(reason("create_fails") == ": create failed with CALX_E_MEMORY: out of memory");
  CHECK(reason("create_nothing") == ": create reported success but made no instance");
}

TEST_CASE("a case the plugin finds wrong is a fault of the case, not of the plugin") {
  const Outcome outcome = create("test.create-rejects", bad_folder("create_rejects"));
  CHECK(outcome.text == "case.json /forces/0: test.create-rejects 1.0.0: gain = 3 is above 2; give at most 2");
  CHECK(outcome.code == 3);
}

TEST_CASE("the table of the kind is checked") {
  CHECK(reason("null_table") == ": it has no table calx.particle-force/1");
  CHECK(reason("null_eval") == ": its table calx.particle-force/1 lacks eval");
  CHECK(reason("wrong_draft") ==
        ": its table calx.particle-force/1 was built against draft 7, this host speaks the released one of ABI "
        "1.0: rebuild it");
  CHECK(reason("small_table") == ": its table calx.particle-force/1 has 8 bytes, ABI 1.0 needs 72: rebuild it");
}

TEST_CASE("a library that changes the rounding mode is refused and the mode put back") {
#if defined(__x86_64__)
  CHECK(
      reason("changes_rounding") ==
      " changed the floating-point mode of the process when it was loaded (MXCSR 0x1f80 became MXCSR 0x5f80); rebuild "
      "it without -ffast-math and without fesetround");
  CHECK(reason("changes_rounding_in_create") ==
        " changed the floating-point mode of the process in create (MXCSR 0x1f80 became MXCSR 0x3f80)");
#endif
  CHECK(std::fegetround() == FE_TONEAREST);
  // Its constructor does not run a second time, but the refusal is remembered.
  CHECK(reason("changes_rounding").find("changed the floating-point mode") != std::string::npos);
}

TEST_CASE("a manifest that promises what the library does not hold is refused") {
  const std::string folder = bad_folder("lying_manifest"), library = bad_library("lying_manifest");
  const std::string written = folder + "/bad_lying_manifest.plugin.json";
  CHECK(create("test.not-there", folder).text == "case.json /forces/0: plugin test.not-there refused: " + library +
                                                     " holds no plugin test.not-there, although " + written +
                                                     " says so; it holds \"test.good\"");
  CHECK(create("test.good", folder, {}, CALX_MOTION).text ==
        "case.json /forces/0: plugin test.good refused: " + library +
            " says test.good is of the kind calx.particle-force/1, but " + written + " says calx.motion/1");
  Scratch scratch;
  fs::copy(bad_library("good"), scratch.path("good.so"));
  std::string stale = manifest("test.good", "good.so");
  stale.replace(stale.find("1.0.0"), 5, "0.9.0");
  const std::string path = scratch.write("good.plugin.json", stale);
  CHECK(create("test.good", scratch.path()).text ==
        "case.json /forces/0: plugin test.good refused: " + scratch.path("good.so") +
            " holds version 1.0.0 of test.good, but " + path + " says 0.9.0");
}

TEST_CASE("a library everybody can change, a link, and a file that is no library are refused") {
  Scratch scratch;
  scratch.write("x.plugin.json", manifest("test.good", "x.so"));
  const std::string library = scratch.path("x.so"), start = "case.json /forces/0: plugin test.good refused: " + library;

  fs::copy(bad_library("good"), library);
  fs::permissions(library, fs::perms::others_write, fs::perm_options::add);
  CHECK(create("test.good", scratch.path()).text == start + " can be changed by every user; run chmod o-w on it");
  fs::permissions(library, fs::perms::others_write, fs::perm_options::remove);
  CHECK(create("test.good", scratch.path()).text == "no error");

  fs::remove(library);
  fs::create_symlink(bad_library("good"), library);
  CHECK(create("test.good", scratch.path()).text ==
        start + " is a symbolic link; put the library itself beside its manifest");

  fs::remove(library);
  fs::create_directory(library);
  CHECK(create("test.good", scratch.path()).text == start + " is not a regular file");

  fs::remove(library);
  scratch.write("x.so", "not a library, but long enough to hold what an ELF header would hold, were it one.....");
  CHECK(create("test.good", scratch.path()).text == start + " cannot be loaded: invalid ELF header");
}

TEST_CASE("a library of another user is refused") {
  if (geteuid() != 0) return;  // only root can give files away
  Scratch scratch;
  scratch.write("x.plugin.json", manifest("test.good", "x.so"));
  fs::copy(bad_library("good"), scratch.path("x.so"));
  REQUIRE(chown(scratch.path("x.so").c_str(), 4321, 4321) == 0);
  CHECK(create("test.good", scratch.path()).text ==
        "case.json /forces/0: plugin test.good refused: " + scratch.path("x.so") +
            " belongs to user 4321; only libraries owned by root or by the user who runs calx are loaded");
}

TEST_CASE("a library that is not the pinned one, or not the one of its manifest, is refused before it is loaded") {
  const std::string hash = sha256_file(bad_library("good")), other(64, 'a');
  CHECK(create("test.good", bad_folder("good"), {{"test.good", hash}}).text == "no error");
  CHECK(create("test.good", bad_folder("good"), {{"test.good", other}}).text ==
        "case.json /forces/0: plugin test.good refused: " + bad_library("good") + " has SHA-256 " + hash +
            ", but the case pins " + other);

  Scratch scratch;
  scratch.write("trap.plugin.json", manifest("test.trap", "trap.so", ", \"sha256\": \"" + other + "\""));
  fs::copy(bad_library("trap"), scratch.path("trap.so"));
  const fs::path before = fs::current_path();
  fs::current_path(scratch.path());
  const Outcome outcome = create("test.trap", scratch.path());
  fs::current_path(before);
  CHECK(outcome.text == "case.json /forces/0: plugin test.trap refused: " + scratch.path("trap.so") + " has SHA-256 " +
                            sha256_file(bad_library("trap")) + ", but its manifest says " + other);
  CHECK_FALSE(fs::exists(scratch.path("trap-was-executed")));
}

TEST_CASE("a library changed in place after it was loaded is refused") {
  Scratch scratch;
  scratch.write("x.plugin.json", manifest("test.good", "x.so"));
  fs::copy(bad_library("good"), scratch.path("x.so"));
  CHECK(create("test.good", scratch.path()).text == "no error");
  std::ofstream(scratch.path("x.so"), std::ios::app | std::ios::binary) << "x";
  CHECK(create("test.good", scratch.path()).text ==
        "case.json /forces/0: plugin test.good refused: " + scratch.path("x.so") +
            " was changed after this process loaded it; start again");
}

TEST_CASE("a library lying in the working directory is never loaded") {
  Scratch here, plugins;
  here.write("bad_trap.plugin.json", manifest("test.trap", "bad_trap.so"));
  fs::copy(bad_library("trap"), here.path("bad_trap.so"));
  // The manifest in the search folder names a library that lies only in the working directory.
  plugins.write("bad_trap.plugin.json", manifest("test.trap", "bad_trap.so"));
  const fs::path before = fs::current_path();
  fs::current_path(here.path());

  CHECK(create("test.trap", plugins.path()).text ==
        "case.json /forces/0: plugin test.trap refused: bad manifest " + plugins.path("bad_trap.plugin.json") +
            " /library: " + plugins.path("bad_trap.so") + " does not exist");
  CHECK(create("test.trap", "").text ==
        "case.json /forces/0: no plugin test.trap of the kind calx.particle-force/1 "
        "found in no folder; name its folder with --plugin-path");
  CHECK(create("bad_trap.so", plugins.path()).code == 4);
  CHECK_FALSE(fs::exists(here.path("trap-was-executed")));

  // The trap works: named as a search folder on purpose, it is loaded.
  CHECK(create("test.trap", here.path()).text == "no error");
  CHECK(fs::exists(here.path("trap-was-executed")));
  fs::current_path(before);
}
