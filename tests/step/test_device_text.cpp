// The whole text of a step, with every shipped law and force, through NVRTC: what a GPU would run. Needs neither a GPU
// nor a driver.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "compute/cuda_api.hpp"
#include "compute/cuda_compile.hpp"
#include "plugin/plugin.hpp"
#include "sim/laws.hpp"
#include "step/on_device_text.hpp"
#include "support/case.hpp"

using namespace calx;

namespace {

/// Every law of the shipped plugins on a material of its own, and four laws on one contact.
struct Shipped {
  CaseFile file;
  PluginRegistry registry{plugin_search_path({CALX_PLUGIN_DIR}), {}};
  CaseLaws laws;
  InstancePtr drag;
  std::vector<ParticleForce> forces;

  Shipped() {
    const std::string hertz = R"("law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0.4)",
                      linear = R"("law": "calx.linear", "parameters": {"kn": 1e3, "restitution": 0.5, "friction": 0.4)",
                      epam = R"("law": "calx.epam", "parameters": {"restitution": 0.5, "friction": 0.4,
                                "plasticity": 0.5, "surface_energy": 0.1)",
                      roll = R"(, "rolling": "epsd", "rolling_friction": 0.1})", flat = "}";
    std::vector<std::string> entries = {hertz + flat, hertz + roll, linear + flat, linear + roll};
    for (const std::string exponent : {R"(, "exponent": "1")", R"(, "exponent": "1.5")"}) {
      entries.push_back(epam + exponent + flat);
      entries.push_back(epam + exponent + roll);
      entries.push_back(epam + exponent + R"(, "adhesion_exponent": "4.5"})");
    }
    entries.push_back("\"laws\": [{" + entries[1] + "}, {" + entries[3] + "}, {" + entries[5] +
                      R"(, "name": "soft"}, {)" + entries[8] + R"(, "name": "stiff"}])");
    CaseText c;
    c.materials = "{";
    c.contacts = "[";
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const std::string comma = k ? ", " : "", name = "\"m" + std::to_string(k) + "\"";
      c.materials += comma + name + R"(: {"density": 2000, "young": 1e7, "poisson": 0.25})";
      c.contacts += comma + "{\"between\": [" + name + ", " + name + "], " + entries[k] + "}";
    }
    c.materials += "}";
    c.contacts += "]";
    c.more = R"("forces": [{"plugin": "calx.stokes-drag", "parameters": {"viscosity": 1e-3}}])";
    file = c.file();
    laws = load_laws(file.settings, registry);
    const auto& force = file.settings.forces.front();
    drag = registry.create(force.plugin, CALX_PARTICLE_FORCE, force.parameters, "test.json");
    forces.push_back(
        {static_cast<const calx_particle_force*>(drag->table(CALX_PARTICLE_FORCE)), drag->get(), force.plugin});
  }
};

}  // namespace

TEST_CASE("NVRTC compiles the whole step with every shipped law without a spill") {
  try {
    nvrtc();
  } catch (const Error& error) {
    MESSAGE("skipped: " << error.what());
    return;
  }
  const Shipped shipped;
  const LawProgram laws = law_program(shipped.laws.matrix);
  for (const char* law : {"hertz_mindlin", "hertz_mindlin_rolling", "linear_spring", "linear_spring_rolling", "epam_n1",
                          "epam_n15", "epam_n1_rolling", "epam_n15_rolling", "epam_n1_chi", "epam_n15_chi"})
    CHECK(laws.text.find(std::string("CALX_ONE_LAW(") + law + ",") != std::string::npos);
  DeviceCache cache(CALX_TEST_CACHE);
  const ModuleText step = step_text(laws, force_program(shipped.forces), true, false);
  for (const std::string architecture : {"sm_80", "sm_86", "sm_90"})
    for (const ModuleText& text : {step, list_text()}) {
      const CudaBinary binary = compile_cuda(text, architecture, "none", cache);
      CHECK(binary.image.size() > 1000);
      CHECK(binary.resources.size() > 15);
      for (const auto& [name, used] : binary.resources) {
        CAPTURE(architecture);
        CAPTURE(name);
        INFO("registers " << used.registers << ", stack " << used.stack_bytes);
        CHECK(used.spill_bytes == 0);
        CHECK(used.registers > 0);
        // The minima of a surface are a list that its kernel searches and sorts; they are the only stack.
        if (name != "find_wall_contacts") CHECK(used.stack_bytes == 0);
      }
    }
}
