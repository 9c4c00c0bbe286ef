#include "compute/force_text.hpp"

#include <algorithm>

namespace calx {
namespace {

constexpr const char* kHead = R"(
#define CALX_TAKE_ROW(name, unit, lo, hi, preset, flags, doc) row.name = numbers[at++];
/* One force: its numbers from AT on. */
#define CALX_ONE_FORCE(force, AT)                           \
  force##_row_f64 row;                                      \
  u32 at = AT;                                              \
  force##_row_LIST(CALX_TAKE_ROW)                           \
  w.fx = w.fy = w.fz = w.mx = w.my = w.mz = 0.0;            \
  force##_eval_f64(b, &row, &w);                            \
  out->fx += w.fx;                                          \
  out->fy += w.fy;                                          \
  out->fz += w.fz;                                          \
  out->mx += w.mx;                                          \
  out->my += w.my;                                          \
  out->mz += w.mz;

/* Adds the forces of the case on particle b to out. */
FN void calx_particle_forces(const calx_body_f64* b, GLOBAL const double* numbers, calx_wrench_f64* out) {
  calx_wrench_f64 w;
)";

}  // namespace

ForceProgram force_program(const std::vector<ParticleForce>& forces) {
  ForceProgram out;
  out.text = kHead;
  for (const ParticleForce& force : forces) {
    const calx_particle_force& table = *force.table;
    std::string source(table.source, table.source_size);
    if (std::none_of(out.forces.begin(), out.forces.end(), [&](const TextPart& p) { return p.text == source; }))
      out.forces.push_back({force.id, std::move(source)});
    out.text += std::string("  {\n    CALX_ONE_FORCE(") + table.symbol + ", " + std::to_string(out.numbers.size()) +
                "u)\n  }\n";
    std::vector<double> row(table.row_count);
    table.numbers(force.instance, row.data());
    out.numbers.insert(out.numbers.end(), row.begin(), row.end());
  }
  out.text += "}\n";
  return out;
}

std::vector<std::string> forces_without_text(const std::vector<ParticleForce>& forces) {
  std::vector<std::string> ids;
  for (const ParticleForce& force : forces) {
    const calx_particle_force& t = *force.table;
    if (t.source && t.source_size > 0 && t.symbol && t.numbers) continue;
    if (std::find(ids.begin(), ids.end(), force.id) == ids.end()) ids.push_back(force.id);
  }
  return ids;
}

}  // namespace calx
