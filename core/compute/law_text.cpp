#include "compute/law_text.hpp"

#include <algorithm>

namespace calx {
namespace {

constexpr const char* kMacros = R"(
#ifndef CALX_ONE_LAW
#define CALX_TAKE_PAIR(name, unit, lo, hi, preset, flags, doc) pair.name = (real)numbers[at++];
#define CALX_TAKE_STATE(name, unit, lo, hi, preset, flags, doc)        \
  state.name = (real)(starts ? numbers[at] : history[(u64)k * stride]); \
  ++at;                                                               \
  ++k;
#define CALX_GIVE_STATE(name, unit, lo, hi, preset, flags, doc) history[(u64)(k++) * stride] = state.name;
/* One law of a list: numbers from AT on, history from column STATE on, read and written by TAKE and GIVE. */
#define CALX_ONE_LAW(law, AT, STATE, TAKE, GIVE)                                                      \
  CALX_ID(law##_pair) pair;                                                                           \
  CALX_ID(law##_prop) prop;                                                                           \
  CALX_ID(law##_state) state;                                                                         \
  u32 at = AT, k = STATE;                                                                             \
  prop.calx_unused = R(0.0);                                                                          \
  law##_pair_LIST(CALX_TAKE_PAIR) law##_state_LIST(TAKE)                                              \
  w.fx = w.fy = w.fz = w.mx = w.my = w.mz = R(0.0);                                                   \
  w.elastic = w.friction = w.damping = w.plastic = R(0.0);                                            \
  CALX_ID(law##_eval)(c, &pair, &prop, &prop, &state, &w);                                            \
  at -= k - STATE; /* back to the presets of its history */                                           \
  k = STATE;                                                                                          \
  law##_state_LIST(GIVE)
#endif

/* The laws of list number `list` for the contact c, whose fn_before is set here. history: of the contact, columns
 * `stride` apart; starts: it did not touch at the last step. Returns 0 for a list that the case does not give. */
FN u32 CALX_ID(calx_contact_laws)(u32 list, CALX_ID(calx_contact) * c, GLOBAL double* history, u64 stride, u32 starts,
                                  GLOBAL const double* numbers, CALX_ID(calx_wrench) * out) {
  CALX_ID(calx_wrench) w;
)";

/// For lists that reach, see evaluate_block: history that does not survive separation is as new in rows apart.
constexpr const char* kApartMacros = R"(
#ifndef CALX_IS_NEW
#define CALX_IS_NEW(flags) (apart && !((flags) & CALX_FIELD_KEEP_APART))
#define CALX_TAKE_APART(name, unit, lo, hi, preset, flags, doc)                              \
  state.name = (real)(starts || CALX_IS_NEW(flags) ? numbers[at] : history[(u64)k * stride]); \
  ++at;                                                                                      \
  ++k;
#define CALX_GIVE_APART(name, unit, lo, hi, preset, flags, doc)                          \
  history[(u64)k * stride] = (double)(CALX_IS_NEW(flags) ? (real)numbers[at] : state.name); \
  ++at;                                                                                  \
  ++k;
#endif
)";
constexpr const char* kDrop = R"(      if (apart) {
        w.fx = w.fy = w.fz = w.mx = w.my = w.mz = R(0.0);
        w.elastic = w.friction = w.damping = w.plastic = R(0.0);
      }
)";

constexpr const char* kAdd = R"(      out->fx += w.fx;
      out->fy += w.fy;
      out->fz += w.fz;
      out->mx += w.mx;
      out->my += w.my;
      out->mz += w.mz;
      out->elastic += w.elastic;
      out->friction += w.friction;
      out->damping += w.damping;
      out->plastic += w.plastic;
)";

std::string number(std::size_t n) { return std::to_string(n) + "u"; }

/// Flags that stand in the lists of a law text.
std::string field_flags() {
  std::string text;
  const auto define = [&](const char* name, std::size_t value) {
    text += std::string("#undef ") + name + "\n#define " + name + " " + number(value) + "\n";
  };
  define("CALX_FIELD_INTEGER", CALX_FIELD_INTEGER);
  define("CALX_FIELD_ODD", CALX_FIELD_ODD);
  define("CALX_FIELD_KEEP_APART", CALX_FIELD_KEEP_APART);
  define("CALX_FIELD_ACCUMULATE", CALX_FIELD_ACCUMULATE);
  return text + "#undef CALX_VEC\n#define CALX_VEC(group) 0u\n" + kApartMacros;
}

}  // namespace

LawProgram law_program(const std::vector<const LawList*>& laws) {
  LawProgram out;
  for (const LawList* list : laws) out.reaches = out.reaches || (list && list->reaches);
  out.text = (out.reaches ? field_flags() : "") + kMacros;
  std::vector<const LawList*> lists;
  for (const LawList* list : laws) {
    if (!list) {
      out.law_of.push_back(LawProgram::kNoLaw);
      continue;
    }
    const auto found = std::find(lists.begin(), lists.end(), list);
    out.law_of.push_back(static_cast<std::uint32_t>(found - lists.begin()));
    if (found != lists.end()) continue;
    out.text += "  if (list == " + number(lists.size()) + ") {\n";
    if (list->reaches) out.text += "    const u32 apart = !(c->overlap > R(0.0));\n";
    lists.push_back(list);
    for (std::size_t t = 0; t < list->terms.size(); ++t) {
      const LawTerm& term = list->terms[t];
      std::string source(term.table->source, term.table->source_size);
      if (std::none_of(out.laws.begin(), out.laws.end(), [&](const TextPart& p) { return p.text == source; }))
        out.laws.push_back({term.id, std::move(source)});
      const char* before = t == 0 ? "R(0.0)" : "out->fx * c->nx + out->fy * c->ny + out->fz * c->nz";
      out.text += std::string("    {\n      c->fn_before = ") + before + ";\n      CALX_ONE_LAW(" + term.table->symbol +
                  ", " + number(out.numbers.size()) + ", " + number(term.state_offset) +
                  (list->reaches ? ", CALX_TAKE_APART, CALX_GIVE_APART)\n" : ", CALX_TAKE_STATE, CALX_GIVE_STATE)\n");
      if (list->reaches && !term.table->reach) out.text += kDrop;
      out.text += t == 0 ? "      *out = w;\n" : kAdd;
      out.text += "    }\n";
      out.numbers.insert(out.numbers.end(), term.pair_row.begin(), term.pair_row.end());
      const auto preset = list->preset.begin() + term.state_offset;
      out.numbers.insert(out.numbers.end(), preset, preset + term.table->state_count);
    }
    out.text += "    return 1;\n  }\n";
  }
  out.text += "  return 0;\n}\n";
  return out;
}

std::vector<std::string> laws_without_text(const std::vector<const LawList*>& laws) {
  std::vector<std::string> ids;
  for (const LawList* list : laws)
    for (std::size_t t = 0; list && t < list->terms.size(); ++t) {
      const LawTerm& term = list->terms[t];
      if (term.table->source && term.table->source_size > 0 && term.table->symbol) continue;
      if (std::find(ids.begin(), ids.end(), term.id) == ids.end()) ids.push_back(term.id);
    }
  return ids;
}

}  // namespace calx
