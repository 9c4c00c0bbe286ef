// scratch.hpp: a folder of its own for each test, gone afterwards; and texts of expected errors.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/error.hpp"

namespace calx_test {

struct Scratch {
  std::string path;
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "calx_io_XXXXXX").string();
    if (mkdtemp(&pattern[0]) == nullptr) throw std::runtime_error("no scratch folder");
    path = pattern;
  }
  ~Scratch() {
    std::error_code code;
    std::filesystem::remove_all(path, code);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string operator/(const std::string& name) const { return path + "/" + name; }
  /// Names in the folder, or in one below it, in no order.
  std::size_t file_count(const std::string& below = "") const {
    std::size_t n = 0;
    for (const auto& f : std::filesystem::directory_iterator(path + "/" + below)) n += f.is_regular_file() ? 1 : 0;
    return n;
  }
};

/// The message of the Error(Fault::files) that action throws; empty when it throws none.
template <class Action>
std::string file_error(Action action) {
  try {
    action();
  } catch (const calx::Error& error) {
    return error.fault() == calx::Fault::files ? error.what() : "";
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace calx_test
