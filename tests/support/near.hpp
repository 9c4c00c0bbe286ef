// near.hpp: relative closeness. Approx alone adds 1 to the scale, which hides any error of a small number.
#pragma once
#include <doctest/doctest.h>

namespace calx {

inline doctest::Approx near(double value, double relative) { return doctest::Approx(value).epsilon(relative).scale(0); }

}  // namespace calx
