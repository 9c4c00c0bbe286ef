#include "base/units.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/error.hpp"
#include "base/nearest.hpp"

namespace calx {
namespace {

const double pi = 3.141592653589793;

struct Symbol {
  const char* name;
  double factor;
  double e[7];  // kg m s A K mol rad
  bool prefixes;
};

const Symbol symbols[] = {
    {"m", 1, {0, 1, 0, 0, 0, 0, 0}, true},
    {"g", 1e-3, {1, 0, 0, 0, 0, 0, 0}, true},
    {"s", 1, {0, 0, 1, 0, 0, 0, 0}, true},
    {"A", 1, {0, 0, 0, 1, 0, 0, 0}, true},
    {"K", 1, {0, 0, 0, 0, 1, 0, 0}, true},
    {"mol", 1, {0, 0, 0, 0, 0, 1, 0}, true},
    {"rad", 1, {0, 0, 0, 0, 0, 0, 1}, true},
    {"Hz", 1, {0, 0, -1, 0, 0, 0, 0}, true},
    {"N", 1, {1, 1, -2, 0, 0, 0, 0}, true},
    {"Pa", 1, {1, -1, -2, 0, 0, 0, 0}, true},
    {"J", 1, {1, 2, -2, 0, 0, 0, 0}, true},
    {"W", 1, {1, 2, -3, 0, 0, 0, 0}, true},
    {"C", 1, {0, 0, 1, 1, 0, 0, 0}, true},
    {"V", 1, {1, 2, -3, -1, 0, 0, 0}, true},
    {"L", 1e-3, {0, 3, 0, 0, 0, 0, 0}, true},
    {"t", 1000, {1, 0, 0, 0, 0, 0, 0}, false},
    {"min", 60, {0, 0, 1, 0, 0, 0, 0}, false},
    {"h", 3600, {0, 0, 1, 0, 0, 0, 0}, false},
    {"deg", pi / 180, {0, 0, 0, 0, 0, 0, 1}, false},
    {"rev", 2 * pi, {0, 0, 0, 0, 0, 0, 1}, false},
    {"rpm", 2 * pi / 60, {0, 0, -1, 0, 0, 0, 1}, false},
    {"bar", 1e5, {1, -1, -2, 0, 0, 0, 0}, true},
    {"%", 0.01, {0, 0, 0, 0, 0, 0, 0}, false},
};

struct Prefix {
  char name;
  double factor;
};
const Prefix prefixes[] = {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2},
                           {'d', 1e-1}, {'k', 1e3},  {'M', 1e6},  {'G', 1e9}};

std::vector<std::string> known_symbols() {
  std::vector<std::string> names;
  for (const Symbol& s : symbols) names.push_back(s.name);
  for (const char* often :
       {"kg", "mm", "cm", "um", "km", "ms", "kN", "mN", "kPa", "MPa", "GPa", "mJ", "kJ", "kW", "mL", "mg"})
    names.push_back(often);
  return names;
}

Unit unit_of(const Symbol& s, double scale) {
  Unit u;
  u.factor = s.factor * scale;
  for (int k = 0; k < 7; ++k) u.exponent[k] = s.e[k];
  return u;
}

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}
  Unit all() {
    skip();
    if (at_ == text_.size()) return {};
    const Unit u = product();
    if (at_ != text_.size()) fail("\"" + text_.substr(at_, 1) + "\" is not expected here");
    return u;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(Fault::settings, "unit \"" + text_ + "\": " + why);
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  Unit product() {
    Unit u = power();
    bool divided = false;
    for (;;) {
      skip();
      const char c = peek();
      if (c == '\0' || c == ')') return u;
      const bool divide = c == '/';
      if (divide || c == '*') ++at_, skip();
      if (!divide && divided) fail("a product after \"/\" can be read in two ways; write parentheses, as in J/(kg K)");
      multiply(u, power(), divide ? -1 : 1);
      divided = divided || divide;
    }
  }

  Unit power() {
    Unit u = factor();
    skip();
    if (peek() != '^') return u;
    ++at_;
    skip();
    const char* begin = text_.data() + at_;
    double e = 0;
    const auto r = std::from_chars(begin, text_.data() + text_.size(), e);
    if (r.ec != std::errc()) fail("a number must follow \"^\"");
    at_ += static_cast<std::size_t>(r.ptr - begin);
    for (double& x : u.exponent) x *= e;
    u.factor = std::pow(u.factor, e);
    return u;
  }

  Unit factor() {
    if (peek() == '(') {
      ++at_;
      skip();
      const Unit u = product();
      if (peek() != ')') fail("\")\" is missing");
      ++at_;
      return u;
    }
    if (peek() == '1') return ++at_, Unit{};
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::string(" */^()").find(text_[at_]) == std::string::npos) ++at_;
    return symbol(text_.substr(begin, at_ - begin));
  }

  Unit symbol(std::string name) const {
    if (name.empty()) fail("a unit is missing");
    // The micro sign and the Greek letter mu, as UTF-8.
    if (name.size() > 2 && (name.compare(0, 2, "\xc2\xb5") == 0 || name.compare(0, 2, "\xce\xbc") == 0))
      name.replace(0, 2, "u");
    for (const Symbol& s : symbols)
      if (name == s.name) return unit_of(s, 1);
    for (const Symbol& s : symbols)
      for (const Prefix& p : prefixes)
        if (s.prefixes && name == p.name + std::string(s.name)) return unit_of(s, p.factor);
    fail("\"" + name + "\" is not known; " + did_you_mean(name, known_symbols()));
  }

  static void multiply(Unit& u, const Unit& by, int sign) {
    for (int k = 0; k < 7; ++k) u.exponent[k] += sign * by.exponent[k];
    u.factor = sign > 0 ? u.factor * by.factor : u.factor / by.factor;
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

Unit parse_unit(const std::string& text) { return Parser(text).all(); }

bool same_dimension(const Unit& a, const Unit& b) {
  for (int k = 0; k < 7; ++k)
    if (std::abs(a.exponent[k] - b.exponent[k]) > 1e-9) return false;
  return true;
}

std::string format_number(double value) {
  char buffer[40];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, r.ptr);
}

std::string format_quantity(double value, const std::string& unit) {
  return format_number(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

std::string dimension_name(const Unit& unit) {
  static const struct {
    const char *unit, *name;
  } names[] = {{"1", "plain number"},
               {"m", "length"},
               {"kg", "mass"},
               {"s", "time"},
               {"rad", "angle"},
               {"m^2", "area"},
               {"m^3", "volume"},
               {"m/s", "speed"},
               {"m/s^2", "acceleration"},
               {"rad/s", "angular speed"},
               {"rad/s^2", "angular acceleration"},
               {"1/s", "frequency"},
               {"kg/m^3", "density"},
               {"kg/s", "mass flow"},
               {"N", "force"},
               {"N/m", "stiffness"},
               {"Pa", "pressure"},
               {"J", "energy"},
               {"W", "power"},
               {"K", "temperature"},
               {"A", "electric current"},
               {"C", "electric charge"},
               {"V", "voltage"},
               {"mol", "amount of substance"},
               {"m^3/s", "volume flow"},
               {"Pa s", "viscosity"}};
  for (const auto& n : names)
    if (same_dimension(unit, parse_unit(n.unit))) return n.name;
  static const char* const base[7] = {"kg", "m", "s", "A", "K", "mol", "rad"};
  std::string text;
  for (int k = 0; k < 7; ++k) {
    if (unit.exponent[k] == 0) continue;
    text += (text.empty() ? "" : " ") + std::string(base[k]);
    if (unit.exponent[k] != 1) text += "^" + format_number(unit.exponent[k]);
  }
  return "quantity in " + text;
}

double to_si(double value, const std::string& unit, const std::string& si) {
  const Unit from = parse_unit(unit), to = parse_unit(si);
  if (!same_dimension(from, to)) {
    const auto noun = [](const Unit& u, const std::string& text) {
      const std::string name = dimension_name(u);
      if (name.compare(0, 8, "quantity") == 0) return "a quantity in " + (text.empty() ? name.substr(12) : text);
      return (std::string("aeiou").find(name[0]) == std::string::npos ? "a " : "an ") + name +
             (text.empty() || text == "1" ? "" : " in " + text);
    };
    throw Error(Fault::settings,
                "unit \"" + unit + "\" measures " + noun(from, "") + "; " + noun(to, si) + " is needed");
  }
  // One rounding instead of two where the factor is a negative power of ten: 2.5 mm is 0.0025 to the last bit.
  const double inverse = to.factor / from.factor;
  if (inverse > 1 && inverse == std::floor(inverse)) return value / inverse;
  return value * (from.factor / to.factor);
}

std::string brief_quantity(double value, const std::string& unit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return unit.empty() || unit == "1" ? text : std::string(text) + " " + unit;
}

}  // namespace calx
