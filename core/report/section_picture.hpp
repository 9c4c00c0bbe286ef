// section_picture.hpp: the apparatus cut open, drawn as SVG by this library, so that it prints and needs no script.
#pragma once
#include <string>

#include "report/run_folder.hpp"

namespace calx {

struct SectionPicture {
  std::string svg;  // an svg element; empty when there is nothing to draw
  std::size_t spheres = 0;
};

/// The plane stands along gravity through the middle of the parts, seen along its normal (for gravity along -z: seen
/// along +y, x to the right). Spheres whose centres lie less than one largest diameter behind the plane are drawn,
/// coloured by speed up to highest_speed, m/s; parts as the lines in which the plane cuts them.
SectionPicture draw_section(const FrameSet& set, const FrameData& frame, const Vec3& gravity, double highest_speed);

/// "#rrggbb" of a share 0..1 on the page's speed scale (the same anchors as in viewer.js).
std::string speed_colour(double share);

}  // namespace calx
