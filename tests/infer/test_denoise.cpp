#include <doctest/doctest.h>

#include "infer/denoise.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

const SeedScatter runs_scatter = small_scatter(0.7, 0.5);

Vector noise_of(calx::Random& random) {
  Vector v(31);
  const double common = 0.5 * random.normal();
  for (int k = 0; k < 30; ++k) v[k] = 0.5 * (0.7 * random.normal() + common);
  v[30] = 2 * 0.7 * random.normal();
  return v;
}

}  // namespace

TEST_CASE("a smooth response loses most of its noise and keeps its size") {
  const Denoiser denoise(small_observables(), runs_scatter);
  calx::Random random(4, 1);
  double before = 0, after = 0;
  const Vector response = 4 * small_signatures()[2];
  for (int k = 0; k < 30; ++k) {
    const Vector noise = noise_of(random);
    before += noise.head(30).squaredNorm();
    after += (denoise(response + noise, 1) - response).head(30).squaredNorm();
  }
  // A third of the noise is the common mode, which no block tells from a constant response.
  CHECK(after < 0.7 * before);
}

TEST_CASE("pure noise becomes a response near zero") {
  const Denoiser denoise(small_observables(), runs_scatter);
  calx::Random random(4, 2);
  double before = 0, after = 0;
  for (int k = 0; k < 30; ++k) {
    const Vector noise = noise_of(random);
    before += noise.squaredNorm();
    after += denoise(noise, 1).squaredNorm();
  }
  CHECK(after < 0.1 * before);
}

TEST_CASE("the evidence knows the size of the noise") {
  const Denoiser denoise(small_observables(), runs_scatter);
  calx::Random random(4, 3);
  double right = 0, small = 0, large = 0;
  for (int k = 0; k < 10; ++k) {
    const Vector v = small_signatures()[1] + noise_of(random);
    denoise(v, 1, &right);
    denoise(v, 0.25, &small);
    denoise(v, 4, &large);
  }
  CHECK(right > small + 5);
  CHECK(right > large + 5);
}
