#include "compute/host_compiler.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/error.hpp"

namespace calx {
namespace {

/// A folder for one compilation, removed with all it holds.
class Scratch {
 public:
  Scratch() {
    const char* base = std::getenv("TMPDIR");
    path_ = std::string(base && *base ? base : "/tmp") + "/calx-XXXXXX";
    if (!mkdtemp(&path_[0]))
      throw Error(Fault::files,
                  "no folder for temporary files can be made as " + path_ + "; TMPDIR names another place");
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Exit status of the command, 127 where it does not start; what it prints goes to the file.
int run(const std::vector<std::string>& command, const std::string& output) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const pid_t child = fork();
  if (child == 0) {
    // Only calls that are safe between fork and exec of a program with threads.
    dup2(file, 1);
    dup2(file, 2);
    execvp(words[0], words.data());
    _exit(127);
  }
  if (file >= 0) close(file);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

HostCompiler find_host_compiler() {
  HostCompiler compiler;
  const char* own = std::getenv("CALX_CXX");
  std::istringstream words(own && *own ? own : "c++");
  for (std::string word; words >> word;) compiler.command.push_back(word);
  const Scratch scratch;
  std::vector<std::string> ask = compiler.command;
  ask.push_back("--version");
  if (run(ask, scratch.file("version")) == 0) {
    std::istringstream lines(content(scratch.file("version")));
    std::getline(lines, compiler.version);
  }
  return compiler;
}

CompiledModule compile_on_host(const HostCompiler& compiler, const std::string& text, bool fast) {
  const Scratch scratch;
  const std::string source = scratch.file("module.cpp"), library = scratch.file("module.so");
  std::ofstream(source, std::ios::binary) << text;
  std::vector<std::string> command = {compiler.command.front(),
                                      "-std=c++17",
                                      "-O2",
                                      "-fno-math-errno",
                                      "-fno-trapping-math",
                                      fast ? "-ffp-contract=fast" : "-ffp-contract=off",
                                      "-w",
                                      "-shared",
                                      "-fPIC"};
  command.insert(command.end(), compiler.command.begin() + 1, compiler.command.end());
  command.insert(command.end(), {"-o", library, source});
  CompiledModule module;
  if (run(command, scratch.file("log")) == 0) module.image = content(library);
  module.log = content(scratch.file("log"));
  return module;
}

void* open_image(const std::string& image) {
  const Scratch scratch;
  const std::string path = scratch.file("module.so");
  std::ofstream(path, std::ios::binary) << image;
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle)
    throw Error(Fault::files, "a compiled module cannot be opened: " + std::string(dlerror()) +
                                  "; TMPDIR names another folder for temporary files");
  return handle;
}

}  // namespace calx
