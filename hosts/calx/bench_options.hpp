// bench_options.hpp: what the command line asks of a timed scene.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace calx {

struct BenchOptions {
  std::string name = "settled";
  long long particles = 0;  // 0: what the case is defined with
  int threads = 1, steps = 400, warm_up = 100;
  double at = 0;                  // s, simulated untimed before the warm-up
  double rolling = 0;             // rolling friction; 0: none
  double settle = -1;             // s of settling before a start is used; below 0: what the case needs
  std::string start;              // a folder of --save-start, or a CSV with the settled tile or bed; empty: make one
  std::string save;               // CSV, gets the settled tile or bed
  std::string save_start;         // folder, gets the whole start
  std::string law = "calx.epam";  // clumps
  std::string base = "bumps";     // chute
  std::string case_path;          // fill
  std::string precision = "double", device = "cpu";
  std::vector<std::string> plugin_path;
  std::vector<std::pair<std::string, std::string>> overrides;  // JSON pointer and value
  bool json = false;
};

}  // namespace calx
