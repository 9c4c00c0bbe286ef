// inertial_number.cpp: kind "inertial-number": whether a bed deforms quasi-statically.
//
// Keys: "region", "start" (an event: largest_1 counts from there; left out: from the first row).
// I = rate d sqrt(rho / P) (GDR MiDi 2004, Eur. Phys. J. E 14, 341); below about 1e-3 a flow is quasi-static, above 0.1
// it is collisional. All four are means over the region: the rate is sqrt(2 D:D) of the deviatoric symmetric part D of
// the velocity gradient that fits the grains best (least squares), d the diameter of a sphere of a grain's volume (mean
// by mass), rho the density of the grains, P half the weight of the grains over the area they cover, that is the
// pressure in the middle of the bed. Shear bands are narrower than the region, so I is larger inside of them: compare
// with a region about the band.
//
// Columns: inertial_1, rate_1_s, pressure_Pa, grain_m, largest_1 (largest inertial_1 so far). NaN with fewer than 10
// grains.
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

/// Columns of the inverse of a symmetric matrix given by its columns; empty where it is singular.
std::vector<Vec3> inverse(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double determinant = dot(a, cross(b, c));
  const double size = norm(a) * norm(b) * norm(c);
  if (!(std::abs(determinant) > 1e-12 * size)) return {};
  // Of a symmetric matrix rows and columns are the same.
  return {cross(b, c) / determinant, cross(c, a) / determinant, cross(a, b) / determinant};
}

class InertialNumberSensor : public Sensor {
 public:
  InertialNumberSensor(const RegionSettings& region, std::string start) : region_(&region), start_(std::move(start)) {}
  std::vector<std::string> columns() const override {
    return {"inertial_1", "rate_1_s", "pressure_Pa", "grain_m", "largest_1"};
  }

  std::vector<double> sample(const WorldView& world) override {
    const Particles& particles = world.particles();
    std::vector<std::size_t> inside;
    double mass = 0, volume = 0, weighted = 0;
    Vec3 x, v;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      const Record& body = particles.body[p];
      if (!region_.contains(world, position(body))) continue;
      inside.push_back(p);
      const double scale = particles.scale[p],
                   each = particles.shapes[particles.shape[p]].volume * scale * scale * scale;
      mass += body.m, volume += each;
      weighted += body.m * std::cbrt(6 / pi * each);
      x += position(body);
      v += Vec3{body.vx, body.vy, body.vz};
    }
    std::vector<double> row{nan, nan, nan, nan, largest_};
    const double n = static_cast<double>(inside.size());
    if (inside.size() < 10) return row;
    const double d = weighted / mass;
    std::set<std::pair<long, long>> covered;
    Vec3 moment[3], gradient[3];  // sums of dx dx and of dv dx, by the second index
    for (const std::size_t p : inside) {
      const Record& body = particles.body[p];
      const Vec3 dx = position(body) - x / n, dv = Vec3{body.vx, body.vy, body.vz} - v / n;
      for (int k = 0; k < 3; ++k) moment[k] += dx[k] * dx, gradient[k] += dx[k] * dv;
      covered.emplace(std::lround(body.x / d), std::lround(body.y / d));
    }
    const double area = static_cast<double>(covered.size()) * d * d;
    const double pressure = mass * norm(world.settings().gravity) / (2 * area);
    row[2] = pressure, row[3] = d;
    const std::vector<Vec3> back = inverse(moment[0], moment[1], moment[2]);
    if (back.empty()) return row;
    double g[3][3];
    for (int k = 0; k < 3; ++k) {
      const Vec3 column = back[static_cast<std::size_t>(k)].x * gradient[0] +
                          back[static_cast<std::size_t>(k)].y * gradient[1] +
                          back[static_cast<std::size_t>(k)].z * gradient[2];
      for (int i = 0; i < 3; ++i) g[i][k] = column[i];
    }
    const double trace = (g[0][0] + g[1][1] + g[2][2]) / 3;
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        const double shear = 0.5 * (g[i][k] + g[k][i]) - (i == k ? trace : 0);
        sum += shear * shear;
      }
    row[1] = std::sqrt(2 * sum);
    row[0] = row[1] * d * std::sqrt(mass / volume / pressure);
    if ((start_.empty() || world.event_time(start_) >= 0) && !(largest_ >= row[0])) largest_ = row[0];
    row[4] = largest_;
    return row;
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    out.put_number(prefix + "/largest", largest_, "1");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    largest_ = in.get_number(prefix + "/largest");
  }

 private:
  RegionRef region_;
  std::string start_;
  double largest_ = nan;
};

}  // namespace

std::unique_ptr<Sensor> make_inertial_number_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  return std::make_unique<InertialNumberSensor>(region, options.event("start"));
}

}  // namespace calx
