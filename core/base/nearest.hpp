// nearest.hpp: the known name a misspelt one was meant to be, for error messages.
#pragma once
#include <string>
#include <vector>

namespace calx {

/// The member of known closest to key by edit distance (insert, delete, replace, swap of neighbours; case ignored), the
/// first of several equally close; empty when none is near enough to be meant.
std::string nearest_name(const std::string& key, const std::vector<std::string>& known);

/// The last part of a message about an unknown name: `did you mean "young"?`, or `known are "a", "b"` when none is
/// near, or `none is defined` when known is empty.
std::string did_you_mean(const std::string& key, const std::vector<std::string>& known);

/// `"a", "b", "c"`.
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace calx
