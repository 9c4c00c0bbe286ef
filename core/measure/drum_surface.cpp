// drum_surface.cpp: kind "drum-surface": the free surface of the bed in a turning drum, as a camera in front of a glass
// end wall sees it, and the dynamic angle of repose.
//
// Keys: "region" (a cylinder: the inside of the drum, horizontal axis), "start" (an event, such as the end of the
// spin-up: frames before it do not count; left out: from the first row), "cell" (m; a hundredth of the radius), "near"
// and "far" (2/7, 25/42: half widths of the two line fits as shares of the radius; 12 and 25 mm of a GranuDrum of 84
// mm). Axes: u is the cylinder's axis (from, to) turned into the horizontal direction to the right of it seen from
// above, so that an axis along +y has u along +x; heights count from the drum's axis.
//
// Each row adds one frame: grains are projected along the axis onto square cells, a cell is dark where any sphere
// covers its middle. The surface of a column of cells is the highest place where the mean over frames reaches 1/2,
// between cells by straight line, within 0.95 of the radius. The rule is that of the published GranuDrum curves
// (arXiv:2505.02967), so that both can be laid over each other.
//
// Columns: angle_deg and far_deg (lines through |u| below near and far; positive where the bed hangs towards -u), rms_m
// and far_rms_m (of the surface about these lines), level_m (height of the near line at u = 0), fill_1 (dark share of
// the area within 0.96 of the radius), frames_1. NaN before the first frame. Curves, u_m against height_m: "surface",
// "near line" and "far line" (two points each), "drum" (the circle of the wall).
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

class DrumSurfaceSensor : public Sensor {
 public:
  DrumSurfaceSensor(const RegionSettings& region, std::string start, double cell, double near, double far)
      : region_(&region),
        start_(std::move(start)),
        near_(near),
        far_(far),
        radius_(region.radius),
        cells_(2 * static_cast<std::size_t>(std::ceil(region.radius / cell))),
        cell_(2 * region.radius / static_cast<double>(cells_)),
        centre_(0.5 * (region.a + region.b)),
        dark_(cells_ * cells_) {
    const Vec3 axis = normalized(region.b - region.a);
    right_ = normalized(Vec3{axis.y, -axis.x, 0});
  }
  std::vector<std::string> columns() const override {
    return {"angle_deg", "far_deg", "rms_m", "far_rms_m", "level_m", "fill_1", "frames_1"};
  }

  std::vector<double> sample(const WorldView& world) override {
    if (start_.empty() || world.event_time(start_) >= 0) add_frame(world);
    if (frames_ == 0) return {nan, nan, nan, nan, nan, nan, 0};
    const CurveResult surface = curve();
    const Fit near = fit(surface, near_ * radius_), far = fit(surface, far_ * radius_);
    return {near.angle, far.angle, near.rms, far.rms, near.level, fill(), static_cast<double>(frames_)};
  }
  std::vector<CurveResult> curves() const override {
    const CurveResult surface = curve();
    CurveResult wall{"drum", "u_m", "height_m", {}, {}};
    for (int k = 0; k <= 120; ++k) {
      wall.x.push_back(radius_ * std::cos(k * pi / 60));
      wall.y.push_back(radius_ * std::sin(k * pi / 60));
    }
    return {surface, line("near line", surface, near_ * radius_), line("far line", surface, far_ * radius_), wall};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    out.put(prefix + "/dark", dark_.data(), dark_.size());
    out.put_number(prefix + "/frames", frames_, "1");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    dark_ = in.get_u32(prefix + "/dark");
    dark_.resize(cells_ * cells_);
    frames_ = static_cast<std::uint32_t>(in.get_number(prefix + "/frames"));
  }

 private:
  struct Fit {
    double angle = nan, level = nan, rms = nan;  // deg, m, m
  };

  /// Middle of cell k along either axis, m from the drum's axis.
  double middle(std::size_t k) const { return (static_cast<double>(k) + 0.5) * cell_ - radius_; }

  void add_frame(const WorldView& world) {
    std::vector<std::uint8_t> covered(cells_ * cells_);
    const Particles& particles = world.particles();
    const double last = static_cast<double>(cells_ - 1);
    const auto index = [&](double x) {
      return static_cast<std::size_t>(std::min(last, std::max(0.0, (x + radius_) / cell_ - 0.5)));
    };
    for (std::size_t s = 0; s < particles.sphere_count(); ++s) {
      const Record& sphere = particles.spheres()[s];
      if (!region_.contains(world, position(sphere))) continue;
      const Vec3 arm = position(sphere) - centre_;
      const double u = dot(arm, right_), z = arm.z, r = sphere.r;
      for (std::size_t j = index(z - r); j <= index(z + r + cell_); ++j)
        for (std::size_t i = index(u - r); i <= index(u + r + cell_); ++i) {
          const double du = middle(i) - u, dz = middle(j) - z;
          if (du * du + dz * dz <= r * r) covered[j * cells_ + i] = 1;
        }
    }
    for (std::size_t k = 0; k < covered.size(); ++k) dark_[k] += covered[k];
    ++frames_;
  }

  CurveResult curve() const {
    CurveResult out{"surface", "u_m", "height_m", {}, {}};
    if (frames_ == 0) return out;
    const auto share = [&](std::size_t i, std::size_t j) {
      return static_cast<double>(dark_[j * cells_ + i]) / static_cast<double>(frames_);
    };
    for (std::size_t i = 0; i < cells_; ++i) {
      const double u = middle(i);
      std::size_t j = cells_ - 1;
      const auto outside = [&](std::size_t row) { return std::hypot(u, middle(row)) > 0.95 * radius_; };
      while (j > 0 && (outside(j) || share(i, j) < 0.5)) --j;
      // No surface where the bed reaches the wall above, or is not there at all.
      if (j == 0 || outside(j + 1) || outside(j)) continue;
      const double below = share(i, j), above = share(i, j + 1);
      out.x.push_back(u);
      out.y.push_back(middle(j) + cell_ * (below - 0.5) / (below - above));
    }
    return out;
  }

  static Fit fit(const CurveResult& surface, double half_width) {
    double n = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t k = 0; k < surface.x.size(); ++k)
      if (std::abs(surface.x[k]) < half_width) n += 1, sx += surface.x[k], sy += surface.y[k];
    for (std::size_t k = 0; k < surface.x.size(); ++k) {
      if (!(std::abs(surface.x[k]) < half_width)) continue;
      const double dx = surface.x[k] - sx / n, dy = surface.y[k] - sy / n;
      xx += dx * dx, xy += dx * dy, yy += dy * dy;
    }
    if (n < 3) return {};
    const double slope = xy / xx;
    return {std::atan(-slope) * 180 / pi, (sy - slope * sx) / n, std::sqrt(std::max(0.0, yy - slope * xy) / n)};
  }

  static CurveResult line(const std::string& name, const CurveResult& surface, double half_width) {
    CurveResult out{name, surface.x_name, surface.y_name, {}, {}};
    const Fit found = fit(surface, half_width);
    for (const double u : {-half_width, half_width}) {
      out.x.push_back(u);
      out.y.push_back(found.level - std::tan(found.angle * pi / 180) * u);
    }
    return out;
  }

  double fill() const {
    double dark = 0, all = 0;
    for (std::size_t j = 0; j < cells_; ++j)
      for (std::size_t i = 0; i < cells_; ++i) {
        if (std::hypot(middle(i), middle(j)) > 0.96 * radius_) continue;
        all += 1;
        dark += static_cast<double>(dark_[j * cells_ + i]) / static_cast<double>(frames_);
      }
    return dark / all;
  }

  RegionRef region_;
  std::string start_;
  double near_, far_, radius_;
  std::size_t cells_;  // along either axis
  double cell_;        // m
  Vec3 centre_, right_;
  std::vector<std::uint32_t> dark_;  // frames in which a cell was covered; rows of u, z outer
  std::uint32_t frames_ = 0;
};

}  // namespace

std::unique_ptr<Sensor> make_drum_surface_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  if (region.kind != RegionSettings::Kind::cylinder)
    throw options.error("region", "region \"" + region.name + "\" is no cylinder; the inside of the drum is needed");
  if (std::abs(region.b.z - region.a.z) > 1e-6 * norm(region.b - region.a))
    throw options.error("region", "the axis of region \"" + region.name + "\" is not horizontal");
  const double cell = options.number("cell", "m", region.radius / 1000, region.radius / 10, region.radius / 100);
  const double near = options.number("near", "1", 0.01, 0.95, 2.0 / 7),
               far = options.number("far", "1", 0.01, 0.95, 25.0 / 42);
  return std::make_unique<DrumSurfaceSensor>(region, options.event("start"), cell, near, far);
}

}  // namespace calx
