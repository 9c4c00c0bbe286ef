#include "base/column_name.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace calx {
namespace {

// "kg" of a token "kg", "m^3" of "m3"; empty when it is no unit.
std::string unit_of_token(const std::string& token, bool alone) {
  static const char* const known[] = {"kg", "g",   "mg",  "t",   "m",   "mm", "cm", "um",  "s",   "ms",
                                      "N",  "mN",  "kN",  "J",   "W",   "K",  "Pa", "kPa", "MPa", "bar",
                                      "Hz", "deg", "rad", "rev", "rpm", "mL", "L",  "1"};
  if (token == "percent") return "%";
  if (alone && (token == "min" || token == "h")) return token;
  std::string base = token, power;
  if (base.size() > 1 && (base.back() == '2' || base.back() == '3')) power = base.back(), base.pop_back();
  if (std::find(std::begin(known), std::end(known), base) == std::end(known)) return "";
  return power.empty() ? base : base + "^" + power;
}

std::string joined(const std::vector<std::string>& units) {
  if (units.empty()) return "";
  if (units.size() == 1) return units[0];
  // A moment and an impulse are products, everything else a quotient: kg_m2_s is kg/(m^2 s).
  if (units[0] == "N" && units.size() == 2 && (units[1] == "m" || units[1] == "s")) return units[0] + " " + units[1];
  std::string below;
  for (std::size_t k = 1; k < units.size(); ++k) below += (k > 1 ? " " : "") + units[k];
  return units[0] + (units.size() > 2 ? "/(" + below + ")" : "/" + below);
}

}  // namespace

ColumnName split_column(const std::string& column) {
  ColumnName out{column, ""};
  std::vector<std::string> units;
  for (;;) {
    const std::size_t at = out.quantity.rfind('_');
    if (at == std::string::npos) break;
    const std::string unit = unit_of_token(out.quantity.substr(at + 1), units.empty());
    if (unit.empty()) break;
    units.insert(units.begin(), unit);
    out.quantity.resize(at);
  }
  out.unit = joined(units);
  return out;
}

}  // namespace calx
