#include "compute/cuda_compile.hpp"

#include <cstdio>
#include <sstream>

#include "base/error.hpp"
#include "compute/cuda_api.hpp"
#include "compute/device_failure.hpp"

namespace calx {

// "ptxas info    : Compiling entry function 'scan' for 'sm_90'", then lines "ptxas         .     0 bytes stack
// frame, 0 bytes spill stores, 0 bytes spill loads" and "ptxas info    : Used 40 registers, ...".
std::vector<std::pair<std::string, KernelResources>> read_resources(const std::string& log) {
  std::vector<std::pair<std::string, KernelResources>> all;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t entry = line.find("Compiling entry function '");
    if (entry != std::string::npos) {
      const std::size_t first = line.find('\'', entry) + 1;
      all.push_back({line.substr(first, line.find('\'', first) - first), {}});
    }
    if (all.empty()) continue;
    KernelResources& last = all.back().second;
    int stack = 0, stores = 0, loads = 0;
    const std::size_t frame = line.find_first_of("0123456789");
    if (frame != std::string::npos &&
        std::sscanf(line.c_str() + frame, "%d bytes stack frame, %d bytes spill stores, %d bytes spill loads", &stack,
                    &stores, &loads) == 3) {
      last.stack_bytes = stack;
      last.spill_bytes = stores + loads;
    }
    const std::size_t used = line.find("Used ");
    if (used != std::string::npos) std::sscanf(line.c_str() + used, "Used %d registers", &last.registers);
  }
  return all;
}

CudaBinary compile_cuda(const ModuleText& text, const std::string& architecture, const std::string& driver,
                        DeviceCache& cache) {
  const Nvrtc& api = nvrtc();
  const std::string source = compose(text);
  // 177: a function that is not used. Division, square root and small numbers are exact by default.
  const std::vector<std::string> options = {"--gpu-architecture=" + architecture,
                                            "--std=c++17",
                                            text.fast ? "--fmad=true" : "--fmad=false",
                                            "--prec-div=true",
                                            "--prec-sqrt=true",
                                            "--ftz=false",
                                            "--diag-suppress=177",
                                            "--ptxas-options=-v"};
  std::vector<std::string> parts = options;
  parts.insert(parts.end(), {source, driver, api.library.name, std::to_string(api.major), std::to_string(api.minor)});
  const std::string key = DeviceCache::key(parts);
  CudaBinary binary;
  std::optional<CompiledModule> compiled = cache.load(key);
  binary.from_cache = compiled.has_value();
  if (!compiled) {
    nvrtcProgram program = nullptr;
    if (api.nvrtcCreateProgram(&program, source.c_str(), "module.cu", 0, nullptr, nullptr) != 0)
      throw Error(Fault::plugin, "NVRTC cannot take the text of module \"" + text.label + "\"");
    std::vector<const char*> words;
    for (const std::string& option : options) words.push_back(option.c_str());
    const int code = api.nvrtcCompileProgram(program, static_cast<int>(words.size()), words.data());
    compiled = CompiledModule();
    std::size_t bytes = 0;
    if (api.nvrtcGetProgramLogSize(program, &bytes) == 0 && bytes > 0) {
      compiled->log.resize(bytes);
      api.nvrtcGetProgramLog(program, &compiled->log[0]);
      while (!compiled->log.empty() && compiled->log.back() == '\0') compiled->log.pop_back();
    }
    if (code == 0 && api.nvrtcGetCUBINSize(program, &bytes) == 0) {
      compiled->image.resize(bytes);
      api.nvrtcGetCUBIN(program, &compiled->image[0]);
    }
    api.nvrtcDestroyProgram(&program);
    if (compiled->image.empty())
      build_failed(text,
                   "CUDA " + architecture + " by NVRTC " + std::to_string(api.major) + "." + std::to_string(api.minor),
                   compiled->log, cache);
    cache.store(key, *compiled);
  }
  binary.image = std::move(compiled->image);
  binary.log = std::move(compiled->log);
  binary.resources = read_resources(binary.log);
  return binary;
}

}  // namespace calx
