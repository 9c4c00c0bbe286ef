#include "sample_diagnosis.hpp"

#include <filesystem>
#include <fstream>

namespace calx_test {
namespace {

using Json = nlohmann::json;

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

Json observable(const std::string& name, bool held_out) {
  const Json measured = {40.0, 38.0, 36.0, 34.0}, none = Json::array();
  return {{"name", name},
          {"kind", "load-cell"},
          {"case", "fast"},
          {"unit", "g"},
          {"against", "time_s"},
          {"x", {0.5, 1.0, 1.5, 2.0}},
          {"log_x", false},
          {"fit", held_out ? none : measured},
          {"hold", held_out ? measured : none},
          {"sd", {0.5, 0.5, 0.5, 0.5}},
          {"before", {40.0, 39.0, 38.0, 37.0}},
          {"after", {40.0, 38.0, 36.0, 34.5}},
          {"band", {0.6, 0.6, 0.6, 0.6}},
          {"z", 5.2},
          {"p", 0.0025},
          {"signed_error", 1.5},
          {"z_after", 0.3},
          {"p_after", 0.7},
          {"looks_like", "drift"},
          {"conditions", {{"stroke_s", 0.1}}},
          {"seed_scatter", 0.2},
          {"noise_estimated", true},
          {"repeats", 5},
          {"simulated_elsewhere", false}};
}

Json single_value() {
  Json o = observable("residue", false);
  o["against"] = "";
  o["x"] = {0.0}, o["fit"] = {6.0}, o["hold"] = {6.1}, o["sd"] = {0.3}, o["band"] = {0.4};
  o["before"] = {5.2}, o["after"] = {5.3};
  o["z"] = -1.9, o["p"] = 0.08, o["signed_error"] = -0.8, o["z_after"] = -1.8, o["looks_like"] = "";
  return o;
}

Json cause(const std::string& id, const std::string& summary, double probability, double value) {
  return {{"id", id},
          {"amplitude", "gap"},
          {"summary", summary},
          {"probability", probability},
          {"evidence", probability},
          {"named", false},
          {"parameters",
           {{{"name", "gap"},
             {"unit", "m"},
             {"value", value},
             {"low", 0.8 * value},
             {"high", 1.2 * value},
             {"off", 0},
             {"range", {0, 0.008}}}}},
          {"signal_to_noise", 12 * probability},
          {"instrument", false},
          {"rivals", Json::array()}};
}

}  // namespace

Json sample_diagnosis() {
  Json leak = cause("calx.leak", "Powder leaks between rotor and housing.", 0.96, 0.002);
  leak["named"] = true;
  leak["rivals"] = {{{"effect", "calx.worn-pocket"}, {"separate", "turn the rotor slower: a leak grows with time"}}};
  Json j;
  j["calx_diagnosis"] = 1;
  j["title"] = "A valve & its <leak>";
  j["study"] = "study.json";
  j["data_sha256"] = "0123456789abcdef";
  j["calx"] = "0.1.0 abc";
  j["seed"] = 7;
  j["verdict"] = "named";
  j["reason"] = "probable, fits, and predicts the held-out data";
  j["sentence"] = "The data name a cause.";
  j["causes"] = {leak, cause("calx.worn-pocket", "A pocket is worn.", 0.02, 0.001),
                 cause("calx.tilt", "The canister stands at an angle.", 0.001, 0.0001)};
  j["evidence"] = {{"none", 0.003}, {"unknown", 0.015}, {"fit_p", 0.0025}, {"fit_p_with_named", 0.6}};
  j["set"] = {"calx.leak"};
  j["after_holds"] = {"calx.leak"};
  j["observables"] = {observable("hopper, fast", false), observable("hopper, slow", true), single_value()};
  j["events"] = {{{"observable", "hopper, fast"}, {"x", 1.5}, {"z", 6.0}}};
  j["confusability"] = {{"ids", {"calx.leak", "calx.worn-pocket", "calx.tilt"}},
                        {"distance", {{0, 2.5, 7}, {1.5, 0, 4}, {0.1, 0.1, 0}}},
                        {"groups", Json::array({Json::array({"calx.leak", "calx.worn-pocket"})})}};
  j["unknown_terms"] = Json::array();
  j["extension"] = "extension/fast.json";
  j["extensions"] = {{"fast", "extension/fast.json"}};
  j["gain"] = {{"held_out_log_score", 8.0}, {"sd", 2.0}, {"needed", 3.0}, {"held_out", true}, {"split_repeats", false}};
  j["confirmation"] = {{"passed", true},
                       {"seeds", 3},
                       {"held_out_log_score", 7.5},
                       {"error_before", 3.7},
                       {"error_after", 0.6},
                       {"agreement_p", 0.4},
                       {"before", {40, 39, 38, 37, 40, 39, 38, 37, 5.2}},
                       {"after", {40, 38, 36, 35.2, 40, 38, 36, 34.4, 5.3}}};
  j["self_test"] = {
      {"controls", 40},
      {"controls_named", 0},
      {"powers",
       {{{"cause", "calx.leak"}, {"strength", 0.0005}, {"unit", "m"}, {"studies", 40}, {"right", 9}, {"wrong", 0}},
        {{"cause", "calx.leak"}, {"strength", 0.0021}, {"unit", "m"}, {"studies", 40}, {"right", 34}, {"wrong", 1}}}},
      {"calibration", {{"stated", {0.1, 0.5, 0.9}}, {"observed", {0.02, 0.4, 0.95}}}}};
  j["next"] = {{{"name", "flow by angle"}, {"cost", 2}, {"information_nats", 0.5}, {"clear_verdict", 0.8}},
               {{"name", "a longer fill"}, {"cost", 1}, {"information_nats", 0.1}, {"clear_verdict", 0.2}}};
  j["nuisances"] = {{{"name", "friction"},
                     {"unit", "1"},
                     {"prior_mean", 0.5},
                     {"prior_sd", 0.05},
                     {"before", 0.65},
                     {"after", 0.52},
                     {"sd", 0.02},
                     {"strained", true}}};
  j["claims"] = {{{"effect", "calx.interlocking"},
                  {"observable", "residue"},
                  {"says", "interlocking holds it up"},
                  {"verdict", "contradicted"},
                  {"sentence", "the claimed cause can only give more: contradicted by its sign"}}};
  j["untested"] = {{{"effect", "calx.drag"}, {"reason", "the case has no air"}}};
  j["runs"] = {{"budget", 150}, {"planned", 122}, {"used", 80}};
  j["assumptions"] = {"The data are made up."};
  j["notes"] = {"a note of the diagnosis"};
  return j;
}

void write_sample_diagnosis(const std::string& folder, const Json& diagnosis) {
  std::filesystem::create_directories(folder + "/extension");
  write(folder + "/diagnosis.json", diagnosis.dump());
  write(folder + "/extension/fast.json", "{\"title\": \"with <leak>\"}\n");
  write(folder + "/cost.json", R"({"runs": 80, "cached": 3, "failed": 1, "run_seconds": 250, "executor": "local"})");
  write(folder + "/runs.csv",
        "stage,case,effects,wall_s,folder\n\"base\",\"fast\",\"a, "
        "b\",20.783795928,ab12\n\"confirmation\",\"slow\",\"\",3,cd34\n");
}

}  // namespace calx_test
