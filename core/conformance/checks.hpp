// checks.hpp: the list of checks. A function that returns has passed; it throws Failed or Skipped. What it returns is
// told with the result. Private to core/conformance.
#pragma once
#include <string>
#include <vector>

#include "conformance/conformance.hpp"
#include "conformance/subject.hpp"

namespace calx::conformance {

struct Check {
  const char* name;
  const char* meaning;
  const char* kind;  // of the plugins it is for; "" each plugin, whatever its kind; null: once for each library
  bool random;       // draws inputs from the seed
  std::string (*run)(Subject&);
  bool compiles = false;  // compilers speak in it, which is no word of the plugin
};

std::vector<Check> library_checks();
std::vector<Check> table_checks();
std::vector<Check> life_checks();
std::vector<Check> text_checks();
std::vector<Check> law_checks();
std::vector<Check> law_energy_checks();
std::vector<Check> state_checks();
std::vector<Check> geometry_checks();
std::vector<Check> motion_checks();
std::vector<Check> force_checks();
std::vector<Check> sensor_checks();

/// Force over overlap, restitution over speed, tangential loop.
std::vector<CheckCurve> law_curves(Subject& subject);
/// Displacement and angle over time.
std::vector<CheckCurve> motion_curves(Subject& subject);
/// At most six configurations that look different.
std::vector<CheckShape> shapes(Subject& subject);

/// Uses the plugin once, whatever its kind: its main function is called.
void exercise(Subject& subject);

/// "1.3e-05".
std::string short_number(double value);

}  // namespace calx::conformance
