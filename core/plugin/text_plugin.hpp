// text_plugin.hpp: a plugin that is a law text and a manifest, without native code: the text is linted, put between the
// headers of the ABI and a generated entry, and compiled by the machine's C++ compiler. Private to core/plugin.
// The lists of the text are its tables: the pair row of a law is what users give, the row of a force its parameters.
#pragma once
#include <string>

#include "plugin/plugin.hpp"

namespace calx {

/// text: the bytes of manifest.text. Compiled once per process and content; the entry lives to the end of the process.
/// Throws Refused: breaks the dialect (with file and line), does not compile (with the compiler's words), no compiler.
const calx_entry& compile_text_plugin(const PluginManifest& manifest, const std::string& text);

}  // namespace calx
