// formula.hpp: a formula as a person writes it, "speed / (speed + 0.1)", put into the dialect of law texts. Private to
// study/.
#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"

namespace calx {

/// Numbers, the variables given, + - * / and parentheses, sqrt(a) abs(a) min(a, b) max(a, b). node: the text, for
/// messages. Throws Error(Fault::settings) with the place in the formula and what would be right. The result is an
/// expression of the dialect in which each variable stands under its own name.
std::string dialect_formula(const Node& node, const std::vector<std::string>& variables);

}  // namespace calx
