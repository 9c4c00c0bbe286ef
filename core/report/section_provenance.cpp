// Time-step limits, speed, provenance and the case.
#include <algorithm>
#include <cmath>

#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {

void Sections::time_step() {
  std::string out;
  if (run.limits.empty()) {
    out = html_absent("No time-step limits: summary.json does not state them.");
  } else {
    double longest = 0, shortest = 1e300;
    for (const StepLimitRow& l : run.limits) {
      if (l.seconds > 0 && std::isfinite(l.seconds))
        longest = std::max(longest, l.seconds), shortest = std::min(shortest, l.seconds);
    }
    for (const double taken : {run.time_step, run.law_limit_seen.seconds})
      if (taken > 0) shortest = std::min(shortest, taken);
    // Bars on a logarithmic scale from a third of the shortest to the longest: limits differ by powers of ten.
    const double low = std::log(shortest / 3), high = std::log(longest);
    const auto bar = [&](double seconds, const char* css) {
      if (!(seconds > 0) || !(high > low)) return std::string();
      const double share = 100 * std::min(1.0, std::max(0.01, (std::log(seconds) - low) / (high - low)));
      return "<span class=\"bar " + std::string(css) + "\"><i style=\"width:" + format_number(share, 3) +
             "%\"></i></span>";
    };
    std::vector<std::vector<std::string>> rows = {
        {"Advised by", "Where", "", "At most", "Step / advice", "Refused above"}};
    for (const StepLimitRow& l : run.limits) {
      const std::string name = html_text(l.name);
      rows.push_back({l.binds ? "<b>" + name + "</b> <span class=\"tag\">binds</span>" : name, html_text(l.where),
                      bar(l.seconds, l.binds ? "binds" : ""), format_quantity(l.seconds, "s", 4),
                      run.time_step > 0 && l.seconds > 0 ? format_number(run.time_step / l.seconds, 3) : "-",
                      l.refused_above > 0 ? format_quantity(l.refused_above, "s", 4) : "-"});
    }
    const StepLimitRow& seen = run.law_limit_seen;
    if (seen.seconds > 0)
      rows.push_back({"law, largest overlap of the run", html_text(seen.where), bar(seen.seconds, ""),
                      format_quantity(seen.seconds, "s", 4),
                      run.time_step > 0 ? format_number(run.time_step / seen.seconds, 3) : "-", ""});
    if (run.time_step > 0)
      rows.push_back({"step taken", "", bar(run.time_step, "taken"), format_quantity(run.time_step, "s", 4), "", ""});
    out = html_table(rows, 3, "limits") + "<p class=\"note\">Bars: logarithmic scale.</p>";
  }
  page.section("time-step", "Time-step limits", "Time step", out);
}

void Sections::provenance() {
  std::string out;
  std::vector<std::vector<std::string>> rows = {{"What", "Value"}};
  for (const auto& [name, value] : run.provenance) {
    std::string shown = name;
    std::replace(shown.begin(), shown.end(), '_', ' ');
    rows.push_back({html_text(shown), "<code>" + html_text(value) + "</code>"});
  }
  if (run.wall_seconds >= 0) rows.push_back({"wall time", format_number(run.wall_seconds, 4) + " s"});
  out += rows.size() > 1 ? html_table(rows, 2) : html_absent("No provenance: summary.json does not state it.");
  if (!run.plugins.empty()) {
    std::vector<std::vector<std::string>> plugins = {{"Plugin", "Version", "SHA-256", ""}};
    for (const PluginRow& p : run.plugins) {
      plugins.push_back(
          {html_text(p.id), html_text(p.version), "<code>" + html_text(p.hash) + "</code>", html_text(p.note)});
    }
    out += html_table(plugins, 4);
  }
  page.section("provenance", "Provenance", "Provenance", out);
}

void Sections::case_text() {
  page.section("case", "The case", "Case",
               run.case_text.empty()
                   ? html_absent("No case: case.json is not there.")
                   : "<details><summary>case.json as resolved; running it again gives the same bits</summary><pre>" +
                         html_text(run.case_text) + "</pre></details>");
}

}  // namespace calx
