#include <doctest/doctest.h>

#include <cmath>

#include "stand_in.hpp"
#include "study/surrogate.hpp"

namespace calx {

TEST_CASE("a scalar's target is the error of the mean with the tolerance") {
  StudyObservable o = stand_in_scalar("a", "angle_deg", 40, 0.8, 4);
  o.tolerance = 0.3;
  CHECK(target_of(o).covariance(0, 0) == doctest::Approx(0.4 * 0.4 + 0.3 * 0.3));
  // A reduced case that may be 10 % off.
  CHECK(target_of(o, 0.1).covariance(0, 0) == doctest::Approx(0.16 + 0.09 + 16));
  // An sd from five repeats is worth a Student t of four degrees, whose variance is twice as large.
  o.measured.repeats = 5;
  o.measured.sd_estimated = true;
  o.tolerance = 0;
  CHECK(target_of(o).covariance(0, 0) == doctest::Approx(2 * 0.64 / 5));
  o.measured.repeats = 2;
  CHECK(target_of(o).covariance(0, 0) == doctest::Approx(3 * 0.64 / 2));
}

TEST_CASE("points of a curve share errors as its autocorrelation and the smooth half of the tolerance say") {
  StudyObservable o;
  o.measured.x = {0, 1, 3};
  o.measured.y = {1, 2, 3};
  o.measured.sd = {1, 2, 4};
  o.measured.correlation = 0.5;
  o.measured.repeats = 2;
  o.tolerance = 0.6;
  const Eigen::MatrixXd c = target_of(o).covariance;
  CHECK(c(0, 0) == doctest::Approx(0.5 + 0.36));
  const double apart = 2 / (0.35 * 3);
  CHECK(c(1, 2) == doctest::Approx(0.5 * 8 * 0.5 + 0.18 * std::exp(-0.5 * apart * apart)));
  CHECK(c(0, 2) == doctest::Approx(0.5 * 4 * 0.25 + 0.18 * std::exp(-0.5 * 9 / (1.05 * 1.05))));
}

TEST_CASE("the misfit of a curve is that of the normal density of several variables") {
  Target t;
  t.y = Eigen::Vector2d(1, 2);
  t.covariance = Eigen::Matrix2d::Identity();
  Figures f{Eigen::Vector2d(0, 0), Eigen::Matrix2d::Zero()};
  f.covariance << 1, 0.5, 0.5, 2;
  Eigen::Matrix2d all;
  all << 2, 0.5, 0.5, 3;
  const Misfit m = misfit(t, f);
  CHECK(m.square == doctest::Approx(t.y.dot(all.inverse() * t.y)));
  CHECK(m.log_likelihood == doctest::Approx(-0.5 * m.square - 0.5 * std::log(all.determinant()) - std::log(2 * M_PI)));
}

TEST_CASE("distances become normal deviates") {
  CHECK(normal_score(4, 1) == 2);
  // The 97.725 % quantile (two standard deviations) of chi-square with 10 degrees is 20.51 (NIST handbook 1.3.6.7.4
  // gives 20.483 at 97.5 %); Wilson and Hilferty are good to a percent there.
  CHECK(normal_score(20.483, 10) == doctest::Approx(1.96).epsilon(0.01));
  CHECK(normal_score(18.307, 10) == doctest::Approx(1.645).epsilon(0.01));
}

}  // namespace calx
