#include <doctest/doctest.h>

#include "infer/checks.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

struct Setting {
  LinearModel model = small_model();
  Bank bank = make_bank(model.observables);
  Matrix systematic = 0.01 * Matrix::Identity(31, 31);
  Matrix noise = Matrix(model.observables.sd().cwiseAbs2().asDiagonal());
  Options options;
  FitCheck check(const Vector& r) { return check_fit(model, bank, systematic, noise, r, options, 1); }
};

}  // namespace

TEST_CASE("a right model is refused about as often as p says, never more") {
  Setting setting;
  calx::Random random(10, 1);
  int refused = 0;
  const int studies = 200;
  for (int k = 0; k < studies; ++k)
    refused += setting.check(setting.model.observables.sd().cwiseProduct(normal_vector(random, 31))).p < 0.05 ? 1 : 0;
  // 5 % of 200 are 10, with an sd of 3.1; Gaussian data against a heavy-tailed null stay below.
  CHECK(refused <= 20);
}

TEST_CASE("a structured departure is refused and located") {
  Setting setting;
  calx::Random random(10, 2);
  Vector r = setting.model.observables.sd().cwiseProduct(normal_vector(random, 31));
  for (int k = 15; k < 30; ++k) r[k] += 1.5;
  const FitCheck check = setting.check(r);
  CHECK(check.p < 0.01);
  CHECK(check.blocks[0].p < 0.01);
  CHECK(check.blocks[1].p > 0.02);
  CHECK(check.blocks[0].departure == doctest::Approx(0.75).epsilon(0.3));
  CHECK(check.blocks[0].z > 5);
}
