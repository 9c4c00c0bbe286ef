// Parts, motions, stages, particle forces and sensors.
#include <algorithm>

#include "base/nearest.hpp"
#include "config/case_reader.hpp"
#include "config/sensor_kinds.hpp"

namespace calx {

void CaseReader::read_parts(Object& root) {
  for (const Node& node : root.items("parts", "parts")) {
    PartSettings p;
    p.pointer = node.pointer();
    Object object(node, "a part");
    const Node name = object.need("name", "a name for the part");
    p.name = name.text("a name");
    check_name(name, p.name);
    for (const PartSettings& other : case_.parts)
      if (other.name == p.name) name.fail("another part is called \"" + p.name + "\"; names of parts must differ");
    p.geometry =
        object.need("geometry", "the id of a geometry, such as \"calx.cylinder\"").text("the id of a geometry");
    p.parameters = object.parameters();
    p.material = object.need("material", "the name of a material").name_of("material", names_.materials);
    if (const auto motion = object.find("motion")) p.motion = motion->name_of("motion", names_.motions);
    if (const auto e = object.find("appears")) p.appears = event(*e, "part " + p.name + " appears");
    if (const auto e = object.find("vanishes")) p.vanishes = event(*e, "part " + p.name + " vanishes");
    p.present = object.boolean("present", p.appears.empty());
    p.assumed = object.boolean("assumed", false);
    object.done();
    case_.parts.push_back(p);
  }
}

void CaseReader::read_motions(Object& root) {
  for (const auto& entry : root.section("motions", "motions by name").entries()) {
    check_name(entry.second, entry.first);
    MotionSettings m;
    m.name = entry.first;
    m.pointer = entry.second.pointer();
    Object object(entry.second, "a motion");
    m.plugin = object.need("plugin", "the id of a motion, such as \"calx.reciprocate\"").text("the id of a motion");
    m.parameters = object.parameters();
    if (const auto start = object.find("start")) m.start = event(*start, "motion " + m.name);
    if (const auto carrier = object.find("carried_by")) m.carried_by = carrier->name_of("motion", names_.motions);
    object.done();
    case_.motions.push_back(m);
  }
  for (const MotionSettings& m : case_.motions) {
    std::string chain = "\"" + m.name + "\"";
    const MotionSettings* at = &m;
    for (std::size_t steps = 0; !at->carried_by.empty(); ++steps) {
      chain += " is carried by \"" + at->carried_by + "\"";
      if (at->carried_by == m.name || steps > case_.motions.size())
        document_.fail(m.pointer + "/carried_by", chain + "; a motion must not carry itself");
      at = &*std::find_if(case_.motions.begin(), case_.motions.end(),
                          [&](const MotionSettings& other) { return other.name == at->carried_by; });
    }
  }
}

void CaseReader::read_stages(Object& root) {
  const std::vector<Node> nodes = root.items("stages", "stages");
  for (const Node& node : nodes) {
    StageSettings s;
    s.pointer = node.pointer();
    Object object(node, "a stage");
    const Node name = object.need("name", "a name for the stage");
    s.name = name.text("a name");
    check_name(name, s.name);
    for (const StageSettings& other : case_.stages)
      if (other.name == s.name) name.fail("another stage is called \"" + s.name + "\"; names of stages must differ");
    s.add = object.names("add", "part", names_.parts);
    s.remove = object.names("remove", "part", names_.parts);
    s.start = object.names("start", "motion", names_.motions);
    if (const auto until = object.find("until"))
      s.until = event(*until, "stage " + s.name);
    else if (&node != &nodes.back())
      object.need("until", "the event or condition that ends it; only the last stage may last to the end");
    object.done();
    case_.stages.push_back(s);
  }
}

void CaseReader::read_forces(Object& root) {
  for (const Node& node : root.items("forces", "particle forces")) {
    Object object(node, "a particle force");
    ForceSettings f;
    f.pointer = node.pointer();
    f.plugin = object.need("plugin", "the id of a particle force").text("the id of a particle force");
    f.parameters = object.parameters();
    object.done();
    case_.forces.push_back(f);
  }
}

void CaseReader::read_instruments(const Node& sensor, SensorSettings& s) {
  Object all(sensor, "a sensor");
  for (const Node& node : all.items("instruments", "instruments")) {
    Object object(node, "an instrument");
    InstrumentSettings i;
    i.pointer = node.pointer();
    i.plugin = object.need("plugin", "the id of an instrument").text("the id of an instrument");
    i.column = object.text("column", "the name of a column");
    i.parameters = object.parameters();
    object.done();
    s.instruments.push_back(i);
  }
}

// Which other keys a sensor has is known by its kind, so they are kept as they are.
void CaseReader::read_sensors(Object& root) {
  for (const Node& node : root.items("sensors", "sensors")) {
    Object object(node, "a sensor");
    SensorSettings s;
    s.pointer = node.pointer();
    const Node name = object.need("name", "a name for the sensor");
    s.name = name.text("a name");
    check_name(name, s.name);
    for (const SensorSettings& other : case_.sensors)
      if (other.name == s.name) name.fail("another sensor is called \"" + s.name + "\"; names of sensors must differ");
    const auto plugin = object.find("plugin");
    if (plugin && object.has("kind")) plugin->fail("a sensor has a \"kind\" or a \"plugin\"; must have one");
    const Node kind = plugin ? *plugin : object.need("kind", "the kind of sensor, such as \"mass\", or \"plugin\"");
    s.kind = kind.text(plugin ? "the id of a sensor" : "a kind of sensor");
    if (!is_builtin_sensor(s.kind) && s.kind.find('.') == std::string::npos) kind.fail(unknown_sensor_kind(s.kind));
    s.every = object.need("every", "the simulated time between samples in s").number("s", Allow::above_zero);
    s.parameters = node.parameters();
    Json own = node.json();
    if (const auto region = object.find("region")) own["region"] = region_name(*region, "sensor " + s.name);
    own.erase("instruments");
    s.parameters.json = own.dump();
    read_instruments(node, s);
    if (s.kind == "energy") case_.energy_ledger = true;
    case_.sensors.push_back(s);
  }
}

}  // namespace calx
