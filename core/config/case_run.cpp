// The case as a whole, and how it is run: domain, time, output, plugin pins. Also the entry points of the module.
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/units.hpp"
#include "config/case_effects.hpp"
#include "config/case_reader.hpp"
#include "config/config.hpp"

namespace calx {

// Wrong types are left for the section's own reader to refuse.
void CaseReader::collect_names(const Node& root) {
  const Json& j = root.json();
  const auto keys = [&](const char* section, std::vector<std::string>& out) {
    const auto it = j.find(section);
    if (it == j.end() || !it->is_object()) return;
    for (const auto& item : it->items()) out.push_back(item.key());
  };
  keys("materials", names_.materials);
  keys("shapes", names_.shapes);
  keys("regions", names_.regions);
  keys("motions", names_.motions);
  keys("events", names_.events);
  const auto parts = j.find("parts");
  if (parts == j.end() || !parts->is_array()) return;
  for (const Json& part : *parts) {
    const auto name = part.is_object() ? part.find("name") : part.end();
    if (name != part.end() && name->is_string()) names_.parts.push_back(name->get<std::string>());
  }
}

void CaseReader::read_domain(Object& root) {
  Object o(root.need("domain", "the box the particles live in: {\"min\": [..], \"max\": [..]}, m"), "a domain");
  DomainSettings& d = case_.domain;
  d.box.lo = o.need("min", "the lowest corner of the domain, m").vector("m");
  d.box.hi = o.need("max", "the highest corner of the domain, m").vector("m");
  check_corners(o.node(), d.box.lo, d.box.hi);
  if (const auto periodic = o.find("periodic")) {
    const std::vector<Node> flags = periodic->items("three times true or false");
    if (flags.size() != 3)
      periodic->fail(shown(periodic->json()) + "; must be three times true or false, for x, y and z");
    for (std::size_t k = 0; k < 3; ++k) d.periodic[k] = flags[k].boolean();
  } else {
    document_.fill(o.pointer() + "/periodic", {false, false, false});
  }
  const std::size_t leave =
      o.choice("on_leave", "a way to treat particles that leave", {"error", "delete", "count"}, 0);
  d.on_leave = leave == 0   ? DomainSettings::OnLeave::error
               : leave == 1 ? DomainSettings::OnLeave::remove
                            : DomainSettings::OnLeave::count;
  o.done();
}

void CaseReader::read_time(Object& root) {
  Object o(root.need("time", "must hold at least \"end\", the end of the run in s"), "the time settings");
  TimeSettings& t = case_.time;
  t.integrator = o.choice("integrator", "an integrator", {"euler", "verlet"}, 0) == 0
                     ? TimeSettings::Integrator::euler
                     : TimeSettings::Integrator::verlet;
  t.rayleigh_fraction = o.number("rayleigh_fraction", "1", t.rayleigh_fraction, Allow::above_zero);
  if (t.rayleigh_fraction > 1)
    o.find("rayleigh_fraction")
        ->fail(format_number(t.rayleigh_fraction) + " is out of range; must be above 0 and at most 1");
  t.step = o.number("step", "s", 0, Allow::not_negative);
  t.end = o.need("end", "the end of the run in s").number("s", Allow::not_negative);
  if (const auto e = o.find("end_event")) t.end_event = event(*e, "end of the run");
  o.done();
}

void CaseReader::read_output(Object& root) {
  Object o = root.section("output", "output settings");
  OutputSettings& s = case_.output;
  s.frames_every = o.number("frames_every", "s", s.frames_every, Allow::not_negative);
  s.checkpoint_every_wall = o.number("checkpoint_every_wall", "s", s.checkpoint_every_wall, Allow::not_negative);
  s.checkpoint_every = o.number("checkpoint_every", "s", s.checkpoint_every, Allow::not_negative);
  s.particles_h5 = o.boolean("particles_h5", s.particles_h5);
  o.done();
  Object n = root.section("neighbour", "neighbour settings");
  case_.neighbour.skin = n.number("skin", "m", 0, Allow::not_negative);
  n.done();
}

void CaseReader::read_rest(Object& root) {
  RestSettings& r = case_.rest;
  r.on = root.has("rest");
  if (!r.on) return;
  Object o = root.section("rest", "settings of particles at rest");
  r.after = o.number("after", "s", r.after, Allow::above_zero);
  r.displacement = o.number("displacement", "1", r.displacement, Allow::above_zero);
  r.force = o.number("force", "1", r.force, Allow::above_zero);
  o.done();
}

void CaseReader::read_plugins(Object& root) {
  for (const auto& entry : root.section("plugins", "plugin pins by id").entries()) {
    Object o(entry.second, "a plugin pin");
    const Node node = o.need("sha256", "the SHA-256 of the plugin's library");
    std::string hash = node.text("64 hexadecimal digits");
    for (char& c : hash)
      if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
    if (hash.size() != 64 || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
      node.fail(shown(node.json()) + "; must be 64 hexadecimal digits");
    o.done();
    case_.plugin_pins.emplace_back(entry.first, hash);
  }
}

// Expanded before the case is read (case_effects.hpp); what stands here is the record.
void CaseReader::read_effects(Object& root) {
  for (const Node& node : root.items("effects", "effects")) {
    Object o(node, "an effect");
    EffectSettings e;
    e.effect = o.need("effect", "the id of an effect").text("the id of an effect");
    e.version = o.text("version", "a version");
    e.on = o.parameters("on").json;
    e.parameters = o.parameters("parameters").json;
    o.has("expanded");
    o.done();
    case_.effects.push_back(e);
  }
}

CaseSettings CaseReader::read() {
  const Node top(document_, document_.root(), "");
  Object root(top, "a case");
  collect_names(top);
  case_.file = document_.file();
  case_.folder = document_.folder();
  root.has("$schema");
  root.has("relative_to");
  const Node version = root.need("calx", "must be 1, the version of the format");
  if (!version.json().is_number() || version.json().get<double>() != 1)
    version.fail(shown(version.json()) + " is not a version this program reads; must be 1");
  case_.title = root.text("title", "a line of text");
  if (case_.title.empty()) {
    case_.title = std::filesystem::path(document_.file()).stem().string();
    document_.fill("/title", case_.title);
  }
  case_.gravity = root.vector("gravity", "m/s^2", case_.gravity);
  if (const auto seed = root.find("seed"))
    case_.seed = seed->whole(0);
  else
    document_.fill("/seed", case_.seed);
  // Order matters: events first, so that named ones stand before those made up by others; regions before sources.
  read_regions(root);
  read_events(root);
  read_domain(root);
  read_time(root);
  read_materials(root);
  read_contacts(root);
  read_shapes(root);
  read_sources(root);
  read_motions(root);
  read_parts(root);
  read_stages(root);
  read_forces(root);
  case_.energy_ledger = root.boolean("energy", false);
  read_sensors(root);
  read_output(root);
  read_rest(root);
  case_.overlap_limit = root.number("overlap_limit", "1", case_.overlap_limit, Allow::above_zero);
  for (const Node& n : root.items("assumptions", "texts"))
    case_.assumptions.push_back(n.text("one assumption in words"));
  read_effects(root);
  read_plugins(root);
  read_scale(root);
  root.done();
  check_event_cycles();
  return case_;
}

CaseFile parse_case(const std::string& text, const std::string& file,
                    const std::vector<std::pair<std::string, std::string>>& overrides, const EffectLibrary* effects) {
  Document document(text, file, overrides);
  expand_effects(document, effects);
  CaseFile out;
  out.settings = CaseReader(document).read();
  out.resolved = document.resolved();
  return out;
}

CaseFile read_case(const std::string& path, const std::vector<std::pair<std::string, std::string>>& overrides,
                   const EffectLibrary* effects) {
  return parse_case(read_text_file(path), path, overrides, effects);
}

}  // namespace calx
