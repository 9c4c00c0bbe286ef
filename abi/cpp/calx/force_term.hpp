// SPDX-License-Identifier: MIT
// calx/force_term.hpp: optional C++11 helper for a particle force of one text whose parameters are its row of numbers.
// It compiles the text and gives the class calx::ForceTerm.
//
//   #define CALX_TERM lift                                     // symbol of the force
//   #define CALX_TERM_TEXT "lift.law.h"
//   #define CALX_TERM_BYTES "lift.law.h.inc"                   // made by calx_add_plugin(... LAWS ...)
//   #define CALX_TERM_SHA256 "lift.law.h.sha256.inc"
//   #include <calx/force_term.hpp>
//   const calx_descriptor calx::ForceTerm::descriptor = calx::force_term("org.example.lift", "Lift", ...);
//   CALX_PLUGIN(calx::ForceTerm)
#ifndef CALX_FORCE_TERM_HPP
#define CALX_FORCE_TERM_HPP
#include <calx/plugin.hpp>
#include <cstddef>
#include <vector>

#define CALX_TERM_EXPAND(macro, force) macro(force)
#define CALX_TERM_JOIN_(force, name) force##name
#define CALX_TERM_JOIN(force, name) CALX_TERM_JOIN_(force, name)
#define CALX_TERM_TEXT_OF_(force) #force
#define CALX_TERM_TEXT_OF(force) CALX_TERM_TEXT_OF_(force)
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include CALX_TERM_TEXT
#include <calx/law/force_native.h>
CALX_TERM_EXPAND(CALX_FORCE_BATCH, CALX_TERM)

namespace calx {

/// Rows of the table, without its closing row.
constexpr uint32_t force_rows = sizeof(CALX_TERM_JOIN(CALX_TERM, _row_fields)) / sizeof(calx_field) - 1;

class ForceTerm : public Instance {
 public:
  static const calx_descriptor descriptor;

  ForceTerm(const calx_host*, const calx_config& c) : row_(c.value, c.value + force_rows) {}

  const void* get_interface(const char* id) const override {
    static const char source[] = {
#include CALX_TERM_BYTES
    };
    static const char sha256[] =
#include CALX_TERM_SHA256
        ;
    static const calx_particle_force table = {sizeof(calx_particle_force),
                                              CALX_ABI_DRAFT,
                                              &eval,
                                              1,
                                              force_rows,
                                              CALX_TERM_JOIN(CALX_TERM, _row_fields),
                                              CALX_TERM_TEXT_OF(CALX_TERM),
                                              source,
                                              sizeof source - 1,
                                              sha256,
                                              &numbers};
    return std::strcmp(id, CALX_PARTICLE_FORCE) == 0 ? &table : 0;
  }

 private:
  static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) noexcept {
    CALX_TERM_JOIN(CALX_TERM, _batch)(static_cast<const ForceTerm*>(self)->row_.data(), block);
  }
  static void CALX_CALL numbers(const calx_instance* self, double* row) noexcept {
    const std::vector<double>& mine = static_cast<const ForceTerm*>(self)->row_;
    std::memcpy(row, mine.data(), mine.size() * sizeof *row);
  }

  std::vector<double> row_;
};

/// Descriptor of a force whose parameters are the rows of its text.
inline calx_descriptor force_term(const char* id, const char* name, const char* version, const char* vendor,
                                  const char* license, const char* summary) {
  return calx_descriptor{sizeof(calx_descriptor),
                         0,
                         id,
                         CALX_PARTICLE_FORCE,
                         name,
                         version,
                         vendor,
                         license,
                         summary,
                         nullptr,
                         CALX_TERM_JOIN(CALX_TERM, _row_fields),
                         force_rows,
                         0,
                         nullptr};
}

}  // namespace calx
#endif
