#include "config/sensor_kinds.hpp"

#include <algorithm>

#include "base/nearest.hpp"
#include "base/text_table.hpp"

namespace calx {

const std::vector<SensorKind>& sensor_kinds() {
  static const std::vector<SensorKind> kinds = {
      {"mass", "mass of the particles in a region", "region"},
      {"cycle-mass", "mass that a region gains in each cycle of a motion", "region, motion, first"},
      {"flow", "mass through a plane, or into a region, and its rate",
       "region, point, normal, radius, direction, every_step"},
      {"bulk-density", "mass of solid per volume of a region", "region"},
      {"coordination", "contacts and partners of a particle, overlaps", "region, rattler_partners"},
      {"height-map", "surface of a bed over a grid", "region, cell, section_y"},
      {"angle-of-repose", "angles of the flanks of a pile", "region, shape, sectors, centre, direction"},
      {"discharge", "mass left in a vessel, its steady rate, and Beverloo's estimate",
       "region, bed, opening, width, length, c, k, from, to"},
      {"drum-surface", "surface of the bed in a turning drum, dynamic angle of repose",
       "region, start, cell, near, far"},
      {"inertial-number", "whether a bed deforms quasi-statically", "region, start"},
      {"residue", "mass left lying on a part or in a region", "part, region, speed"},
      {"part-load", "force, torque and power of the particles on a part", "part, every_step"},
      {"stress", "normal and shear stress on parts", "parts, area, normal, shear, below, slider"},
      {"cell-density", "height and density of the powder in a cell for each load or tap",
       "motion, area, region, lid, height, floor, up, window"},
      {"wall-friction", "points and line of a wall yield locus",
       "parts, area, normal, shear, below, slider, motion, window, steady, first"},
      {"yield-locus", "pre-shear, yield points and locus of a shear test",
       "parts, area, normal, shear, below, slider, motion, pattern, window, steady, prorate"},
      {"energy", "energies of all particles, work, and what does not close", ""},
      {"mass-ledger", "where every particle is", "regions"}};
  return kinds;
}

bool is_builtin_sensor(const std::string& kind) {
  const auto& all = sensor_kinds();
  return std::any_of(all.begin(), all.end(), [&](const SensorKind& each) { return kind == each.name; });
}

std::string unknown_sensor_kind(const std::string& kind) {
  std::vector<std::string> known;
  std::string list;
  for (const SensorKind& each : sensor_kinds()) {
    known.push_back(each.name);
    list += std::string(list.empty() ? "" : ", ") + each.name;
  }
  const std::string near = nearest_name(kind, known);
  return "unknown kind of sensor \"" + kind + "\"; " + (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
         "Built in are " + list + "; others are named by their plugin's id";
}

std::string sensor_kinds_text() {
  std::vector<std::vector<std::string>> rows = {{"kind", "measures", "keys beside name, kind, every, instruments"}};
  for (const SensorKind& each : sensor_kinds()) rows.push_back({each.name, each.measures, each.keys});
  return text_table(rows);
}

}  // namespace calx
