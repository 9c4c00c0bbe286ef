// calibrate.hpp: the command that fits parameters to measured data.
#pragma once
#include <atomic>

namespace CLI {
class App;
}
namespace calx {
/// `calx calibrate STUDY.json`. json: set when the user asks for JSON lines. stop: set by the handlers that
/// catch_signals installs.
void add_calibrate_command(CLI::App& app, bool& json, const std::atomic<bool>& stop, void (*catch_signals)());
}  // namespace calx
