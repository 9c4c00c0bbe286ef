// chart_svg.hpp: xy charts side by side as one still SVG picture, for READMEs; pages draw their charts in the browser.
#pragma once
#include <string>
#include <vector>

#include "report/chart.hpp"

namespace calx {

/// Lines and points of Kind::xy charts, 320 x 250 units each; legends, titles and units are drawn, captions, marks,
/// bands and error bars are not. title: a line above, may be empty. Points closer together than a pen's width are left
/// out, so a picture of three charts has some 10 kB.
std::string charts_svg(const std::string& title, const std::vector<Chart>& charts);

}  // namespace calx
