// Header, checks, assumptions, deviations: what a reader needs before the first chart.
#include <algorithm>
#include <cmath>

#include "report/lab_figures.hpp"
#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

std::string status_class(const std::string& status) {
  if (status == "done" || status == "finished" || status == "complete") return "good";
  if (status == "running" || status == "interrupted") return "going";
  return status == "unknown" || status == "no summary yet" ? "going" : "bad";
}

std::string percent(double share) { return format_number(100 * share, 3) + "\xc2\xa0%"; }

std::string wall_text(double seconds) {
  if (seconds < 120) return format_number(seconds, 3) + "\xc2\xa0s";
  if (seconds < 7200) return format_number(seconds / 60, 3) + "\xc2\xa0min";
  return format_number(seconds / 3600, 3) + "\xc2\xa0h";
}

std::string list(const std::vector<std::string>& entries) {
  std::string out = "<ol>";
  for (const std::string& e : entries) out += "<li>" + html_text(e) + "</li>";
  return out + "</ol>";
}

/// The time step beside the advice. A step that the case gives above it is judged by the overlaps of the run: none of
/// the limits is exact, so that a run that ended is no failure of itself.
std::string step_check(const RunFolder& run) {
  const auto binding = std::find_if(run.limits.begin(), run.limits.end(),
                                    [](const StepLimitRow& l) { return l.binds && l.seconds > 0; });
  if (binding == run.limits.end() || !(run.time_step > 0)) return "";
  const auto seconds = [](double s) { return format_quantity(s, "s", 4); };
  const std::string advice =
      "Advice: " + html_text(binding->name) + (binding->where.empty() ? "" : ", " + html_text(binding->where)) + ".";
  if (run.time_step <= binding->seconds * (1 + 1e-9))
    return html_check(
        "good", "Time step " + seconds(run.time_step) + " is within the advised " + seconds(binding->seconds) + ".",
        advice);
  std::string text = advice;
  double refused = 0;
  for (const StepLimitRow& l : run.limits)
    if (l.refused_above > 0 && (refused == 0 || l.refused_above < refused)) refused = l.refused_above;
  if (refused > 0) text += " A step above " + seconds(refused) + " is refused.";
  if (run.largest_overlap_share >= 0)
    text += " Largest overlap seen: " + format_number(run.largest_overlap_share, 3) + " of the radius" +
            (run.overlap_limit > 0 ? " (limit " + format_number(run.overlap_limit, 3) + ")" : "") + ".";
  const StepLimitRow& seen = run.law_limit_seen;
  if (seen.seconds > 0)
    text += " At that overlap the law states a stable step of " + seconds(seen.seconds) + " (" + html_text(seen.where) +
            ")" +
            (run.time_step <= seen.seconds
                 ? ", which the step keeps."
                 : ": the step was above it for such a contact, so compare with a run at that step.");
  if (run.status == "stopped") text += " The run stopped early; a smaller step is the first thing to try.";
  return html_check(
      run.status == "stopped" ? "bad" : "open",
      "Time step " + seconds(run.time_step) + " is given, above the advised " + seconds(binding->seconds) + ".", text);
}

}  // namespace

void Sections::header() {
  std::string out = "<div class=\"title\"><h1>" + html_text(run.title) + "</h1><span class=\"status " +
                    status_class(run.status) + "\">" + html_text(run.status) + "</span></div>";
  if (run.status == "running" && run.time_end > 0) {
    const double share = std::min(1.0, run.time / run.time_end);
    out += "<div class=\"progress\"><i style=\"width:" + format_number(100 * share, 3) + "%\"></i></div><p>" +
           format_number(run.time, 4) + " s of " + format_number(run.time_end, 4) +
           " s simulated. The figures below are those of this moment.</p>";
  }
  out += "<div class=\"cards\">";
  for (const LabFigure& f : lab_figures(run))
    out += html_card(html_text(f.name), html_text(f.value), html_text(f.note), f.value == "none" ? "" : "main");
  if (std::isfinite(figures.filled)) {
    out += html_card("mass filled", format_quantity(figures.filled, "kg", 5),
                     figures.fill ? "sensor " + html_text(figures.fill->name) : "sum over cycles", "main");
  }
  const CycleFigures& c = figures.cycles;
  if (!c.cycle.empty()) {
    const std::string note = "sd " + format_quantity(c.per_cycle.deviation, "kg", 3) + ", cycles " +
                             format_number(c.first) + " to " + format_number(c.cycle.back());
    out += html_card("mass per cycle, mean", format_quantity(c.per_cycle.mean, "kg", 4), note, "main");
  }
  if (run.has_summary) {
    out += html_card("simulated time", format_quantity(run.time, "s", 4),
                     run.steps >= 0 ? format_count(run.steps) + " steps" : "");
  }
  if (run.particles >= 0) out += html_card("particles", format_count(run.particles), "in the world now");
  if (run.time_step > 0) out += html_card("time step", format_quantity(run.time_step, "s", 4), "");
  if (run.particle_steps_per_second > 0) {
    out += html_card(
        "speed", format_number(run.particle_steps_per_second / 1e6, 3) + " M",
        "particle steps per second" + (run.wall_seconds > 0 ? "; wall time " + wall_text(run.wall_seconds) : ""));
  }
  if (std::isfinite(figures.energy_remainder)) {
    const double share = figures.energy_work > 0 ? std::fabs(figures.energy_remainder) / figures.energy_work : 0;
    out += html_card("energy remainder", percent(share),
                     format_quantity(figures.energy_remainder, "J", 3) + " of " +
                         format_quantity(figures.energy_work, "J", 3) + " work done",
                     share > 0.05 ? "bad" : "");
  }
  const char* closed = figures.ledger == KeyFigures::Closed::yes  ? "yes"
                       : figures.ledger == KeyFigures::Closed::no ? "no"
                                                                  : "not stated";
  out += html_card("mass ledger closed", closed, html_text(figures.ledger_text),
                   figures.ledger == KeyFigures::Closed::yes  ? "good"
                   : figures.ledger == KeyFigures::Closed::no ? "bad"
                                                              : "");
  page.header(out + "</div>");
}

void Sections::overview() {
  std::string checks = "<ul class=\"checks\">";
  if (figures.ledger != KeyFigures::Closed::unknown) {
    const bool good = figures.ledger == KeyFigures::Closed::yes;
    checks += html_check(good ? "good" : "bad", good ? "Mass ledger closes." : "Mass ledger does not close.",
                         html_text(figures.ledger_text) + ".");
  } else {
    checks += html_check("open", "Mass ledger not checked.", "Add a sensor of kind mass-ledger.");
  }
  if (std::isfinite(figures.energy_remainder) && figures.energy_work > 0) {
    const double share = std::fabs(figures.energy_remainder) / figures.energy_work;
    // 1 % and 5 %: house rule for "converged in time" and "look at the time step"; the number itself is what counts.
    checks += html_check(share <= 0.01   ? "good"
                         : share <= 0.05 ? "open"
                                         : "bad",
                         "Energy remainder " + percent(share) + " of the work done.",
                         share <= 0.05 ? "What time integration lost or gained."
                                       : "The time step is too large for this stiffness, or the run blew up.");
  } else {
    checks +=
        html_check("open", "Energy not checked.", "Add a sensor of kind energy to see what time integration loses.");
  }
  const double requested = value_of(run.mass, "requested", 0), delivered = value_of(run.mass, "delivered", 0);
  if (requested > 0) {
    const bool full = delivered >= 0.999 * requested;
    checks += html_check(
        full ? "good" : "open",
        "Sources delivered " + format_quantity(delivered, "kg", 4) + " of " + format_quantity(requested, "kg", 4) + ".",
        full ? "" : "A source had no room, or the run ended before it was done.");
  }
  checks += step_check(run);
  for (const std::string& n : run.notes) checks += html_check("open", "Not complete:", html_text(n) + ".");
  checks += "</ul>";

  std::string assumed = run.assumptions.empty() ? html_absent("The case lists no assumptions.")
                                                : "<p>Not measured or not known; chosen for this run. Agreement "
                                                  "reached by choosing them is calibration, not validation.</p>" +
                                                      list(run.assumptions);
  std::string out = "<div class=\"two\"><div class=\"box\"><h3>Checks</h3>" + checks +
                    "</div><div class=\"box assumed\"><h3>Assumptions (" + std::to_string(run.assumptions.size()) +
                    ")</h3>" + assumed + "</div></div>";
  if (!run.deviations.empty()) {
    std::vector<std::vector<std::string>> rows = {{"Figure", "Source", "This run", "Reference", "Difference"}};
    std::vector<std::string> sentences;
    for (const DeviationRow& d : run.deviations) {
      if (!d.has_numbers) {
        sentences.push_back(d.text);
        continue;
      }
      rows.push_back({html_text(d.text), html_text(d.source), format_quantity(d.value, d.unit, 5),
                      format_quantity(d.reference, d.unit, 5),
                      std::fabs(d.reference) > 0 ? percent((d.value - d.reference) / std::fabs(d.reference)) : "-"});
    }
    out += "<h3>Deviations</h3>" + (rows.size() > 1 ? html_table(rows, 2) : "") +
           (sentences.empty() ? "" : list(sentences));
  }
  page.section("trust", "Can I believe this run?", "Checks", out);
}

}  // namespace calx
