// overlap.hpp: how much of a sphere lies inside a region.
#pragma once
#include "config/settings.hpp"

namespace calx {

/// Volume of the sphere's part inside the region as the case draws it, m^3. Closed form for a sphere wholly inside a
/// box and for a spherical region; else one-dimensional Gauss quadrature over exact slice areas, relative error of the
/// sphere's volume below 1e-9 for a box and a cylinder, below 1e-8 for a cone.
double overlap_volume(const RegionSettings& region, const Vec3& centre, double radius);

}  // namespace calx
