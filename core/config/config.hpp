// config.hpp: reads a case (JSON with comments, SI units) into CaseSettings, and plugin parameters into table order.
// Every error names the file, the JSON pointer, the value and what would be right, with the nearest known key.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "calx/abi.h"
#include "config/effects.hpp"
#include "config/settings.hpp"

namespace calx {

struct CaseFile {
  CaseSettings settings;
  std::string resolved;  // the case as resolved: extends merged, overrides applied, effects expanded, comments gone;
                         // running it again gives the same bits (written as case.json of the run's folder)
};

/// Reads, merges "extends" (RFC 7396), applies overrides ("/time/end", "2.0": a JSON value, or text where it does not
/// parse) and validates all that needs no plugin: keys, types, units, ranges, names that refer to each other.
/// effects: where "effects" of the case are looked up (PluginEffects of core/plugin); without it a case that names one
/// is refused, unless it is a resolved one, whose effects are expanded already.
/// Throws Error(Fault::settings) or Error(Fault::files).
CaseFile read_case(const std::string& path, const std::vector<std::pair<std::string, std::string>>& overrides = {},
                   const EffectLibrary* effects = nullptr);

/// The same from text; file is used in messages and to resolve relative paths.
CaseFile parse_case(const std::string& text, const std::string& file,
                    const std::vector<std::pair<std::string, std::string>>& overrides = {},
                    const EffectLibrary* effects = nullptr);

/// The values of a parameter table in table order: presets filled in, units converted ("swing_deg" for a field in rad,
/// {"value": 2.5, "unit": "mm"}, arrays of three for vector groups, names for choices), ranges checked.
struct FieldTable {
  const calx_field* fields = nullptr;
  std::uint32_t count = 0;
};
struct ResolvedParameters {
  std::vector<std::vector<double>> values;  // one vector per table given
  std::string extra_json = "{}";            // what extra_schema allows, paths made absolute
  std::vector<std::string> presets_used;    // names of fields the user did not give
};
/// Several tables may share one JSON object (a law's options and its pair parameters). A key in none of them and not in
/// extra_schema is an error with the nearest name; owner ("calx.epam 1.0.0") stands in messages; ignore lists keys that
/// belong to somebody else. file: the case file, for messages and paths.
ResolvedParameters resolve_parameters(const Parameters& parameters, const std::vector<FieldTable>& tables,
                                      const char* extra_schema, const std::string& owner, const std::string& file,
                                      const std::vector<std::string>& ignore = {});

/// Keys of the object with the JSON pointer of each, in the order the user wrote them.
std::vector<std::pair<std::string, std::string>> parameter_keys(const Parameters& parameters);
/// What a user may write for a table: field names, one name per vector group, and the "_deg" forms of angles.
std::vector<std::string> table_keys(const FieldTable& table);
/// Throws for the first key that is not known: `case.json /materials/calcine/yuong: unknown key; did you mean
/// "young"?`.
void check_keys(const Parameters& parameters, const std::vector<std::string>& known, const std::string& file);

/// JSON Schema (draft 2020-12) of a case, without plugin parameters; of one table, for `calx plugin schema`.
std::string case_schema();
std::string table_schema(const std::vector<FieldTable>& tables, const char* extra_schema, const std::string& title);

}  // namespace calx
