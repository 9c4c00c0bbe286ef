// The lint of law texts: ours pass; each line of broken.law.h that says so is found, and no other; texts that reach for
// other memory or other functions are found, since text-only plugins rest on it.
#include <doctest/doctest.h>

#include <filesystem>
#include <set>

#include "plugin/law_lint.hpp"
#include "scratch.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

std::string stem_of(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.substr(0, name.find('.'));
}

/// Findings of a law whose body is the line given.
std::string lint_body(const std::string& body, const std::string& before = "") {
  const std::string text =
      "#define evil_pair_LIST(X) X(k, \"N/m\", 0, 1e9, 100, 0, \"stiffness\")\n#define evil_prop_LIST(X)\n"
      "#define evil_state_LIST(X)\n#define evil_NEEDS 1\nCALX_LAW_DECLARE(evil)\n" +
      before + "\nCALX_LAW_EVAL(evil) {\n" + body + "\n}\n";
  return lint_text(lint_law(text, "evil"), "evil");
}

}  // namespace

TEST_CASE("every law text of the tree keeps to the dialect") {
  int texts = 0;
  for (const char* folder : {"plugins", "examples", "abi/template", "tests/bad_plugins"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CALX_SOURCE_DIR) / folder)) {
      const std::string name = entry.path().string();
      if (name.size() < 6 || name.substr(name.size() - 6) != ".law.h") continue;
      // This one leans on a macro of its plugin, on purpose.
      if (name.find("leaning_text") != std::string::npos) continue;
      CAPTURE(name);
      CHECK(lint_text(lint_law(read_text(name), stem_of(entry.path())), name) == "");
      ++texts;
    }
  for (const char* shared : {"sliding", "rolling"})
    CHECK(lint_text(lint_law(read_text(std::string(CALX_SOURCE_DIR "/abi/include/calx/law/") + shared + ".h"), shared),
                    shared) == "");
  CHECK(texts >= 8);
}

TEST_CASE("each broken line of broken.law.h is found, and no other") {
  const std::string text = read_text(CALX_SOURCE_DIR "/tests/plugin/broken.law.h");
  std::set<std::size_t> broken, found;
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = text.find('\n', at);
    if (text.substr(at, end - at).find("BROKEN") != std::string::npos) broken.insert(line);
    at = end + 1;
  }
  for (const LintFinding& finding : lint_law(text, "broken")) found.insert(finding.line);
  CHECK(found == broken);
  CHECK(broken.size() == 11);
}

TEST_CASE("what the dialect has instead of a forbidden word is told") {
  CHECK(lint_body("  if (c->overlap > R(0.0)) out->fx = p->k;").find("if is not in the dialect; write cond ? a : b") !=
        std::string::npos);
  CHECK(lint_body("  out->fx = pow(c->overlap, R(1.5));")
            .find("pow is not in the dialect; write products, and calx_sqrt for halves of powers") !=
        std::string::npos);
}

TEST_CASE("a text cannot reach memory or functions that are not its own") {
  CHECK(lint_body("  out->fx = p->k * c->overlap;") == "");
  CHECK(lint_body("  real c2 = R(1.0);\n  out->fx = c2 + R(1.0);") == "");
  for (const char* body : {
           "  out->fx = (c + 1)->overlap;",
           "  out->fx = *(&p->k + 5);",
           "  out->fx = p[3].k;",
           "  out->fx = CALX_ID(evil_help)(c + 1);",
           "  out->fx = CALX_ID(evil_help)((c) + 1);",
           "  out->fx = CALX_ID(evil_help)(calx_min(c, c) + 1);",
           "  { const real c = R(1.0); out->fx = c; }",
           "  out->fx = system(\"id\");",
           "  out->fx = p <: 3 :> .k;",
           "  asm(\"nop\");",
           "  out->fx = '\"'; /* \" */",
           "  out->fx = R\"x(\"; )x\"; evil();",
           "  /* comment *\\\n/ evil(); */",
       }) {
    CAPTURE(std::string(body));
    CHECK(lint_body(body) != "");
  }
  // Through a macro of its own.
  CHECK(lint_body("  out->fx = CALX_ID(evil_help)(evil_ADD(c));", "#define evil_ADD(x) x + 1") != "");
  CHECK(lint_body("  out->fx = evil_K(p);", "#define evil_K(x) x->k") == "");
  CHECK(lint_body("  out->fx = R(1.0);", "#define evil_C c") != "");
  // A function under a name of its own; one in a row of a list, which a table of the plugin would call.
  CHECK(lint_body("  out->fx = evil_f(\"id\");", "#define evil_f system") != "");
  CHECK(lint_body("  out->fx = R(1.0);", "#define evil_more(X) X(a, \"1\", 0, system(\"id\"), 0, 0, \"b\")") != "");
  CHECK(lint_body("  out->fx = R(1.0);", "#define evil_more(X) X(a, \"1\", 0, 1, 0, CALX_VEC(1), \"b\")") == "");
  CHECK(lint_body("  out->fx = OUTSIDE * p->k;").find("OUTSIDE: a text uses nothing but") != std::string::npos);
  CHECK(lint_body("  out->fx = R(1.0);", "#include <stdio.h>") != "");
  CHECK(lint_body("  out->fx = R(1.0);", "#define evil_paste(a) a##b") != "");
  CHECK(lint_body("  out->fx = R(1.0); /* no end") != "");
  CHECK(lint_body(std::string(70000, ' ')) != "");
}
