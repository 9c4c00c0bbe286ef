// bench.hpp: the command that runs timed scenes.
#pragma once
namespace CLI {
class App;
}
namespace calx {
/// `calx bench CASE`: one JSON line or a few lines of text for each run.
void add_bench_command(CLI::App& app);
}  // namespace calx
