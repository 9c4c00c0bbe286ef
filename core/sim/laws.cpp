// laws.cpp: from "contacts" and "materials" of a case to pair rows.
#include "sim/laws.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/units.hpp"
#include "config/scale.hpp"
#include "plugin/contact_law.hpp"

namespace calx {
namespace {

std::uint32_t material_index(const CaseSettings& settings, const std::string& name) {
  for (std::uint32_t k = 0; k < settings.materials.size(); ++k)
    if (settings.materials[k].name == name) return k;
  throw Error(Fault::settings, settings.file + ": no material \"" + name + "\"");
}

/// Keys of a material that a law's table does not name: they belong to other laws.
std::vector<std::string> foreign_keys(const Parameters& parameters, const FieldTable& table) {
  const auto own = table_keys(table);
  std::vector<std::string> out;
  for (const auto& key : parameter_keys(parameters))
    if (std::find(own.begin(), own.end(), key.first) == own.end()) out.push_back(key.first);
  return out;
}

void refuse_unsupported(const calx_contact_law& table, const std::string& where) {
  if (table.prop_count > 0)
    throw Error(Fault::plugin, where + ": the law reads particle columns, which this host does not offer yet");
}

/// Values of a table for grains of another size. lines gets what changed, "calcine-steel calx.linear: kn 1e3 N/m ->
/// ...".
void scale_values(const ScaleSettings& scale, const FieldTable& table, const std::string& owner,
                  std::vector<double>& values, std::vector<std::string>& lines) {
  if (scale.factor == 1) return;  // exactly 1 leaves every bit as it is
  for (std::uint32_t k = 0; k < table.count; ++k) {
    const calx_field& field = table.fields[k];
    if (field.flags & CALX_FIELD_CHOICE) continue;
    const double by = scale_factor(scale, field.unit), before = values[k];
    values[k] *= by;
    const std::string line = owner + ": " + field.name + " " + brief_quantity(before, field.unit) + " -> " +
                             brief_quantity(values[k], field.unit);
    if (by != 1 && before != 0 && std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
}

}  // namespace

CaseLaws load_laws(const CaseSettings& settings, PluginRegistry& registry) {
  const auto n = static_cast<std::uint32_t>(settings.materials.size());
  CaseLaws out;
  out.matrix.assign(static_cast<std::size_t>(n) * n, nullptr);
  // Moduli also give the Rayleigh limit of the time step, whatever the law reads.
  std::vector<std::string> known{"density", "young", "poisson"};
  std::vector<ContactLawEntry> entries;
  for (const auto& contact : settings.contacts)
    for (const auto& entry : contact.laws) {
      entries.push_back(create_contact_law(registry, entry, settings.file));
      for (const auto& key : table_keys(entries.back().law.material())) known.push_back(key);
    }
  // Before any law misses a property: a misspelt key is the likelier mistake.
  for (const auto& m : settings.materials) check_keys(m.properties, known, settings.file);
  auto next = entries.begin();
  for (const auto& contact : settings.contacts) {
    const std::uint32_t a = material_index(settings, contact.between[0]),
                        b = material_index(settings, contact.between[1]);
    auto list_ab = std::make_unique<LawList>(), list_ba = std::make_unique<LawList>();
    list_ab->label = contact.between[0] + "-" + contact.between[1];
    list_ba->label = contact.between[1] + "-" + contact.between[0];
    for (const auto& entry : contact.laws) {
      ContactLawEntry& made = *next++;
      const ContactLaw& law = made.law;
      const std::string owner = law.id() + " " + law.version();
      refuse_unsupported(law.table(), settings.file + " " + entry.pointer + ": " + owner);
      for (const auto& name : made.presets_used)
        for (std::uint32_t k = 0; k < law.given().count; ++k)
          if (name == law.given().fields[k].name)
            out.presets.push_back(list_ab->label + " " + law.id() + ": " + name + " = " +
                                  format_quantity(law.given().fields[k].preset, law.given().fields[k].unit));
      scale_values(settings.scale, law.given(), list_ab->label + " " + law.id(), made.given, out.scaled);
      std::vector<double> row[2];
      for (int side = 0; side < 2; ++side) {
        const auto& m = settings.materials[side == 0 ? a : b];
        row[side] = resolve_parameters(m.properties, {law.material()}, nullptr, owner, settings.file,
                                       foreign_keys(m.properties, law.material()))
                        .values[0];
        scale_values(settings.scale, law.material(), m.name + " " + law.id(), row[side], out.scaled);
      }
      for (int direction = 0; direction < 2; ++direction) {
        LawList& list = direction == 0 ? *list_ab : *list_ba;
        LawTerm term;
        term.table = &law.table();
        term.id = entry.law;
        term.name = entry.name;
        term.state_offset = list.state_count;
        term.pair_row = law.derive(row[direction], row[1 - direction], made.given, settings.file, entry.pointer);
        term.pair_row_f32.assign(term.pair_row.begin(), term.pair_row.end());
        for (std::uint32_t k = 0; k < law.state().count; ++k) {
          list.odd.push_back(law.is_odd(k));
          list.keep.push_back(law.keeps_apart(k));
        }
        list.reaches = list.reaches || law.acts_apart();
        const auto presets = law.new_history();
        list.preset.insert(list.preset.end(), presets.begin(), presets.end());
        list.needs |= law.table().needs;
        list.state_count += law.state().count;
        list.terms.push_back(std::move(term));
      }
      out.laws.push_back(std::make_unique<ContactLaw>(law));
    }
    out.matrix[a * n + b] = list_ab.get();
    out.lists.push_back(std::move(list_ab));
    if (a == b) continue;
    out.matrix[b * n + a] = list_ba.get();
    out.lists.push_back(std::move(list_ba));
  }
  std::vector<const ContactLaw*> all;
  for (const auto& law : out.laws) all.push_back(law.get());
  check_material_units(all);
  return out;
}

}  // namespace calx
