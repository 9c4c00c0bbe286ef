#include "config/schema.hpp"

#include <cmath>

#include "base/units.hpp"
#include "config/extra_schema.hpp"
#include "config/tables.hpp"

namespace calx {
namespace schema {

Json text(const std::string& doc) { return {{"type", "string"}, {"minLength", 1}, {"description", doc}}; }

Json boolean(const std::string& doc, bool value) {
  return {{"type", "boolean"}, {"default", value}, {"description", doc}};
}

Json whole(const std::string& doc, std::uint64_t lowest) {
  return {{"type", "integer"}, {"minimum", lowest}, {"description", doc}};
}

Json choice(const std::string& doc, const std::vector<std::string>& names) {
  return {{"enum", names}, {"description", doc}};
}

Json with_unit(const Json& value, const std::string& unit) {
  return {{"type", "object"},
          {"properties",
           {{"value", value},
            {"unit", {{"type", "string"}, {"description", "a unit of " + dimension_name(parse_unit(unit))}}}}},
          {"required", {"value", "unit"}},
          {"additionalProperties", false}};
}

// Bounds are in SI; a value with a unit is checked when the case is read.
Json number(const std::string& doc, const std::string& unit, const Properties& bounds) {
  Json plain = {{"type", "number"}};
  for (const auto& b : bounds) plain[b.first] = b.second;
  const std::string in = unit == "1" || unit.empty() ? "" : ", " + unit;
  return {{"anyOf", {plain, with_unit({{"type", "number"}}, unit)}}, {"description", doc + in}};
}

Json vector(const std::string& doc, const std::string& unit) {
  const Json three = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
  Json each = three;
  each["items"] = number("component", unit);
  const std::string in = unit == "1" ? "" : ", " + unit;
  return {{"anyOf", {each, with_unit(three, unit)}}, {"description", doc + in}};
}

Json list(const std::string& doc, Json items) {
  return {{"type", "array"}, {"items", std::move(items)}, {"description", doc}};
}

Json map(const std::string& doc, Json values) {
  return {{"type", "object"}, {"additionalProperties", std::move(values)}, {"description", doc}};
}

Json object(const std::string& doc, const Properties& properties, const std::vector<std::string>& required) {
  Json out = {{"type", "object"}, {"description", doc}, {"properties", Json::object()}};
  for (const auto& p : properties) out["properties"][p.first] = p.second;
  if (!required.empty()) out["required"] = required;
  out["additionalProperties"] = false;
  return out;
}

Json any_of(const std::string& doc, const std::vector<Json>& options) {
  return {{"anyOf", options}, {"description", doc}};
}

Json ref(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json preset(Json schema, Json value) {
  schema["default"] = std::move(value);
  return schema;
}

namespace {

Properties bounds_of(const calx_field& f, double per) {
  Properties b;
  if (f.lowest > -unbounded) b.emplace_back("minimum", f.lowest / per);
  if (f.highest < unbounded) b.emplace_back("maximum", f.highest / per);
  return b;
}

double rounded(double degrees) { return std::round(degrees * 1e9) / 1e9; }

Json preset_of(const TableEntry& e, double per) {
  Json value = Json::array();
  for (int k = 0; k < 3; ++k) value.push_back(per == 1 ? e.field[k].preset : rounded(e.field[k].preset / per));
  return value;
}

// Degrees have no {"value", "unit"} form: the key says the unit.
Json plain_degrees(const TableEntry& e, Json schema) {
  schema["description"] = std::string(e.field->doc) + ", " + degree_unit(e.field->unit);
  return schema;
}

void add_entry(Json& properties, const TableEntry& e) {
  const calx_field& f = *e.field;
  if (!e.choices.empty()) {
    const std::size_t index = static_cast<std::size_t>(f.preset);
    properties[e.name] =
        preset(choice(f.doc, e.choices), index < e.choices.size() ? e.choices[index] : e.choices.front());
    return;
  }
  if (e.rows == 3) {
    properties[e.name] = preset(vector(f.doc, f.unit), preset_of(e, 1));
    const Json three = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
    if (e.is_angle)
      properties[e.name + "_deg"] = preset(plain_degrees(e, three), preset_of(e, from_degrees(1, f.unit)));
    return;
  }
  Json entry;
  if (f.flags & CALX_FIELD_INTEGER) {
    entry = {{"type", "integer"}, {"description", f.doc}};
    for (const auto& b : bounds_of(f, 1)) entry[b.first] = static_cast<std::int64_t>(b.second.get<double>());
    properties[e.name] = preset(entry, static_cast<std::int64_t>(f.preset));
    return;
  }
  properties[e.name] = preset(number(f.doc, f.unit, bounds_of(f, 1)), f.preset);
  if (!e.is_angle) return;
  const double per = from_degrees(1, f.unit);
  entry = plain_degrees(e, {{"type", "number"}});
  for (const auto& b : bounds_of(f, per)) entry[b.first] = rounded(b.second.get<double>());
  properties[e.name + "_deg"] = preset(entry, rounded(f.preset / per));
}

}  // namespace
}  // namespace schema

std::string table_schema(const std::vector<FieldTable>& tables, const char* extra_schema, const std::string& title) {
  Json properties = Json::object(), required = Json::array(), all = Json::array();
  for (const FieldTable& t : tables)
    for (const TableEntry& e : table_entries(t)) {
      if (properties.contains(e.name)) continue;
      schema::add_entry(properties, e);
      if (e.is_angle) {
        const Json one = {{"required", Json::array({e.name})}}, other = {{"required", Json::array({e.name + "_deg"})}};
        if (e.field->flags & CALX_FIELD_REQUIRED)
          all.push_back({{"oneOf", {one, other}}});
        else
          all.push_back({{"not", {{"required", {e.name, e.name + "_deg"}}}}});
      } else if (e.field->flags & CALX_FIELD_REQUIRED) {
        required.push_back(e.name);
      }
      if (e.field->flags & CALX_FIELD_REQUIRED)
        for (const std::string& key : {e.name, e.name + "_deg"})
          if (properties.contains(key)) properties[key].erase("default");
    }
  const Json extra = parse_extra_schema(extra_schema, title);
  if (extra.contains("properties"))
    for (const std::string& key : extra_keys(extra)) {
      if (extra["properties"].contains(key)) {
        properties[key] = extra["properties"][key];
        continue;
      }
      // The "_deg" form of the angle before it; limits in radians do not hold for it.
      Json degrees = extra["properties"][key.substr(0, key.size() - 4)];
      for (const char* limit : {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "default"})
        degrees.erase(limit);
      degrees["unit"] = degree_unit(degrees["unit"]);
      properties[key] = degrees;
    }
  if (extra.contains("required"))
    for (const Json& key : extra["required"]) required.push_back(key);
  Json out = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", title},
              {"type", "object"},
              {"properties", properties}};
  if (!required.empty()) out["required"] = required;
  if (!all.empty()) out["allOf"] = all;
  out["additionalProperties"] = false;
  return out.dump(2) + "\n";
}

}  // namespace calx
