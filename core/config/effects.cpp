// effects.cpp: the manifest object "effect", checked, and the key "effects" of a case: which effect, on what, how
// strong.
#include "config/effects.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/case_effects.hpp"
#include "config/effect_edits.hpp"
#include "config/node.hpp"

namespace calx {
namespace {

const std::vector<std::string> role_kinds = {"part",   "motion", "material", "region",
                                             "sensor", "source", "shape",    "event"};
const std::vector<std::string> signs = {"any", "positive", "negative"};

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(Fault::plugin, where + ": " + what);
}

void check_keys(const Json& object, const std::string& where, const std::vector<std::string>& known) {
  if (!object.is_object()) refuse(where, shown(object) + " is not an object");
  for (const auto& item : object.items())
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      refuse(where + "/" + item.key(), "unknown key; " + did_you_mean(item.key(), known));
}

const Json& need(const Json& object, const std::string& key, const std::string& where, const std::string& what) {
  const auto found = object.find(key);
  if (found == object.end()) refuse(where + "/" + key, "is missing; " + what);
  return *found;
}

std::string text(const Json& object, const std::string& key, const std::string& where, const std::string& what) {
  const Json& value = need(object, key, where, what);
  if (!value.is_string() || value.get<std::string>().empty())
    refuse(where + "/" + key, shown(value) + "; must be " + what);
  return value.get<std::string>();
}

double number(const Json& object, const std::string& key, const std::string& where, const std::string& what) {
  const Json& value = need(object, key, where, what);
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    refuse(where + "/" + key, shown(value) + "; must be " + what);
  return value.get<double>();
}

std::vector<std::string> texts(const Json& object, const std::string& key, const std::string& where,
                               const std::vector<std::string>& known) {
  std::vector<std::string> out;
  const auto found = object.find(key);
  if (found == object.end()) return out;
  if (!found->is_array()) refuse(where + "/" + key, shown(*found) + "; must be a list of texts");
  for (std::size_t k = 0; k < found->size(); ++k) {
    const Json& value = (*found)[k];
    const std::string at = where + "/" + key + pointer_token(k);
    if (!value.is_string()) refuse(at, shown(value) + "; must be text");
    out.push_back(value.get<std::string>());
    if (!known.empty() && std::find(known.begin(), known.end(), out.back()) == known.end())
      refuse(at, "\"" + out.back() + "\" is not known; " + did_you_mean(out.back(), known));
  }
  return out;
}

bool is_name(const std::string& name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_ ") == std::string::npos;
}

EffectParameter parse_parameter(const Json& j, const std::string& where) {
  check_keys(j, where, {"name", "unit", "off", "preset", "scale", "sign", "range", "doc", "direction_of"});
  EffectParameter p;
  p.name = text(j, "name", where, "a name");
  if (!is_name(p.name)) refuse(where + "/name", "\"" + p.name + "\"; must be of a-z, 0-9 and _");
  p.unit = text(j, "unit", where, "the unit of the number, \"1\" for none");
  try {
    parse_unit(p.unit);
  } catch (const Error& e) {
    refuse(where + "/unit", e.what());
  }
  p.doc = text(j, "doc", where, "what the parameter means");
  p.is_amplitude = j.count("off") != 0;
  if (p.is_amplitude == (j.count("preset") != 0))
    refuse(where, "must hold \"off\", where nothing happens, or \"preset\", for what shapes the effect only");
  p.off = number(j, p.is_amplitude ? "off" : "preset", where, "a number");
  if (p.is_amplitude) {
    p.scale = number(j, "scale", where, "a typical strength, as distance from off");
    if (!(p.scale > 0)) refuse(where + "/scale", shown(j["scale"]) + "; must be above 0");
  } else if (j.count("scale")) {
    refuse(where + "/scale", "is for parameters with an \"off\" value");
  }
  if (j.count("direction_of")) {
    p.direction_of = text(j, "direction_of", where, "the amplitude that the angle turns");
    if (p.is_amplitude || p.unit != "deg") refuse(where + "/direction_of", "is for angles in deg with a \"preset\"");
  }
  if (j.count("sign")) {
    const std::string sign = text(j, "sign", where, "one of " + quoted_list(signs));
    const auto found = std::find(signs.begin(), signs.end(), sign);
    if (found == signs.end()) refuse(where + "/sign", "\"" + sign + "\" is not a sign; " + did_you_mean(sign, signs));
    p.sign = static_cast<EffectParameter::Sign>(found - signs.begin());
  }
  const Json& range = need(j, "range", where, "lowest and highest value");
  if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number() ||
      !(range[0].get<double>() < range[1].get<double>()))
    refuse(where + "/range", shown(range) + "; must be two numbers, the lower one first");
  p.lowest = range[0].get<double>();
  p.highest = range[1].get<double>();
  if (!(p.off >= p.lowest && p.off <= p.highest))
    refuse(where + (p.is_amplitude ? "/off" : "/preset"), format_number(p.off) + " lies outside of the range");
  if ((p.sign == EffectParameter::Sign::positive && p.lowest < p.off) ||
      (p.sign == EffectParameter::Sign::negative && p.highest > p.off))
    refuse(where + "/range", "holds values on the side of \"off\" that \"sign\" excludes");
  return p;
}

EffectRole parse_role(const Json& j, const std::string& where) {
  check_keys(j, where, {"name", "kind", "plugins", "used_by", "doc"});
  EffectRole r;
  r.name = text(j, "name", where, "a name");
  if (!is_name(r.name)) refuse(where + "/name", "\"" + r.name + "\"; must be of a-z, 0-9, _ and spaces");
  r.kind = text(j, "kind", where, "one of " + quoted_list(role_kinds));
  if (std::find(role_kinds.begin(), role_kinds.end(), r.kind) == role_kinds.end())
    refuse(where + "/kind", "\"" + r.kind + "\" is no kind of role; " + did_you_mean(r.kind, role_kinds));
  r.doc = text(j, "doc", where, "what plays the role");
  r.plugins = texts(j, "plugins", where, {});
  if (j.count("used_by")) {
    r.used_by = text(j, "used_by", where, "\"sources\" or \"parts\"");
    if (r.used_by != "sources" && r.used_by != "parts")
      refuse(where + "/used_by", "\"" + r.used_by + "\"; must be \"sources\" or \"parts\"");
  }
  return r;
}

/// Every text in the edit, however deep: its placeholders must be roles or parameters.
void check_placeholders(const Json& value, const EffectInfo& effect, const std::string& where) {
  if (value.is_string())
    for (const std::string& name : placeholders(value.get<std::string>()))
      if (!effect.parameter(name) && !effect.role(name))
        refuse(where, "{" + name + "} is neither a parameter nor a role of the effect");
  if (value.is_object())
    for (const auto& item : value.items()) check_placeholders(item.value(), effect, where + pointer_token(item.key()));
  if (value.is_array())
    for (std::size_t k = 0; k < value.size(); ++k) check_placeholders(value[k], effect, where + pointer_token(k));
}

void check_edit(const Json& edit, const EffectInfo& effect, const std::string& where) {
  if (!edit.is_object()) refuse(where, shown(edit) + " is not an object");
  std::vector<std::string> ops;
  for (const EditShape& shape : edit_shapes()) ops.push_back(shape.op);
  const std::string op = text(edit, "op", where, "one of " + quoted_list(ops));
  const auto shape =
      std::find_if(edit_shapes().begin(), edit_shapes().end(), [&](const EditShape& s) { return op == s.op; });
  if (shape == edit_shapes().end()) refuse(where + "/op", "\"" + op + "\" is no operation; " + did_you_mean(op, ops));
  std::vector<std::string> known = {"op", "unless_off"};
  known.insert(known.end(), shape->needs.begin(), shape->needs.end());
  known.insert(known.end(), shape->may.begin(), shape->may.end());
  check_keys(edit, where, known);
  for (const std::string& key : shape->needs) need(edit, key, where, "\"" + op + "\" needs it");
  for (const char* flag : {"unless_off", "optional"})
    if (edit.count(flag) && !edit[flag].is_boolean()) refuse(where + "/" + flag, "must be true or false");
  if (edit.count("times")) number(edit, "times", where, "a number");
  if (edit.count("unit")) text(edit, "unit", where, "a unit");
  for (const char* pointer : {"to", "at"})
    if (edit.count(pointer) && text(edit, pointer, where, "a JSON pointer")[0] != '/')
      refuse(where + "/" + pointer, "must be a JSON pointer such as /parts/{rotor}/parameters/gap");
  check_placeholders(edit, effect, where);
}

EffectUse read_use(const Node& node, const std::vector<EffectInfo>& effects) {
  EffectUse use;
  use.pointer = node.pointer();
  Object object(node, "an effect");
  const Node id = object.need("effect", "the id of an effect, such as \"calx.canister-tilt\"");
  const std::string name = id.text("the id of an effect");
  std::vector<std::string> known;
  for (const EffectInfo& e : effects) {
    if (e.id == name) use.effect = &e;
    known.push_back(e.id);
  }
  if (!use.effect) id.fail("no effect \"" + name + "\" among the plugins found; " + did_you_mean(name, known));
  const EffectInfo& effect = *use.effect;

  Object on = object.section("on", "names by role");
  for (const auto& entry : on.entries()) {
    std::vector<std::string> roles;
    for (const EffectRole& r : effect.roles) roles.push_back(r.name);
    if (!effect.role(entry.first))
      entry.second.fail("effect " + name + " has no role \"" + entry.first + "\"; " + did_you_mean(entry.first, roles));
  }
  const Json& root = node.document().root();
  for (const EffectRole& role : effect.roles) {
    const std::vector<std::string> fit = role_candidates(root, role);
    const std::string what = role.plugins.empty() ? role.kind : role.kind + " of " + quoted_list(role.plugins);
    if (const auto given = on.find(role.name)) {
      const std::string chosen = given->name_of(role.kind, names_of_kind(root, role.kind));
      if (!role.plugins.empty() && std::find(fit.begin(), fit.end(), chosen) == fit.end())
        given->fail("\"" + chosen + "\" cannot be the " + role.name + " of effect " + name + ", which must be a " +
                    what);
      use.on[role.name] = chosen;
    } else if (fit.size() == 1 || std::find(fit.begin(), fit.end(), role.name) != fit.end()) {
      use.on[role.name] = fit.size() == 1 ? fit[0] : role.name;
    } else {
      node.document().fail(
          node.pointer() + "/on" + pointer_token(role.name),
          "effect " + name + " needs a " + role.name + " (" + role.doc + "): " +
              (fit.empty() ? "the case has no " + what : "the case has several; name one of " + quoted_list(fit)));
    }
  }

  Object parameters = object.section("parameters", "parameters of the effect");
  for (const EffectParameter& p : effect.parameters) {
    double value = p.off;
    const auto given = parameters.find(p.name);
    if (!given && p.is_amplitude)
      parameters.need(
          p.name,
          "effect " + name + " needs its strength: " + p.doc + "; off is " + format_quantity(p.off, p.unit) +
              ", typical are " +
              format_quantity(p.sign == EffectParameter::Sign::negative ? p.off - p.scale : p.off + p.scale, p.unit));
    if (given) {
      // A plain number is in the unit of the parameter; one with a unit is converted.
      value = given->json().is_object() ? given->number(p.unit) / parse_unit(p.unit).factor : given->number("1");
      if (!(value >= p.lowest && value <= p.highest))
        given->fail(format_quantity(value, p.unit) + " is out of range; effect " + name + " allows " +
                    format_number(p.lowest) + " to " + format_quantity(p.highest, p.unit));
    }
    use.values[p.name] = value;
  }
  parameters.done();
  for (const char* key : {"version", "expanded"}) object.has(key);
  object.done();
  return use;
}

std::string assumption(const EffectUse& use) {
  std::string out = "Effect " + use.effect->id + " " + use.effect->version;
  std::string on, values;
  for (const EffectRole& r : use.effect->roles)
    on += (on.empty() ? "" : ", ") + r.name + " \"" + use.on.at(r.name) + "\"";
  for (const EffectParameter& p : use.effect->parameters)
    values += (values.empty() ? "" : ", ") + p.name + " = " + format_quantity(use.values.at(p.name), p.unit);
  return out + (on.empty() ? "" : " on " + on) + ": " + values + (use.is_off() ? " (off)." : ".");
}

}  // namespace

const EffectParameter* EffectInfo::parameter(const std::string& name) const {
  for (const EffectParameter& p : parameters)
    if (p.name == name) return &p;
  return nullptr;
}

const EffectRole* EffectInfo::role(const std::string& name) const {
  for (const EffectRole& r : roles)
    if (r.name == name) return &r;
  return nullptr;
}

const std::vector<std::string>& effect_observables() {
  static const std::vector<std::string> kinds = {
      "mass-per-cycle", "mass-after-cycles", "load-cell",     "folded-flow",  "hopper-discharge", "flow-rate",
      "drained-angle",  "static-angle",      "dynamic-angle", "pile-profile", "residue",          "bulk-density",
      "tapped-density", "compressibility",   "wall-friction", "shear",        "fill-height",      "torque",
      "other"};
  return kinds;
}

EffectInfo parse_effect(const std::string& source, const std::string& where) {
  const Json j = Json::parse(source);
  check_keys(j, where, {"parameters", "roles", "touches", "rivals", "instrument", "edits"});
  EffectInfo effect;
  const auto list = [&](const char* key, bool needed) -> const Json& {
    static const Json none = Json::array();
    const auto found = j.find(key);
    if (found == j.end() && !needed) return none;
    const Json& value = need(j, key, where, "must be a list");
    if (!value.is_array() || (needed && value.empty()))
      refuse(where + "/" + key, shown(value) + "; must be a list" + (needed ? " of at least one" : ""));
    return value;
  };
  const Json& parameters = list("parameters", true);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const std::string at = where + "/parameters" + pointer_token(k);
    EffectParameter p = parse_parameter(parameters[k], at);
    if (effect.parameter(p.name)) refuse(at + "/name", "\"" + p.name + "\" stands twice");
    effect.parameters.push_back(std::move(p));
  }
  if (std::none_of(effect.parameters.begin(), effect.parameters.end(),
                   [](const EffectParameter& p) { return p.is_amplitude; }))
    refuse(where + "/parameters", "none has an \"off\" value, so the effect cannot be switched off");
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    const std::string& turned = effect.parameters[k].direction_of;
    const EffectParameter* amplitude = effect.parameter(turned);
    if (!turned.empty() && !(amplitude && amplitude->is_amplitude))
      refuse(where + "/parameters" + pointer_token(k) + "/direction_of",
             "\"" + turned + "\" is no parameter of the effect with an \"off\" value");
  }
  const Json& roles = list("roles", false);
  for (std::size_t k = 0; k < roles.size(); ++k) {
    const std::string at = where + "/roles" + pointer_token(k);
    EffectRole r = parse_role(roles[k], at);
    if (effect.role(r.name) || effect.parameter(r.name)) refuse(at + "/name", "\"" + r.name + "\" stands twice");
    effect.roles.push_back(std::move(r));
  }
  effect.touches = texts(j, "touches", where, effect_observables());
  if (effect.touches.empty()) refuse(where + "/touches", "must name the kinds of observables the effect can change");
  const Json& rivals = list("rivals", false);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    const std::string at = where + "/rivals" + pointer_token(k);
    check_keys(rivals[k], at, {"effect", "separate"});
    effect.rivals.push_back({text(rivals[k], "effect", at, "an effect that looks alike"),
                             text(rivals[k], "separate", at, "the measurement that tells them apart")});
  }
  if (j.count("instrument")) {
    if (!j["instrument"].is_boolean())
      refuse(where + "/instrument", shown(j["instrument"]) + "; must be true or false");
    effect.is_instrument = j["instrument"].get<bool>();
  }
  const Json& edits = list("edits", true);
  for (std::size_t k = 0; k < edits.size(); ++k) check_edit(edits[k], effect, where + "/edits" + pointer_token(k));
  effect.edits = edits.dump();
  return effect;
}

void expand_effects(Document& document, const EffectLibrary* library) {
  const auto found = document.root().find("effects");
  if (found == document.root().end()) return;
  const Node list(document, *found, "/effects");
  std::vector<EffectInfo> effects;
  std::vector<EffectUse> uses;
  Json record = *found;
  std::vector<std::size_t> places;
  for (const Node& node : list.items("effects")) {
    // A case as resolved holds what was expanded as a record.
    const bool done = node.json().is_object() && node.json().value("expanded", Json(false)) == Json(true);
    places.push_back(places.size());
    if (done) continue;
    if (!library) node.fail("effects come from plugins, and this reader was given none; read the case with plugins");
    if (effects.empty()) effects = library->effects();
    EffectUse use = read_use(node, effects);
    Json on = Json::object(), values = Json::object();
    for (const EffectRole& r : use.effect->roles) on[r.name] = use.on.at(r.name);
    for (const EffectParameter& p : use.effect->parameters) values[p.name] = use.values.at(p.name);
    record[places.back()] = {{"effect", use.effect->id},
                             {"version", use.effect->version},
                             {"on", on},
                             {"parameters", values},
                             {"expanded", true}};
    uses.push_back(std::move(use));
  }
  for (const EffectUse& use : uses) {
    apply_edits(document, use, *library);
    Json& assumptions = document.change()["assumptions"];
    if (assumptions.is_null()) assumptions = Json::array();
    if (assumptions.is_array()) assumptions.push_back(assumption(use));
  }
  document.change()["effects"] = record;
}

}  // namespace calx
