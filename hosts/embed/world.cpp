// world.cpp: particle columns, parts and sensors as the surrounding program sees them.
#include <cmath>
#include <cstring>

#include "base/nearest.hpp"
#include "simulation.hpp"

using namespace calx;

namespace {

/// A column over rows of T whose first component lies `offset` bytes into a row.
template <class T>
calx_sim_column column(Column<T>& rows, std::size_t offset, std::uint32_t components, const char* unit, bool writable) {
  calx_sim_column out{};
  out.data = reinterpret_cast<char*>(rows.data()) + offset;
  out.rows = rows.size();
  out.stride = sizeof(T);
  out.components = components;
  out.unit = unit;
  out.is_integer = std::is_same<T, std::uint32_t>::value;
  out.writable = writable;
  return out;
}

calx_sim_column named_column(Particles& p, const std::string& name) {
  if (name == "position") return column(p.body, offsetof(Record, x), 3, "m", true);
  if (name == "velocity") return column(p.body, offsetof(Record, vx), 3, "m/s", true);
  if (name == "spin") return column(p.body, offsetof(Record, wx), 3, "rad/s", true);
  if (name == "mass") return column(p.body, offsetof(Record, m), 1, "kg", false);
  if (name == "orientation") return column(p.turn, 0, 4, "1", true);
  if (name == "scale") return column(p.scale, 0, 1, "1", false);
  if (name == "id") return column(p.id, 0, 1, "1", false);
  if (name == "material") return column(p.material, 0, 1, "1", false);
  if (name == "shape") return column(p.shape, 0, 1, "1", false);
  const std::string near =
      nearest_name(name, {"position", "velocity", "spin", "mass", "orientation", "scale", "id", "material", "shape"});
  misused("calx_sim_particles: no column \"" + name + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

void put(const Vec3& v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
Vec3 vector(const double* v) { return {v[0], v[1], v[2]}; }

const WorldView& world_of(const calx_sim* sim, const char* function, std::uint32_t part) {
  const WorldView& world = needed(sim, function, "sim").simulation->world();
  if (part >= world.part_count())
    misused(std::string(function) + ": part " + std::to_string(part) + " of " + std::to_string(world.part_count()));
  return world;
}

/// The index of the name in a list made by `at`.
template <class At>
std::uint32_t find(const char* function, const char* name, std::size_t count, const At& at) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    if (at(k) == name) return static_cast<std::uint32_t>(k);
    names.push_back(at(k));
  }
  const std::string near = nearest_name(name, names);
  misused(std::string(function) + ": the case has none named \"" + name + "\"" +
          (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

}  // namespace

std::int32_t calx_sim_particles(calx_sim* sim, const char* name, calx_sim_column* out) {
  return guarded([&] {
    calx_sim& s = needed(sim, "calx_sim_particles", "sim");
    needed(out, "calx_sim_particles", "out") =
        named_column(s.simulation->edit_particles(), &needed(name, "calx_sim_particles", "name"));
  });
}

std::uint64_t calx_sim_particle_count(const calx_sim* sim) { return sim ? sim->simulation->particle_count() : 0; }

std::int32_t calx_sim_particles_written(calx_sim* sim) {
  return guarded([&] { needed(sim, "calx_sim_particles_written", "sim").simulation->particles_written(); });
}

std::int32_t calx_sim_part(const calx_sim* sim, const char* name, std::uint32_t* part) {
  return guarded([&] {
    const WorldView& w = needed(sim, "calx_sim_part", "sim").simulation->world();
    needed(name, "calx_sim_part", "name");
    needed(part, "calx_sim_part", "part") =
        find("calx_sim_part", name, w.part_count(), [&](std::size_t k) { return w.part_name(k); });
  });
}

std::int32_t calx_sim_part_pose(const calx_sim* sim, std::uint32_t part, calx_sim_pose* out) {
  return guarded([&] {
    const Pose p = world_of(sim, "calx_sim_part_pose", part).part_pose(part);
    calx_sim_pose& o = needed(out, "calx_sim_part_pose", "out");
    put(p.shift, o.position);
    put(p.centre, o.centre);
    put(p.velocity, o.velocity);
    put(p.spin, o.spin);
    o.orientation[0] = p.turn.w, o.orientation[1] = p.turn.x, o.orientation[2] = p.turn.y, o.orientation[3] = p.turn.z;
  });
}

std::int32_t calx_sim_part_load(const calx_sim* sim, std::uint32_t part, double force[3], double torque[3]) {
  return guarded([&] {
    const PartLoad load = world_of(sim, "calx_sim_part_load", part).part_load(part);
    put(load.force, &needed(force, "calx_sim_part_load", "force"));
    put(load.torque, &needed(torque, "calx_sim_part_load", "torque"));
  });
}

std::int32_t calx_sim_drive_part(calx_sim* sim, std::uint32_t part, const calx_sim_pose* pose) {
  return guarded([&] {
    const char* const function = "calx_sim_drive_part";
    world_of(sim, function, part);
    const calx_sim_pose& given = needed(pose, function, "pose");
    Pose p;
    p.shift = vector(given.position);
    p.centre = vector(given.centre);
    p.velocity = vector(given.velocity);
    p.spin = vector(given.spin);
    const double* q = given.orientation;
    p.turn = {q[0], q[1], q[2], q[3]};
    const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(std::fabs(length2 - 1) < 1e-9))
      misused(std::string(function) + ": the squared length of the quaternion is " + std::to_string(length2) +
              "; it must be 1");
    if (!std::isfinite(norm2(p.shift) + norm2(p.centre) + norm2(p.velocity) + norm2(p.spin)))
      misused(std::string(function) + ": a number of the pose is not finite");
    sim->simulation->drive_part(part, p);
  });
}

std::uint32_t calx_sim_sensor_count(const calx_sim* sim) {
  return sim ? static_cast<std::uint32_t>(sim->columns.size()) : 0;
}

std::int32_t calx_sim_sensor(const calx_sim* sim, const char* name, std::uint32_t* sensor) {
  return guarded([&] {
    auto& sensors = needed(sim, "calx_sim_sensor", "sim").simulation->sensors();
    needed(name, "calx_sim_sensor", "name");
    needed(sensor, "calx_sim_sensor", "sensor") =
        find("calx_sim_sensor", name, sensors.size(), [&](std::size_t k) { return sensors[k]->name(); });
  });
}

std::uint32_t calx_sim_sensor_columns(const calx_sim* sim, std::uint32_t sensor) {
  return sensor < calx_sim_sensor_count(sim) ? static_cast<std::uint32_t>(sim->columns[sensor].size()) : 0;
}

const char* calx_sim_sensor_column(const calx_sim* sim, std::uint32_t sensor, std::uint32_t column) {
  return column < calx_sim_sensor_columns(sim, sensor) ? sim->columns[sensor][column].c_str() : nullptr;
}

std::int32_t calx_sim_sample(calx_sim* sim, std::uint32_t sensor, double* values, std::uint32_t room) {
  return guarded([&] {
    Simulation& s = *needed(sim, "calx_sim_sample", "sim").simulation;
    needed(values, "calx_sim_sample", "values");
    if (sensor >= s.sensors().size())
      misused("calx_sim_sample: sensor " + std::to_string(sensor) + " of " + std::to_string(s.sensors().size()));
    const std::uint32_t count = calx_sim_sensor_columns(sim, sensor);
    if (room < count)
      misused("calx_sim_sample: room for " + std::to_string(room) + " numbers, the sensor has " +
              std::to_string(count));
    const std::vector<double> row = s.sensors()[sensor]->sample(s.world());
    std::memcpy(values, row.data(), std::min<std::size_t>(row.size(), count) * sizeof(double));
  });
}
