// event_set.cpp: when things happen. Asked once per step with some tens of events; only cheap conditions (time, cycle,
// after) are read in every step.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "motion/motion.hpp"
#include "motion/saved_names.hpp"

namespace calx {
namespace {

using Kind = ConditionSettings::Kind;

std::size_t settled_leaves(const ConditionSettings& c) {
  std::size_t n = c.kind == Kind::settled ? 1 : 0;
  for (const auto& part : c.parts) n += settled_leaves(part);
  return n;
}

}  // namespace

struct EventSet::Question {
  double t;  // s
  bool due;  // particles may be looked at
  Entry& entry;
  const EventView& view;
};

EventSet::EventSet(const std::vector<EventSettings>& events, double check_interval) : check_interval_(check_interval) {
  for (const auto& settings : events) {
    Entry e;
    e.settings = settings;
    e.leaves.resize(settled_leaves(settings.when));
    events_.push_back(e);
  }
}

EventSet::Answer EventSet::answer(const ConditionSettings& c, std::size_t leaf, Question& q) const {
  const auto known = [](bool holds) { return holds ? Answer::yes : Answer::no; };
  switch (c.kind) {
    case Kind::time:
      return known(q.t >= c.time);
    case Kind::after:
      return known(fired(c.event) && q.t >= time_of(c.event) + c.time);
    case Kind::cycle:
      return known(q.view.cycles_of(c.motion) >= c.value);
    case Kind::mass:
      if (!q.due) return Answer::unknown;
      return known(c.at_least ? q.view.mass_in(c.region) >= c.value : q.view.mass_in(c.region) <= c.value);
    case Kind::count: {
      if (!q.due) return Answer::unknown;
      const double n = static_cast<double>(q.view.count_in(c.region));
      return known(c.at_least ? n >= c.value : n <= c.value);
    }
    case Kind::settled:
      return answer_settled(c, q.entry.leaves[leaf], q);
    case Kind::all:
      return answer_all(c, leaf, q);
    case Kind::any:
      return answer_any(c, leaf, q);
  }
  return Answer::no;
}

EventSet::Answer EventSet::answer_settled(const ConditionSettings& c, Settling& leaf, const Question& q) const {
  if (leaf.armed < 0) leaf.armed = q.t;
  if (!q.due) return Answer::unknown;
  if (!q.view.settled_in(c.region, c.kinetic_per_particle)) {
    leaf.since = -1;
    return Answer::no;
  }
  if (leaf.since < 0) leaf.since = q.t;
  return q.t >= leaf.since + c.hold && q.t >= leaf.armed + c.not_before ? Answer::yes : Answer::no;
}

EventSet::Answer EventSet::answer_all(const ConditionSettings& c, std::size_t leaf, Question& q) const {
  Answer sum = Answer::yes;
  for (const auto& part : c.parts) {
    const std::size_t count = settled_leaves(part);
    if (sum == Answer::yes)
      sum = answer(part, leaf, q);
    else if (sum == Answer::no)
      // Nobody watches a later part meanwhile, so what it held so far no longer counts.
      for (std::size_t k = leaf; k < leaf + count; ++k) q.entry.leaves[k] = Settling();
    leaf += count;
  }
  return sum;
}

EventSet::Answer EventSet::answer_any(const ConditionSettings& c, std::size_t leaf, Question& q) const {
  Answer sum = Answer::no;
  for (const auto& part : c.parts) {
    const Answer one = answer(part, leaf, q);  // every part, so that each keeps track of its hold
    if (one == Answer::yes || (one == Answer::unknown && sum == Answer::no)) sum = one;
    leaf += settled_leaves(part);
  }
  return sum;
}

std::vector<std::string> EventSet::update(double t, const EventView& view) {
  const bool due = t >= next_check_;
  if (due && check_interval_ > 0) {
    next_check_ = (std::floor(t / check_interval_) + 1) * check_interval_;
    if (next_check_ <= t) next_check_ += check_interval_;  // where the quotient was rounded down
  }
  std::vector<std::string> names;
  for (std::size_t before = 0;; before = names.size()) {
    for (Entry& e : events_) {
      Question q{t, due, e, view};
      if (e.fired_at >= 0 || answer(e.settings.when, 0, q) != Answer::yes) continue;
      e.fired_at = t;
      names.push_back(e.settings.name);
    }
    if (names.size() == before) return names;  // nothing that another event could follow
  }
}

bool EventSet::still(const ConditionSettings& c, double before, double t,
                     const std::function<double(const std::string&, double)>& cycles) const {
  switch (c.kind) {
    case Kind::time:
      return (before >= c.time) == (t >= c.time);
    case Kind::after: {
      const double due = time_of(c.event) + c.time;
      return !fired(c.event) || (before >= due) == (t >= due);
    }
    case Kind::cycle:
      return (cycles(c.motion, before) >= c.value) == (cycles(c.motion, t) >= c.value);
    case Kind::mass:
    case Kind::count:
    case Kind::settled:
      return t < next_check_;
    case Kind::all:
    case Kind::any:
      break;
  }
  return std::all_of(c.parts.begin(), c.parts.end(),
                     [&](const ConditionSettings& part) { return still(part, before, t, cycles); });
}

bool EventSet::still(double before, double t, const std::function<double(const std::string&, double)>& cycles) const {
  return std::all_of(events_.begin(), events_.end(),
                     [&](const Entry& e) { return e.fired_at >= 0 || still(e.settings.when, before, t, cycles); });
}

void EventSet::fire(const std::string& name, double t) {
  if (fired(name)) return;
  for (Entry& e : events_)
    if (e.settings.name == name) {
      e.fired_at = t;
      return;
    }
  announced_.emplace_back(name, t);
}

bool EventSet::fired(const std::string& name) const { return time_of(name) >= 0; }

double EventSet::time_of(const std::string& name) const {
  for (const Entry& e : events_)
    if (e.settings.name == name) return e.fired_at;
  for (const auto& [known, t] : announced_)
    if (known == name) return t;
  return -1;
}

void EventSet::save(StateWriter& out) const {
  std::string names, announced;
  std::vector<double> fired_at, armed, since, announced_at;
  for (const Entry& e : events_) {
    append_name(names, e.settings.name);
    fired_at.push_back(e.fired_at);
    for (const Settling& leaf : e.leaves) {
      armed.push_back(leaf.armed);
      since.push_back(leaf.since);
    }
  }
  for (const auto& [name, t] : announced_) {
    append_name(announced, name);
    announced_at.push_back(t);
  }
  out.put_text("events/names", names);
  out.put("events/fired_at", fired_at.data(), fired_at.size(), "s");
  out.put("events/settled_armed", armed.data(), armed.size(), "s");
  out.put("events/settled_since", since.data(), since.size(), "s");
  out.put_text("events/announced", announced);
  out.put("events/announced_at", announced_at.data(), announced_at.size(), "s");
  out.put_number("events/next_check", next_check_, "s");
}

void EventSet::load(const StateReader& in) {
  std::string names;
  std::size_t leaf_count = 0;
  for (const Entry& e : events_) {
    append_name(names, e.settings.name);
    leaf_count += e.leaves.size();
  }
  const std::string saved = in.get_text("events/names"), announced = in.get_text("events/announced");
  const auto fired_at = in.get_doubles("events/fired_at"), armed = in.get_doubles("events/settled_armed"),
             since = in.get_doubles("events/settled_since"), announced_at = in.get_doubles("events/announced_at");
  if (saved != names || fired_at.size() != events_.size() || armed.size() != leaf_count || since.size() != leaf_count)
    throw Error(Fault::files, "events/names: the checkpoint holds the events [" + listed(saved) + "], the case has [" +
                                  listed(names) + "]; resume with the case the checkpoint was written with");
  std::size_t leaf = 0;
  for (std::size_t k = 0; k < events_.size(); ++k) {
    events_[k].fired_at = fired_at[k];
    for (Settling& s : events_[k].leaves) {
      s.armed = armed[leaf];
      s.since = since[leaf++];
    }
  }
  announced_.clear();
  std::size_t begin = 0;
  for (const double t : announced_at) {
    const std::size_t end = announced.find('\n', begin);
    announced_.emplace_back(announced.substr(begin, end - begin), t);
    begin = end + 1;
  }
  next_check_ = in.get_number("events/next_check");
}

}  // namespace calx
