#include "plugin/law_lint.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace calx {
namespace {

const std::set<std::string>& forbidden() {
  static const std::set<std::string> words = {
      "if",     "else",   "while",    "for",      "do",   "switch",   "case",   "goto", "return", "break",  "continue",
      "static", "extern", "volatile", "register", "auto", "union",    "enum",   "asm",  "sizeof", "inline", "float",
      "double", "long",   "short",    "char",     "int",  "unsigned", "signed", "bool", "size_t", "pow",    "sqrt",
      "sqrtf",  "fabs",   "fabsf",    "fmin",     "fmax", "exp",      "log",    "sin",  "cos",    "tan"};
  return words;
}

/// What to write in the place of a forbidden word, "; write ..."; empty where nothing does the same.
std::string instead_of(const std::string& word) {
  static const std::map<std::string, std::string> other = {
      {"if", "cond ? a : b"},     {"else", "cond ? a : b"},
      {"switch", "cond ? a : b"}, {"pow", "products, and calx_sqrt for halves of powers"},
      {"sqrt", "calx_sqrt"},      {"sqrtf", "calx_sqrt"},
      {"fabs", "calx_abs"},       {"fabsf", "calx_abs"},
      {"fmin", "calx_min"},       {"fmax", "calx_max"},
      {"float", "real"},          {"double", "real"}};
  const auto found = other.find(word);
  return found == other.end() ? "" : "; write " + found->second;
}

struct Token {
  std::string text;
  std::size_t line;
  bool starts_line;   // first of its line
  bool in_directive;  // of a line that begins with #, and of those it continues on
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Comments and strings as blanks, so that lines and columns hold; a continued line stays two lines.
std::string blanked(const std::string& text) {
  std::string out = text;
  for (std::size_t at = 0; at < out.size(); ++at) {
    std::size_t end = at;
    if (out.compare(at, 2, "/*") == 0) {
      end = out.find("*/", at + 2);
      end = end == std::string::npos ? out.size() : end + 2;
    } else if (out[at] == '"') {
      end = at + 1;
      while (end < out.size() && out[end] != '"' && out[end] != '\n') end += out[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, out.size());
    }
    for (; at < end; ++at)
      if (out[at] != '\n') out[at] = ' ';
    if (end > at) --at;
  }
  return out;
}

/// Words, numbers, and operators of one or two characters; backslashes at the end of a line are left out.
std::vector<Token> tokens_of(const std::string& code) {
  static const std::set<std::string> two = {
      "->", "++", "--", "==", "!=", "<=", ">=", "&&", "||", "##", "//", "<:", ":>",
      "<%", "%>", "%:", "??", "+=", "-=", "*=", "/=", "<<", ">>", "&=", "|=", "^="};
  std::vector<Token> out;
  std::size_t line = 1;
  bool starts = true, directive = false, continued = false;
  for (std::size_t at = 0; at < code.size();) {
    const char c = code[at];
    if (c == '\n') {
      ++line;
      starts = true;
      directive = directive && continued;
      ++at;
      continue;
    }
    if (std::isspace(static_cast<unsigned char>(c)) || c == '\\') {
      continued = continued || c == '\\';
      ++at;
      continue;
    }
    continued = false;
    directive = directive || (starts && c == '#');
    std::size_t end = at + 1;
    const bool number = std::isdigit(static_cast<unsigned char>(c)) ||
                        (c == '.' && end < code.size() && std::isdigit(static_cast<unsigned char>(code[end])));
    if (number) {
      while (end < code.size() && (is_word(code[end]) || code[end] == '.' ||
                                   ((code[end] == '+' || code[end] == '-') && std::tolower(code[end - 1]) == 'e')))
        ++end;
    } else if (is_word(c)) {
      while (end < code.size() && is_word(code[end])) ++end;
    } else if (two.count(code.substr(at, 2))) {
      end = at + 2;
    }
    out.push_back({code.substr(at, end - at), line, starts, directive});
    starts = false;
    at = end;
  }
  return out;
}

bool begins_with(const std::string& word, const std::string& start) {
  return word.compare(0, start.size(), start) == 0;
}

class Lint {
 public:
  Lint(const std::string& text, const std::string& stem)
      : text_(text), stem_(stem), tokens_(tokens_of(blanked(text))) {}

  std::vector<LintFinding> run() {
    check_bytes();
    check_quotes();
    collect();
    for (std::size_t k = 0; k < tokens_.size(); ++k) {
      follow(k);
      check_token(k);
    }
    check_symbols();
    std::vector<LintFinding> out;
    for (const auto& one : found_) out.push_back({one.first, one.second});
    return out;
  }

 private:
  void report(std::size_t line, const std::string& what) { found_.emplace(line, what); }
  const std::string& at(std::size_t k) const {
    static const std::string none;
    return k < tokens_.size() ? tokens_[k].text : none;  // 0 - 1 is out of range, too
  }
  bool is_name(std::size_t k) const {
    const std::string& t = at(k);
    return !t.empty() && is_word(t[0]) && !std::isdigit(static_cast<unsigned char>(t[0]));
  }
  /// "name" or "CALX_ID(name)" at k.
  std::string defined_name(std::size_t k) const { return at(k) == "CALX_ID" ? at(k + 2) : at(k); }

  /// What could make the compiler see a comment or a string end elsewhere than this lint does.
  void check_quotes() {
    std::size_t line = 1;
    bool comment = false, string = false;
    for (std::size_t k = 0; k < text_.size(); ++k) {
      const char c = text_[k];
      const char next = k + 1 < text_.size() ? text_[k + 1] : '\0';
      if (c == '\n') {
        ++line;
        string = false;
      } else if (comment) {
        comment = !(c == '*' && next == '/');
        if (!comment) ++k;
        if (c == '\\' && next == '\n') report(line, "no line of a comment ends in a backslash");
      } else if (string) {
        string = c != '"';
        if (c == '\\') report(line, "no backslash in a string");
      } else if (c == '"') {
        if (k > 0 && is_word(text_[k - 1])) report(line, "no letter before a string");
        string = true;
      } else if (c == '/' && next == '*') {
        comment = true;
        ++k;
      } else if (c == '\'') {
        report(line, "no single quote outside of comments");
      } else if (c == '/' && next == '\\') {
        report(line, "no backslash behind a slash");
      }
    }
    if (comment) report(line, "a comment does not end");
  }

  void check_bytes() {
    if (text_.size() > kLawTextLimit)
      report(1, std::to_string(text_.size()) + " bytes; a law text has at most " + std::to_string(kLawTextLimit));
    std::size_t line = 1;
    for (const char c : text_) {
      if (c == '\n')
        ++line;
      else if ((c < 32 && c != '\t') || c > 126)
        report(line, "not ASCII");
    }
  }

  /// Symbols, and macros and functions that the text defines.
  void collect() {
    value_macros_ = {"R", "calx_sqrt", "calx_abs", "calx_min", "calx_max"};
    known_ = {"real", "R", "X", "const", "typedef", "struct", "void", "define", "c", "p", "pi", "pj", "s", "b", "out"};
    for (std::size_t k = 0; k < tokens_.size(); ++k) {
      learn(k);
      if (begins_with(at(k), "CALX_LAW_DECLARE")) symbols_.emplace_back(at(k + 2), tokens_[k].line);
      if (at(k) == "CALX_FORCE_DECLARE") {
        symbols_.emplace_back(at(k + 2), tokens_[k].line);
        forces_.insert(at(k + 2));
      }
      if (at(k) == "CALX_LAW_EVAL" || at(k) == "CALX_FORCE_EVAL") ++evals_;
      if (at(k) == "define") {
        defines_.insert(at(k + 1));
        if (takes_values(k)) value_macros_.insert(at(k + 1));
      }
    }
    // Texts that several laws share have no law of their own.
    stems_ = symbols_.empty() ? std::vector<std::string>{"calx_", "CALX_"} : std::vector<std::string>{stem_};
  }

  /// Names that the text makes known at k: "real a, b", "CALX_ID(type) a", "* a", parameters of macros, rows of lists.
  void learn(std::size_t k) {
    if (at(k) == "define" && at(k + 2) == "(")
      for (std::size_t m = k + 3; m < tokens_.size() && at(m) != ")"; ++m) known_.insert(at(m));
    if (at(k) == "X" && at(k + 1) == "(") known_.insert(at(k + 2));
    const bool pointer = at(k) == "*" && (at(k - 1) == "real" || (at(k - 1) == ")" && at(k - 4) == "CALX_ID"));
    const bool typed = at(k) == "real" || pointer || (at(k) == ")" && at(k - 3) == "CALX_ID");
    if (!typed || !is_name(k + 1)) return;
    std::size_t m = k + 1;
    const std::string& end = at(m + 1);
    if (end != "," && end != ";" && end != "=" && end != ")") return;
    known_.insert(at(m));
    for (; at(m + 1) == "," && is_name(m + 2) && (at(m + 3) == "," || at(m + 3) == ";"); m += 2)
      known_.insert(at(m + 2));
  }

  /// The macro at k, "define NAME(a, b) ...", uses a parameter otherwise than as a->member.
  bool takes_values(std::size_t k) const {
    if (at(k + 2) != "(") return false;
    std::set<std::string> parameters;
    std::size_t m = k + 3;
    for (; m < tokens_.size() && at(m) != ")"; ++m)
      if (is_name(m)) parameters.insert(at(m));
    for (++m; m < tokens_.size() && tokens_[m].in_directive && at(m) != "#"; ++m)
      if (parameters.count(at(m)) && at(m + 1) != "->" && at(m) != "X") return true;
    return false;
  }

  /// Follows where the text is: pointers are those of the function at hand; a real of the same name hides one.
  void follow(std::size_t k) {
    const std::string& t = at(k);
    if (tokens_[k].in_directive) {
      if (t == "define") pointers_ = {"c", "p", "pi", "pj", "s", "b", "out"};
      return;
    }
    if (k > 0 && tokens_[k - 1].in_directive) pointers_.clear();
    if (t == "CALX_LAW_EVAL") pointers_ = {"c", "p", "pi", "pj", "s", "out"};
    if (t == "CALX_FORCE_EVAL") pointers_ = {"b", "p", "out"};
    if (t == "CALX_FN") pointers_.clear();
    if (depth_ == 0 && t == "*" && is_name(k + 1)) pointers_.insert(at(k + 1));
    const std::string& before = at(k - 1);
    if (depth_ > 0 && pointers_.count(t) && (before == "real" || (before == ")" && at(k - 4) == "CALX_ID")))
      if (at(k + 1) == "=" || at(k + 1) == ";") pointers_.erase(t);
    if (t == "{" && ++depth_ > 1) report(tokens_[k].line, "no block inside of a body");
    if (t == "}" && depth_ > 0) --depth_;
  }

  void check_defined(std::size_t line, const std::string& name) {
    for (const std::string& stem : stems_)
      if (begins_with(name, stem)) return;
    report(line, name + ": a name the law defines begins with " + stems_[0]);
  }

  /// A list row, "X(name, unit, lowest, highest, preset, flags, doc)": its numbers are plain.
  bool in_list_row(std::size_t k) {
    if (k >= row_end_ && at(k) == "X" && at(k + 1) == "(") {
      int depth = 0;
      row_end_ = k + 1;
      do {
        depth += at(row_end_) == "(" ? 1 : at(row_end_) == ")" ? -1 : 0;
        ++row_end_;
      } while (depth > 0 && row_end_ < tokens_.size());
    }
    return k < row_end_;
  }

  void check_token(std::size_t k) {
    const Token& token = tokens_[k];
    const std::string& t = token.text;
    if (token.starts_line && t == "#" && at(k + 1) != "define") report(token.line, "only #define is allowed");
    if ((t == "#" && !token.starts_line) || t == "##") report(token.line, "no # and ## in a macro");
    if (t == "define") check_defined(token.line, at(k + 1));
    if (t == "CALX_FN") {
      check_defined(token.line, defined_name(k + 2));
      if (at(k + 1) != "real" && at(k + 1) != "void") report(token.line, "a function gives real or void");
    }
    if (t == "typedef" && at(k + 1) == "struct") check_defined(token.line, defined_name(k + 2));
    if (forbidden().count(t)) report(token.line, t + " is not in the dialect" + instead_of(t));
    if (t.find("__") != std::string::npos) report(token.line, t + ": two underscores belong to the compiler");
    if (t == "//") report(token.line, "comments are /* */");
    if (t == "[" || t == "]" || t == "<:" || t == ":>" || t == "<%" || t == "%>" || t == "%:" || t == "??")
      report(token.line, "no array and no index");
    if (t == "++" || t == "--") report(token.line, "no ++ and no --");
    if (t == "(" && (at(k + 1) == "real" || at(k + 1) == "void") && (at(k + 2) == ")" || at(k + 3) == ")"))
      report(token.line, "no cast");
    if (t == "(" && at(k + 1) == "const" && at(k + 2) == "real" && (at(k + 3) == ")" || at(k + 4) == ")"))
      report(token.line, "no cast");
    check_name(k);
    if (in_list_row(k)) return;
    const bool number = std::isdigit(static_cast<unsigned char>(t[0])) || (t[0] == '.' && t.size() > 1);
    if (number && t.find_first_of(".eE") != std::string::npos && begins_with(t, "0x") == false &&
        !(at(k - 1) == "(" && at(k - 2) == "R") && !(at(k - 1) == "-" && at(k - 2) == "(" && at(k - 3) == "R"))
      report(token.line, "bare literal " + t + ": write R(" + t + ")");
    check_reach(k);
  }

  /// What a text can touch: the pointers it is given, through "->" or handed on, and functions of its own.
  void check_reach(std::size_t k) {
    const Token& token = tokens_[k];
    const std::string &t = token.text, &before = at(k - 1), &after = at(k + 1);
    if (t == "->" && !is_name(k - 1)) report(token.line, "only a name stands before ->");
    if (t == "&") {
      const bool handed_on =
          (before == "," || before == "(") && is_name(k + 1) && (at(k + 2) == "," || at(k + 2) == ")");
      if (!handed_on || (before == "(" && !opens_call(k - 1)) || in_value_macro(k - 1))
        report(token.line, "& only hands a variable to a function, as in f(&spring)");
    }
    const bool member = before == "." || before == "->";
    if (pointers_.count(t) && !member && after != "->") {
      const bool declared = depth_ == 0 && before == "*";
      const bool handed_on = (before == "," || (before == "(" && opens_call(k - 1))) &&
                             (after == "," || after == ")") && !in_value_macro(k - 1);
      // "*root = ...;" gives a value back.
      const bool given = before == "*" && after == "=" && (at(k - 2) == ";" || at(k - 2) == "{");
      if (!declared && !given && !handed_on && !(tokens_[k].in_directive && is_parameter(k)))
        report(token.line, t + ": a pointer is followed by -> or handed to a function");
    }
  }

  /// Nothing from outside of the text is used, neither a function nor a macro nor a variable.
  void check_name(std::size_t k) {
    const std::string& t = at(k);
    if (!is_name(k) || at(k - 1) == "." || at(k - 1) == "->" || forbidden().count(t)) return;
    const bool own = begins_with(t, "calx_") || begins_with(t, "CALX_") ||
                     std::any_of(stems_.begin(), stems_.end(), [&](const std::string& s) { return begins_with(t, s); });
    if (own || (t == "R" || t == "X")) return;
    if (at(k + 1) == "(" && known_.count(t) == 0)
      report(tokens_[k].line, t + " is no function of the text; calx_sqrt, calx_abs, calx_min and calx_max are there");
    else if (known_.count(t) == 0 && !(tokens_[k].in_directive && at(k - 1) == "define"))
      report(tokens_[k].line, t + ": a text uses nothing but what it is given and what it defines");
  }

  /// k lies in the list of arguments of the macro that its line defines.
  bool is_parameter(std::size_t k) const {
    std::size_t m = k;
    while (m > 0 && at(m) != ")" && at(m) != "define") --m;
    return at(m) == "define" && at(m + 2) == "(";
  }

  /// The "(" at k belongs to a call, f( or CALX_ID(f)(, that may be given a pointer.
  bool opens_call(std::size_t k) const {
    if (at(k - 1) == ")") return at(k - 4) == "CALX_ID";
    return is_name(k - 1) && !value_macros_.count(at(k - 1));
  }
  bool in_value_macro(std::size_t k) const {
    int depth = 0;
    for (std::size_t m = k; m > 0 && at(m) != ";" && at(m) != "{"; --m) {
      depth += at(m) == ")" ? 1 : at(m) == "(" ? -1 : 0;
      if (depth < 0) return value_macros_.count(at(m - 1)) > 0;
    }
    return false;
  }

  void check_symbols() {
    for (const auto& symbol : symbols_) {
      if (!begins_with(symbol.first, stem_))
        report(1, symbol.first + ": a symbol begins with the file's stem, " + stem_);
      const std::vector<std::string> parts =
          forces_.count(symbol.first) ? std::vector<std::string>{"row_LIST"}
                                      : std::vector<std::string>{"pair_LIST", "prop_LIST", "state_LIST", "NEEDS"};
      for (const std::string& part : parts)
        if (!defines_.count(symbol.first + "_" + part)) report(1, symbol.first + "_" + part + " is not defined");
    }
    if (!symbols_.empty() && evals_ != symbols_.size())
      report(1, "each declared symbol needs one CALX_LAW_EVAL or CALX_FORCE_EVAL");
  }

  const std::string& text_;
  std::string stem_;
  std::vector<Token> tokens_;
  std::set<std::string> pointers_, defines_, forces_, value_macros_, known_;
  int depth_ = 0;
  std::vector<std::pair<std::string, std::size_t>> symbols_;
  std::vector<std::string> stems_;
  std::size_t evals_ = 0, row_end_ = 0;
  std::set<std::pair<std::size_t, std::string>> found_;
};

}  // namespace

std::vector<LintFinding> lint_law(const std::string& text, const std::string& stem) { return Lint(text, stem).run(); }

std::string lint_text(const std::vector<LintFinding>& findings, const std::string& file) {
  std::string out;
  for (std::size_t k = 0; k < findings.size() && k < 3; ++k)
    out += (k ? "; " : "") + file + ":" + std::to_string(findings[k].line) + ": " + findings[k].what;
  if (findings.size() > 3) out += "; and " + std::to_string(findings.size() - 3) + " more";
  return out;
}

}  // namespace calx
