// assets.hpp: the browser libraries and the page's own style and scripts, as bytes of this library (see report.cmake).
// About 1.1 MB of three.js (MIT licence), 0.24 MB of D3 (BSD 3-clause) and 40 kB of our own.
#pragma once
#include <string_view>

namespace calx {

std::string_view asset_three();
std::string_view asset_orbit();
std::string_view asset_d3();
std::string_view asset_style();
std::string_view asset_charts();
std::string_view asset_viewer();

}  // namespace calx
