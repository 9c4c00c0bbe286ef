// windows.hpp: means over stretches of equal length of one step of a test, to tell a steady value from a peak and from
// what still changes. Private to measure/.
#pragma once
#include <utility>
#include <vector>

namespace calx {

/// A stress in a cell, or on a wall, and how fast it is sheared or squeezed.
struct StressState {
  double normal = 0, shear = 0;  // Pa; normal is positive in compression
  double height = 0;             // m; 0 where nobody asks
  double speed = 0;              // m/s, not negative
};

/// Consecutive windows of a step; the last one that is cut short by the end of the step is left out.
class Windows {
 public:
  explicit Windows(double length) : length_(length) { begin(); }
  /// Begins a step; forgets the one before.
  void begin();
  /// After a time step of dt, s.
  void add(const StressState& now, double dt);
  /// Mean over the last window of the step, or over the whole step where it holds none.
  StressState last() const;
  /// The window with the largest shear; last() where the step holds none.
  StressState peak() const { return count_ > 0 ? peak_ : last(); }
  /// Relative change from the last window but one to the last, of shear over normal stress (a load that has just
  /// changed must not look like friction that does), and of height; NaN with fewer than two.
  double ratio_drift() const;
  double height_drift() const;
  /// Largest speed / sqrt(normal) of the windows, m/s / sqrt(Pa): what inertial numbers grow with. Windows with less
  /// than half of the last one's normal stress are left out: a lid on its way down is no test yet. NaN without any.
  double haste() const;

  std::vector<double> numbers() const;
  void set_numbers(const std::vector<double>& numbers);

 private:
  void close();
  double length_;
  StressState sum_, last_, before_, peak_;
  std::vector<std::pair<double, double>> paces_;  // speed and normal stress of each window
  double steps_ = 0, time_ = 0, count_ = 0;
};

}  // namespace calx
