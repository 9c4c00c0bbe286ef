// host_compiler.hpp: the machine's C++ compiler, which makes kernel texts into shared libraries at run time.
#pragma once
#include <string>

#include "compute/device_cache.hpp"

namespace calx {

struct HostCompiler {
  std::vector<std::string> command;  // $CALX_CXX, which may hold options, else c++
  std::string version;               // first line of --version; empty where it does not start
};

HostCompiler find_host_compiler();

/// image is empty where the text does not compile; log holds why.
CompiledModule compile_on_host(const HostCompiler& compiler, const std::string& text, bool fast);

/// A library from its bytes. Throws Error(Fault::files) where the folder for temporary files cannot be written or no
/// library may be opened there.
void* open_image(const std::string& image);

}  // namespace calx
