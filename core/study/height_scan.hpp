// height_scan.hpp: a scanned surface, such as that of a laser over a pile, as a few numbers that carry its shape, and
// the same numbers of a sensor's height map. Private to study/.
#pragma once
#include <string>
#include <vector>

#include "study/study.hpp"

namespace calx {

/// Mean height, slopes along x and y, curvature along x, twist, curvature along y: coefficients of products of Legendre
/// polynomials up to the second degree in place, scaled so that the scanned rectangle is -1..1 each way. Each has the
/// unit of the heights and is at most what it raises the edge by.
constexpr std::size_t scan_modes = 6;

/// Least squares over the points given; z may hold NaN, which is left out. All NaN where fewer than half of the points,
/// or fewer than twice the modes, are left, or where they lie on lines.
std::vector<double> modes_of(const HeightScan& frame, const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z);

/// A sensor's map at the points of the scan, each the height of the cell it lies in, m; NaN over an empty cell. Throws
/// Error(Fault::files) for a folder without the map, Error(Fault::settings) where a point lies outside of it.
std::vector<double> heights_at(const std::string& folder, const StudyObservable& o);

}  // namespace calx
