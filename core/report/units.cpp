#include "report/units.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/column_name.hpp"

namespace calx {
namespace {

std::string with_spaces(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace

Quantity quantity_of(const std::string& column) {
  ColumnName name = split_column(column);
  // As readers write it: "kg/m3", and nothing for a count or a ratio.
  name.unit.erase(std::remove(name.unit.begin(), name.unit.end(), '^'), name.unit.end());
  return {with_spaces(name.quantity), name.unit == "1" ? "" : name.unit};
}

DisplayUnit display_unit(const std::string& unit, double largest) {
  const double a = std::fabs(largest);
  if (!(a > 0) || !std::isfinite(a)) return {unit, 1};
  if (unit == "kg") return a < 1e-4 ? DisplayUnit{"mg", 1e6} : a < 0.5 ? DisplayUnit{"g", 1e3} : DisplayUnit{"kg", 1};
  if (unit == "kg/s") return a < 0.5 ? DisplayUnit{"g/s", 1e3} : DisplayUnit{"kg/s", 1};
  if (unit == "m") return a < 1e-3 ? DisplayUnit{"um", 1e6} : a < 2 ? DisplayUnit{"mm", 1e3} : DisplayUnit{"m", 1};
  if (unit == "s") {
    return a < 1e-3 ? DisplayUnit{"us", 1e6} : a < 1 ? DisplayUnit{"ms", 1e3} : DisplayUnit{"s", 1};
  }
  if (unit == "J" || unit == "N" || unit == "N m" || unit == "W" || unit == "Pa") {
    if (a < 1e-3) return {unit == "N m" ? "uN m" : "u" + unit, 1e6};
    if (a < 1) return {unit == "N m" ? "mN m" : "m" + unit, 1e3};
    if (a >= 1e6) return {"M" + unit, 1e-6};
    if (a >= 1e4) return {"k" + unit, 1e-3};
  }
  return {unit, 1};
}

std::string format_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string format_count(double value) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.0f", value);
  std::string out = text;
  const std::size_t first = out[0] == '-' ? 1 : 0;
  for (std::size_t at = out.size(); at > first + 3;) {
    at -= 3;
    out.insert(at, "\xc2\xa0");
  }
  return out;
}

std::string format_quantity(double value, const std::string& si_unit, int digits) {
  if (!std::isfinite(value)) return "-";
  const DisplayUnit shown = display_unit(si_unit, value);
  const std::string number = format_number(value * shown.factor, digits);
  return shown.unit.empty() ? number : number + "\xc2\xa0" + shown.unit;
}

}  // namespace calx
