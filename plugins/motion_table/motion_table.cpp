// motion_table.cpp: any measured or designed motion as a table of angle and displacement over time, calx.motion-table.
#include <calx/rigid_motion.hpp>
#include <limits>

#include "table.hpp"

namespace {

using calx::rigid::Motion;
using calx::rigid::Vector;
using motion_table::Point;
using motion_table::Table;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("origin", "m", 1e6, 0, 0, 0, 1, "a point of the axis of rotation"),
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 0, 1, 2, "direction of the axis of rotation, of any length"),
    CALX_VECTOR_FIELDS("direction", "1", 1e6, 0, 0, 1, 3, "direction of the displacement, of any length"),
    {"curve", "linear|cubic", "straight lines between rows, or cubics that do not overshoot", 0, 1, 0,
     CALX_FIELD_CHOICE, 0},
    {"cycles", "1", "how often the table runs, each time from where it ended; 0: endless", 0, 1e9, 1,
     CALX_FIELD_INTEGER, 0}};

// Exactly one of the two lists must be there; the plugin's message says so.
const char schema[] =
    "{\"properties\": {"
    "\"rows\": {\"type\": \"array\", \"minItems\": 2, \"description\": \"rows of time s, angle rad, displacement m\","
    " \"items\": {\"type\": \"array\", \"items\": {\"type\": \"number\"}, \"minItems\": 3, \"maxItems\": 3}},"
    "\"rows_deg\": {\"type\": \"array\", \"minItems\": 2, \"description\": \"the same with the angle in degrees\","
    " \"items\": {\"type\": \"array\", \"items\": {\"type\": \"number\"}, \"minItems\": 3, \"maxItems\": 3}}}}";

class MotionTable : public Motion {
 public:
  static const calx_descriptor descriptor;

  MotionTable(const calx_host* host, const calx_config& c)
      : Motion(host),
        origin_(calx::rigid::vector(descriptor, c, "origin")),
        axis_(calx::rigid::direction(descriptor, c, "axis")),
        direction_(calx::rigid::direction(descriptor, c, "direction")),
        cycles_(calx::parameter(descriptor, c, "cycles")),
        table_(c.json ? std::string(c.json, c.json_size) : "{}", calx::rigid::is_choice(descriptor, c, "curve", 1)) {}

  void pose(double t, calx_pose& out) const noexcept override {
    const double period = table_.end();
    double done = 0;  // whole runs of the table
    Point p = Point{table_.first().angle, table_.first().shift, 0, 0};
    if (t >= duration()) {
      p = Point{table_.last().angle, table_.last().shift, 0, 0};
      done = cycles_ - 1;
      out.cycle = cycles_;
    } else if (t > 0) {
      const double phase = std::fmod(t, period);  // exact, so that every run gives the same numbers
      done = std::floor((t - phase) / period + 0.5);
      p = table_.at(phase);
      out.cycle = done + phase / period;
    }
    const double angle = p.angle + done * (table_.last().angle - table_.first().angle);
    const double shift = p.shift + done * (table_.last().shift - table_.first().shift);
    calx::rigid::turn(out, origin_, axis_, angle, p.angle_rate);
    calx::rigid::set(out.displacement, direction_, shift);
    calx::rigid::set(out.velocity, direction_, p.shift_rate);
  }
  double duration() const noexcept override {
    return cycles_ > 0 ? cycles_ * table_.end() : std::numeric_limits<double>::infinity();
  }
  double top_speed(double radius) const noexcept override {
    return table_.top_shift_rate() + table_.top_angle_rate() * radius;
  }

 private:
  Vector origin_, axis_, direction_;
  double cycles_;
  Table table_;
};

const calx_descriptor MotionTable::descriptor = {sizeof(calx_descriptor),
                                                 0,
                                                 "calx.motion-table",
                                                 CALX_MOTION,
                                                 "Motion from a table",
                                                 "1.0.0",
                                                 "Calx",
                                                 "Apache-2.0",
                                                 "Follows rows of time, angle and displacement.",
                                                 0,
                                                 fields,
                                                 sizeof fields / sizeof fields[0],
                                                 0,
                                                 schema};

}  // namespace

CALX_PLUGIN(MotionTable)
