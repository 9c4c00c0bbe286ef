#include "config/tables.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/units.hpp"

namespace calx {

bool has_angle(const std::string& unit) { return parse_unit(unit).exponent[6] != 0; }

double from_degrees(double value, const std::string& unit) {
  const double pi = 3.141592653589793, power = parse_unit(unit).exponent[6];
  // value * pi / 180 keeps 180, 90, 45 exact multiples of pi.
  return power == 1 ? value * pi / 180 : value * std::pow(pi / 180, power);
}

std::string degree_unit(const std::string& unit) {
  std::string out = unit;
  const std::size_t at = out.find("rad");
  return at == std::string::npos ? out : out.replace(at, 3, "deg");
}

std::string range_text(double lowest, double highest, const std::string& unit) {
  const std::string in = unit.empty() || unit == "1" ? "" : " in " + unit;
  if (lowest <= -unbounded && highest >= unbounded) return "any number" + in;
  if (highest >= unbounded) return format_quantity(lowest, unit) + " or more";
  if (lowest <= -unbounded) return format_quantity(highest, unit) + " or less";
  return format_number(lowest) + " to " + format_quantity(highest, unit);
}

std::vector<TableEntry> table_entries(const FieldTable& table) {
  std::vector<TableEntry> out;
  for (std::uint32_t k = 0; k < table.count; ++k) {
    const calx_field& f = table.fields[k];
    TableEntry e;
    e.name = f.name;
    e.field = &f;
    e.first = k;
    const std::uint32_t group = (f.flags >> 8) & 255;
    if (group != 0) {
      const std::string base = e.name.size() > 2 ? e.name.substr(0, e.name.size() - 2) : "";
      for (std::uint32_t c = 0; c < 3; ++c)
        if (k + c >= table.count || table.fields[k + c].name != base + "_" + "xyz"[c] ||
            ((table.fields[k + c].flags >> 8) & 255) != group)
          throw Error(Fault::plugin, "the parameter table has \"" + e.name + "\" in a vector group; the rows must be " +
                                         base + "_x, " + base + "_y, " + base + "_z");
      e.name = base;
      e.rows = 3;
      k += 2;
    }
    if (f.flags & CALX_FIELD_CHOICE) {
      std::string name;
      for (const char* p = f.unit;; ++p) {
        if (*p != '|' && *p != '\0') {
          name += *p;
          continue;
        }
        e.choices.push_back(name);
        name.clear();
        if (*p == '\0') break;
      }
    } else {
      e.is_angle = has_angle(f.unit);
    }
    out.push_back(e);
  }
  return out;
}

std::vector<std::string> table_keys(const FieldTable& table) {
  std::vector<std::string> keys;
  for (const TableEntry& e : table_entries(table)) {
    keys.push_back(e.name);
    if (e.is_angle) keys.push_back(e.name + "_deg");
  }
  return keys;
}

}  // namespace calx
