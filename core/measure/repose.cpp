// repose.cpp: kind "angle-of-repose": flank angles of a pile ("shape": "cone", preset) or of a wedge ("wedge").
//
// Keys: "region", "shape", "sectors" (8 to 12; 8; a wedge has fewer slices where they would be narrower than d),
// "centre"
// ([x, y] of the apex, m; found when left out), "direction" (of a wedge: the horizontal direction across its ridge;
// [1, 0, 0]).
// One d is the median sphere diameter in the region. The surface is the highest sphere point of each cell of d/4. Cone:
// sectors of azimuth about the apex, which is the centroid of the surface above 80 % of its height, and bins of radius;
// wedge: slices along the ridge, and bins of distance from the ridge, the highest bin across the whole width. Bins are
// one d wide and hold the 95th percentile of their cells; the angle of each sector comes from fit_flank (flank.hpp).
// The 95th percentile and the envelope lift the surface by nearly the same everywhere, which leaves the angle alone;
// where the slope changes with azimuth they follow the flattest part of a sector, so that a leaning pile reads low.
//
// Columns: angle_deg and sd_deg over all sectors, left_deg, left_sd_deg, right_deg, right_sd_deg of those whose middle
// lies towards -direction and +direction, sectors_1 and bins_1 that gave an angle, apex_x_m, apex_y_m, apex_z_m. Never
// quote an angle finer than its sd. NaN, with a reason, when fewer than half of the sectors (of a side: none) show a
// flank.
// volume_angle_deg is an independent check that fits no flank: the angle of a cone of the same volume and base, or of a
// wedge of the same cross-section (flank.hpp), from the profile; base_m is the radius, or the length, of that base. A
// rounded apex and a flat toe make it read low. NaN for a ridge, which has two flanks.
//
// Curves: "profile", radius or distance (negative to the left) against height, over all azimuths or the whole width;
// "flank" (of a wedge: "flank left", "flank right"), the line of fit_flank through the profile; "sectors", the azimuth
// of each sector's middle (deg, 0 along the direction) or its place along the ridge (m; left flanks, then right ones)
// against its angle.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/flank.hpp"
#include "measure/height_map.hpp"
#include "measure/kinds.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

struct Cell {
  double x, y, z;
};

struct Angles {
  std::vector<double> values;  // deg
  int bins = 0;
  void add(const Flank& flank) {
    if (flank.bins == 0) return;
    values.push_back(flank.angle * 180 / pi);
    bins += flank.bins;
  }
  double mean() const {
    double sum = 0;
    for (double v : values) sum += v;
    return values.empty() ? nan : sum / static_cast<double>(values.size());
  }
  double sd() const {
    if (values.size() < 2) return nan;
    double sum = 0;
    for (double v : values) sum += (v - mean()) * (v - mean());
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
  }
};

class Bins {
 public:
  void add(double distance, double height, double d) {
    const std::size_t k = static_cast<std::size_t>(distance / d);
    if (k >= cells_.size()) cells_.resize(k + 1);
    cells_[k].push_back(height);
  }
  std::vector<double> heights() {
    std::vector<double> result;
    for (std::vector<double>& cell : cells_) result.push_back(cell.empty() ? nan : percentile(cell, 0.95));
    return result;
  }

 private:
  std::vector<std::vector<double>> cells_;
};

class ReposeSensor : public Sensor {
 public:
  ReposeSensor(const RegionSettings& region, bool is_wedge, std::size_t sectors, bool has_centre, const Vec3& centre,
               const Vec3& direction)
      : region_(&region),
        is_wedge_(is_wedge),
        sectors_(sectors),
        has_centre_(has_centre),
        centre_(centre),
        direction_(direction) {}
  std::vector<std::string> columns() const override {
    return {"angle_deg", "sd_deg",   "left_deg", "left_sd_deg", "right_deg",        "right_sd_deg", "sectors_1",
            "bins_1",    "apex_x_m", "apex_y_m", "apex_z_m",    "volume_angle_deg", "base_m"};
  }

  std::vector<double> sample(const WorldView& world) override {
    profile_ = {"profile", is_wedge_ ? "distance_m" : "radius_m", "height_m", {}, {}};
    each_ = {"sectors", is_wedge_ ? "across_m" : "azimuth_deg", "angle_deg", {}, {}};
    lines_.clear();
    reason_.clear();
    volume_angle_ = base_ = nan;
    const std::vector<const Record*> spheres = spheres_in(world, region_);
    std::vector<double> row(columns().size(), nan);
    row[6] = row[7] = 0;
    if (spheres.empty()) {
      reason_ = "no particle is in the region";
      return row;
    }
    std::vector<double> diameters;
    for (const Record* sphere : spheres) diameters.push_back(2 * sphere->r);
    d_ = percentile(diameters, 0.5);
    const std::vector<Cell> cells = surface_of(spheres);
    const Vec3 apex = is_wedge_ ? ridge_of(cells) : apex_of(cells);

    Angles all, left, right;
    std::size_t possible = sectors_;
    if (is_wedge_) {
      possible = measure_wedge(cells, apex, left, right);
      all = left;
      all.values.insert(all.values.end(), right.values.begin(), right.values.end());
      all.bins += right.bins;
    } else {
      measure_cone(cells, apex, all, left, right);
    }
    row[6] = static_cast<double>(all.values.size());
    row[7] = all.bins;
    if (2 * all.values.size() < possible) {
      if (reason_.empty())
        reason_ = "a flank shows in " + std::to_string(all.values.size()) + " of " + std::to_string(possible) +
                  (is_wedge_ ? " slices" : " sectors") + " only; half are needed";
      return row;
    }
    reason_.clear();
    return {all.mean(), all.sd(), left.mean(), left.sd(), right.mean(),  right.sd(), row[6],
            row[7],     apex.x,   apex.y,      apex.z,    volume_angle_, base_};
  }

  std::string reason() const override { return reason_; }

  std::vector<CurveResult> curves() const override {
    std::vector<CurveResult> all{profile_, each_};
    all.insert(all.end(), lines_.begin(), lines_.end());
    return all;
  }

 private:
  std::vector<Cell> surface_of(const std::vector<const Record*>& spheres) const {
    Box box;
    for (const Record* sphere : spheres) {
      const Vec3 reach{sphere->r, sphere->r, 0};
      box.add(position(*sphere) - reach);
      box.add(position(*sphere) + reach);
    }
    // A quarter of a diameter, so that bins near the apex hold enough cells; coarser only where the map would not fit
    // into memory.
    const double area = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y);
    const double cell = std::max(d_ / 4, std::sqrt(area / static_cast<double>(HeightMap::most_cells)));
    HeightMap map(box.lo, box.hi, cell);
    for (const Record* sphere : spheres) map.add(*sphere);
    std::vector<Cell> cells;
    for (std::size_t j = 0; j < map.ny(); ++j)
      for (std::size_t i = 0; i < map.nx(); ++i)
        if (!std::isnan(map.at(i, j))) cells.push_back({map.x(i), map.y(j), map.at(i, j)});
    return cells;
  }

  /// Lowest and, against single grains thrown up, 99.9th percentile of the heights.
  static void height_range(const std::vector<Cell>& cells, double& low, double& high) {
    std::vector<double> heights;
    for (const Cell& cell : cells) heights.push_back(cell.z);
    high = percentile(heights, 0.999);
    low = heights.front();
  }

  Vec3 apex_of(const std::vector<Cell>& cells) const {
    double low = 0, high = 0, n = 0;
    height_range(cells, low, high);
    Vec3 apex{0, 0, high};
    for (const Cell& cell : cells)
      if (cell.z >= low + 0.8 * (high - low)) n += 1, apex.x += cell.x, apex.y += cell.y;
    if (has_centre_) return {centre_.x, centre_.y, high};
    return {apex.x / n, apex.y / n, high};
  }

  Vec3 ridge_of(const std::vector<Cell>& cells) const {
    double low = 1e300, low_y = 1e300, high_y = -1e300;
    for (const Cell& cell : cells) {
      low = std::min(low, along(cell, {}));
      low_y = std::min(low_y, across(cell, {}));
      high_y = std::max(high_y, across(cell, {}));
    }
    Bins bins;
    for (const Cell& cell : cells) bins.add(along(cell, {}) - low, cell.z, d_);
    const std::vector<double> heights = bins.heights();
    std::size_t top = 0;
    for (std::size_t k = 0; k < heights.size(); ++k)
      if (heights[k] > heights[top] || std::isnan(heights[top])) top = k;
    const double a = low + (static_cast<double>(top) + 0.5) * d_, b = 0.5 * (low_y + high_y);
    if (has_centre_) return {centre_.x, centre_.y, heights[top]};
    return Vec3{a * direction_.x - b * direction_.y, a * direction_.y + b * direction_.x, heights[top]};
  }

  double along(const Cell& cell, const Vec3& from) const {
    return (cell.x - from.x) * direction_.x + (cell.y - from.y) * direction_.y;
  }
  double across(const Cell& cell, const Vec3& from) const {
    return -(cell.x - from.x) * direction_.y + (cell.y - from.y) * direction_.x;
  }

  void measure_cone(const std::vector<Cell>& cells, const Vec3& apex, Angles& all, Angles& left, Angles& right) {
    std::vector<Bins> sector(sectors_);
    Bins whole;
    const double count = static_cast<double>(sectors_);
    for (const Cell& cell : cells) {
      const double a = along(cell, apex), b = across(cell, apex), radius = std::sqrt(a * a + b * b);
      const double turn = (std::atan2(b, a) + pi) / (2 * pi);
      sector[std::min(sectors_ - 1, static_cast<std::size_t>(turn * count))].add(radius, cell.z, d_);
      whole.add(radius, cell.z, d_);
    }
    for (std::size_t s = 0; s < sectors_; ++s) {
      const Flank flank = fit_flank(sector[s].heights(), d_);
      const double side = std::cos((static_cast<double>(s) + 0.5) / count * 2 * pi - pi);
      all.add(flank);
      add_sector((static_cast<double>(s) + 0.5) / count * 360 - 180, flank);
      if (side < -1e-9) left.add(flank);
      if (side > 1e-9) right.add(flank);
    }
    const std::vector<double> heights = whole.heights();
    reason_ = no_flank(heights, d_);
    append_profile(heights, 1);
    add_line("flank", heights, 1);
    volume_angle_ = volume_angle(heights, d_, false, base_) * 180 / pi;
  }

  /// Gives the number of slices.
  std::size_t measure_wedge(const std::vector<Cell>& cells, const Vec3& apex, Angles& left, Angles& right) {
    double low = 1e300, high = -1e300;
    for (const Cell& cell : cells) {
      low = std::min(low, across(cell, apex));
      high = std::max(high, across(cell, apex));
    }
    // A slice narrower than a grain shows single grains, not a surface.
    const std::size_t count = std::min(sectors_, std::max<std::size_t>(1, static_cast<std::size_t>((high - low) / d_)));
    std::vector<Bins> slices[2] = {std::vector<Bins>(count), std::vector<Bins>(count)};
    Bins whole[2];
    const double width = (high - low) * (1 + 1e-9) / static_cast<double>(count);
    for (const Cell& cell : cells) {
      const double a = along(cell, apex);
      const std::size_t s = width > 0 ? static_cast<std::size_t>((across(cell, apex) - low) / width) : 0;
      slices[a > 0][std::min(count - 1, s)].add(std::abs(a), cell.z, d_);
      whole[a > 0].add(std::abs(a), cell.z, d_);
    }
    for (const bool is_right : {false, true})
      for (std::size_t s = 0; s < count; ++s) {
        const Flank flank = fit_flank(slices[is_right][s].heights(), d_);
        (is_right ? right : left).add(flank);
        add_sector(low + (static_cast<double>(s) + 0.5) * width, flank);
      }
    const std::vector<double> heights[2] = {whole[0].heights(), whole[1].heights()};
    // Of the longer side: a wedge at a wall has one.
    reason_ = no_flank(heights[heights[1].size() > heights[0].size()], d_);
    append_profile(heights[0], -1);
    std::reverse(profile_.x.begin(), profile_.x.end());
    std::reverse(profile_.y.begin(), profile_.y.end());
    append_profile(heights[1], 1);
    add_line("flank left", heights[0], -1);
    add_line("flank right", heights[1], 1);
    if (lines_.size() == 1) volume_angle_ = volume_angle(heights[lines_[0].x[0] > 0], d_, true, base_) * 180 / pi;
    return count;
  }

  void add_sector(double place, const Flank& flank) {
    if (flank.bins == 0) return;
    each_.x.push_back(place);
    each_.y.push_back(flank.angle * 180 / pi);
  }

  void add_line(const std::string& name, const std::vector<double>& heights, double side) {
    const Flank flank = fit_flank(heights, d_);
    if (flank.bins == 0) return;
    CurveResult line{name, profile_.x_name, profile_.y_name, {}, {}};
    for (const double x : {flank.from, flank.to}) {
      line.x.push_back(side * x);
      line.y.push_back(flank.level - std::tan(flank.angle) * x);
    }
    lines_.push_back(line);
  }

  void append_profile(const std::vector<double>& heights, double side) {
    for (std::size_t k = 0; k < heights.size(); ++k) {
      profile_.x.push_back(side * (static_cast<double>(k) + 0.5) * d_);
      profile_.y.push_back(heights[k]);
    }
  }

  RegionRef region_;
  bool is_wedge_;
  std::size_t sectors_;
  bool has_centre_;
  Vec3 centre_, direction_;
  double d_ = 0;  // m, median sphere diameter
  CurveResult profile_, each_;
  std::vector<CurveResult> lines_;
  std::string reason_;
  double volume_angle_ = nan, base_ = nan;  // deg, m
};

}  // namespace

std::unique_ptr<Sensor> make_angle_of_repose_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  const bool is_wedge = options.choice("shape", {"cone", "wedge"}, "cone") == "wedge";
  const std::size_t sectors = options.whole("sectors", 8, 12, 8);
  const bool has_centre = options.has("centre");
  const Vec3 centre = has_centre ? options.vector("centre", "m") : Vec3{};
  Vec3 direction{1, 0, 0};
  if (options.has("direction")) {
    direction = options.vector("direction", "1");
    direction.z = 0;
    if (!(norm2(direction) > 0)) throw options.error("direction", "has no horizontal part; give [x, y, 0]");
    direction = normalized(direction);
  }
  return std::make_unique<ReposeSensor>(region, is_wedge, sectors, has_centre, centre, direction);
}

}  // namespace calx
