// A case with every key arrives in the settings, in SI, and its resolved text gives the same settings again.
#include <doctest/doctest.h>

#include "cases.hpp"
#include "config/config.hpp"

using namespace calx;
using doctest::Approx;

TEST_CASE("every key of a case reaches the settings in SI") {
  const CaseSettings c = parse_case(full_case(), "case.json").settings;
  CHECK(c.file == "case.json");
  CHECK(c.title == "Canister fill");
  CHECK(c.gravity.z == -9.81);
  CHECK(c.domain.box.lo.x == -0.1);
  CHECK(c.domain.box.hi.z == 0.4);
  CHECK(c.domain.periodic[0]);
  CHECK_FALSE(c.domain.periodic[2]);
  CHECK(c.domain.on_leave == DomainSettings::OnLeave::remove);
  CHECK(c.time.integrator == TimeSettings::Integrator::verlet);
  CHECK(c.time.rayleigh_fraction == 0.2);
  CHECK(c.time.step == 1e-6);
  CHECK(c.time.end == 12);
  CHECK(c.time.end_event == "full");
  CHECK(c.seed == 7);

  REQUIRE(c.materials.size() == 2);
  CHECK(c.materials[0].name == "steel");  // in the order of the file, not of the alphabet
  CHECK(c.materials[0].density == 0);
  CHECK(c.materials[1].density == Approx(2017));
  CHECK(c.materials[1].properties.pointer == "/materials/calcine");
  REQUIRE(c.contacts.size() == 2);
  CHECK(c.contacts[0].between[1] == "calcine");
  REQUIRE(c.contacts[0].laws.size() == 1);
  CHECK(c.contacts[0].laws[0].name == "calx.epam");
  CHECK(c.contacts[0].laws[0].parameters.json == "{\"k1\":200000.0}");
  CHECK(c.contacts[0].laws[0].parameters.pointer == "/contacts/0/parameters");
  REQUIRE(c.contacts[1].laws.size() == 2);
  CHECK(c.contacts[1].laws[1].name == "extra cohesion");
  CHECK(c.contacts[1].laws[0].parameters.pointer == "/contacts/1/laws/0/parameters");

  REQUIRE(c.shapes.size() == 2);
  REQUIRE(c.shapes[0].spheres.size() == 2);
  CHECK(c.shapes[0].spheres[0].at.z == -0.0003);
  CHECK(c.shapes[0].spheres[1].radius == 0.00125);
  CHECK(c.shapes[1].spheres[0].radius == 0.002);

  CHECK(c.output.frames_every == 0.05);
  CHECK(c.output.checkpoint_every_wall == 30);
  CHECK(c.output.checkpoint_every == 1);
  CHECK_FALSE(c.output.particles_h5);
  CHECK(c.neighbour.skin == 0.0002);
  CHECK(c.rest.on);
  CHECK(c.rest.after == 0.005);
  CHECK(c.rest.displacement == 1e-4);
  CHECK(c.rest.force == 0.02);
  CHECK(c.energy_ledger);
  CHECK(c.overlap_limit == 0.3);
  REQUIRE(c.assumptions.size() == 1);
  REQUIRE(c.plugin_pins.size() == 1);
  CHECK(c.plugin_pins[0].first == "org.example.sensor");
  CHECK(c.forces.at(0).plugin == "calx.drag");
  CHECK(c.forces.at(0).parameters.json == "{\"viscosity\":1.8e-05}");
}

TEST_CASE("sources know their region, amount, sizes and positions") {
  const CaseSettings c = parse_case(full_case(), "case.json").settings;
  REQUIRE(c.sources.size() == 6);
  const SourceSettings &hopper = c.sources[0], &few = c.sources[1], &placed = c.sources[2], &sizes = c.sources[3];
  CHECK(hopper.region.name == "hopper");
  CHECK(hopper.region.radius_b == 0.05);
  CHECK(hopper.mass == 0.6);
  CHECK(hopper.rate == 0.1);
  CHECK(hopper.velocity.z == -1);
  CHECK_FALSE(hopper.random_orientation);
  CHECK(hopper.size.kind == SizeSettings::Kind::normal);
  CHECK(hopper.size.scale == 1.1);
  CHECK(hopper.size.lowest == Approx(0.8));  // three deviations
  CHECK(hopper.size.highest == Approx(1.4));
  CHECK(hopper.when == "source hopper fill");
  CHECK(few.when == "full");
  CHECK(few.count == 10);
  CHECK(few.size.scale == 1.5);
  CHECK(few.random_orientation);
  CHECK(few.region.b.z == 1);
  CHECK(placed.positions.at(1).z == 0.2);
  CHECK(placed.orientations.at(1).x == Approx(0.8));
  CHECK(placed.velocities.at(1).z == 2);
  CHECK(placed.spins.at(1).x == 2);
  CHECK_FALSE(placed.random_orientation);
  CHECK(sizes.size.shares.at(0) == 0.75);
  CHECK(sizes.size.highest == 2);
  CHECK(c.sources[4].size.lowest == 0.9);
  CHECK(c.sources[5].size.deviation == 0.2);
}

TEST_CASE("parts, motions, stages, sensors and events refer to each other by name") {
  const CaseSettings c = parse_case(full_case(), "case.json").settings;
  CHECK(c.parts.at(0).present);
  CHECK(c.parts.at(0).motion == "lift");
  CHECK(c.parts.at(0).parameters.json == "{\"radius\":0.03}");
  CHECK_FALSE(c.parts.at(1).present);
  CHECK(c.parts.at(1).assumed);
  CHECK(c.parts.at(1).appears == "valve open");
  CHECK(c.parts.at(1).vanishes == "part rotor vanishes");
  CHECK(c.motions.at(1).start == "valve open");
  CHECK(c.motions.at(1).carried_by == "lift");
  CHECK(c.stages.at(0).until == "full");
  CHECK(c.stages.at(0).start.at(0) == "lift");
  CHECK(c.stages.at(1).until == "stage rest");

  REQUIRE(c.sensors.size() == 3);
  CHECK(c.sensors[0].kind == "mass");
  CHECK(c.sensors[1].parameters.json.find("\"region\":\"sensor inline\"") != std::string::npos);
  CHECK(c.sensors[2].kind == "org.example.sensor");
  CHECK(c.sensors[2].every == 0.01);
  REQUIRE(c.regions.size() == 6);
  CHECK(c.regions[1].follows == "canister");
  CHECK(c.regions[3].a.z == 0.1);
  CHECK(c.regions[4].name == "region of /events/full/when/any/1/all/0");
  CHECK_FALSE(c.regions[4].is_named);
  CHECK(c.regions[5].name == "sensor inline");

  using Kind = ConditionSettings::Kind;
  REQUIRE(c.events.size() == 5);
  CHECK(c.events[0].name == "valve open");
  CHECK(c.events[0].when.kind == Kind::settled);
  CHECK(c.events[0].when.hold == 0.1);
  CHECK(c.events[0].when.not_before == 0.2);
  const ConditionSettings& full = c.events[1].when;
  CHECK(full.kind == Kind::any);
  REQUIRE(full.parts.size() == 4);
  CHECK(full.parts[0].value == 0.5);
  CHECK(full.parts[0].at_least);
  CHECK(full.parts[1].parts.at(0).kind == Kind::count);
  CHECK_FALSE(full.parts[1].parts.at(0).at_least);
  CHECK(full.parts[1].parts.at(1).kind == Kind::after);
  CHECK(full.parts[1].parts.at(1).time == 0);
  CHECK(full.parts[2].value == 40);
  CHECK(full.parts[3].time == 60);
  CHECK(c.events[2].name == "source hopper fill");
  CHECK(c.events[2].when.time == 0.5);
}

TEST_CASE("the least case gets the defaults, and they stand in the resolved text") {
  const CaseFile c = parse_case(least_case(), "folder/least.json");
  CHECK(c.settings.title == "least");
  CHECK(c.settings.gravity.z == -9.81);
  CHECK(c.settings.seed == 1);
  CHECK(c.settings.output.checkpoint_every_wall == 60);
  for (const char* text :
       {"\"rayleigh_fraction\": 0.1", "\"integrator\": \"euler\"", "\"on_leave\": \"error\"", "\"seed\": 1",
        "\"checkpoint_every_wall\": 60.0", "\"skin\": 0.0", "\"overlap_limit\": 0.5", "\"title\": \"least\""})
    CHECK_MESSAGE(c.resolved.find(text) != std::string::npos, text);
}

TEST_CASE("the resolved text read again resolves to itself") {
  for (const char* text : {full_case(), least_case()}) {
    const CaseFile once = parse_case(text, "cases/case.json");
    const CaseFile again = parse_case(once.resolved, "elsewhere/case.json");
    CHECK(again.resolved == once.resolved);
    CHECK(again.settings.folder == once.settings.folder);
    CHECK(again.settings.events.size() == once.settings.events.size());
  }
}

TEST_CASE("a shorthand, an event in any list and a whole number written as 1e3 are understood") {
  const CaseSettings c = parse_case(R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1},
    "materials": {"glass": {"density": 2500}}, "shapes": {"ball": {"sphere": {"radius": {"value": 1, "unit": "mm"}}}},
    "events": {"a": {"when": {"time": 1}}, "b": {"when": "a"}, "c": {"when": {"all": ["a", "b"]}}},
    "sources": [{"shape": "ball", "material": "glass", "count": 1e3, "region": {"sphere": {"centre": [0, 0, 0], "radius": 1}}}]})",
                                    "case.json")
                             .settings;
  CHECK(c.sources.at(0).count == 1000);
  CHECK(c.sources.at(0).name == "source 0");
  CHECK(c.events.at(1).when.event == "a");
  CHECK(c.events.at(2).when.parts.at(1).event == "b");
}
