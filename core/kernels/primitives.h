/* primitives.h: exclusive scan of u32 and reductions, without barriers, so that every backend runs this text and gives
 * the same bits. One item works on CALX_RUN entries one after the other; the results are treated the same way until one
 * is left. work holds the results of all levels behind each other; *_first is where a level begins in it, in entries.
 */
#define CALX_RUN 64

/* Sum of each run. */
KERNEL(scan_sums, GLOBAL const u32* RESTRICT in, const u32 in_first, GLOBAL u32* RESTRICT out, const u32 out_first,
       const u32 n, const u32 runs) {
  if (ITEM >= runs) return;
  const u32 run = ITEM;
  const u32 first = run * CALX_RUN;
  const u32 last = MIN(n - first, CALX_RUN) + first;
  u32 sum = 0;
  for (u32 k = first; k < last; ++k) sum += in[(u64)in_first + k];
  out[(u64)out_first + run] = sum;
}

/* What comes before each entry, given what comes before each run; the total behind the last entry. The only run of the
 * last level begins at 0. */
KERNEL(scan_write, GLOBAL const u32* RESTRICT in, const u32 in_first, GLOBAL const u32* RESTRICT before,
       const u32 before_first, GLOBAL u32* RESTRICT out, const u32 out_first, const u32 n, const u32 runs) {
  if (ITEM >= runs) return;
  const u32 run = ITEM;
  const u32 first = run * CALX_RUN;
  const u32 last = MIN(n - first, CALX_RUN) + first;
  u32 sum = runs == 1 ? 0 : before[(u64)before_first + run];
  for (u32 k = first; k < last; ++k) {
    const u32 value = in[(u64)in_first + k];
    out[(u64)out_first + k] = sum;
    sum += value;
  }
  if (run == runs - 1) out[(u64)out_first + n] = sum;
}

/* Item k takes entries k, k + items, k + 2 items, ...: neighbours read neighbours. */
#define CALX_REDUCE(name, T, JOIN)                                                                           \
  KERNEL(name, GLOBAL const T* RESTRICT in, const u32 in_first, GLOBAL T* RESTRICT out, const u32 out_first, \
         const u32 n, const u32 items) {                                                                     \
    if (ITEM >= items) return;                                                                               \
    const u32 item = ITEM;                                                                                   \
    T a = in[(u64)in_first + item];                                                                          \
    for (u64 k = (u64)item + items; k < n; k += items) {                                                     \
      const T b = in[in_first + k];                                                                          \
      a = JOIN;                                                                                              \
    }                                                                                                        \
    out[(u64)out_first + item] = a;                                                                          \
  }
#define CALX_REDUCTIONS(S, T)                   \
  CALX_REDUCE(reduce_sum##S, T, a + b)          \
  CALX_REDUCE(reduce_smallest##S, T, MIN(a, b)) \
  CALX_REDUCE(reduce_largest##S, T, MAX(a, b))
CALX_REDUCTIONS(_u32, u32)
CALX_REDUCTIONS(_f32, float)
#ifdef CALX_HAS_DOUBLE
CALX_REDUCTIONS(_f64, double)
#endif
