// summary.cpp: figures of a run as JSON.
#include "sim/summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.hpp"
#include "plugin/tables.hpp"

namespace calx {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json numbers(const std::vector<double>& v) {
  Json out = Json::array();
  for (const double x : v) out.push_back(number(x));
  return out;
}

Json mass_json(const WorldView& world) {
  const MassLedger l = world.mass();
  Json regions = Json::object();
  const Particles& p = world.particles();
  for (const auto& r : world.settings().regions) {
    if (!r.is_named) continue;
    double mass = 0;
    for (const auto& b : p.body)
      if (world.in_region(r.name, position(b))) mass += b.m;
    regions[r.name] = mass;
  }
  return {{"requested", l.requested},
          {"delivered", l.delivered},
          {"inserted", l.inserted},
          {"inside", l.inside},
          {"left", l.removed},
          {"inserted_particles", l.inserted_count},
          {"inside_particles", l.inside_count},
          {"left_particles", l.removed_count},
          {"closes", l.inserted_count == l.inside_count + l.removed_count},
          {"regions", regions}};
}

Json energy_json(const EnergyLedger& e) {
  if (!e.kept) return {{"kept", false}};
  return {{"kept", true},
          {"kinetic_translation", e.kinetic_translation},
          {"kinetic_rotation", e.kinetic_rotation},
          {"gravity", e.gravity},
          {"elastic", e.elastic},
          {"friction", e.friction},
          {"damping", e.damping},
          {"plastic", e.plastic},
          {"wall_work", e.wall_work},
          {"force_work", e.force_work},
          {"inserted", e.inserted},
          {"removed", e.removed},
          {"remainder", e.remainder},
          {"work_done", e.work_done},
          {"remainder_share", e.work_done > 0 ? std::fabs(e.remainder) / e.work_done : 0.0}};
}

}  // namespace

std::string summary_json(Simulation& s, const RunFacts& facts) {
  const WorldView& world = s.world();
  const CaseSettings& c = s.settings();
  const auto counters = s.counters();
  Json j;
  j["title"] = c.title;
  j["status"] = facts.status;
  if (!facts.reason.empty()) j["reason"] = facts.reason;
  j["time"] = s.time();
  j["end"] = c.time.end;
  j["steps"] = s.step_count();
  j["time_step"] = s.time_step();
  j["integrator"] = c.time.integrator == TimeSettings::Integrator::verlet ? "verlet" : "euler";
  for (const auto& l : s.step_limits())
    j["step_limits"].push_back({{"name", l.name},
                                {"where", l.where},
                                {"seconds", l.seconds},
                                {"refused_above", l.refused_above},
                                {"binds", l.binds}});
  const StepLimit seen = s.law_limit_seen();
  if (seen.seconds > 0) j["law_limit_seen"] = {{"where", seen.where}, {"seconds", seen.seconds}};
  j["particles"] = world.particles().count();
  j["spheres"] = world.particles().sphere_count();
  j["mass"] = mass_json(world);
  j["energy"] = energy_json(world.energy());
  j["sensors"] = Json::object();
  for (std::size_t k = 0; k < s.sensors().size(); ++k) {
    const Sensor& sensor = *s.sensors()[k];
    Json last = Json::object();
    const auto columns = sensor.columns();
    for (std::size_t m = 0; m < columns.size() && k < facts.last.size() && m < facts.last[k].size(); ++m)
      last[columns[m]] = number(facts.last[k][m]);
    j["sensors"][sensor.name()] = {
        {"kind", sensor.kind()}, {"every", sensor.every()}, {"columns", columns}, {"last", last}};
  }
  j["events"] = Json::array();
  for (const auto& e : facts.events) j["events"].push_back({{"name", e.first}, {"time", e.second}});
  j["largest_overlap_share"] = counters.largest_overlap;
  j["overlap_limit"] = c.overlap_limit;
  if (c.rest.on) j["asleep"] = counters.asleep;
  j["list_rebuilds"] = counters.rebuilds;
  j["memory_bytes"] = s.memory_bytes();
  j["wall_seconds"] = facts.wall_seconds;
  j["particle_steps_per_second"] = facts.rate;
  j["seconds"] = {{"neighbour", counters.seconds_neighbour},
                  {"contacts", counters.seconds_contacts},
                  {"integrate", counters.seconds_integrate}};
  Json plugins = Json::array();
  for (const auto& p : s.provenance())
    plugins.push_back({{"id", p.id}, {"version", p.version}, {"sha256", p.sha256}, {"path", p.path}});
  Json effects = Json::array();
  for (const auto& e : c.effects)
    effects.push_back({{"effect", e.effect},
                       {"version", e.version},
                       {"on", Json::parse(e.on)},
                       {"parameters", Json::parse(e.parameters)}});
  j["provenance"] = {{"calx", version()},
                     {"git", git_revision()},
                     {"abi", abi_version()},
                     {"plugins", plugins},
                     {"effects", effects},
                     {"case_sha256", facts.case_sha256},
                     {"case_file", c.file},
                     {"started", facts.started},
                     {"seed", c.seed},
                     {"device", s.device()},
                     {"precision", facts.mixed ? "mixed" : "double"},
                     {"arithmetic", s.fast() ? "fast" : "exact"},
                     {"threads", facts.threads}};
  j["presets"] = s.presets();
  if (c.scale.factor != 1) j["scale"] = {{"factor", c.scale.factor}, {"parameters", s.scaled()}};
  j["assumptions"] = c.assumptions;
  for (const auto& part : c.parts)
    if (part.assumed) j["assumptions"].push_back("geometry of part \"" + part.name + "\" is assumed");
  j["notes"] = facts.notes;
  return j.dump(2) + "\n";
}

std::string fields_json(Simulation& s) {
  Json fields = Json::array(), curves = Json::array();
  for (const auto& sensor : s.sensors()) {
    for (const auto& f : sensor->fields())
      fields.push_back({{"sensor", sensor->name()},
                        {"name", f.name},
                        {"unit", f.unit},
                        {"nx", f.nx},
                        {"ny", f.ny},
                        {"origin", {f.origin.x, f.origin.y, f.origin.z}},
                        {"cell", f.cell},
                        {"values", numbers(f.values)}});
    for (const auto& c : sensor->curves())
      curves.push_back({{"sensor", sensor->name()},
                        {"name", c.name},
                        {"x_name", c.x_name},
                        {"y_name", c.y_name},
                        {"x", numbers(c.x)},
                        {"y", numbers(c.y)}});
  }
  return Json{{"fields", fields}, {"curves", curves}}.dump() + "\n";
}

}  // namespace calx
