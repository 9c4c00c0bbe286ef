// tables.hpp: rows of a parameter table grouped as users write them: a number, a choice, or a vector of three rows.
// Private to this module.
#pragma once
#include <string>
#include <vector>

#include "config/config.hpp"

namespace calx {

struct TableEntry {
  std::string name;                  // the key: "stroke"; "base" for base_x, base_y, base_z
  const calx_field* field;           // the first row
  std::uint32_t first = 0;           // its index
  std::uint32_t rows = 1;            // 3 for a vector
  std::vector<std::string> choices;  // names of a choice, else empty
  bool is_angle = false;             // may also be given as name_deg
};

std::vector<TableEntry> table_entries(const FieldTable& table);

/// Whether radians stand in the unit.
bool has_angle(const std::string& unit);
/// A value given in degrees, in the unit with radians.
double from_degrees(double value, const std::string& unit);
/// The unit with "deg" for "rad".
std::string degree_unit(const std::string& unit);

/// "0 to 1 m", "0 m or more", "any number in m".
std::string range_text(double lowest, double highest, const std::string& unit);

/// Bounds at or beyond this are no bounds.
constexpr double unbounded = 1e300;

}  // namespace calx
