// chart.hpp: what a chart shows, without how it is drawn; web/charts.js draws it. A page holds some 10 to 60 charts.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "report/json_text.hpp"

namespace calx {

struct ChartAxis {
  std::string title, unit;  // shown as "mass, kg"
  bool from_zero = false;
  std::vector<std::string> categories;  // names for x = 0, 1, 2, ...; empty: numbers
  bool logarithmic = false;             // x only; all values must be above 0
};

struct ChartSeries {
  enum class Style { line, dashed, points, bars, area, band } style = Style::line;
  std::string name;
  std::vector<double> x, y;
  std::vector<double> error;  // half length of the error bar, half width of the band; empty: none
  int colour = -1;            // number in the palette; -1: the next free one
};

struct ChartMark {
  double at = 0;
  std::string name;
};

/// Mean with a band of one standard deviation on either side.
struct ChartBand {
  double mean = 0, deviation = 0;
  std::string name;
};

struct Chart {
  enum class Kind { xy, stack, map } kind = Kind::xy;
  std::string title, caption;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  std::vector<ChartMark> marks;  // vertical lines at x
  std::vector<ChartBand> bands;  // horizontal
  bool equal_scales = false;     // one unit of x as long as one of y: angles are true
  bool wide = false;             // over the full width of the page
  // Kind::map: nx * ny values, row by row from the lowest y; NaN stays empty.
  std::size_t nx = 0, ny = 0;
  double x0 = 0, y0 = 0, cell = 0;
  std::vector<double> values;
  ChartAxis value;
};

/// At most about that many rows, keeping the lowest and the highest of each stretch, so that peaks stay visible.
void thin_out(std::vector<double>& x, std::vector<double>& y, std::size_t most);

/// The chart as JSON for charts.js. Series longer than 1500 rows are thinned out.
void write_json(JsonText& out, const Chart& chart);

}  // namespace calx
