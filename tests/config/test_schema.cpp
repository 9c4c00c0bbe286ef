// The JSON Schema and the reader of a case know the same keys, and a table's schema says what the table says.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "cases.hpp"
#include "config/config.hpp"

using namespace calx;
using Json = nlohmann::ordered_json;

namespace {

// Follows value and schema together, and notes each property of the schema by its place in the schema.
class Walk {
 public:
  explicit Walk(const Json& root) : root_(root) {}
  std::set<std::string> used;
  std::set<std::string> unknown;

  // Whether value could be meant by schema; options of anyOf are told apart by type and keys.
  bool fits(const Json& value, const Json& schema) const {
    if (schema.contains("$ref")) return fits(value, target(schema));
    if (schema.contains("const")) return value == schema["const"];
    if (schema.contains("anyOf") && !schema.contains("type")) {
      for (const Json& option : schema["anyOf"])
        if (fits(value, option)) return true;
      return false;
    }
    const std::string type = schema.value("type", "");
    if (type == "object" && value.is_object() && schema.contains("properties") &&
        schema.value("additionalProperties", Json()) == false) {
      for (const auto& item : value.items())
        if (!schema["properties"].contains(item.key())) return false;
      if (schema["properties"].contains("distribution"))
        return fits(value.value("distribution", Json()), schema["properties"]["distribution"]);
    }
    return type.empty() || (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
           ((type == "number" || type == "integer") && value.is_number());
  }

  void go(const Json& value, const Json& schema, const std::string& place) {
    if (schema.contains("$ref")) return go(value, target(schema), schema["$ref"].get<std::string>());
    if (schema.contains("anyOf") && !schema.contains("type")) {
      for (std::size_t k = 0; k < schema["anyOf"].size(); ++k)
        if (fits(value, schema["anyOf"][k])) return go(value, schema["anyOf"][k], place + "/" + std::to_string(k));
      unknown.insert(place);
      return;
    }
    if (value.is_array() && schema.contains("items"))
      for (const Json& entry : value) go(entry, schema["items"], place + "[]");
    if (!value.is_object()) return;
    for (const auto& item : value.items()) {
      if (schema.contains("properties") && schema["properties"].contains(item.key())) {
        used.insert(place + "/" + item.key());
        go(item.value(), schema["properties"][item.key()], place + "/" + item.key());
      } else if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
        go(item.value(), schema["additionalProperties"], place + "/*");
      } else if (schema.value("additionalProperties", Json(true)) == false) {
        unknown.insert(place + "/" + item.key());
      }
    }
  }

  // Every property the schema offers, by its place.
  void all(const Json& schema, const std::string& place, std::set<std::string>& out) const {
    if (schema.contains("anyOf") && !schema.contains("type"))
      for (std::size_t k = 0; k < schema["anyOf"].size(); ++k)
        all(schema["anyOf"][k], place + "/" + std::to_string(k), out);
    if (schema.contains("items")) all(schema["items"], place + "[]", out);
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
      all(schema["additionalProperties"], place + "/*", out);
    if (schema.contains("properties") && !schema["properties"].contains("unit"))
      for (const auto& p : schema["properties"].items()) {
        out.insert(place + "/" + p.key());
        all(p.value(), place + "/" + p.key(), out);
      }
  }

 private:
  const Json& target(const Json& schema) const { return root_["$defs"][schema["$ref"].get<std::string>().substr(8)]; }
  const Json& root_;
};

}  // namespace

TEST_CASE("the schema knows every key of the full case, and the full case uses every key of the schema") {
  const Json schema = Json::parse(case_schema());
  Walk walk(schema);
  // As resolved, so that defaults stand there too; the reader accepts it, which test_case.cpp shows.
  walk.go(Json::parse(parse_case(full_case(), "case.json").resolved), schema, "");
  CHECK_MESSAGE(walk.unknown.empty(), *walk.unknown.begin());
  std::set<std::string> all;
  walk.all(schema, "", all);
  for (const auto& def : schema["$defs"].items()) walk.all(def.value(), "#/$defs/" + def.key(), all);
  // Left out on purpose: the merge happens before, and a file of positions must exist.
  for (const char* key : {"/extends", "/sources[]/file", "/contacts[]/name", "/contacts[]/laws[]/parameters"})
    walk.used.insert(key);
  for (const std::string& key : all) CHECK_MESSAGE(walk.used.count(key) == 1, key);
  CHECK(all.size() > 120);
}

TEST_CASE("the walk itself notices a key the schema lacks") {
  Json schema = Json::parse(case_schema());
  schema["properties"]["time"]["properties"].erase("step");
  Walk walk(schema);
  walk.go(Json::parse(full_case(), nullptr, true, true), schema, "");
  CHECK(walk.unknown == std::set<std::string>{"/time/step"});
}

TEST_CASE("a table's schema holds names, ranges, degrees, choices and what is required") {
  const calx_field fields[] = {{"swing", "rad", "angle of a swing", 0, 6.283185307179586, 0, CALX_FIELD_REQUIRED, 0},
                               {"stroke", "m", "length of a stroke", 0, 1, 0.5, CALX_FIELD_REQUIRED, 0},
                               {"at_x", "m", "a point", -1e300, 1e300, 1, CALX_VEC(1), 0},
                               {"at_y", "m", "a point", -1e300, 1e300, 2, CALX_VEC(1), 0},
                               {"at_z", "m", "a point", -1e300, 1e300, 3, CALX_VEC(1), 0},
                               {"mode", "open|shut", "a mode", 0, 1, 1, CALX_FIELD_CHOICE, 0},
                               {"n", "1", "a number of things", 1, 9, 2, CALX_FIELD_INTEGER, 0},
                               {"lag", "rad", "an angle", -1, 1, 0, 0, 0}};
  const Json s = Json::parse(table_schema(
      {{fields, 8}},
      R"({"properties": {"file": {"type": "string"}, "tilt": {"type": "number", "unit": "rad", "maximum": 3}}, "required": ["file"]})",
      "x 1"));
  CHECK(s["title"] == "x 1");
  CHECK(s["additionalProperties"] == false);
  const Json& p = s["properties"];
  CHECK(p["swing_deg"]["maximum"] == 360);
  CHECK(p["swing_deg"]["description"] == "angle of a swing, deg");
  CHECK(p["stroke"]["anyOf"][0]["maximum"] == 1);
  CHECK_FALSE(p["stroke"].contains("default"));
  CHECK(p["at"]["default"] == Json({1.0, 2.0, 3.0}));
  CHECK_FALSE(p["at"]["anyOf"][0]["items"]["anyOf"][0].contains("maximum"));
  CHECK(p["mode"]["enum"] == Json({"open", "shut"}));
  CHECK(p["mode"]["default"] == "shut");
  CHECK(p["tilt_deg"]["unit"] == "deg");
  CHECK_FALSE(p["tilt_deg"].contains("maximum"));
  CHECK(p["n"]["type"] == "integer");
  CHECK(p["n"]["default"] == 2);
  CHECK(s["required"] == Json({"stroke", "file"}));
  CHECK(s["allOf"][0]["oneOf"][1]["required"][0] == "swing_deg");
  CHECK(s["allOf"][1]["not"]["required"] == Json({"lag", "lag_deg"}));
}
