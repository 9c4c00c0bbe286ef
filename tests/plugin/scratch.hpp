// scratch.hpp: a folder of its own for one test case, and manifests to put there.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::canonical(std::filesystem::temp_directory_path()) / "calx-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::string path_;
};

inline std::string read_text(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

/// Folder and library of a plugin of tests/bad_plugins.
inline std::string bad_folder(const std::string& name) { return std::string(CALX_BAD_PLUGIN_DIR) + "/" + name; }
inline std::string bad_library(const std::string& name) { return bad_folder(name) + "/bad_" + name + ".so"; }

/// A manifest of one particle force; more: further members, each with a leading comma.
inline std::string manifest(const std::string& id, const std::string& library, const std::string& more = "") {
  return "{\"calx_plugin\": 1, \"library\": \"" + library +
         "\", \"abi\": {\"major\": 1, \"minor\": 0}, \"version\": \"1.0.0\", \"vendor\": \"Calx\", "
         "\"license\": \"MIT\", \"plugins\": [{\"id\": \"" +
         id + "\", \"kind\": \"calx.particle-force/1\", \"summary\": \"A plugin for tests.\"}]" + more + "}";
}

/// The message of the Error that call throws, "no error" if none; its fault is checked by the caller's text.
template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "no error";
}
