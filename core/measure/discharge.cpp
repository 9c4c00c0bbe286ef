// discharge.cpp: kind "discharge": mass that left a vessel through an opening, its steady rate, and Beverloo's estimate
// for grains of the same size.
//
// Keys: "region" (the vessel; the moment it holds most grains is the start, so fill it before it opens), "bed" (a
// region inside the powder, where the bulk density is measured until the first grain leaves), "opening" ("slot",
// preset, or "circle"), "width" (of the slot, or diameter of the circle, m), "length" (of the slot, m), "c"
// (preset 1.03 for a slot, 0.58 for a circle) and "k" (1.4) of the rule, "from" and "to" (0.25, 0.75: the middle half,
// as shares of the mass discharged so far).
//
// Columns:
//   mass_kg, retained_kg   discharged and still in the vessel; exact
//   rate_kg_s              least-squares slope of mass against time over the middle half
//   rate_sd_kg_s           scatter of that rate: sd of the rates of ten equal spans of the middle half
//   r2_1                   share of the variance that the line explains
//   pause_s                longest time within the middle half in which nothing left, as fine as the rows
//   density_kg_m3          bulk density in "bed" before the flow
//   grain_m                diameter of a sphere of a grain's volume, mean by mass, in the full vessel
//   beverloo_kg_s          slot: c rho sqrt(g) L (W - k d)^1.5, circle: c rho sqrt(g) (W - k d)^2.5 (Beverloo, Leniger,
//   van
//                          de Velde 1961, Chem. Eng. Sci. 15, 260; slot and its 1.03: Brown, Richards 1970, Principles
//                          of Powder Mechanics); 0 where W <= k d
//   ratio_1                rate over that estimate
// NaN until at least ten rows lie in the middle half. Curves: mass against time, the line, Beverloo's line.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/bulk_density.hpp"
#include "measure/kinds.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

struct Opening {
  bool is_slot = true;
  double width = 0, length = 0;  // m
  double c = 0, k = 0;

  double rate(double density, double gravity, double d) const {
    const double free = std::max(0.0, width - k * d);
    const double root = std::sqrt(free);
    return c * density * std::sqrt(gravity) * (is_slot ? length * free * root : free * free * root);
  }
};

/// Straight line through rows [first, last).
struct Line {
  double slope = nan, at_zero = nan, r2 = nan;
  Line(const std::vector<double>& x, const std::vector<double>& y, std::size_t first, std::size_t last) {
    const double n = static_cast<double>(last - first);
    double sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t k = first; k < last; ++k) sx += x[k], sy += y[k];
    for (std::size_t k = first; k < last; ++k) {
      const double dx = x[k] - sx / n, dy = y[k] - sy / n;
      xx += dx * dx, xy += dx * dy, yy += dy * dy;
    }
    if (last < first + 2 || !(xx > 0)) return;
    slope = xy / xx;
    at_zero = sy / n - slope * sx / n;
    if (yy > 0) r2 = xy * xy / (xx * yy);
  }
};

class DischargeSensor : public Sensor {
 public:
  DischargeSensor(const RegionSettings& region, const RegionSettings& bed, const Opening& opening, double from,
                  double to)
      : region_(&region), bed_(&bed), opening_(opening), from_(from), to_(to) {}
  std::vector<std::string> columns() const override {
    return {"mass_kg", "retained_kg",   "rate_kg_s", "rate_sd_kg_s",  "r2_1",
            "pause_s", "density_kg_m3", "grain_m",   "beverloo_kg_s", "ratio_1"};
  }

  std::vector<double> sample(const WorldView& world) override {
    const double retained = look(world);
    const double estimate = opening_.rate(density_, norm(world.settings().gravity), grain_);
    const double mass = mass_.empty() ? 0 : mass_.back();
    std::size_t first = 0, last = 0;
    middle(first, last);
    if (last < first + fewest_rows) return {mass, retained, nan, nan, nan, nan, density_, grain_, estimate, nan};
    const Line line(time_, mass_, first, last);
    return {mass,     retained, line.slope, scatter(first, last), line.r2, pause(first, last),
            density_, grain_,   estimate,   line.slope / estimate};
  }

  std::vector<CurveResult> curves() const override {
    CurveResult all{"discharge", "time_s", "mass_kg", time_, mass_};
    CurveResult fit{"middle half", "time_s", "mass_kg", {}, {}}, rule{"Beverloo", "time_s", "mass_kg", {}, {}};
    std::size_t first = 0, last = 0;
    middle(first, last);
    if (last < first + fewest_rows) return {all, fit, rule};
    const Line line(time_, mass_, first, last);
    const double begin = time_[first], end = time_[last - 1], mid = 0.5 * (begin + end);
    const double centre = line.at_zero + line.slope * mid, slope = opening_.rate(density_, gravity_, grain_);
    for (const double t : {begin, end}) {
      fit.x.push_back(t), fit.y.push_back(line.at_zero + line.slope * t);
      rule.x.push_back(t), rule.y.push_back(centre + slope * (t - mid));
    }
    return {all, fit, rule};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    out.put(prefix + "/time", time_.data(), time_.size(), "s");
    out.put(prefix + "/mass", mass_.data(), mass_.size(), "kg");
    const double numbers[] = {full_, full_count_, density_, grain_, gravity_};
    out.put(prefix + "/numbers", numbers, 5, "");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    time_ = in.get_doubles(prefix + "/time");
    mass_ = in.get_doubles(prefix + "/mass");
    const std::vector<double> numbers = in.get_doubles(prefix + "/numbers");
    full_ = numbers.at(0), full_count_ = numbers.at(1), density_ = numbers.at(2), grain_ = numbers.at(3);
    gravity_ = numbers.at(4);
  }

 private:
  static constexpr std::size_t fewest_rows = 10;

  /// Takes a row; returns the mass in the vessel.
  double look(const WorldView& world) {
    const Particles& particles = world.particles();
    double mass = 0, count = 0, weighted = 0;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      if (!region_.contains(world, position(particles.body[p]))) continue;
      const double m = particles.body[p].m, scale = particles.scale[p];
      mass += m, count += 1;
      weighted += m * scale * std::cbrt(6 / pi * particles.shapes[particles.shape[p]].volume);
    }
    gravity_ = norm(world.settings().gravity);
    if (count >= full_count_) {
      full_count_ = count, full_ = mass;
      grain_ = mass > 0 ? weighted / mass : nan;
      density_ = solid_in(world, bed_).mass / bed_.settings().volume();
      time_.clear(), mass_.clear();
    }
    time_.push_back(world.time());
    mass_.push_back(count < full_count_ ? full_ - mass : 0);
    return mass;
  }

  void middle(std::size_t& first, std::size_t& last) const {
    first = last = 0;
    if (mass_.empty() || !(mass_.back() > 0)) return;
    while (first < mass_.size() && mass_[first] < from_ * mass_.back()) ++first;
    last = first;
    while (last < mass_.size() && mass_[last] <= to_ * mass_.back()) ++last;
  }

  double scatter(std::size_t first, std::size_t last) const {
    std::vector<double> rates;
    const double rows = static_cast<double>(last - first - 1);
    for (int k = 0; k < 10; ++k) {
      const auto at = [&](int span) { return first + static_cast<std::size_t>(rows * span / 10 + 0.5); };
      const std::size_t a = at(k), b = at(k + 1);
      if (time_[b] > time_[a]) rates.push_back((mass_[b] - mass_[a]) / (time_[b] - time_[a]));
    }
    double mean = 0, sum = 0;
    for (const double r : rates) mean += r / static_cast<double>(rates.size());
    for (const double r : rates) sum += (r - mean) * (r - mean);
    return rates.size() < 2 ? nan : std::sqrt(sum / static_cast<double>(rates.size() - 1));
  }

  double pause(std::size_t first, std::size_t last) const {
    double longest = 0, since = time_[first];
    for (std::size_t k = first + 1; k < last; ++k) {
      if (mass_[k] > mass_[k - 1]) since = time_[k];
      longest = std::max(longest, time_[k] - since);
    }
    return longest;
  }

  RegionRef region_, bed_;
  Opening opening_;
  double from_, to_;
  std::vector<double> time_, mass_;  // s, kg discharged, since the vessel was fullest
  double full_ = 0, full_count_ = 0;
  double density_ = nan, grain_ = nan, gravity_ = 0;
};

}  // namespace

std::unique_ptr<Sensor> make_discharge_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  const RegionSettings& bed = options.required_region("bed");
  Opening opening;
  opening.is_slot = options.choice("opening", {"slot", "circle"}, "slot") == "slot";
  opening.width = options.required_number("width", "m", 1e-9, 1e6);
  if (opening.is_slot) opening.length = options.required_number("length", "m", 1e-9, 1e6);
  opening.c = options.number("c", "1", 0, 100, opening.is_slot ? 1.03 : 0.58);
  opening.k = options.number("k", "1", 0, 10, 1.4);
  const double from = options.number("from", "1", 0, 1, 0.25), to = options.number("to", "1", 0, 1, 0.75);
  if (!(from < to)) throw options.error("from", "the share at which the fit begins must be below \"to\"");
  return std::make_unique<DischargeSensor>(region, bed, opening, from, to);
}

}  // namespace calx
