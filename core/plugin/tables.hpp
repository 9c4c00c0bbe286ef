// tables.hpp: does what a plugin hands over keep the contract? Field tables, descriptors, and the function table of
// every kind. Each check returns what is wrong as the rest of a sentence, or an empty text. For core/plugin and
// core/conformance.
#pragma once
#include <string>
#include <vector>

#include "calx/all.h"

namespace calx {

/// Kinds this host runs.
const std::vector<std::string>& known_kinds();

/// No table is longer than this; the engine's scratch has room for as many.
constexpr std::uint32_t field_limit = 64;

/// Count, pointer, names, units, ranges, finite presets, vector groups. users_write: users write these fields in a
/// case, so rows of a vector group must be called NAME_x, NAME_y, NAME_z.
std::string field_table_fault(const char* table, const calx_field* fields, std::uint32_t count, bool users_write);

/// Of this host, "1.0".
std::string abi_version();

std::string descriptor_fault(const calx_descriptor& descriptor);

/// Size, draft, functions and field tables of the table an instance returned for kind or for "calx.state/1".
std::string interface_fault(const std::string& kind, const void* table);

}  // namespace calx
