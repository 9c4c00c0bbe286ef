#include <doctest/doctest.h>

#include "infer/confusability.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

TEST_CASE("alike signatures form a group, unlike ones do not, and a one-sided effect cannot turn its sign") {
  LinearModel model = small_model();
  model.signatures[2] = 1.1 * model.signatures[0];
  model.signatures[2](30, 0) = 0.1;
  const Metric metric(Matrix(model.observables.sd().cwiseAbs2().asDiagonal()), Vector::Zero(31));
  const Vector one = Vector::Ones(1);
  const Confusability alike = compare_causes(model, metric, {2 * one, 2 * one, 2 * one});
  REQUIRE(alike.groups.size() == 1);
  CHECK(alike.groups[0] == std::vector<std::size_t>{0, 2});
  CHECK(alike.cosine(0, 2) > 0.99);
  CHECK(alike.distance(1, 2) > 3);
  // d = delta sqrt(1 - c^2) of Gaussian models.
  CHECK(alike.distance(1, 2) ==
        doctest::Approx(alike.detectability[1] * std::sqrt(1 - std::pow(alike.cosine(1, 2), 2))).epsilon(1e-9));
  const Confusability turned = compare_causes(model, metric, {2 * one, 2 * one, -2 * one});
  CHECK(turned.distance(2, 0) == doctest::Approx(turned.detectability[2]));
}
