// kernels.cpp: compiled once per instruction set, each time with another CALX_KERNELS, the name of the table.
//
// Only static functions live here: an inline function that the linker shared with the rest of the program could carry
// instructions that a lesser processor does not have. Vectors are four doubles wide, the width of half a record.
#include "step/kernels.hpp"

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace calx {
namespace {

using Four = double __attribute__((vector_size(32)));
using Two = double __attribute__((vector_size(16)));
using FourFloat = float __attribute__((vector_size(16)));
using EightFloat = float __attribute__((vector_size(32)));
using FourMask = long long __attribute__((vector_size(32)));

#define CALX_INLINE static inline __attribute__((always_inline))

/// Numbers stand where their arrays put them, aligned to themselves only.
template <class Vector, class Scalar>
CALX_INLINE Vector read(const Scalar* p) {
  Vector v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

CALX_INLINE Four load(const double* p) { return read<Four>(p); }
CALX_INLINE void store(double* p, Four v) { __builtin_memcpy(p, &v, sizeof v); }
CALX_INLINE Two load_two(const double* p) { return read<Two>(p); }
CALX_INLINE void store_two(double* p, Two v) { __builtin_memcpy(p, &v, sizeof v); }
CALX_INLINE FourFloat load(const float* p) { return read<FourFloat>(p); }
CALX_INLINE void store(float* p, FourFloat v) { __builtin_memcpy(p, &v, sizeof v); }
CALX_INLINE EightFloat load_eight(const float* p) { return read<EightFloat>(p); }
CALX_INLINE void store_eight(float* p, EightFloat v) { __builtin_memcpy(p, &v, sizeof v); }
CALX_INLINE FourFloat narrow(Four v) { return __builtin_convertvector(v, FourFloat); }
CALX_INLINE Four wide(FourFloat v) { return __builtin_convertvector(v, Four); }
CALX_INLINE Four all(double x) { return Four{x, x, x, x}; }

CALX_INLINE Four root(Four x) {
#if defined(__AVX__)
  return _mm256_sqrt_pd(x);
#else
  return Four{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])};
#endif
}

/// Bit k: lane k of the mask of four lanes is set.
template <class Mask>
CALX_INLINE unsigned bits_of(Mask mask) {
#if defined(__AVX__)
  if constexpr (sizeof(mask) == 32)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
  else
    return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}

using FourIndex = std::uint32_t __attribute__((vector_size(16)));

CALX_INLINE FourIndex load_index(const std::uint32_t* p) { return read<FourIndex>(p); }
CALX_INLINE void store_index(std::uint32_t* p, FourIndex v) { __builtin_memcpy(p, &v, sizeof v); }

CALX_INLINE unsigned ones(unsigned nibble) { return static_cast<unsigned>(__builtin_popcount(nibble)); }

/// The four flags, each 0 or 1, are the four bits.
CALX_INLINE bool same_flags(const std::uint8_t* flags, unsigned bits) {
  static const std::uint32_t spread[16] = {0x0,       0x1,       0x100,     0x101,     0x10000,   0x10001,
                                           0x10100,   0x10101,   0x1000000, 0x1000001, 0x1000100, 0x1000101,
                                           0x1010000, 0x1010001, 0x1010100, 0x1010101};
  std::uint32_t four;
  __builtin_memcpy(&four, flags, 4);
  return four == spread[bits];
}

/// The lanes whose bit is set, moved to the front; what follows them means nothing.
CALX_INLINE FourIndex pick(FourIndex v, unsigned bits) {
  static const unsigned char lanes[16][4] = {
      {0, 1, 2, 3}, {0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 2, 3}, {2, 0, 1, 3}, {0, 2, 1, 3}, {1, 2, 0, 3}, {0, 1, 2, 3},
      {3, 0, 1, 2}, {0, 3, 1, 2}, {1, 3, 0, 2}, {0, 1, 3, 2}, {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 2, 3, 0}, {0, 1, 2, 3}};
#if defined(__AVX2__)
  const __m128i order = _mm_cvtepu8_epi32(_mm_loadu_si32(lanes[bits]));
  return reinterpret_cast<FourIndex>(_mm_permutevar_ps(reinterpret_cast<__m128>(v), order));
#else
  const unsigned char* from = lanes[bits];
  return FourIndex{v[from[0]], v[from[1]], v[from[2]], v[from[3]]};
#endif
}

CALX_INLINE Four lesser(Four a, Four b) { return a < b ? a : b; }
CALX_INLINE Four greater(Four a, Four b) { return a > b ? a : b; }

/// Rows become columns.
CALX_INLINE void transpose(Four& a, Four& b, Four& c, Four& d) {
  const Four t0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), t1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four t2 = __builtin_shufflevector(c, d, 0, 4, 2, 6), t3 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  b = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  c = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  d = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

/// The same in each half: columns of the lower halves and of the upper.
CALX_INLINE void transpose(EightFloat& a, EightFloat& b, EightFloat& c, EightFloat& d) {
  const EightFloat t0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                   t1 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                   t2 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                   t3 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}
CALX_INLINE FourFloat lower(EightFloat v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
CALX_INLINE FourFloat upper(EightFloat v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
CALX_INLINE EightFloat joined(FourFloat a, FourFloat b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Shortest image of differences along one direction.
CALX_INLINE Four nearest(Four d, double length) {
  d = d > all(0.5 * length) ? d - length : d;
  return d < all(-0.5 * length) ? d + length : d;
}

CALX_INLINE void nearest(const Wrap& wrap, Four& x, Four& y, Four& z) {
  if (wrap.periodic[0]) x = nearest(x, wrap.length.x);
  if (wrap.periodic[1]) y = nearest(y, wrap.length.y);
  if (wrap.periodic[2]) z = nearest(z, wrap.length.z);
}

/// Entries between asking for a partner's data and using it.
constexpr std::size_t kAhead = 64;

/// Gaps at which the laws of four pairs act, m.
CALX_INLINE Four gaps_of(const PairScan& scan, const std::uint32_t* i, const std::uint32_t* j) {
  Four out = all(0);
  for (int q = 0; q < 4; ++q) {
    const std::uint32_t a = scan.owner ? scan.owner[i[q]] : i[q], b = scan.owner ? scan.owner[j[q]] : j[q];
    out[q] = scan.gaps[std::size_t{scan.material[a]} * scan.materials + scan.material[b]];
  }
  return out;
}

template <bool wraps, bool chooses, bool reaches, class Precision>
CALX_INLINE bool find_in(PairScan& scan, PairBlock& block) {
  using Sphere = typename Precision::Sphere;
  const Sphere* __restrict s = static_cast<const Sphere*>(scan.spheres);
  const auto* sums = static_cast<const typename Precision::Sum*>(scan.sums);
  const std::uint32_t* __restrict pi = scan.i, * __restrict pj = scan.j;
  std::size_t e = scan.next_entry;
  const std::size_t last = scan.last_entry;
  std::uint32_t n = 0, crossed = scan.crossed, started = 0;
  const FourIndex first_row{0, 1, 2, 3};
  std::uint32_t ii[4] = {0, 0, 0, 0}, jj[4] = {0, 0, 0, 0};
  for (; e < last && n <= kBlockRows - 4; e += 4) {
    const std::size_t left = last - e;
    const std::uint32_t *gi = pi + e, *gj = pj + e;
    unsigned valid = 15;
    if (left < 4) {
      for (std::size_t q = 0; q < 4; ++q) {
        const std::size_t from = q < left ? e + q : last - 1;
        ii[q] = pi[from];
        jj[q] = pj[from];
      }
      gi = ii;
      gj = jj;
      valid = (1u << left) - 1;
    }
    // Partners lie anywhere: without asking early, time goes by waiting for them.
    if (left > kAhead + 4) {
      for (std::size_t q = 0; q < 4; ++q) {
        const std::uint32_t soon = pj[e + kAhead + q];
        const char* record = reinterpret_cast<const char*>(s + soon);
        __builtin_prefetch(record);
        if (sizeof(Sphere) > 64) __builtin_prefetch(record + 64);
        __builtin_prefetch(sums + soon, 1);
      }
      const std::size_t ahead = chooses ? scan.first_entry + scan.chosen[e + kAhead] : e + kAhead;
      const double* rows = scan.history + ahead * scan.width;
      for (std::size_t h = 0; h < 4 * scan.width; h += 8) __builtin_prefetch(rows + h, 1);
    }
    Four d0 = load(&s[gi[0]].x), d1 = load(&s[gi[1]].x), d2 = load(&s[gi[2]].x), d3 = load(&s[gi[3]].x);
    Four b0 = load(&s[gj[0]].x), b1 = load(&s[gj[1]].x), b2 = load(&s[gj[2]].x), b3 = load(&s[gj[3]].x);
    // Lane 3 carries radii: minus for the sum under the difference.
    const FourMask sign{0, 0, 0, static_cast<long long>(0x8000000000000000ull)};
    b0 = reinterpret_cast<Four>(reinterpret_cast<FourMask>(b0) ^ sign);
    b1 = reinterpret_cast<Four>(reinterpret_cast<FourMask>(b1) ^ sign);
    b2 = reinterpret_cast<Four>(reinterpret_cast<FourMask>(b2) ^ sign);
    b3 = reinterpret_cast<Four>(reinterpret_cast<FourMask>(b3) ^ sign);
    d0 -= b0;
    d1 -= b1;
    d2 -= b2;
    d3 -= b3;
    transpose(d0, d1, d2, d3);
    if (wraps) nearest(*scan.wrap, d0, d1, d2);
    if (reaches) d3 += gaps_of(scan, gi, gj);
    const unsigned hits = bits_of(d0 * d0 + d1 * d1 + d2 * d2 < d3 * d3) & valid;
    // A contact that ends is forgotten; one that begins is named to the caller.
    if (chooses || left < 4 || !same_flags(scan.touching + e, hits))
      for (unsigned q = 0; q < 4 && q < left; ++q) {
        const unsigned hit = hits >> q & 1u;
        std::uint8_t& flag = scan.touching[chooses ? scan.first_entry + scan.chosen[e + q] : e + q];
        if (hit != flag) {
          flag = static_cast<std::uint8_t>(hit);
          if (hit) scan.fresh[started++] = n + ones(hits & ((1u << q) - 1));
        }
      }
    const FourIndex vi = load_index(gi), vj = load_index(gj);
    const FourIndex row =
        chooses ? load_index(scan.chosen + e) : first_row + static_cast<std::uint32_t>(e - scan.first_entry);
    const unsigned leaving = chooses ? 0 : bits_of(vj >= scan.last_sphere) & valid;
    FourIndex number{crossed, crossed, crossed, crossed};
    if (chooses) number = load_index(scan.chosen_ordinal + e);
    if (leaving) number += FourIndex{0, leaving & 1u, ones(leaving & 3u), ones(leaving & 7u)};
    store_index(block.entry + n, pick(row, hits));
    store_index(block.i + n, pick(vi, hits));
    store_index(block.j + n, pick(vj, hits));
    store_index(block.ordinal + n, pick(number, hits));
    n += ones(hits);
    crossed += ones(leaving);
  }
  scan.next_entry = e;
  scan.crossed = crossed;
  scan.started = started;
  block.count = n;
  block.repeat_last_row();
  return e < last;
}

template <bool chooses, bool reaches, class Precision>
CALX_INLINE bool find_with(PairScan& scan, PairBlock& block) {
  return scan.wrap ? find_in<true, chooses, reaches, Precision>(scan, block)
                   : find_in<false, chooses, reaches, Precision>(scan, block);
}

template <class Precision>
bool find(PairScan& scan, PairBlock& block) {
  if (scan.gaps)
    return scan.chosen ? find_with<true, true, Precision>(scan, block) : find_with<false, true, Precision>(scan, block);
  return scan.chosen ? find_with<true, false, Precision>(scan, block) : find_with<false, false, Precision>(scan, block);
}

/// Geometry of four pairs, in double whatever the precision: unit vectors towards i, overlaps, distances, radii.
struct FourPairs {
  Four nx, ny, nz, overlap, ri, rj;
};

template <class Sphere>
CALX_INLINE FourPairs meet(const Sphere* const* a, const Sphere* const* b, const Wrap* wrap) {
  Four x = load(&a[0]->x), y = load(&a[1]->x), z = load(&a[2]->x), ri = load(&a[3]->x);
  Four px = load(&b[0]->x), py = load(&b[1]->x), pz = load(&b[2]->x), rj = load(&b[3]->x);
  transpose(x, y, z, ri);
  transpose(px, py, pz, rj);
  x -= px;
  y -= py;
  z -= pz;
  if (wrap) nearest(*wrap, x, y, z);
  const Four distance = root(x * x + y * y + z * z);
  const Four inverse = 1 / distance;
  return {x * inverse, y * inverse, z * inverse, ri + rj - distance, ri, rj};
}

/// Velocities, spins and masses of four spheres.
struct FourMotions {
  Four vx, vy, vz, m, wx, wy, wz;
};
struct FourLeanMotions {
  FourFloat vx, vy, vz, m, wx, wy, wz;
};

CALX_INLINE FourMotions motions(const Record* const* s) {
  FourMotions out;
  out.vx = load(&s[0]->vx), out.vy = load(&s[1]->vx), out.vz = load(&s[2]->vx), out.m = load(&s[3]->vx);
  transpose(out.vx, out.vy, out.vz, out.m);
  Four unused = load(&s[3]->wx);
  out.wx = load(&s[0]->wx), out.wy = load(&s[1]->wx), out.wz = load(&s[2]->wx);
  transpose(out.wx, out.wy, out.wz, unused);
  return out;
}
CALX_INLINE FourLeanMotions motions(const LeanRecord* const* s) {
  EightFloat x = load_eight(&s[0]->vx), y = load_eight(&s[1]->vx), z = load_eight(&s[2]->vx), m = load_eight(&s[3]->vx);
  transpose(x, y, z, m);
  return {lower(x), lower(y), lower(z), lower(m), upper(x), upper(y), upper(z)};
}

CALX_INLINE Four in_precision(Four v, const InDouble&) { return v; }
CALX_INLINE FourFloat in_precision(Four v, const InMixed&) { return narrow(v); }

template <class Precision>
bool kinematics(const typename Precision::Sphere* spheres, const Wrap* wrap, const PairBlock& block, double largest,
                const PairColumns<typename Precision::Real>& out) {
  const Precision precision;
  unsigned above = 0;
  for (std::uint32_t k = 0; k < block.count; k += 4) {
    const typename Precision::Sphere* a[4] = {spheres + block.i[k], spheres + block.i[k + 1], spheres + block.i[k + 2],
                                              spheres + block.i[k + 3]};
    const typename Precision::Sphere* b[4] = {spheres + block.j[k], spheres + block.j[k + 1], spheres + block.j[k + 2],
                                              spheres + block.j[k + 3]};
    const FourPairs pair = meet(a, b, wrap);
    const Four r_eff = pair.ri * pair.rj / (pair.ri + pair.rj);
    above |= bits_of(0.5 * pair.overlap > largest * r_eff);
    const auto x = in_precision(pair.nx, precision), y = in_precision(pair.ny, precision),
               z = in_precision(pair.nz, precision);
    const auto arm_i = in_precision(pair.ri - 0.5 * pair.overlap, precision),
               arm_j = in_precision(pair.rj - 0.5 * pair.overlap, precision);
    store(out.nx + k, x);
    store(out.ny + k, y);
    store(out.nz + k, z);
    store(out.overlap + k, in_precision(pair.overlap, precision));
    store(out.r_eff + k, in_precision(r_eff, precision));
    store(out.arm_i + k, arm_i);
    store(out.arm_j + k, arm_j);
    if (out.r_i) {
      store(out.r_i + k, in_precision(pair.ri, precision));
      store(out.r_j + k, in_precision(pair.rj, precision));
    }
    const auto i = motions(a), j = motions(b);
    if (out.wx) {
      store(out.wx + k, i.wx - j.wx);
      store(out.wy + k, i.wy - j.wy);
      store(out.wz + k, i.wz - j.wz);
    }
    // v_i + w_i x (-a n) - v_j - w_j x (b n) = v_i - v_j - (a w_i + b w_j) x n
    const auto sx = arm_i * i.wx + arm_j * j.wx, sy = arm_i * i.wy + arm_j * j.wy, sz = arm_i * i.wz + arm_j * j.wz;
    store(out.vx + k, i.vx - j.vx - (sy * z - sz * y));
    store(out.vy + k, i.vy - j.vy - (sz * x - sx * z));
    store(out.vz + k, i.vz - j.vz - (sx * y - sy * x));
    store(out.m_eff + k, i.m * j.m / (i.m + j.m));
  }
  return above != 0;
}

CALX_INLINE void store_columns(double* to, Four v) { store(to, v); }
CALX_INLINE void store_columns(float* to, Four v) { store(to, narrow(v)); }
CALX_INLINE Four load_columns(const double* from) { return load(from); }
CALX_INLINE Four load_columns(const float* from) { return wide(load(from)); }

template <class Precision>
void read_history(const double* history, std::uint32_t width, const PairBlock& block, std::uint32_t count,
                  typename Precision::Real* columns) {
  constexpr std::uint32_t stride = kColumnStride<typename Precision::Real>;
  for (std::uint32_t k = 0; k < block.count; k += 4) {
    const double *r0 = history + std::size_t(block.entry[k]) * width,
                 *r1 = history + std::size_t(block.entry[k + 1]) * width,
                 *r2 = history + std::size_t(block.entry[k + 2]) * width,
                 *r3 = history + std::size_t(block.entry[k + 3]) * width;
    auto* to = columns + k;
    for (std::uint32_t h = 0; h < count; h += 4, to += 4 * stride) {
      Four a = load(r0 + h), b = load(r1 + h), c = load(r2 + h), d = load(r3 + h);
      transpose(a, b, c, d);
      store_columns(to, a);
      if (h + 1 < count) store_columns(to + stride, b);
      if (h + 2 < count) store_columns(to + 2 * stride, c);
      if (h + 3 < count) store_columns(to + 3 * stride, d);
    }
  }
}

/// The first count values of a, at most four.
CALX_INLINE void store_first(double* p, Four a, std::uint32_t count) {
  if (count > 3) {
    store(p, a);
    return;
  }
  if (count == 1) {
    p[0] = a[0];
    return;
  }
  store_two(p, __builtin_shufflevector(a, a, 0, 1));
  if (count == 3) p[2] = a[2];
}

template <class Precision>
void write_history(double* history, std::uint32_t width, const PairBlock& block, std::uint32_t count,
                   const typename Precision::Real* columns) {
  constexpr std::uint32_t stride = kColumnStride<typename Precision::Real>;
  const Four zero = all(0);
  for (std::uint32_t k = 0; k < block.count; k += 4) {
    const std::uint32_t rows = block.count - k;
    double* const r0 = history + std::size_t(block.entry[k]) * width;
    double* const r1 = history + std::size_t(block.entry[k + 1]) * width;
    double* const r2 = history + std::size_t(block.entry[k + 2]) * width;
    double* const r3 = history + std::size_t(block.entry[k + 3]) * width;
    const auto* from = columns + k;
    for (std::uint32_t h = 0; h < count; h += 4, from += 4 * stride) {
      const std::uint32_t left = count - h;
      Four a = load_columns(from), b = left > 1 ? load_columns(from + stride) : zero,
           c = left > 2 ? load_columns(from + 2 * stride) : zero, d = left > 3 ? load_columns(from + 3 * stride) : zero;
      transpose(a, b, c, d);
      // Rows beyond the count repeat the last one: they must not write over it.
      store_first(r0 + h, a, left);
      if (rows > 1) store_first(r1 + h, b, left);
      if (rows > 2) store_first(r2 + h, c, left);
      if (rows > 3) store_first(r3 + h, d, left);
    }
  }
}

/// Wrenches of four contacts as rows.
struct FourWrenches {
  Four force[4];  // fx, fy, fz, tx
  Two torque[4];  // ty, tz
};
struct FourLeanWrenches {
  EightFloat row[4];
};

CALX_INLINE FourWrenches rows(Four fx, Four fy, Four fz, Four tx, Four ty, Four tz) {
  const Four even = __builtin_shufflevector(ty, tz, 0, 4, 2, 6), odd = __builtin_shufflevector(ty, tz, 1, 5, 3, 7);
  transpose(fx, fy, fz, tx);
  return {{fx, fy, fz, tx},
          {__builtin_shufflevector(even, even, 0, 1), __builtin_shufflevector(odd, odd, 0, 1),
           __builtin_shufflevector(even, even, 2, 3), __builtin_shufflevector(odd, odd, 2, 3)}};
}
CALX_INLINE FourLeanWrenches rows(FourFloat fx, FourFloat fy, FourFloat fz, FourFloat tx, FourFloat ty, FourFloat tz) {
  EightFloat a = joined(fx, tx), b = joined(fy, ty), c = joined(fz, tz), d{};
  transpose(a, b, c, d);
  return {{a, b, c, d}};
}

CALX_INLINE void add(Wrench& sum, const FourWrenches& w, std::uint32_t q) {
  store(&sum.fx, load(&sum.fx) + w.force[q]);
  store_two(&sum.ty, load_two(&sum.ty) + w.torque[q]);
}
CALX_INLINE void subtract(Wrench& sum, const FourWrenches& w, std::uint32_t q) {
  store(&sum.fx, load(&sum.fx) - w.force[q]);
  store_two(&sum.ty, load_two(&sum.ty) - w.torque[q]);
}
CALX_INLINE void put_negative(Wrench& sum, const FourWrenches& w, std::uint32_t q) {
  store(&sum.fx, -w.force[q]);
  store_two(&sum.ty, -w.torque[q]);
}
CALX_INLINE void add(LeanWrench& sum, const FourLeanWrenches& w, std::uint32_t q) {
  store_eight(&sum.fx, load_eight(&sum.fx) + w.row[q]);
}
CALX_INLINE void subtract(LeanWrench& sum, const FourLeanWrenches& w, std::uint32_t q) {
  store_eight(&sum.fx, load_eight(&sum.fx) - w.row[q]);
}
CALX_INLINE void put_negative(LeanWrench& sum, const FourLeanWrenches& w, std::uint32_t q) {
  store_eight(&sum.fx, -w.row[q]);
}

template <class Precision>
void scatter(const PairBlock& block, const PairSums<Precision>& out) {
  auto* __restrict sums = out.sums;
  const std::uint32_t count = block.count;
  for (std::uint32_t k = 0; k < count; k += 4) {
    const auto fx = load(out.fx + k), fy = load(out.fy + k), fz = load(out.fz + k);
    const auto nx = load(out.nx + k), ny = load(out.ny + k), nz = load(out.nz + k);
    const auto mx = load(out.mx + k), my = load(out.my + k), mz = load(out.mz + k);
    // n x f; the lever arms are -a n and b n.
    const auto gx = ny * fz - nz * fy, gy = nz * fx - nx * fz, gz = nx * fy - ny * fx;
    const auto a = load(out.arm_i + k), b = load(out.arm_j + k);
    const auto on_i = rows(fx, fy, fz, mx - a * gx, my - a * gy, mz - a * gz);
    const auto on_j = rows(fx, fy, fz, mx + b * gx, my + b * gy, mz + b * gz);
    const std::uint32_t left = count - k;
#pragma GCC unroll 4
    for (std::uint32_t q = 0; q < 4; ++q) {
      if (q >= left) break;
      add(sums[block.i[k + q]], on_i, q);
      const std::uint32_t j = block.j[k + q];
      if (j < out.last_sphere) {
        subtract(sums[j], on_j, q);
      } else {
        const std::uint32_t slot = out.cross[block.ordinal[k + q]];
        out.slot_used[slot] = 1;
        put_negative(out.slot_wrench[slot], on_j, q);
      }
    }
  }
}

void thin(const Record* __restrict spheres, std::size_t count, LeanRecord* __restrict out) {
  for (std::size_t k = 0; k < count; ++k) {
    store(&out[k].x, load(&spheres[k].x));
    store(&out[k].vx, narrow(load(&spheres[k].vx)));
    store(&out[k].wx, narrow(load(&spheres[k].wx)));
  }
}

void widen(const LeanWrench* __restrict from, std::size_t count, Wrench* __restrict to) {
  for (std::size_t k = 0; k < count; ++k) {
    // Three numbers each; the fourth of the force stands before the torque and is zero.
    const Four force = wide(load(&from[k].fx)), torque = wide(load(&from[k].tx));
    Wrench& w = to[k];
    w.fx += force[0];
    w.fy += force[1];
    w.fz += force[2];
    w.tx += torque[0];
    w.ty += torque[1];
    w.tz += torque[2];
  }
}

template <bool turns>
CALX_INLINE void move(Record* __restrict body, const Wrench* __restrict wrench, std::size_t count,
                      const double gravity[3], double dt) {
  const Four zero = all(0), pull{gravity[0] * dt, gravity[1] * dt, gravity[2] * dt, 0};
  for (std::size_t k = 0; k < count; ++k) {
    Record& b = body[k];
    const Wrench& w = wrench[k];
    const Four force = __builtin_shufflevector(load(&w.fx), zero, 0, 1, 2, 7);
    const Four v = load(&b.vx) + (all(dt / b.m) * force + pull);
    store(&b.vx, v);
    store(&b.x, load(&b.x) + all(dt) * __builtin_shufflevector(v, zero, 0, 1, 2, 7));
    if (!turns) continue;
    // Lanes tx, ty, tz from the last four numbers of the wrench.
    const Four torque = __builtin_shufflevector(load(&w.fz), zero, 1, 2, 3, 7);
    store(&b.wx, load(&b.wx) + all(dt * b.aux) * torque);
  }
}

void move_spheres(Record* body, const Wrench* wrench, std::size_t count, const double gravity[3], double dt) {
  move<true>(body, wrench, count, gravity, dt);
}
void move_clumps(Record* body, const Wrench* wrench, std::size_t count, const double gravity[3], double dt) {
  move<false>(body, wrench, count, gravity, dt);
}

template <bool clumps>
CALX_INLINE void look(const Record* __restrict body, const float* __restrict haste, std::size_t count, Survey& out) {
  Four lo = all(1e300), hi = all(-1e300), pace = all(0), squares = all(0);
  for (std::size_t k = 0; k < count; ++k) {
    const Four x = load(&body[k].x), v = load(&body[k].vx), w = load(&body[k].wx);
    lo = lesser(x, lo);
    hi = greater(x, hi);
    Four v2 = v * v;
    const Four w2 = w * w;
    squares += v2 + w2;
    // (|v| + |w| r)^2 <= 2 (v^2 + w^2 r^2), and a fifth for a spin that changes within the step.
    if (clumps) v2 = 2.4 * (v2 + w2 * all(body[k].r * body[k].r));
    pace = greater(v2 * all(haste[k]), pace);
  }
  store(out.lo, lo);
  store(out.hi, hi);
  // Lane by lane the largest, so their sum is not below the largest sum; lane 3 is no velocity.
  out.pace2 = pace[0] + pace[1] + pace[2];
  out.squares = squares[0] + squares[1] + squares[2];
}

void survey(const Record* body, const float* haste, std::size_t count, bool clumps, Survey& out) {
  if (clumps)
    look<true>(body, haste, count, out);
  else
    look<false>(body, haste, count, out);
}

/// Turns q by spin w over dt: Cayley's map, exact to third order in w dt, built from + - * / and sqrt.
CALX_INLINE Quat turned(const Quat& q, const Vec3& w, double dt) {
  const Quat step{1, 0.5 * dt * w.x, 0.5 * dt * w.y, 0.5 * dt * w.z};
  return normalized(step * q);
}

void turn_bodies(std::uint32_t n, TurnTile& t, double dt, double kick, double late_kick) {
#pragma omp simd
  for (std::uint32_t k = 0; k < n; ++k) {
    const Quat q{t.qw[k], t.qx[k], t.qy[k], t.qz[k]};
    const Vec3 i{t.ix[k], t.iy[k], t.iz[k]}, inverse{1 / i.x, 1 / i.y, 1 / i.z};
    const Vec3 w{t.wx[k], t.wy[k], t.wz[k]}, torque{t.tx[k], t.ty[k], t.tz[k]};
    const Vec3 b = rotate(conjugate(q), w);
    const Vec3 l0 = rotate(q, {i.x * b.x, i.y * b.y, i.z * b.z});
    const Vec3 l = l0 + kick * torque;
    const Vec3 b0 = rotate(conjugate(q), l);
    const Quat half = turned(q, rotate(q, {b0.x * inverse.x, b0.y * inverse.y, b0.z * inverse.z}), 0.5 * dt);
    const Vec3 b1 = rotate(conjugate(half), l);
    const Quat now = turned(q, rotate(half, {b1.x * inverse.x, b1.y * inverse.y, b1.z * inverse.z}), dt);
    const Vec3 l1 = l + late_kick * torque;
    const Vec3 b2 = rotate(conjugate(now), l1);
    const Vec3 w1 = rotate(now, {b2.x * inverse.x, b2.y * inverse.y, b2.z * inverse.z});
    t.before[k] = 0.5 * dot(l0, w);
    t.after[k] = 0.5 * dot(l1, w1);
    t.qw[k] = now.w;
    t.qx[k] = now.x;
    t.qy[k] = now.y;
    t.qz[k] = now.z;
    t.wx[k] = w1.x;
    t.wy[k] = w1.y;
    t.wz[k] = w1.z;
  }
}

}  // namespace

extern const StepKernels CALX_KERNELS;
const StepKernels CALX_KERNELS{
    {find<InDouble>, kinematics<InDouble>, read_history<InDouble>, write_history<InDouble>, scatter<InDouble>},
    {find<InMixed>, kinematics<InMixed>, read_history<InMixed>, write_history<InMixed>, scatter<InMixed>},
    thin,
    widen,
    move_spheres,
    move_clumps,
    survey,
    turn_bodies};

}  // namespace calx
