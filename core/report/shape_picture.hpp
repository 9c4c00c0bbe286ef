// shape_picture.hpp: a wall's surface seen from the front, the right and above, drawn as SVG by this library.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace calx {

/// Part frame, m; x to the right and backwards, z up. Faces seen from outside are blue, those seen from inside orange,
/// so that a wrong winding shows; the size stands below. triangles: three vertex numbers each, wound counter-clockwise
/// seen from outside; of more than 10000 every n-th is drawn. Empty for a shape without triangles.
std::string draw_shape(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& triangles);

}  // namespace calx
