// check.cpp: what a run of a case would be, without the run.
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "sim/run.hpp"
#include "sim/source.hpp"
#include "sim/wall_clock.hpp"
#include "sim/whole_case.hpp"

namespace calx {

using Json = nlohmann::json;

namespace {

double least_refused(const std::vector<StepLimit>& limits) {
  double least = limits.front().refused_above;
  for (const auto& l : limits) least = std::min(least, l.refused_above);
  return least;
}

}  // namespace

std::string check_case(const RunOptions& options) {
  Simulation sim(read_whole_case(options), options.simulation);
  const CaseSettings& c = sim.settings();
  // The first step places what is there at the start, and finds what overlaps or does not fit.
  if (c.time.end > 0) sim.step();
  std::string out;
  auto line = [&](const std::string& text) { out += text + "\n"; };
  line(c.title.empty() ? c.file : c.title);
  line("");
  const auto limits = sim.step_limits();
  const auto binding = std::find_if(limits.begin(), limits.end(), [](const StepLimit& l) { return l.binds; });
  std::string given = c.time.step > 0 ? " (given)" : "";
  if (c.time.step > 0 && binding != limits.end() && c.time.step > binding->seconds)
    given = " (given, above the advised " + brief_quantity(binding->seconds, "s") + "; refused above " +
            brief_quantity(least_refused(limits), "s") + ")";
  line("Time step " + brief_quantity(sim.time_step(), "s") + given + "; limits:");
  for (const auto& l : limits)
    line("  " + std::string(l.binds ? "* " : "  ") + l.name +
         std::string(l.name.size() < 9 ? 9 - l.name.size() : 0, ' ') + brief_quantity(l.seconds, "s") + "  " + l.where +
         (l.binds ? "  <- binds" : ""));
  if (c.scale.factor != 1) {
    line("Scale: grains " + format_number(c.scale.factor) +
         " times as large; kept: density, moduli, restitution, friction, " +
         (c.scale.cohesion == ScaleSettings::Cohesion::strength ? "strength of the bulk" : "Bond number of a grain") +
         (c.time.step > 0 ? "; the given time step is " + format_number(c.scale.factor) + " times that of the case"
                          : ""));
    for (const auto& s : c.shapes) {
      double radius = 0;
      for (const auto& sphere : s.spheres) radius = std::max(radius, sphere.radius);
      line("  " + s.name + ": largest sphere " + brief_quantity(radius / c.scale.factor, "m") + " -> " +
           brief_quantity(radius, "m") + " in radius");
    }
    for (const auto& text : sim.scaled()) line("  " + text);
  }
  double mass = 0, particles = 0, spheres = 0;
  const auto& shapes = sim.world().particles().shapes;
  for (const auto& s : c.sources) {
    std::size_t members = 1;
    double volume = 0, density = 0;
    for (const auto& shape : shapes)
      if (shape.name == s.shape) members = shape.members.size(), volume = shape.volume;
    for (const auto& m : c.materials)
      if (m.name == s.material) density = m.density;
    const double each = density * volume * std::pow(s.size.kind == SizeSettings::Kind::fixed ? s.size.scale : 1.0, 3);
    double n = s.count > 0  ? static_cast<double>(s.count)
               : s.mass > 0 ? s.mass / each
                            : static_cast<double>(s.positions.size());
    double delivered = n * each;
    if (!s.file.empty()) {
      // Rows bring sizes of their own.
      const std::vector<Seed> rows = read_seeds(s.file);
      n = static_cast<double>(rows.size());
      delivered = 0;
      for (const Seed& row : rows) delivered += density * volume * row.scale * row.scale * row.scale;
    }
    const bool is_given = !s.file.empty() || !s.positions.empty();
    mass += delivered;
    particles += n;
    spheres += n * static_cast<double>(members);
    line("Source \"" + s.name + "\": " + brief_quantity(delivered, "kg") + (is_given ? ", " : ", about ") +
         format_number(std::round(n)) + " particles of \"" + s.shape + "\"");
  }
  const double steps = c.time.end / sim.time_step(), work = steps * spheres;
  // Measured on two cores of a server of 2024 with Hertz-Mindlin and EpAM; an order of magnitude for other machines.
  constexpr double kSphereStepsPerCore = 5e6;
  const int threads = options.simulation.threads > 0 ? options.simulation.threads : omp_get_max_threads();
  const std::string cores = std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  line("Size: " + brief_quantity(mass, "kg") + ", " + format_number(std::round(particles)) + " particles, " +
       format_number(std::round(spheres)) + " spheres, " + format_number(std::round(steps)) + " steps, " +
       brief_quantity(particles * steps, "1") + " particle-steps");
  const double megabytes = std::round(spheres * 600 / 1e6), cost = work / (kSphereStepsPerCore * threads);
  line("Memory: " + (megabytes < 1 ? "below 1" : "about " + brief_quantity(megabytes, "1")) + " MB");
  line("Cost: " + (cost < 1 ? "below 1 s" : "about " + clock_text(cost)) + " on " + cores + " at " +
       format_number(kSphereStepsPerCore * threads / 1e6) + " M sphere-steps/s (estimate)");
  line("Device: " + sim.device() + "; " + (options.simulation.mixed ? "mixed" : "double") + " precision, " +
       (sim.fast() ? "fast" : "exact") + " arithmetic, " + cores);
  line("Materials (SI units):");
  for (const auto& m : c.materials) {
    std::string text;
    const Json properties = Json::parse(m.properties.json);
    for (const auto& item : properties.items())
      text += (text.empty() ? " " : ", ") + item.key() + " " +
              (item.value().is_number() ? brief_quantity(item.value().get<double>(), "1") : item.value().dump());
    line("  " + m.name + ":" + text);
  }
  line("Contacts:");
  for (const auto& contact : c.contacts)
    for (const auto& law : contact.laws) line("  " + contact.between[0] + "-" + contact.between[1] + ": " + law.law);
  if (!sim.presets().empty()) line("Left to presets:");
  for (const auto& p : sim.presets()) line("  " + p);
  line("Parts:");
  for (std::size_t k = 0; k < c.parts.size(); ++k) {
    const auto faults = sim.world().part_surface(k).faults().describe();
    line("  " + c.parts[k].name + ": " + c.parts[k].geometry + ", " +
         std::to_string(sim.world().part_surface(k).element_count()) + " surface elements" +
         (c.parts[k].motion.empty() ? "" : ", moved by \"" + c.parts[k].motion + "\"") +
         (faults.empty() ? "" : " (" + faults + ")"));
  }
  line("Plugins:");
  for (const auto& p : sim.provenance())
    line("  " + p.id + " " + p.version + "  sha256 " + p.sha256.substr(0, 12) + "  " + p.path);
  if (!c.assumptions.empty()) line("Assumptions:");
  for (const auto& a : c.assumptions) line("  - " + a);
  return out;
}

}  // namespace calx
