// law.hpp: the command calx law, a virtual contact bench.
#pragma once

namespace CLI {
class App;
}

namespace calx {

void add_law_command(CLI::App& app);

}  // namespace calx
