// causes.hpp: evidence of single effects and of pairs of effects, with amplitudes.
#pragma once
#include <vector>

#include "infer/linearise.hpp"
#include "infer/metric.hpp"

namespace calx::infer {

/// An effect in the metric of the residuals: r ~ N(G a, I + B(a) B(a)^T), B linear in the amplitude a: the signature
/// times a smooth unknown factor per block, because a right cause has a formula that is right to 20 or 30 % only.
struct Signature {
  Matrix columns;             // whitened G, one column per component
  std::vector<Matrix> shape;  // whitened B of a unit of each component
  double scale = 1;
  bool one_sided = false;
};

/// Tolerance of a signature's shape, unwhitened: all rows, few columns. Blocks where four times `scale` times the
/// signature stays far below the noise need none. factor: over options.shape.
Matrix shape_columns(const Observables& observables, const Vector& signature, double scale, double factor,
                     const Options& options);
/// What the scatter of the runs behind a signature leaves in it after denoising, per unit of amplitude, unwhitened: per
/// block a constant and a few smooth columns. None without options.signature_noise and for instruments.
Matrix noise_columns(const LinearModel& model, std::size_t effect, const Options& options);
Signature whiten_signature(const LinearModel& model, std::size_t effect, const Metric& metric, const Options& options);

struct SingleFit {
  double odds = 0;                   // log, against "no effect", prior of the amplitude integrated out
  Vector amplitude;                  // posterior mean
  double sd = 0, low = 0, high = 0;  // of the amplitude (along its mean direction): sd, 5 % and 95 % points
  double shape_factor = 1;           // most probable tolerance of the shape, over options.shape
};

/// On a grid of 241 amplitudes; 12 directions where there are two components. Prior: normal (half-normal where
/// one-sided) averaged over four scales, so that no single scale decides (Lindley's paradox).
SingleFit fit_single(const Signature& signature, const Metric& metric);

struct PairFit {
  double odds = 0;       // log, against "no effect"
  Vector first, second;  // amplitudes, posterior mean
};

/// Two effects together, from closed forms around their joint fit; amplitudes start from the single fits.
PairFit fit_pair(const Signature& a, const Signature& b, const SingleFit& fit_a, const SingleFit& fit_b,
                 const Metric& metric);

}  // namespace calx::infer
