// column_name.hpp: names of columns of series and of measured data, which end in their unit.
#pragma once
#include <string>

namespace calx {

struct ColumnName {
  std::string quantity;  // "density", "torque_x"
  std::string unit;      // as units.hpp reads it: "kg/m^3", "N m", "1"; empty when the name ends in none
};

/// "mass_kg" -> "mass", "kg"; "density_kg_m3" -> "density", "kg/m^3"; "torque_x_N_m" -> "torque_x", "N m". "min" and
/// "h" are units only where no other follows, for "min" also means a minimum.
ColumnName split_column(const std::string& column);

}  // namespace calx
