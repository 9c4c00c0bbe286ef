// resolve.hpp: from a request to the case it means, and to the key of its cache. Private to study/.
#pragma once
#include "config/config.hpp"
#include "study/executor.hpp"

namespace calx {

/// The case with patches, overrides and seed applied, its effects looked up in plugin_path and where calx looks itself.
/// Throws what read_case throws.
CaseFile resolve(const RunRequest& request, const std::vector<std::string>& plugin_path);

/// SHA-256 of all that the result of a run depends on: the resolved case, files it names, seed, version of calx, and
/// the libraries of the plugins it names. Where the case stands plays no part.
std::string cache_key(const CaseFile& file, const std::vector<std::string>& plugin_path);

}  // namespace calx
