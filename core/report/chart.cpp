#include "report/chart.hpp"

#include <cmath>

namespace calx {
namespace {

const std::size_t most_rows = 1500;

void write_axis(JsonText& out, const std::string& name, const ChartAxis& axis) {
  out.key(name).begin_object().member("title", axis.title).member("unit", axis.unit);
  if (axis.from_zero) out.member("zero", true);
  if (axis.logarithmic) out.member("log", true);
  if (!axis.categories.empty()) {
    out.key("categories").begin_array();
    for (const std::string& c : axis.categories) out.value(c);
    out.end_array();
  }
  out.end_object();
}

const char* style_name(ChartSeries::Style style) {
  switch (style) {
    case ChartSeries::Style::line:
      return "line";
    case ChartSeries::Style::dashed:
      return "dashed";
    case ChartSeries::Style::points:
      return "points";
    case ChartSeries::Style::bars:
      return "bars";
    case ChartSeries::Style::area:
      return "area";
    case ChartSeries::Style::band:
      return "band";
  }
  return "line";
}

// Rows of a stack must stay aligned, so a stack is thinned by taking every n-th row.
void stride_out(std::vector<double>& v, std::size_t most) {
  if (v.size() <= most) return;
  const std::size_t step = (v.size() + most - 1) / most;
  std::vector<double> kept;
  for (std::size_t i = 0; i < v.size(); i += step) kept.push_back(v[i]);
  if ((v.size() - 1) % step != 0) kept.push_back(v.back());
  v = std::move(kept);
}

}  // namespace

void thin_out(std::vector<double>& x, std::vector<double>& y, std::size_t most) {
  const std::size_t count = x.size();
  if (count <= most || most < 4) return;
  const std::size_t stretches = most / 2;
  std::vector<double> kept_x, kept_y;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t first = s * count / stretches, last = (s + 1) * count / stretches;
    std::size_t low = first, high = first;
    for (std::size_t i = first; i < last; ++i) {
      if (y[i] < y[low] || !std::isfinite(y[low])) low = i;
      if (y[i] > y[high] || !std::isfinite(y[high])) high = i;
    }
    if (s == 0 && low != 0 && high != 0) kept_x.push_back(x[0]), kept_y.push_back(y[0]);
    const std::size_t a = low < high ? low : high, b = low < high ? high : low;
    kept_x.push_back(x[a]), kept_y.push_back(y[a]);
    if (b != a) kept_x.push_back(x[b]), kept_y.push_back(y[b]);
    if (s + 1 == stretches && b != count - 1) kept_x.push_back(x[count - 1]), kept_y.push_back(y[count - 1]);
  }
  x = std::move(kept_x);
  y = std::move(kept_y);
}

void write_json(JsonText& out, const Chart& chart) {
  static const char* const kinds[] = {"xy", "stack", "map"};
  out.begin_object().member("kind", kinds[static_cast<int>(chart.kind)]).member("title", chart.title);
  if (chart.equal_scales) out.member("equal", true);
  write_axis(out, "x", chart.x);
  write_axis(out, "y", chart.y);
  out.key("series").begin_array();
  for (const ChartSeries& series : chart.series) {
    ChartSeries s = series;
    if (chart.kind == Chart::Kind::stack) {
      stride_out(s.x, most_rows);
      stride_out(s.y, most_rows);
    } else if (s.error.empty()) {
      thin_out(s.x, s.y, most_rows);
    }
    out.begin_object().member("name", s.name).member("style", style_name(s.style));
    if (s.colour >= 0) out.member("colour", static_cast<double>(s.colour));
    out.key("x").values(s.x, 8).key("y").values(s.y);
    if (!s.error.empty()) out.key("error").values(s.error);
    out.end_object();
  }
  out.end_array();
  if (!chart.marks.empty()) {
    out.key("marks").begin_array();
    for (const ChartMark& m : chart.marks) out.begin_object().member("at", m.at).member("name", m.name).end_object();
    out.end_array();
  }
  if (!chart.bands.empty()) {
    out.key("bands").begin_array();
    for (const ChartBand& b : chart.bands) {
      out.begin_object().member("mean", b.mean).member("sd", b.deviation).member("name", b.name).end_object();
    }
    out.end_array();
  }
  if (chart.kind == Chart::Kind::map) {
    out.member("nx", static_cast<double>(chart.nx)).member("ny", static_cast<double>(chart.ny));
    out.member("x0", chart.x0).member("y0", chart.y0).member("cell", chart.cell);
    write_axis(out, "value", chart.value);
    out.key("values").values(chart.values, 5);
  }
  out.end_object();
}

}  // namespace calx
