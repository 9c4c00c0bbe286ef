#include "measure/windows.hpp"

#include <cmath>
#include <limits>

namespace calx {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

StressState scaled(const StressState& s, double factor) {
  return {s.normal * factor, s.shear * factor, s.height * factor, s.speed * factor};
}

double change(double from, double to) { return to != 0 ? std::fabs(to - from) / std::fabs(to) : nan; }

}  // namespace

void Windows::begin() {
  sum_ = last_ = before_ = peak_ = StressState();
  steps_ = time_ = count_ = 0;
  paces_.clear();
}

void Windows::add(const StressState& now, double dt) {
  sum_.normal += now.normal;
  sum_.shear += now.shear;
  sum_.height += now.height;
  sum_.speed += now.speed;
  steps_ += 1;
  time_ += dt;
  if (time_ >= length_ - 0.5 * dt) close();
}

void Windows::close() {
  before_ = last_;
  last_ = scaled(sum_, 1 / steps_);
  if (count_ == 0 || last_.shear > peak_.shear) peak_ = last_;
  paces_.emplace_back(last_.speed, last_.normal);
  count_ += 1;
  sum_ = StressState();
  steps_ = time_ = 0;
}

StressState Windows::last() const { return count_ > 0 ? last_ : scaled(sum_, steps_ > 0 ? 1 / steps_ : 0); }
double Windows::ratio_drift() const {
  if (count_ < 2 || !(before_.normal > 0) || !(last_.normal > 0)) return nan;
  return change(before_.shear / before_.normal, last_.shear / last_.normal);
}

double Windows::height_drift() const { return count_ > 1 ? change(before_.height, last_.height) : nan; }

double Windows::haste() const {
  double most = nan;
  for (const auto& [speed, normal] : paces_)
    if (normal > 0 && normal >= 0.5 * last_.normal && !(speed / std::sqrt(normal) <= most))
      most = speed / std::sqrt(normal);
  return most;
}

std::vector<double> Windows::numbers() const {
  std::vector<double> out{steps_, time_, count_};
  for (const StressState& s : {sum_, last_, before_, peak_})
    out.insert(out.end(), {s.normal, s.shear, s.height, s.speed});
  for (const auto& pace : paces_) out.insert(out.end(), {pace.first, pace.second});
  return out;
}

void Windows::set_numbers(const std::vector<double>& n) {
  steps_ = n.at(0);
  time_ = n.at(1);
  count_ = n.at(2);
  std::size_t at = 3;
  for (StressState* s : {&sum_, &last_, &before_, &peak_}) {
    *s = {n.at(at), n.at(at + 1), n.at(at + 2), n.at(at + 3)};
    at += 4;
  }
  paces_.clear();
  for (; at + 1 < n.size(); at += 2) paces_.emplace_back(n[at], n[at + 1]);
}

}  // namespace calx
