// kernel_choice.cpp: which instruction set the hot loops use on this processor.
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "step/kernels.hpp"

namespace calx {

// One table per set built, see core/CMakeLists.txt.
extern const StepKernels kernels_plain, kernels_v3, kernels_v4;

namespace {

#if defined(CALX_X86_KERNELS)
bool has_v3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}
bool has_v4() {
  return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

const StepKernels& choose() {
  struct Candidate {
    const StepKernels* table;
    const char* name;
    bool works;
  };
  const Candidate candidates[] = {
    {&kernels_plain, "plain", true},
#if defined(CALX_X86_KERNELS)
    {&kernels_v3, "x86-64-v3", has_v3()},
    {&kernels_v4, "x86-64-v4", has_v4()},
#endif
  };
  const char* asked = std::getenv("CALX_INSTRUCTION_SET");
  const StepKernels* best = nullptr;
  std::string known;
  for (const auto& c : candidates) {
    if (!c.works) continue;
    if (!asked || !*asked || std::string(asked) == c.name) best = c.table;
    known += std::string(known.empty() ? "" : ", ") + c.name;
  }
  if (!best)
    throw Error(Fault::usage, "CALX_INSTRUCTION_SET=" + std::string(asked) +
                                  ": not a set of this build and processor; it has " + known);
  return *best;
}

}  // namespace

const StepKernels& step_kernels() {
  static const StepKernels& chosen = choose();
  return chosen;
}

}  // namespace calx
