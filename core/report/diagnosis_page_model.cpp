// The extended model: cases to take away, and where the parameters went.
#include <cmath>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

// The browser's clipboard needs a page it trusts; a selection and "copy" work for a file as well.
const char* const copy_button =
    "<button class=\"copy screen\" onclick=\"var "
    "r=document.createRange(),s=getSelection();r.selectNodeContents(this.parentNode.querySelector('pre'));s."
    "removeAllRanges();s.addRange(r);document.execCommand('copy');s.removeAllRanges();this.textContent='copied'\">copy<"
    "/button>";

std::string parameter_flags(const DiagnosisResult::Parameter& p, bool has_cause) {
  const bool before = p.strained(p.before), after = has_cause && p.strained(p.after);
  if (before && has_cause && !after) return "<br><span class=\"tag\">strained without the cause</span>";
  if (before || after) return "<br><span class=\"tag\">strained</span>";
  return "";
}

}  // namespace

std::string DiagnosisSections::generic_term() const {
  const DiagnosisResult::GenericTerm& g = d.generic;
  if (g.id.empty()) return "";
  std::string out =
      "<h3>A generic term, which is no named cause</h3><p>The study asked for forces that are known by a formula "
      "alone, in case nothing of the library explains the data. "
      "The likeliest is " +
      names_html({g.id}) + ": " + html_text(g.summary) + "</p><ul class=\"checks\">" +
      html_check(g.accepted ? "good" : "open", g.accepted ? "It is worth using." : "It is refused.",
                 "Why: " + html_text(g.reason) + "." +
                     (g.accepted ? " Found: " + strength_html(g.amount) + "; held-out data are " +
                                       likelier_html(g.gain) + " with it, their typical error goes from " +
                                       number_html(g.error_before, 2) + " to " + number_html(g.error_after, 2) +
                                       " sd, in runs with new seeds. It describes what happens under the "
                                       "conditions of these data; why it happens is still to be found."
                                 : "")) +
      "</ul>";
  std::vector<std::vector<std::string>> rows = {{"Generic term", "Log odds against the recalibrated case"}};
  for (const auto& t : g.tried) rows.push_back({"<code>" + html_text(t.first) + "</code>", number_html(t.second)});
  return out + html_table(rows, 1);
}

void DiagnosisSections::model() {
  std::string out = generic_term();
  if (d.extensions.empty())
    out += html_absent(d.verdict == "named" ? "No extended case is listed."
                                            : "No cause is named, so the case stays as it is: an extension that the "
                                              "data do not prove would make every later prediction worse.");
  for (const DiagnosisResult::Extension& e : d.extensions) {
    out += "<h3>Case " + html_text(e.case_name) + "</h3>";
    if (e.text.empty())
      out += html_absent("The file " + e.path + " is not there.");
    else
      out += "<p>Run it with <code>calx run " + html_text(e.path) +
             "</code> from the folder of this page.</p><details" + std::string(&e == &d.extensions[0] ? " open" : "") +
             "><summary>" + html_text(e.path) + "</summary><div class=\"source\">" + copy_button + "<pre>" +
             html_text(e.text) + "</pre></div></details>";
  }
  if (!d.extensions.empty())
    out += "<p class=\"note\">An extended case holds the " +
           std::string(d.generic.accepted ? "generic term" : "cause") +
           " with the strength found and the parameters set anew. It is "
           "valid for the conditions of these data.</p>";
  out += "<h3>Parameters that were set anew</h3>";
  if (d.parameters.empty()) out += html_absent("The study leaves no parameter open.");
  std::vector<std::vector<std::string>> rows = {{"Parameter", "Expected", "Recalibrated"}};
  if (d.has_cause()) rows[0].push_back("Recalibrated with the cause");
  for (const DiagnosisResult::Parameter& p : d.parameters) {
    rows.push_back({html_text(p.name) + parameter_flags(p, d.has_cause()),
                    amount_html(p.prior_mean, p.unit) + " \xc2\xb1 " + number_html(p.prior_sd, 2),
                    amount_html(p.before, p.unit) + " \xc2\xb1 " + number_html(p.sd, 2)});
    if (d.has_cause()) rows.back().push_back(amount_html(p.after, p.unit));
  }
  if (rows.size() > 1)
    out += html_table(rows, 1) +
           "<p class=\"note\">Strained: more than two standard deviations off what was expected. A parameter that has "
           "to bend that far often stands in for a cause that is missing.</p>";
  page.section("model", "3. The extended model", "Extended model", out);
}

}  // namespace calx
