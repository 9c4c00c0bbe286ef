#include "report/calibration_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "io/io.hpp"
#include "report/page.hpp"
#include "report/statistics.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

using Json = nlohmann::json;

std::vector<double> numbers(const Json& list) {
  std::vector<double> out;
  for (const Json& v : list) out.push_back(v.is_number() ? v.get<double>() : std::nan(""));
  return out;
}

std::string with_unit(double value, const std::string& unit, int digits = 4) {
  return format_number(value, digits) + (unit.empty() || unit == "1" ? "" : "\xc2\xa0" + html_text(unit));
}

std::string axis_unit(const std::string& unit) { return unit == "1" ? "" : unit; }

/// One column a parameter.
std::vector<std::vector<double>> read_samples(const std::string& path, std::size_t columns) {
  std::vector<std::vector<double>> out(columns);
  if (!std::filesystem::exists(path)) return out;
  std::istringstream lines(read_text(path));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t k = 0; k < columns && std::getline(cells, cell, ','); ++k) out[k].push_back(std::stod(cell));
  }
  return out;
}

ChartSeries series(const std::string& name, ChartSeries::Style style, std::vector<double> x, std::vector<double> y,
                   int colour = -1, std::vector<double> error = {}) {
  ChartSeries s;
  s.name = name;
  s.style = style;
  s.x = std::move(x);
  s.y = std::move(y);
  s.error = std::move(error);
  s.colour = colour;
  return s;
}

class CalibrationPage {
 public:
  explicit CalibrationPage(const std::string& dir)
      : dir_(dir), c_(Json::parse(read_text(dir + "/calibration.json"), nullptr, false)) {
    if (!c_.is_object() || !c_.contains("parameters"))
      throw Error(Fault::files, dir + "/calibration.json: is not the result of a calibration");
    samples_ = read_samples(dir + "/samples.csv", c_["parameters"].size());
  }

  std::string write() {
    Page page(c_.value("title", "calibration"));
    page_ = &page;
    header();
    parameters();
    predictions();
    posterior();
    emulators();
    cost();
    assumptions();
    const std::string path = dir_ + "/report.html";
    write_text_atomically(path, page.html());
    return path;
  }

 private:
  void header() {
    std::string out = "<div class=\"title\"><h1>" + html_text(c_.value("title", "calibration")) +
                      "</h1><span class=\"status good\">calibrated</span></div><div class=\"cards\">";
    for (const Json& p : c_["parameters"]) {
      const std::string unit = p["unit"], told = p["told"];
      out += html_card(html_text(p["name"]), with_unit(p["mean"], unit) + " \xc2\xb1 " + format_number(p["sd"], 2),
                       "90 % interval " + format_number(p["q05"], 4) + " to " + with_unit(p["q95"], unit) + "; " + told,
                       told == "found"    ? "good"
                       : told == "weakly" ? "main"
                                          : "bad");
    }
    out += html_card(
        "runs", format_number(c_["runs"]["spent"]),
        "of " + format_number(c_["runs"]["budget"]) + " planned, " + format_number(c_["runs"]["failed"]) + " failed",
        "");
    page_->header(out + "</div>");
  }

  void parameters() {
    std::string checks = "<ul class=\"checks\">";
    for (const Json& p : c_["parameters"]) {
      const double share = p["identifiability"];
      const std::string name = html_text(p["name"]);
      if (share < 0.5)
        checks +=
            html_check("good", name + " is found.", "Its spread is " + format_number(share, 2) + " of the prior's.");
      else
        checks += html_check(share < 0.8 ? "open" : "bad",
                             name + (share < 0.8 ? " is told weakly." : " is not told by the data."),
                             "Its spread is still " + format_number(share, 2) +
                                 " of the prior's; another kind of measurement is needed.");
    }
    for (const Json& f : c_["confounded"])
      checks += html_check(
          "bad", html_text(f["parameters"][0]) + " and " + html_text(f["parameters"][1]) + " are told only together.",
          "Correlation " + format_number(f["correlation"], 2) +
              ": a change of one is made up by the other. A measurement that answers to one of them "
              "alone tells them apart.");
    for (const Json& o : c_["observables"])
      checks += html_check(o["agrees"] ? "good" : "bad",
                           html_text(o["name"]) + (o["agrees"] ? " agrees" : " does not agree") +
                               (o["use"] == "fit" ? "." : " (held out)."),
                           "Distance " + format_number(o["z"], 2) + " standard deviations.");
    for (const Json& n : c_["notes"]) checks += html_check("open", "Note:", html_text(n) + ".");
    std::vector<std::vector<std::string>> rows = {
        {"Parameter", "Where", "Mean", "sd", "5 %", "50 %", "95 %", "Range", "sd / prior sd"}};
    for (const Json& p : c_["parameters"]) {
      std::string where;
      for (const Json& s : p["set"]) where += (where.empty() ? "" : "<br>") + ("<code>" + html_text(s)) + "</code>";
      rows.push_back({html_text(p["name"]), where, with_unit(p["mean"], p["unit"], 5), format_number(p["sd"], 3),
                      format_number(p["q05"], 4), format_number(p["q50"], 4), format_number(p["q95"], 4),
                      format_number(p["range"][0], 4) + " to " + format_number(p["range"][1], 4),
                      format_number(p["identifiability"], 2)});
    }
    page_->section(
        "found", "What the data tell", "Parameters",
        html_table(rows, 2) + "<div class=\"two\"><div class=\"box\"><h3>Checks</h3>" + checks + "</ul></div></div>");
  }

  void predictions() {
    std::string charts = "<div class=\"charts\">";
    // Scalars side by side, in units of what the measurement and the tolerance leave open.
    Chart scalars;
    scalars.title = "Measured and predicted, single values";
    scalars.caption =
        "Zero is the measured mean; the unit is its standard error with the tolerance of the model. Bars: one standard "
        "deviation.";
    scalars.x.title = "observable";
    scalars.y.title = "difference / sd";
    std::vector<double> at, zero, one, predicted, spread, confirmed_at, confirmed, confirmed_error;
    std::vector<std::vector<std::string>> rows = {
        {"Observable", "Kind", "Use", "Measured", "Predicted", "Runs at the mean", "z"}};
    for (const Json& o : c_["observables"]) {
      if (o["x"].size() > 1) {
        charts += curve(o);
        continue;
      }
      const std::string unit = o["unit"];
      const double measured = o["measured"][0], error = o["measured_sd"][0], tolerance = o["tolerance"],
                   size = std::hypot(error, tolerance), mean = o["predicted"]["mean"][0], sd = o["predicted"]["sd"][0];
      at.push_back(static_cast<double>(scalars.x.categories.size()));
      scalars.x.categories.push_back(o["name"].get<std::string>() + (o["use"] == "fit" ? "" : " (held out)"));
      zero.push_back(0);
      one.push_back(1);
      predicted.push_back((mean - measured) / size);
      spread.push_back(sd / size);
      std::string seen = "-";
      if (!o["confirmed"]["mean"].empty()) {
        const double value = o["confirmed"]["mean"][0], value_sd = o["confirmed"]["sd"][0];
        seen = with_unit(value, unit) + " \xc2\xb1 " + format_number(value_sd, 2);
        confirmed_at.push_back(at.back() + 0.15);
        confirmed.push_back((value - measured) / size);
        confirmed_error.push_back(value_sd / size);
      }
      rows.push_back({html_text(o["name"]), html_text(o["kind"]), html_text(o["use"]),
                      with_unit(measured, unit) + " \xc2\xb1 " + format_number(error, 2),
                      with_unit(mean, unit) + " \xc2\xb1 " + format_number(sd, 2), seen, format_number(o["z"], 2)});
    }
    if (!at.empty()) {
      const auto beside = [&](double by) {
        std::vector<double> out = at;
        for (double& v : out) v += by;
        return out;
      };
      using Style = ChartSeries::Style;
      scalars.series = {
          series("measured", Style::points, beside(-0.15), zero, 1, one),
          series("predicted", Style::points, at, predicted, 0, spread),
          series("runs at the posterior mean", Style::points, confirmed_at, confirmed, 2, confirmed_error)};
      charts += page_->chart(scalars);
    }
    page_->section("predicted", "Measured against predicted", "Predictions",
                   charts + "</div>" + (rows.size() > 1 ? html_table(rows, 3) : "") +
                       "<p class=\"note\">Held-out observables were not fitted.</p>");
  }

  std::string curve(const Json& o) {
    Chart chart;
    chart.title = o["name"].get<std::string>() + (o["use"] == "fit" ? "" : " (held out)");
    const Quantity x = quantity_of(o["against"]);
    chart.x.title = x.title;
    chart.x.unit = x.unit;
    chart.y.title = o["name"];
    chart.y.unit = axis_unit(o["unit"]);
    const std::vector<double> places = numbers(o["x"]);
    using Style = ChartSeries::Style;
    chart.series = {series("measured", Style::points, places, numbers(o["measured"]), 1, numbers(o["measured_sd"])),
                    series("predicted", Style::line, places, numbers(o["predicted"]["mean"]), 0),
                    series("5 %", Style::dashed, places, numbers(o["predicted"]["q05"]), 0),
                    series("95 %", Style::dashed, places, numbers(o["predicted"]["q95"]), 0)};
    if (!o["confirmed"]["mean"].empty())
      chart.series.push_back(
          series("runs at the posterior mean", Style::points, places, numbers(o["confirmed"]["mean"]), 2));
    chart.caption = "Distance " + format_number(o["z"], 2) + " standard deviations, over all places together.";
    return page_->chart(chart);
  }

  void posterior() {
    const std::size_t n = c_["parameters"].size();
    if (samples_.empty() || samples_[0].empty()) {
      page_->section("posterior", "Posterior", "Posterior", html_absent("No draws: samples.csv is not there."));
      return;
    }
    std::string out = "<div class=\"charts\">";
    for (std::size_t k = 0; k < n; ++k) out += histogram(k);
    // The six pairs that hang together most; more would bury them.
    std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> pairs;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < k; ++j) pairs.push_back({-std::fabs(c_["correlations"][k][j].get<double>()), {j, k}});
    std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t k = 0; k < std::min<std::size_t>(pairs.size(), 6); ++k)
      out += pair(pairs[k].second.first, pairs[k].second.second);
    out += "</div>";
    if (n > 1) {
      std::vector<std::vector<std::string>> rows = {{"Correlation"}};
      for (const Json& p : c_["parameters"]) rows[0].push_back(html_text(p["name"]));
      for (std::size_t k = 0; k < n; ++k) {
        rows.push_back({html_text(c_["parameters"][k]["name"])});
        for (std::size_t j = 0; j < n; ++j) rows.back().push_back(format_number(c_["correlations"][k][j], 2));
      }
      out += html_table(rows, 1);
    }
    page_->section("posterior", "Posterior", "Posterior", out);
  }

  ChartAxis axis_of(std::size_t k) const {
    ChartAxis out;
    out.title = c_["parameters"][k]["name"];
    out.unit = axis_unit(c_["parameters"][k]["unit"]);
    return out;
  }

  std::string histogram(std::size_t k) {
    const Json& p = c_["parameters"][k];
    const double low = p["range"][0], high = p["range"][1];
    constexpr std::size_t kBins = 40;
    std::vector<double> x, y(kBins, 0);
    const double width = (high - low) / kBins;
    for (std::size_t b = 0; b < kBins; ++b) x.push_back(low + (static_cast<double>(b) + 0.5) * width);
    for (const double v : samples_[k]) {
      const double bin = std::floor((v - low) / width);
      if (bin >= 0 && bin < kBins)
        y[static_cast<std::size_t>(bin)] += 1 / (width * static_cast<double>(samples_[k].size()));
    }
    Chart chart;
    chart.title = p["name"];
    chart.x = axis_of(k);
    chart.y.title = "density";
    chart.y.from_zero = true;
    chart.series = {series("posterior", ChartSeries::Style::area, x, y, 0)};
    if (p["prior"] == "uniform")
      chart.series.push_back(
          series("prior", ChartSeries::Style::dashed, {low, high}, {1 / (high - low), 1 / (high - low)}, 1));
    chart.marks = {{p["q05"], "5 %"}, {p["q95"], "95 %"}};
    return page_->chart(chart);
  }

  std::string pair(std::size_t j, std::size_t k) {
    Chart chart;
    chart.title =
        c_["parameters"][j]["name"].get<std::string>() + " and " + c_["parameters"][k]["name"].get<std::string>();
    chart.caption = "Draws from the posterior; correlation " + format_number(c_["correlations"][k][j], 2) + ".";
    chart.x = axis_of(j);
    chart.y = axis_of(k);
    std::vector<double> x, y;
    // Some 400 dots show the shape; all of them would be one blot.
    const std::size_t step = std::max<std::size_t>(1, samples_[j].size() / 400);
    for (std::size_t s = 0; s < samples_[j].size(); s += step) x.push_back(samples_[j][s]), y.push_back(samples_[k][s]);
    chart.series = {series("draws", ChartSeries::Style::points, x, y, 0)};
    return page_->chart(chart);
  }

  void emulators() {
    std::string out =
        "<p>An emulator stands for the simulation between the places that were run. Each dot is a place it has not "
        "seen: "
        "what it said, against what the runs gave. The mean square of the differences, in its own standard deviations, "
        "is near 1 when it knows how much it knows.</p><div class=\"charts\">";
    for (const Json& e : c_["emulators"]) {
      const Json& left_out = e["leave_one_out"];
      const std::vector<double> seen = numbers(left_out["simulated"]);
      Chart chart;
      chart.title = e["observable"];
      chart.x.title = e["components"] > 1 ? "simulated, first component" : "simulated";
      chart.y.title = "predicted";
      const auto ends = std::minmax_element(seen.begin(), seen.end());
      chart.series = {
          series("places left out", ChartSeries::Style::points, seen, numbers(left_out["predicted"]), 0,
                 numbers(left_out["sd"])),
          series("equal", ChartSeries::Style::dashed, {*ends.first, *ends.second}, {*ends.first, *ends.second}, 1)};
      chart.caption = "Mean square " + format_number(left_out["mean_square"], 2) + "; scatter of one run " +
                      format_number(e["noise_sd"], 3) + "; the emulator is " +
                      format_number(100 * e["share_of_variance"].get<double>(), 2) +
                      " % of the variance that is left open at the posterior.";
      out += page_->chart(chart);
    }
    page_->section("emulators", "Emulators", "Emulators", out + "</div>");
  }

  void cost() {
    std::vector<std::vector<std::string>> rows = {{"Wave", "Places", "Runs", "Plausible share of the ranges"}};
    for (const Json& p : c_["parameters"]) rows[0].push_back(html_text(p["name"]) + ", plausible");
    std::size_t number = 0;
    for (const Json& w : c_["waves"]) {
      rows.push_back({format_number(++number) + (w["reduced"] ? " (reduced)" : ""), format_number(w["places"]),
                      format_number(w["runs"]), format_number(w["plausible_share"], 3)});
      for (const Json& p : c_["parameters"]) {
        const Json& ends = w["plausible"][p["name"].get<std::string>()];
        rows.back().push_back(format_number(ends[0], 3) + " to " + format_number(ends[1], 3));
      }
    }
    std::string out = html_table(rows, 1);
    const std::string path = dir_ + "/cost.json";
    if (std::filesystem::exists(path)) {
      const Json cost = Json::parse(read_text(path), nullptr, false);
      out += "<p>" + format_number(cost["runs"]) + " runs, " + format_number(cost["cached"]) +
             " of them taken from earlier, " + format_number(cost["failed"]) + " failed; " +
             format_quantity(cost["run_seconds"], "s", 3) + " of run time in all, executor " +
             html_text(cost["executor"]) +
             ". Every run with its parameters stands in runs.csv, every draw in "
             "samples.csv. material.json holds the posterior mean for cases to extend.</p>";
    }
    page_->section("cost", "Runs and cost", "Runs", out);
  }

  void assumptions() {
    std::string out;
    if (c_["assumptions"].empty())
      out = html_absent("The study lists no assumptions.");
    else
      out += "<div class=\"box assumed\"><ol>";
    for (const Json& a : c_["assumptions"]) out += "<li>" + html_text(a) + "</li>";
    if (!c_["assumptions"].empty()) out += "</ol></div>";
    std::vector<std::vector<std::string>> rows = {{"Observable", "Repeats", "Error of the mean", "Tolerance"}};
    for (const Json& o : c_["observables"])
      rows.push_back({html_text(o["name"]), format_number(o["repeats"]),
                      with_unit(spread_of(numbers(o["measured_sd"])).mean, o["unit"], 3),
                      with_unit(o["tolerance"], o["unit"], 3)});
    out += html_table(rows, 1) +
           "<p class=\"note\">The tolerance is what the model may miss without being wrong (standard deviation). A "
           "calibrated value belongs to these grains and these tests; agreement with the data it was fitted to is no "
           "validation.</p><p class=\"note\">Study " +
           html_text(c_["study"]["file"]) + ", SHA-256 <code>" + html_text(c_["study"]["sha256"]) + "</code>, calx " +
           html_text(c_["calx"]) + ", seed " + format_number(c_["seed"]) + ".</p>";
    page_->section("assumptions", "Assumptions and noise", "Assumptions", out);
  }

  std::string dir_;
  Json c_;
  std::vector<std::vector<double>> samples_;
  Page* page_ = nullptr;
};

}  // namespace

std::string write_calibration_report(const std::string& dir) { return CalibrationPage(dir).write(); }

}  // namespace calx
