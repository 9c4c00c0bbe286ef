// contact_law.hpp: a contact law ready for the engine: its tables, the pair rows it derives, and its block function.
// One per entry of a law list; copied freely, the copies share the instance.
#pragma once
#include <string>
#include <vector>

#include "calx/contact_law.h"
#include "plugin/plugin.hpp"

namespace calx {

class ContactLaw {
 public:
  /// instance: of the kind calx.contact-law/1, from PluginRegistry::create, which has checked its table.
  explicit ContactLaw(InstancePtr instance);

  std::string id() const { return instance_->descriptor().id; }
  std::string version() const { return instance_->descriptor().version; }
  const calx_contact_law& table() const { return *table_; }
  const PluginInstance& instance() const { return *instance_; }

  /// What the user sets for the law as a whole, once per material, and once per pair of materials.
  FieldTable options() const { return {instance_->descriptor().parameter, instance_->descriptor().parameter_count}; }
  FieldTable material() const { return {table_->material, table_->material_count}; }
  FieldTable given() const { return {table_->given, table_->given_count}; }
  /// What the law reads: one row per ordered pair of materials, particle columns, contact history.
  FieldTable pair() const { return {table_->pair, table_->pair_count}; }
  FieldTable prop() const { return {table_->prop, table_->prop_count}; }
  FieldTable state() const { return {table_->state, table_->state_count}; }

  /// input: CALX_IN_*.
  bool reads(std::uint32_t input) const { return (table_->needs >> input) & 1u; }
  bool is_exact() const { return table_->flags & CALX_LAW_EXACT; }
  bool is_active() const { return table_->flags & CALX_LAW_ACTIVE; }

  /// History of a new contact, state_count values.
  std::vector<double> new_history() const;
  /// The value changes sign when i and j trade places.
  bool is_odd(std::uint32_t column) const { return table_->state[column].flags & CALX_FIELD_ODD; }
  /// The value survives separation up to the reach of the law.
  bool keeps_apart(std::uint32_t column) const { return table_->state[column].flags & CALX_FIELD_KEEP_APART; }
  /// Vector the column belongs to, 0 for a scalar; the three columns of a vector turn together.
  std::uint32_t vector_group(std::uint32_t column) const { return (table_->state[column].flags >> 8) & 0xffu; }

  /// The pair row of materials i and j (SI, in the order of material() and given()). file and pointer: where the case
  /// states the pair, for messages. Throws Error(Fault::settings) where the law finds the values wrong, Error(Fault::
  /// plugin) for a value that is not finite. [main]
  std::vector<double> derive(const std::vector<double>& material_i, const std::vector<double>& material_j,
                             const std::vector<double>& given, const std::string& file,
                             const std::string& pointer) const;
  /// Largest stable step of one contact, s; infinite where the law does not say. kg, m; overlap: the largest expected.
  /// Throws Error(Fault::plugin) for a step that is not above 0, as reach() does for one below 0 or not finite.
  double stable_dt(const std::vector<double>& pair, double m_eff, double r_eff, double overlap) const;
  /// The law can act between surfaces that do not touch.
  bool acts_apart() const { return table_->reach != nullptr; }
  /// Largest gap at which it acts, m; 0: only while touching.
  double reach(const std::vector<double>& pair, double r_i, double r_j) const;

  /// One block of contacts. Pure. [worker]
  void eval(const calx_block_f64& block) const { table_->eval_f64(&block); }

 private:
  InstancePtr instance_;
  const calx_contact_law* table_;
};

/// A law of one contact entry of a case, with the values the user gave for the pair.
struct ContactLawEntry {
  ContactLaw law;
  std::vector<double> given;              // in the order of law.given(), SI, presets filled in
  std::vector<std::string> presets_used;  // options and given fields the user left out
};

/// Creates the law and reads its parameters: one JSON object holds the law's options and its pair values; a key in
/// neither is an error. Throws Error(Fault::plugin) or Error(Fault::settings). file: the case, for messages and paths.
/// [main]
ContactLawEntry create_contact_law(PluginRegistry& registry, const LawSettings& settings, const std::string& file);

/// Laws that ask for the same material property must agree on its unit. Throws Error(Fault::plugin) with both names.
void check_material_units(const std::vector<const ContactLaw*>& laws);

}  // namespace calx
