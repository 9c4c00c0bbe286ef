// What a diagnosis does not say: effects that were not tried, assumptions, notes; and where it comes from.
#include <algorithm>
#include <cstdlib>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

std::string list_html(const std::vector<std::string>& entries) {
  std::string out = "<ol>";
  for (const std::string& e : entries) out += "<li>" + html_text(e) + "</li>";
  return out + "</ol>";
}

/// A cell with many decimals, to four digits; others as they are.
std::string short_number(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  const bool is_long = !cell.empty() && *end == '\0' && cell.size() > 6 && cell.find('.') != std::string::npos;
  return is_long ? format_number(value, 4) : cell;
}

std::string runs_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::vector<std::string>> out;
  // Names of folders are hashes; runs.csv has them.
  const auto folder = std::find(rows[0].begin(), rows[0].end(), "folder") - rows[0].begin();
  for (const std::vector<std::string>& row : rows) {
    out.emplace_back();
    for (std::size_t k = 0; k < row.size(); ++k)
      if (static_cast<std::ptrdiff_t>(k) != folder) out.back().push_back(html_text(short_number(row[k])));
  }
  return html_table(out, out[0].size());
}

}  // namespace

void DiagnosisSections::limits() {
  std::string out;
  if (d.untested.empty()) {
    out += "<p>Every effect of the library was tried.</p>";
  } else {
    out += "<h3>Effects that were not tried</h3>";
    std::vector<std::vector<std::string>> rows = {{"Effect", "Why not"}};
    for (const auto& [effect, reason] : d.untested)
      rows.push_back({"<code>" + html_text(effect) + "</code>", html_text(reason)});
    out += html_table(rows, 2) + "<p class=\"note\">If one of these is the true cause, it cannot be named here.</p>";
  }
  out += "<div class=\"two\"><div class=\"box assumed\"><h3>Assumptions</h3>" +
         (d.assumptions.empty() ? html_absent("The study lists no assumptions.") : list_html(d.assumptions)) + "</div>";
  if (!d.notes.empty()) out += "<div class=\"box\"><h3>Notes of the diagnosis</h3>" + list_html(d.notes) + "</div>";
  page.section("limits", "7. What was not tested", "Limits", out + "</div>");
}

void DiagnosisSections::provenance() {
  std::string out;
  if (d.has_cost)
    out += "<p>" + format_number(d.runs) + " runs, " + format_number(d.cached) + " of them taken from earlier, " +
           format_number(d.failed) + " failed; " + minutes_html(d.run_seconds) + " of run time in all, executor " +
           html_text(d.executor) + ". runs.csv says where each one lies.</p>";
  else
    out += html_absent("No cost: cost.json is not there.");
  if (d.run_rows.size() > 1)
    out += "<details><summary>all runs (" + std::to_string(d.run_rows.size() - 1) + ")</summary>" +
           runs_table(d.run_rows) + "</details>";
  else
    out += html_absent("No list of runs: runs.csv is not there.");
  std::vector<std::vector<std::string>> rows = {{"What", "Value"}};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) rows.push_back({name, "<code>" + html_text(value) + "</code>"});
  };
  add("study", d.study), add("data, SHA-256", d.data_sha256), add("calx", d.calx), add("seed", d.seed);
  page.section("provenance", "Runs and provenance", "Runs", out + html_table(rows, 2));
}

}  // namespace calx
