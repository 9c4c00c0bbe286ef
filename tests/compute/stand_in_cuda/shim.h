// shim.h: what makes CUDA text valid C++: the stand-in compiler puts it in front. Kernels are marked by __global__ and
// found by that mark after preprocessing.
#include <math.h>

#include <utility>
#define __CUDACC__ 1
#define __device__
#define __forceinline__ inline __attribute__((always_inline))
#define __restrict__ __restrict
#define __global__ calx_stand_in_global
struct calx_index {
  unsigned x, y, z;
};
static thread_local calx_index blockIdx, blockDim, threadIdx;
static unsigned atomicAdd(unsigned* p, unsigned v) { return __atomic_fetch_add(p, v, __ATOMIC_RELAXED); }
static unsigned atomicOr(unsigned* p, unsigned v) { return __atomic_fetch_or(p, v, __ATOMIC_RELAXED); }
static unsigned atomicMax(unsigned* p, unsigned v) {
  const unsigned before = *p;
  *p = before > v ? before : v;
  return before;
}
namespace {
template <auto F, class... A, size_t... I>
void calx_run(void (*)(A...), std::index_sequence<I...>, unsigned grid, unsigned block, void** arguments) {
  blockDim.x = block;
  for (blockIdx.x = 0; blockIdx.x < grid; ++blockIdx.x)
    for (threadIdx.x = 0; threadIdx.x < block; ++threadIdx.x) F(*static_cast<A*>(arguments[I])...);
}
template <auto F, class... A>
void calx_run(void (*f)(A...), unsigned grid, unsigned block, void** arguments) {
  calx_run<F>(f, std::index_sequence_for<A...>(), grid, block, arguments);
}
template <class... A>
const size_t* calx_sizes(void (*)(A...)) {
  static const size_t list[] = {sizeof(A)..., 0};
  return list;
}
}  // namespace
