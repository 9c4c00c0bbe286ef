// How measured data become blocks of the diagnosis: what is fitted, what is held out, how uncertain it is.
#include <doctest/doctest.h>

#include <cmath>

#include "study/measured_blocks.hpp"

namespace calx {
namespace {

StudyObservable curve(const std::string& name, StudyObservable::Use use, std::vector<double> y, double sd,
                      std::size_t repeats) {
  StudyObservable o;
  o.name = name, o.kind = "load-cell", o.case_name = "valve", o.sensor = "cell", o.column = "mass_kg";
  o.against = "time_s", o.unit = "g", o.use = use;
  for (std::size_t k = 0; k < y.size(); ++k) o.measured.x.push_back(static_cast<double>(k));
  o.measured.sd.assign(y.size(), sd);
  o.measured.y = std::move(y);
  o.measured.repeats = repeats;
  o.tolerance = 0.35 * sd;
  return o;
}

constexpr auto fit = StudyObservable::Use::fit, hold_out = StudyObservable::Use::hold_out;

}  // namespace

TEST_CASE("two campaigns of one reading are one block, with one sd of the mean") {
  Study study;
  study.observables = {curve("a", fit, {1, 2, 3}, 0.4, 4), curve("b", hold_out, {1.1, 2.1, 3.1}, 0.3, 4)};
  const MeasuredBlocks m = measured_blocks(study);
  REQUIRE(m.observables.blocks.size() == 1);
  const infer::Block& block = m.observables.blocks[0];
  CHECK(block.fit[2] == 3);
  CHECK(block.hold[2] == 3.1);
  // 0.4 / 2 and 0.3 / 2: the root of the mean square of both.
  CHECK(block.sd[0] == doctest::Approx(std::sqrt((0.04 + 0.0225) / 2)));
  CHECK(block.ordered);
  CHECK(m.has_hold_out);
  CHECK(m.block_of == std::vector<std::size_t>{0, 0});
  CHECK_FALSE(m.split_repeats);
  // The tolerance stays what it is in the unit of the observable.
  CHECK(block.tolerance * block.sd[0] == doctest::Approx(0.14));
}

TEST_CASE("campaigns of other places, other cases or far other noise stay apart") {
  Study study;
  study.observables = {curve("a", fit, {1, 2, 3}, 0.4, 4), curve("b", hold_out, {1, 2, 3}, 0.1, 4),
                       curve("c", hold_out, {1, 2, 3, 4}, 0.4, 4), curve("d", hold_out, {1, 2, 3}, 0.4, 4)};
  study.observables[3].case_name = "slow valve";
  const MeasuredBlocks m = measured_blocks(study);
  REQUIRE(m.observables.blocks.size() == 4);
  for (std::size_t b = 1; b < 4; ++b) CHECK(m.observables.blocks[b].fit.size() == 0);
  CHECK(m.readings[3].case_name == "slow valve");
}

TEST_CASE("an sd from a few repeats is wider, as t is wider than a normal deviate") {
  Study study;
  study.observables = {curve("given", fit, {5}, 1, 5), curve("seen", fit, {5}, 1, 5), curve("twice", fit, {5}, 1, 2)};
  for (StudyObservable& o : study.observables) o.against = "";
  study.observables[1].measured.sd_estimated = study.observables[2].measured.sd_estimated = true;
  study.observables[1].column = "b", study.observables[2].column = "c";
  const MeasuredBlocks m = measured_blocks(study);
  CHECK(m.observables.blocks[0].sd[0] == doctest::Approx(1 / std::sqrt(5.0)));
  // Four degrees of freedom: variance 4 / (4 - 2) of a normal one.
  CHECK(m.observables.blocks[1].sd[0] == doctest::Approx(std::sqrt(2.0 / 5)));
  // One degree has no variance at all; bounded at four times.
  CHECK(m.observables.blocks[2].sd[0] == doctest::Approx(std::sqrt(4.0 / 2)));
}

TEST_CASE("where nothing is held out, the later half of the repeats is") {
  Study study;
  study.observables = {curve("a", fit, {3}, 1, 4), curve("b", fit, {3}, 1, 2)};
  for (StudyObservable& o : study.observables) o.against = "";
  study.observables[0].measured.each = {{1}, {2}, {4}, {5}};
  study.observables[1].measured.each = {{1}, {5}};
  study.observables[1].column = "other";
  const MeasuredBlocks m = measured_blocks(study);
  CHECK(m.split_repeats);
  CHECK(m.observables.blocks[0].fit[0] == 1.5);
  CHECK(m.observables.blocks[0].hold[0] == 4.5);
  CHECK(m.observables.blocks[0].sd[0] == doctest::Approx(1 / std::sqrt(2.0)));
  // Two scalars are too few to be two campaigns.
  CHECK(m.observables.blocks[1].fit[0] == 3);
  CHECK(m.observables.blocks[1].hold.size() == 0);
}

TEST_CASE("the mass in the vessel is the sum of what each cycle delivers") {
  Study study;
  study.observables = {curve("per cycle", fit, {1, 2, 3}, 0.4, 4), curve("in all", fit, {1, 3, 6}, 0.4, 4),
                       curve("elsewhere", fit, {1, 3, 6}, 0.4, 4)};
  study.observables[0].kind = "mass-per-cycle";
  study.observables[1].kind = study.observables[2].kind = "mass-after-cycles";
  study.observables[2].case_name = "slow valve";
  const MeasuredBlocks m = measured_blocks(study);
  CHECK(m.observables.blocks[1].sums == "per cycle");
  CHECK(m.observables.blocks[2].sums.empty());
}

TEST_CASE("stress is looked at by its logarithm, and another program's numbers are a base with their own sd") {
  Study study;
  StudyObservable o = curve("a", fit, {1, 2, 3}, 0.4, 4);
  o.kind = "compressibility", o.against = "stress_Pa", o.measured.x = {500, 1000, 15000};
  o.simulated = {1, 2, 3}, o.simulated_sd = 0.1;
  study.observables = {o};
  const MeasuredBlocks m = measured_blocks(study);
  CHECK(m.observables.blocks[0].log_x);
  CHECK_FALSE(m.observables.blocks[0].ordered);
  CHECK(m.observables.blocks[0].base_sd == doctest::Approx(0.5));
  CHECK_FALSE(m.has_hold_out);
}

}  // namespace calx
