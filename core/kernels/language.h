/* language.h: the layer that lets one kernel text be OpenCL C 1.2, CUDA C++ and C++17. It stands in front of every
 * module, before prelude.h and the laws, which have macros of their own and do not know this file.
 *
 * A kernel is KERNEL(name, parameters) { ... }. It works on one item, ITEM (u32), and begins with
 *     if (ITEM >= count) return;
 * because more items than asked for may be started. ITEM is known in the kernel itself only, not in an FN function.
 * A parameter is a GLOBAL pointer, a number of 4 or 8 bytes, or a struct of such numbers by value.
 * There are no barriers, no local memory and no atomics on floating-point numbers: order reaches no result.
 *
 * Subset: C99 scalars and structs, for, if, ?:. No recursion, function pointer, libc or writable global, no operator on
 * a struct, no run-time index into a struct (it costs a stack frame). A pointer to global memory is GLOBAL in FN
 * functions, too. Indices are u32; an offset column * stride + item is u64. Names with _f32 or _f64 fit prelude.h's
 * CALX_ID(name). Names that OpenCL C has already are taken: half, kernel, global, local, constant, step, mix, dot,
 * length. CALX_FAST is defined where a module may contract a * b + c; otherwise every backend gives the same bits. */
#ifndef CALX_LANGUAGE_H
#define CALX_LANGUAGE_H

#define KERNEL(name, ...) CALX_KERNEL(name, __VA_ARGS__)

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#define CALX_OPENCL 1
#ifdef CALX_FAST
#pragma OPENCL FP_CONTRACT ON
#else
#pragma OPENCL FP_CONTRACT OFF
#endif
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define CALX_HAS_DOUBLE 1
#endif
#define GLOBAL __global
#define RESTRICT restrict
#define FN static inline
#define CALX_KERNEL(name, ...) __kernel void name(__VA_ARGS__)
#define ITEM ((u32)get_global_id(0))
/* Return the value before. */
#define ATOMIC_ADD(pointer, value) atomic_add(pointer, value)
#define ATOMIC_OR(pointer, value) atomic_or(pointer, value)
#define ATOMIC_MAX(pointer, value) atomic_max(pointer, value)
/* OpenCL's own uint8 and the like are vectors, hence these names. */
typedef uchar u8;
typedef uint u32;
typedef int i32;
typedef ulong u64;
typedef long i64;

#else

#define CALX_HAS_DOUBLE 1
#define GLOBAL
typedef unsigned char u8;
typedef unsigned int u32;
typedef int i32;
typedef unsigned long long u64;
typedef long long i64;

#if defined(__CUDACC__) || defined(__CUDACC_RTC__)

#define RESTRICT __restrict__
#define FN static __device__ __forceinline__
#define CALX_KERNEL(name, ...) extern "C" __global__ void name(__VA_ARGS__)
#define ITEM (blockIdx.x * blockDim.x + threadIdx.x)
#define ATOMIC_ADD(pointer, value) atomicAdd(pointer, value)
#define ATOMIC_OR(pointer, value) atomicOr(pointer, value)
#define ATOMIC_MAX(pointer, value) atomicMax(pointer, value)

#else

/* One thread runs all items of a kernel in order, so that atomics are plain. */
#include <math.h>

#include <utility>
#define RESTRICT __restrict
#define FN static inline __attribute__((always_inline))
#define ITEM calx_item
#define ATOMIC_ADD(pointer, value) calx_host::add(pointer, value)
#define ATOMIC_OR(pointer, value) calx_host::bit_or(pointer, value)
#define ATOMIC_MAX(pointer, value) calx_host::larger(pointer, value)
/* Beside the kernel stand a loop over all items, which takes pointers to the arguments, and the list of its parameters.
 */
#define CALX_KERNEL(name, ...)                                                                                     \
  static void name(const u32 calx_item, __VA_ARGS__);                                                              \
  extern "C" void calx_run_##name(u64 items, void** arguments) { calx_host::run<&name>(&name, items, arguments); } \
  extern "C" const u32* calx_parameters_##name() { return calx_host::parameters(&name); }                          \
  static inline __attribute__((always_inline)) void name(const u32 calx_item, __VA_ARGS__)
namespace {
namespace calx_host {
inline u32 add(u32* p, u32 v) {
  const u32 before = *p;
  *p = before + v;
  return before;
}
inline u32 bit_or(u32* p, u32 v) {
  const u32 before = *p;
  *p = before | v;
  return before;
}
inline u32 larger(u32* p, u32 v) {
  const u32 before = *p;
  *p = before > v ? before : v;
  return before;
}
template <auto F, class... A>
void loop(u64 items, A... values) {
  for (u64 k = 0; k < items; ++k) F((u32)k, values...);
}
template <auto F, class... A, size_t... I>
void unpack(std::index_sequence<I...>, u64 items, void** arguments) {
  loop<F, A...>(items, *(A*)arguments[I]...);
}
template <auto F, class... A>
void run(void (*)(u32, A...), u64 items, void** arguments) {
  unpack<F, A...>(std::index_sequence_for<A...>(), items, arguments);
}
template <class T>
constexpr u32 describe = sizeof(T);
template <class T>
constexpr u32 describe<T*> = 0x80000000u | sizeof(T*);
/* Size of each parameter, highest bit set for a pointer; closed by 0. */
template <class... A>
const u32* parameters(void (*)(u32, A...)) {
  static const u32 list[] = {describe<A>..., 0};
  return list;
}
}  // namespace calx_host
}  // namespace

#endif
#endif

#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

/* Functions of one precision: square root, absolute value, floor (exactly rounded everywhere), and vectors. scale3 is
 * s a, mad3 is a + s b. */
#define CALX_PRECISION(T, S, SQRT, ABS, FLOOR)                                                                    \
  FN T sqrt##S(T x) { return SQRT(x); }                                                                           \
  FN T abs##S(T x) { return ABS(x); }                                                                             \
  FN T floor##S(T x) { return FLOOR(x); }                                                                         \
  typedef struct vec3##S {                                                                                        \
    T x, y, z;                                                                                                    \
  } vec3##S;                                                                                                      \
  FN vec3##S make3##S(T x, T y, T z) {                                                                            \
    vec3##S v;                                                                                                    \
    v.x = x;                                                                                                      \
    v.y = y;                                                                                                      \
    v.z = z;                                                                                                      \
    return v;                                                                                                     \
  }                                                                                                               \
  FN vec3##S add3##S(vec3##S a, vec3##S b) { return make3##S(a.x + b.x, a.y + b.y, a.z + b.z); }                  \
  FN vec3##S sub3##S(vec3##S a, vec3##S b) { return make3##S(a.x - b.x, a.y - b.y, a.z - b.z); }                  \
  FN vec3##S scale3##S(T s, vec3##S a) { return make3##S(s * a.x, s * a.y, s * a.z); }                            \
  FN vec3##S mad3##S(vec3##S a, T s, vec3##S b) { return make3##S(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z); } \
  FN T dot3##S(vec3##S a, vec3##S b) { return a.x * b.x + a.y * b.y + a.z * b.z; }                                \
  FN vec3##S cross3##S(vec3##S a, vec3##S b) {                                                                    \
    return make3##S(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);                         \
  }                                                                                                               \
  FN T length3##S(vec3##S a) { return SQRT(dot3##S(a, a)); }

#ifdef CALX_OPENCL
CALX_PRECISION(float, _f32, sqrt, fabs, floor)
#else
CALX_PRECISION(float, _f32, sqrtf, fabsf, floorf)
#endif
#ifdef CALX_HAS_DOUBLE
CALX_PRECISION(double, _f64, sqrt, fabs, floor)
#endif

#endif
