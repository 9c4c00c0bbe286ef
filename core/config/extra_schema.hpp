// extra_schema.hpp: the part of JSON Schema a plugin may use for what its parameter table cannot say. Private to this
// module. Known keywords: type, properties, required, additionalProperties, items, minItems, maxItems, enum, minimum,
// maximum, exclusiveMinimum, exclusiveMaximum, default, format ("path" makes text an absolute path), unit (a number or
// list of numbers in that SI unit; {"value", "unit"} and, for angles, the key with "_deg" are converted), and the
// annotations title, description, examples, $schema, $id, $comment.
#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"

namespace calx {

/// The schema as an object; {} for null. Throws Error(Fault::plugin) when it is not JSON or uses an unknown keyword.
Json parse_extra_schema(const char* text, const std::string& owner);

/// Keys of the user's object that the schema's properties take, "_deg" forms included.
std::vector<std::string> extra_keys(const Json& schema);

/// The value as the schema wants it: defaults filled in, units converted, paths absolute. Keys outside of "properties"
/// are left out at the top, where other tables own them, and refused deeper down.
Json read_extra(const Node& node, const Json& schema, const std::string& owner);

}  // namespace calx
