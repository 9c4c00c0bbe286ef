// Units: exponents, factors, conversions and the texts a user sees.
#include <doctest/doctest.h>

#include <string>

#include "base/error.hpp"
#include "base/units.hpp"

using namespace calx;

namespace {
std::string message(const std::string& unit) {
  try {
    parse_unit(unit);
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
    return e.what();
  }
  return "no error";
}
}  // namespace

TEST_CASE("a stiffness with a real power has the exponents of kg m^-0.5 s^-2") {
  const Unit u = parse_unit("N/m^1.5");
  CHECK(u.factor == 1);
  CHECK(u.exponent[0] == 1);
  CHECK(u.exponent[1] == doctest::Approx(-0.5));
  CHECK(u.exponent[2] == -2);
  CHECK(u.exponent[6] == 0);
}

TEST_CASE("spelling does not matter: spaces, stars, parentheses") {
  for (const char* text : {"J/(kg K)", "J/kg/K", "J kg^-1 K^-1", "J * kg^-1*K^-1", "m^2/(s^2 K)"})
    CHECK_MESSAGE(same_dimension(parse_unit(text), parse_unit("J/kg/K")), text);
  CHECK(same_dimension(parse_unit(""), parse_unit("1")));
  CHECK(same_dimension(parse_unit("1/s"), parse_unit("Hz")));
}

TEST_CASE("what process engineers write converts to SI") {
  struct Row {
    double value;
    const char *unit, *si;
    double result;
  };
  for (const Row& r : {Row{2.5, "mm", "m", 0.0025},
                       Row{3, "cm", "m", 0.03},
                       Row{40, "um", "m", 4e-5},
                       Row{5, "g", "kg", 0.005},
                       Row{1.5, "t", "kg", 1500},
                       Row{30, "rpm", "rad/s", 3.141592653589793},
                       Row{5, "kPa", "Pa", 5000},
                       Row{25, "MPa", "Pa", 2.5e7},
                       Row{210, "GPa", "N/m^2", 2.1e11},
                       Row{7, "mJ", "J", 0.007},
                       Row{2, "min", "s", 120},
                       Row{3, "ms", "s", 0.003},
                       Row{50, "Hz", "1/s", 50},
                       Row{2, "L", "m^3", 0.002},
                       Row{2.017, "g/cm^3", "kg/m^3", 2017},
                       Row{1, "kg/h", "kg/s", 1.0 / 3600},
                       Row{30, "%", "1", 0.3},
                       Row{180, "deg", "rad", 3.141592653589793},
                       Row{1, "rev/min", "rad/s", 0.10471975511965977},
                       Row{2, "mm^2", "m^2", 2e-6},
                       Row{4, "\xc2\xb5m", "m", 4e-6}})
    CHECK_MESSAGE(to_si(r.value, r.unit, r.si) == doctest::Approx(r.result).epsilon(1e-14), r.unit);
  CHECK(to_si(2.5, "mm", "m") == 0.0025);  // to the last bit, so that a case in mm equals the same case in m
  CHECK(to_si(0.3, "mm", "m") == 0.3e-3);
}

TEST_CASE("an unknown or ambiguous unit says what would be right") {
  CHECK(message("kPaa") == "unit \"kPaa\": \"kPaa\" is not known; did you mean \"kPa\"?");
  CHECK(message("J/kg K") ==
        "unit \"J/kg K\": a product after \"/\" can be read in two ways; write parentheses, as in J/(kg K)");
  CHECK(message("m^x") == "unit \"m^x\": a number must follow \"^\"");
  CHECK(message("(m") == "unit \"(m\": \")\" is missing");
  CHECK(message("m/") == "unit \"m/\": a unit is missing");
  CHECK(message("m)") == "unit \"m)\": \")\" is not expected here");
}

TEST_CASE("a unit of another dimension is refused, turns per second are not hertz") {
  CHECK_THROWS_WITH(to_si(1, "kg", "m"), "unit \"kg\" measures a mass; a length in m is needed");
  CHECK_THROWS_WITH(to_si(1, "Hz", "rad/s"), "unit \"Hz\" measures a frequency; an angular speed in rad/s is needed");
  CHECK_THROWS_WITH(to_si(1, "N/m", "N/m^1.5"), "unit \"N/m\" measures a stiffness; a quantity in N/m^1.5 is needed");
  CHECK_THROWS_WITH(to_si(1, "N/m^1.5", "N/m"),
                    "unit \"N/m^1.5\" measures a quantity in kg m^-0.5 s^-2; a stiffness in N/m is needed");
  CHECK_THROWS_WITH(to_si(1, "m", "1"), "unit \"m\" measures a length; a plain number is needed");
}

TEST_CASE("numbers print with the digits that read back") {
  CHECK(format_quantity(0.1, "m") == "0.1 m");
  CHECK(format_quantity(-2017, "kg/m^3") == "-2017 kg/m^3");
  CHECK(format_quantity(12, "1") == "12");
  CHECK(std::stod(format_number(0.1 + 0.2)) == 0.1 + 0.2);
}
