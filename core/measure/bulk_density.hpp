// bulk_density.hpp: the solid inside a region.
#pragma once
#include "measure/region_ref.hpp"

namespace calx {

struct Solid {
  double volume = 0, mass = 0;  // m^3, kg
};

/// Particles that the region's surface cuts count with the part inside, computed sphere by sphere (overlap.hpp). A
/// clump's volume, which counts overlaps of its members once, is shared out over the members by their volumes; so a cut
/// clump is exact on average, not one by one. Images across periodic faces count. [main]
Solid solid_in(const WorldView& world, const RegionRef& region);

}  // namespace calx
