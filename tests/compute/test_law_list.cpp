// A block through a list of laws written here: what each law sees, and how their outputs add.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "compute/law_list.hpp"

using namespace calx;

namespace {

std::vector<calx_block_f64> seen;  // of each evaluation, pointers as the law saw them

/// f = pair[0] overlap n, one history column counting evaluations; energy columns when asked.
void CALX_CALL spring(const calx_block_f64* b) {
  seen.push_back(*b);
  for (std::uint32_t k = 0; k < b->count; ++k) {
    const double f = b->pair[0] * b->in[CALX_IN_OVERLAP][k];
    for (int d = 0; d < 3; ++d) b->out[d][k] = f * b->in[CALX_IN_NX + d][k];
    for (int d = 3; d < 6; ++d) b->out[d][k] = b->pair[0] * d;
    b->state[k] += 1;
    if (!b->out[CALX_OUT_ELASTIC]) continue;
    for (int d = 6; d < 10; ++d) b->out[d][k] = b->pair[0] * d;
  }
}

/// f = pair[0] times the normal force of the laws before it; two history columns.
void CALX_CALL follower(const calx_block_f64* b) {
  seen.push_back(*b);
  for (std::uint32_t k = 0; k < b->count; ++k) {
    for (int d = 0; d < 3; ++d) b->out[d][k] = b->pair[0] * b->in[CALX_IN_FN_BEFORE][k] * b->in[CALX_IN_NX + d][k];
    for (int d = 3; d < 6; ++d) b->out[d][k] = 0;
    b->state[k] += 10;
    b->state[b->stride + k] += 100;
    if (!b->out[CALX_OUT_ELASTIC]) continue;
    for (int d = 6; d < 10; ++d) b->out[d][k] = 1;
  }
}

/// f = pair[0] sqrt(overlap), no number where the spheres do not touch; one history column.
void CALX_CALL root(const calx_block_f64* b) {
  seen.push_back(*b);
  for (std::uint32_t k = 0; k < b->count; ++k) {
    for (int d = 0; d < 10; ++d)
      if (b->out[d]) b->out[d][k] = b->pair[0] * std::sqrt(b->in[CALX_IN_OVERLAP][k]);
    b->state[k] *= 2;
  }
}
double CALX_CALL millimetre(const double* pair, double r_i, double) { return pair[0] * r_i; }

constexpr std::uint32_t kNormal = 7u << CALX_IN_NX;

struct Bench {
  calx_contact_law spring_table{}, follower_table{};
  LawList list;
  BlockScratch scratch{4};

  Bench() {
    seen.clear();
    spring_table.needs = 1u << CALX_IN_OVERLAP | kNormal;
    spring_table.eval_f64 = &spring;
    follower_table.needs = kNormal | 1u << CALX_IN_FN_BEFORE;
    follower_table.eval_f64 = &follower;
  }
  void add(const calx_contact_law& table, double parameter, std::uint32_t columns) {
    LawTerm term;
    term.table = &table;
    term.pair_row = {parameter};
    term.state_offset = list.state_count;
    list.state_count += columns;
    list.needs |= table.needs;
    list.terms.push_back(term);
  }
  void fill(std::uint32_t n) {
    scratch.count = n;
    for (std::uint32_t k = 0; k < n; ++k) {
      scratch.in(CALX_IN_OVERLAP)[k] = 1e-6 * (k + 1);
      scratch.in(CALX_IN_NX)[k] = 0.6;
      scratch.in(CALX_IN_NY)[k] = 0;
      scratch.in(CALX_IN_NZ)[k] = -0.8;
      for (std::uint32_t s = 0; s < 4; ++s) scratch.state(s)[k] = s;
    }
  }
};

}  // namespace

TEST_CASE("a law sees the columns it asks for and null for the others, its own pair row and time") {
  Bench b;
  b.add(b.spring_table, 3, 1);
  b.fill(5);
  evaluate_block(b.list, b.scratch, 1e-6, 0.25, false);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].count == 5);
  CHECK(seen[0].dt == 1e-6);
  CHECK(seen[0].time == 0.25);
  CHECK(seen[0].stride == kBlockStride);
  CHECK(seen[0].struct_size == sizeof(calx_block_f64));
  CHECK(seen[0].in[CALX_IN_OVERLAP] == b.scratch.in(CALX_IN_OVERLAP));
  CHECK(seen[0].in[CALX_IN_VX] == nullptr);
  CHECK(seen[0].in[CALX_IN_FN_BEFORE] == nullptr);
  CHECK(seen[0].out[CALX_OUT_ELASTIC] == nullptr);
  CHECK(seen[0].pair[0] == 3);
  CHECK(b.scratch.out(CALX_OUT_FX)[4] == doctest::Approx(9e-6).scale(0).epsilon(1e-14));
  CHECK(b.scratch.out(CALX_OUT_MY)[4] == 12);
  CHECK(b.scratch.state(0)[4] == 1);
  CHECK(b.scratch.state(1)[4] == 1);
}

TEST_CASE("wrenches and energies of a list add, and each law has its own pair row and history") {
  Bench b;
  b.add(b.spring_table, 3, 1);
  b.add(b.follower_table, 0.5, 2);
  b.add(b.spring_table, -1, 1);
  b.fill(kBlockRows);
  evaluate_block(b.list, b.scratch, 1e-6, 0, true);
  REQUIRE(seen.size() == 3);
  for (std::uint32_t k = 0; k < kBlockRows; ++k) {
    const double o = 1e-6 * (k + 1), f = 3 * o + 0.5 * 3 * o - o;
    CHECK(b.scratch.out(CALX_OUT_FX)[k] == doctest::Approx(0.6 * f).scale(0).epsilon(1e-14));
    CHECK(b.scratch.out(CALX_OUT_FZ)[k] == doctest::Approx(-0.8 * f).scale(0).epsilon(1e-14));
    CHECK(b.scratch.out(CALX_OUT_MX)[k] == 6);
    CHECK(b.scratch.out(CALX_OUT_PLASTIC)[k] == 19);
    CHECK(b.scratch.state(0)[k] == 1);
    CHECK(b.scratch.state(1)[k] == 11);
    CHECK(b.scratch.state(2)[k] == 102);
    CHECK(b.scratch.state(3)[k] == 4);
  }
}

TEST_CASE("a law that reads the force before it reads 0 when it comes first") {
  Bench b;
  b.add(b.follower_table, 0.5, 2);
  b.fill(3);
  for (int k = 0; k < 3; ++k) b.scratch.in(CALX_IN_FN_BEFORE)[k] = 7;
  evaluate_block(b.list, b.scratch, 1e-6, 0, false);
  for (int k = 0; k < 3; ++k) CHECK(b.scratch.out(CALX_OUT_FX)[k] == 0);
}

TEST_CASE("columns of a block stand on cache lines and hold finite numbers beyond the count") {
  Bench b;
  for (int k = 0; k < CALX_IN_COUNT; ++k) {
    CHECK(reinterpret_cast<std::uintptr_t>(b.scratch.in(k)) % 64 == 0);
    CHECK(b.scratch.in(k)[kBlockStride - 1] == 0);
  }
  CHECK(reinterpret_cast<std::uintptr_t>(b.scratch.state(3)) % 64 == 0);
  CHECK(b.scratch.state(3)[kBlockStride - 1] == 0);
}

TEST_CASE("rows apart: terms without reach do nothing, history without CALX_FIELD_KEEP_APART is as new") {
  Bench b;
  calx_contact_law root_table = b.spring_table, wide_table = b.follower_table;
  root_table.eval_f64 = &root;
  root_table.state_count = 1;
  wide_table.reach = &millimetre;
  wide_table.state_count = 2;
  b.add(root_table, 3, 1);
  b.add(wide_table, 0.5, 2);
  b.list.reaches = true;
  b.list.preset = {7, 0, 5};
  b.list.keep = {0, 1, 0};
  b.fill(40);
  for (std::uint32_t k = 0; k < 40; ++k) {
    if (k % 2) b.scratch.in(CALX_IN_OVERLAP)[k] *= -1;
    for (std::uint32_t s = 0; s < 3; ++s) b.scratch.state(s)[k] = 20 + 10 * s;
  }
  evaluate_block(b.list, b.scratch, 1e-6, 0, true);
  for (std::uint32_t k = 0; k < 40; ++k) {
    CAPTURE(k);
    const double f = k % 2 ? 0 : 3 * std::sqrt(1e-6 * (k + 1));
    // Of the first law along n, once more half of it.
    const double sum = f + 0.5 * 0.6 * f * (0.6 - 0.8);
    CHECK(std::fabs(b.scratch.out(CALX_OUT_FX)[k] - sum) <= 1e-14 * f);
    CHECK(b.scratch.out(CALX_OUT_MX)[k] == f);
    CHECK(b.scratch.out(CALX_OUT_PLASTIC)[k] == f + 1);
    CHECK(b.scratch.state(0)[k] == (k % 2 ? 7 : 40));
    CHECK(b.scratch.state(1)[k] == 40);
    CHECK(b.scratch.state(2)[k] == (k % 2 ? 5 : 140));
  }
  CHECK(reach_of(b.list, 1e-3, 0) == 0.5e-3);
  b.list.terms[1].pair_row = {-1};
  CHECK_THROWS_WITH_AS(reach_of(b.list, 1e-3, 0), doctest::Contains("the reach of law "), Error);
}
