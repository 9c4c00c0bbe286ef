// emulator.hpp: a Gaussian process that stands for one figure of a simulation as a function of its parameters.
// Typical: 10 to 100 places in 1 to 10 dimensions, 1 to 5 runs a place; it is asked some 1e5 times.
#pragma once
#include <Eigen/Dense>
#include <vector>

namespace calx {

/// A mean and the variance of what is not known of it.
struct Estimate {
  double mean = 0, variance = 0;
};

/// y(x) = linear trend + Gaussian process with a Matern 5/2 kernel and one length per dimension; runs scatter about
/// y(x) with one standard deviation everywhere, found from the runs that share a place and from the fit together.
/// Equations: Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), 2.23-2.26, 2.30, 4.17, 5.10-5.12;
/// replicates: Binois, Gramacy and Ludkovski (2018), J. Comput. Graph. Stat. 27, eq. 3-5.
class Emulator {
 public:
  /// x: places (rows) in coordinates of order one; values: the runs of each place, at least one; places: two or more
  /// of them. trend: further columns that the trend is linear in, one row a place (a cheaper model's figure); may have
  /// no columns. Hyperparameters have the highest posterior density under weak priors (log-normal lengths).
  /// Throws std::invalid_argument for sizes that do not fit and for values that are not finite.
  Emulator(const Eigen::MatrixXd& x, const std::vector<std::vector<double>>& values,
           const Eigen::MatrixXd& trend = Eigen::MatrixXd());

  /// y at x, without the scatter of a run. trend: as at fitting.
  Estimate at(const Eigen::VectorXd& x, const Eigen::VectorXd& trend = Eigen::VectorXd()) const;

  /// What the emulator says of each place when it has not seen its runs; the variance holds the scatter of the mean of
  /// that place's runs.
  std::vector<Estimate> leave_one_out() const;
  /// Mean of the runs of each place.
  const Eigen::VectorXd& places_mean() const { return y_; }

  /// Scatter of one run, in units of y.
  double noise_sd() const { return noise_ * scale_; }
  /// Kernel lengths, in units of x.
  const Eigen::VectorXd& lengths() const { return lengths_; }
  /// Factor on variances that makes leave-one-out residuals as large as they say; 1 or more.
  double inflation() const { return inflation_; }
  /// Log density of the data and of the hyperparameters, for tests: at log lengths, log signal, log noise (in units of
  /// the standard deviation of y).
  double log_density(const Eigen::VectorXd& log_parameters) const;
  /// Where log_density is highest.
  const Eigen::VectorXd& log_parameters() const { return best_; }

 private:
  double kernel(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& inverse,
                double signal) const;
  Eigen::MatrixXd covariance(const Eigen::VectorXd& log_parameters) const;
  void find_hyperparameters();
  void solve();

  Eigen::MatrixXd x_, trend_;  // trend_: 1, x, further columns, standardised
  Eigen::VectorXd trend_shift_, trend_scale_;
  Eigen::VectorXd y_, standard_, counts_;   // means; the same about 0 with unit sd; runs per place
  double shift_ = 0, scale_ = 1;            // y = shift + scale * standard
  double within_ = 0, within_freedom_ = 0;  // sum of squares of runs about their place's mean, standardised
  Eigen::VectorXd best_, lengths_, weights_;
  double signal_ = 1, noise_ = 0, inflation_ = 1;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace calx
