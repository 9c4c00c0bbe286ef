// Which cause the data speak for, what looks like it, and what was not tried.
#include <algorithm>
#include <cmath>
#include <set>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

constexpr double least_share = 0.01;  // below it a cause has no bar
constexpr double apart = 3;           // sd; nearer causes are one group in the diagnosis

std::string bar(double share, const std::string& mood) {
  return "<span class=\"bar " + mood + "\"><i style=\"width:" + format_number(100 * std::clamp(share, 0.0, 1.0), 3) +
         "%\"></i></span>";
}

std::string shade(const std::string& which, const std::string& content) {
  return "<span class=\"shade " + which + "\">" + content + "</span>";
}

std::string summary_html(const DiagnosisResult::Cause& c) {
  return c.summary.empty() ? "" : "<br><small>" + html_text(c.summary) + "</small>";
}

/// Words of a term bear no units.
std::string units_html(const DiagnosisResult& d, const DiagnosisResult::UnknownTerm& t) {
  for (const DiagnosisResult::Observable& o : d.observables) {
    if (o.name != t.observable) continue;
    const Quantity x = quantity_of(o.against);
    return (o.unit.empty() || o.unit == "1" ? "a plain number" : "in " + html_text(o.unit)) +
           (x.title.empty() ? "" : ", against " + html_text(x.title)) +
           (x.unit.empty() ? "" : " in " + html_text(x.unit));
  }
  return "";
}

bool leads(const DiagnosisResult::Cause& c) { return c.named || c.evidence >= least_share; }

}  // namespace

std::string DiagnosisSections::evidence_bars() const {
  std::vector<std::vector<std::string>> rows = {{"Explanation", "Share", ""}};
  const auto add = [&](const std::string& name, double share, const std::string& mood) {
    if (std::isfinite(share)) rows.push_back({name, share_html(share), bar(share, mood)});
  };
  add("<b>nothing is wrong</b><br><small>recalibrated simulation and chance</small>", d.none, "none");
  std::vector<std::string> little;
  for (const DiagnosisResult::Cause& c : d.causes) {
    if (leads(c))
      add("<code>" + html_text(c.label) + "</code>" + (c.named ? " <span class=\"tag\">named</span>" : "") +
              summary_html(c),
          c.evidence, c.named ? "taken" : "");
    else
      little.push_back(c.label);
  }
  add("<b>something that is not in the library</b><br><small>a departure with a shape that no cause leaves</small>",
      d.unlisted, "binds");
  std::string out = html_table(rows, 1, "evidence") +
                    "<p class=\"note\">How likely each is at work, alone or beside another cause, before the self-test "
                    "corrects it; so the shares can add up to more than 100\xc2\xa0%.</p>";
  if (!little.empty()) out += "<p><b>Hardly supported</b>, each below 1\xc2\xa0%: " + names_html(little) + ".</p>";
  return out;
}

std::string DiagnosisSections::cause_table() const {
  std::vector<std::vector<std::string>> rows = {
      {"Cause", "Strength that fits best", "Allowed", "Signal to noise", "Probability"}};
  for (const DiagnosisResult::Cause& c : d.causes) {
    if (!leads(c)) continue;
    std::string strength, range;
    for (const DiagnosisResult::Amount& a : c.parameters) {
      strength += (strength.empty() ? "" : "<br>") + strength_html(a);
      if (std::isfinite(a.lowest) && std::isfinite(a.highest)) range += range_html(a.lowest, a.highest, a.unit);
      if (std::isfinite(a.off))
        range += "<br><small>" + (a.off == 0 ? "0" : quantity_html(a.off, a.unit)) + " when there is none</small>";
    }
    rows.push_back(
        {"<code>" + html_text(c.label) + "</code>" + (c.is_instrument ? "<br><small>instrument</small>" : ""), strength,
         range, distance_html(c.signal_to_noise), share_html(c.probability)});
  }
  if (rows.size() == 1) return "";
  return "<h3>The causes that have a share</h3>" + html_table(rows, 3) +
         "<p class=\"note\">Signal to noise: how far the trace of the cause stands out of the scatter, at this "
         "strength and with all parameters set anew; below 3 it is faint. Probability: after the calibration of the "
         "self-test.</p>";
}

std::string DiagnosisSections::alike() const {
  std::string out;
  for (const std::vector<std::string>& group : d.groups)
    if (group.size() > 1)
      out += html_check("open", names_html(group) + " leave the same traces.",
                        "No analysis of these data tells them apart; another measurement may.");
  return out.empty() ? "" : "<h3>What cannot be told apart with these data</h3><ul class=\"checks\">" + out + "</ul>";
}

std::string DiagnosisSections::distance_map() const {
  std::set<std::string> wanted;
  for (const DiagnosisResult::Cause& c : d.causes)
    if (leads(c) || wanted.size() < 6) wanted.insert(c.label);
  for (const std::vector<std::string>& group : d.groups) wanted.insert(group.begin(), group.end());
  // Likeliest first, as in the bars above.
  std::vector<std::size_t> shown;
  for (const DiagnosisResult::Cause& c : d.causes) {
    const auto at = std::find(d.ids.begin(), d.ids.end(), c.label);
    if (wanted.count(c.label) > 0 && at != d.ids.end()) shown.push_back(static_cast<std::size_t>(at - d.ids.begin()));
  }
  if (shown.size() < 2) return "";
  std::vector<std::vector<std::string>> rows = {{"", "True cause"}};
  for (std::size_t l = 0; l < shown.size(); ++l) rows[0].push_back(std::to_string(l + 1));
  for (std::size_t k = 0; k < shown.size(); ++k) {
    rows.push_back({std::to_string(k + 1), "<code>" + html_text(d.ids[shown[k]]) + "</code>"});
    for (std::size_t l = 0; l < shown.size(); ++l) {
      const double distance = d.distance[shown[k]][shown[l]];
      const std::string which = !(distance >= apart) ? "near" : distance < 2 * apart ? "middle" : "far";
      rows.back().push_back(k == l ? "" : shade(which, distance_html(distance)));
    }
  }
  return "<h3>How well the causes can be told apart</h3>" + html_table(rows, 2, "map") +
         "<p class=\"note\">What is left of a true cause (row, at the strength that fits best) when another one "
         "(column, by "
         "its number) imitates it as well as it can, in standard deviations. " +
         shade("near", "below 3") + " cannot be told apart, " + shade("middle", "3 to 6") + " mostly, " +
         shade("far", "above 6") +
         " surely. A row of small numbers throughout is a cause whose best strength is next to nothing.</p>";
}

std::string DiagnosisSections::rivals() const {
  std::string out;
  for (const DiagnosisResult::Cause& c : d.causes) {
    const bool left = std::find(d.set.begin(), d.set.end(), c.label) != d.set.end();
    if (!c.named && !(left && d.verdict != "none")) continue;
    for (const DiagnosisResult::Rival& r : c.rivals)
      out += "<li>" + names_html({c.label}) + " or " +
             (r.effect.find(' ') == std::string::npos ? names_html({r.effect}) : html_text(r.effect)) + "? " +
             html_text(r.separate) + "</li>";
  }
  return out.empty() ? "" : "<h3>What would tell them from their rivals</h3><ul>" + out + "</ul>";
}

std::string DiagnosisSections::terms() const {
  if (d.terms.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"What the departure looks like", "What such a shape can mean", "Data with it are", "Chosen again"}};
  for (const DiagnosisResult::UnknownTerm& t : d.terms)
    rows.push_back({html_text(t.words) + "<br><small>" + units_html(d, t) + "</small>", shape_meaning_html(t.family),
                    likelier_html(t.gain), t.stability > 0 ? share_html(t.stability) : "-"});
  return "<h3>The unknown in words</h3>" + html_table(rows, 2) +
         "<p class=\"note\">Sizes are measurement less simulation. Chosen again: how often the same shape comes first "
         "when a fifth of the numbers is left out. These terms describe what was measured between its first and its "
         "last value; they are no cause and foretell nothing outside.</p>";
}

std::string DiagnosisSections::claims() const {
  std::string out;
  for (const DiagnosisResult::Claim& c : d.claims) {
    const bool against = c.verdict == "contradicted";
    out += html_check(against ? "bad" : "open", html_text(c.effect) + ": " + html_text(c.verdict) + ".",
                      html_text(c.sentence) + "." + (c.says.empty() ? "" : " Claimed: " + html_text(c.says)));
  }
  return out.empty() ? "" : "<h3>Causes that somebody claims</h3><ul class=\"checks\">" + out + "</ul>";
}

void DiagnosisSections::why() {
  std::string out =
      "<p>Each cause of the library was built into the simulation, and its trace laid beside the differences above. "
      "\"Nothing is wrong\" and \"not in the library\" compete with them.</p>" +
      evidence_bars() + cause_table() + terms() + alike() + rivals() + claims() + distance_map();
  if (!d.sentence.empty()) out += "<p class=\"note\">In the words of diagnosis.json: " + html_text(d.sentence) + "</p>";
  page.section("why", "2. Why", "Why", out);
}

}  // namespace calx
