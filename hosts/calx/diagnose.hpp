// diagnose.hpp: the command that shows what a simulation gets wrong, and why.
#pragma once
#include <atomic>

namespace CLI {
class App;
}
namespace calx {
/// `calx diagnose STUDY.json`. json: set when the user asks for JSON lines. stop: set by the handlers that
/// catch_signals installs.
void add_diagnose_command(CLI::App& app, bool& json, const std::atomic<bool>& stop, void (*catch_signals)());
}  // namespace calx
