#include "report/diagnosis_page_words.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "report/page.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

struct Shape {
  const char *name, *meaning;
};

const std::map<std::string, Shape>& shapes() {
  static const std::map<std::string, Shape> all = {
      {"constant", {"shift", "the same everywhere, such as a wrong zero or a wrong scale"}},
      {"step", {"jump", "a jump that stays: something changed at that place and did not go back"}},
      {"hinge", {"bend", "right up to a place, then off more and more: a regime that the simulation does not know"}},
      {"bump", {"local", "off around one place only: something local, such as a dent, a lump, a disturbance"}},
      {"drift", {"drift", "off more and more at a steady rate, such as wear, warming, a zero that wanders"}},
      {"decay", {"start", "off at the beginning and right later, such as a start that is not settled"}},
      {"periodic", {"wave", "a wave that repeats: look for what turns or swings with that period"}},
      {"sawtooth",
       {"sawtooth", "grows and falls back again and again: look for what fills and empties with that period"}},
      {"smooth", {"smooth curve", "a smooth departure without a simple shape"}},
      {"rough", {"uneven curve", "an uneven departure without a simple shape"}}};
  return all;
}

}  // namespace

std::string number_html(double value, int digits) {
  const double size = std::fabs(value);
  if (!std::isfinite(value) || size == 0 || (size >= 1e-4 && size < 1e4)) {
    const std::string out = format_number(value, digits);
    // Three digits of 1234.5 would be a power of ten; its whole part reads better.
    return out.find('e') == std::string::npos ? out : format_number(std::round(value), 8);
  }
  if (size >= 1e4 && size < 1e7) return format_count(std::stod(format_number(value, digits)));
  const std::string text = format_number(value, digits);
  const std::size_t e = text.find('e');
  return e == std::string::npos
             ? text
             : text.substr(0, e) + "\xc2\xb7" + "10<sup>" + std::to_string(std::stoi(text.substr(e + 1))) + "</sup>";
}

std::string distance_html(double deviations) { return std::fabs(deviations) < 0.05 ? "0" : number_html(deviations, 2); }

std::string amount_html(double value, const std::string& unit, int digits) {
  if (!std::isfinite(value)) return "-";
  return number_html(value, digits) + (unit.empty() || unit == "1" ? "" : "\xc2\xa0" + html_text(unit));
}

std::string quantity_html(double value, const std::string& si_unit, int digits) {
  const DisplayUnit shown = display_unit(si_unit, value);
  return amount_html(value * shown.factor, shown.unit, digits);
}

std::string range_html(double low, double high, const std::string& si_unit) {
  const DisplayUnit shown = display_unit(si_unit, std::max(std::fabs(low), std::fabs(high)));
  return number_html(low * shown.factor) + " to " + amount_html(high * shown.factor, shown.unit);
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
  if (p < 1e-6) return "no, less than once in a million times";
  const std::string times = format_count(std::stod(format_number(1 / p, 2))) + " times";
  if (p >= 0.05) return "yes, about once in " + times;
  return p >= 0.01 ? "hardly, about once in " + times : "no, once in " + times + " at most";
}

std::string minutes_html(double seconds) {
  return std::isfinite(seconds) ? format_count(std::ceil(seconds / 60)) + "\xc2\xa0min" : "-";
}

std::string likelier_html(double nats) {
  if (!std::isfinite(nats)) return "-";
  if (std::fabs(nats) < 0.1) return "as likely";
  const double times = std::exp(std::fabs(nats));
  std::string out = "over a million times";
  if (times < 1e6) out = format_count(std::stod(format_number(times, 2))) + " times";
  return out + (nats >= 0 ? " likelier" : " less likely");
}

std::string strength_html(const DiagnosisResult::Amount& amount) {
  const bool has_interval = std::isfinite(amount.low) && std::isfinite(amount.high);
  const double largest = has_interval ? std::max(std::fabs(amount.low), std::fabs(amount.high)) : 0;
  const DisplayUnit shown = display_unit(amount.unit, std::max(largest, std::fabs(amount.value)));
  // What is left of a strength that the fit drove to zero.
  const double value = std::fabs(amount.value) < 1e-6 * largest ? 0 : amount.value;
  std::string out =
      html_text(quantity_of(amount.name).title) + " = <b>" + amount_html(value * shown.factor, shown.unit) + "</b>";
  if (has_interval)
    out += " (90\xc2\xa0% interval " + number_html(amount.low * shown.factor) + " to " +
           amount_html(amount.high * shown.factor, shown.unit) + ")";
  return out;
}

std::string shape_html(const std::string& family) {
  const auto at = shapes().find(family);
  return at == shapes().end() ? html_text(family) : at->second.name;
}

std::string shape_meaning_html(const std::string& family) {
  const auto at = shapes().find(family);
  return at == shapes().end() ? "" : at->second.meaning;
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
