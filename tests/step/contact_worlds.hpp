// contact_worlds.hpp: contacts with closed forms, side by side in three small worlds: pairs of spheres without gravity,
// spheres on a floor, and clumps. Each contact has a material of its own, so that laws and parameters differ. Shared by
// the tests of every precision, instruction set and device.
#pragma once
#include <cmath>

#include "support/case.hpp"

namespace calx::contact_worlds {

constexpr double kPi = 3.14159265358979323846, kRadius = 1e-3, kDensity = 2000;
constexpr double kMass = kDensity * 4 / 3 * kPi * kRadius * kRadius * kRadius;

/// A material of one contact: what it touches, and its laws without braces.
struct Material {
  const char* name;
  const char* other;
  std::string laws;
};
inline std::vector<Material> materials();

/// A world of some of the materials. All worlds give all laws, so that devices compile one text for the three.
struct World {
  CaseText text;
  std::string shape = "ball";
  std::vector<SourceSettings> sources;
  void add(const std::string& material, const std::vector<Given>& particles) {
    sources.push_back(given_source(shape, particles, material));
  }
  CaseFile file() {
    const std::string properties = R"(": {"density": 2000, "young": 1e7, "poisson": 0.25})";
    text.materials = "{\"floor" + properties;
    text.contacts.clear();
    for (const Material& m : materials()) {
      text.materials += ", \"" + std::string(m.name) + properties;
      text.contacts += std::string(text.contacts.empty() ? "[" : ", ") + "{\"between\": [\"" + m.name + "\", \"" +
                       m.other + "\"], " + m.laws + "}";
    }
    text.materials += "}";
    text.contacts += "]";
    CaseFile out = text.file();
    out.settings.sources = sources;
    return out;
  }
};

inline std::string linear(const std::string& more, double kn = 4000, const std::string& name = "") {
  return R"("law": "calx.linear")" + (name.empty() ? "" : ", \"name\": \"" + name + "\"") +
         ", \"parameters\": {\"kn\": " + std::to_string(kn) + ", " + more + "}";
}

/// Two spheres that meet at `place`: v of the first along the line of centres n, and u across it; the second has the
/// opposite. gap: between them, m.
inline std::vector<Given> meeting(const Vec3& place, const Vec3& n, double v, const Vec3& u = {}, const Vec3& w = {},
                                  double gap = 2e-6) {
  const Vec3 half = (kRadius + 0.5 * gap) * n;
  return {{place - half, v * n + u, w, {}}, {place + half, -(v * n + u), -w, {}}};
}

// Pairs. 4000 N/m between two spheres: contact time 1.02e-4 s, 200 steps.
constexpr double kPairStep = 5e-7;
constexpr int kPairSteps = 1200;
/// Speed below which a plastic, pulling pair sticks, m/s: calx.epam with exponent 1, lambda = 1/2, no dashpot, k1 and a
/// pull f0. Loading to d with 1/2 k1 d^2 = f0 d + 1/2 m* v^2, unloading along 2 k1 to d/2, then against f0 alone: what
/// is left, 1/4 k1 d^2 - f0 d, is zero for d = 4 f0 / k1, which is v^2 = 8 f0^2 / (k1 m*).
constexpr double kPull = 4e-3, kStiffness = 4000;
inline double sticking_speed() { return kPull * std::sqrt(8 / (kStiffness * 0.5 * kMass)); }
/// Relative speed after an impact above it, m/s.
inline double freed_speed(double v) {
  const double m = 0.5 * kMass, d = (kPull + std::sqrt(kPull * kPull + kStiffness * m * v * v)) / kStiffness;
  return std::sqrt(2 * (0.25 * kStiffness * d * d - kPull * d) / m);
}

enum Pair { pair_linear, pair_hertz, pair_sliding, pair_rolling, pair_plastic, pair_sticking, pair_freed, pair_laws };

inline std::vector<Material> materials() {
  const std::string epam = R"("law": "calx.epam", "parameters": {"exponent": "1", "dashpot": "always", "k1": 4000,
    "restitution": 1, "friction": 0, "plasticity": 0.5)";
  const std::string rough = R"("restitution": 0.5, "friction": 0.3)";
  // Two springs, damped by the dashpot of the first: zeta = c / (2 sqrt(k m*)) of both is that of restitution 1/2.
  const double beta = std::log(2.0) / std::sqrt(kPi * kPi + std::log(2.0) * std::log(2.0));
  const double c = 2 * beta * std::sqrt(4000 * 0.5 * kMass);
  return {
      {"linear", "linear", linear(R"("restitution": 0.5, "friction": 0)")},
      {"hertz", "hertz", R"("law": "calx.hertz-mindlin", "parameters": {"restitution": 0.7, "friction": 0})"},
      {"sliding", "sliding", linear(R"("restitution": 1, "friction": 0.1, "tangential_damping": 0)")},
      {"rolling", "rolling", linear(R"("restitution": 1, "friction": 0, "rolling": "a", "rolling_friction": 0.2)")},
      {"plastic", "plastic", epam + "}"},
      {"pulling", "pulling", epam + R"(, "pull_off": 4e-3})"},
      {"twofold", "twofold",
       "\"laws\": [{" + linear("\"restitution\": 1, \"friction\": 0, \"damping\": " + std::to_string(c), 1000, "a") +
           "}, {" + linear(R"("restitution": 1, "friction": 0)", 3000, "b") + "}]"},
      {"rough", "floor", linear(rough, 1000)},
      {"braked", "floor", linear(rough + R"(, "rolling": "a", "rolling_friction": 0.1)", 1000)},
      {"bouncing", "floor", R"("law": "calx.hertz-mindlin", "parameters": {"restitution": 0.6, "friction": 0.3})"},
      {"upright", "floor", linear(R"("restitution": 0.5, "friction": 0)")},
      {"slanted", "floor", linear(R"("restitution": 1, "friction": 0)", 40000)},
  };
}

inline CaseFile pairs() {
  World w;
  w.text.time = R"({"step": 5e-7, "end": 10})";
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, slanted = normalized(Vec3{1, -2, 0.5});
  w.add("linear", meeting({0, 0, 0}, slanted, 0.05));
  w.add("hertz", meeting({0.01, 0, 0}, slanted, 0.05));
  w.add("sliding", meeting({0.02, 0, 0}, x, 0.01, 0.01 * y));
  w.add("rolling", meeting({0.03, 0, 0}, x, 0.025, {}, 50.0 * y));
  w.add("plastic", meeting({0.04, 0, 0}, slanted, 0.05));
  w.add("pulling", meeting({0.05, 0, 0}, slanted, 0.475 * sticking_speed()));
  w.add("pulling", meeting({0.06, 0, 0}, slanted, 0.6 * sticking_speed()));
  w.add("twofold", meeting({0.07, 0, 0}, slanted, 0.05));
  return w.file();
}

inline const char* const kFloor = R"([{"name": "floor", "geometry": "calx.plane", "material": "floor",
                                       "parameters": {"point": [0, 0, 0], "half_u": 0.5, "half_v": 0.5}}])";

// On a floor with gravity; 1000 N/m: contact time 2.9e-4 s, 57 steps.
constexpr double kFloorStep = 5e-6, kGravity = 9.81, kFriction = 0.3, kRollingFriction = 0.1;
constexpr int kFloorSteps = 2400;

enum OnFloor { floor_sliding, floor_spinning, floor_rolling, floor_bouncing };

inline CaseFile on_floor() {
  World w;
  w.text.time = R"({"step": 5e-6, "end": 10})";
  w.text.gravity = "[0, 0, -9.81]";
  w.text.parts = kFloor;
  const double rest = kRadius - kMass * kGravity / 1000;
  w.add("rough", {{{0, 0, rest}, {0.1, 0, 0}, {}, {}}});
  w.add("rough", {{{0, 0.01, rest}, {}, {0, 100, 0}, {}}});
  w.add("braked", {{{0, 0.02, rest}, {0.05, 0, 0}, {0, 0.05 / kRadius, 0}, {}}});
  w.add("bouncing", {{{0, 0.03, kRadius + 1e-5}, {0, 0, -1}, {}, {}}});
  return w.file();
}

// Clumps without gravity: a grain upright and one slanted by 45 degrees on a floor, two grains that meet end to end.
constexpr double kClumpStep = 1e-6;
constexpr int kClumpSteps = 800;

enum Clump { clump_upright, clump_slanted, clump_pair };

inline CaseFile clumps() {
  World w;
  w.shape = "grain";
  w.text.time = R"({"step": 1e-6, "end": 10})";
  w.text.parts = kFloor;
  const double end = 3e-4 + kRadius;  // from the middle of a grain to its end
  w.add("upright", {{{0, 0, end + 1e-6}, {0, 0, -0.05}, {}, {}}});
  // Turned about y: its lower sphere touches off the line through the centre of mass.
  const Quat turn = normalized(Quat{std::cos(kPi / 8), 0, std::sin(kPi / 8), 0});
  w.add("slanted", {{{0.01, 0, 3e-4 * std::sqrt(0.5) + kRadius + 1e-6}, {0, 0, -0.01}, {}, turn}});
  w.add("linear",
        {{{0.02, 0, 0.01 - end - 1e-6}, {0, 0, 0.05}, {}, {}}, {{0.02, 0, 0.01 + end + 1e-6}, {0, 0, -0.05}, {}, {}}});
  return w.file();
}

}  // namespace calx::contact_worlds
