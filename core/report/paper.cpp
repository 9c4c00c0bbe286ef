#include "report/paper.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "report/page.hpp"
#include "report/paper_drawings.hpp"
#include "report/paper_figures.hpp"
#include "report/paper_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

struct RowResults {
  PaperResult form[2];
};

std::string list(const std::vector<std::string>& sentences) {
  std::string out = "<ul>";
  for (const std::string& s : sentences) out += "<li>" + html_text(s) + "</li>";
  return out + "</ul>";
}

std::string folded(const std::string& summary, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  return "<details><summary>" + summary + " (" + std::to_string(sentences.size()) + ")</summary>" + list(sentences) +
         "</details>";
}

/// Where the mean of a form lies against the measurement, and whether the scatter of seeds is larger than that.
std::string against_measured(const PaperRow& row, const PaperResult& result) {
  if (result.spread.count == 0) return "";
  const PaperDifference d = difference_to(result.spread.mean, result.spread.mean, row.measured);
  std::string out = difference_html(d, row.measured, row.unit);
  if (d.known && result.spread.count > 1 && d.sign != 0 && std::fabs(d.amount) <= result.spread.deviation)
    out += ", less than one sd";
  return out;
}

std::string scatter_verdict(const PaperRow& row, const PaperResult& result) {
  if (!row.against_scatter || result.spread.count == 0) return "";
  const std::string unit = row.unit == "1" ? "" : "\xc2\xa0" + unit_html(row.unit);
  if (!(result.pooled > 0))
    return html_check("open", "Scatter of seeds not known.", "At least two seeds of each run are needed.");
  const bool inside = std::fabs(result.spread.mean) <= result.pooled;
  return html_check(
      inside ? "good" : "bad",
      inside ? "The difference is no larger than between seeds." : "The difference exceeds that between seeds.",
      "Difference of means " + format_number(result.spread.mean, 3) + unit + ", its standard error " +
          format_number(result.spread.deviation, 2) + unit + "; pooled sd between seeds " +
          format_number(result.pooled, 2) + unit + ".");
}

std::string claims(const PaperRow& row) {
  std::string out;
  const PaperDifference own = own_difference(row);
  for (const PaperClaim& c : row.claims) {
    const std::string said = "\"" + html_text(c.words) + "\" (" + html_text(c.where) + ")";
    if (!own.known || own.sign == c.sign)
      out += html_check("good", "The publication's words agree with its numbers:", said + ".");
    else
      out += html_check("bad", "The publication contradicts itself.",
                        said + " says " + (c.sign < 0 ? "underestimate" : "overestimate") + "; its numbers say " +
                            difference_html(own, row.measured, row.unit) + ". The numbers are what is compared here.");
  }
  return out;
}

std::string figures_table(const PaperRow& row, const RowResults& results) {
  std::vector<std::vector<std::string>> rows = {{"", "Figure", "Against the measurement"}};
  const auto small = [](const std::string& text) { return text.empty() ? "" : "<br><small>" + text + "</small>"; };
  const auto name = [&](const char* what, const PaperReference& r) {
    return what + (r.derived ? std::string(" <span class=\"tag\">derived</span>") : "") + small(html_text(r.where));
  };
  rows.push_back({name("Measured", row.measured), reference_html(row.measured, row.unit), ""});
  if (row.simulated.kind != PaperReference::Kind::none)
    rows.push_back({name("Paper's DEM", row.simulated), reference_html(row.simulated, row.unit),
                    difference_html(own_difference(row), row.measured, row.unit)});
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results.form[form];
    if (!r.exists) continue;
    std::string seeds = row.figure.minus_run.empty() ? "" : "standard error in place of the sd";
    for (const double v : r.values)
      if (row.figure.minus_run.empty()) seeds += (seeds.empty() ? "seeds: " : ", ") + format_number(v, 4);
    const bool is_drawn = !row.has_figure() && !r.runs.empty();
    rows.push_back({std::string("Calx, ") + paper_form_name(form) + small(seeds),
                    r.spread.count > 0 ? result_html(r, row.unit)
                    : is_drawn         ? "see the plot"
                                       : "<i>not run</i>",
                    against_measured(row, r)});
  }
  return html_table(rows, 99);
}

std::string row_content(Page& page, const PaperRows& rows, const PaperRow& row, const RowResults& results,
                        const std::string& out) {
  const PaperRun& run = paper_run(rows, row.figure.run);
  std::string text = figures_table(row, results), checks = claims(row), links;
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results.form[form];
    checks += scatter_verdict(row, r);
    // A form that nobody began has said so in the table.
    if (r.begun || form == paper_reduced)
      for (const std::string& m : r.missing) checks += html_check("open", "", html_text(m) + ".");
    for (const RunFolder& folder : r.runs)
      links += (links.empty() ? "Runs: " : ", ") + std::string("<a href=\"") +
               html_text(std::filesystem::path(folder.dir).lexically_relative(out).string()) + "/report.html\">" +
               paper_form_name(form) + " " + std::filesystem::path(folder.dir).filename().string() + "</a>";
  }
  if (!checks.empty()) text += "<ul class=\"checks\">" + checks + "</ul>";
  for (const std::string& n : row.notes) text += "<p class=\"note\">" + html_text(n) + "</p>";
  if (!links.empty()) text += "<p class=\"note\">" + links + ".</p>";
  std::string assumed;
  if (!row.assumed.empty()) assumed += "<h3>Assumed</h3>" + list(row.assumed);
  const PaperForm& reduced = run.forms[paper_reduced];
  if (!reduced.reduced.empty()) assumed += "<h3>Reduced</h3>" + list(reduced.reduced);
  for (const int form : {paper_reduced, paper_full}) {
    if (results.form[form].runs.empty()) continue;
    std::vector<std::string> set;
    for (const auto& [pointer, value] : run.forms[form].set) set.push_back(pointer + " = " + value);
    assumed += folded(std::string("Set for this row, in place of what the case says, ") + paper_form_name(form), set);
    assumed += folded(std::string("Assumptions of the case, ") + paper_form_name(form),
                      results.form[form].runs.front().assumptions);
  }
  text = "<div class=\"two\"><div>" + text + "</div><div class=\"box assumed\">" + assumed + "</div></div>";
  const std::string drawn = paper_drawings(page, row, results.form);
  return drawn.empty() ? text : text + "<div class=\"charts\">" + drawn + "</div>";
}

std::string anchor(std::size_t index) { return "row-" + std::to_string(index + 1); }

/// A tag for a row whose publication says the opposite of its numbers.
std::string contradiction(const PaperRow& row) {
  const PaperDifference own = own_difference(row);
  for (const PaperClaim& c : row.claims)
    if (own.known && own.sign != c.sign)
      return std::string("<br><span class=\"tag\">its text says ") + (c.sign < 0 ? "underestimate" : "overestimate") +
             "</span>";
  return "";
}

std::string overview(const PaperRows& rows, const std::vector<RowResults>& results) {
  std::vector<std::vector<std::string>> table = {{"Row", "Measured", "Paper's DEM", "Paper's DEM against measured",
                                                  "Calx, reduced", "Calx, reduced, against measured", "Calx, full"}};
  for (std::size_t k = 0; k < rows.rows.size(); ++k) {
    const PaperRow& row = rows.rows[k];
    const auto cell = [&](int form) -> std::string {
      const PaperResult& r = results[k].form[form];
      if (!r.exists) return "-";
      if (r.spread.count > 0) return result_html(r, row.unit);
      if (!r.runs.empty())
        return row.has_figure() ? "<i>no figure</i>"
                                : "shape only <small>(n\xc2\xa0=\xc2\xa0" + std::to_string(r.runs.size()) + ")</small>";
      return r.begun ? "<i>not finished</i>" : "<i>not\xc2\xa0run</i>";
    };
    table.push_back({"<a href=\"#" + anchor(k) + "\">" + html_text(row.name) + "</a>",
                     reference_html(row.measured, row.unit), reference_html(row.simulated, row.unit),
                     side_html(own_difference(row), row.measured) + contradiction(row), cell(paper_reduced),
                     against_measured(row, results[k].form[paper_reduced]), cell(paper_full)});
  }
  return "<p>Mean \xc2\xb1 standard deviation over n seeds; a difference of two runs carries its standard error "
         "instead. Every figure comes from the runs in this page's folder; nothing is written by hand.</p>" +
         html_table(table, 99);
}

}  // namespace

std::string write_paper(const PaperRows& rows, std::size_t seeds, const std::string& out) {
  std::error_code failed;
  std::filesystem::create_directories(out, failed);
  if (failed) throw Error(Fault::files, out + ": cannot be made: " + failed.message());
  std::vector<RowResults> results(rows.rows.size());
  std::size_t filled[2] = {0, 0}, of[2] = {0, 0};
  for (std::size_t k = 0; k < rows.rows.size(); ++k)
    for (const int form : {paper_full, paper_reduced}) {
      PaperResult& r = results[k].form[form] = paper_result(rows, rows.rows[k], form, seeds, out);
      of[form] += r.exists;
      filled[form] += !rows.rows[k].has_figure() ? !r.runs.empty() : r.spread.count > 0;
    }
  Page page(rows.title);
  const auto share = [&](int form) { return std::to_string(filled[form]) + " of " + std::to_string(of[form]); };
  page.header(
      "<div class=\"title\"><h1>" + html_text(rows.title) + "</h1></div><p class=\"note\">" + html_text(rows.source) +
      "</p><div class=\"cards\">" +
      html_card("rows filled by reduced runs", share(paper_reduced), "what was reduced stands in each row", "main") +
      html_card("rows filled by full runs", share(paper_full), "calx paper --full computes them", "main") + "</div>" +
      (rows.intro.empty() ? "" : "<p>" + html_text(rows.intro) + "</p>"));
  page.section("rows", "All rows", "All rows", overview(rows, results));
  for (std::size_t first = 0; first < rows.rows.size();) {
    const std::string& group = rows.rows[first].group;
    std::string content;
    std::size_t k = first;
    for (; k < rows.rows.size() && rows.rows[k].group == group; ++k)
      content += "<div class=\"paper-row\" id=\"" + anchor(k) + "\"><h3>" + html_text(rows.rows[k].name) + "</h3>" +
                 row_content(page, rows, rows.rows[k], results[k], out) + "</div>";
    page.section("group-" + std::to_string(first), group, group, content);
    first = k;
  }
  const std::string path = out + "/paper.html";
  write_text_atomically(path, page.html());
  return path;
}

}  // namespace calx
