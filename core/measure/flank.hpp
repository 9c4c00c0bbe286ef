// flank.hpp: the slope of one flank of a pile from its profile.
#pragma once
#include <vector>

namespace calx {

struct Flank {
  double angle = 0;  // rad, positive where the pile falls away from its apex
  int bins = 0;      // used by the fit; 0: too little pile
};

/// heights: one per bin of width d outwards from the apex, NaN where nothing is, m. The flank ends where two empty bins
/// follow each other. Its height runs from its lowest bin to its highest; the least-squares line takes the bins between
/// 20 and 80 % of it, without the first 2 d and without the last 2 d before the toe, the first bin within d of the
/// lowest. No angle below a height of 5 d or with fewer than 3 bins.
Flank fit_flank(const std::vector<double>& heights, double d);

/// The share of values below which the fraction lies, by linear interpolation between order statistics; sorts values.
double percentile(std::vector<double>& values, double fraction);

}  // namespace calx
