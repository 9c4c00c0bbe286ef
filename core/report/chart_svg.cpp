#include "report/chart_svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "report/page.hpp"

namespace calx {
namespace {

constexpr double kWidth = 320, kHeight = 250, kLeft = 62, kRight = 12, kTop = 30, kBottom = 42;
constexpr double kPen = 1.6;  // units between two points that are drawn
const char* const kPalette[] = {"#1f6f8b", "#d97a2b", "#5b8c3e", "#8f4f96", "#b8902a", "#4c5f7a"};

std::string format(const char* pattern, double value) {
  char out[40];
  std::snprintf(out, sizeof out, pattern, value);
  return out;
}

std::string text(double x, double y, const std::string& words, const std::string& more) {
  return "<text x=\"" + format("%.0f", x) + "\" y=\"" + format("%.0f", y) + "\" " + more + ">" + html_text(words) +
         "</text>\n";
}

/// From values to places along one side of a chart.
struct Scale {
  double low, high, from, to;
  bool logarithmic;

  double value(double x) const { return logarithmic ? std::log10(x) : x; }
  double at(double x) const { return from + (to - from) * (value(x) - low) / (high - low); }
  bool holds(double x) const { return std::isfinite(x) && (!logarithmic || x > 0); }

  std::vector<double> ticks() const {
    std::vector<double> out;
    if (logarithmic) {
      for (double p = std::ceil(low - 1e-9); p <= high + 1e-9; ++p) out.push_back(std::pow(10.0, p));
      return out;
    }
    const double raw = (high - low) / 4, power = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = power * (raw < 1.5 * power ? 1 : raw < 3.5 * power ? 2 : raw < 7.5 * power ? 5 : 10);
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push_back(k * step + 0.0);
    return out;
  }
};

Scale scale_of(const Chart& chart, bool along_x, double from, double to) {
  const ChartAxis& axis = along_x ? chart.x : chart.y;
  Scale scale{HUGE_VAL, -HUGE_VAL, from, to, axis.logarithmic};
  for (const ChartSeries& series : chart.series)
    for (const double v : along_x ? series.x : series.y) {
      if (!scale.holds(v)) continue;
      scale.low = std::min(scale.low, scale.value(v));
      scale.high = std::max(scale.high, scale.value(v));
    }
  if (axis.from_zero) {
    scale.low = std::min(scale.low, 0.0);
    scale.high = std::max(scale.high, 0.0);
  }
  if (!(scale.low <= scale.high)) scale.low = 0, scale.high = 1;
  const double width = scale.high - scale.low,
               air = width > 0 ? 0.04 * width : std::max(0.5 * std::fabs(scale.low), 0.5);
  if (!(axis.from_zero && scale.low >= 0)) scale.low -= air;
  scale.high += air;
  return scale;
}

struct Place {
  double x, y;
};

/// Rows that are numbers, without those that change nothing to see: too near the one before, or on a straight way.
std::vector<Place> places(const ChartSeries& series, const Scale& x, const Scale& y) {
  std::vector<Place> all, out;
  for (std::size_t k = 0; k < series.x.size(); ++k)
    if (x.holds(series.x[k]) && y.holds(series.y[k])) all.push_back({x.at(series.x[k]), y.at(series.y[k])});
  if (series.style == ChartSeries::Style::points) return all;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k > 0 && k + 1 < all.size()) {
      const Place &a = out.back(), &b = all[k], &c = all[k + 1];
      const double along = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y),
                   length = std::hypot(c.x - a.x, c.y - a.y);
      const double off = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      if (along >= 0 && (std::hypot(b.x - a.x, b.y - a.y) < kPen || off < 0.05 * length)) continue;
    }
    out.push_back(all[k]);
  }
  return out;
}

std::string curve(const ChartSeries& series, const Scale& x, const Scale& y, const std::string& colour) {
  std::string points, dots;
  for (const Place& place : places(series, x, y)) {
    points += (points.empty() ? "" : " ") + format("%.1f,", place.x) + format("%.1f", place.y);
    dots += "<circle cx=\"" + format("%.1f", place.x) + "\" cy=\"" + format("%.1f", place.y) + "\" r=\"2.2\" fill=\"" +
            colour + "\"/>\n";
  }
  if (series.style == ChartSeries::Style::points) return dots;
  const std::string dash = series.style == ChartSeries::Style::dashed ? " stroke-dasharray=\"5 3\"" : "";
  return "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"1.4\"" + dash +
         "/>\n";
}

std::string drawing(const Chart& chart, double left, double top) {
  const Scale x = scale_of(chart, true, left + kLeft, left + kWidth - kRight);
  const Scale y = scale_of(chart, false, top + kHeight - kBottom, top + kTop);
  std::string out = text(left + kLeft, top + 18, chart.title, "font-weight=\"bold\"");
  for (const double tick : x.ticks())
    out += "<path d=\"M" + format("%.1f", x.at(tick)) + " " + format("%.1f", y.from) + "V" + format("%.1f", y.to) +
           "\" stroke=\"#e4e4e4\"/>\n" +
           text(x.at(tick), y.from + 14, format("%.3g", tick), "text-anchor=\"middle\" font-size=\"10\"");
  for (const double tick : y.ticks())
    out += "<path d=\"M" + format("%.1f", x.from) + " " + format("%.1f", y.at(tick)) + "H" + format("%.1f", x.to) +
           "\" stroke=\"#e4e4e4\"/>\n" +
           text(x.from - 4, y.at(tick) + 4, format("%.3g", tick), "text-anchor=\"end\" font-size=\"10\"");
  out += "<path d=\"M" + format("%.1f", x.from) + " " + format("%.1f", y.to) + "V" + format("%.1f", y.from) + "H" +
         format("%.1f", x.to) + "\" fill=\"none\" stroke=\"#444\"/>\n";
  const auto name = [](const ChartAxis& axis) { return axis.title + (axis.unit.empty() ? "" : ", " + axis.unit); };
  out += text(0.5 * (x.from + x.to), y.from + 32, name(chart.x), "text-anchor=\"middle\" font-size=\"11\"");
  const std::string middle = format("%.0f", left + 12) + " " + format("%.0f", 0.5 * (y.from + y.to));
  out += "<text transform=\"translate(" + middle + ") rotate(-90)\" text-anchor=\"middle\" font-size=\"11\">" +
         html_text(name(chart.y)) + "</text>\n";
  const bool named = chart.series.size() > 1;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const std::string colour = kPalette[k % (sizeof kPalette / sizeof *kPalette)];
    out += curve(chart.series[k], x, y, colour);
    if (named)
      out += text(x.from + 8, y.to + 12 + 13 * static_cast<double>(k), chart.series[k].name,
                  "font-size=\"10\" fill=\"" + colour + "\"");
  }
  return out;
}

}  // namespace

std::string charts_svg(const std::string& title, const std::vector<Chart>& charts) {
  const double top = title.empty() ? 0 : 22;
  const std::string size =
      format("%.0f", kWidth * static_cast<double>(charts.size())) + " " + format("%.0f", kHeight + top);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n";
  out += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  if (!title.empty()) out += text(10, 16, title, "font-size=\"12\" fill=\"#444\"");
  for (std::size_t k = 0; k < charts.size(); ++k) out += drawing(charts[k], kWidth * static_cast<double>(k), top);
  return out + "</svg>\n";
}

}  // namespace calx
