// The JSON Schema of a case. Keys and defaults follow the readers of this module; tests hold the two together.
#include "config/config.hpp"
#include "config/schema.hpp"
#include "config/sensor_kinds.hpp"

namespace calx {
namespace {

using namespace schema;

const Properties above_zero = {{"exclusiveMinimum", 0}};
const Properties not_negative = {{"minimum", 0}};

Json parameters() {
  return {{"type", "object"}, {"description", "what the plugin takes; see `calx plugin schema ID`"}};
}

Json region() {
  const Json box =
      object("box along the axes", {{"min", vector("lowest corner", "m")}, {"max", vector("highest corner", "m")}},
             {"min", "max"});
  const Json from = vector("one end of the axis", "m"), to = vector("other end of the axis", "m");
  const Json cylinder = object("cylinder", {{"from", from}, {"to", to}, {"radius", number("radius", "m", above_zero)}},
                               {"from", "to", "radius"});
  const Json cone = object("cone or frustum",
                           {{"from", from},
                            {"to", to},
                            {"radius_from", number("radius at \"from\"", "m", not_negative)},
                            {"radius_to", number("radius at \"to\"", "m", not_negative)}},
                           {"from", "to", "radius_from", "radius_to"});
  const Json sphere =
      object("sphere", {{"centre", vector("centre", "m")}, {"radius", number("radius", "m", above_zero)}},
             {"centre", "radius"});
  Json out =
      object("a volume in the world frame: one of box, cylinder, cone, sphere",
             {{"box", box},
              {"cylinder", cylinder},
              {"cone", cone},
              {"sphere", sphere},
              {"follows", text("name of a part whose motion carries the region; without it the region stands still")}});
  out["oneOf"] = Json::array();
  for (const char* kind : {"box", "cylinder", "cone", "sphere"}) out["oneOf"].push_back({{"required", {kind}}});
  return out;
}

Json condition() {
  const Json where =
      any_of("name of a region, or one written here; without it the whole domain", {text("name"), ref("region")});
  const auto amount = [&](const std::string& doc, const Json& limit) {
    Json out = object(doc, {{"region", where}, {"at_least", limit}, {"at_most", limit}});
    out["oneOf"] = {{{"required", {"at_least"}}}, {{"required", {"at_most"}}}};
    return out;
  };
  const Json settled =
      object("particles have come to rest",
             {{"region", where},
              {"kinetic_per_particle",
               preset(number("mean kinetic energy below which they rest; 0: m g d / 1000", "J", not_negative), 0.0)},
              {"hold", preset(number("for this long", "s", not_negative), 0.0)},
              {"not_before", preset(number("not earlier than this after the wait begins", "s", not_negative), 0.0)}});
  Json out = object(
      "when something happens: exactly one of these keys",
      {{"time", number("at this simulated time", "s", not_negative)},
       {"mass", amount("mass of particles in a region", number("limit", "kg", not_negative))},
       {"count", amount("number of particles in a region", whole("limit", 0))},
       {"settled", settled},
       {"cycle", object("a motion has completed cycles",
                        {{"motion", text("name of a motion")}, {"number", whole("cycles", 1)}}, {"motion", "number"})},
       {"after",
        object("some time after another event",
               {{"event", text("name of an event")}, {"delay", preset(number("delay", "s", not_negative), 0.0)}},
               {"event"})},
       {"event", text("name of an event: short for \"after\" without delay")},
       {"all", list("when all of these have happened", ref("condition"))},
       {"any", list("when one of these has happened", ref("condition"))}});
  out["minProperties"] = out["maxProperties"] = 1;
  return any_of("a condition, or the name of an event", {text("name of an event"), out});
}

Json size() {
  const Json factor = number("scale factor, 1 = as drawn", "1", above_zero);
  const auto distribution = [&](const std::string& name, const std::string& doc, Properties more,
                                std::vector<std::string> need) {
    more.insert(more.begin(), {"distribution", {{"const", name}}});
    need.insert(need.begin(), "distribution");
    return object(doc, more, need);
  };
  const Json lowest = number("cut-off below; default three deviations", "1", above_zero);
  const Json highest = number("cut-off above; default three deviations", "1", above_zero);
  return any_of(
      "scale factor of the shape",
      {factor, object("one size", {{"scale", factor}}, {"scale"}),
       distribution("uniform", "all scales between two equally likely by number",
                    {{"lowest", factor}, {"highest", factor}}, {"lowest", "highest"}),
       distribution("normal", "normal by number",
                    {{"mean", preset(factor, 1.0)},
                     {"deviation", number("standard deviation of the scale", "1", above_zero)},
                     {"lowest", lowest},
                     {"highest", highest}},
                    {"deviation"}),
       distribution("lognormal", "lognormal by number",
                    {{"median", preset(factor, 1.0)},
                     {"deviation", number("standard deviation of ln(scale)", "1", above_zero)},
                     {"lowest", lowest},
                     {"highest", highest}},
                    {"deviation"}),
       distribution("list", "given scales and their shares by mass",
                    {{"scales", list("scale factors", factor)},
                     {"shares", list("share by mass of each; need not sum to 1", number("share", "1", not_negative))}},
                    {"scales", "shares"})});
}

Json source() {
  const Json quaternion = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 4}, {"maxItems", 4}};
  return object(
      "makes particles: fills a region with a mass or a count, or puts them at given positions",
      {{"name", text("name; default \"source 0\", \"source 1\", ...")},
       {"shape", text("name of a shape")},
       {"material", text("name of a material with a density")},
       {"size", ref("size")},
       {"region", any_of("name of a region, or one written here", {text("name"), ref("region")})},
       {"mass", number("mass to make", "kg", above_zero)},
       {"count", whole("number of particles to make, instead of mass", 1)},
       {"rate", number("mass flow; 0: all at once", "kg/s", not_negative)},
       {"velocity", preset(vector("velocity of new particles", "m/s"), {0.0, 0.0, 0.0})},
       {"when", any_of("event at which it begins; without it at t = 0", {ref("condition")})},
       {"random_orientation",
        boolean("turn each particle at random; default false where orientations are given", true)},
       {"positions", list("centres of mass, instead of a region", vector("position", "m"))},
       {"orientations", list("unit quaternion [w, x, y, z] of each position", quaternion)},
       {"velocities", list("velocity of each position", vector("velocity", "m/s"))},
       {"spins", list("angular velocity of each position", vector("spin", "rad/s"))},
       {"file",
        text(
            "CSV with header x_m,y_m,z_m[,vx_m_s,vy_m_s,vz_m_s][,scale], instead of positions; relative to the case")}},
      {"shape", "material"});
}

Json contact() {
  const Json law = object("one law",
                          {{"law", text("id of a contact law")},
                           {"parameters", parameters()},
                           {"name", text("unique in the list; default: the id")}},
                          {"law"});
  Json out =
      object("the law, or the list of laws whose forces add, of a pair of materials",
             {{"between", {{"type", "array"}, {"items", text("name of a material")}, {"minItems", 2}, {"maxItems", 2}}},
              {"law", text("id of a contact law, where there is one")},
              {"parameters", parameters()},
              {"name", text("name of the law; default: its id")},
              {"laws", list("several laws", law)}},
             {"between"});
  out["oneOf"] = {{{"required", {"law"}}}, {{"required", {"laws"}}}};
  return out;
}

Json shape() {
  const Json radius = number("radius", "m", above_zero);
  Json out = object(
      "rigid particle made of one or more spheres; it need not be centred",
      {{"spheres", list("spheres in the frame of the shape",
                        object("a sphere", {{"at", vector("centre", "m")}, {"radius", radius}}, {"at", "radius"}))},
       {"sphere", object("a single sphere", {{"radius", radius}}, {"radius"})}});
  out["oneOf"] = {{{"required", {"spheres"}}}, {{"required", {"sphere"}}}};
  return out;
}

Json material() {
  return {{"type", "object"},
          {"description", "properties of a material; contact laws name further ones"},
          {"properties",
           {{"density", number("density, needed where particles are made of it", "kg/m^3", above_zero)},
            {"young", number("Young's modulus", "Pa", above_zero)},
            {"poisson", number("Poisson's ratio", "1", {{"exclusiveMinimum", -1}, {"maximum", 0.5}})}}}};
}

Json part() {
  return object("a wall of the machine",
                {{"name", text("unique name")},
                 {"geometry", text("id of a geometry plugin")},
                 {"parameters", parameters()},
                 {"material", text("name of a material")},
                 {"motion", text("name of a motion; without it the part stands still")},
                 {"present", boolean("there from the start; default false where \"appears\" is given", true)},
                 {"appears", ref("condition")},
                 {"vanishes", ref("condition")},
                 {"assumed", boolean("its dimensions are an assumption; marked in the report", false)}},
                {"name", "geometry", "material"});
}

Json sensor() {
  std::vector<Json> kinds;
  for (const SensorKind& each : sensor_kinds()) {
    const std::string keys = each.keys;
    kinds.push_back(
        {{"const", each.name}, {"description", std::string(each.measures) + (keys.empty() ? "" : "; keys: " + keys)}});
  }
  kinds.push_back({{"type", "string"}, {"pattern", "\\."}, {"description", "the id of a sensor plugin"}});
  Json out = {{"type", "object"},
              {"description", "samples a figure into series/<name>.csv; further keys belong to its kind"},
              {"properties",
               {{"name", text("unique name")},
                {"kind", any_of("a built-in kind, or the id of a sensor plugin", kinds)},
                {"plugin", text("id of a sensor plugin, instead of kind")},
                {"every", number("simulated time between samples", "s", above_zero)},
                {"region", any_of("name of a region, or one written here", {text("name"), ref("region")})},
                {"instruments", list("what the figures pass before they are recorded, in this order",
                                     object("a sensor plugin that reads this sensor",
                                            {{"plugin", text("id of the plugin")},
                                             {"column", text("column it changes; default: the first")},
                                             {"parameters", parameters()}},
                                            {"plugin"}))}}},
              {"required", {"name", "every"}}};
  out["oneOf"] = {{{"required", {"kind"}}}, {{"required", {"plugin"}}}};
  return out;
}

Json stage() {
  const Json parts = list("names of parts", text("name of a part"));
  return object("a phase of the run; it begins when the one before ends",
                {{"name", text("unique name")},
                 {"until", ref("condition")},
                 {"add", parts},
                 {"remove", parts},
                 {"start", list("names of motions that start with the stage", text("name of a motion"))}},
                {"name"});
}

}  // namespace

std::string case_schema() {
  const TimeSettings t;
  const OutputSettings o;
  const CaseSettings c;
  const Json gravity = {c.gravity.x, c.gravity.y, c.gravity.z};
  const Json flags = {{"type", "array"},
                      {"items", {{"type", "boolean"}}},
                      {"minItems", 3},
                      {"maxItems", 3},
                      {"default", {false, false, false}}};
  const Json domain =
      object("the box particles live in",
             {{"min", vector("lowest corner", "m")},
              {"max", vector("highest corner", "m")},
              {"periodic", flags},
              {"on_leave", preset(choice("particles that leave: stop the run, delete them, or delete and count them",
                                         {"error", "delete", "count"}),
                                  "error")}},
             {"min", "max"});
  const Json time = object(
      "how time advances",
      {{"integrator", preset(choice("semi-implicit Euler or velocity Verlet", {"euler", "verlet"}), "euler")},
       {"rayleigh_fraction",
        preset(number("time step as a share of the Rayleigh time", "1", {{"exclusiveMinimum", 0}, {"maximum", 1}}),
               t.rayleigh_fraction)},
       {"step", preset(number("fixed time step; 0: from the limits", "s", not_negative), t.step)},
       {"end", number("end of the run", "s", not_negative)},
       {"end_event", ref("condition")}},
      {"end"});
  const Json output = object(
      "what is written and how often",
      {{"frames_every", preset(number("simulated time between frames; 0: none", "s", not_negative), o.frames_every)},
       {"checkpoint_every_wall",
        preset(number("wall time between checkpoints; 0: only at the end and on interruption", "s", not_negative),
               o.checkpoint_every_wall)},
       {"checkpoint_every",
        preset(number("simulated time between checkpoints; 0: off", "s", not_negative), o.checkpoint_every)},
       {"particles_h5", boolean("write particles.h5", o.particles_h5)}});
  const Json motion = object("axis and angle, or displacement, as functions of time",
                             {{"plugin", text("id of a motion plugin")},
                              {"parameters", parameters()},
                              {"start", ref("condition")},
                              {"carried_by", text("name of a motion applied on top")}},
                             {"plugin"});
  const Json pin = {
      {"type", "string"}, {"pattern", "^[0-9a-fA-F]{64}$"}, {"description", "SHA-256 the library must have"}};

  Json out = object(
      "A Calx case. SI units; a number with a dimension may be {\"value\": 2.5, \"unit\": \"mm\"}; angles in degrees "
      "only where the "
      "key ends in _deg. Comments are allowed. Relative paths start at the folder of the case that is run.",
      {{"$schema", {{"type", "string"}}},
       {"calx", {{"const", 1}, {"description", "version of the format"}}},
       {"title", text("one line; default: the file name")},
       {"extends", text("path of a case that this one changes by JSON merge patch (RFC 7396), relative to this file")},
       {"relative_to", text("folder where relative paths start; written into resolved cases")},
       {"gravity", preset(vector("acceleration of gravity", "m/s^2"), gravity)},
       {"domain", domain},
       {"time", time},
       {"seed", preset(whole("of all random numbers", 0), c.seed)},
       {"materials", map("materials by name", material())},
       {"contacts", list("one for each pair of materials that may touch", contact())},
       {"shapes", map("shapes by name", shape())},
       {"regions", map("regions by name", ref("region"))},
       {"sources", list("where particles come from", source())},
       {"parts", list("walls", part())},
       {"motions", map("motions by name", motion)},
       {"events", map("events by name", object("an event", {{"when", ref("condition")}}, {"when"}))},
       {"stages", list("phases in order", stage())},
       {"forces", list("forces on particles beside contacts and gravity",
                       object("a particle force",
                              {{"plugin", text("id of a particle force")}, {"parameters", parameters()}}, {"plugin"}))},
       {"sensors", list("what is measured", sensor())},
       {"effects", list("hidden causes put into the case; see `calx plugin list`",
                        object("an effect",
                               {{"effect", text("id of an effect")},
                                {"on", map("what plays each role, by role; a role with one candidate may be left out",
                                           text("name"))},
                                {"parameters", parameters()},
                                {"version", text("written into resolved cases")},
                                {"expanded", boolean("written into resolved cases: the edits are done", false)}},
                               {"effect"}))},
       {"output", output},
       {"neighbour",
        object("neighbour list",
               {{"skin", preset(number("added to each radius; 0: chosen by the engine", "m", not_negative), 0.0)}})},
       {"rest",
        object("leaves particles that no longer move out of the steps; without this key nothing is left out",
               {{"after", preset(number("time a particle must have been quiet", "s", above_zero), c.rest.after)},
                {"displacement",
                 preset(number("way within that time, as a share of the radius, that counts as none", "1", above_zero),
                        c.rest.displacement)},
                {"force", preset(number("unbalanced force as a share of the weight; beyond it a particle wakes, and it "
                                        "falls asleep below half of it",
                                        "1", above_zero),
                                 c.rest.force)}})},
       {"scale",
        object("particle scaling: grains larger by a factor while vessels stay",
               {{"factor", number("how many times larger the grains are", "1", {{"minimum", 0.01}, {"maximum", 100}})},
                {"cohesion",
                 preset(choice("kept: the strength of the bulk, or the Bond number of a grain", {"strength", "bond"}),
                        "strength")}},
               {"factor"})},
       {"energy", boolean("keep the energy ledger", false)},
       {"overlap_limit",
        preset(number("largest overlap as a share of the radius; beyond it the run stops", "1", above_zero),
               c.overlap_limit)},
       {"assumptions", list("what was chosen without a source, in words; shown in the report", text("one assumption"))},
       {"plugins", map("pins by plugin id", object("a pin", {{"sha256", pin}}, {"sha256"}))}});
  // What a case leaves out may come from the one it extends.
  out["anyOf"] = {{{"required", {"extends"}}}, {{"required", {"calx", "domain", "time"}}}};
  Json document = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Calx case"}};
  document.update(out);
  document["$defs"] = {{"region", region()}, {"condition", condition()}, {"size", size()}};
  return document.dump(2) + "\n";
}

}  // namespace calx
