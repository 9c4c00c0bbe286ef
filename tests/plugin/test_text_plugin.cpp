// A plugin that is a law text alone: the numbers of its native twin, refusals, and where it may lie.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "plugin/contact_law.hpp"
#include "plugin/plugin.hpp"
#include "scratch.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

std::string text_manifest(const std::string& id, const std::string& kind, const std::string& more) {
  return "{\"calx_plugin\": 1, \"abi\": {\"major\": 1, \"minor\": 0}, \"version\": \"1.2.0\", "
         "\"vendor\": "
         "\"Me @VERSION@ \\\"x\", \"license\": \"MIT\", \"plugins\": [{\"id\": \"" +
         id + "\", \"kind\": \"" + kind + "\", \"summary\": \"A text.\", " + more + "}]}";
}

std::string spring() { return read_text(CALX_SOURCE_DIR "/examples/third_party_law/spring.law.h"); }

struct Block {
  double in[CALX_IN_COUNT] = {2e-5, 0.6, 0, 0.8, 0.1, -0.2, -0.3, 0, 0, 0, 1e-3, 1e-5, 2e-3, 2e-3, 0},
         out[CALX_OUT_COUNT];
  std::vector<double> evaluate(const ContactLaw& law, const std::vector<double>& pair) {
    std::vector<double> state = law.new_history();
    calx_block_f64 block;
    std::memset(&block, 0, sizeof block);
    block.struct_size = sizeof block;
    block.count = 1;
    block.stride = 1;
    block.dt = 1e-6;
    for (int k = 0; k < CALX_IN_COUNT; ++k) block.in[k] = &in[k];
    for (int k = 0; k < CALX_OUT_COUNT; ++k) block.out[k] = &out[k];
    block.pair = pair.data();
    block.state = state.data();
    for (int k = 0; k < 5; ++k) law.eval(block);
    state.insert(state.end(), out, out + CALX_OUT_COUNT);
    return state;
  }
};

std::string refusal(const std::string& folder, const std::string& id = "org.me.spring",
                    const std::string& kind = CALX_CONTACT_LAW) {
  try {
    PluginRegistry registry({folder});
    registry.create_with_values(id, kind, "case.json", "/contacts/0", {});
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a law that is a text gives the bits of the same text in a library") {
  Scratch scratch;
  scratch.write("spring.law.h", spring());
  scratch.write("spring.plugin.json", text_manifest("org.me.spring", CALX_CONTACT_LAW,
                                                    "\"text\": \"spring.law.h\", \"stiffness\": [\"kn\", \"kt\"]"));
  PluginRegistry texts({scratch.path()}), natives({CALX_TEST_PLUGIN_DIR});
  const ContactLaw text(texts.create_with_values("org.me.spring", CALX_CONTACT_LAW, "", "", {}));
  const ContactLaw native(natives.create_with_values("org.example.spring", CALX_CONTACT_LAW, "", "", {}));
  CHECK(text.version() == "1.2.0");
  REQUIRE(text.given().count == 4);
  CHECK(std::string(text.given().fields[0].name) == "kn");
  CHECK(std::string(text.table().source, text.table().source_size) == spring());
  const std::vector<double> pair = {2e4, 0.3, 1e4, 0.4};
  Block a, b;
  CHECK(a.evaluate(text, pair) == b.evaluate(native, pair));
  CHECK(a.out[CALX_OUT_FX] != 0);
  // A tenth of 2 pi sqrt(m / k) of the stiffer spring.
  CHECK(std::fabs(text.stable_dt(pair, 1e-5, 1e-3, 1e-5) - 0.2 * 3.14159265358979324 * std::sqrt(1e-5 / 2e4)) < 1e-15);
  const auto from = texts.provenance();
  REQUIRE(from.size() == 1);
  CHECK(from[0].sha256 == sha256_file(scratch.path("spring.law.h")));
}

TEST_CASE("columns that limit the step of a text have the units the step is computed with") {
  Scratch scratch;
  std::string text = spring();
  text.replace(text.find("X(kn, \"N/m\""), 11, "X(kn, \"Pa\"");
  scratch.write("spring.law.h", text);
  const auto with = [&](const std::string& keys) {
    scratch.write("spring.plugin.json",
                  text_manifest("org.me.spring", CALX_CONTACT_LAW, "\"text\": \"spring.law.h\", " + keys));
    return refusal(scratch.path());
  };
  CHECK(with("\"stiffness\": [\"kn\"]")
            .find("spring.plugin.json \"stiffness\": column \"kn\" is in Pa, it must be in N/m; "
                  "the modulus of a Hertz law belongs under \"modulus\"") != std::string::npos);
  CHECK(with("\"modulus\": [\"kt\"]").find("\"modulus\": column \"kt\" is in N/m, it must be in Pa") !=
        std::string::npos);
  CHECK(with("\"reach\": [\"mu\"]").find("\"reach\": column \"mu\" is in 1, it must be in m") != std::string::npos);

  // Hertz: k = d(4/3 E sqrt(r) d^1.5)/dd = 2 E sqrt(r d), and the step a tenth of 2 pi sqrt(m / k).
  CHECK(with("\"modulus\": [\"kn\"], \"stiffness\": [\"kt\"]") == "no error");
  PluginRegistry registry({scratch.path()});
  const ContactLaw law(registry.create_with_values("org.me.spring", CALX_CONTACT_LAW, "", "", {}));
  const double k = 1e3 + 2 * 1e7 * std::sqrt(1e-3 * 4e-5);
  CHECK(law.stable_dt({1e7, 0.3, 1e3, 0.4}, 1e-5, 1e-3, 4e-5) ==
        doctest::Approx(0.2 * 3.14159265358979324 * std::sqrt(1e-5 / k)).epsilon(1e-12));
}

TEST_CASE("a law that is a text may reach beyond touch and keep history so far") {
  Scratch scratch;
  scratch.write("golden_law.law.h", read_text(CALX_SOURCE_DIR "/tests/golden/golden_law.law.h"));
  const std::string text = "\"text\": \"golden_law.law.h\"";
  scratch.write("string.plugin.json",
                text_manifest("org.me.string", CALX_CONTACT_LAW, text + ", \"reach\": [\"length\"]"));
  PluginRegistry registry({scratch.path()});
  const ContactLaw law(registry.create_with_values("org.me.string", CALX_CONTACT_LAW, "", "", {}));
  CHECK(law.keeps_apart(0));
  CHECK(law.acts_apart());
  CHECK(law.reach({1e3, 1e-4, 7e-5}, 1e-3, 1e-3) == 7e-5);
  Block block;
  CHECK(block.evaluate(law, {1e3, 1e-3, 7e-5})[0] == 1);
  scratch.write("string.plugin.json", text_manifest("org.me.string", CALX_CONTACT_LAW, text));
  CHECK(refusal(scratch.path(), "org.me.string").find("survives separation, but it has no reach") != std::string::npos);
}

TEST_CASE("a force that is a text takes its row as parameters") {
  Scratch scratch;
  scratch.write("push.law.h",
                "#define push_row_LIST(X) X(gain, \"m/s^2\", 0, 1e9, 2, 0, \"strength\")\nCALX_FORCE_DECLARE(push)\n"
                "CALX_FORCE_EVAL(push) { out->fx = p->gain * b->mass; }\n");
  scratch.write("push.plugin.json", text_manifest("org.me.push", CALX_PARTICLE_FORCE, "\"text\": \"push.law.h\""));
  PluginRegistry registry({scratch.path()});
  const InstancePtr made = registry.create_with_values("org.me.push", CALX_PARTICLE_FORCE, "", "", {3.0});
  double columns[17] = {};
  columns[9] = 0.5;
  calx_particle_block block = {};
  block.struct_size = sizeof block;
  block.count = 1;
  const double** in[] = {&block.x,  &block.y,  &block.z,  &block.vx,   &block.vy,    &block.vz,
                         &block.wx, &block.wy, &block.wz, &block.mass, &block.radius};
  for (int k = 0; k < 11; ++k) *in[k] = &columns[k];
  double** out[] = {&block.fx, &block.fy, &block.fz, &block.mx, &block.my, &block.mz};
  for (int k = 0; k < 6; ++k) *out[k] = &columns[11 + k];
  static_cast<const calx_particle_force*>(made->table(CALX_PARTICLE_FORCE))->eval(made->get(), &block);
  CHECK(columns[11] == 1.5);
}

TEST_CASE("a text that breaks the dialect or does not compile is refused with file and line") {
  Scratch scratch;
  scratch.write("spring.plugin.json", text_manifest("org.me.spring", CALX_CONTACT_LAW, "\"text\": \"spring.law.h\""));
  std::string text = spring();
  text.replace(text.find("out->fx = fn"), 12, "out->fx = system(\"true\") + fn");
  scratch.write("spring.law.h", text);
  CHECK(
      refusal(scratch.path()).find("spring.law.h breaks the dialect of laws: spring.law.h:36: system is no function") !=
      std::string::npos);
  text = spring();
  text.replace(text.find("out->fx = fn"), 12, "out->missing = fn");
  scratch.write("spring.law.h", text);
  const std::string said = refusal(scratch.path());
  CAPTURE(said);
  CHECK(said.find("does not compile") != std::string::npos);
  CHECK(said.find("spring.law.h:36") != std::string::npos);
  scratch.write("spring.plugin.json", text_manifest("org.me.spring", CALX_CONTACT_LAW,
                                                    "\"text\": \"spring.law.h\", \"stiffness\": [\"no_such\"]"));
  scratch.write("spring.law.h", spring());
  CHECK(refusal(scratch.path()).find("no_such") != std::string::npos);
}

TEST_CASE("manifests of texts are checked before anything is compiled") {
  Scratch scratch;
  scratch.write("spring.law.h", spring());
  const auto said = [&](const std::string& kind, const std::string& more) {
    scratch.write("spring.plugin.json", text_manifest("org.me.spring", kind, more));
    return refusal(scratch.path(), "org.me.spring", kind);
  };
  CHECK(said(CALX_MOTION, "\"text\": \"spring.law.h\"").find("needs a library") != std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"spring.h\"").find("does not end in .law.h") != std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"../spring.law.h\"").find("lies outside") != std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"other.law.h\"").find("does not exist") != std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"spring.law.h\", \"symbol\": \"spring(); system\"").find("is not a name") !=
        std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"spring.law.h\", \"stiffness\": [\"kn) + system(0\"]")
            .find("is not the name") != std::string::npos);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"spring.law.h\", \"reach\": [\"Kn\"]")
            .find("/reach: \"Kn\" is not the name of a column") != std::string::npos);
  fs::permissions(scratch.path("spring.law.h"), fs::perms::others_write, fs::perm_options::add);
  CHECK(said(CALX_CONTACT_LAW, "\"text\": \"spring.law.h\"").find("can be changed by every user") != std::string::npos);
}

TEST_CASE("beside a case only texts are found, never a library") {
  Scratch beside;
  beside.write("spring.law.h", spring());
  beside.write("spring.plugin.json", text_manifest("org.me.spring", CALX_CONTACT_LAW, "\"text\": \"spring.law.h\""));
  beside.write("trap.plugin.json", manifest("test.trap", "bad_trap.so"));
  fs::copy(bad_library("trap"), beside.path("bad_trap.so"));
  PluginTrust trust;
  trust.text_folder = beside.path();
  PluginRegistry registry({}, {}, trust);
  CHECK_NOTHROW(registry.create_with_values("org.me.spring", CALX_CONTACT_LAW, "", "", {}));
  CHECK_THROWS_WITH(
      registry.create_with_values("test.trap", CALX_PARTICLE_FORCE, "", "", {}),
      "no plugin test.trap of the kind calx.particle-force/1 found in no folder; name its folder with --plugin-path");
  CHECK_FALSE(fs::exists("trap-was-executed"));
}

TEST_CASE("where pins are required an unpinned plugin is refused, with the line to add") {
  PluginTrust trust;
  trust.pins_required = true;
  const std::string hash = sha256_file(bad_library("good"));
  CHECK_THROWS_WITH(
      PluginRegistry({bad_folder("good")}, {}, trust).create_with_values("test.good", CALX_PARTICLE_FORCE, "", "", {}),
      ("plugin test.good refused: the case does not pin it, and pins are required; add \"plugins\": {\"test.good\": "
       "{\"sha256\": \"" +
       hash + "\"}} to the case if you trust " + bad_library("good"))
          .c_str());
  CHECK_NOTHROW(PluginRegistry({bad_folder("good")}, {{"test.good", hash}}, trust)
                    .create_with_values("test.good", CALX_PARTICLE_FORCE, "", "", {}));
}

TEST_CASE("a plugin that crashes or exits before it is used is refused, and this process lives on") {
  const auto said = [](const std::string& name, const std::string& id) {
    return refusal(bad_folder(name), id, CALX_PARTICLE_FORCE);
  };
  CHECK(said("crashes_in_init", "test.crashes-in-init")
            .find("crashed with SIGSEGV (invalid memory access) when it was "
                  "loaded and initialised") != std::string::npos);
  CHECK(said("crashes_in_create", "test.crashes-in-create").find("when it made an instance") != std::string::npos);
  CHECK(said("exits_in_create", "test.exits-in-create").find("ended the process with exit status 0") !=
        std::string::npos);
  CHECK(said("throws_across", "test.throws-across").find("crashed with SIGABRT") != std::string::npos);
  CHECK(said("needs_host_symbols", "test.needs-host-symbols").find("undefined symbol") != std::string::npos);
}
