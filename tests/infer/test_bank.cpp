#include <doctest/doctest.h>

#include <cmath>

#include "infer/posterior.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

TEST_CASE("prior shares of all terms sum to one") {
  double sum = 0;
  for (double share : make_bank(small_observables()).log_share) sum += std::exp(share);
  CHECK(sum == doctest::Approx(1).epsilon(1e-12));
}

namespace {

/// The series, with what it adds up to after 10, 20 and 30 cycles.
Observables with_sums() {
  Observables all = small_observables();
  Block sums = small_block("total", 3, 2);
  sums.x << 10, 20, 30;
  sums.sums = "series";
  all.blocks.push_back(sums);
  return all;
}

UnknownFit fit_of(const Observables& all, const Bank& bank, const Vector& r) {
  const Metric metric(Matrix(all.sd().cwiseAbs2().asDiagonal()), r);
  return fit_unknown(bank, whiten_bank(bank, all, metric), all.blocks.size(), metric);
}

}  // namespace

TEST_CASE(
    "a step of the powder is one discrepancy in a series and in its sums, one of the instrument is in the series") {
  const Observables all = with_sums();
  const Bank bank = make_bank(all);
  calx::Random random(9, 2);
  const Vector noise = all.sd().cwiseProduct(normal_vector(random, 34));
  Vector shown = noise;
  for (int k = 15; k < 30; ++k) shown[k] += 1.5;
  const UnknownFit instrument = fit_of(all, bank, shown);
  CHECK(bank.terms[instrument.term].family == "step");
  CHECK(bank.terms[instrument.term].sums.rows() == 0);

  Vector real = shown;
  real[32] += 1.5 * 5, real[33] += 1.5 * 15;  // cycles 16 to 20, 16 to 30
  const UnknownFit powder = fit_of(all, bank, real);
  CHECK(bank.terms[powder.term].family == "step");
  CHECK(bank.terms[powder.term].place == doctest::Approx(16).epsilon(0.1));
  CHECK(bank.terms[powder.term].sums.rows() == 3);
  // Without the sums the step and the totals are two discrepancies, each with its own prior.
  Observables apart = all;
  apart.blocks[2].sums.clear();
  CHECK(powder.odds > fit_of(apart, make_bank(apart), real).odds + 3);
}

TEST_CASE("a curve displaced along its index is told from a curve of another shape") {
  const Observables all = small_observables();
  Vector base = Vector::Zero(31);
  for (int k = 0; k < 30; ++k) base[k] = -std::abs(k - 14.5);
  const Bank bank = make_bank(all, base);
  Vector r = Vector::Zero(31);
  for (int k = 0; k < 30; ++k) r[k] = -std::abs(k - 16.5) - base[k];
  const UnknownFit fit = fit_of(all, bank, r);
  CHECK(bank.terms[fit.term].family == "shift");
  // Flat curves look the same wherever they are.
  for (const Term& term : make_bank(all, Vector::Ones(31)).terms) CHECK(term.family != "shift");
}

TEST_CASE("a step is found at its place, in its block, and noise is not") {
  const Observables all = small_observables();
  const Bank bank = make_bank(all);
  const Matrix s = Matrix(all.sd().cwiseAbs2().asDiagonal());
  calx::Random random(9, 1);
  Vector r = all.sd().cwiseProduct(normal_vector(random, 31));
  const Metric quiet(s, r);
  CHECK(fit_unknown(bank, whiten_bank(bank, all, quiet), 2, quiet).odds < 0);
  for (int k = 19; k < 30; ++k) r[k] += 1.5;
  const Metric loud(s, r);
  const UnknownFit fit = fit_unknown(bank, whiten_bank(bank, all, loud), 2, loud);
  CHECK(fit.odds > 10);
  CHECK(bank.terms[fit.term].family == "step");
  CHECK(bank.terms[fit.term].place == doctest::Approx(19).epsilon(0.1));
  CHECK(fit.block_share[0] > 0.99);
}

TEST_CASE("what an effect of the library does is not outside the library, too") {
  const LinearModel model = small_model();
  const Observables& all = model.observables;
  const Bank bank = make_bank(all);
  // Log odds lost by terms that an effect imitates. The rise is one-sided: it cannot imitate a fall.
  const auto lost = [&](double amplitude) {
    const Metric metric(Matrix(all.sd().cwiseAbs2().asDiagonal()), Vector(amplitude * model.signatures[0]));
    return fit_unknown(bank, whiten_bank(bank, all, metric), 2, metric).odds -
           weigh(model, bank, metric, {}).discrepancy.odds;
  };
  CHECK(lost(1.5) > 2);
  CHECK(lost(-1.5) < 0.1);
}
