// Whether the diagnosis can be trusted: the same analysis on made-up data with known causes; what to measure next.
#include <cmath>
#include <limits>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

using Power = DiagnosisResult::Power;

constexpr double wrong_share = 0.05;  // of the trials; more of them named wrong is bad

std::string count_html(double part, double all) {
  if (!(all > 0)) return "-";
  return format_number(std::round(100 * part / all)) + "\xc2\xa0% <small>(" + format_number(part) + " of " +
         format_number(all) + ")</small>";
}

/// The trials of a cause whose strength is nearest to the one found, by their ratio.
const Power* nearest(const std::vector<Power>& powers, const DiagnosisResult::Cause& cause) {
  const Power* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Power& p : powers) {
    if (p.cause != cause.label || cause.parameters.empty()) continue;
    const DiagnosisResult::Amount& found = cause.parameters[0];
    const double off = std::isfinite(found.off) ? found.off : 0;
    const double distance = std::fabs(std::log((p.strength - off) / (found.value - off)));
    if (distance < least) least = distance, best = &p;
  }
  return best;
}

std::string power_sentence(const Power& p) {
  return "With these data, a cause " + names_html({p.cause}) + " of strength " + quantity_html(p.strength, p.unit) +
         " would be named right " + count_html(p.right, p.studies) + ", wrong " + count_html(p.wrong, p.studies) +
         ", and left open otherwise.";
}

std::string powers_table(const std::vector<Power>& powers) {
  std::vector<std::vector<std::string>> rows = {
      {"If the cause were", "of strength", "named right", "named wrong", "left open"}};
  const Power* last = nullptr;
  for (const Power& p : powers) {
    const bool again = last && last->cause == p.cause;
    rows.push_back({again ? "" : names_html({p.cause}), quantity_html(p.strength, p.unit),
                    count_html(p.right, p.studies), count_html(p.wrong, p.studies),
                    count_html(p.studies - p.right - p.wrong, p.studies)});
    last = &p;
  }
  return html_table(rows, 1);
}

}  // namespace

void DiagnosisSections::trust() {
  std::string out;
  if (d.powers.empty() && !(d.controls > 0)) {
    page.section("trust", "5. Can it be trusted", "Trust", html_absent("diagnosis.json holds no self-test."));
    return;
  }
  out +=
      "<p>The whole analysis was done again on made-up measurements, drawn from the fitted simulation with the noise "
      "and the number of values of this study, so that the right answer was known.</p><ul class=\"checks\">";
  if (d.controls > 0)
    out += html_check(
        d.controls_named > 0 ? "bad" : "good", "With nothing wrong, a cause was named",
        count_html(d.controls_named, d.controls) +
            (d.controls_named > 0 ? "."
                                  : "; " + format_number(d.controls) + " trials alone leave room for up to " +
                                        format_number(300 / d.controls, 2) + "\xc2\xa0%."));
  for (const DiagnosisResult::Cause* c : d.named())
    if (const Power* p = nearest(d.powers, *c))
      out += html_check(p->wrong > wrong_share * p->studies ? "bad"
                        : p->right >= 0.5 * p->studies      ? "good"
                                                            : "open",
                        "The cause named here:", power_sentence(*p));
  out += "</ul>";
  if (!d.powers.empty()) out += "<h3>What would be found</h3>" + powers_table(d.powers);
  if (d.stated.size() == d.observed.size() && d.stated.size() > 1) {
    Chart chart;
    chart.title = "Stated and true probabilities";
    chart.x.title = "stated probability", chart.y.title = "share that was true";
    chart.y.from_zero = true;
    chart.series = {{ChartSeries::Style::dashed, "equal", {0, 1}, {0, 1}, {}, 1},
                    {ChartSeries::Style::points, "self-test", d.stated, d.observed, {}, 0},
                    {ChartSeries::Style::line, "used for this page", d.stated, d.observed, {}, 0}};
    chart.caption =
        "Below the dashed line the bare method is too sure of itself. The probabilities on this page are read from "
        "this curve, so that they are as often true as they say.";
    out += "<div class=\"charts\">" + page.chart(chart) + "</div>";
  }
  page.section("trust", "5. Can it be trusted", "Trust", out);
}

void DiagnosisSections::next() {
  if (d.next.empty()) {
    page.section("next", "6. Measure next", "Next",
                 html_absent(d.verdict == "named" || d.verdict == "none"
                                 ? "No further measurement was weighed."
                                 : "The study names no measurement that could be made. List those you could make under "
                                   "\"experiments\", with their cost, and they will be weighed here."));
    return;
  }
  std::vector<std::vector<std::string>> rows = {{"Measurement", "Clear verdict", "Cost", "Expected information, nats"}};
  for (const DiagnosisResult::Measurement& m : d.next)
    rows.push_back(
        {html_text(m.name), share_html(m.clear_verdict), format_number(m.cost, 3), format_number(m.information, 2)});
  page.section(
      "next", "6. Measure next", "Next",
      "<p>Of the measurements that the study says could be made, <b>" + html_text(d.next[0].name) +
          "</b> tells most for its cost about what is left open." +
          std::string(d.next[0].clear_verdict < 0.5 ? " It is not likely to settle it alone." : "") + "</p>" +
          html_table(rows, 1) +
          "<p class=\"note\">Clear verdict: how likely the measurement leaves one explanation. Information: ln 2, "
          "0.69, is the answer to one question of yes or no. Cost: as the study gives it.</p>");
}

}  // namespace calx
