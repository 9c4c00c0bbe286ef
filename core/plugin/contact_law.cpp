#include "plugin/contact_law.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "plugin/refused.hpp"

namespace calx {

ContactLaw::ContactLaw(InstancePtr instance)
    : instance_(std::move(instance)), table_(static_cast<const calx_contact_law*>(instance_->table(CALX_CONTACT_LAW))) {
  if (!table_)
    throw Error(Fault::plugin, instance_->label() + " is of the kind " + instance_->descriptor().kind +
                                   ", but " CALX_CONTACT_LAW " is wanted here");
}

std::vector<double> ContactLaw::new_history() const {
  std::vector<double> out;
  for (std::uint32_t k = 0; k < table_->state_count; ++k) out.push_back(table_->state[k].preset);
  return out;
}

std::vector<double> ContactLaw::derive(const std::vector<double>& material_i, const std::vector<double>& material_j,
                                       const std::vector<double>& given, const std::string& file,
                                       const std::string& pointer) const {
  if (material_i.size() != table_->material_count || material_j.size() != table_->material_count ||
      given.size() != table_->given_count)
    throw Error(Fault::plugin, place(file, pointer) + instance_->label() + ": rows of another length than its tables");
  std::vector<double> pair = given;
  if (table_->derive) {
    pair.assign(table_->pair_count, 0.0);
    instance_->check(table_->derive(instance_->get(), instance_->host(), material_i.data(), material_j.data(),
                                    given.data(), pair.data()),
                     file, pointer, "derive");
  }
  for (std::uint32_t k = 0; k < table_->pair_count; ++k)
    if (!std::isfinite(pair[k]))
      throw Error(Fault::plugin, place(file, pointer) + instance_->label() + " derives a value of \"" +
                                     table_->pair[k].name + "\" (" + table_->pair[k].doc +
                                     ") that is not finite; look at the material and contact parameters");
  return pair;
}

double ContactLaw::stable_dt(const std::vector<double>& pair, double m_eff, double r_eff, double overlap) const {
  if (!table_->stable_dt) return std::numeric_limits<double>::infinity();
  const double dt = table_->stable_dt(pair.data(), m_eff, r_eff, overlap);
  if (dt > 0) return dt;
  throw Error(Fault::plugin,
              instance_->label() + ": its stable step is " + std::to_string(dt) + " s; above 0 is needed");
}

double ContactLaw::reach(const std::vector<double>& pair, double r_i, double r_j) const {
  if (!table_->reach) return 0.0;
  const double gap = table_->reach(pair.data(), r_i, r_j);
  if (gap >= 0 && std::isfinite(gap)) return gap;
  throw Error(Fault::plugin, instance_->label() + ": its reach is " + std::to_string(gap) + " m; 0 or more is needed");
}

ContactLawEntry create_contact_law(PluginRegistry& registry, const LawSettings& settings, const std::string& file) {
  // The given table may depend on the options, so the options are read first, passing over every other key; the second
  // reading knows both tables and judges all keys.
  std::vector<std::string> keys;
  const nlohmann::json object = nlohmann::json::parse(settings.parameters.json);
  for (const auto& item : object.items()) keys.push_back(item.key());
  ContactLaw law(registry.create(settings.law, CALX_CONTACT_LAW, settings.parameters, file, keys));
  ResolvedParameters all = resolve_parameters(settings.parameters, {law.options(), law.given()},
                                              law.instance().descriptor().extra_schema, law.instance().label(), file);
  return {law, std::move(all.values.at(1)), std::move(all.presets_used)};
}

void check_material_units(const std::vector<const ContactLaw*>& laws) {
  for (std::size_t a = 0; a < laws.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::uint32_t k = 0; k < laws[a]->material().count; ++k)
        for (std::uint32_t m = 0; m < laws[b]->material().count; ++m) {
          const calx_field &mine = laws[a]->material().fields[k], &other = laws[b]->material().fields[m];
          if (std::strcmp(mine.name, other.name) != 0 || std::strcmp(mine.unit, other.unit) == 0) continue;
          throw Error(Fault::plugin, "material property \"" + std::string(mine.name) +
                                         "\": " + laws[b]->instance().label() + " reads it in " + other.unit + ", " +
                                         laws[a]->instance().label() + " in " + mine.unit +
                                         "; the two cannot be used in one case");
        }
}

}  // namespace calx
