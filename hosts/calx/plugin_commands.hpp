// plugin_commands.hpp: calx plugin list, describe, schema, check, doctor, new.
#pragma once

namespace CLI {
class App;
}

namespace calx {

void add_plugin_command(CLI::App& app);

}  // namespace calx
