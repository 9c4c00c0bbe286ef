// law_kernel.hpp: a kernel that evaluates one law for rows of columns, from the lists of the law's own text.
#pragma once
#include <regex>
#include <string>
#include <vector>

#include "compute/device_text.hpp"

namespace testing {

// in: 15 columns, state: those of the law, out: 10; all with the same stride. Columns the law does not ask for hold
// zero.
constexpr const char* kLawKernel = R"(
#undef ROW_PAIR
#undef ROW_LOAD
#undef ROW_STORE
#undef LAW_ROWS
#define ROW_PAIR(name, unit, lo, hi, preset, flags, doc) p.name = pair[k++];
#define ROW_LOAD(name, unit, lo, hi, preset, flags, doc) s.name = state[stride * k++ + i];
#define ROW_STORE(name, unit, lo, hi, preset, flags, doc) state[stride * k++ + i] = s.name;
#define LAW_ROWS(law)                                                                                            \
  KERNEL(CALX_ID(law##_rows), GLOBAL const real* RESTRICT in, GLOBAL const real* RESTRICT pair,                   \
         GLOBAL real* RESTRICT state, GLOBAL real* RESTRICT out, const u64 stride, const real dt, const u32 n) {  \
    if (ITEM >= n) return;                                                                                       \
    const u64 i = ITEM;                                                                                          \
    u64 k = 0;                                                                                                   \
    CALX_ID(calx_contact) c;                                                                                     \
    CALX_ID(law##_pair) p;                                                                                       \
    CALX_ID(law##_prop) none;                                                                                    \
    CALX_ID(law##_state) s;                                                                                      \
    CALX_ID(calx_wrench) o;                                                                                      \
    c.overlap = in[i];                                                                                           \
    c.nx = in[stride + i]; c.ny = in[2 * stride + i]; c.nz = in[3 * stride + i];                                 \
    c.vx = in[4 * stride + i]; c.vy = in[5 * stride + i]; c.vz = in[6 * stride + i];                             \
    c.wx = in[7 * stride + i]; c.wy = in[8 * stride + i]; c.wz = in[9 * stride + i];                             \
    c.r_eff = in[10 * stride + i]; c.m_eff = in[11 * stride + i];                                                \
    c.r_i = in[12 * stride + i]; c.r_j = in[13 * stride + i]; c.fn_before = in[14 * stride + i];                 \
    c.dt = dt;                                                                                                   \
    c.time = R(0.0);                                                                                             \
    o.fx = o.fy = o.fz = o.mx = o.my = o.mz = R(0.0);                                                            \
    o.elastic = o.friction = o.damping = o.plastic = R(0.0);                                                     \
    none.calx_unused = R(0.0);                                                                                   \
    law##_pair_LIST(ROW_PAIR) k = 0;                                                                             \
    law##_state_LIST(ROW_LOAD)                                                                                   \
    CALX_ID(law##_eval)(&c, &p, &none, &none, &s, &o);                                                           \
    k = 0;                                                                                                       \
    law##_state_LIST(ROW_STORE)                                                                                  \
    out[i] = o.fx; out[stride + i] = o.fy; out[2 * stride + i] = o.fz;                                           \
    out[3 * stride + i] = o.mx; out[4 * stride + i] = o.my; out[5 * stride + i] = o.mz;                          \
    out[6 * stride + i] = o.elastic; out[7 * stride + i] = o.friction;                                           \
    out[8 * stride + i] = o.damping; out[9 * stride + i] = o.plastic;                                            \
  }
)";

/// Names of the laws that a text defines.
inline std::vector<std::string> laws_of(const std::string& text) {
  std::vector<std::string> names;
  const std::regex law("CALX_LAW_EVAL\\((\\w+)\\)");
  for (std::sregex_iterator k(text.begin(), text.end(), law), end; k != end; ++k) names.push_back((*k)[1]);
  return names;
}

/// Kernels NAME_rows_f32 and NAME_rows_f64 for all laws of the texts.
inline calx::ModuleText law_module(const std::vector<calx::TextPart>& texts) {
  calx::ModuleText module;
  module.label = "laws of rows";
  for (const int bits : {64, 32}) {
    module.add_laws(bits, texts);
    module.add("law_kernel.h", kLawKernel);
    std::string kernels;
    for (const calx::TextPart& text : texts)
      for (const std::string& law : laws_of(text.text)) kernels += "LAW_ROWS(" + law + ")\n";
    module.add("kernels", kernels);
  }
  return module;
}

}  // namespace testing
