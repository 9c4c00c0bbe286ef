#include <doctest/doctest.h>

#include "infer/bank.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

TEST_CASE("prior shares of all terms sum to one") {
  double sum = 0;
  for (double share : make_bank(small_observables()).log_share) sum += std::exp(share);
  CHECK(sum == doctest::Approx(1).epsilon(1e-12));
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
