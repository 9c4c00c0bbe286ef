#include <doctest/doctest.h>

#include <cmath>

#include "measure/windows.hpp"

using namespace calx;

TEST_CASE("means over whole windows, the peak, and what changed last") {
  Windows w(0.004);
  // Four steps of 1 ms each: shear 1, 3, 2; then two steps that make no window.
  for (const double shear : {1.0, 3.0, 2.0})
    for (int k = 0; k < 4; ++k) w.add({100, shear + (k % 2 ? 0.5 : -0.5), 0.1 * shear, 0.2 * shear}, 0.001);
  for (int k = 0; k < 2; ++k) w.add({100, 99, 0, 0}, 0.001);
  CHECK(w.last().shear == doctest::Approx(2));
  CHECK(w.peak().shear == doctest::Approx(3));
  CHECK(w.peak().height == doctest::Approx(0.3));
  CHECK(w.ratio_drift() == doctest::Approx(0.5));
  CHECK(w.height_drift() == doctest::Approx(0.5));
  CHECK(w.haste() == doctest::Approx(0.06));
  Windows again(0.004);
  again.set_numbers(w.numbers());
  for (Windows* one : {&w, &again})
    for (int k = 0; k < 2; ++k) one->add({100, 1, 0, 0}, 0.001);
  CHECK(w.last().shear == doctest::Approx(50));
  CHECK(again.last().shear == w.last().shear);
  w.begin();
  CHECK(w.last().shear == 0);
  CHECK(std::isnan(w.ratio_drift()));
  CHECK(std::isnan(w.haste()));
}

TEST_CASE("windows under less than half of the last stress do not count as haste") {
  Windows w(0.001);
  w.add({10, 0, 0, 5}, 0.001);
  w.add({60, 0, 0, 2}, 0.001);
  Windows again(0.001);
  again.set_numbers(w.numbers());
  for (Windows* one : {&w, &again}) {
    one->add({100, 0, 0, 1}, 0.001);
    CHECK(one->haste() == doctest::Approx(2 / std::sqrt(60.0)));
  }
}

TEST_CASE("a step shorter than a window gives its own mean") {
  Windows w(1);
  w.add({10, 4, 0, 0}, 0.001);
  w.add({20, 6, 0, 0}, 0.001);
  CHECK(w.last().normal == doctest::Approx(15));
  CHECK(w.peak().shear == doctest::Approx(5));
  CHECK(std::isnan(w.ratio_drift()));
}
