// effect_edits.cpp: the edits by which an effect enters a case. An edit is
//   {"op": "append", "to": POINTER, "value": V}      V becomes the last entry of a list, made where it is missing
//   {"op": "set", "at": POINTER, "value": V}         V replaces what stands there
//   {"op": "add", "at": POINTER, "value": V, "times": n, "unit": u}
//                                                    n V (in u) is added to the number there, or to the plugin's preset
//   {"op": "scale", "at": POINTER, "value": V, "times": n, "optional": true}
//                                                    every number there and below is multiplied by 1 + n V
//   {"op": "carry", "part": P, "motion": M}          motion M is applied on top of all that moves part P
// and may hold "unless_off": true, which leaves it out while every amplitude is off. {NAME} stands for a role's name or
// a parameter's number; a list of named objects is entered by name; "A|B" is the contact between two materials, whose
// "law" becomes "laws" where an edit goes on to these. {"$copy": POINTER or a list of them} copies the first value that
// the case has; {"$bounds": REGION, "corner": "min"} gives a corner of the box round a region.
#include "config/effect_edits.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/case_reader.hpp"
#include "config/node.hpp"
#include "config/tables.hpp"

namespace calx {
namespace {

const char* const section_of[][2] = {{"part", "parts"},     {"motion", "motions"}, {"material", "materials"},
                                     {"region", "regions"}, {"sensor", "sensors"}, {"source", "sources"},
                                     {"shape", "shapes"},   {"event", "events"}};

std::string text_of(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Name of an entry of a list; sources without one are called by their number.
std::string entry_name(const Json& entry, const std::string& section, std::size_t index) {
  const std::string name = text_of(entry, "name");
  return name.empty() && section == "sources" ? "source " + std::to_string(index) : name;
}

std::string plugin_of(const Json& object) {
  for (const char* key : {"geometry", "plugin", "kind", "law"}) {
    const std::string id = text_of(object, key);
    if (!id.empty()) return id;
  }
  return "";
}

const Json* section(const Json& root, const std::string& name) {
  const auto found = root.find(name);
  return found == root.end() ? nullptr : &*found;
}

class Editor {
 public:
  Editor(Document& document, const EffectUse& use, const EffectLibrary& library)
      : document_(document), use_(use), library_(library) {}

  void apply(const Json& edit, std::size_t number) {
    const std::string op = edit["op"];
    what_ = "effect " + use_.effect->id + ", edit " + std::to_string(number) + " (" + op + "): ";
    if (edit.value("unless_off", false) && use_.is_off()) return;
    if (op == "append") append(edit);
    if (op == "set") set(edit);
    if (op == "add") add(edit);
    if (op == "scale") scale(edit);
    if (op == "carry") carry(edit);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { document_.fail(use_.pointer, what_ + why); }

  std::string name_filled(const std::string& text) const {
    std::string out = text;
    for (const std::string& name : placeholders(text)) {
      const auto role = use_.on.find(name);
      const std::string with = role != use_.on.end() ? role->second : format_number(use_.values.at(name));
      for (std::size_t at = 0; (at = out.find("{" + name + "}", at)) != std::string::npos; at += with.size())
        out.replace(at, name.size() + 2, with);
    }
    return out;
  }

  /// The value of an edit with everything in braces filled in; null for an optional copy of what is not there.
  Json filled(const Json& value) {
    if (value.is_string()) {
      const std::string text = value.get<std::string>();
      for (const auto& p : use_.values)
        if (text == "{" + p.first + "}") return p.second;
      return name_filled(text);
    }
    if (value.is_object() && value.count("$copy")) {
      const Json places = value["$copy"].is_array() ? value["$copy"] : Json::array({value["$copy"]});
      for (const Json& place : places)
        if (const Json* found = find(place, false)) return *found;
      if (value.value("optional", false)) return nullptr;
      fail("the case has no " + name_filled(places.back()));
    }
    if (value.is_object() && value.count("$bounds")) return corner(value);
    Json out = value.is_array() ? Json::array() : Json::object();
    if (value.is_array())
      for (const Json& entry : value) out.push_back(filled(entry));
    else if (value.is_object())
      for (const auto& item : value.items()) {
        Json with = filled(item.value());
        if (!with.is_null()) out[item.key()] = with;
      }
    else
      return value;
    return out;
  }

  Json corner(const Json& value) {
    const std::string name = name_filled(value["$bounds"]);
    const Box box = CaseReader::named_region(document_, name).bounds();
    const Vec3& at = value.value("corner", "") == "max" ? box.hi : box.lo;
    return Json::array({at.x, at.y, at.z});
  }

  /// The entry of a list that a token names.
  Json* entry(Json& list, const std::string& section, const std::string& token) {
    const std::size_t bar = token.find('|');
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (std::to_string(k) == token || entry_name(list[k], section, k) == token) return &list[k];
      if (bar == std::string::npos || !list[k].is_object() || !list[k].count("between")) continue;
      const Json& pair = list[k]["between"];
      const std::string a = token.substr(0, bar), b = token.substr(bar + 1);
      if (pair == Json{a, b} || pair == Json{b, a}) return &list[k];
    }
    return nullptr;
  }

  /// A contact with one law becomes one with a list of one.
  static void make_list(Json& contact) {
    if (contact.count("laws") || !contact.count("law")) return;
    Json law = Json::object();
    for (const char* key : {"law", "name", "parameters"})
      if (contact.count(key)) {
        law[key] = contact[key];
        contact.erase(key);
      }
    contact["laws"] = Json::array({law});
  }

  /// What stands at a pointer; null when it is not there, unless objects on the way are to be made.
  Json* find(const std::string& pointer, bool make) {
    Json* here = &document_.change();
    std::string first;
    for (std::size_t from = 1; from <= pointer.size();) {
      const std::size_t to = std::min(pointer.find('/', from), pointer.size());
      const std::string token = name_filled(pointer.substr(from, to - from));
      from = to + 1;
      if (first.empty()) first = token;
      if (token == "laws" && here->is_object()) make_list(*here);
      if (here->is_array()) {
        here = entry(*here, first, token);
        if (!here) return nullptr;
      } else if (here->is_object() && here->count(token)) {
        here = &(*here)[token];
      } else if (here->is_object() && make) {
        here = &(*here)[token];
        if (from <= pointer.size()) *here = Json::object();
      } else {
        return nullptr;
      }
    }
    return here;
  }

  Json& need(const Json& pointer, bool make) {
    Json* found = find(pointer, make);
    if (!found) fail("the case has no " + name_filled(pointer));
    return *found;
  }

  void append(const Json& edit) {
    const Json value = filled(edit["value"]);
    Json& list = need(edit["to"], true);
    if (list.is_null()) list = Json::array();
    if (!list.is_array()) fail(name_filled(edit["to"]) + " is " + shown(list) + ", not a list");
    list.push_back(value);
  }

  void set(const Json& edit) {
    const Json value = filled(edit["value"]);
    if (!value.is_null()) need(edit["at"], true) = value;
  }

  double amount(const Json& edit) {
    const Json value = filled(edit["value"]);
    if (!value.is_number()) fail("\"value\" is " + shown(value) + "; must be a number");
    return edit.value("times", 1.0) * value.get<double>();
  }

  /// Adds in SI, whatever form the user gave the number: plain, with a unit, or under the name that ends in "_deg".
  void add(const Json& edit) {
    const std::string unit = edit.value("unit", "1");
    const double more = amount(edit) * parse_unit(unit).factor;
    const std::string pointer = edit["at"];
    const std::size_t slash = pointer.rfind('/');
    const std::string name = pointer.substr(slash + 1), parent = pointer.substr(0, slash);
    Json& object = need(parent, true);
    if (object.is_null()) object = Json::object();
    const std::string si = unit == "deg" ? "rad" : unit;
    double old = 0;
    if (object.count(name)) {
      old = Node(document_, object[name], name_filled(pointer)).number(si);
    } else if (object.count(name + "_deg")) {
      old = from_degrees(Node(document_, object[name + "_deg"], name_filled(pointer) + "_deg").number("1"), si);
      object.erase(name + "_deg");
    } else {
      const Json* owner = find(parent.substr(0, parent.rfind('/')), false);
      const auto preset = library_.preset(owner ? plugin_of(*owner) : "", name);
      if (!preset) fail("the case gives no " + name_filled(pointer) + ", and its plugin has no preset of it");
      old = *preset;
    }
    object[name] = old + more;
  }

  static void multiply(Json& value, double factor) {
    if (value.is_number())
      value = factor * value.get<double>();
    else if (value.is_array() || value.is_object())
      for (Json& inside : value) multiply(inside, factor);
  }
  void scale(const Json& edit) {
    const double factor = 1 + amount(edit);
    Json* there = find(edit["at"], false);
    if (there)
      multiply(*there, factor);
    else if (!edit.value("optional", false))
      fail("the case has no " + name_filled(edit["at"]));
  }

  void carry(const Json& edit) {
    const std::string part = name_filled(edit["part"]), motion = name_filled(edit["motion"]);
    Json& root = document_.change();
    std::string inner = text_of(need("/parts/" + edit["part"].get<std::string>(), false), "motion");
    if (inner.empty()) {
      need("/parts/" + edit["part"].get<std::string>(), false)["motion"] = motion;
      return;
    }
    for (std::size_t depth = 0; depth <= root["motions"].size(); ++depth) {
      if (!root["motions"].count(inner))
        fail("part \"" + part + "\" is moved by \"" + inner + "\", which is not there");
      const std::string outer = text_of(root["motions"][inner], "carried_by");
      if (outer.empty()) break;
      inner = outer;
    }
    root["motions"][inner]["carried_by"] = motion;
  }

  Document& document_;
  const EffectUse& use_;
  const EffectLibrary& library_;
  std::string what_;
};

}  // namespace

bool EffectUse::is_off() const {
  for (const EffectParameter& p : effect->parameters)
    if (p.is_amplitude && std::fabs(values.at(p.name) - p.off) > 0) return false;
  return true;
}

std::vector<std::string> placeholders(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = text.find('{', at)) != std::string::npos;) {
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) break;
    out.push_back(text.substr(at + 1, end - at - 1));
    at = end;
  }
  return out;
}

std::vector<std::string> names_of_kind(const Json& root, const std::string& kind) {
  std::vector<std::string> out;
  for (const auto& row : section_of) {
    if (kind != row[0]) continue;
    const Json* all = section(root, row[1]);
    if (all && all->is_object())
      for (const auto& item : all->items()) out.push_back(item.key());
    if (all && all->is_array())
      for (std::size_t k = 0; k < all->size(); ++k) out.push_back(entry_name((*all)[k], row[1], k));
  }
  return out;
}

std::vector<std::string> role_candidates(const Json& root, const EffectRole& role) {
  std::vector<std::string> out;
  if (!role.used_by.empty()) {
    const Json* users = section(root, role.used_by);
    if (users && users->is_array())
      for (const Json& user : *users) {
        const std::string name = text_of(user, "material");
        if (!name.empty() && std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
      }
    return out;
  }
  const std::vector<std::string> names = names_of_kind(root, role.kind);
  if (role.plugins.empty()) return names;
  for (const auto& row : section_of) {
    const Json* all = role.kind == row[0] ? section(root, row[1]) : nullptr;
    if (!all || !all->is_structured()) continue;
    std::size_t k = 0;
    for (const Json& entry : *all) {
      if (std::find(role.plugins.begin(), role.plugins.end(), plugin_of(entry)) != role.plugins.end())
        out.push_back(names[k]);
      ++k;
    }
  }
  return out;
}

const std::vector<EditShape>& edit_shapes() {
  static const std::vector<EditShape> shapes = {{"append", {"to", "value"}, {}},
                                                {"set", {"at", "value"}, {}},
                                                {"add", {"at", "value"}, {"times", "unit"}},
                                                {"scale", {"at", "value"}, {"times", "optional"}},
                                                {"carry", {"part", "motion"}, {}}};
  return shapes;
}

void apply_edits(Document& document, const EffectUse& use, const EffectLibrary& library) {
  const Json edits = Json::parse(use.effect->edits);
  Editor editor(document, use, library);
  for (std::size_t k = 0; k < edits.size(); ++k) editor.apply(edits[k], k);
}

}  // namespace calx
