// compare.hpp: the command calx compare.
#pragma once

namespace CLI {
class App;
}

namespace calx {

void add_compare_command(CLI::App& app);

}  // namespace calx
