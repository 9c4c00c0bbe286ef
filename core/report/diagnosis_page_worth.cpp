// What the extension is worth: held-out data before and after, and runs with new seeds.
#include <cmath>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

using Style = ChartSeries::Style;
using Numbers = std::vector<double>;

constexpr double much_left = 2;  // sd; a right model would be near 1

/// Simulated less measured.
struct Miss {
  double mean = DiagnosisResult::unknown;  // unit of the observable
  double rms = DiagnosisResult::unknown;   // in sd of the measurement
};

Miss miss_of(const Numbers& simulated, const Numbers& measured, const Numbers& sd) {
  double sum = 0, squares = 0, count = 0;
  for (std::size_t k = 0; k < measured.size() && k < simulated.size() && k < sd.size(); ++k) {
    const double error = simulated[k] - measured[k];
    if (!std::isfinite(error) || !(sd[k] > 0)) continue;
    sum += error, squares += std::pow(error / sd[k], 2), count += 1;
  }
  if (count == 0) return {};
  return {sum / count, std::sqrt(squares / count)};
}

/// Fitted and held-out numbers together.
Miss miss_of_all(const DiagnosisResult::Observable& o, const Numbers& simulated) {
  const Miss fit = miss_of(simulated, o.fit, o.sd), hold = miss_of(simulated, o.hold, o.sd);
  if (!std::isfinite(fit.rms)) return hold;
  if (!std::isfinite(hold.rms)) return fit;
  return {(fit.mean + hold.mean) / 2, std::sqrt((fit.rms * fit.rms + hold.rms * hold.rms) / 2)};
}

}  // namespace

std::string DiagnosisSections::held_out_table() const {
  std::vector<std::vector<std::string>> rows = {
      {"Held-out observable", "Simulation before", "and after", "Typical error before, sd", "and after"}};
  std::string worse, left;
  for (const DiagnosisResult::Observable& o : d.observables) {
    const Miss before = miss_of_all(o, o.before), after = miss_of_all(o, o.after);
    // A tenth and a tenth of an sd: less is nothing that a person could act on.
    if (after.rms > 1.1 * before.rms && after.rms > before.rms + 0.1)
      worse += html_check("bad", html_text(o.name) + " got worse.",
                          "Typical error " + number_html(before.rms, 2) + " sd before, " + number_html(after.rms, 2) +
                              " sd after (" + use_html(o) + ").");
    if (o.hold.empty()) continue;
    const Miss hold_before = miss_of(o.before, o.hold, o.sd), hold_after = miss_of(o.after, o.hold, o.sd);
    rows.push_back({html_text(o.name), error_html(hold_before.mean, o.unit), error_html(hold_after.mean, o.unit),
                    number_html(hold_before.rms, 2), number_html(hold_after.rms, 2)});
    if (hold_after.rms > much_left)
      left += (left.empty() ? "" : ", ") + html_text(o.name) + " " + number_html(hold_after.rms, 2) + " sd";
  }
  std::string out;
  if (rows.size() > 1)
    out += html_table(rows, 3) +
           "<p class=\"note\">Typical error: root mean square over the curve, in standard deviations of the "
           "measurement; 1 is as good as the measurement itself. Before: recalibrated; after: " +
           added() + " and recalibrated.</p>";
  if (worse.empty()) worse = html_check("good", "No observable got worse.", "Fitted ones included.");
  if (!left.empty())
    worse += html_check("open", "Not all is explained.",
                        "Typical errors that are left: " + left + ". A right model would be near 1.");
  return out + "<ul class=\"checks\">" + worse + "</ul>";
}

std::string DiagnosisSections::held_out_charts() {
  const auto& c = d.confirmation;
  std::size_t rows = 0;
  for (const DiagnosisResult::Observable& o : d.observables) rows += o.before.size();
  const bool runs = c.done && c.after.size() == rows && c.before.size() == rows;
  std::string out;
  std::size_t first = 0;
  for (const DiagnosisResult::Observable& o : d.observables) {
    const std::size_t from = first;
    first += o.before.size();
    if (o.hold.empty() || o.x.size() < 2 || o.hold.size() != o.x.size()) continue;
    const auto less_measured = [&](const Numbers& simulated, std::size_t offset) {
      Numbers v;
      for (std::size_t k = 0; k < o.hold.size() && offset + k < simulated.size(); ++k)
        v.push_back(simulated[offset + k] - o.hold[k]);
      return v;
    };
    Chart chart = curve_of(o);
    chart.y.title = "simulated less measured";
    chart.series = {{Style::band, "measured", o.x, Numbers(o.x.size(), 0.0), o.sd, 3},
                    {Style::line, "before", o.x, less_measured(o.before, 0), {}, 0},
                    {Style::line, "after", o.x, less_measured(o.after, 0), {}, 2}};
    if (o.sd.size() != o.x.size()) chart.series[0].style = Style::line, chart.series[0].error.clear();
    if (runs) {
      chart.series.push_back({Style::points, "before, really run", o.x, less_measured(c.before, from), {}, 0});
      chart.series.push_back({Style::points, "after, really run", o.x, less_measured(c.after, from), {}, 2});
    }
    out += page.chart(chart);
  }
  return out.empty() ? "" : "<div class=\"charts\">" + out + "</div>";
}

std::string DiagnosisSections::confirmation() const {
  const auto& c = d.confirmation;
  if (!c.done && d.generic.accepted)
    return "<ul class=\"checks\">" +
           html_check(
               "good", "The improvement by the generic term is there.",
               "The old case and that of section 3 were really run with new seeds: typical error on held-out data " +
                   number_html(d.generic.error_before, 2) + " sd before, " + number_html(d.generic.error_after, 2) +
                   " sd with the term.") +
           "</ul>";
  if (!c.done)
    return html_absent(d.verdict == "named" ? "The extended case was not run with new seeds."
                                            : "There is no extended case to run.");
  std::string out = "<p>The old and the extended case were really run, " + format_number(c.seeds) +
                    " times each with seeds that the diagnosis had not used.</p><ul class=\"checks\">";
  out += html_check(c.holds() ? "good" : "bad",
                    !c.passed        ? "The improvement is not there."
                    : c.contradicted ? "The improvement is not what was foretold."
                                     : "The improvement is there.",
                    "Typical error on held-out data " + number_html(c.error_before) + " sd with the old case, " +
                        number_html(c.error_after) + " sd with the extended one" +
                        (c.contradicted ? " instead of " + number_html(c.error_foretold) +
                                              " sd: the forecasts that chose the cause are in doubt"
                                        : "") +
                        "; the held-out data are " + likelier_html(c.gain) + " with it.");
  if (std::isfinite(c.agreement_p)) {
    const bool agrees = c.agreement_p >= 0.05;
    out += html_check(
        agrees ? "good" : "open",
        agrees ? "The runs agree with what was foretold." : "The runs differ from what was foretold.",
        "Could chance alone make a difference like this? " + chance_html(c.agreement_p) +
            " (p = " + number_html(c.agreement_p, 2) + ")." +
            (agrees ? ""
                    : " Lines in the plots above are foretold, dots were run. The forecast takes a trace to grow in "
                      "proportion to the strength of its cause; where it does not, the strength found is rough."));
  }
  return out + "</ul>";
}

void DiagnosisSections::worth() {
  std::string out;
  if (!d.held_out) {
    out += html_absent("The study holds no data out and its repeats cannot be split, so that no gain can be measured.");
  } else if (!d.has_after()) {
    out += html_absent("No cause was added, so that there is nothing to compare.");
  } else {
    if (d.split_repeats)
      out +=
          "<p>The study holds no data out, so the later half of the repeats was kept aside. Data at other conditions "
          "would prove more.</p>";
    if (std::isfinite(d.gain)) {
      const bool enough = d.gain >= d.gain_needed;
      out +=
          "<ul class=\"checks\">" +
          html_check(enough ? "good" : "bad", enough ? "The gain is large enough." : "The gain is too small to count.",
                     "Data that were not fitted are " + likelier_html(d.gain) + " " + added() +
                         " than with the recalibrated simulation alone; at least " +
                         format_number(std::exp(d.gain_needed), 2) + " times are asked for. (Log score " +
                         number_html(d.gain) + " \xc2\xb1 " + number_html(d.gain_sd, 2) + " nats, needed " +
                         format_number(d.gain_needed, 2) + ".)") +
          "</ul>";
    }
    out += held_out_table() + held_out_charts();
  }
  out += "<h3>Confirmed by runs</h3>" + confirmation();
  page.section("worth", "4. What it is worth", "Worth", out);
}

}  // namespace calx
