#include "report/diagnosis_page_words.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "report/page.hpp"
#include "report/units.hpp"

namespace calx {

std::string amount_html(double value, const std::string& unit, int digits) {
  if (!std::isfinite(value)) return "-";
  return format_number(value, digits) + (unit.empty() || unit == "1" ? "" : "\xc2\xa0" + html_text(unit));
}

std::string share_html(double share) {
  if (!std::isfinite(share)) return "-";
  const double percent = 100 * share;
  if (percent < 0.1) return "below 0.1\xc2\xa0%";
  if (percent > 99.9) return "above 99.9\xc2\xa0%";
  return format_number(percent, percent < 1 || percent > 99 ? 3 : 2) + "\xc2\xa0%";
}

std::string error_html(double signed_error, const std::string& unit) {
  if (!std::isfinite(signed_error)) return "-";
  return amount_html(std::fabs(signed_error), unit) + (signed_error > 0 ? " too much" : " too little");
}

std::string chance_html(double p) {
  if (!std::isfinite(p)) return "not known";
  if (p >= 0.3) return "yes, easily";
  if (p >= 0.05) return "yes, about once in " + format_number(std::round(1 / p)) + " times";
  return std::string(p >= 0.01 ? "hardly" : "no") + ", about once in " +
         format_count(std::round(1 / std::max(p, 1e-9))) + " times";
}

std::string likelier_html(double nats) {
  if (!std::isfinite(nats)) return "-";
  const double times = std::exp(std::fabs(nats));
  std::string out = "more than a million times";
  if (times < 1e6) out = format_count(std::stod(format_number(times, 2))) + " times";
  return out + (nats >= 0 ? " likelier" : " less likely");
}

std::string strength_html(const DiagnosisResult::Amount& amount) {
  std::string out = html_text(amount.name) + " = <b>" + amount_html(amount.value, amount.unit) + "</b>";
  if (std::isfinite(amount.low) && std::isfinite(amount.high))
    out +=
        " (90\xc2\xa0% interval " + amount_html(amount.low, "") + " to " + amount_html(amount.high, amount.unit) + ")";
  return out;
}

std::string family_html(const std::string& family) {
  static const std::map<std::string, std::string> words = {
      {"constant", "a shift that is the same everywhere, such as a wrong zero"},
      {"step", "a jump that stays: something changed at that place and did not go back"},
      {"hinge", "right up to a place, then off more and more: a regime that the simulation does not know"},
      {"bump", "off around one place only: something local, such as a dent, a lump, a disturbance"},
      {"drift", "off more and more at a steady rate, such as wear, warming, a zero that wanders"},
      {"decay", "off at the beginning and right later, such as a start that is not settled"},
      {"periodic", "a wave that repeats: look for what turns or swings with that period"},
      {"sawtooth", "grows and falls back, again and again: look for what fills and empties with that period"},
      {"smooth", "a smooth departure without a simple shape"},
      {"rough", "an uneven departure without a simple shape"}};
  const auto at = words.find(family);
  return at == words.end() ? "" : at->second;
}

std::string use_html(const DiagnosisResult::Observable& o) {
  if (o.fit.empty()) return o.hold.empty() ? "-" : "held out";
  return o.hold.empty() ? "fitted" : "fitted and held out";
}

const char* mood_of(double p) { return !(p < 0.05) ? "good" : p < 0.01 ? "bad" : "open"; }

std::string names_html(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + ("<code>" + html_text(names[k])) + "</code>";
  return out;
}

}  // namespace calx
