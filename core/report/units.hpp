// units.hpp: names that end in their unit ("mass_kg", "torque_N_m") taken apart, and readable prefixes (g, mm, kPa).
#pragma once
#include <string>

namespace calx {

struct Quantity {
  std::string title;  // "mass", "torque", underscores replaced by spaces
  std::string unit;   // "kg", "N m", "kg/s"; empty for counts and ratios
};
Quantity quantity_of(const std::string& column);

/// factor * value in SI = value in unit. largest: the largest magnitude to be shown, in SI.
struct DisplayUnit {
  std::string unit;
  double factor = 1;
};
DisplayUnit display_unit(const std::string& si_unit, double largest);

/// Plain text with that many significant digits, no trailing zeros, powers of ten as "2.5e-06".
std::string format_number(double value, int digits = 5);
/// "133 000": thousands apart by a no-break space (UTF-8).
std::string format_count(double value);
/// "2.183 kg", "54.9 g": value in SI with the prefix that suits it; "-" when it is not finite.
std::string format_quantity(double value, const std::string& si_unit, int digits = 4);

}  // namespace calx
