#include "study/generic_terms.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/text.hpp"
#include "config/effects.hpp"
#include "io/io.hpp"
#include "study/formula.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

/// Amplitudes beyond so many scales are held to be impossible.
constexpr double highest_in_scales = 40;

/// What formulas of contacts may use.
constexpr const char* contact_inputs = R"(  const real load = calx_max(c->fn_before, R(0.0));
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real vt2 = c->vx * c->vx + c->vy * c->vy + c->vz * c->vz - vn * vn;
  const real speed = calx_sqrt(calx_max(vt2, R(0.0)));
  const real radius = R(@RADII@) * c->r_eff;
  const real stress = load / (R(3.141592653589793) * radius * radius);
  const real time = c->time;
)";

constexpr const char* friction_text = R"(#define @S@_state_LIST(X)                                         \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x") \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y") \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define @S@_NEEDS \
  (CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF | CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(@S@)

CALX_LAW_EVAL(@S@) {
  CALX_ID(calx_spring) spring;
@INPUTS@  const real more = calx_max(p->amount * (@FORMULA@), R(0.0));
  const real limit = load * more;
  /* The spring slips after a hundredth of the radius, whatever the load: no stiffness of the laws before is known. */
  const real kt = limit / (R(0.01) * radius);
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(calx_slide)(c, vn, kt, kt, R(1.0), R(1.0), R(0.0), limit, &spring);
  s->spring_x = p->amount > R(0.0) ? spring.x : R(0.0);
  s->spring_y = p->amount > R(0.0) ? spring.y : R(0.0);
  s->spring_z = p->amount > R(0.0) ? spring.z : R(0.0);
  out->fx = spring.fx;
  out->fy = spring.fy;
  out->fz = spring.fz;
  out->elastic = spring.elastic;
  out->friction = spring.friction;
}
)";

constexpr const char* pull_text = R"(#define @S@_state_LIST(X)
#define @S@_NEEDS \
  (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF | CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(@S@)

CALX_LAW_EVAL(@S@) {
@INPUTS@  const real pull = R(9.81) * c->m_eff * calx_max(p->amount * (@FORMULA@), R(0.0));
  out->fx = -pull * c->nx;
  out->fy = -pull * c->ny;
  out->fz = -pull * c->nz;
  out->elastic = -pull * c->overlap;
}
)";

constexpr const char* drag_text = R"(
CALX_FORCE_DECLARE(@S@)

CALX_FORCE_EVAL(@S@) {
  const real x = b->x;
  const real y = b->y;
  const real z = b->z;
  const real speed = calx_sqrt(b->vx * b->vx + b->vy * b->vy + b->vz * b->vz);
  const real time = b->time;
  const real drag = b->mass * calx_max(p->amount * (@FORMULA@), R(0.0));
  out->fx = -drag * b->vx;
  out->fy = -drag * b->vy;
  out->fz = -drag * b->vz;
}
)";

bool begins_with(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

std::string symbol_of(const GenericTerm& term) {
  std::string out = "generic_" + term.name;
  std::replace(out.begin(), out.end(), '-', '_');
  return out;
}

const GenericTarget& target_of(const std::string& name) {
  const auto& all = generic_targets();
  return *std::find_if(all.begin(), all.end(), [&](const GenericTarget& t) { return t.name == name; });
}

std::string amount_words(const GenericTerm& term) {
  return target_of(term.target).doc + " is amount" + (term.formula == "1" ? "" : " * (" + term.formula + ")");
}

std::string law_text(const GenericTerm& term) {
  const GenericTarget& target = target_of(term.target);
  const bool is_drag = target.name == "drag", on_wall = begins_with(target.name, "wall");
  std::string out =
      "/* @S@.law.h: " + target.doc + " by amount times a formula. A generic term, no named cause. */\n#define @S@_" +
      (is_drag ? "row" : "pair") + "_LIST(X) X(amount, \"1\", 0, 1e12, 0, 0, \"factor of the formula\")\n";
  if (!is_drag) out += "#define @S@_prop_LIST(X)\n";
  out += is_drag ? drag_text : target.name.find("friction") != std::string::npos ? friction_text : pull_text;
  out = replaced(out, "@INPUTS@", contact_inputs);
  // Of equal grains the reduced radius is half of one; of a grain on a wall it is the whole.
  out = replaced(out, "@RADII@", on_wall ? "1.0" : "2.0");
  return replaced(replaced(out, "@S@", symbol_of(term)), "@FORMULA@", term.dialect);
}

std::string manifest_text(const GenericTerm& term) {
  const GenericTarget& target = target_of(term.target);
  const bool is_drag = target.name == "drag", on_wall = begins_with(target.name, "wall");
  Json roles = Json::array();
  if (!is_drag)
    roles.push_back({{"name", "powder"}, {"kind", "material"}, {"used_by", "sources"}, {"doc", "the grains"}});
  if (on_wall)
    roles.push_back({{"name", "wall"}, {"kind", "material"}, {"used_by", "parts"}, {"doc", "the walls concerned"}});
  const Json parameters = {{"amount", "{amount}"}};
  const Json edit =
      is_drag
          ? Json{{"op", "append"}, {"to", "/forces"}, {"value", {{"plugin", term.id()}, {"parameters", parameters}}}}
          : Json{{"op", "append"},
                 {"to", std::string("/contacts/{powder}|") + (on_wall ? "{wall}" : "{powder}") + "/laws"},
                 {"value", {{"law", term.id()}, {"parameters", parameters}}}};
  const Json effect = {{"parameters",
                        {{{"name", "amount"},
                          {"unit", "1"},
                          {"off", 0},
                          {"scale", term.scale},
                          {"sign", "positive"},
                          {"range", {0, highest_in_scales * term.scale}},
                          {"doc", amount_words(term) + ", " + target.unit}}}},
                       {"roles", roles},
                       {"touches", effect_observables()},
                       {"rivals", Json::array()},
                       {"edits", {edit}}};
  Json plugin = {{"id", term.id()},
                 {"kind", is_drag ? "calx.particle-force/1" : "calx.contact-law/1"},
                 {"summary", "Generic term, no named cause: " + amount_words(term) + "."},
                 {"text", symbol_of(term) + ".law.h"},
                 {"effect", effect}};
  const Json out = {{"calx_plugin", 1},         {"abi", {{"major", 1}, {"minor", 0}}},
                    {"version", "1.0.0"},       {"vendor", "calx diagnose"},
                    {"license", "Apache-2.0"},  {"plugins", {plugin}},
                    {"requires", Json::array()}};
  return out.dump(2) + "\n";
}

GenericTerm usual(const char* name, const char* target, const char* formula, double scale) {
  GenericTerm out{name, target, formula, "", scale};
  const Json text = formula;
  Document document(Parameters{text.dump(), "", "/"}, "");
  out.dialect = dialect_formula(Node(document, document.root(), ""), target_of(target).variables);
  return out;
}

GenericTerm read_own(const Node& node) {
  Object o(node, "a generic term");
  GenericTerm out;
  const Node name = o.need("name", "what the term is called, such as \"wall-friction-fast\"");
  out.name = name.text("a name of small letters, digits and -");
  if (out.name.empty() || out.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos)
    name.fail(shown(name.json()) + "; must be small letters, digits and -");
  std::vector<std::string> targets;
  for (const GenericTarget& t : generic_targets()) targets.push_back(t.name);
  out.target = o.need("on", "where it acts: " + quoted_list(targets)).name_of("target of generic terms", targets);
  const Node formula = o.need("formula", "such as \"speed / (speed + 0.1)\"");
  out.dialect = dialect_formula(formula, target_of(out.target).variables);
  out.formula = formula.json().get<std::string>();
  out.scale = o.need("scale", "a typical amplitude").number("1", Allow::above_zero);
  o.done();
  return out;
}

}  // namespace

const std::vector<GenericTarget>& generic_targets() {
  static const std::vector<std::string> of_contact = {"speed", "load", "stress", "time"};
  static const std::vector<GenericTarget> all = {
      {"grain friction", "1", "friction among grains added to that of the case", of_contact},
      {"wall friction", "1", "friction on walls added to that of the case", of_contact},
      {"grain pull", "weights of the reduced mass", "pull between grains that touch", of_contact},
      {"wall pull", "weights of the grain", "pull of walls on grains that touch", of_contact},
      {"drag", "1/s", "drag on a grain over mass and speed", {"speed", "time", "x", "y", "z"}}};
  return all;
}

const std::vector<GenericTerm>& usual_generic_terms() {
  static const std::vector<GenericTerm> all = {
      usual("grain-friction-speed", "grain friction", "speed / (speed + 0.05)", 0.2),
      usual("grain-friction-stress", "grain friction", "1 / (1 + stress / 500)", 0.2),
      usual("wall-friction-speed", "wall friction", "speed / (speed + 0.05)", 0.2),
      usual("wall-friction-stress", "wall friction", "1 / (1 + stress / 500)", 0.2),
      usual("grain-pull", "grain pull", "1", 2),
      usual("grain-pull-time", "grain pull", "time", 2),
      usual("wall-pull", "wall pull", "1", 2),
      usual("drag", "drag", "1", 2)};
  return all;
}

std::vector<GenericTerm> read_generic_terms(const Study& study) {
  Document document(Parameters{study.generic_terms, "/generic_terms", study.folder}, study.file);
  const Node node(document, document.root(), "/generic_terms");
  if (node.json().is_boolean()) return node.boolean() ? usual_generic_terms() : std::vector<GenericTerm>();
  std::vector<std::string> known;
  for (const GenericTerm& t : usual_generic_terms()) known.push_back(t.name);
  std::vector<GenericTerm> out;
  for (const Node& item : node.items("generic terms, or true")) {
    GenericTerm term;
    if (item.json().is_string())
      term =
          *std::find_if(usual_generic_terms().begin(), usual_generic_terms().end(),
                        [name = item.name_of("generic term", known)](const GenericTerm& t) { return t.name == name; });
    else
      term = read_own(item);
    for (const GenericTerm& other : out)
      if (other.name == term.name) item.fail("generic term \"" + term.name + "\" stands twice");
    out.push_back(term);
  }
  return out;
}

void write_generic_plugins(const std::string& folder, const std::vector<GenericTerm>& terms) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(Fault::files, folder + ": cannot be made: " + failed.message());
  for (const GenericTerm& term : terms) {
    write_text_atomically(folder + "/" + symbol_of(term) + ".law.h", law_text(term));
    write_text_atomically(folder + "/" + term.name + ".plugin.json", manifest_text(term));
  }
}

}  // namespace calx
