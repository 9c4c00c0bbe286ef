#include "report/units.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace calx {
namespace {

struct Suffix {
  const char *ending, *unit;
};
// Longest first, so that "kg_m3" is not read as a "m3".
const std::vector<Suffix>& suffixes() {
  static const std::vector<Suffix> table = {{"_kg_m2_s", "kg/(m2 s)"},
                                            {"_rad_s", "rad/s"},
                                            {"_kg_m3", "kg/m3"},
                                            {"_kg_s", "kg/s"},
                                            {"_m_s2", "m/s2"},
                                            {"_1_s", "1/s"},
                                            {"_m_s", "m/s"},
                                            {"_N_m", "N m"},
                                            {"_Nm", "N m"},
                                            {"_N_s", "N s"},
                                            {"_deg_s", "deg/s"},
                                            {"_percent", "%"},
                                            {"_deg", "deg"},
                                            {"_rad", "rad"},
                                            {"_kPa", "kPa"},
                                            {"_Pa", "Pa"},
                                            {"_m3", "m3"},
                                            {"_m2", "m2"},
                                            {"_mm", "mm"},
                                            {"_kg", "kg"},
                                            {"_Hz", "Hz"},
                                            {"_g", "g"},
                                            {"_m", "m"},
                                            {"_s", "s"},
                                            {"_N", "N"},
                                            {"_J", "J"},
                                            {"_W", "W"},
                                            {"_K", "K"},
                                            {"_1", ""}};
  return table;
}

std::string with_spaces(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace

Quantity quantity_of(const std::string& column) {
  for (const Suffix& s : suffixes()) {
    const std::string ending = s.ending;
    if (column.size() > ending.size() && column.compare(column.size() - ending.size(), ending.size(), ending) == 0) {
      return {with_spaces(column.substr(0, column.size() - ending.size())), s.unit};
    }
  }
  return {with_spaces(column), ""};
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
