#include "study/height_scan.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/units.hpp"
#include "io/io.hpp"

namespace calx {
namespace {

using Json = nlohmann::json;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> modes_of(const HeightScan& frame, const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(z.size()), static_cast<Eigen::Index>(scan_modes));
  Eigen::VectorXd heights(basis.rows());
  Eigen::Index n = 0;
  for (std::size_t k = 0; k < z.size(); ++k) {
    if (!std::isfinite(z[k])) continue;
    const double u = (2 * x[k] - frame.low_x - frame.high_x) / (frame.high_x - frame.low_x);
    const double v = (2 * y[k] - frame.low_y - frame.high_y) / (frame.high_y - frame.low_y);
    basis.row(n) << 1, u, v, 0.5 * (3 * u * u - 1), u * v, 0.5 * (3 * v * v - 1);
    heights[n++] = z[k];
  }
  const auto modes = static_cast<Eigen::Index>(scan_modes);
  if (2 * n < basis.rows() || n < 2 * modes) return std::vector<double>(scan_modes, none);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(basis.topRows(n));
  if (solver.rank() < modes) return std::vector<double>(scan_modes, none);
  const Eigen::VectorXd found = solver.solve(heights.head(n));
  return {found.data(), found.data() + modes};
}

std::vector<double> heights_at(const std::string& folder, const StudyObservable& o) {
  const std::string path = folder + "/fields.json";
  const Json all = Json::parse(read_text(path), nullptr, false);
  if (all.is_discarded() || !all.is_object()) throw Error(Fault::files, path + ": is not valid JSON");
  for (const Json& field : all.value("fields", Json::array())) {
    if (field.value("sensor", "") != o.sensor || field.value("name", "") != o.column) continue;
    const double cell = field["cell"], left = field["origin"][0], front = field["origin"][1];
    const std::size_t nx = field["nx"], ny = field["ny"];
    const Json& values = field["values"];
    std::vector<double> out;
    for (std::size_t k = 0; k < o.scan.x.size(); ++k) {
      const double i = std::floor((o.scan.x[k] - left) / cell), j = std::floor((o.scan.y[k] - front) / cell);
      if (i < 0 || j < 0 || i >= static_cast<double>(nx) || j >= static_cast<double>(ny))
        throw Error(Fault::settings,
                    "observable \"" + o.name + "\": the scanned point (" + format_number(o.scan.x[k]) + ", " +
                        format_number(o.scan.y[k]) + ") m lies outside of the map of sensor \"" + o.sensor +
                        "\", which covers x from " + format_number(left) + " to " +
                        format_number(left + static_cast<double>(nx) * cell) + " m and y from " + format_number(front) +
                        " to " + format_number(front + static_cast<double>(ny) * cell) +
                        " m; cut the scan, or move it into the frame of the case");
      const Json& v = values[static_cast<std::size_t>(j) * nx + static_cast<std::size_t>(i)];
      out.push_back(v.is_number() ? v.get<double>() : none);
    }
    return out;
  }
  throw Error(Fault::files, path + ": sensor \"" + o.sensor + "\" has no field \"" + o.column + "\"");
}

}  // namespace calx
