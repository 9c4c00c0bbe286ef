// path.hpp: the one text value this plugin gets, out of the configuration's JSON.
#ifndef PATH_HPP
#define PATH_HPP
#include <string>

/// Value of the member "file" of a JSON object whose members are all texts; empty when it has none.
std::string file_of(const std::string& json);

#endif
