// table.cpp: reads the rows once when a motion is created; found by bisection for each pose.
#include "table.hpp"

#include <algorithm>
#include <calx/rigid_motion.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

namespace motion_table {
namespace {

std::vector<Row> read_rows(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw calx::ConfigError("rows: the parameters are no JSON object");
  const bool degrees = json.count("rows_deg") > 0;
  const std::string key = degrees ? "rows_deg" : "rows";
  if (degrees && json.count("rows") > 0) throw calx::ConfigError("rows and rows_deg are given both; give one of them");
  if (json.count(key) == 0)
    throw calx::ConfigError(
        "rows: missing; give a list of [time s, angle rad, displacement m], or rows_deg with angles in degrees");
  const nlohmann::json& list = json[key];
  if (!list.is_array() || list.size() < 2)
    throw calx::ConfigError(key + ": needs a list of at least two rows [time, angle, displacement]");
  std::vector<Row> rows;
  for (const nlohmann::json& item : list) {
    const std::string where = key + "/" + std::to_string(rows.size()) + ": ";
    double cell[3] = {0, 0, 0};
    if (!item.is_array() || item.size() != 3)
      throw calx::ConfigError(where + item.dump() + " is no row; write [time, angle, displacement]");
    for (std::size_t k = 0; k < 3; ++k) {
      if (!item[k].is_number() || !std::isfinite(item[k].get<double>()))
        throw calx::ConfigError(where + item[k].dump() + " is no number; write [time, angle, displacement]");
      cell[k] = item[k].get<double>();
    }
    if (rows.empty() && (cell[0] < 0 || cell[0] > 0))
      throw calx::ConfigError(where + "time " + calx::rigid::number(cell[0]) +
                              " s; the first row is the rest at time 0");
    if (!rows.empty() && !(cell[0] > rows.back().t))
      throw calx::ConfigError(where + "time " + calx::rigid::number(cell[0]) + " s does not rise above " +
                              calx::rigid::number(rows.back().t) + " s of the row before");
    const double angle = degrees ? cell[1] * calx::rigid::pi / 180 : cell[1];
    rows.push_back(Row{cell[0], angle, cell[2], 0, 0});
  }
  return rows;
}

double secant(const Row& a, const Row& b, double Row::*value) { return (b.*value - a.*value) / (b.t - a.t); }

// Steffen's slope at a row between intervals of width h0, h1 and secants s0, s1: 0 at an extremum, else limited so that
// the cubics on both sides stay monotone.
double limited(double h0, double h1, double s0, double s1) {
  if (s0 * s1 <= 0) return 0;
  const double p = std::fabs((s0 * h1 + s1 * h0) / (h0 + h1));
  const double size = std::min(std::min(2 * std::fabs(s0), 2 * std::fabs(s1)), p);
  return s0 < 0 ? -size : size;
}

// Value and slope of the cubic with values y0, y1 and slopes m0, m1 at the ends of an interval h, at share u of it.
void hermite(double h, double u, double y0, double y1, double m0, double m1, double& y, double& slope) {
  const double s = (y1 - y0) / h;
  const double c = 3 * s - 2 * m0 - m1, d = m0 + m1 - 2 * s;  // y = y0 + h u (m0 + u (c + u d))
  y = y0 + h * u * (m0 + u * (c + u * d));
  slope = m0 + u * (2 * c + u * 3 * d);
}

// Largest |slope| of that cubic: at an end or at the vertex of the parabola.
double top_slope(double s, double m0, double m1) {
  const double c = 3 * s - 2 * m0 - m1, d = m0 + m1 - 2 * s;
  double top = std::max(std::fabs(m0), std::fabs(m1));
  if (std::fabs(d) > 0) {
    const double u = -c / (3 * d);
    if (u > 0 && u < 1) top = std::max(top, std::fabs(m0 + u * (2 * c + u * 3 * d)));
  }
  return top;
}

}  // namespace

Table::Table(const std::string& json, bool cubic) : cubic_(cubic), rows_(read_rows(json)) { find_slopes(); }

void Table::find_slopes() {
  double Row::*const values[] = {&Row::angle, &Row::shift};
  double Row::*const slopes[] = {&Row::angle_rate, &Row::shift_rate};
  const std::size_t n = rows_.size();
  for (int q = 0; q < 2; ++q)
    for (std::size_t k = 0; k < n; ++k) {
      Row& row = rows_[k];
      if (!cubic_)
        row.*slopes[q] = k + 1 < n ? secant(row, rows_[k + 1], values[q]) : 0;
      else if (k > 0 && k + 1 < n)
        row.*slopes[q] = limited(row.t - rows_[k - 1].t, rows_[k + 1].t - row.t, secant(rows_[k - 1], row, values[q]),
                                 secant(row, rows_[k + 1], values[q]));
      else
        row.*slopes[q] = 0;  // a table begins and ends at rest
    }
}

Point Table::at(double t) const {
  const auto later = std::upper_bound(rows_.begin(), rows_.end(), t, [](double x, const Row& r) { return x < r.t; });
  if (later == rows_.end()) return Point{last().angle, last().shift, 0, 0};
  const Row &a = *(later - 1), &b = *later;
  if (!cubic_)
    return Point{a.angle + a.angle_rate * (t - a.t), a.shift + a.shift_rate * (t - a.t), a.angle_rate, a.shift_rate};
  const double h = b.t - a.t, u = (t - a.t) / h;
  Point p;
  hermite(h, u, a.angle, b.angle, a.angle_rate, b.angle_rate, p.angle, p.angle_rate);
  hermite(h, u, a.shift, b.shift, a.shift_rate, b.shift_rate, p.shift, p.shift_rate);
  return p;
}

double Table::top_angle_rate() const {
  double top = 0;
  for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
    const Row &a = rows_[k], &b = rows_[k + 1];
    const double s = secant(a, b, &Row::angle);
    top = std::max(top, cubic_ ? top_slope(s, a.angle_rate, b.angle_rate) : std::fabs(s));
  }
  return top;
}

double Table::top_shift_rate() const {
  double top = 0;
  for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
    const Row &a = rows_[k], &b = rows_[k + 1];
    const double s = secant(a, b, &Row::shift);
    top = std::max(top, cubic_ ? top_slope(s, a.shift_rate, b.shift_rate) : std::fabs(s));
  }
  return top;
}

}  // namespace motion_table
