// schema.hpp: small builders of JSON Schema (draft 2020-12) pieces.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "config/document.hpp"

namespace calx::schema {

using Properties = std::vector<std::pair<std::string, Json>>;

Json text(const std::string& doc);
Json boolean(const std::string& doc, bool preset);
Json whole(const std::string& doc, std::uint64_t lowest);
Json choice(const std::string& doc, const std::vector<std::string>& names);
/// {"value": number, "unit": "mm"}; number is the schema of the value.
Json with_unit(const Json& value, const std::string& unit);
/// A number in unit or a value with a unit; bounds: {{"exclusiveMinimum", 0}}, SI.
Json number(const std::string& doc, const std::string& unit, const Properties& bounds = {});
Json vector(const std::string& doc, const std::string& unit);
Json list(const std::string& doc, Json items);
Json map(const std::string& doc, Json values);
Json object(const std::string& doc, const Properties& properties, const std::vector<std::string>& required = {});
Json any_of(const std::string& doc, const std::vector<Json>& options);
Json ref(const std::string& name);
/// The schema with a "default".
Json preset(Json schema, Json value);

}  // namespace calx::schema
