// SPDX-License-Identifier: MIT
// calx/law_term.hpp: optional C++11 helper for a contact law of one text whose parameters are its pair row: a term that
// stands after others in a law list. It compiles the text in both precisions and gives the class calx::LawTerm.
//
//   #define CALX_TERM adhesion                                 // symbol of the law
//   #define CALX_TERM_TEXT "adhesion.law.h"
//   #define CALX_TERM_BYTES "adhesion.law.h.inc"               // made by calx_add_plugin(... LAWS ...)
//   #define CALX_TERM_SHA256 "adhesion.law.h.sha256.inc"
//   #include <calx/law_term.hpp>
//   const calx_descriptor calx::LawTerm::descriptor = calx::law_term("org.example.adhesion", "Adhesion", ...);
//   CALX_PLUGIN(calx::LawTerm)
#ifndef CALX_LAW_TERM_HPP
#define CALX_LAW_TERM_HPP
#include <calx/plugin.hpp>

#define CALX_TERM_EXPAND(macro, law) macro(law)
#define CALX_BITS 32
#include <calx/law/prelude.h>
#include <calx/law/rolling.h>
#include <calx/law/sliding.h>
#include CALX_TERM_TEXT
#include <calx/law/native.h>
CALX_TERM_EXPAND(CALX_LAW_BATCH, CALX_TERM)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include <calx/law/rolling.h>
#include <calx/law/sliding.h>
#include CALX_TERM_TEXT
#include <calx/law/native.h>
CALX_TERM_EXPAND(CALX_LAW_BATCH, CALX_TERM)
CALX_TERM_EXPAND(CALX_LAW_TABLES, CALX_TERM)

namespace calx {

class LawTerm : public Instance {
 public:
  static const calx_descriptor descriptor;

  LawTerm(const calx_host*, const calx_config&) {
    static const char source[] = {
#include CALX_TERM_BYTES
    };
    static const char sha256[] =
#include CALX_TERM_SHA256
        ;
    std::memset(&table_, 0, sizeof table_);
#define CALX_TERM_FILL(law) CALX_LAW_FILL(table_, law)
    CALX_TERM_EXPAND(CALX_TERM_FILL, CALX_TERM);
#undef CALX_TERM_FILL
    table_.flags = CALX_LAW_EXACT;
    table_.given = table_.pair;
    table_.given_count = table_.pair_count;
    table_.source = source;
    table_.source_size = sizeof source - 1;
    table_.source_sha256 = sha256;
  }

  const void* get_interface(const char* id) const override {
    return std::strcmp(id, CALX_CONTACT_LAW) == 0 ? &table_ : 0;
  }

 protected:
  calx_contact_law table_;  // for what a law derived from this one adds
};

/// Descriptor of a term; it has no options.
constexpr calx_descriptor law_term(const char* id, const char* name, const char* version, const char* vendor,
                                   const char* license, const char* summary) {
  return calx_descriptor{sizeof(calx_descriptor),
                         0,
                         id,
                         CALX_CONTACT_LAW,
                         name,
                         version,
                         vendor,
                         license,
                         summary,
                         nullptr,
                         nullptr,
                         0,
                         0,
                         nullptr};
}

}  // namespace calx
#endif
