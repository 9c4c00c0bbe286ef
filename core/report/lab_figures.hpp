// lab_figures.hpp: the figures a powder laboratory would write down first, from the last rows of a rig's sensors.
#pragma once
#include <string>
#include <vector>

#include "report/run_folder.hpp"

namespace calx {

/// Plain text: "angle of repose", "27.2 +- 2.6 deg" with its signs, "sd of 12 sectors".
struct LabFigure {
  std::string name, value, note;
};

/// One for each sensor of a kind that a laboratory has a figure for, in the order of the sensors; the note names the
/// sensor unless it is called as the figure is. "none" with its reason where the last figure is not a number.
std::vector<LabFigure> lab_figures(const RunFolder& run);

}  // namespace calx
