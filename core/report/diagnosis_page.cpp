#include "report/diagnosis_page.hpp"

#include <cmath>

#include "io/io.hpp"
#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

/// How a verdict is shown: mood is the colour of the banner.
struct Banner {
  std::string mood, word, headline, meaning, next;
};

std::string what_is_named(const DiagnosisResult& d) {
  std::string out;
  for (const DiagnosisResult::Cause* c : d.named()) {
    out += (out.empty() ? "" : " and ") + names_html({c->label});
    if (!c->parameters.empty()) out += ", " + strength_html(c->parameters[0]);
  }
  return out;
}

/// Causes that are not named and still have a share worth a look.
std::string perhaps_beside(const DiagnosisResult& d) {
  std::string out;
  for (const DiagnosisResult::Cause& c : d.causes)
    if (!c.named && !c.is_dropped && c.probability >= 0.1)
      out += (out.empty() ? " Perhaps at work beside it: " : ", ") + names_html({c.label}) + " (" +
             share_html(c.probability) + ")";
  if (!out.empty()) out += ".";
  for (const DiagnosisResult::Cause& c : d.causes)
    if (c.is_dropped) out += " " + names_html({c.label}) + " looked likely beside it, but adds nothing when it is run.";
  return out;
}

Banner named_banner(const DiagnosisResult& d) {
  Banner b{"named", "cause named", "", "", ""};
  if (d.named().empty()) {
    b.headline = "A cause is named", b.meaning = html_text(d.sentence);
    return b;
  }
  bool instrument = false;
  for (const DiagnosisResult::Cause* c : d.named()) {
    std::string summary = c->summary.empty() ? c->label : c->summary;
    if (summary.back() == '.') summary.pop_back();
    b.headline += (b.headline.empty() ? "" : "; and: ") + html_text(summary);
    instrument = instrument || c->is_instrument;
  }
  b.meaning = "The simulation is wrong, and one explanation stands out: " + what_is_named(d) +
              ". Neither chance nor recalibration nor another cause of the library explains the measurements as well, "
              "and data that were not fitted bear it out." +
              perhaps_beside(d);
  b.next =
      std::string(instrument ? "Check the instrument: the cause lies in how it was measured, not in the powder. "
                             : "Look for it at the plant, for the data show its traces and not the thing itself. ") +
      "For further predictions use the extended case of section 3; the old one is wrong by what section 1 shows.";
  return b;
}

Banner none_banner() {
  return {"none", "nothing shown wrong", "Nothing is shown to be wrong",
          "The recalibrated simulation and the measurements agree within noise, seeds and tolerance. That is no proof "
          "that all is right: a cause too weak for these data can hide, and section 5 says how strong it may be.",
          "Leave the case as it is. If something still seems odd at the plant, measure with more repeats or at other "
          "conditions."};
}

Banner ambiguous_banner(const DiagnosisResult& d) {
  std::vector<std::string> causes;
  bool none = false, unlisted = false;
  for (const std::string& s : d.set) {
    none = none || s == "none", unlisted = unlisted || s == "unknown";
    if (s != "none" && s != "unknown") causes.push_back(s);
  }
  Banner b{"ambiguous", "no clear verdict", "These data cannot say what is wrong", "", ""};
  b.meaning = d.reason.empty() ? "" : "Why: " + html_text(d.reason) + ". ";
  std::string left;
  const auto add = [&](bool is_left, const std::string& what) {
    if (is_left) left += (left.empty() ? "Still possible: " : "; ") + what;
  };
  add(!causes.empty(), (causes.size() == 1 ? "the cause " : "the causes ") + names_html(causes));
  add(none, "nothing wrong at all");
  add(unlisted, "something that is not in the library");
  // One alone is left where it was found wanting.
  if (d.set.size() == 1 && causes.size() == 1)
    left = "Likeliest is " + names_html(causes) + ", but not sure enough to be named";
  b.meaning += left.empty() ? "" : left + ".";
  b.next = "Do not change the case yet: a wrong cause built in makes every later prediction worse. " +
           (d.next.empty() ? std::string("Measure something else: section 2 says what would tell the causes apart.")
                           : "Measure: <b>" + html_text(d.next[0].name) +
                                 "</b> tells most for its cost; a clear verdict after it has a probability of " +
                                 share_html(d.next[0].clear_verdict) + " (section 6).");
  return b;
}

Banner unknown_banner(const DiagnosisResult& d) {
  Banner b{"unknown", "not in the library", "Something is wrong that no known cause explains", "", ""};
  b.meaning =
      "The measurements depart from the simulation in a way that neither chance nor recalibration nor any cause of the "
      "library makes.";
  if (!d.terms.empty()) b.meaning += " It looks like this: <b>" + html_text(d.terms[0].words) + "</b>.";
  if (d.generic.accepted)
    b.meaning += " " + names_html({d.generic.id}) + " describes it (section 3), which does not tell why it happens.";
  b.next =
      "Ask at the plant what could leave such a trace, and whether an instrument could. Whoever has an idea can add it "
      "as an effect plugin and diagnose again; finished runs are kept. Until then do not trust predictions of what "
      "section 1 shows as wrong.";
  return b;
}

Banner banner_of(const DiagnosisResult& d) {
  if (d.verdict == "named") return named_banner(d);
  if (d.verdict == "none") return none_banner();
  if (d.verdict == "ambiguous") return ambiguous_banner(d);
  if (d.verdict == "unknown") return unknown_banner(d);
  return {"ambiguous", html_text(d.verdict), "A verdict that this version does not know", html_text(d.reason), ""};
}

std::string cost_card(const DiagnosisResult& d) {
  if (!d.has_cost) return html_card("cost", "-", "cost.json is not there");
  std::string note = minutes_html(d.run_seconds) + " of run time";
  if (d.planned > 0) note += "; planned at most " + format_number(d.planned);
  if (d.budget > 0) note += ", budget " + format_number(d.budget);
  return html_card("runs", format_number(d.runs), note);
}

}  // namespace

std::string DiagnosisSections::added() const { return d.has_cause() ? "with the cause" : "with the unknown term"; }

void DiagnosisSections::header() {
  const Banner b = banner_of(d);
  std::string out = "<div class=\"title\"><h1>" + html_text(d.title.empty() ? "diagnosis" : d.title) +
                    "</h1></div><div class=\"verdict " + b.mood + "\"><span class=\"status\">" + b.word +
                    "</span><h2>" + b.headline + "</h2><p>" + b.meaning + "</p>";
  if (!b.next.empty()) out += "<p><b>What to do.</b> " + b.next + "</p>";
  if (!d.hints.empty()) {
    out += "<p><b>Hints from these data.</b></p><ul>";
    for (const std::string& hint : d.hints) out += "<li>" + html_text(hint) + "</li>";
    out += "</ul>";
  }
  out += "</div><div class=\"cards\">";
  std::size_t wrong = 0;
  for (const DiagnosisResult::Observable& o : d.observables) wrong += o.p < 0.05 ? 1 : 0;
  out += html_card("observables that are off", format_number(wrong) + " of " + format_number(d.observables.size()),
                   "beyond what chance gives in 1 of 20 cases",
                   wrong == 0            ? "good"
                   : d.verdict == "none" ? ""
                                         : "bad");
  if (!d.named().empty())
    out += html_card("probability of the cause", share_html(d.named()[0]->probability),
                     "as often true as it says, by the self-test", "main");
  if (d.has_after() && std::isfinite(d.gain))
    out += html_card("data not fitted are", likelier_html(d.gain),
                     "than with the old model; needed: " + format_number(std::exp(d.gain_needed), 2) + " times",
                     d.gain >= d.gain_needed ? "good" : "bad");
  if (d.confirmation.done)
    out += html_card("runs with new seeds", d.confirmation.holds() ? "confirm it" : "do not confirm",
                     format_number(d.confirmation.seeds) + " of each case", d.confirmation.holds() ? "good" : "bad");
  page.header(out + cost_card(d) + "</div>");
}

std::string write_diagnosis_report(const std::string& dir) {
  const DiagnosisResult result = read_diagnosis(dir);
  Page page(result.title.empty() ? "diagnosis" : result.title);
  DiagnosisSections sections{result, page};
  sections.header();
  sections.wrong();
  sections.why();
  sections.model();
  sections.worth();
  sections.trust();
  sections.next();
  sections.limits();
  sections.provenance();
  const std::string path = dir + "/report.html";
  write_text_atomically(path, page.html());
  return path;
}

}  // namespace calx
