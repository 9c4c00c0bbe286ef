#include "report/lab_figures.hpp"

#include <cmath>
#include <limits>

#include "report/key_figures.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const std::string plus_minus = " \xc2\xb1 ", degree = "\xc2\xb0";

std::string angle(double value, double error) {
  return format_number(value, 3) + (std::isfinite(error) ? plus_minus + format_number(error, 2) : "") + degree;
}

/// Name and value of the figure; the value is empty where it is not a number.
LabFigure figure_of(const SensorSeries& s) {
  const auto value = [&](const char* column) { return last_row(s, column); };
  const auto known = [&](const char* column) { return std::isfinite(value(column)); };
  LabFigure out;
  if (s.kind == "bulk-density") {
    out.name = "bulk density";
    if (known("density_kg_m3")) out.value = format_quantity(value("density_kg_m3"), "kg/m\xc2\xb3", 4);
    out.note = "solid fraction " + format_number(value("solid_fraction_1"), 3);
  } else if (s.kind == "angle-of-repose") {
    out.name = "angle of repose";
    if (known("angle_deg")) out.value = angle(value("angle_deg"), value("sd_deg"));
    out.note = "sd of " + format_number(value("sectors_1")) + " sectors";
  } else if (s.kind == "drum-surface") {
    out.name = "dynamic angle";
    if (known("angle_deg")) out.value = angle(value("angle_deg"), std::numeric_limits<double>::quiet_NaN());
    out.note = "wider part " + angle(value("far_deg"), std::numeric_limits<double>::quiet_NaN());
  } else if (s.kind == "discharge") {
    out.name = "discharge rate";
    if (known("rate_kg_s"))
      out.value = format_quantity(value("rate_kg_s"), "kg/s", 3) + plus_minus +
                  format_quantity(value("rate_sd_kg_s"), "kg/s", 2);
    out.note = format_number(value("ratio_1"), 3) + " of Beverloo's estimate";
  } else if (s.kind == "cell-density") {
    out.name = known("stress_Pa") ? "compressibility" : "tapped density";
    const int step = s.column("step_1"), cps = s.column("cps_percent"), stress = s.column("stress_Pa");
    if (known("stress_Pa") && cps >= 0) {
      const auto& stresses = s.values[static_cast<std::size_t>(stress)];
      std::size_t top = 0;
      for (std::size_t k = 0; k < stresses.size(); ++k)
        if (!(stresses[k] <= stresses[top])) top = std::isfinite(stresses[k]) ? k : top;
      out.value = format_number(s.values[static_cast<std::size_t>(cps)][top], 3) + "\xc2\xa0%";
      out.note = "at " + format_quantity(stresses[top], "Pa", 4);
    } else if (known("density_kg_m3") && step >= 0) {
      out.value = format_quantity(value("density_kg_m3"), "kg/m\xc2\xb3", 4);
      out.note = "after " + format_number(value("step_1")) + " taps";
    }
  } else if (s.kind == "wall-friction") {
    out.name = "angle of wall friction";
    if (known("phi_w_deg")) out.value = angle(value("phi_w_deg"), value("phi_w_se_deg"));
    out.note = "standard error of the line";
  } else if (s.kind == "yield-locus") {
    out.name = "internal friction";
    if (known("phi_deg")) out.value = angle(value("phi_deg"), value("phi_se_deg"));
    out.note = "cohesion " + format_quantity(value("cohesion_Pa"), "Pa", 3);
  }
  return out;
}

}  // namespace

std::vector<LabFigure> lab_figures(const RunFolder& run) {
  std::vector<LabFigure> out;
  for (const SensorSeries& s : run.sensors) {
    LabFigure figure = figure_of(s);
    if (figure.name.empty()) continue;
    if (figure.value.empty()) {
      figure.value = "none";
      figure.note = s.reason.empty() ? "no number yet" : s.reason;
    }
    if (s.name != figure.name) figure.note = s.name + ": " + figure.note;
    out.push_back(figure);
  }
  return out;
}

}  // namespace calx
