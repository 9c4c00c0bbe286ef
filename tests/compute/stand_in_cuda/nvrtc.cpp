// nvrtc.cpp: a stand-in for NVRTC. It compiles CUDA text with the machine's C++ compiler into a shared library, which
// plays the cubin: the stand-in driver opens it. Options that NVRTC would refuse are refused.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace {

struct Program {
  std::string text, log, image;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool known(const std::string& option) {
  static const std::set<std::string> all = {"--std=c++17",         "--fmad=true",       "--fmad=false",
                                            "--prec-div=true",     "--prec-sqrt=true",  "--ftz=false",
                                            "--diag-suppress=177", "--ptxas-options=-v"};
  return all.count(option) || std::regex_match(option, std::regex("--gpu-architecture=sm_[0-9]{2,3}"));
}

int compile(Program& program, const std::string& flags, const std::string& architecture) {
  char folder[] = "/tmp/calx-nvrtc-XXXXXX";
  if (!mkdtemp(folder)) return 1;
  const std::string base = folder, c = "c++ -std=c++17 -w ";
  std::ofstream(base + "/a.cpp") << program.text;
  int code =
      std::system((c + "-E -include " CALX_SHIM " -o " + base + "/b.ii " + base + "/a.cpp 2>" + base + "/log").c_str());
  if (code == 0) {
    std::string text = content(base + "/b.ii");
    // The preprocessor may put a line marker before a name that it has put together.
    const std::regex mark("calx_stand_in_global\\s+void\\s+(?:#[^\n]*\\s+)*(\\w+)");
    std::string entries;
    for (std::sregex_iterator k(text.begin(), text.end(), mark), end; k != end; ++k) {
      const std::string name = (*k)[1];
      entries += "extern \"C\" __attribute__((visibility(\"default\"))) void calx_run_" + name +
                 "(unsigned g, unsigned b, void** a) { calx_run<&" + name + ">(&" + name +
                 ", g, b, a); }\nextern \"C\" __attribute__((visibility(\"default\"))) const size_t* calx_sizes_" +
                 name + "() { return calx_sizes(&" + name + "); }\n";
      program.log += "ptxas info    : Compiling entry function '" + name + "' for '" + architecture +
                     "'\nptxas info    : Function properties for " + name +
                     "\nptxas         .     0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n"
                     "ptxas info    : Used 32 registers, used 0 barriers\n";
    }
    text = std::regex_replace(text, std::regex("calx_stand_in_global"), "");
    std::ofstream(base + "/c.ii") << text << "\n" << entries;
    code = std::system((c + flags + " -O1 -fno-math-errno -fno-trapping-math -fvisibility=hidden -shared -fPIC -o " +
                        base + "/c.so " + base + "/c.ii 2>" + base + "/log")
                           .c_str());
  }
  if (code == 0)
    program.image = content(base + "/c.so");
  else
    program.log = content(base + "/log");
  std::system(("rm -r " + base).c_str());
  return code == 0 ? 0 : 6;
}

}  // namespace

extern "C" {
int nvrtcVersion(int* major, int* minor) {
  // Modules that were compiled with another shim are not taken from a cache.
  *major = 0;
  *minor = static_cast<int>(std::hash<std::string>()(content(CALX_SHIM)) % 1000000);
  return 0;
}
int nvrtcCreateProgram(Program** program, const char* text, const char*, int, const char* const*, const char* const*) {
  *program = new Program{text, "", ""};
  return 0;
}
int nvrtcCompileProgram(Program* program, int count, const char* const* options) {
  std::string flags = "-ffp-contract=fast", architecture;
  for (int k = 0; k < count; ++k) {
    const std::string option = options[k];
    if (!known(option)) {
      program->log = "nvrtc: error: unrecognized option " + option;
      return 5;
    }
    if (option == "--fmad=false") flags = "-ffp-contract=off";
    if (option.rfind("--gpu", 0) == 0) architecture = option.substr(option.find('=') + 1);
  }
  return compile(*program, flags, architecture);
}
int nvrtcDestroyProgram(Program** program) {
  delete *program;
  *program = nullptr;
  return 0;
}
int nvrtcGetProgramLogSize(Program* program, std::size_t* bytes) {
  *bytes = program->log.size() + 1;
  return 0;
}
int nvrtcGetProgramLog(Program* program, char* to) {
  std::memcpy(to, program->log.c_str(), program->log.size() + 1);
  return 0;
}
int nvrtcGetCUBINSize(Program* program, std::size_t* bytes) {
  *bytes = program->image.size();
  return 0;
}
int nvrtcGetCUBIN(Program* program, char* to) {
  std::memcpy(to, program->image.data(), program->image.size());
  return 0;
}
}
