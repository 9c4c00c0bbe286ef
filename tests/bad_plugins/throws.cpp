// Two plugins in one library, written with the C++ helper, whose constructors throw.
#include <calx/plugin.hpp>

namespace {

const calx_field gain[] = {{"gain", "1", "strength", 0.0, 10.0, 1.0, 0, 0}};

struct Confused : calx::Instance {
  static const calx_descriptor descriptor;
  Confused(const calx_host*, const calx_config&) { throw std::runtime_error("table of moments is empty"); }
  const void* get_interface(const char*) const override { return nullptr; }
};
const calx_descriptor Confused::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "test.confused",
                                              CALX_PARTICLE_FORCE,
                                              "Confused",
                                              "1.0.0",
                                              "Calx",
                                              "Apache-2.0",
                                              "Fails by a mistake of its own.",
                                              nullptr,
                                              nullptr,
                                              0,
                                              0,
                                              nullptr};

void CALX_CALL eval(const calx_instance*, const calx_particle_block*) {}
const calx_particle_force force = {
    sizeof(calx_particle_force), CALX_ABI_DRAFT, eval, 0, 0, nullptr, nullptr, nullptr, 0, nullptr, nullptr};

struct Strict : calx::Instance {
  static const calx_descriptor descriptor;
  Strict(const calx_host*, const calx_config& config) {
    if (calx::parameter(descriptor, config, "gain") > 2.0) throw calx::ConfigError("gain is above 2; give at most 2");
  }
  const void* get_interface(const char* id) const override {
    return std::strcmp(id, CALX_PARTICLE_FORCE) == 0 ? &force : nullptr;
  }
};
const calx_descriptor Strict::descriptor = {sizeof(calx_descriptor),
                                            0,
                                            "test.strict",
                                            CALX_PARTICLE_FORCE,
                                            "Strict",
                                            "1.0.0",
                                            "Calx",
                                            "Apache-2.0",
                                            "Takes a gain up to 2.",
                                            nullptr,
                                            gain,
                                            1,
                                            0,
                                            nullptr};

}  // namespace

CALX_PLUGIN(Confused, Strict)
