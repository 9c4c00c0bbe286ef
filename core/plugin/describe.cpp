// describe.cpp: what a plugin says about itself, as text for people and as JSON Schema for editors.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/text_table.hpp"
#include "plugin/contact_law.hpp"
#include "plugin/effects.hpp"
#include "plugin/plugin.hpp"

namespace calx {
namespace {

using Row = std::vector<std::string>;

/// Shortest text that reads back to the same value, whatever the locale.
std::string number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char out[40];
  const auto end = std::to_chars(out, out + sizeof out, value);
  return {out, end.ptr};
}

std::vector<std::string> choices(const calx_field& field) {
  std::vector<std::string> names(1);
  for (const char* c = field.unit; *c; ++c) {
    if (*c == '|')
      names.emplace_back();
    else
      names.back() += *c;
  }
  return names;
}

Row field_row(const calx_field& field) {
  Row row = {field.name};
  if (field.flags & CALX_FIELD_CHOICE) {
    const std::vector<std::string> names = choices(field);
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : " | ") + name;
    row.insert(row.end(), {"choice", all, names.at(static_cast<std::size_t>(field.preset))});
  } else {
    row.insert(row.end(), {field.unit, number(field.lowest) + " .. " + number(field.highest), number(field.preset)});
  }
  if (field.flags & CALX_FIELD_REQUIRED) row.back() = "required";
  std::string marks;
  if (field.flags & CALX_FIELD_INTEGER) marks += " [whole number]";
  if (field.flags & CALX_FIELD_ODD) marks += " [changes sign with i and j]";
  if (field.flags & CALX_FIELD_KEEP_APART) marks += " [survives separation]";
  if (field.flags & CALX_FIELD_ACCUMULATE) marks += " [added to]";
  if ((field.flags >> 8) & 0xffu) marks += " [vector " + std::to_string((field.flags >> 8) & 0xffu) + "]";
  row.push_back(field.doc + marks);
  return row;
}

/// How a case writes rows that are not a key of their own name: vectors as lists, angles in degrees. Presets shown.
std::string written_as(const FieldTable& fields) {
  std::string out;
  for (std::uint32_t k = 0; k < fields.count; ++k) {
    const calx_field* field = fields.fields + k;
    std::string name = field->name, value;
    if ((field->flags >> 8) & 0xffu) {  // tables are checked: three rows, called NAME_x, NAME_y, NAME_z
      name.resize(name.size() - 2);
      value = "[" + number(field[0].preset) + ", " + number(field[1].preset) + ", " + number(field[2].preset) + "]";
      k += 2;
    } else if (std::string(field->unit).compare(0, 3, "rad") == 0) {
      name += "_deg";  // as a person would write it, not to the last digit
      value = number(std::round(field->preset * 180 / 3.14159265358979324 * 1e6) / 1e6);
    }
    if (!value.empty()) out += (out.empty() ? "\"" : ", \"") + name + "\": " + value;
  }
  return out.empty() ? out : "  a case may write " + out + "\n";
}

std::string field_section(const std::string& title, const FieldTable& fields) {
  if (fields.count == 0) return "";
  std::vector<Row> rows = {{"name", "unit", "range", "preset", "meaning"}};
  for (std::uint32_t k = 0; k < fields.count; ++k) rows.push_back(field_row(fields.fields[k]));
  return "\n" + title + "\n" + text_table(rows);
}

std::string needs_text(const ContactLaw& law) {
  static const char* const names[CALX_IN_COUNT] = {"overlap", "nx", "ny",    "nz",    "vx",  "vy",  "vz",       "wx",
                                                   "wy",      "wz", "r_eff", "m_eff", "r_i", "r_j", "fn_before"};
  std::string out;
  for (std::uint32_t k = 0; k < CALX_IN_COUNT; ++k)
    if (law.reads(k)) out += std::string(" ") + names[k];
  return out.empty() ? " nothing" : out;
}

/// The kind of a usable plugin, for commands that are given an id alone.
std::string kind_of(const PluginRegistry& registry, const std::vector<std::string>& search, const std::string& id) {
  std::vector<std::string> known;
  for (const PluginManifest& m : registry.manifests()) {
    if (m.id == id && m.refused.empty()) return m.kind;
    if (m.refused.empty()) known.push_back(m.id);
  }
  for (const PluginManifest& m : registry.manifests())
    if (m.id == id) throw Error(Fault::plugin, "plugin " + id + " refused: " + m.refused);
  std::string folders;
  for (const std::string& folder : search) folders += (folders.empty() ? "" : ", ") + folder;
  throw Error(Fault::plugin, "no plugin " + id + " found in " + (folders.empty() ? "any folder" : folders) + "; " +
                                 (nearest_name(id, known).empty()
                                      ? "name its folder with --plugin-path; calx plugin list shows those found"
                                      : did_you_mean(id, known)));
}

const PluginManifest& usable(const PluginRegistry& registry, const std::string& id) {
  const auto& all = registry.manifests();
  return *std::find_if(all.begin(), all.end(),
                       [&](const PluginManifest& m) { return m.id == id && m.refused.empty(); });
}

/// A law made with presets, which always succeeds, to see the tables of its instance.
ContactLaw preset_law(PluginRegistry& registry, const calx_descriptor& d) {
  std::vector<double> presets;
  for (std::uint32_t k = 0; k < d.parameter_count; ++k) presets.push_back(d.parameter[k].preset);
  return ContactLaw(registry.create_with_values(d.id, CALX_CONTACT_LAW, "", "", presets));
}

}  // namespace

std::string plugin_list_text(const std::vector<std::string>& search) {
  std::vector<Row> rows;
  std::string refused;
  for (const PluginManifest& m : discover_plugins(search)) {
    if (m.refused.empty())
      rows.push_back({m.id, m.version, m.kind, std::string(m.effect ? "[effect] " : "") + m.summary});
    else
      refused += "  " + (m.id.empty() ? m.path : m.id) + ": " + m.refused + "\n";
  }
  std::sort(rows.begin(), rows.end());
  std::string out = rows.empty() ? "no plugin found\n" : "plugins\n" + text_table(rows);
  if (!refused.empty()) out += "\nrefused\n" + refused;
  out += "\nfolders searched, in this order\n";
  for (const std::string& folder : search) out += "  " + folder + "\n";
  return out;
}

std::string plugin_describe_text(const std::string& id, const std::vector<std::string>& search) {
  PluginRegistry registry(search);
  const std::string kind = kind_of(registry, search, id);
  const PluginManifest& manifest = usable(registry, id);
  if (kind == kCaseEffect)
    return id + " " + manifest.version + "\n" + manifest.summary + "\n\n" +
           text_table({{"kind", kind}, {"license", manifest.license}, {"manifest", manifest.path}}) +
           effect_text(*manifest.effect);
  const calx_descriptor& d = registry.load(id, kind, "", "");
  const PluginProvenance from = registry.provenance().at(0);
  std::string out = std::string(d.id) + " " + d.version + "\n" + d.summary + "\n\n";
  out += text_table({{"name", d.name},
                     {"kind", d.kind},
                     {"vendor", d.vendor},
                     {"license", d.license},
                     {"library", from.path},
                     {"sha256", from.sha256}});
  out += field_section("parameters", {d.parameter, d.parameter_count});
  out += written_as({d.parameter, d.parameter_count});
  if (kind == CALX_CONTACT_LAW) {
    const ContactLaw law = preset_law(registry, d);
    out += field_section("material properties, once per material", law.material());
    out += field_section("parameters of a pair of materials", law.given());
    out += written_as(law.given());
    if (law.table().derive) out += field_section("pair values the law reads, derived from those", law.pair());
    out += field_section("particle columns", law.prop());
    out += field_section("contact history", law.state());
    out += "\nreads" + needs_text(law) + "\n";
    out += law.acts_apart() ? "acts between surfaces that do not touch\n" : "acts only while touching\n";
    if (law.is_exact()) out += "exact: the same bits on every backend\n";
    if (law.is_active()) out += "active: may create energy on purpose\n";
  }
  if (d.extra_schema) out += std::string("\nfurther parameters, as JSON Schema\n  ") + d.extra_schema + "\n";
  if (manifest.effect) out += effect_text(*manifest.effect);
  return out;
}

std::string plugin_schema_text(const std::string& id, const std::vector<std::string>& search) {
  PluginRegistry registry(search);
  const std::string kind = kind_of(registry, search, id);
  if (kind == kCaseEffect)
    throw Error(Fault::plugin,
                "plugin " + id + " is an effect of edits alone; calx plugin describe shows its parameters");
  const calx_descriptor& d = registry.load(id, kind, "", "");
  const std::string title = std::string("parameters of ") + d.id + " " + d.version;
  if (kind != CALX_CONTACT_LAW) return table_schema({{d.parameter, d.parameter_count}}, d.extra_schema, title);
  const ContactLaw law = preset_law(registry, d);
  return table_schema({law.options(), law.given()}, d.extra_schema, title);
}

}  // namespace calx
