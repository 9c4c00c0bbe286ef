// paper_words.hpp: references, results and differences of a publication's rows as HTML.
#pragma once
#include <string>

#include "report/paper_figures.hpp"

namespace calx {

/// "full" or "reduced".
const char* paper_form_name(int form);
/// "g/cm^3" with the power raised; empty for plain numbers.
std::string unit_html(const std::string& unit);
/// "38 to 42 deg", "6 g", "below 0 (sign only)", or the words; "-" for none.
std::string reference_html(const PaperReference& reference, const std::string& unit);
/// "5.1 &plusmn; 0.4 g (n = 3)", with as many digits as the scatter allows; "-" without a value.
std::string result_html(const PaperResult& result, const std::string& unit);
/// "underestimate", "overestimate", "equal", "in the range"; for a sign "same side", "other side".
std::string side_html(const PaperDifference& difference, const PaperReference& reference);
/// The side with amount and share: "underestimate, -0.769 g (-12.8 %)"; empty when the reference holds no number.
std::string difference_html(const PaperDifference& difference, const PaperReference& reference,
                            const std::string& unit);
/// The publication's own simulation against its measurement, by its numbers.
PaperDifference own_difference(const PaperRow& row);

}  // namespace calx
