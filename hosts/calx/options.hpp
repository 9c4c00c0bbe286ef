// options.hpp: checks of option values that say what would be right, and the message for a word that is not known.
#pragma once
#include <string>
#include <utility>

namespace CLI {
class App;
class ParseError;
class Validator;
}  // namespace CLI

namespace calx {

CLI::Validator whole_above_zero();
CLI::Validator whole_number();  // 0 or more
CLI::Validator zero_or_more();

/// "/time/end=2.0" of --set to pointer and value. example: one for the message. Throws Error(Fault::usage).
std::pair<std::string, std::string> split_override(const std::string& text, const std::string& example);

/// What is wrong with a command line that CLI11 refused, for people.
std::string usage_text(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace calx
