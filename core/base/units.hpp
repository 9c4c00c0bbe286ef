// units.hpp: units of measurement as exponents of kg, m, s, A, K, mol, rad and a factor to coherent SI.
// Angles keep a dimension of their own, so that rpm and Hz cannot be mixed up.
#pragma once
#include <array>
#include <string>

namespace calx {

struct Unit {
  std::array<double, 7> exponent{};  // kg m s A K mol rad
  double factor = 1;                 // value in SI = factor * value in this unit
};

/// Grammar: factors joined by a space, "*" or "/", each with an optional real power ("N/m^1.5"), parentheses for
/// groups ("J/(kg K)"), "1" or "" for none. Units: m g s A K mol rad Hz N Pa J W C V L, with prefixes n u m c d k M G;
/// without prefix t min h deg rev rpm bar %. "J/kg K" is refused as ambiguous.
/// Throws Error(Fault::settings): `unit "kPaa": "kPaa" is not known; did you mean "kPa"?`.
Unit parse_unit(const std::string& text);

bool same_dimension(const Unit& a, const Unit& b);

/// "length", "mass", "angular speed", ...; for others the SI unit it has: "quantity in kg/s^2.5"; "plain number" for
/// none.
std::string dimension_name(const Unit& unit);

/// Value converted to SI. Throws Error(Fault::settings) when unit is not of the dimension of si:
/// `unit "kg" measures a mass; a length in m is needed`.
double to_si(double value, const std::string& unit, const std::string& si);

/// "2.5 mm", "-0.3" for unit "1" or ""; the shortest digits that read back to the same number.
std::string format_quantity(double value, const std::string& unit);
std::string format_number(double value);
/// Four digits, for lines people read: "0.2201 kg".
std::string brief_quantity(double value, const std::string& unit);

}  // namespace calx
