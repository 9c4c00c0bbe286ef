// law_checks.cpp: numbers of a contact law: blocks, symmetry, frame, edges, threads.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "compute/law_list.hpp"
#include "conformance/checks.hpp"
#include "conformance/law_rig.hpp"

namespace calx::conformance {
namespace {

constexpr std::size_t kRows = 300;

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
bool same(const Evaluated& a, const Evaluated& b) { return same_bits(a.out, b.out) && same_bits(a.state, b.state); }

/// Contacts and a history that some steps have written, so that more than new contacts is tried.
struct Worn {
  std::vector<Contact> rows;
  std::vector<double> state;
};
Worn worn(Subject& s, const LawRig& rig, std::size_t count) {
  Worn out{rig.contacts(s, count), rig.fresh(count)};
  // What is apart now has touched before.
  std::vector<Contact> before = out.rows;
  for (Contact& row : before) row.in[CALX_IN_OVERLAP] = std::fabs(row.in[CALX_IN_OVERLAP]);
  for (int k = 0; k < 4; ++k) out.state = rig.evaluate<double>(before, out.state).state;
  out.state = rig.evaluate<double>(out.rows, out.state).state;
  return out;
}

std::string finite(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    std::vector<Contact> rows;
    const double r = LawRig::radius;
    for (const double overlap : {1e-30, 1e-15, 1e-9 * r, 1e-3 * r, 0.9 * r})
      for (const double speed : {0.0, 1e-12, 1e-3, 100.0})
        for (const double r_j : {0.0, r, 1e-3 * r})
          for (const double ratio : {1.0, 1e-6}) {
            Contact row;
            const double in[CALX_IN_COUNT] = {overlap,
                                              0,
                                              0,
                                              1,
                                              speed,
                                              0,
                                              -speed,
                                              speed,
                                              speed,
                                              0,
                                              r_j > 0 ? r * r_j / (r + r_j) : r,
                                              rig.mass() * ratio,
                                              r,
                                              r_j,
                                              0};
            std::memcpy(row.in, in, sizeof in);
            rows.push_back(row);
          }
    std::vector<double> state = rig.fresh(rows.size());
    for (int k = 0; k < 3; ++k) {
      for (const bool single : {false, true}) {
        if (single && !rig.table().eval_f32) continue;
        const Evaluated e = single ? rig.evaluate<float>(rows, state) : rig.evaluate<double>(rows, state);
        for (std::size_t row = 0; row < rows.size(); ++row) {
          bool good = true;
          for (std::size_t c = 0; c < CALX_OUT_COUNT; ++c)
            good = good && std::isfinite(e.out[row * CALX_OUT_COUNT + c]);
          for (std::size_t c = 0; c < rig.table().state_count; ++c)
            good = good && std::isfinite(e.state[row * rig.table().state_count + c]);
          const Contact& at = rows[row];
          require(good, rig.name() + ": a number that is not finite, in " + (single ? "single" : "double") +
                            " precision, at overlap " + short_number(at.in[CALX_IN_OVERLAP]) + " m, speed " +
                            short_number(at.in[CALX_IN_VX]) + " m/s, r_j " + short_number(at.in[CALX_IN_R_J]) +
                            " m, m_eff " + short_number(at.in[CALX_IN_M_EFF]) + " kg");
        }
        if (!single) state = e.state;
      }
      std::reverse(rows.begin(), rows.end());  // each history meets another overlap
    }
  }
  return variants_text(all.size());
}

std::string blocks(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    const Worn w = worn(s, rig, kRows);
    const Evaluated whole = rig.evaluate<double>(w.rows, w.state, {kRows, true, -1});
    for (const std::size_t n : {1, 7, 16, 64, 256})
      require(same(rig.evaluate<double>(w.rows, w.state, {n, true, -1}), whole),
              rig.name() + ": blocks of " + std::to_string(n) + " rows give other bits than one of 300");
    Worn turned = w;
    std::reverse(turned.rows.begin(), turned.rows.end());
    const std::size_t states = rig.table().state_count;
    for (std::size_t r = 0; r < kRows; ++r)
      std::copy_n(w.state.begin() + static_cast<std::ptrdiff_t>((kRows - 1 - r) * states), states,
                  turned.state.begin() + static_cast<std::ptrdiff_t>(r * states));
    const Evaluated back = rig.evaluate<double>(turned.rows, turned.state, {kRows, true, -1});
    for (std::size_t r = 0; r < kRows; ++r)
      require(std::memcmp(&back.out[r * CALX_OUT_COUNT], &whole.out[(kRows - 1 - r) * CALX_OUT_COUNT],
                          CALX_OUT_COUNT * sizeof(double)) == 0,
              rig.name() + ": the order of rows changes bits");
    Evaluated without = rig.evaluate<double>(w.rows, w.state, {kRows, false, -1});
    for (std::size_t r = 0; r < kRows; ++r)
      require(std::memcmp(&without.out[r * CALX_OUT_COUNT], &whole.out[r * CALX_OUT_COUNT], 6 * sizeof(double)) == 0,
              rig.name() + ": forces depend on whether energies are asked for");
    require(same_bits(without.state, whole.state), rig.name() + ": history depends on whether energies are asked for");
    if (rig.table().eval_f32)
      require(same(rig.evaluate<float>(w.rows, w.state, {33, true, -1}), rig.evaluate<float>(w.rows, w.state)),
              rig.name() + ": the size of blocks changes bits in single precision");
  }
  return variants_text(all.size());
}

std::string single(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    if (!rig.table().eval_f32) throw Failed{"there is no eval_f32: mixed precision and its devices are closed to it"};
    const Worn w = worn(s, rig, kRows);
    const Evaluated d = rig.evaluate<double>(w.rows, w.state), f = rig.evaluate<float>(w.rows, w.state);
    // A contact at the edge of sliding may take the other side of a choice: 2 % of the rows may.
    std::size_t far = 0;
    for (std::size_t r = 0; r < kRows; ++r) {
      double size = 0, error = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = d.out[r * CALX_OUT_COUNT + c], y = f.out[r * CALX_OUT_COUNT + c];
        size += x * x;
        error += (x - y) * (x - y);
      }
      // Inputs and some forty operations round to 6e-8 each; cancellation of spring and dashpot takes a digit or two.
      far += std::sqrt(error) > 1e-4 * std::sqrt(size) + 1e-9;
    }
    require(far <= kRows / 50, rig.name() + ": " + std::to_string(far) + " of " + std::to_string(kRows) +
                                   " contacts differ by more than 1e-4 between single and double precision");
  }
  return variants_text(all.size());
}

std::string swap(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    Worn w = worn(s, rig, kRows);
    w.rows.erase(std::remove_if(w.rows.begin(), w.rows.end(), [](const Contact& c) { return c.in[CALX_IN_R_J] <= 0; }),
                 w.rows.end());  // a wall is always j
    std::vector<Contact> other = w.rows;
    for (Contact& row : other) {
      for (int c = CALX_IN_NX; c <= CALX_IN_WZ; ++c) row.in[c] = -row.in[c];
      std::swap(row.in[CALX_IN_R_I], row.in[CALX_IN_R_J]);
    }
    const std::size_t states = rig.table().state_count;
    Evaluated a, b;
    a.state = rig.fresh(w.rows.size());
    b.state = a.state;
    for (std::size_t k = 0; k < b.state.size(); ++k)
      if (rig.law().is_odd(static_cast<std::uint32_t>(k % states))) b.state[k] = -b.state[k];
    for (int step = 0; step < 20; ++step) {
      a = rig.evaluate<double>(w.rows, a.state);
      b = rig.evaluate<double>(other, b.state);
      for (std::size_t k = 0; k < a.out.size(); ++k) {
        const bool energy = k % CALX_OUT_COUNT >= CALX_OUT_ELASTIC;
        require(a.out[k] == (energy ? b.out[k] : -b.out[k]),
                rig.name() + ": trading i and j does not just turn the " + (energy ? "energies" : "wrench") + ": " +
                    short_number(a.out[k]) + " and " + short_number(b.out[k]) +
                    "; forces must depend on n, v, w as odd functions and treat both radii alike");
      }
      for (std::size_t k = 0; k < a.state.size(); ++k) {
        const auto column = static_cast<std::uint32_t>(k % states);
        require(a.state[k] == (rig.law().is_odd(column) ? -b.state[k] : b.state[k]),
                rig.name() + ": history \"" + rig.table().state[column].name + "\" does not " +
                    (rig.law().is_odd(column) ? "change sign, though it is CALX_FIELD_ODD"
                                              : "stay when i and j trade places; is it CALX_FIELD_ODD?"));
      }
    }
  }
  return variants_text(all.size());
}

Vec3 turned(const Vec3& v) {
  // By a fixed unit quaternion.
  const double w = 0.5, x = -0.1, y = 0.7;
  const Vec3 u{x, y, std::sqrt(1 - w * w - x * x - y * y)};
  const Vec3 t = 2.0 * cross(u, v);
  return v + w * t + cross(u, t);
}

std::string rotation(Subject& s) {
  const auto all = rigs(s);
  double worst = 0;
  for (const LawRig& rig : all) {
    const std::vector<Contact> rows = rig.contacts(s, kRows);
    std::vector<Contact> other = rows;
    for (Contact& row : other)
      for (const int c : {CALX_IN_NX, CALX_IN_VX, CALX_IN_WX}) {
        const Vec3 v = turned({row.in[c], row.in[c + 1], row.in[c + 2]});
        row.in[c] = v.x;
        row.in[c + 1] = v.y;
        row.in[c + 2] = v.z;
      }
    Evaluated a, b;
    a.state = b.state = rig.fresh(kRows);
    for (int step = 0; step < 3; ++step) {
      a = rig.evaluate<double>(rows, a.state);
      b = rig.evaluate<double>(other, b.state);
      for (std::size_t r = 0; r < kRows; ++r) {
        const double* p = &a.out[r * CALX_OUT_COUNT];
        const double* q = &b.out[r * CALX_OUT_COUNT];
        const double size = norm(Vec3{p[0], p[1], p[2]}) + 1e-12;
        for (const int c : {CALX_OUT_FX, CALX_OUT_MX}) {
          const double scale = c == CALX_OUT_FX ? size : size * LawRig::radius;
          worst = std::max(worst, norm(turned({p[c], p[c + 1], p[c + 2]}) - Vec3{q[c], q[c + 1], q[c + 2]}) / scale);
        }
      }
      // Rounding of some hundred operations; a component kept in a fixed direction gives errors of order one.
      require(worst < 1e-11, rig.name() + ": turning all inputs turns the wrench with a relative error of " +
                                 short_number(worst) +
                                 "; is a direction fixed in it, or a history vector not CALX_VEC?");
    }
    for (std::uint32_t k = 0; k < rig.table().state_count; ++k)
      if (rig.law().vector_group(k) && (k == 0 || rig.law().vector_group(k - 1) != rig.law().vector_group(k)))
        for (std::size_t r = 0; r < kRows; ++r) {
          const double* p = &a.state[r * rig.table().state_count + k];
          const double* q = &b.state[r * rig.table().state_count + k];
          const double size = norm(Vec3{p[0], p[1], p[2]});
          require(norm(turned({p[0], p[1], p[2]}) - Vec3{q[0], q[1], q[2]}) <= 1e-9 * size + 1e-300,
                  rig.name() + ": history \"" + rig.table().state[k].name + "\" does not turn with the inputs");
        }
  }
  return variants_text(all.size()) + ", largest relative error " + short_number(worst);
}

std::string no_time(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    const Worn w = worn(s, rig, kRows);
    const Evaluated once = rig.evaluate<double>(w.rows, w.state, {256, true, 0});
    const Evaluated twice = rig.evaluate<double>(w.rows, once.state, {256, true, 0});
    for (std::size_t k = 0; k < once.state.size(); ++k) {
      const std::uint32_t column = static_cast<std::uint32_t>(k % rig.table().state_count);
      require(std::isfinite(once.state[k]) &&
                  std::fabs(twice.state[k] - once.state[k]) <= 1e-9 * std::fabs(once.state[k]) + 1e-300,
              rig.name() + ": with dt = 0 history \"" + rig.table().state[column].name +
                  "\" goes on changing; it may be carried into the contact plane and cut to its limit, once");
    }
    for (const double x : once.out) require(std::isfinite(x), rig.name() + ": with dt = 0 an output is not finite");
  }
  return variants_text(all.size());
}

std::string reach(Subject& s) {
  const auto all = rigs(s);
  bool any = false;
  for (const LawRig& rig : all) {
    if (!rig.law().acts_apart()) continue;
    any = true;
    for (const double ri : {0.5e-3, 1e-3, 2e-3}) {
      const double gap = rig.law().reach(rig.pair(), ri, LawRig::radius);
      std::vector<Contact> rows = rig.contacts(s, 64);
      for (Contact& row : rows) {
        row.in[CALX_IN_OVERLAP] = -gap * 1.0001 - 1e-12;
        row.in[CALX_IN_R_I] = ri;
        row.in[CALX_IN_R_J] = LawRig::radius;
        row.in[CALX_IN_R_EFF] = ri * LawRig::radius / (ri + LawRig::radius);
      }
      std::vector<double> state = worn(s, rig, 64).state;
      const Evaluated e = rig.evaluate<double>(rows, state);
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < 6; ++c)
          require(e.out[r * CALX_OUT_COUNT + c] == 0,
                  rig.name() + ": a wrench beyond its reach of " + short_number(gap) + " m");
      const std::vector<double> fresh = rig.fresh(rows.size());
      for (std::size_t k = 0; k < fresh.size(); ++k) {
        const calx_field& column = rig.table().state[k % rig.table().state_count];
        require(!(column.flags & CALX_FIELD_KEEP_APART) || e.state[k] == fresh[k],
                rig.name() + ": beyond its reach of " + short_number(gap) + " m history \"" + column.name +
                    "\" is not that of a new contact");
      }
      const double wider = rig.law().reach(rig.pair(), 1.5 * ri, LawRig::radius);
      require(wider >= gap, rig.name() + ": its reach falls from " + short_number(gap) + " to " + short_number(wider) +
                                " m when a radius grows");
    }
  }
  if (!any) throw Skipped{"it acts only while touching"};
  return "";
}

void CALX_CALL eval_nothing(const calx_block_f64* block) {
  for (std::uint32_t k = 0; k < CALX_OUT_COUNT; ++k)
    for (std::uint32_t r = 0; block->out[k] && r < block->count; ++r) block->out[k][r] = 0;
}

std::string in_a_list(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    calx_contact_law nothing{};
    nothing.eval_f64 = eval_nothing;
    LawTerm own, zero;
    own.table = &rig.table();
    own.pair_row = rig.pair();
    zero.table = &nothing;
    const Worn w = worn(s, rig, 200);
    std::vector<std::vector<double>> results;
    for (const std::vector<LawTerm>& terms :
         {std::vector<LawTerm>{own}, std::vector<LawTerm>{own, zero}, std::vector<LawTerm>{zero, own}}) {
      LawList list;
      list.terms = terms;
      list.state_count = rig.table().state_count;
      BlockScratch scratch(std::max(1u, list.state_count));
      scratch.count = 200;
      for (std::uint32_t r = 0; r < 200; ++r) {
        for (int k = 0; k < CALX_IN_COUNT; ++k) scratch.in(k)[r] = w.rows[r].in[k];
        for (std::uint32_t k = 0; k < list.state_count; ++k) scratch.state(k)[r] = w.state[r * list.state_count + k];
      }
      evaluate_block(list, scratch, rig.dt(), 0, false);
      std::vector<double> result;
      for (int k = 0; k < 6; ++k) result.insert(result.end(), scratch.out(k), scratch.out(k) + 200);
      for (std::uint32_t k = 0; k < list.state_count; ++k)
        result.insert(result.end(), scratch.state(k), scratch.state(k) + 200);
      results.push_back(result);
    }
    if (rig.table().prop_count) throw Skipped{"it reads particle columns, which lists do not bring"};
    for (std::size_t k = 1; k < results.size(); ++k)
      for (std::size_t n = 0; n < results[0].size(); ++n)
        require(results[k][n] == results[0][n],
                rig.name() + ": in a list with a term of no force it gives other numbers");
  }
  return variants_text(all.size());
}

std::string threads(Subject& s) {
  const auto all = rigs(s);
  for (const LawRig& rig : all) {
    const Worn w = worn(s, rig, kRows);
    const Evaluated alone = rig.evaluate<double>(w.rows, w.state);
    std::vector<int> good(16, 0);
    std::vector<std::thread> crew;
    for (std::size_t t = 0; t < good.size(); ++t)
      crew.emplace_back([&, t] {
        good[t] = 1;
        for (int k = 0; k < 20; ++k) good[t] = good[t] && same(rig.evaluate<double>(w.rows, w.state), alone);
      });
    for (std::thread& thread : crew) thread.join();
    for (const int one : good)
      require(one, rig.name() + ": 16 threads at once get other bits than one; is a variable shared?");
  }
  return variants_text(all.size());
}

std::string throughput(Subject& s) {
  const LawRig rig = rigs(s).front();
  const std::uint32_t states = rig.table().state_count;
  LawList list;
  list.terms.resize(1);
  list.terms[0].table = &rig.table();
  list.terms[0].pair_row = rig.pair();
  list.state_count = states;
  if (rig.table().prop_count) throw Skipped{"it reads particle columns"};
  BlockScratch scratch(std::max(1u, states));
  const std::vector<Contact> rows = rig.contacts(s, kBlockRows);
  const std::vector<double> state = rig.fresh(kBlockRows);
  scratch.count = kBlockRows;
  for (std::uint32_t r = 0; r < kBlockRows; ++r) {
    for (int k = 0; k < CALX_IN_COUNT; ++k) scratch.in(k)[r] = rows[r].in[k];
    for (std::uint32_t k = 0; k < states; ++k) scratch.state(k)[r] = state[r * states + k];
  }
  double best = 1e9;
  for (int k = 0; k < 5; ++k) {
    timespec before{}, after{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
    for (int n = 0; n < 100; ++n) evaluate_block(list, scratch, rig.dt(), 0, false);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
    best = std::min(best, static_cast<double>(after.tv_sec - before.tv_sec) * 1e9 +
                              static_cast<double>(after.tv_nsec - before.tv_nsec));
  }
  return short_number(best / (100.0 * kBlockRows)) + " ns of processor time a contact, best of five";
}

}  // namespace

std::vector<Check> law_checks() {
  constexpr const char* kind = CALX_CONTACT_LAW;
  return {{"finite", "Outputs and history are finite for zero and huge overlaps, speeds and mass ratios.", kind, false,
           finite},
          {"blocks",
           "Size of blocks, order of rows and energy columns change no bit; nothing outside of the rows is written.",
           kind, true, blocks},
          {"single-precision", "Single precision stays near double.", kind, true, single},
          {"swap", "Trading i and j turns wrench and odd history exactly.", kind, true, swap},
          {"rotation", "Turned inputs give turned outputs.", kind, true, rotation},
          {"no-time", "With dt = 0 history is only carried into the contact plane.", kind, true, no_time},
          {"reach", "Beyond its reach there is no wrench and history is new.", kind, true, reach},
          {"in-a-list", "Alone and beside a term of no force it gives the same numbers.", kind, true, in_a_list},
          {"law-threads", "16 threads at once get the bits of one.", kind, true, threads},
          {"throughput", "Time a contact, for information.", kind, false, throughput}};
}

}  // namespace calx::conformance
