// denoise.hpp: responses of a simulator, freed from the scatter of the few runs behind them.
#pragma once
#include "infer/observables.hpp"
#include "infer/seed_scatter.hpp"

namespace calx::infer {

/// Posterior mean of a response given its noise, block by block, under a mixture of priors: exactly zero, constant,
/// smooth, rough or white Gaussian processes of several strengths (empirical Bayes; Johnstone and Silverman 2005). A
/// clean but wrong signature beats a right but noisy one, so this decides whether causes are found.
class Denoiser {
 public:
  Denoiser(const Observables& observables, const SeedScatter& scatter);
  /// response: difference of runs; its noise covariance is variance times that of one run. A block that is exactly zero
  /// was not run again: it stays zero and says nothing. Returns the cleaned response; log_evidence, where not null,
  /// gets the log density of the response under the mixture added.
  Vector operator()(const Vector& response, double variance, double* log_evidence = nullptr) const;

 private:
  struct Kernel {
    Matrix modes;   // of the whitened block, orthonormal columns
    Vector powers;  // variance of each mode at strength one, whitened
  };
  struct Part {
    int first, size;
    Vector sd;
    Matrix whitening, back;  // root of the inverse covariance of one run in declared sd, and its inverse
    std::vector<Kernel> kernels;
  };
  std::vector<Part> parts_;
};

}  // namespace calx::infer
