#include "options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "base/error.hpp"
#include "base/nearest.hpp"

namespace calx {
namespace {

/// Numbers from least on; "a whole number above 0".
CLI::Validator at_least(double least, bool whole, const std::string& right) {
  return CLI::Validator(
      [=](std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool good = end != text.c_str() && *end == '\0' && std::isfinite(value) && value >= least &&
                          (!whole || value == std::floor(value));
        return good ? std::string() : "\"" + text + "\" is not " + right;
      },
      "");
}

}  // namespace

CLI::Validator whole_above_zero() { return at_least(1, true, "a whole number above 0"); }
CLI::Validator whole_number() { return at_least(0, true, "a whole number, 0 or more"); }
CLI::Validator zero_or_more() { return at_least(0, false, "a number, 0 or more"); }

std::pair<std::string, std::string> split_override(const std::string& text, const std::string& example) {
  const auto at = text.find('=');
  if (at == std::string::npos || text[0] != '/')
    throw Error(Fault::usage, "--set " + text + ": expected /json/pointer=value, for instance " + example);
  return {text.substr(0, at), text.substr(at + 1)};
}

std::string usage_text(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const CLI::App* at = &app;
  std::string path;
  int used = 1;
  for (; used < argc; ++used) {
    const auto commands = at->get_subcommands([&](const CLI::App* a) { return a->get_name() == argv[used]; });
    if (commands.empty()) break;
    at = commands.front();
    path += at->get_name() + " ";
  }
  const std::string see = " (see calx " + path + "--help)",
                    here = path.empty() ? path : path.substr(0, path.size() - 1) + ": ";
  std::vector<std::string> commands;
  for (const CLI::App* a : at->get_subcommands([](const CLI::App*) { return true; })) commands.push_back(a->get_name());
  if (!commands.empty() && (used >= argc || argv[used][0] != '-')) {
    if (used >= argc) return "a command is needed: " + quoted_list(commands) + see;
    return "no command \"" + std::string(argv[used]) + "\"; " + did_you_mean(argv[used], commands) + see;
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    std::vector<std::string> options;
    for (const CLI::Option* o : at->get_options()) {
      if (!o->get_lnames().empty()) options.push_back("--" + o->get_lnames().front());
    }
    for (int k = used; k < argc; ++k) {
      const std::string word = std::string(argv[k]).substr(0, std::string(argv[k]).find('='));
      if (word.size() > 1 && word[0] == '-' && !at->get_option_no_throw(word)) {
        const std::string near = nearest_name(word, options);
        return here + "no option " + word + (near.empty() ? "" : "; did you mean " + near + "?") + see;
      }
    }
  }
  return here + error.what() + see;
}

}  // namespace calx
