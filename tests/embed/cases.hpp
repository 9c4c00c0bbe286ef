// cases.hpp: small cases as text for the tests of the library.
#pragma once
#include <calx/embed.hpp>
#include <string>

/// Grains of 3 mm that fall into a box, or what `parts` puts there; `more`: further keys, each after a comma.
inline std::string falling_grains(int count, const std::string& parts = "", const std::string& more = "") {
  return R"({"calx": 1, "domain": {"min": [-0.05, -0.05, -0.02], "max": [0.05, 0.05, 0.2]},
    "time": {"end": 0.3},
    "materials": {"grain": {"density": 2500, "young": 5e6, "poisson": 0.25}},
    "contacts": [{"between": ["grain", "grain"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.4, "friction": 0.4}}],
    "shapes": {"grain": {"sphere": {"radius": 0.0015}}},
    "sources": [{"name": "powder", "shape": "grain", "material": "grain", "count": )" +
         std::to_string(count) + R"(, "region": {"box": {"min": [-0.01, -0.01, 0.002], "max": [0.01, 0.01, 0.06]}}}],
    "parts": [)" +
         (parts.empty() ? R"({"name": "floor", "geometry": "calx.box", "material": "grain",
                             "parameters": {"min": [-0.04, -0.04, 0], "max": [0.04, 0.04, 0.15], "open_top": "yes"}})"
                        : parts) +
         "]" + more + "}";
}

inline calx::embed::Options with_plugins(int threads = 1) {
  calx::embed::Options o;
  o.threads = threads;
  o.plugin_path = CALX_PLUGIN_DIR;
  return o;
}
