#include "config/extra_schema.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/tables.hpp"

namespace calx {
namespace {

void check_keywords(const Json& schema, const std::string& owner, const std::string& place) {
  static const std::vector<std::string> known = {"type",
                                                 "properties",
                                                 "required",
                                                 "additionalProperties",
                                                 "items",
                                                 "minItems",
                                                 "maxItems",
                                                 "enum",
                                                 "minimum",
                                                 "maximum",
                                                 "exclusiveMinimum",
                                                 "exclusiveMaximum",
                                                 "default",
                                                 "format",
                                                 "unit",
                                                 "title",
                                                 "description",
                                                 "examples",
                                                 "$schema",
                                                 "$id",
                                                 "$comment"};
  const auto refuse = [&](const std::string& why) {
    throw Error(Fault::plugin, owner + ": extra_schema " + (place.empty() ? "/" : place) + ": " + why);
  };
  if (!schema.is_object()) refuse("must be an object");
  for (const auto& item : schema.items()) {
    const std::string at = place + pointer_token(item.key());
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      refuse("keyword \"" + item.key() + "\" is not supported; " + did_you_mean(item.key(), known));
    if (item.key() == "items") check_keywords(item.value(), owner, at);
    if (item.key() == "unit") {
      if (!item.value().is_string()) refuse("\"unit\" must be text");
      parse_unit(item.value().get<std::string>());
    }
    if (item.key() != "properties") continue;
    if (!item.value().is_object()) refuse("\"properties\" must be an object");
    for (const auto& property : item.value().items())
      check_keywords(property.value(), owner, at + pointer_token(property.key()));
  }
}

bool has_type(const Json& value, const std::string& type) {
  if (type == "number") return value.is_number();
  if (type == "integer")
    return value.is_number_integer() ||
           (value.is_number_float() &&
            value == Json(static_cast<double>(static_cast<std::int64_t>(value.get<double>()))));
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "array") return value.is_array();
  if (type == "object") return value.is_object();
  return type == "null" && value.is_null();
}

std::vector<std::string> types_of(const Json& schema) {
  const auto it = schema.find("type");
  if (it == schema.end()) return {};
  if (it->is_string()) return {it->get<std::string>()};
  return it->get<std::vector<std::string>>();
}

std::string in_words(const std::vector<std::string>& types) {
  std::string out;
  for (const std::string& t : types) {
    const std::string word = t == "number"    ? "a number"
                             : t == "integer" ? "a whole number"
                             : t == "string"  ? "text"
                             : t == "boolean" ? "true or false"
                             : t == "array"   ? "a list"
                             : t == "object"  ? "an object"
                                              : "null";
    out += (out.empty() ? "" : " or ") + word;
  }
  return out;
}

std::string unit_of(const Json& schema) {
  const auto it = schema.find("unit");
  return it == schema.end() ? "" : it->get<std::string>();
}

bool is_angle(const Json& schema) { return !unit_of(schema).empty() && has_angle(unit_of(schema)); }

void check_number(const Node& node, double x, const Json& schema, const std::string& owner) {
  const std::string unit = unit_of(schema);
  const auto limit = [&](const char* key, bool bad, const char* words) {
    if (bad)
      node.fail(format_quantity(x, unit) + " is out of range; " + owner + " needs " + words + " " +
                format_quantity(schema[key].get<double>(), unit));
  };
  const auto at = [&](const char* key) { return schema.contains(key); };
  if (at("minimum")) limit("minimum", x < schema["minimum"].get<double>(), "at least");
  if (at("maximum")) limit("maximum", x > schema["maximum"].get<double>(), "at most");
  if (at("exclusiveMinimum")) limit("exclusiveMinimum", x <= schema["exclusiveMinimum"].get<double>(), "more than");
  if (at("exclusiveMaximum")) limit("exclusiveMaximum", x >= schema["exclusiveMaximum"].get<double>(), "less than");
}

Json read_value(const Node& node, const Json& schema, const std::string& owner, bool in_degrees);

Json read_object(const Node& node, const Json& schema, const std::string& owner, bool is_top) {
  Json out = Json::object();
  std::vector<std::string> known;
  const Json none = Json::object();
  const Json& properties = schema.contains("properties") ? schema["properties"] : none;
  const auto child = [&](const std::string& key) {
    return Node(node.document(), node.json()[key], node.pointer() + pointer_token(key));
  };
  for (const auto& property : properties.items()) {
    const std::string& key = property.key();
    known.push_back(key);
    const bool given = node.json().contains(key);
    const bool angle = is_angle(property.value());
    if (angle) known.push_back(key + "_deg");
    if (angle && node.json().contains(key + "_deg")) {
      if (given) node.fail("holds \"" + key + "\" and \"" + key + "_deg\"; must hold one of them");
      out[key] = read_value(child(key + "_deg"), property.value(), owner, true);
    } else if (given) {
      out[key] = read_value(child(key), property.value(), owner, false);
    } else if (property.value().contains("default")) {
      out[key] = property.value()["default"];
    }
  }
  const bool open = schema.contains("additionalProperties") && schema["additionalProperties"] != false;
  if (!is_top)
    for (const auto& item : node.json().items()) {
      if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
      if (!open && schema.contains("properties"))
        child(item.key()).fail("unknown key for " + owner + "; " + did_you_mean(item.key(), known));
      out[item.key()] = item.value();
    }
  if (schema.contains("required"))
    for (const Json& key : schema["required"])
      if (!out.contains(key.get<std::string>()))
        node.document().fail(node.pointer() + pointer_token(key.get<std::string>()),
                             "is missing; " + owner + " needs it");
  return out;
}

Json read_value(const Node& node, const Json& schema, const std::string& owner, bool in_degrees) {
  const Json& value = node.json();
  const std::string unit = unit_of(schema);
  Json out;
  const std::vector<std::string> types = types_of(schema);
  const bool may_be_object = std::find(types.begin(), types.end(), "object") != types.end();
  if (!unit.empty() && (value.is_number() || (value.is_object() && !may_be_object))) {
    out = in_degrees ? from_degrees(node.number("1"), unit) : node.number(unit);
  } else {
    bool fits = types.empty();
    for (const std::string& t : types) fits = fits || has_type(value, t);
    if (!fits) node.fail(shown(value) + "; " + owner + " needs " + in_words(types));
    out = value;
  }
  if (out.is_number()) check_number(node, out.get<double>(), schema, owner);
  if (schema.contains("enum") && std::find(schema["enum"].begin(), schema["enum"].end(), out) == schema["enum"].end()) {
    std::vector<std::string> names;
    for (const Json& name : schema["enum"]) names.push_back(name.is_string() ? name.get<std::string>() : name.dump());
    node.fail(shown(value) + " is not one of the choices of " + owner + "; " +
              did_you_mean(value.is_string() ? value.get<std::string>() : value.dump(), names));
  }
  if (value.is_string() && schema.contains("format") && schema["format"] == "path")
    out = node.document().absolute_path(value.get<std::string>());
  if (value.is_array()) {
    const std::size_t least = schema.value("minItems", std::size_t(0));
    const std::size_t most = schema.value("maxItems", static_cast<std::size_t>(-1));
    if (value.size() < least || value.size() > most) {
      const std::string right = least == most          ? std::to_string(least)
                                : value.size() < least ? "at least " + std::to_string(least)
                                                       : "at most " + std::to_string(most);
      node.fail(shown(value) + "; " + owner + " needs " + right);
    }
    if (schema.contains("items")) {
      // A list takes over the unit of the list itself, so that key and "_deg" stand once.
      Json items = schema["items"];
      if (!unit.empty() && !items.contains("unit") && items.value("type", "") == "number") items["unit"] = unit;
      out = Json::array();
      for (const Node& n : node.items("values")) out.push_back(read_value(n, items, owner, in_degrees));
    }
  } else if (out.is_object()) {
    out = read_object(node, schema, owner, false);
  }
  return out;
}

}  // namespace

Json parse_extra_schema(const char* text, const std::string& owner) {
  if (text == nullptr) return Json::object();
  Json schema = Json::parse(text, nullptr, false);
  if (schema.is_discarded())
    throw Error(Fault::plugin, owner + ": extra_schema is not JSON; must be an object with \"properties\"");
  check_keywords(schema, owner, "");
  return schema;
}

std::vector<std::string> extra_keys(const Json& schema) {
  std::vector<std::string> keys;
  if (schema.contains("properties"))
    for (const auto& property : schema["properties"].items()) {
      keys.push_back(property.key());
      if (is_angle(property.value())) keys.push_back(property.key() + "_deg");
    }
  return keys;
}

Json read_extra(const Node& node, const Json& schema, const std::string& owner) {
  return read_object(node, schema, owner, true);
}

}  // namespace calx
