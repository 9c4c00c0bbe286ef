// svg.hpp: numbers and colours of pictures that this library draws as SVG.
#pragma once
#include <string>

namespace calx {

/// One digit after the point, in pixels: finer than a screen shows.
std::string svg_number(double pixels);
/// "#rrggbb"; each 0 to 255, rounded.
std::string svg_colour(double red, double green, double blue);

}  // namespace calx
