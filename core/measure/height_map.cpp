// height_map.cpp: the envelope, and kind "height-map": the surface of a bed.
//
// Keys: "region" (its spheres by their centres; the map covers its bounds in x and y), "cell" (m). Heights are world z
// of the highest sphere point over each cell, so they lie above the mean surface by up to one sphere radius.
// Columns: height_mean_m, height_min_m, height_max_m over cells that are not empty; covered_1, their share; slope_deg
// of the least-squares plane through them; centre_x_m, centre_y_m, centre of mass of the particles in the region. Field
// "height". Curves: "section", x against height in the row of cells at "section_y" (m; the middle of the region when
// left out), and "azimuthal mean", radius about the middle against the mean height of rings one cell wide.
#include "measure/height_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degrees = 180 / 3.14159265358979323846;

std::size_t cells_along(double lo, double hi, double cell) {
  // Slack for bounds that are whole cells apart up to rounding.
  return static_cast<std::size_t>(std::max(1.0, std::ceil((hi - lo) / cell - 1e-9)));
}

}  // namespace

HeightMap::HeightMap(const Vec3& lo, const Vec3& hi, double cell)
    : origin_{lo.x, lo.y, lo.z},
      cell_(cell),
      nx_(cells_along(lo.x, hi.x, cell)),
      ny_(cells_along(lo.y, hi.y, cell)),
      top_(nx_ * ny_, nan) {}

void HeightMap::add(const Record& sphere) {
  const auto first = [this](double low, double origin) {
    return static_cast<std::size_t>(std::max(0.0, std::floor((low - origin) / cell_)));
  };
  // Distance from c to the interval of cell k.
  const auto gap = [this](double c, double origin, std::size_t k) {
    const double lo = origin + static_cast<double>(k) * cell_;
    return std::max({0.0, lo - c, c - (lo + cell_)});
  };
  const double r = sphere.r;
  for (std::size_t j = first(sphere.y - r, origin_.y); j < ny_; ++j) {
    if (origin_.y + static_cast<double>(j) * cell_ > sphere.y + r) break;
    const double dy = gap(sphere.y, origin_.y, j);
    for (std::size_t i = first(sphere.x - r, origin_.x); i < nx_; ++i) {
      if (origin_.x + static_cast<double>(i) * cell_ > sphere.x + r) break;
      const double dx = gap(sphere.x, origin_.x, i), squared = r * r - dx * dx - dy * dy;
      if (squared < 0) continue;
      const double height = sphere.z + std::sqrt(squared);
      double& top = top_[j * nx_ + i];
      if (!(top >= height)) top = height;
    }
  }
}

std::vector<const Record*> spheres_in(const WorldView& world, const RegionRef& region) {
  const Particles& particles = world.particles();
  std::vector<const Record*> found;
  for (std::size_t s = 0; s < particles.sphere_count(); ++s) {
    const Record* sphere = particles.spheres() + s;
    if (region.contains(world, position(*sphere))) found.push_back(sphere);
  }
  return found;
}

namespace {

class HeightMapSensor : public Sensor {
 public:
  HeightMapSensor(const RegionSettings& region, double cell, double section_y)
      : region_(&region), cell_(cell), section_y_(section_y) {}
  std::vector<std::string> columns() const override {
    return {"height_mean_m", "height_min_m", "height_max_m", "covered_1", "slope_deg", "centre_x_m", "centre_y_m"};
  }

  std::vector<double> sample(const WorldView& world) override {
    const Box box = region_.bounds(world);
    middle_ = 0.5 * (box.lo + box.hi);
    map_ = HeightMap(box.lo, box.hi, cell_);
    for (const Record* sphere : spheres_in(world, region_)) map_.add(*sphere);
    std::vector<double> row = surface();
    Vec3 moment;
    double mass = 0;
    for (const Record& body : world.particles().body) {
      if (!region_.contains(world, position(body))) continue;
      mass += body.m;
      moment += body.m * position(body);
    }
    row.push_back(mass > 0 ? moment.x / mass : nan);
    row.push_back(mass > 0 ? moment.y / mass : nan);
    return row;
  }

  std::vector<FieldResult> fields() const override {
    return {{"height", "m", map_.nx(), map_.ny(), map_.origin(), map_.cell(), map_.values()}};
  }

  std::vector<CurveResult> curves() const override {
    CurveResult section{"section", "x_m", "height_m", {}, {}};
    CurveResult ring{"azimuthal mean", "radius_m", "height_m", {}, {}};
    if (map_.nx() == 0) return {section, ring};
    const double y = std::isnan(section_y_) ? middle_.y : section_y_;
    const double line = std::max(0.0, std::floor((y - map_.origin().y) / cell_));
    const std::size_t row = std::min(map_.ny() - 1, static_cast<std::size_t>(line));
    for (std::size_t i = 0; i < map_.nx(); ++i) section.x.push_back(map_.x(i)), section.y.push_back(map_.at(i, row));

    std::vector<double> sum, count;
    for (std::size_t j = 0; j < map_.ny(); ++j)
      for (std::size_t i = 0; i < map_.nx(); ++i) {
        if (std::isnan(map_.at(i, j))) continue;
        const double dx = map_.x(i) - middle_.x, dy = map_.y(j) - middle_.y;
        const std::size_t k = static_cast<std::size_t>(std::sqrt(dx * dx + dy * dy) / cell_);
        if (k >= sum.size()) sum.resize(k + 1), count.resize(k + 1);
        sum[k] += map_.at(i, j);
        count[k] += 1;
      }
    for (std::size_t k = 0; k < sum.size(); ++k) {
      ring.x.push_back((static_cast<double>(k) + 0.5) * cell_);
      ring.y.push_back(count[k] > 0 ? sum[k] / count[k] : nan);
    }
    return {section, ring};
  }

 private:
  /// Mean, lowest, highest, covered share, slope of the plane through all covered cells.
  std::vector<double> surface() const {
    double n = 0, sx = 0, sy = 0, sz = 0, low = nan, high = nan;
    const auto each = [this](auto&& visit) {
      for (std::size_t j = 0; j < map_.ny(); ++j)
        for (std::size_t i = 0; i < map_.nx(); ++i)
          if (!std::isnan(map_.at(i, j))) visit(map_.x(i), map_.y(j), map_.at(i, j));
    };
    each([&](double x, double y, double z) {
      n += 1, sx += x, sy += y, sz += z;
      if (!(low <= z)) low = z;
      if (!(high >= z)) high = z;
    });
    if (n < 1) return {nan, nan, nan, 0, nan};
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
    each([&](double x, double y, double z) {
      const double dx = x - sx / n, dy = y - sy / n, dz = z - sz / n;
      xx += dx * dx, xy += dx * dy, yy += dy * dy, xz += dx * dz, yz += dy * dz;
    });
    const double determinant = xx * yy - xy * xy;
    double slope = nan;
    if (determinant > 1e-12 * xx * yy) {
      const double a = (xz * yy - yz * xy) / determinant, b = (yz * xx - xz * xy) / determinant;
      slope = std::atan(std::sqrt(a * a + b * b)) * degrees;
    }
    return {sz / n, low, high, n / static_cast<double>(map_.nx() * map_.ny()), slope};
  }

  RegionRef region_;
  double cell_, section_y_;
  Vec3 middle_;
  HeightMap map_;
};

}  // namespace

std::unique_ptr<Sensor> make_height_map_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  const double cell = options.required_number("cell", "m", 1e-9, 1e6);
  const Box box = region.bounds();
  const double cells = std::ceil((box.hi.x - box.lo.x) / cell) * std::ceil((box.hi.y - box.lo.y) / cell);
  if (cells > static_cast<double>(HeightMap::most_cells))
    throw options.error("cell", "cells of " + std::to_string(cell) + " m need more than " +
                                    std::to_string(HeightMap::most_cells) + " of them over region \"" + region.name +
                                    "\"; use larger cells or a smaller region");
  return std::make_unique<HeightMapSensor>(region, cell, options.number("section_y", "m", -1e9, 1e9, nan));
}

}  // namespace calx
