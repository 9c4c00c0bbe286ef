// plugin_state.hpp: hidden state of a plugin instance ("calx.state/1") to a checkpoint and back.
#pragma once
#include <string>

#include "base/state.hpp"
#include "calx/state.h"

namespace calx {

/// Writes the bytes the instance saves as NAME/bytes and their schema as NAME/schema. who: for messages, "motion
/// \"lid\"". Throws Error(Fault::plugin) when the plugin fails. [main]
void save_plugin_state(const calx_state& table, const calx_instance* instance, StateWriter& out,
                       const std::string& name, const std::string& who);

/// Gives the bytes back. Throws Error(Fault::files) when the plugin refuses them. [main]
void load_plugin_state(const calx_state& table, calx_instance* instance, const StateReader& in, const std::string& name,
                       const std::string& who);

}  // namespace calx
