// sensor_kinds.hpp: names of the built-in sensors, for schema, messages and documents; core/measure makes them.
#pragma once
#include <string>
#include <vector>

namespace calx {

struct SensorKind {
  const char* name;
  const char* measures;  // one phrase
  const char* keys;      // beside name, kind, every and instruments: "region, motion, first"
};

/// In the order in which lists show them.
const std::vector<SensorKind>& sensor_kinds();

/// Any other kind is the id of a plugin, which has a dot.
bool is_builtin_sensor(const std::string& kind);

/// `unknown kind of sensor "part-lod"; did you mean "part-load"? Built in are ...; others are named by their plugin's
/// id`.
std::string unknown_sensor_kind(const std::string& kind);

/// A table for people: kind, what it measures, keys.
std::string sensor_kinds_text();

}  // namespace calx
