#include "study/formula.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>

#include "base/nearest.hpp"

namespace calx {
namespace {

struct Function {
  std::size_t arguments;
  const char* before;  // its name in the dialect, with what stands before the first argument
  const char* after;
};

const std::map<std::string, Function>& functions() {
  // The root of a negative number is none: a formula gives 0 there.
  static const std::map<std::string, Function> all = {{"sqrt", {1, "calx_sqrt(calx_max(", ", R(0.0)))"}},
                                                      {"abs", {1, "calx_abs(", ")"}},
                                                      {"min", {2, "calx_min(", ")"}},
                                                      {"max", {2, "calx_max(", ")"}}};
  return all;
}

/// Recursive descent; every method reads one thing and gives its text in the dialect.
class Translator {
 public:
  Translator(const Node& node, const std::vector<std::string>& variables)
      : node_(node), text_(node.text("a formula such as \"speed / (speed + 0.1)\"")), variables_(variables) {}

  std::string all() {
    const std::string out = sum();
    if (peek() != '\0')
      refuse(std::string("\"") + peek() + "\" is not expected; an operator or the end would be right");
    return out;
  }

 private:
  static constexpr int deepest = 60;

  [[noreturn]] void refuse(const std::string& what) const {
    constexpr std::size_t shown = 80;
    node_.fail("\"" + (text_.size() > shown ? text_.substr(0, shown) + "..." : text_) + "\" at character " +
               std::to_string(at_ + 1) + ": " + what);
  }
  char peek() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  void take(char wanted) {
    if (peek() != wanted) refuse(std::string("\"") + wanted + "\" is missing");
    ++at_;
  }

  void deeper() {
    if (++depth_ > deepest) refuse("too many parentheses or signs in each other; at most " + std::to_string(deepest));
  }

  std::string sum() {
    deeper();
    std::string out = product();
    while (peek() == '+' || peek() == '-') {
      const char sign = text_[at_++];
      out += std::string(" ") + sign + " " + product();
    }
    --depth_;
    return out;
  }

  std::string product() {
    std::string out = factor();
    while (peek() == '*' || peek() == '/') {
      const char sign = text_[at_++];
      out += std::string(" ") + sign + " " + factor();
    }
    return out;
  }

  std::string factor() {
    const char c = peek();
    if (c == '-') {
      ++at_;
      deeper();
      const std::string inner = factor();
      --depth_;
      return "(R(0.0) - " + inner + ")";
    }
    if (c == '(') {
      ++at_;
      const std::string inner = sum();
      take(')');
      return "(" + inner + ")";
    }
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c))) return word();
    refuse(c == '\0' ? "ends too early; a number, a variable or \"(\" is missing"
                     : std::string("\"") + c + "\" is not known; a number, a variable or \"(\" would be right");
  }

  std::string number() {
    const std::size_t start = at_;
    const auto digits = [&] {
      const std::size_t first = at_;
      while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) ++at_;
      return at_ - first;
    };
    std::size_t count = digits();
    std::string fraction = ".0";
    const std::string whole = count > 0 ? text_.substr(start, count) : "0";
    if (at_ < text_.size() && text_[at_] == '.') {
      const std::size_t point = at_++;
      const std::size_t more = digits();
      count += more;
      if (more > 0) fraction = text_.substr(point, more + 1);
    }
    if (count == 0) refuse("a number has digits");
    std::string exponent;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      const std::size_t from = at_++;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      if (digits() == 0) refuse("the exponent of a number has digits");
      exponent = text_.substr(from, at_ - from);
    }
    if (!std::isfinite(std::strtod(text_.substr(start, at_ - start).c_str(), nullptr)))
      refuse("a number is below 1e308");
    return "R(" + whole + fraction + exponent + ")";
  }

  std::string word() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    const std::string name = text_.substr(start, at_ - start);
    const auto function = functions().find(name);
    if (function != functions().end()) {
      std::string out = function->second.before;
      take('(');
      for (std::size_t k = 0; k < function->second.arguments; ++k) {
        if (k > 0) take(','), out += ", ";
        out += sum();
      }
      take(')');
      return out + function->second.after;
    }
    for (const std::string& v : variables_)
      if (v == name) return name;
    at_ = start;
    std::vector<std::string> known = variables_;
    for (const auto& f : functions()) known.push_back(f.first);
    refuse("\"" + name + "\" is not known here; " + did_you_mean(name, known));
  }

  const Node& node_;
  const std::string text_;
  const std::vector<std::string>& variables_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::string dialect_formula(const Node& node, const std::vector<std::string>& variables) {
  return Translator(node, variables).all();
}

}  // namespace calx
