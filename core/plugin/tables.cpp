#include "plugin/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "base/sha256.hpp"

namespace calx {
namespace {

bool is_name(const char* text) {
  if (!text || *text < 'a' || *text > 'z') return false;
  for (; *text; ++text)
    if (!((*text >= 'a' && *text <= 'z') || (*text >= '0' && *text <= '9') || *text == '_')) return false;
  return true;
}

std::uint32_t group_of(const calx_field& field) { return (field.flags >> 8) & 0xffu; }

std::string field_fault(const calx_field& f) {
  if (!f.unit || !*f.unit) return "has no unit; write \"1\" for none";
  if (!f.doc || !*f.doc) return "has no meaning (doc)";
  if (!std::isfinite(f.preset)) return "has a preset that is not finite";
  if (std::isnan(f.lowest) || std::isnan(f.highest) || !(f.lowest <= f.preset && f.preset <= f.highest))
    return "does not keep lowest <= preset <= highest";
  if (f.flags & CALX_FIELD_CHOICE) {
    const auto names = 1 + std::count(f.unit, f.unit + std::strlen(f.unit), '|');
    if (f.lowest != 0 || f.highest != static_cast<double>(names - 1) || f.preset != std::floor(f.preset))
      return "offers " + std::to_string(names) + " names, so its range must be 0 to " + std::to_string(names - 1) +
             " and its preset whole";
  }
  if ((f.flags & CALX_FIELD_INTEGER) && f.preset != std::floor(f.preset)) return "is whole but its preset is not";
  return "";
}

/// first: a row that opens a vector group; the two after it must belong to it, and no others.
std::string vector_fault(const calx_field* fields, std::uint32_t count, std::uint32_t first, bool users_write) {
  const std::uint32_t group = group_of(fields[first]);
  std::uint32_t rows = 0;
  for (std::uint32_t k = 0; k < count; ++k) rows += group_of(fields[k]) == group;
  if (rows != 3 || first + 2 >= count || group_of(fields[first + 1]) != group || group_of(fields[first + 2]) != group)
    return "opens a vector group that is not three rows, one after the other";
  if (!users_write) return "";
  const std::string x = fields[first].name;
  const std::string stem = x.size() > 2 ? x.substr(0, x.size() - 1) : "";
  if (stem.empty() || x != stem + "x" || fields[first + 1].name != stem + "y" || fields[first + 2].name != stem + "z")
    return "opens a vector group whose rows are not called NAME_x, NAME_y, NAME_z";
  return "";
}

std::string lacks(const char* kind, const char* member) {
  return std::string("its table ") + kind + " lacks " + member;
}

std::string law_text_fault(const calx_contact_law& law) {
  if (!law.source && law.source_size == 0) return "";  // a law without a text runs on the CPU only
  if (!law.source || law.source_size == 0) return lacks(CALX_CONTACT_LAW, law.source ? "source_size" : "source");
  if (law.source_size > 65536)
    return "its law text has " + std::to_string(law.source_size) + " bytes; 65536 are allowed";
  if (law.dialect != 1)
    return "its law text is written in dialect " + std::to_string(law.dialect) + ", this host reads dialect 1";
  if (!is_name(law.symbol)) return lacks(CALX_CONTACT_LAW, "a symbol of lower-case letters, digits and _");
  const std::string hash = sha256(law.source, static_cast<std::size_t>(law.source_size));
  if (!law.source_sha256 || hash != law.source_sha256)
    return "its law text has SHA-256 " + hash + ", but it was compiled from " +
           (law.source_sha256 ? law.source_sha256 : "a text without one");
  return "";
}

std::string contact_law_fault(const calx_contact_law& law) {
  struct Table {
    const char* name;
    const calx_field* fields;
    std::uint32_t count;
    bool users_write;
  };
  for (const Table& t :
       {Table{"material", law.material, law.material_count, true}, Table{"given", law.given, law.given_count, true},
        Table{"pair", law.pair, law.pair_count, false}, Table{"prop", law.prop, law.prop_count, false},
        Table{"state", law.state, law.state_count, false}}) {
    const std::string fault = field_table_fault(t.name, t.fields, t.count, t.users_write);
    if (!fault.empty()) return fault;
  }
  if (!law.eval_f64) return lacks(CALX_CONTACT_LAW, "eval_f64");
  if (!law.derive && law.given_count != law.pair_count)
    return "it has no derive, so its given and pair tables must be the same, but they have " +
           std::to_string(law.given_count) + " and " + std::to_string(law.pair_count) + " rows";
  for (std::uint32_t k = 0; k < law.state_count; ++k)
    if (!law.reach && law.state[k].flags & CALX_FIELD_KEEP_APART)
      return std::string("its history \"") + law.state[k].name +
             "\" survives separation, but it has no reach, up to which it could";
  if (law.needs >> CALX_IN_COUNT)
    return "it needs an input column this host does not have (needs = " + std::to_string(law.needs) + ", known are " +
           std::to_string(CALX_IN_COUNT) + " bits)";
  return law_text_fault(law);
}

std::string sensor_fault(const calx_sensor& sensor) {
  if (!sensor.sample) return lacks(CALX_SENSOR, "sample");
  if (sensor.output_count == 0) return "its output table is empty";
  return field_table_fault("output", sensor.output, sensor.output_count, false);
}

std::string motion_fault(const calx_motion& motion) {
  if (!motion.pose) return lacks(CALX_MOTION, "pose");
  if (!motion.duration) return lacks(CALX_MOTION, "duration");
  return motion.top_speed ? "" : lacks(CALX_MOTION, "top_speed");
}

std::string servo_fault(const calx_servo& servo) {
  if (!servo.pose) return lacks(CALX_SERVO, "pose");
  if (!servo.advance) return lacks(CALX_SERVO, "advance");
  if (!servo.top_speed) return lacks(CALX_SERVO, "top_speed");
  return servo.reach ? "" : lacks(CALX_SERVO, "reach");
}

std::string state_fault(const calx_state& state) {
  if (!state.save) return lacks(CALX_STATE, "save");
  return state.load ? "" : lacks(CALX_STATE, "load");
}

}  // namespace

const std::vector<std::string>& known_kinds() {
  static const std::vector<std::string> kinds = {CALX_CONTACT_LAW,    CALX_GEOMETRY, CALX_MOTION,
                                                 CALX_PARTICLE_FORCE, CALX_SENSOR,   CALX_SERVO};
  return kinds;
}

std::string field_table_fault(const char* table, const calx_field* fields, std::uint32_t count, bool users_write) {
  const std::string where = std::string("its ") + table + " table ";
  if (count > field_limit)
    return where + "has " + std::to_string(count) + " rows; " + std::to_string(field_limit) + " are allowed";
  if (count > 0 && !fields) return where + "is null but announces " + std::to_string(count) + " rows";
  for (std::uint32_t k = 0; k < count; ++k) {
    const calx_field& f = fields[k];
    if (!is_name(f.name))
      return where + "row " + std::to_string(k) + " is called \"" + (f.name ? f.name : "") +
             "\"; names begin with a lower-case letter and go on with those, digits and _";
    for (std::uint32_t other = 0; other < k; ++other)
      if (std::strcmp(fields[other].name, f.name) == 0) return where + "has two rows called \"" + f.name + "\"";
    const std::string fault = field_fault(f);
    if (!fault.empty()) return where + "row \"" + f.name + "\" " + fault;
  }
  // Once every name is known to be there.
  for (std::uint32_t k = 0; k < count; ++k) {
    if (group_of(fields[k]) == 0 || (k > 0 && group_of(fields[k - 1]) == group_of(fields[k]))) continue;
    const std::string fault = vector_fault(fields, count, k, users_write);
    if (!fault.empty()) return where + "row \"" + fields[k].name + "\" " + fault;
  }
  return "";
}

std::string descriptor_fault(const calx_descriptor& d) {
  // The size of release 1.0; later releases may only add behind extra_schema.
  constexpr std::uint32_t needed = offsetof(calx_descriptor, extra_schema) + sizeof(const char*);
  if (d.struct_size < needed)
    return "a descriptor has " + std::to_string(d.struct_size) + " bytes, ABI 1.0 needs " + std::to_string(needed);
  for (const char* text : {d.id, d.kind, d.name, d.version, d.vendor, d.license, d.summary})
    if (!text) return "a descriptor lacks one of id, kind, name, version, vendor, license, summary";
  const std::string fault = field_table_fault("parameter", d.parameter, d.parameter_count, true);
  return fault.empty() ? "" : "the descriptor of " + std::string(d.id) + " is wrong: " + fault;
}

std::string abi_version() { return std::to_string(CALX_ABI_MAJOR) + "." + std::to_string(CALX_ABI_MINOR); }

std::string interface_fault(const std::string& kind, const void* table) {
  if (!table) return "it has no table " + kind;
  struct Head {
    std::uint32_t struct_size, draft;
  } head;
  std::memcpy(&head, table, sizeof head);
  const struct {
    const char* id;
    std::size_t size;
  } sizes[] = {{CALX_CONTACT_LAW, sizeof(calx_contact_law)},
               {CALX_GEOMETRY, sizeof(calx_geometry)},
               {CALX_MOTION, sizeof(calx_motion)},
               {CALX_PARTICLE_FORCE, sizeof(calx_particle_force)},
               {CALX_SENSOR, sizeof(calx_sensor)},
               {CALX_SERVO, sizeof(calx_servo)},
               {CALX_STATE, sizeof(calx_state)}};
  const auto known = std::find_if(std::begin(sizes), std::end(sizes), [&](const auto& s) { return kind == s.id; });
  if (known == std::end(sizes)) return "this host does not know the kind " + kind;
  if (head.draft != CALX_ABI_DRAFT)
    return "its table " + kind + " was built against draft " + std::to_string(head.draft) +
           ", this host speaks the released one of ABI " + abi_version() + ": rebuild it";
  // Tables of functions never grow, so their size is that of release 1.0.
  if (head.struct_size < known->size)
    return "its table " + kind + " has " + std::to_string(head.struct_size) + " bytes, ABI 1.0 needs " +
           std::to_string(known->size) + ": rebuild it";
  if (kind == CALX_CONTACT_LAW) return contact_law_fault(*static_cast<const calx_contact_law*>(table));
  if (kind == CALX_GEOMETRY)
    return static_cast<const calx_geometry*>(table)->build ? "" : lacks(CALX_GEOMETRY, "build");
  if (kind == CALX_MOTION) return motion_fault(*static_cast<const calx_motion*>(table));
  if (kind == CALX_PARTICLE_FORCE)
    return static_cast<const calx_particle_force*>(table)->eval ? "" : lacks(CALX_PARTICLE_FORCE, "eval");
  if (kind == CALX_SENSOR) return sensor_fault(*static_cast<const calx_sensor*>(table));
  if (kind == CALX_SERVO) return servo_fault(*static_cast<const calx_servo*>(table));
  return state_fault(*static_cast<const calx_state*>(table));
}

}  // namespace calx
