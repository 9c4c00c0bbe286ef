// flow.cpp: kind "flow": mass that crosses a plane or enters a region, and its rate.
//
// Plane: "point", "normal" (any length; its side is forward) and, when only a disc counts, "radius". Region: "region";
// entering is forward. "direction": "net" (preset) counts forward minus backward, so a particle that comes back is
// taken off again; "forward" and "backward" count that way only, backward with a negative sign. Columns: mass_kg (since
// the start), rate_kg_s (over the interval since the last row, 0 in the first), particles_1 (net, since the start),
// forward_kg, backward_kg (both >= 0, since the start).
//
// A particle crosses where the straight line between its centres of mass at two looks does; particles that appear or
// are deleted cross nothing. Looks happen at each row, or at each step with "every_step": true, which is needed only
// where a particle may cross the disc, or pass through the region, within one interval.
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

struct Plane {
  Vec3 point, normal;
  double radius = std::numeric_limits<double>::infinity();
};

class FlowSensor : public Sensor {
 public:
  enum class Direction { net, forward, backward };

  FlowSensor(const RegionSettings* region, const Plane& plane, Direction direction, bool every_step)
      : region_(region), plane_(plane), direction_(direction), every_step_(every_step) {}

  std::vector<std::string> columns() const override {
    return {"mass_kg", "rate_kg_s", "particles_1", "forward_kg", "backward_kg"};
  }
  bool wants_every_step() const override { return every_step_; }
  void step(const WorldView& world) override { look(world); }

  std::vector<double> sample(const WorldView& world) override {
    look(world);
    const double mass = direction_ == Direction::forward    ? forward_
                        : direction_ == Direction::backward ? -backward_
                                                            : forward_ - backward_;
    const double interval = world.time() - row_time_;
    const double rate = has_row_ && interval > 0 ? (mass - row_mass_) / interval : 0;
    row_mass_ = mass;
    row_time_ = world.time();
    has_row_ = true;
    return {mass, rate, count_, forward_, backward_};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    std::vector<std::uint32_t> ids;
    std::vector<double> xyz;
    std::vector<std::uint8_t> inside;
    for (std::uint32_t id = 0; id < last_.size(); ++id) {
      if (!last_[id].seen) continue;
      ids.push_back(id);
      xyz.insert(xyz.end(), {last_[id].at.x, last_[id].at.y, last_[id].at.z});
      inside.push_back(last_[id].inside);
    }
    out.put(prefix + "/id", ids.data(), ids.size());
    out.put(prefix + "/position", xyz.data(), xyz.size(), "m");
    out.put(prefix + "/inside", inside.data(), inside.size());
    const double sums[] = {forward_, backward_, count_, row_mass_, row_time_, has_row_ ? 1.0 : 0.0};
    out.put(prefix + "/sums", sums, 6, "");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    const std::vector<std::uint32_t> ids = in.get_u32(prefix + "/id");
    const std::vector<double> xyz = in.get_doubles(prefix + "/position");
    const std::vector<std::uint8_t> inside = in.get_u8(prefix + "/inside");
    last_.assign(ids.empty() ? 0 : ids.back() + 1, {});
    for (std::size_t k = 0; k < ids.size(); ++k)
      last_[ids[k]] = {{xyz.at(3 * k), xyz.at(3 * k + 1), xyz.at(3 * k + 2)}, true, inside.at(k) != 0};
    const std::vector<double> sums = in.get_doubles(prefix + "/sums");
    forward_ = sums.at(0), backward_ = sums.at(1), count_ = sums.at(2);
    row_mass_ = sums.at(3), row_time_ = sums.at(4), has_row_ = sums.at(5) > 0;
  }

 private:
  struct Last {
    Vec3 at;  // m, centre of mass at the last look
    bool seen = false, inside = false;
  };

  void look(const WorldView& world) {
    const Particles& particles = world.particles();
    if (last_.size() < particles.next_id) last_.resize(particles.next_id);
    const DomainSettings& domain = world.settings().domain;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      Last& last = last_[particles.id[p]];
      const Vec3 now = position(particles.body[p]);
      const bool inside = region_.everywhere() ? is_ahead(now) : region_.contains(world, now);
      if (last.seen) {
        // Of two images of the old place the nearer one: going through a periodic face is no crossing.
        Vec3 move = now - last.at;
        bool wrapped = false;
        for (int k = 0; k < 3; ++k) {
          const double length = domain.box.hi[k] - domain.box.lo[k];
          if (!domain.periodic[static_cast<std::size_t>(k)] || 2 * std::abs(move[k]) <= length) continue;
          move[k] += move[k] > 0 ? -length : length;
          wrapped = true;
        }
        if (region_.everywhere()) {
          const bool was_ahead = wrapped ? is_ahead(now - move) : last.inside;
          if (was_ahead != inside && is_through_disc(now, move)) count(inside, particles.body[p].m);
        } else if (last.inside != inside) {
          count(inside, particles.body[p].m);
        }
      }
      last = {now, true, inside};
    }
  }
  bool is_ahead(const Vec3& p) const { return dot(p - plane_.point, plane_.normal) >= 0; }
  bool is_through_disc(const Vec3& now, const Vec3& move) const {
    if (!(plane_.radius < std::numeric_limits<double>::infinity())) return true;
    const double after = dot(now - plane_.point, plane_.normal), change = dot(move, plane_.normal);
    const Vec3 place = now - (after / change) * move - plane_.point;
    return norm2(place) <= plane_.radius * plane_.radius;
  }
  void count(bool is_forward, double mass) {
    (is_forward ? forward_ : backward_) += mass;
    count_ += is_forward ? 1 : -1;
  }

  RegionRef region_;
  Plane plane_;
  Direction direction_;
  bool every_step_;
  std::vector<Last> last_;              // by particle id
  double forward_ = 0, backward_ = 0;   // kg
  double count_ = 0;                    // particles, net
  double row_mass_ = 0, row_time_ = 0;  // kg, s, of the last row
  bool has_row_ = false;
};

}  // namespace

std::unique_ptr<Sensor> make_flow_sensor(SensorOptions& options) {
  const RegionSettings* region = options.region("region");
  const bool has_point = options.has("point"), has_normal = options.has("normal"), has_radius = options.has("radius");
  Plane plane;
  if (region && (has_point || has_normal || has_radius))
    throw options.error("region", "a flow sensor watches a region or a plane (point, normal), not both");
  if (!region) {
    if (!has_point || !has_normal)
      throw options.error("", "sensor \"" + options.settings().name +
                                  "\" of kind flow needs \"point\" and \"normal\" of a plane, or a \"region\"");
    plane.point = options.vector("point", "m");
    plane.normal = normalized(options.vector("normal", "1"));
    if (!(norm2(plane.normal) > 0)) throw options.error("normal", "a normal of length 0 has no direction");
    plane.radius = options.number("radius", "m", 1e-9, 1e9, plane.radius);
  }
  const std::string name = options.choice("direction", {"net", "forward", "backward"}, "net");
  const auto direction = name == "forward"    ? FlowSensor::Direction::forward
                         : name == "backward" ? FlowSensor::Direction::backward
                                              : FlowSensor::Direction::net;
  return std::make_unique<FlowSensor>(region, plane, direction, options.flag("every_step", false));
}

}  // namespace calx
