// table.hpp: rows of time, angle and displacement, and a curve through them.
#ifndef CALX_MOTION_TABLE_TABLE_HPP
#define CALX_MOTION_TABLE_TABLE_HPP
#include <string>
#include <vector>

namespace motion_table {

/// One row: time since the start, s; angle, rad; displacement, m; and the slopes of the curve through them, per second.
struct Row {
  double t, angle, shift;
  double angle_rate, shift_rate;
};

struct Point {
  double angle, shift, angle_rate, shift_rate;
};

/// Straight lines through the rows, or cubics that never overshoot them (Steffen 1990, Astron. Astrophys. 239, 443).
class Table {
 public:
  /// json: {"rows": [[t, angle, displacement], ...]}, or "rows_deg" with angles in degrees. Throws calx::ConfigError
  /// that names the row.
  Table(const std::string& json, bool cubic);
  double end() const { return rows_.back().t; }
  const Row& first() const { return rows_.front(); }
  const Row& last() const { return rows_.back(); }
  /// 0 <= t <= end(); at a row the slopes of the interval that begins there.
  Point at(double t) const;
  double top_angle_rate() const;  // rad/s
  double top_shift_rate() const;  // m/s

 private:
  void find_slopes();
  bool cubic_;
  std::vector<Row> rows_;
};

}  // namespace motion_table
#endif
