// time_step.cpp: Rayleigh, law, Hertz and wall-speed limits.
#include "sim/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

std::string brief(double v) { return brief_quantity(v, "1"); }

constexpr double kPi = 3.14159265358979323846;

struct Elastic {
  double young = 0, poisson = 0;
};

/// young and poisson of a material, when it has them.
std::optional<Elastic> elastic_of(const MaterialSettings& m, const std::string& file) {
  static const calx_field fields[] = {{"young", "Pa", "", 0, 1e300, 0, 0, 0}, {"poisson", "1", "", -1, 0.5, 0, 0, 0}};
  std::vector<std::string> others;
  bool young = false, poisson = false;
  for (const auto& key : parameter_keys(m.properties)) {
    young |= key.first == "young";
    poisson |= key.first == "poisson";
    if (key.first != "young" && key.first != "poisson") others.push_back(key.first);
  }
  if (!young || !poisson) return std::nullopt;
  const auto v = resolve_parameters(m.properties, {{fields, 2}}, nullptr, "time step", file, others).values[0];
  return Elastic{v[0], v[1]};
}

/// Smallest sphere and lightest particle that a source of a material makes.
struct Smallest {
  double radius = 1e300, mass = 1e300;
  std::string source;
};

Smallest smallest_of(const StepInputs& in, const std::string& material, double density) {
  Smallest out;
  for (const auto& source : *in.sources) {
    if (source.settings().material != material) continue;
    const double scale = source.smallest_scale();
    const Shape& shape = (*in.shapes)[source.shape_index()];
    for (const auto& m : shape.members)
      if (scale * m.radius < out.radius) {
        out.radius = scale * m.radius;
        out.source = source.settings().name;
      }
    out.mass = std::min(out.mass, density * shape.volume * scale * scale * scale);
  }
  return out;
}

}  // namespace

std::vector<StepLimit> time_step_limits(const StepInputs& in) {
  const CaseSettings& c = *in.settings;
  std::vector<StepLimit> limits;
  double smallest_radius = 1e300;
  const std::size_t n = c.materials.size();
  for (std::size_t a = 0; a < n; ++a) {
    const auto& ma = c.materials[a];
    const Smallest small = smallest_of(in, ma.name, ma.density);
    if (small.radius > 1e299) continue;
    smallest_radius = std::min(smallest_radius, small.radius);
    const auto ea = elastic_of(ma, c.file);
    if (ea && ea->young > 0) {
      const double shear = ea->young / (2 * (1 + ea->poisson));
      const double rayleigh = kPi * small.radius * std::sqrt(ma.density / shear) / (0.1631 * ea->poisson + 0.8766);
      limits.push_back({"rayleigh",
                        brief(100 * c.time.rayleigh_fraction) + " % of " + brief(rayleigh) + " s, " + ma.name +
                            " sphere of radius " + brief(small.radius) + " m",
                        c.time.rayleigh_fraction * rayleigh, false});
    }
    for (std::size_t b = 0; b < n; ++b) {
      const LawList* list = in.laws->matrix[a * n + b];
      if (!list) continue;
      const Smallest other = smallest_of(in, c.materials[b].name, c.materials[b].density);
      const bool wall = other.radius > 1e299;
      if (!wall && b < a) continue;
      const double m_eff = wall ? small.mass : small.mass * other.mass / (small.mass + other.mass);
      const double r_eff = wall ? small.radius : small.radius * other.radius / (small.radius + other.radius);
      // Overlap of an elastic impact at the largest speed; without moduli a hundredth of the radius.
      double overlap = 0.01 * small.radius;
      const auto eb = elastic_of(c.materials[b], c.file);
      if (ea && eb && in.particle_speed > 0) {
        const double e_star =
            1 / ((1 - ea->poisson * ea->poisson) / ea->young + (1 - eb->poisson * eb->poisson) / eb->young);
        const double k = 4.0 / 3 * e_star * std::sqrt(r_eff), v = in.particle_speed;
        overlap = std::pow(5 * m_eff * v * v / (4 * k), 0.4);
        const double collision = 2.87 * std::pow(m_eff * m_eff / (r_eff * e_star * e_star * v), 0.2);
        limits.push_back(
            {"hertz", "1/20 of the collision time at " + brief(v) + " m/s, " + list->label, collision / 20, false});
      }
      double inverse_square = 0;
      for (const auto& term : list->terms) {
        if (!term.table->stable_dt) continue;
        const double dt = term.table->stable_dt(term.pair_row.data(), m_eff, r_eff, overlap);
        if (dt > 0) inverse_square += 1 / (dt * dt);
      }
      if (inverse_square > 0)
        limits.push_back(
            {"law", list->label + " at an overlap of " + brief(overlap) + " m", 1 / std::sqrt(inverse_square), false});
    }
  }
  if (in.wall_speed > 0 && smallest_radius < 1e299)
    limits.push_back(
        {"wall",
         "part \"" + in.fastest_part + "\" at " + brief(in.wall_speed) + " m/s moves 2 % of the smallest radius",
         0.02 * smallest_radius / in.wall_speed, false});
  auto least = std::min_element(limits.begin(), limits.end(),
                                [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; });
  if (least != limits.end()) least->binds = true;
  return limits;
}

double choose_step(const StepInputs& in, const std::vector<StepLimit>& limits) {
  const CaseSettings& c = *in.settings;
  if (c.time.step <= 0) {
    for (const auto& limit : limits)
      if (limit.binds) return limit.seconds;
    throw Error(Fault::settings, c.file +
                                     " /time: no limit is known for the time step (no source, or a law without a "
                                     "stable step and materials without young and poisson); give \"step\" in s");
  }
  for (const auto& limit : limits) {
    const double most = limit.name == "rayleigh" ? limit.seconds * 0.5 / c.time.rayleigh_fraction
                        : limit.name == "law"    ? 3 * limit.seconds
                        : limit.name == "wall"   ? 5 * limit.seconds
                                                 : 4 * limit.seconds;
    if (c.time.step > most)
      throw Error(Fault::settings, c.file + " /time/step: " + brief_quantity(c.time.step, "s") +
                                       " is above the limit of " + brief_quantity(most, "s") + " (" + limit.name +
                                       ": " + limit.where + "); at most " + brief_quantity(limit.seconds, "s") +
                                       " is advised, or leave \"step\" out");
  }
  return c.time.step;
}

}  // namespace calx
