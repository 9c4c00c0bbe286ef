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
  bool known() const { return radius < 1e299; }
};

Smallest smallest_of(const StepInputs& in, const std::string& material, double density) {
  Smallest out;
  for (const auto& source : *in.sources) {
    if (source.settings().material != material) continue;
    const double scale = source.smallest_scale();
    const Shape& shape = (*in.shapes)[source.shape_index()];
    for (const auto& m : shape.members) out.radius = std::min(out.radius, scale * m.radius);
    out.mass = std::min(out.mass, density * shape.volume * scale * scale * scale);
  }
  return out;
}

/// Two materials that may touch: their laws and the lightest pair, or the lightest particle and a wall.
struct Touching {
  std::size_t a = 0, b = 0;
  const LawList* list = nullptr;
  bool wall = false;
  double m_eff = 0, r_eff = 0;
};

std::vector<Touching> touching_materials(const StepInputs& in) {
  const auto& materials = in.settings->materials;
  std::vector<Smallest> small;
  for (const auto& m : materials) small.push_back(smallest_of(in, m.name, m.density));
  std::vector<Touching> out;
  for (std::size_t a = 0; a < materials.size(); ++a) {
    if (!small[a].known()) continue;
    for (std::size_t b = 0; b < materials.size(); ++b) {
      const LawList* list = in.laws->matrix[a * materials.size() + b];
      const bool wall = !small[b].known();
      if (!list || (!wall && b < a)) continue;
      const auto both = [](double x, double y) { return x * y / (x + y); };
      out.push_back({a, b, list, wall, wall ? small[a].mass : both(small[a].mass, small[b].mass),
                     wall ? small[a].radius : both(small[a].radius, small[b].radius)});
    }
  }
  return out;
}

/// What the laws of a list state for a contact of that overlap, s; 0 where none states anything. Stiffnesses of terms
/// add up, and so do the inverse squares of their steps.
double law_step(const Touching& t, double overlap) {
  double inverse_square = 0;
  for (const auto& term : t.list->terms) {
    if (!term.table->stable_dt) continue;
    const double dt = term.table->stable_dt(term.pair_row.data(), t.m_eff, t.r_eff, overlap);
    if (dt > 0) inverse_square += 1 / (dt * dt);
  }
  return inverse_square > 0 ? 1 / std::sqrt(inverse_square) : 0;
}

StepLimit law_limit(const Touching& t, double overlap, double seconds) {
  return {"law", t.list->label + " at an overlap of " + brief(overlap) + " m", seconds, 3 * seconds, false};
}

}  // namespace

std::vector<StepLimit> time_step_limits(const StepInputs& in) {
  const CaseSettings& c = *in.settings;
  std::vector<StepLimit> limits;
  double smallest_radius = 1e300;
  for (const auto& m : c.materials) {
    const Smallest small = smallest_of(in, m.name, m.density);
    smallest_radius = std::min(smallest_radius, small.radius);
    const auto e = elastic_of(m, c.file);
    if (!small.known() || !e || !(e->young > 0)) continue;
    const double shear = e->young / (2 * (1 + e->poisson));
    const double rayleigh = kPi * small.radius * std::sqrt(m.density / shear) / (0.1631 * e->poisson + 0.8766);
    const double advised = c.time.rayleigh_fraction * rayleigh;
    limits.push_back({"rayleigh",
                      brief(100 * c.time.rayleigh_fraction) + " % of " + brief(rayleigh) + " s, " + m.name +
                          " sphere of radius " + brief(small.radius) + " m",
                      advised, std::max(advised, 0.5 * rayleigh), false});
  }
  for (const Touching& t : touching_materials(in)) {
    // Overlap of an elastic impact at the largest speed; without moduli a hundredth of the radius.
    double overlap = 0.01 * smallest_of(in, c.materials[t.a].name, c.materials[t.a].density).radius;
    const auto ea = elastic_of(c.materials[t.a], c.file), eb = elastic_of(c.materials[t.b], c.file);
    if (ea && eb && in.particle_speed > 0) {
      const double e_star =
          1 / ((1 - ea->poisson * ea->poisson) / ea->young + (1 - eb->poisson * eb->poisson) / eb->young);
      const double k = 4.0 / 3 * e_star * std::sqrt(t.r_eff), v = in.particle_speed;
      overlap = std::pow(5 * t.m_eff * v * v / (4 * k), 0.4);
      const double collision = 2.87 * std::pow(t.m_eff * t.m_eff / (t.r_eff * e_star * e_star * v), 0.2);
      limits.push_back({"hertz", "1/20 of the collision time at " + brief(v) + " m/s, " + t.list->label, collision / 20,
                        collision / 5, false});
    }
    const double seconds = law_step(t, overlap);
    if (seconds > 0) limits.push_back(law_limit(t, overlap, seconds));
  }
  if (in.wall_speed > 0 && smallest_radius < 1e299)
    limits.push_back(
        {"wall",
         "part \"" + in.fastest_part + "\" at " + brief(in.wall_speed) + " m/s moves 2 % of the smallest radius",
         0.02 * smallest_radius / in.wall_speed, 0.1 * smallest_radius / in.wall_speed, false});
  auto least = std::min_element(limits.begin(), limits.end(),
                                [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; });
  if (least != limits.end()) least->binds = true;
  return limits;
}

StepLimit law_limit_at(const StepInputs& in, double overlap_share) {
  StepLimit least;
  for (const Touching& t : touching_materials(in)) {
    const double overlap = overlap_share * (t.wall ? t.r_eff : 2 * t.r_eff);
    const double seconds = overlap > 0 ? law_step(t, overlap) : 0;
    if (seconds > 0 && (least.seconds == 0 || seconds < least.seconds)) least = law_limit(t, overlap, seconds);
  }
  return least;
}

double choose_step(const StepInputs& in, const std::vector<StepLimit>& limits) {
  const CaseSettings& c = *in.settings;
  if (c.time.step <= 0) {
    for (const auto& limit : limits)
      if (limit.binds) return limit.seconds;
    std::string why;
    for (const Touching& t : touching_materials(in))
      why += (why.empty() ? "" : ", ") + t.list->label + ", whose law states no stable step";
    throw Error(Fault::settings, c.file + " /time: no limit is known for the time step: " +
                                     (why.empty() ? "no source says which particles come"
                                                  : why + " and whose materials have no young and poisson") +
                                     "; give \"step\" in s");
  }
  for (const auto& limit : limits) {
    if (c.time.step > limit.refused_above)
      throw Error(Fault::settings, c.file + " /time/step: " + brief_quantity(c.time.step, "s") +
                                       " is above the limit of " + brief_quantity(limit.refused_above, "s") + " (" +
                                       limit.name + ": " + limit.where + "); at most " +
                                       brief_quantity(limit.seconds, "s") + " is advised, or leave \"step\" out");
  }
  return c.time.step;
}

}  // namespace calx
