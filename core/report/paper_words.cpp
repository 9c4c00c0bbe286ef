#include "report/paper_words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "report/page.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  const std::string u = unit_html(unit);
  return u.empty() ? number : number + "\xc2\xa0" + u;
}

std::string signed_number(double value, int digits) { return (value > 0 ? "+" : "") + format_number(value, digits); }

}  // namespace

const char* paper_form_name(int form) { return form == paper_full ? "full" : "reduced"; }

std::string unit_html(const std::string& unit) {
  if (unit == "1") return "";
  std::string out;
  for (std::size_t k = 0; k < unit.size(); ++k) {
    if (unit[k] != '^') {
      out += html_text(std::string(1, unit[k]));
      continue;
    }
    std::size_t end = k + 1;
    while (end < unit.size() && (std::isdigit(static_cast<unsigned char>(unit[end])) || unit[end] == '-')) ++end;
    out += "<sup>" + unit.substr(k + 1, end - k - 1) + "</sup>";
    k = end - 1;
  }
  return out;
}

std::string reference_html(const PaperReference& r, const std::string& unit) {
  using Kind = PaperReference::Kind;
  switch (r.kind) {
    case Kind::value:
      return with_unit(format_number(r.low, 7), unit);
    case Kind::range:
      return with_unit(format_number(r.low, 6) + " to " + format_number(r.high, 6), unit);
    case Kind::sign:
      return r.sign < 0 ? "below 0 (sign only)" : "above 0 (sign only)";
    case Kind::words:
      return html_text(r.words);
    default:
      return "-";
  }
}

std::string result_html(const PaperResult& result, const std::string& unit) {
  const Spread& s = result.spread;
  if (s.count == 0) return "-";
  const std::string n = " <small>(n\xc2\xa0=\xc2\xa0" + std::to_string(s.count) + ")</small>";
  // One run tells nothing of its scatter; angles scatter by a degree or more.
  if (s.count < 2) return with_unit(format_number(s.mean, unit == "deg" ? 3 : 4), unit) + n;
  if (!(s.deviation > 0)) return with_unit(format_number(s.mean, 5), unit) + n;
  // Two digits of the scatter are all that a few seeds can tell.
  const int decimals = std::min(9, std::max(0, 1 - static_cast<int>(std::floor(std::log10(s.deviation)))));
  char text[80];
  std::snprintf(text, sizeof text, "%.*f \xc2\xb1 %.*f", decimals, s.mean, decimals, s.deviation);
  return with_unit(text, unit) + n;
}

std::string side_html(const PaperDifference& d, const PaperReference& r) {
  if (!d.known) return "";
  if (r.kind == PaperReference::Kind::sign) return d.sign == r.sign ? "same side" : "other side";
  if (d.sign == 0) return r.kind == PaperReference::Kind::range ? "in the range" : "equal";
  return d.sign < 0 ? "underestimate" : "overestimate";
}

std::string difference_html(const PaperDifference& d, const PaperReference& r, const std::string& unit) {
  if (!d.known) return "";
  std::string out = side_html(d, r);
  if (d.sign == 0 || r.kind == PaperReference::Kind::sign) return out;
  out += ", " + with_unit(signed_number(d.amount, 3), unit);
  if (std::isfinite(d.share)) out += " (" + signed_number(100 * d.share, 3) + "\xc2\xa0%)";
  return out;
}

PaperDifference own_difference(const PaperRow& row) {
  using Kind = PaperReference::Kind;
  const Kind kind = row.simulated.kind;
  if (kind == Kind::sign && row.measured.kind == Kind::sign)
    return difference_to(row.simulated.sign, row.simulated.sign, row.measured);
  if (kind != Kind::value && kind != Kind::range) return {};
  return difference_to(row.simulated.low, row.simulated.high, row.measured);
}

}  // namespace calx
