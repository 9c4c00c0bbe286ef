#include "infer/observables.hpp"

#include <cmath>

#include "base/error.hpp"

namespace calx::infer {

int Observables::rows() const {
  int n = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) n += size(b);
  return n;
}

int Observables::first(std::size_t block) const {
  int n = 0;
  for (std::size_t b = 0; b < block; ++b) n += size(b);
  return n;
}

std::size_t Observables::sums_of(std::size_t block) const {
  std::size_t other = 0;
  while (other < blocks.size() && (blocks[other].sums.empty() || blocks[other].sums != blocks[block].name)) ++other;
  return other;
}

Vector Observables::sd() const {
  Vector all(rows());
  for (std::size_t b = 0; b < blocks.size(); ++b) all.segment(first(b), size(b)) = blocks[b].sd;
  return all;
}

void Observables::check() const {
  const auto refuse = [](const Block& block, const std::string& why) {
    throw Error(Fault::settings, "observable \"" + block.name + "\": " + why);
  };
  if (blocks.empty()) throw Error(Fault::settings, "there is no observable; a diagnosis needs at least one");
  for (const Block& block : blocks) {
    const auto n = block.sd.size();
    if (n == 0) refuse(block, "has no number");
    if (block.x.size() != n)
      refuse(block, std::to_string(block.x.size()) + " places for " + std::to_string(n) + " numbers");
    for (const Vector* y : {&block.fit, &block.hold})
      if (y->size() != 0 && (y->size() != n || !y->allFinite()))
        refuse(block, std::to_string(y->size()) + " measured numbers, expected " + std::to_string(n) + ", all finite");
    if (block.fit.size() == 0 && block.hold.size() == 0) refuse(block, "nothing is measured");
    if (!(block.sd.allFinite() && block.sd.minCoeff() > 0)) refuse(block, "every sd must be above zero");
    if (!block.x.allFinite()) refuse(block, "every place must be finite");
    for (int k = 1; k < n; ++k)
      if (!(block.x[k] > block.x[k - 1])) refuse(block, "places must rise; see number " + std::to_string(k + 1));
    if (block.log_x && !(block.x[0] > 0)) refuse(block, "places along a logarithmic index must be above zero");
    if (!(std::abs(block.autocorrelation) < 1)) refuse(block, "the autocorrelation must lie between -1 and 1");
    if (block.sums.empty()) continue;
    bool found = false;
    for (const Block& other : blocks) found = found || (other.name == block.sums && &other != &block);
    if (!found) refuse(block, "sums \"" + block.sums + "\", which is no other observable");
  }
}

Vector unit_index(const Block& block) {
  const auto n = block.x.size();
  if (n < 2) return Vector::Zero(n);
  Vector x = block.x;
  if (block.log_x) x = x.array().log();
  return (x.array() - x[0]) / (x[n - 1] - x[0]);
}

Matrix smooth_kernel(const Block& block, double length) {
  const Vector x = unit_index(block);
  Matrix k(x.size(), x.size());
  for (int i = 0; i < x.size(); ++i)
    for (int j = 0; j < x.size(); ++j) k(i, j) = std::exp(-0.5 * (x[i] - x[j]) * (x[i] - x[j]) / (length * length));
  return k;
}

Matrix autocorrelation_matrix(int size, double correlation) {
  Matrix k(size, size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) k(i, j) = i == j ? 1 : std::pow(correlation, std::abs(i - j));
  return k;
}

Matrix low_rank(const Matrix& k, double keep) {
  Vector left = k.diagonal();
  Matrix f(k.rows(), 0);
  const double enough = keep * left.sum();
  while (f.cols() < k.rows() && left.sum() > enough) {
    Eigen::Index pivot = 0;
    left.maxCoeff(&pivot);
    Vector column = k.col(pivot) - f * f.row(pivot).transpose();
    column /= std::sqrt(left[pivot]);
    f.conservativeResize(Eigen::NoChange, f.cols() + 1);
    f.col(f.cols() - 1) = column;
    left = (left - column.cwiseAbs2()).cwiseMax(0);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> turn(f.transpose() * f);
  return f * turn.eigenvectors().rowwise().reverse();
}

}  // namespace calx::infer
