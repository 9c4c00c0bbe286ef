// Every kind of condition, chains within a step, check intervals and checkpoints of EventSet, against a world of
// numbers.
#include <doctest/doctest.h>

#include <map>

#include "base/error.hpp"
#include "motion/motion.hpp"
#include "support/memory_state.hpp"

namespace {

using calx::ConditionSettings;
using calx::EventSet;
using calx::EventSettings;
using Kind = ConditionSettings::Kind;
using Names = std::vector<std::string>;

class FakeView : public calx::EventView {
 public:
  double mass_in(const std::string& region) const override { return ++looks, mass.count(region) ? mass.at(region) : 0; }
  std::uint64_t count_in(const std::string&) const override { return ++looks, count; }
  bool settled_in(const std::string&, double per_particle) const override {
    asked_energy = per_particle;
    return ++looks, settled;
  }
  double cycles_of(const std::string& motion) const override { return motion == "rotor" ? cycles : 0; }
  std::map<std::string, double> mass;
  std::uint64_t count = 0;
  bool settled = false;
  double cycles = 0;
  mutable int looks = 0;
  mutable double asked_energy = -1;
};

ConditionSettings at_time(double t) {
  ConditionSettings c;
  c.kind = Kind::time;
  c.time = t;
  return c;
}
ConditionSettings after(const std::string& event, double delay = 0) {
  ConditionSettings c;
  c.kind = Kind::after;
  c.event = event;
  c.time = delay;
  return c;
}
ConditionSettings reaches(Kind kind, double value, const std::string& where = "", bool at_least = true) {
  ConditionSettings c;
  c.kind = kind;
  c.value = value;
  (kind == Kind::cycle ? c.motion : c.region) = where;
  c.at_least = at_least;
  return c;
}
ConditionSettings settled(double hold, double not_before = 0) {
  ConditionSettings c;
  c.kind = Kind::settled;
  c.hold = hold;
  c.not_before = not_before;
  c.kinetic_per_particle = 3e-9;
  return c;
}
ConditionSettings joined(Kind kind, std::vector<ConditionSettings> parts) {
  ConditionSettings c;
  c.kind = kind;
  c.parts = std::move(parts);
  return c;
}

}  // namespace

TEST_CASE("an event at a time fires once, at the first step not before it") {
  FakeView view;
  EventSet set({{"open", at_time(0.5)}}, 0.01);
  CHECK(set.update(0, view).empty());
  CHECK(set.update(0.499, view).empty());
  CHECK_FALSE(set.fired("open"));
  CHECK(set.time_of("open") < 0);
  CHECK(set.update(0.5, view) == Names{"open"});
  CHECK(set.update(0.6, view).empty());
  CHECK(set.time_of("open") == 0.5);
  CHECK(view.looks == 0);  // no particle was looked at
}

TEST_CASE("mass and count fire from below or from above") {
  FakeView view;
  view.mass["canister"] = 0.9;
  view.mass["hopper"] = 3;
  view.count = 5;
  EventSet set({{"full", reaches(Kind::mass, 1, "canister")},
                {"low", reaches(Kind::mass, 1, "hopper", false)},
                {"many", reaches(Kind::count, 6)},
                {"few", reaches(Kind::count, 4, "", false)}},
               0);
  CHECK(set.update(0, view).empty());
  view.mass["canister"] = 1;
  CHECK(set.update(1, view) == Names{"full"});
  view.mass["hopper"] = 0.5;
  view.count = 6;
  CHECK(set.update(2, view) == Names{"low", "many"});
  view.count = 4;
  CHECK(set.update(3, view) == Names{"few"});
}

TEST_CASE("settled must hold without a break, and not before its time") {
  FakeView view;
  EventSet set({{"rest", settled(0.2)}, {"late", settled(0, 0.75)}}, 0.1);
  Names seen;
  const auto step = [&](double t) {
    for (const auto& name : set.update(t, view)) seen.push_back(name);
  };
  view.settled = true;
  step(0);
  step(0.1);
  view.settled = false;
  step(0.21);
  view.settled = true;
  step(0.31);
  step(0.41);
  CHECK(seen.empty());  // 0.31 to 0.41 is too short
  step(0.52);
  CHECK(seen == Names{"rest"});
  CHECK(view.asked_energy == 3e-9);
  step(0.61);
  step(0.71);
  CHECK(seen.size() == 1);
  step(0.81);
  CHECK(seen == Names{"rest", "late"});
}

TEST_CASE("cycle counts completed cycles of its motion") {
  FakeView view;
  EventSet set({{"done", reaches(Kind::cycle, 40, "rotor")}, {"other", reaches(Kind::cycle, 1, "gate")}}, 1);
  view.cycles = 39.999;
  CHECK(set.update(0.5, view).empty());
  view.cycles = 40;
  CHECK(set.update(0.7, view) == Names{"done"});
  CHECK_FALSE(set.fired("other"));
}

TEST_CASE("a chain of events without delay fires within one step, whatever the order of the case") {
  FakeView view;
  EventSet set(
      {{"third", after("second")}, {"second", after("first")}, {"first", at_time(1)}, {"last", after("third", 0.5)}},
      0.01);
  CHECK(set.update(0.9, view).empty());
  CHECK(set.update(1.1, view) == Names{"first", "second", "third"});
  CHECK(set.update(1.5, view).empty());
  CHECK(set.update(1.6, view) == Names{"last"});
}

TEST_CASE("all waits for every part and any for one") {
  FakeView view;
  EventSet set({{"both", joined(Kind::all, {at_time(1), reaches(Kind::cycle, 2, "rotor")})},
                {"one", joined(Kind::any, {at_time(9), reaches(Kind::cycle, 1, "rotor")})},
                {"nested", joined(Kind::all, {joined(Kind::any, {at_time(9), after("both")}), at_time(2)})}},
               0.01);
  CHECK(set.update(0.5, view).empty());
  view.cycles = 1;
  CHECK(set.update(0.6, view) == Names{"one"});
  CHECK(set.update(1.2, view).empty());
  view.cycles = 2;
  CHECK(set.update(1.3, view) == Names{"both"});
  CHECK(set.update(2, view) == Names{"nested"});
}

TEST_CASE("in all, a settled part is armed by the parts before it") {
  FakeView view;
  view.settled = true;  // from the start, before anything is poured
  EventSet set({{"poured", at_time(1)}, {"rest", joined(Kind::all, {after("poured"), settled(0.2, 0.5)})}}, 0.1);
  Names seen;
  for (int k = 0; k <= 14; ++k)
    for (const auto& name : set.update(k * 0.1, view)) seen.push_back(name);
  CHECK(seen == Names{"poured"});
  CHECK(set.update(1.51, view) == Names{"rest"});
}

TEST_CASE("a hold starts anew when an earlier part of all fails meanwhile") {
  FakeView view;
  view.settled = true;
  view.mass["canister"] = 1;
  EventSet set({{"rest", joined(Kind::all, {reaches(Kind::mass, 1, "canister"), settled(1)})}}, 0);
  CHECK(set.update(0, view).empty());
  view.mass["canister"] = 0.5;
  CHECK(set.update(0.9, view).empty());
  view.mass["canister"] = 1;
  CHECK(set.update(1, view).empty());
  CHECK(set.update(1.9, view).empty());
  CHECK(set.update(2, view) == Names{"rest"});
}

TEST_CASE("particles are looked at once per check interval and never in between") {
  FakeView view;
  EventSet set({{"full", reaches(Kind::mass, 1, "canister")},
                {"any", joined(Kind::any, {reaches(Kind::mass, 9), at_time(0.055)})}},
               0.01);
  const double dt = 0.0005;
  int steps_of_looks = 0;
  for (int k = 0; k < 200; ++k) {  // 0 to 0.0995 s
    const int before = view.looks;
    const Names names = set.update(k * dt, view);
    if (view.looks > before) ++steps_of_looks;
    // A time part fires in its own step, though the mass beside it is unknown then.
    CHECK((names == Names{"any"}) == (k == 110));
  }
  CHECK(steps_of_looks == 10);
  view.mass["canister"] = 2;
  CHECK(set.update(0.0999, view).empty());
  CHECK(set.update(0.1001, view) == Names{"full"});
}

TEST_CASE("announced events are followed like others and only the first time counts") {
  FakeView view;
  EventSet set({{"next", after("stage one")}}, 0);
  set.fire("stage one", 2);
  set.fire("stage one", 3);
  CHECK(set.time_of("stage one") == 2);
  CHECK(set.update(3, view) == Names{"next"});
  CHECK_FALSE(set.fired("stage two"));
}

TEST_CASE("a resumed set goes on as the first one would have") {
  const std::vector<EventSettings> events = {{"start", at_time(0.3)},
                                             {"rest", joined(Kind::all, {after("start"), settled(0.35, 0.2)})},
                                             {"done", joined(Kind::any, {after("rest", 0.1), reaches(Kind::mass, 5)})},
                                             {"ring", after("bell", 0.4)}};
  const auto world = [](double t) {
    FakeView view;
    view.settled = t < 0.5 || t > 0.62;
    return view;
  };
  // Names with the step they fired in, from step first to step last.
  const auto run = [&](EventSet& set, int first, int last) {
    Names seen;
    for (int k = first; k < last; ++k) {
      if (k == 40) set.fire("bell", k * 0.007);
      for (const auto& name : set.update(k * 0.007, world(k * 0.007))) seen.push_back(name + "@" + std::to_string(k));
    }
    return seen;
  };
  EventSet whole(events, 0.02);
  const Names expected = run(whole, 0, 200);
  CHECK(expected.size() == 4);
  for (int stop = 1; stop < 200; stop += 7) {
    EventSet first(events, 0.02), second(events, 0.02);
    Names seen = run(first, 0, stop);
    calx::MemoryState state;
    first.save(state);
    second.load(state);
    for (const auto& name : run(second, stop, 200)) seen.push_back(name);
    CHECK(seen == expected);
    CHECK(second.time_of("bell") == whole.time_of("bell"));
  }
}

TEST_CASE("a resumed set keeps the rhythm of its checks") {
  FakeView view;
  view.mass["canister"] = 2;
  const std::vector<EventSettings> events = {
      {"full", joined(Kind::all, {at_time(0.012), reaches(Kind::mass, 1, "canister")})}};
  EventSet first(events, 0.01), second(events, 0.01);
  CHECK(first.update(0.011, view).empty());
  calx::MemoryState state;
  first.save(state);
  second.load(state);
  CHECK(second.update(0.015, view).empty());  // the next check is at 0.02 s
  CHECK(view.looks == 0);
  CHECK(second.update(0.0201, view) == Names{"full"});
}

TEST_CASE("a checkpoint of other events is refused by name") {
  EventSet set({{"open", at_time(1)}}, 0), other({{"shut", at_time(1)}}, 0);
  calx::MemoryState state;
  set.save(state);
  try {
    other.load(state);
    FAIL("no error");
  } catch (const calx::Error& e) {
    CHECK(e.fault() == calx::Fault::files);
    CHECK(std::string(e.what()).find("the checkpoint holds the events [open], the case has [shut]") !=
          std::string::npos);
  }
}

TEST_CASE("nothing is missed between two updates as long as the set is still") {
  FakeView view;
  EventSet set({{"open", at_time(0.5)},
                {"after", after("open", 0.2)},
                {"turned", reaches(Kind::cycle, 2, "rotor")},
                {"full", joined(Kind::all, {after("turned"), reaches(Kind::mass, 1, "bin")})}},
               0.01);
  const auto cycles = [](const std::string& motion, double t) { return motion == "rotor" ? t / 0.3 : 0; };
  set.update(0, view);
  CHECK(set.still(0, 0.009, cycles));
  CHECK_FALSE(set.still(0, 0.011, cycles));  // the mass is due to be asked
  const int looks = view.looks;
  set.update(0.495, view);
  CHECK(set.still(0.495, 0.499, cycles));
  CHECK_FALSE(set.still(0.495, 0.5, cycles));  // "open"
  set.update(0.5, view);
  CHECK(set.fired("open"));
  set.update(0.595, view);
  CHECK(set.still(0.595, 0.599, cycles));
  CHECK_FALSE(set.still(0.595, 0.601, cycles));  // the second cycle ends at 0.6
  view.cycles = 2;
  set.update(0.6, view);
  CHECK(set.fired("turned"));
  set.update(0.695, view);
  CHECK(set.still(0.695, 0.699, cycles));
  CHECK_FALSE(set.still(0.695, 0.705, cycles));  // "after", 0.2 s after "open"
  CHECK(view.looks > looks);
}
