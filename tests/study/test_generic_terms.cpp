// Generic terms: formulas put into the dialect, what a study may ask for, and the plugins written for them.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "base/error.hpp"
#include "io/io.hpp"
#include "io/scratch.hpp"
#include "plugin/effects.hpp"
#include "plugin/law_lint.hpp"
#include "plugin/plugin.hpp"
#include "study/formula.hpp"
#include "study/generic_terms.hpp"

namespace calx {
namespace {

std::string in_dialect(const std::string& formula) {
  const Json text = formula;
  Document document(Parameters{text.dump(), "/f", "/"}, "study.json");
  const std::vector<std::string> variables = {"speed", "stress"};
  return dialect_formula(Node(document, document.root(), "/f"), variables);
}

std::string refusal(const std::string& formula) {
  try {
    in_dialect(formula);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

std::string refused_terms(const std::string& json) {
  Study study;
  study.file = "study.json", study.folder = "/", study.generic_terms = json;
  try {
    read_generic_terms(study);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a formula becomes an expression of the dialect") {
  CHECK(in_dialect("speed / (speed + 0.1)") == "speed / (speed + R(0.1))");
  CHECK(in_dialect("2*stress-1e3") == "R(2.0) * stress - R(1.0e3)");
  CHECK(in_dialect("-speed") == "(R(0.0) - speed)");
  CHECK(in_dialect("min(speed, max(.5, 3.))") == "calx_min(speed, calx_max(R(0.5), R(3.0)))");
  CHECK(in_dialect("sqrt(stress)") == "calx_sqrt(calx_max(stress, R(0.0)))");
}

TEST_CASE("a formula that is none is refused with its place") {
  CHECK(says(refusal("sped + 1"), "character 1: \"sped\" is not known here; did you mean \"speed\"?"));
  CHECK(says(refusal("speed +"), "ends too early"));
  CHECK(says(refusal("(speed"), "\")\" is missing"));
  CHECK(says(refusal("speed stress"), "character 7: \"s\" is not expected"));
  CHECK(says(refusal("min(speed)"), "\",\" is missing"));
  CHECK(says(refusal("speed; c"), "\";\" is not expected"));
  CHECK(says(refusal("1e"), "exponent"));
  CHECK(says(refusal("2 + 1e999"), "a number is below 1e308"));
  CHECK(says(refusal(std::string(100, '(')), "too many parentheses"));
  CHECK(says(refusal(std::string(2000000, '-')), "too many parentheses or signs"));
  CHECK(refusal(std::string(2000000, '-')).size() < 300);
  CHECK(says(refusal("speed->x"), "\">\" is not known"));
}

TEST_CASE("a study asks for all generic terms, some, or its own") {
  Study study;
  study.file = "study.json", study.folder = "/";
  CHECK(read_generic_terms(study).empty());
  study.generic_terms = "true";
  CHECK(read_generic_terms(study).size() == usual_generic_terms().size());
  study.generic_terms = R"(["drag", {"name": "fast-walls", "on": "wall friction", "formula": "speed", "scale": 0.3}])";
  const std::vector<GenericTerm> terms = read_generic_terms(study);
  REQUIRE(terms.size() == 2);
  CHECK(terms[0].id() == "generic.drag");
  CHECK(terms[1].dialect == "speed");
  CHECK(terms[1].scale == 0.3);
  CHECK(says(refused_terms("7"), "study.json /generic_terms: 7; must be a list of generic terms, or true"));
  CHECK(says(refused_terms(R"(["darg"])"), "study.json /generic_terms/0"));
  CHECK(says(refused_terms(R"(["darg"])"), "did you mean \"drag\"?"));
  CHECK(says(refused_terms(R"(["drag", "drag"])"), "/generic_terms/1: generic term \"drag\" stands twice"));
  CHECK(says(refused_terms(R"([{"name": "a", "on": "walls", "formula": "1", "scale": 1}])"), "/generic_terms/0/on"));
  CHECK(says(refused_terms(R"([{"name": "a", "on": "drag", "formula": "stress", "scale": 1}])"),
             "/generic_terms/0/formula: \"stress\" at character 1"));
  CHECK(says(refused_terms(R"([{"name": "A b", "on": "drag", "formula": "1", "scale": 1}])"), "small letters"));
  CHECK(says(refused_terms(R"([{"name": "a", "on": "drag", "formula": "1", "scale": 0}])"), "/generic_terms/0/scale"));
}

TEST_CASE("every usual term is a text-only plugin that keeps to the dialect") {
  const calx_test::Scratch scratch;
  const std::string folder = scratch / "generic";
  write_generic_plugins(folder, usual_generic_terms());
  const std::vector<PluginManifest> found = discover_plugins({folder});
  CHECK(found.size() == usual_generic_terms().size());
  for (const PluginManifest& m : found) {
    CHECK_MESSAGE(m.refused.empty(), m.refused);
    CHECK(m.library.empty());
    CHECK_MESSAGE(lint_law(read_text(m.text), m.symbol).empty(),
                  lint_text(lint_law(read_text(m.text), m.symbol), m.id));
    PluginRegistry registry({folder});
    CHECK_NOTHROW(registry.load(m.id, m.kind, "", ""));  // compiles it
  }
  CHECK(list_effects({folder}).size() == found.size());
}

TEST_CASE("an effect that is a law text may stand beside the case") {
  const calx_test::Scratch scratch;
  write_generic_plugins(scratch / "case", usual_generic_terms());
  CHECK(list_effects({}).empty());
  CHECK(list_effects({}, scratch / "case").size() == usual_generic_terms().size());
}

}  // namespace calx
