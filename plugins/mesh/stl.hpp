// stl.hpp: triangles of an STL file, ASCII or binary, in the file's own unit.
#ifndef STL_HPP
#define STL_HPP
#include <string>
#include <vector>

/// Nine coordinates a triangle. Throws calx::ConfigError naming the file when it cannot be read or is no STL file.
std::vector<double> read_stl(const std::string& path);

#endif
