// observables.hpp: what was measured, as blocks of numbers stacked into one vector, and smooth kernels along a block.
#pragma once
#include <Eigen/Dense>
#include <string>
#include <vector>

namespace calx::infer {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// One observable: numbers of one unit along an index (cycle, time, angle, stress, place), or a single number.
struct Block {
  std::string name, kind;
  Vector x;                    // index, rising; any unit
  bool log_x = false;          // smooth along ln x instead of x
  Vector sd;                   // declared measurement sd of each number, same unit as the numbers
  double autocorrelation = 0;  // lag-one correlation of the measurement noise along the index, -1..1
  bool ordered = false;        // the index is time or cycle, along which something can change abruptly
  double tolerance = -1;       // sd of what the model may miss, in declared sd; below zero: that of the options
  double base_sd = -1;         // of the base mean where it comes from no runs, in declared sd; below zero: from runs
  Vector fit, hold;            // measured numbers of the campaign that is fitted and of the one held out; empty: none
  std::string sums;            // name of the block whose running sum from index 0 this one is, same unit; empty: none
};

/// All blocks of a study, stacked in their order.
struct Observables {
  std::vector<Block> blocks;

  int rows() const;
  int first(std::size_t block) const;
  int size(std::size_t block) const { return static_cast<int>(blocks[block].sd.size()); }
  /// Index of the block of running sums of this one; the number of blocks where there is none.
  std::size_t sums_of(std::size_t block) const;
  /// Declared sd of all rows.
  Vector sd() const;
  /// Fails with Fault::settings, naming the block, where sizes differ, a number is not finite, an sd is not above zero,
  /// an index does not rise, a correlation lies outside -1..1 (borders excluded), or it sums a block that is not there.
  void check() const;
};

/// Index of a block stretched to 0..1, along ln x where the block says so; zero for a single number.
Vector unit_index(const Block& block);
/// exp(-d^2 / 2 length^2) between places of the unit index.
Matrix smooth_kernel(const Block& block, double length);
/// correlation^|i-j|.
Matrix autocorrelation_matrix(int size, double correlation);
/// Orthogonal columns F, the strongest first, with F F^T = K but for a remainder of trace keep * trace K. K is
/// symmetric and not negative. Pivoted Cholesky (Harbrecht, Peters and Schneider 2012).
Matrix low_rank(const Matrix& k, double keep);

}  // namespace calx::infer
