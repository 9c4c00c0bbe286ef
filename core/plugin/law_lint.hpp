// law_lint.hpp: does a law text keep to dialect 1? Also what makes a text from a stranger safe to compile and run: no
// name from outside of the text, no pointer but those handed in, no index, so that it can reach no other memory.
#pragma once
#include <string>
#include <vector>

namespace calx {

struct LintFinding {
  std::size_t line = 0;  // from 1
  std::string what;
};

/// text: of NAME.law.h; stem: NAME, with which every name the text defines must begin. Sorted by line, each once.
std::vector<LintFinding> lint_law(const std::string& text, const std::string& stem);

/// "spring.law.h:12: if is not in the dialect; ..."; at most three, with the number of the others.
std::string lint_text(const std::vector<LintFinding>& findings, const std::string& file);

/// A law text has at most so many bytes.
constexpr std::size_t kLawTextLimit = 65536;

}  // namespace calx
