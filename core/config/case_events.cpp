// Events: conditions that are looked at while the run goes on.
#include <algorithm>

#include "base/nearest.hpp"
#include "config/case_reader.hpp"

namespace calx {
namespace {

const std::vector<std::string> kinds = {"time", "mass", "count", "settled", "cycle", "after", "event", "all", "any"};

// Names of the events a condition waits for.
void waits_for(const ConditionSettings& c, std::vector<std::string>& out) {
  if (c.kind == ConditionSettings::Kind::after) out.push_back(c.event);
  for (const ConditionSettings& part : c.parts) waits_for(part, out);
}

}  // namespace

ConditionSettings CaseReader::condition(const Node& node) {
  using Kind = ConditionSettings::Kind;
  ConditionSettings c;
  c.pointer = node.pointer();
  if (node.json().is_string()) {
    c.kind = Kind::after;
    c.event = node.name_of("event", names_.events);
    return c;
  }
  Object object(node, "a condition");
  std::string found;
  for (const std::string& kind : kinds)
    if (object.has(kind)) {
      if (!found.empty())
        node.fail("holds \"" + found + "\" and \"" + kind + "\"; must hold one; put several into \"all\" or \"any\"");
      found = kind;
    }
  object.done();
  if (found.empty()) node.fail("is no condition; must hold one of " + quoted_list(kinds));

  const Node value = *object.find(found);
  if (found == "time") {
    c.kind = Kind::time;
    c.time = value.number("s", Allow::not_negative);
  } else if (found == "event") {
    c.kind = Kind::after;
    c.event = value.name_of("event", names_.events);
  } else if (found == "all" || found == "any") {
    c.kind = found == "all" ? Kind::all : Kind::any;
    for (const Node& part : value.items("conditions")) c.parts.push_back(condition(part));
    if (c.parts.empty()) value.fail("is an empty list; must hold at least one condition");
  } else {
    Object body(value, "a condition");
    if (found == "after") {
      c.kind = Kind::after;
      c.event = body.need("event", "the name of an event").name_of("event", names_.events);
      c.time = body.number("delay", "s", 0, Allow::not_negative);
    } else if (found == "cycle") {
      c.kind = Kind::cycle;
      c.motion = body.need("motion", "the name of a motion").name_of("motion", names_.motions);
      c.value = static_cast<double>(body.need("number", "the number of completed cycles").whole(1));
    } else {
      if (const auto r = body.find("region")) c.region = region_name(*r, "region of " + node.pointer());
      if (found == "settled") {
        c.kind = Kind::settled;
        c.kinetic_per_particle = body.number("kinetic_per_particle", "J", 0, Allow::not_negative);
        c.hold = body.number("hold", "s", 0, Allow::not_negative);
        c.not_before = body.number("not_before", "s", 0, Allow::not_negative);
      } else {
        c.kind = found == "mass" ? Kind::mass : Kind::count;
        const auto least = body.find("at_least"), most = body.find("at_most");
        if (static_cast<bool>(least) == static_cast<bool>(most))
          value.fail(least ? "holds \"at_least\" and \"at_most\"; must hold one of them"
                           : "has no limit; must hold \"at_least\" or \"at_most\"");
        c.at_least = static_cast<bool>(least);
        const Node& limit = least ? *least : *most;
        c.value = c.kind == Kind::mass ? limit.number("kg", Allow::not_negative) : static_cast<double>(limit.whole(0));
      }
    }
    body.done();
  }
  return c;
}

std::string CaseReader::event(const Node& node, const std::string& made_up) {
  if (node.json().is_string()) return node.name_of("event", names_.events);
  for (const EventSettings& e : case_.events)
    if (e.name == made_up) node.fail("needs the name \"" + made_up + "\", which another event has; rename that one");
  case_.events.push_back({made_up, condition(node)});
  return made_up;
}

void CaseReader::read_events(Object& root) {
  for (const auto& entry : root.section("events", "events by name").entries()) {
    check_name(entry.second, entry.first);
    Object object(entry.second, "an event");
    case_.events.push_back({entry.first, condition(object.need("when", "the condition at which the event happens"))});
    object.done();
  }
}

// Depth-first from each event; an event met again on the way up waits for itself and would never happen.
void CaseReader::check_event_cycles() const {
  std::vector<std::string> path;
  const auto find = [&](const std::string& name) {
    return std::find_if(case_.events.begin(), case_.events.end(),
                        [&](const EventSettings& e) { return e.name == name; });
  };
  std::vector<std::string> safe;
  const auto visit = [&](const auto& self, const EventSettings& e) -> void {
    if (std::find(safe.begin(), safe.end(), e.name) != safe.end()) return;
    const auto again = std::find(path.begin(), path.end(), e.name);
    if (again != path.end()) {
      std::string text;
      for (auto it = again; it != path.end(); ++it) text += "\"" + *it + "\" waits for ";
      document_.fail(e.when.pointer, text + "\"" + e.name + "\"; events that wait for each other never happen");
    }
    path.push_back(e.name);
    std::vector<std::string> next;
    waits_for(e.when, next);
    for (const std::string& name : next) self(self, *find(name));
    path.pop_back();
    safe.push_back(e.name);
  };
  for (const EventSettings& e : case_.events) visit(visit, e);
}

}  // namespace calx
