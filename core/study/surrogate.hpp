// surrogate.hpp: what runs at some places say of an observable at all others, and how far that is from what was
// measured. Private to study/.
#pragma once
#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "infer/curve_basis.hpp"
#include "infer/emulator.hpp"
#include "study/study.hpp"

namespace calx {

/// Runs at one place: u in the unit cube of the parameters' ranges; figures[o][r]: of observable o in run r, only runs
/// that gave all of them.
struct PlaceRuns {
  Eigen::VectorXd u;
  bool reduced = false;  // of the reduced cases
  std::vector<std::vector<Eigen::VectorXd>> figures;
};

/// Mean and covariance of an observable's figures, without the scatter of a run.
struct Figures {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Box in the unit cube that a surrogate is good in.
struct UnitBox {
  Eigen::VectorXd low, high;
  bool holds(const Eigen::VectorXd& u) const {
    return (u.array() >= low.array()).all() && (u.array() <= high.array()).all();
  }
};

class Surrogate {
 public:
  /// number: of the observable. base: the surrogate of the reduced case, which the trend follows; may be null. Needs
  /// three places with figures.
  Surrogate(const Study& study, std::size_t number, const std::vector<const PlaceRuns*>& places, const UnitBox& box,
            std::shared_ptr<const Surrogate> base);

  Figures at(const Eigen::VectorXd& u) const;
  const std::vector<Emulator>& emulators() const { return emulators_; }
  const CurveBasis& basis() const { return basis_; }
  /// Places the surrogate was fitted at, in the order of the emulators' leave_one_out().
  const std::vector<const PlaceRuns*>& places() const { return places_; }

 private:
  Eigen::VectorXd scaled(const Eigen::VectorXd& u) const;
  Eigen::VectorXd trend(const Eigen::VectorXd& u) const;

  UnitBox box_;
  CurveBasis basis_;
  std::vector<Emulator> emulators_;  // one a component
  std::vector<const PlaceRuns*> places_;
  std::shared_ptr<const Surrogate> base_;
};

/// The measured values of an observable and the covariance of all that stands between them and the mean of the runs:
/// error of the mean of the repeats, tolerance of the model, further relative tolerance for a reduced case.
struct Target {
  Eigen::VectorXd y;
  Eigen::MatrixXd covariance;
};
Target target_of(const StudyObservable& observable, double relative_tolerance = 0);

/// How far figures are from a target.
struct Misfit {
  double log_likelihood = 0;
  double square = 0;  // Mahalanobis distance, squared
  /// The distance as a normal deviate that is as unlikely: implausible from 3 on.
  double implausibility = 0;
};
Misfit misfit(const Target& target, const Figures& figures);

/// A chi-square variable of that many degrees of freedom as a normal deviate (Wilson and Hilferty 1931, PNAS 17).
double normal_score(double square, Eigen::Index freedom);

}  // namespace calx
