#include "report/svg.hpp"

#include <cmath>
#include <cstdio>

namespace calx {

std::string svg_number(double pixels) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", pixels);
  return text;
}

std::string svg_colour(double red, double green, double blue) {
  char text[8];
  const auto byte = [](double v) { return static_cast<unsigned>(std::lround(v)) & 255; };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(red), byte(green), byte(blue));
  return text;
}

}  // namespace calx
