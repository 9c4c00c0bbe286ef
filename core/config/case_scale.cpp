// Key "scale": grains larger than the case draws them. Sizes, counts and times follow here, law parameters where the
// laws' tables are known (sim/laws.cpp). The resolved case keeps the key and the unscaled values, so it runs to the
// same bits.
#include <cmath>

#include "base/units.hpp"
#include "config/case_reader.hpp"
#include "config/scale.hpp"

namespace calx {
namespace {

void scale_energies(ConditionSettings& condition, double by) {
  condition.kinetic_per_particle *= by;
  for (ConditionSettings& part : condition.parts) scale_energies(part, by);
}

}  // namespace

double scale_factor(const ScaleSettings& scale, const std::string& unit) {
  const Unit u = parse_unit(unit);
  double power = 3 * u.exponent[0] + u.exponent[1] + u.exponent[2];
  const bool is_cohesive = unit == "J/m^2" || same_dimension(u, parse_unit("N"));
  if (scale.cohesion == ScaleSettings::Cohesion::bond && is_cohesive) power += 1;
  double out = 1;
  if (power == std::floor(power) && std::abs(power) < 10)  // products: the same bits everywhere
    for (int k = 0; k < std::abs(static_cast<int>(power)); ++k) out *= scale.factor;
  else
    return std::pow(scale.factor, power);
  return power < 0 ? 1 / out : out;
}

// Last of all sections: it changes what the others have read.
void CaseReader::read_scale(Object& root) {
  ScaleSettings& s = case_.scale;
  if (!root.has("scale")) return;
  Object o = root.section("scale", "particle scaling");
  const Node factor = o.need("factor", "how many times larger the grains are, such as 2");
  s.factor = factor.number("1", Allow::above_zero);
  if (!(s.factor >= 0.01 && s.factor <= 100))
    factor.fail(format_number(s.factor) + " is out of range; must be from 0.01 to 100");
  s.cohesion = o.choice("cohesion", "a way to scale cohesion", {"strength", "bond"}, 0) == 0
                   ? ScaleSettings::Cohesion::strength
                   : ScaleSettings::Cohesion::bond;
  o.done();
  const double f = s.factor, cube = f * f * f;
  if (f == 1) return;  // exactly 1 leaves every bit as it is
  for (const SourceSettings& source : case_.sources)
    if (!source.positions.empty() || !source.file.empty())
      document_.fail(
          source.pointer + (source.file.empty() ? "/positions" : "/file"),
          "source \"" + source.name +
              "\" gives each grain its place, which grains of another size cannot take; let it fill a region, or "
              "leave \"scale\" out");
  for (ShapeSettings& shape : case_.shapes)
    for (SphereSettings& sphere : shape.spheres) {
      sphere.at = f * sphere.at;
      sphere.radius *= f;
    }
  for (SourceSettings& source : case_.sources)
    if (source.count > 0)
      source.count = static_cast<std::uint64_t>(std::fmax(1, std::round(static_cast<double>(source.count) / cube)));
  case_.time.step *= f;
  case_.neighbour.skin *= f;
  for (EventSettings& event : case_.events) scale_energies(event.when, cube);
  std::string text = "Particle scaling: grains " + format_number(f) +
                     " times the size that the case draws, same density, moduli, restitution and friction; " +
                     (s.cohesion == ScaleSettings::Cohesion::strength
                          ? "cohesion keeps the strength of the bulk (pull-off grows with the square of the size)."
                          : "cohesion keeps the grain's Bond number (pull-off grows with the weight).");
  if (!case_.forces.empty()) text += " Particle forces keep their parameters.";
  case_.assumptions.push_back(text);
}

}  // namespace calx
