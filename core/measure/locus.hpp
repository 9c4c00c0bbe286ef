// locus.hpp: the arithmetic of shear testing: straight loci with their errors, and stress circles on them.
// Stresses in Pa, compression positive; angles in rad.
#pragma once
#include <vector>

namespace calx {

struct StressPoint {
  double normal = 0, shear = 0;  // Pa
};

/// shear = intercept + slope * normal by least squares, with standard errors from the scatter about the line.
struct Locus {
  int points = 0;
  double slope = 0, slope_error = 0;  // NaN: fewer than 2 points, or all at one normal stress; error: fewer than 3
  double intercept = 0, intercept_error = 0;  // Pa
  double angle() const;                       // rad, arctan of the slope
  double angle_error() const;                 // rad, to first order
};
Locus fit_locus(const std::vector<StressPoint>& points);

/// What a straight yield locus of cohesion c and angle phi says (Jenike 1964; ASTM D6128).
struct FlowProperties {
  double strength = 0;  // Pa, unconfined: the circle through the origin that touches the locus, 2 c cos/(1 - sin)
  double sigma1 = 0, sigma3 = 0;  // Pa, principal stresses of the circle that touches the locus and holds pre-shear
  double ffc = 0;                 // sigma1 / strength; NaN for a strength of 0 or less
  double effective_angle = 0;     // rad, of the line through the origin that touches that circle
  double steady_angle = 0;        // rad, of the line from the origin to pre-shear
};
/// Of the two circles that touch the locus and hold the point of pre-shear that one counts which touches at the smaller
/// normal stress. A point above the locus is on no such circle; then the circle nearest to it counts, whose centre
/// stands where both would fall together.
FlowProperties flow_properties(const Locus& locus, const StressPoint& pre_shear);

}  // namespace calx
