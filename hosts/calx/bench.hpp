// bench.hpp: timed scenes.
#pragma once
namespace CLI {
class App;
}
namespace calx {
/// `calx bench settled|pour`: cases B1 and B2 (spheres of 2.5 mm, Hertz-Mindlin with history, FP64).
void add_bench_command(CLI::App& app);
}  // namespace calx
