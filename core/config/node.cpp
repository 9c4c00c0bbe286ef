#include "config/node.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

std::string number_in(const std::string& unit) { return unit == "1" ? std::string("a number") : "a number in " + unit; }

// Value and unit of {"value": ..., "unit": "mm"}; unit is empty where a plain value stands.
struct Quantity {
  const Json* value;
  std::string pointer, unit;
};

Quantity quantity(const Node& node) {
  const Json& j = node.json();
  if (!j.is_object()) return {&j, node.pointer(), ""};
  Object object(node, "a number");
  const Node value = object.need("value", "a quantity is {\"value\": 2.5, \"unit\": \"mm\"}");
  const std::string unit =
      object.need("unit", "a quantity is {\"value\": 2.5, \"unit\": \"mm\"}").text("a unit such as mm");
  object.done();
  return {&value.json(), value.pointer(), unit};
}

double convert(const Node& node, double value, const std::string& from, const std::string& si) {
  if (from.empty()) return value;
  try {
    return to_si(value, from, si);
  } catch (const Error& e) {
    node.document().fail(node.pointer() + "/unit", e.what());
  }
}

double finite_number(const Node& node, const Json& j, const std::string& pointer, const std::string& right) {
  if (!j.is_number()) node.document().fail(pointer, shown(j) + " is not a number; must be " + right);
  const double x = j.get<double>();
  if (!std::isfinite(x)) node.document().fail(pointer, "not a finite number; must be " + right);
  return x;
}

}  // namespace

double Node::number(const std::string& unit, Allow allow) const {
  const Quantity q = quantity(*this);
  const double given = finite_number(*this, *q.value, q.pointer, number_in(unit));
  const double x = convert(*this, given, q.unit, unit);
  if ((allow == Allow::above_zero && x <= 0) || (allow == Allow::not_negative && x < 0))
    fail(format_quantity(given, q.unit.empty() ? unit : q.unit) + " is out of range; must be " +
         (allow == Allow::above_zero ? "above 0" : "0 or more"));
  return x;
}

Vec3 Node::vector(const std::string& unit) const {
  const Quantity q = quantity(*this);
  const std::string right = unit == "1" ? "three numbers" : "three numbers in " + unit;
  if (!q.value->is_array() || q.value->size() != 3) document_->fail(q.pointer, shown(*q.value) + "; must be " + right);
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const std::size_t index = static_cast<std::size_t>(k);
    const Json& entry = (*q.value)[index];
    const std::string place = q.pointer + pointer_token(index);
    // Each component may carry its own unit where the whole has none.
    out[k] = q.unit.empty() ? Node(*document_, entry, place).number(unit)
                            : convert(*this, finite_number(*this, entry, place, number_in(q.unit)), q.unit, unit);
  }
  return out;
}

std::uint64_t Node::whole(std::uint64_t lowest) const {
  const std::string right = "; must be a whole number, " + std::to_string(lowest) + " or more";
  std::uint64_t n = 0;
  if (value_->is_number_unsigned()) {
    n = value_->get<std::uint64_t>();
  } else if (value_->is_number_float()) {
    // 1e5 is a whole number to a user though not to JSON libraries; beyond 2^53 the digits would be a guess.
    const double x = value_->get<double>();
    if (!(x >= 0 && x <= 9007199254740992.0 && x == std::floor(x))) fail(shown(*value_) + right);
    n = static_cast<std::uint64_t>(x);
  } else {
    fail(shown(*value_) + right);
  }
  if (n < lowest) fail(shown(*value_) + right);
  return n;
}

bool Node::boolean() const {
  if (!value_->is_boolean()) fail(shown(*value_) + "; must be true or false");
  return value_->get<bool>();
}

std::string Node::text(const std::string& what) const {
  if (!value_->is_string()) fail(shown(*value_) + " is not text; must be " + what);
  std::string out = value_->get<std::string>();
  if (out.empty()) fail("is empty; must be " + what);
  return out;
}

std::size_t Node::choice(const std::string& what, const std::vector<std::string>& names) const {
  const std::string given = text(what + ", one of " + quoted_list(names));
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == given) return k;
  fail("\"" + given + "\" is not " + what + "; " + did_you_mean(given, names));
}

std::string Node::name_of(const std::string& kind, const std::vector<std::string>& known) const {
  const std::string given = text("the name of a " + kind);
  if (std::find(known.begin(), known.end(), given) == known.end())
    fail("no " + kind + " is called \"" + given + "\"; " + did_you_mean(given, known));
  return given;
}

std::vector<Node> Node::items(const std::string& what) const {
  if (!value_->is_array()) fail(shown(*value_) + "; must be a list of " + what);
  std::vector<Node> out;
  out.reserve(value_->size());
  for (std::size_t k = 0; k < value_->size(); ++k)
    out.emplace_back(*document_, (*value_)[k], pointer_ + pointer_token(k));
  return out;
}

Parameters Node::parameters() const {
  if (!value_->is_object()) fail(shown(*value_) + "; must be an object of parameters");
  return {value_->dump(), pointer_, document_->folder()};
}

Object::Object(const Node& node, const std::string& what) : node_(node) {
  if (!node.json().is_object()) node.fail(shown(node.json()) + "; must be " + what + ", an object");
}

Node Object::child(const std::string& key, const Json& value) const {
  return Node(node_.document(), value, node_.pointer() + pointer_token(key));
}

bool Object::has(const std::string& key) { return find(key).has_value(); }

std::optional<Node> Object::find(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  const auto it = node_.json().find(key);
  if (it == node_.json().end()) return std::nullopt;
  return child(key, *it);
}

Node Object::need(const std::string& key, const std::string& what) {
  const std::optional<Node> found = find(key);
  if (found) return *found;
  // A key that nearly is the one needed is the likelier mistake, so it is named.
  std::vector<std::string> present;
  for (const auto& item : node_.json().items())
    if (std::find(asked_.begin(), asked_.end(), item.key()) == asked_.end()) present.push_back(item.key());
  const std::string near = nearest_name(key, present);
  if (!near.empty())
    node_.document().fail(pointer() + pointer_token(near), "unknown key; did you mean \"" + key + "\"?");
  node_.document().fail(pointer() + pointer_token(key), "is missing; " + what);
}

Object Object::section(const std::string& key, const std::string& what) {
  static const Json none = Json::object();
  const std::optional<Node> found = find(key);
  return Object(found ? *found : child(key, none), what);
}

double Object::number(const std::string& key, const std::string& unit, double preset, Allow allow) {
  if (const auto n = find(key)) return n->number(unit, allow);
  node_.document().fill(pointer() + pointer_token(key), preset);
  return preset;
}

Vec3 Object::vector(const std::string& key, const std::string& unit, const Vec3& preset) {
  if (const auto n = find(key)) return n->vector(unit);
  node_.document().fill(pointer() + pointer_token(key), Json::array({preset.x, preset.y, preset.z}));
  return preset;
}

bool Object::boolean(const std::string& key, bool preset) {
  if (const auto n = find(key)) return n->boolean();
  node_.document().fill(pointer() + pointer_token(key), preset);
  return preset;
}

std::size_t Object::choice(const std::string& key, const std::string& what, const std::vector<std::string>& names,
                           std::size_t preset) {
  if (const auto n = find(key)) return n->choice(what, names);
  node_.document().fill(pointer() + pointer_token(key), names[preset]);
  return preset;
}

std::string Object::text(const std::string& key, const std::string& what) {
  const auto n = find(key);
  return n ? n->text(what) : "";
}

std::vector<Node> Object::items(const std::string& key, const std::string& what) {
  const auto n = find(key);
  return n ? n->items(what) : std::vector<Node>();
}

std::vector<std::string> Object::names(const std::string& key, const std::string& kind,
                                       const std::vector<std::string>& known) {
  std::vector<std::string> out;
  for (const Node& n : items(key, "names of " + kind + "s")) out.push_back(n.name_of(kind, known));
  return out;
}

Parameters Object::parameters(const std::string& key) {
  if (const auto n = find(key)) return n->parameters();
  return {"{}", pointer() + pointer_token(key), node_.document().folder()};
}

std::vector<std::pair<std::string, Node>> Object::entries() const {
  std::vector<std::pair<std::string, Node>> out;
  for (const auto& item : node_.json().items()) out.emplace_back(item.key(), child(item.key(), item.value()));
  return out;
}

void Object::done() const {
  for (const auto& item : node_.json().items())
    if (std::find(asked_.begin(), asked_.end(), item.key()) == asked_.end())
      node_.document().fail(pointer() + pointer_token(item.key()), "unknown key; " + did_you_mean(item.key(), asked_));
}

void check_name(const Node& node, const std::string& name) {
  if (name.empty()) node.fail("the name is empty; must be text without \"/\"");
  for (const char c : name)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32)
      node.fail("\"" + name +
                "\" cannot be a name; must not hold slashes, line ends or tabs, since files are named after it");
}

}  // namespace calx
