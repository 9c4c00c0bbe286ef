// flank.hpp: the slope of one flank of a pile from its profile.
#pragma once
#include <string>
#include <vector>

namespace calx {

struct Flank {
  double angle = 0;         // rad, positive where the pile falls away from its apex
  int bins = 0;             // used by the fit; 0: too little pile
  double level = 0;         // m, height of the line at the apex
  double from = 0, to = 0;  // m, middles of the first and the last bin used
};

/// heights: one per bin of width d outwards from the apex, NaN where nothing is, m. The flank ends where two empty bins
/// follow each other. Its height runs from its lowest bin to its highest; the least-squares line takes the bins between
/// 20 and 80 % of it, without the first 2 d and without the last 2 d before the toe, the first bin within d of the
/// lowest. No angle below a height of 5 d or with fewer than 3 bins.
Flank fit_flank(const std::vector<double>& heights, double d);

/// Why fit_flank finds no angle, as a sentence without its full stop; empty where it finds one.
std::string no_flank(const std::vector<double>& heights, double d);

/// The angle that a cone of the profile's volume on its base radius r has, atan(3 V / (pi r^3)), rad; of a wedge's
/// cross-section V, atan(2 V / r^2). It fits no flank, so it is a check on fit_flank. heights and d as there; V counts
/// above the toe, one d over the lowest bin, and r is where the profile crosses that height, so that a surface that is
/// lifted evenly keeps its angle. base: r in m. NaN where fit_flank finds too little pile to have a toe.
double volume_angle(const std::vector<double>& heights, double d, bool is_wedge, double& base);

/// The share of values below which the fraction lies, by linear interpolation between order statistics; sorts values.
double percentile(std::vector<double>& values, double fraction);

}  // namespace calx
