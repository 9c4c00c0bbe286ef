#include <doctest/doctest.h>

#include "base/error.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

TEST_CASE("low rank columns give the kernel back to the share of its trace that was asked for") {
  const Block block = small_block("series", 40, 1);
  const Matrix k = smooth_kernel(block, 0.3);
  const Matrix f = low_rank(k, 1e-3);
  CHECK(f.cols() < 10);
  CHECK((k - f * f.transpose()).trace() <= 1e-3 * k.trace());
  CHECK((k - f * f.transpose()).trace() >= 0);
  const Matrix gram = f.transpose() * f;
  CHECK((gram - Matrix(gram.diagonal().asDiagonal())).norm() < 1e-9 * gram.norm());
}

TEST_CASE("the unit index runs from 0 to 1, along the logarithm where asked") {
  Block block = small_block("series", 3, 1);
  block.x << 1, 10, 100;
  block.log_x = true;
  CHECK(unit_index(block)[1] == doctest::Approx(0.5));
  block.log_x = false;
  CHECK(unit_index(block)[1] == doctest::Approx(9.0 / 99));
  CHECK(unit_index(small_block("single", 1, 1))[0] == 0);
}

TEST_CASE("bad observables are refused by name") {
  const auto message = [](auto spoil) {
    Observables all = small_observables();
    spoil(all.blocks[0]);
    try {
      all.check();
    } catch (const calx::Error& error) {
      CHECK(error.fault() == calx::Fault::settings);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(message([](Block& b) { b.sd[3] = 0; }) == "observable \"series\": every sd must be above zero");
  CHECK(message([](Block& b) { b.x[4] = b.x[3]; }) == "observable \"series\": places must rise; see number 5");
  CHECK(message([](Block& b) { b.fit.conservativeResize(7); }) ==
        "observable \"series\": 7 measured numbers, expected 30, all finite");
  CHECK(message([](Block& b) { b.autocorrelation = 1; }) ==
        "observable \"series\": the autocorrelation must lie between -1 and 1");
  CHECK(message([](Block& b) { b.fit.resize(0), b.hold.resize(0); }) == "observable \"series\": nothing is measured");
  CHECK(message([](Block& b) { b.sums = "singel"; }) ==
        "observable \"series\": sums \"singel\", which is no other observable");
  CHECK(message([](Block& b) { b.sums = "single"; }) == "accepted");
  CHECK(message([](Block&) {}) == "accepted");
}
