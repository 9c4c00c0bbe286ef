// my_plugin.cpp: the law my_plugin.law.h as the plugin org.example.my-plugin.
#include <calx/plugin.hpp>
#include <cmath>
#include <cstring>

// The text is compiled in single and in double precision; CALX_LAW_BATCH makes a loop over contacts of it.
#define CALX_BITS 32
#include <calx/law/prelude.h>
#include "my_plugin.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(my_plugin)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include "my_plugin.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(my_plugin)
CALX_LAW_TABLES(my_plugin)

namespace {

const char source[] = {
#include "my_plugin.law.h.inc"
};
const char sha256[] =
#include "my_plugin.law.h.sha256.inc"
    ;

class MyPlugin : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host*, const calx_config&) {
    std::memset(&table_, 0, sizeof table_);
    CALX_LAW_FILL(table_, my_plugin);
    table_.flags = CALX_LAW_EXACT;  // only + - * /, square root and comparisons: same bits on every device
    // What the user gives for a pair of materials is what the law reads. To compute the pair row from other values and
    // from properties of the materials, set material, given and derive; share/calx/examples/third_party_law shows it.
    table_.given = table_.pair;
    table_.given_count = table_.pair_count;
    table_.stable_dt = &stable_dt;
    table_.source = source;
    table_.source_size = sizeof source - 1;
    table_.source_sha256 = sha256;
  }

  const void* get_interface(const char* id) const override {
    return std::strcmp(id, CALX_CONTACT_LAW) == 0 ? &table_ : nullptr;
  }

 private:
  // A tenth of the period of mass and spring, 2 pi sqrt(m / k).
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double, double) noexcept {
    my_plugin_pair_f64 row;
    std::memcpy(&row, pair, offsetof(my_plugin_pair_f64, calx_unused));
    return 0.2 * 3.14159265358979324 * std::sqrt(m_eff / std::fmax(row.kn, row.kt));
  }

  calx_contact_law table_;
};

const calx_descriptor MyPlugin::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "org.example.my-plugin",
                                              CALX_CONTACT_LAW,
                                              "my-plugin",
                                              "0.1.0",
                                              "Example",
                                              "MIT",
                                              "Linear spring and dashpot with Coulomb friction.",
                                              nullptr,
                                              nullptr,
                                              0,
                                              0,
                                              nullptr};

}  // namespace

CALX_PLUGIN(MyPlugin)
