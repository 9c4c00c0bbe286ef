// The example law of examples/third_party_law through the engine's view of a contact law: tables, derived rows,
// numbers.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "plugin/contact_law.hpp"
#include "scratch.hpp"

using namespace calx;

namespace {

/// Where spring.so lies: the build tree, or the folder plugin_third_party built outside of it.
std::vector<std::string> folders() {
  const char* given = std::getenv("CALX_SPRING_DIR");
  return {given ? given : CALX_TEST_PLUGIN_DIR};
}

LawSettings settings(const std::string& json) {
  LawSettings out;
  out.law = out.name = "org.example.spring";
  out.parameters.json = json;
  out.parameters.pointer = "/contacts/0/parameters";
  return out;
}

ContactLawEntry spring(PluginRegistry& registry, const std::string& json = "{}") {
  return create_contact_law(registry, settings(json), "case.json");
}

/// One contact, normal along x.
struct Contact {
  double overlap = 0, vx = 0, vy = 0, dt = 1e-5;
  double state[3] = {0, 0, 0};
  double out[10] = {};
  void eval(const ContactLaw& law, const std::vector<double>& pair, bool ledger = false) {
    const double one = 1, zero = 0;
    const double* in[7] = {&overlap, &one, &zero, &zero, &vx, &vy, &zero};
    calx_block_f64 block{};
    block.struct_size = sizeof block;
    block.count = 1;
    block.stride = 1;
    block.dt = dt;
    for (int k = 0; k < 7; ++k) block.in[k] = in[k];
    for (int k = 0; k < (ledger ? 10 : 6); ++k) block.out[k] = &out[k];
    block.pair = pair.data();
    block.state = state;
    law.eval(block);
  }
};

}  // namespace

TEST_CASE("given values come in table order, presets fill in and are told") {
  PluginRegistry registry(folders());
  const ContactLawEntry entry = spring(registry, "{\"kn\": 2e4, \"mu\": 0.3}");
  CHECK(entry.given == std::vector<double>{2e4, 0.1, 8e3, 0.3});
  CHECK(entry.presets_used == std::vector<std::string>{"gn", "kt"});
}

TEST_CASE("a key that is neither option nor pair value is an error") {
  PluginRegistry registry(folders());
  try {
    spring(registry, "{\"kn\": 2e4, \"mus\": 0.3}");
    FAIL("accepted");
  } catch (const Error& e) {
    CHECK(e.exit_code() == 3);
    CHECK(std::string(e.what()).find("case.json /contacts/0/parameters/mus: unknown key") == 0);
  }
}

TEST_CASE("the tables tell what the engine must gather and keep") {
  PluginRegistry registry(folders());
  const ContactLaw law = spring(registry).law;
  CHECK(law.id() == "org.example.spring");
  CHECK(law.version() == "1.0.0");
  CHECK(law.material().count == 1);
  CHECK(std::string(law.material().fields[0].name) == "moisture");
  CHECK(law.pair().count == 4);
  CHECK(law.prop().count == 0);
  CHECK(law.options().count == 0);
  CHECK(law.reads(CALX_IN_OVERLAP));
  CHECK(law.reads(CALX_IN_VZ));
  CHECK_FALSE(law.reads(CALX_IN_WX));
  CHECK(law.is_exact());
  CHECK_FALSE(law.is_active());
  CHECK(law.new_history() == std::vector<double>{0, 0, 0});
  for (std::uint32_t k = 0; k < 3; ++k) {
    CHECK(law.is_odd(k));
    CHECK_FALSE(law.keeps_apart(k));
    CHECK(law.vector_group(k) == 1);
  }
}

TEST_CASE("the pair row is derived from both materials") {
  PluginRegistry registry(folders());
  const ContactLawEntry e = spring(registry, "{\"gn\": 0.25}");
  const std::vector<double> pair = e.law.derive({0.5}, {1.0}, e.given, "case.json", "/contacts/0");
  CHECK(pair == std::vector<double>{1e4, 0.4375, 8e3, 0.5});  // 0.25 (1 + (0.5 + 1) / 2)
  CHECK(message_of([&] {
          e.law.derive({0.5}, {1.0}, {1e4, 0.1, 2e4, 0.5}, "case.json", "/contacts/0");
        }) == "case.json /contacts/0: org.example.spring 1.0.0: kt is above kn; a contact is not stiffer sideways");
  CHECK(
      message_of([&] {
        e.law.derive({std::numeric_limits<double>::infinity()}, {0.0}, e.given, "case.json", "/contacts/0");
      }) ==
      "case.json /contacts/0: org.example.spring 1.0.0 derives a value of \"gn\" (normal damping, raised by moisture) "
      "that is not finite; look at the material and contact parameters");
  CHECK(message_of([&] { e.law.derive({}, {0.0}, e.given, "case.json", "/contacts/0"); }) ==
        "case.json /contacts/0: org.example.spring 1.0.0: rows of another length than its tables");
}

TEST_CASE("stable step and reach") {
  PluginRegistry registry(folders());
  const ContactLaw law = spring(registry).law;
  // A tenth of 2 pi sqrt(m / k) = 2 pi 1e-4 s for 1e-4 kg and 1e4 N/m.
  CHECK(law.stable_dt({1e4, 0.1, 8e3, 0.5}, 1e-4, 1e-3, 1e-5) == doctest::Approx(6.283185307179586e-5).epsilon(1e-14));
  CHECK(std::isinf(law.stable_dt({0, 0.1, 0, 0.5}, 1e-4, 1e-3, 1e-5)));
  CHECK(message_of([&] {
          law.stable_dt({1e4, 0.1, 8e3, 0.5}, 0.0, 1e-3, 1e-5);
        }) == "org.example.spring 1.0.0: its stable step is 0.000000 s; above 0 is needed");
  CHECK_FALSE(law.acts_apart());
  CHECK(law.reach({1e4, 0.1, 8e3, 0.5}, 1e-3, 1e-3) == 0);
}

TEST_CASE("normal force is k d - g v and never pulls") {
  PluginRegistry registry(folders());
  const ContactLaw law = spring(registry).law;
  const std::vector<double> pair = {1e4, 0.1, 8e3, 0.5};
  Contact c;
  c.overlap = 2e-5;
  c.vx = -0.5;
  c.eval(law, pair);
  CHECK(c.out[CALX_OUT_FX] == doctest::Approx(0.2 + 0.05).epsilon(1e-14));
  CHECK(c.out[CALX_OUT_FY] == 0);
  c.vx = 3;  // parting fast: the dashpot alone would pull with 0.1 N
  c.eval(law, pair);
  CHECK(c.out[CALX_OUT_FX] == 0);
}

TEST_CASE("the slider holds up to mu N, and the energies balance the work done") {
  PluginRegistry registry(folders());
  const ContactLaw law = spring(registry).law;
  const std::vector<double> pair = {1e4, 0.1, 8e3, 0.5};
  Contact c;
  c.overlap = 2e-5;  // 0.2 N, so at most 0.1 N sideways: a spring of 1.25e-5 m
  c.vy = 1.0;
  c.eval(law, pair, true);
  CHECK(c.out[CALX_OUT_FY] == doctest::Approx(-8e3 * 1e-5).epsilon(1e-14));
  CHECK(c.out[CALX_OUT_FRICTION] == 0);
  c.eval(law, pair, true);
  CHECK(c.out[CALX_OUT_FY] == doctest::Approx(-0.1).epsilon(1e-14));
  CHECK(c.state[1] == doctest::Approx(1.25e-5).epsilon(1e-14));
  // The slider moved 2e-5 - 1.25e-5 m against 0.1 N.
  CHECK(c.out[CALX_OUT_FRICTION] == doctest::Approx(0.1 * 0.75e-5).epsilon(1e-12));
  CHECK(c.out[CALX_OUT_ELASTIC] == doctest::Approx(0.5 * (1e4 * 4e-10 + 8e3 * 1.5625e-10)).epsilon(1e-12));
}

TEST_CASE("laws that read one material property in two units cannot share a case") {
  PluginRegistry registry(folders());
  const ContactLaw law = spring(registry).law;
  CHECK(message_of([&] { check_material_units({&law, &law}); }) == "no error");
  PluginRegistry others({bad_folder("other_unit")});
  const ContactLaw other(others.create_with_values("test.other-unit", CALX_CONTACT_LAW, "", "", {}));
  CHECK(message_of([&] {
          check_material_units({&law, &other});
        }) ==
        "material property \"moisture\": org.example.spring 1.0.0 reads it in 1, test.other-unit 1.0.0 in kg/m^3; the "
        "two cannot be used in one case");
}

TEST_CASE("another kind is no contact law") {
  PluginRegistry registry({bad_folder("good")});
  const InstancePtr force = registry.create_with_values("test.good", CALX_PARTICLE_FORCE, "", "", {});
  CHECK(message_of([&] { ContactLaw law(force); }) ==
        "test.good 1.0.0 is of the kind calx.particle-force/1, but calx.contact-law/1 is wanted here");
}
