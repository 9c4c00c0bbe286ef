// table_checks.cpp: parameter tables, units, schema.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/units.hpp"
#include "config/config.hpp"
#include "conformance/checks.hpp"
#include "plugin/tables.hpp"

namespace calx::conformance {
namespace {

/// The tables users write, and those only the plugin sees.
std::vector<std::pair<std::string, FieldTable>> tables_of(const Subject& subject, const PluginInstance& instance) {
  const calx_descriptor& d = subject.descriptor();
  std::vector<std::pair<std::string, FieldTable>> out = {{"parameter", {d.parameter, d.parameter_count}}};
  if (const auto* law = static_cast<const calx_contact_law*>(instance.table(CALX_CONTACT_LAW))) {
    out.push_back({"material", {law->material, law->material_count}});
    out.push_back({"given", {law->given, law->given_count}});
    out.push_back({"pair", {law->pair, law->pair_count}});
    out.push_back({"prop", {law->prop, law->prop_count}});
    out.push_back({"state", {law->state, law->state_count}});
  }
  if (const auto* sensor = static_cast<const calx_sensor*>(instance.table(CALX_SENSOR)))
    out.push_back({"output", {sensor->output, sensor->output_count}});
  return out;
}

std::string tables(Subject& subject) {
  int rows = 0;
  for (const Variant& variant : subject.variants()) {
    if (variant.example.empty() && variant.name != "presets") continue;
    InstancePtr instance;
    try {
      instance = subject.make(variant);
    } catch (const Failed&) {
      continue;  // creates tells it
    }
    const std::string fault =
        interface_fault(subject.manifest().kind, instance->table(subject.manifest().kind.c_str()));
    require(fault.empty(), variant.name + ": " + fault);
    rows = 0;
    for (const auto& table : tables_of(subject, *instance))
      for (std::uint32_t k = 0; k < table.second.count; ++k, ++rows) {
        const calx_field& f = table.second.fields[k];
        if (f.flags & CALX_FIELD_CHOICE) continue;
        Unit unit;
        try {
          unit = parse_unit(f.unit);
        } catch (const Error& e) {
          throw Failed{"its " + table.first + " table row \"" + f.name + "\": " + e.what()};
        }
        require(std::fabs(unit.factor - 1) < 1e-12,
                "its " + table.first + " table row \"" + f.name + "\" is in " + f.unit +
                    "; tables are in coherent SI, the host converts what users write");
      }
  }
  return std::to_string(rows) + " rows";
}

std::string creates(Subject& subject) {
  const bool law = subject.manifest().kind == CALX_CONTACT_LAW;
  int made = 0, refused = 0;
  std::string why;
  for (const Variant& variant : subject.variants()) {
    try {
      subject.make(variant);
      ++made;
    } catch (const Failed& failed) {
      require(!law && variant.example.empty(),
              failed.detail + (law ? "; creating a law with presets always succeeds" : ""));
      ++refused;
      why = failed.detail;
    }
  }
  if (made == 0) subject.any();
  return std::to_string(made) + " configurations" +
         (refused ? ", " + std::to_string(refused) + " refused (" + why + ")" : "");
}

/// An object of what the tables require, at presets.
nlohmann::json required_object(const std::vector<FieldTable>& tables) {
  nlohmann::json out = nlohmann::json::object();
  for (const FieldTable& table : tables)
    for (std::uint32_t k = 0; k < table.count; ++k) {
      const calx_field& f = table.fields[k];
      if (!(f.flags & CALX_FIELD_REQUIRED) || (f.flags >> 8 & 0xffu)) continue;
      out[f.name] = f.preset;
      if (!(f.flags & CALX_FIELD_CHOICE)) continue;
      std::string names = f.unit;
      for (int choice = static_cast<int>(f.preset); choice > 0; --choice) names.erase(0, names.find('|') + 1);
      out[f.name] = names.substr(0, names.find('|'));
    }
  return out;
}

std::string schema(Subject& subject) {
  const InstancePtr instance = subject.any();
  const calx_descriptor& d = subject.descriptor();
  std::vector<FieldTable> users = {{d.parameter, d.parameter_count}};
  if (const auto* law = static_cast<const calx_contact_law*>(instance->table(CALX_CONTACT_LAW)))
    users.push_back({law->given, law->given_count});
  const nlohmann::json schema = nlohmann::json::parse(table_schema(users, d.extra_schema, d.id));
  require(schema.contains("properties"), "its JSON Schema has no properties");
  if (d.extra_schema && nlohmann::json::parse(d.extra_schema).contains("required")) return "needs further parameters";
  Parameters parameters;
  const nlohmann::json base = required_object(users);
  parameters.json = base.dump();
  try {
    resolve_parameters(parameters, users, d.extra_schema, d.id, "presets");
  } catch (const Error& e) {
    throw Failed{std::string("its own presets are refused: ") + e.what()};
  }
  int tried = 0;
  for (const FieldTable& table : users)
    for (std::uint32_t k = 0; k < table.count; ++k) {
      const calx_field& f = table.fields[k];
      if ((f.flags & CALX_FIELD_CHOICE) || (f.flags >> 8 & 0xffu)) continue;
      for (const double beyond : {f.lowest - 1 - std::fabs(f.lowest), f.highest + 1 + std::fabs(f.highest)}) {
        if (!std::isfinite(beyond)) continue;
        nlohmann::json object = base;
        object[f.name] = beyond;
        parameters.json = object.dump();
        bool refused = false;
        try {
          resolve_parameters(parameters, users, d.extra_schema, d.id, "out of range");
        } catch (const Error&) {
          refused = true;
        }
        require(refused, std::string(f.name) + " = " + short_number(beyond) + " is out of range and accepted");
        ++tried;
      }
    }
  return std::to_string(tried) + " values out of range refused";
}

}  // namespace

std::string short_number(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.3g", value);
  return out;
}

std::vector<Check> table_checks() {
  return {
      {"creates", "Presets, every choice and every example of the manifest give an instance.", "", false, creates},
      {"tables", "Names, ranges, presets and vector groups are in order, units are coherent SI.", "", false, tables},
      {"schema", "The JSON Schema takes presets; values out of range are refused.", "", false, schema}};
}

}  // namespace calx::conformance
