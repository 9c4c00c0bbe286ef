// troubles.hpp: what makes a study harder than the default: how it is drawn, and what the diagnosis sees of it.
#pragma once
#include "diagnosis/blind_study.hpp"

namespace calx {
class Random;
}

namespace calx::diagnosis {

/// Takes two nuisance parameters 2 to 3 prior sd off, to either side.
void take_far(Random& random, Vector& u);

/// Adds 8 sd to three numbers of each campaign, in observables of twelve numbers or more.
void add_gross_errors(Random& random, infer::Observables& observables);

/// The line with what the trouble takes away or offers besides: fewer observables, or the temperature of the load cell
/// that was logged, as one more candidate of the library. Takes what is not seen out of `observables`, too.
class TroubledSimulator : public infer::Simulator {
 public:
  TroubledSimulator(LineSimulator& line, Trouble trouble, infer::Observables& observables);
  const std::vector<infer::Effect>& library() const { return library_; }
  int parameters() const override { return line_.parameters(); }
  Matrix run(const std::vector<infer::RunPoint>& points) override;
  Vector instrument(const infer::RunPoint& point) override;

 private:
  Matrix seen(const Matrix& all) const;

  LineSimulator& line_;
  std::vector<infer::Effect> library_;
  std::vector<std::pair<int, int>> kept_;  // first row and rows of each observable that is seen
};

}  // namespace calx::diagnosis
