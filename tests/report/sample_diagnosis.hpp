// sample_diagnosis.hpp: a made-up result of calx diagnose, as its files stand in a folder. A rotor that leaks: the
// simulation gives 1.5 g too much in the hopper; two seen curves, one of them held out, one single value.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace calx_test {

/// diagnosis.json with the verdict "named".
nlohmann::json sample_diagnosis();

/// Writes diagnosis.json as given, cost.json, runs.csv and extension/fast.json into the folder.
void write_sample_diagnosis(const std::string& folder, const nlohmann::json& diagnosis);

}  // namespace calx_test
