// stand_in.hpp: an executor that evaluates formulas instead of running cases, with scatter from seed to seed that has
// heavy tails; and studies on it. Its runs write the two files that observables are read from.
#pragma once
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/random.hpp"
#include "base/units.hpp"
#include "study/study.hpp"

namespace calx {

/// Student's t with 5 degrees of freedom, scaled to unit variance.
inline double heavy(Random& r) {
  double square = 0;
  for (int k = 0; k < 5; ++k) {
    const double z = r.normal();
    square += z * z;
  }
  return r.normal() / std::sqrt(square / 5) * std::sqrt(3.0 / 5.0);
}

/// A heap and a hopper as functions of sliding friction f and rolling friction r: smooth, curved, not separable.
struct StandIn {
  static double angle(double f, double r) {
    return 14 + 24 * (1 - std::exp(-2.2 * f)) + 30 * r / (0.15 + r) * std::sqrt(f);
  }
  static double density(double f, double r) { return 1500 * (1 - 0.10 * std::pow(f, 0.6) - 0.22 * r); }
  static double height(double f, double r) { return 20 + 12 * f - 3 * f * f + 20 * r; }
  /// Mass out of the hopper at time t, g.
  static double discharged(double f, double r, double t) {
    const double rate = 180 / (1 + 0.5 * f + 1.2 * r * f);
    return 500 * (1 - std::exp(-rate * t / 500));
  }
};
constexpr double kAngleScatter = 0.6, kDensityScatter = 4, kMassScatter = 3,
                 kHeightScatter = 0.4;  // deg, kg/m^3, g, mm

class StandInExecutor : public Executor {
 public:
  explicit StandInExecutor(std::string folder) : folder_(std::move(folder)) {}
  std::size_t computed = 0;
  /// Runs at friction above this end with an error.
  double fails_above = 1e9;
  /// Heaps at friction below this are too flat for an angle.
  double flat_below = 0;

  std::vector<RunResult> run(const std::vector<RunRequest>& requests, const ProgressSink&) override {
    std::vector<RunResult> out;
    for (const RunRequest& q : requests) {
      std::map<std::string, double> at{{"/f", 0.5}, {"/r", 0.1}};
      for (const auto& o : q.overrides) at[o.first] = std::stod(o.second);
      RunResult result;
      result.folder = folder_ + "/" + std::to_string(computed++);
      if (at["/f"] > fails_above) result.error = "blew up";
      std::filesystem::create_directories(result.folder + "/series");
      // A coarser rig is off by a few percent, in a way that depends on the place.
      const bool coarse = q.case_path.find("coarse") != std::string::npos;
      write(result.folder, at["/f"], at["/r"], q.seed, coarse ? 1.04 + 0.03 * at["/f"] : 1, at["/f"] < flat_below);
      out.push_back(result);
    }
    return out;
  }

 private:
  static void write(const std::string& folder, double f, double r, std::uint64_t seed, double off, bool flat) {
    Random random(seed, 5);
    const std::string angle = format_number(off * (StandIn::angle(f, r) + kAngleScatter * heavy(random)));
    std::ofstream(folder + "/summary.json")
        << R"({"sensors": {"heap": {)" << (flat ? R"("reason": "the pile is flat", )" : "")
        << R"("last": {"angle_deg": )" << (flat ? "null" : angle) << R"(, "density_kg_m3": )"
        << format_number(off * (StandIn::density(f, r) + kDensityScatter * heavy(random))) << R"(, "height_mm": )"
        << format_number(off * (StandIn::height(f, r) + kHeightScatter * heavy(random))) << "}}}}\n";
    std::ofstream series(folder + "/series/mass out.csv");
    series << "time_s,mass_kg\n";
    const double shared = kMassScatter * heavy(random);
    for (int k = 0; k <= 12; ++k) {
      const double t = 0.5 * k;
      series << format_number(t) << ","
             << format_number(1e-3 * off * (StandIn::discharged(f, r, t) + (k > 0 ? shared + 0.3 * heavy(random) : 0)))
             << "\n";
    }
  }
  std::string folder_;
};

inline StudyParameter stand_in_parameter(const std::string& name, const std::string& pointer, double low, double high) {
  StudyParameter p;
  p.name = name;
  p.unit = "1";
  p.set = {pointer};
  p.cases = {"rig"};
  p.low = low;
  p.high = high;
  return p;
}

inline StudyObservable stand_in_scalar(const std::string& name, const std::string& column, double value, double sd,
                                       std::size_t repeats) {
  StudyObservable o;
  o.name = name;
  o.kind = "other";
  o.case_name = "rig";
  o.sensor = "heap";
  o.column = column;
  o.measured.y = {value};
  o.measured.sd = {sd};
  o.measured.repeats = repeats;
  o.tolerance = 0.35 * sd;
  return o;
}

/// Angle, density and discharge to fit, height held out, measured five times at the truth (f, r) by a lab with that
/// seed. bias: of the angle, deg, that the lab does not know of.
inline Study stand_in_study(double f, double r, std::uint64_t lab, double bias = 0) {
  Random random(lab, 77);
  const auto mean_of = [&](double value, double sd) {
    double sum = 0;
    for (int k = 0; k < 5; ++k) sum += value + sd * heavy(random);
    return sum / 5;
  };
  Study study;
  study.title = "stand-in";
  study.seed = lab;
  study.budget = 45;
  study.cases.push_back({"rig", "/cases/rig", "rig.json", {}, "", 0.1});
  study.parameters = {stand_in_parameter("friction", "/f", 0.1, 0.9), stand_in_parameter("rolling", "/r", 0, 0.4)};
  study.observables.push_back(stand_in_scalar("angle", "angle_deg", bias + mean_of(StandIn::angle(f, r), 0.8), 0.8, 5));
  study.observables.push_back(stand_in_scalar("density", "density_kg_m3", mean_of(StandIn::density(f, r), 5), 5, 5));
  study.observables.push_back(stand_in_scalar("height", "height_mm", mean_of(StandIn::height(f, r), 0.5), 0.5, 5));
  study.observables.back().use = StudyObservable::Use::hold_out;
  StudyObservable curve = study.observables[0];
  curve.name = "discharge";
  curve.sensor = "mass out";
  curve.column = "mass_kg";
  curve.against = "time_s";
  curve.unit = "g";
  curve.factor = 1000;
  curve.measured = {};
  curve.measured.repeats = 5;
  curve.measured.correlation = 0.5;
  const double shared = mean_of(0, 3);
  for (const double t : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    curve.measured.x.push_back(t);
    curve.measured.y.push_back(shared + mean_of(StandIn::discharged(f, r, t), 2));
    curve.measured.sd.push_back(4);
  }
  curve.tolerance = 1.4;
  study.observables.push_back(curve);
  return study;
}

}  // namespace calx
