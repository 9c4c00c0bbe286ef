// diagnosis_page_words.hpp: the numbers of a diagnosis in words that need no statistics. All texts are HTML. Private to
// report/.
#pragma once
#include <string>
#include <vector>

#include "report/diagnosis_page_result.hpp"

namespace calx {

/// "4.2 g"; without unit for "1". "-" when not finite.
std::string amount_html(double value, const std::string& unit, int digits = 3);

/// "42 %"; "below 0.1 %", "above 99.9 %", since nothing is certain.
std::string share_html(double share);

/// "1.1 g too much": signed_error is simulation - measured.
std::string error_html(double signed_error, const std::string& unit);

/// How likely chance alone gives a difference as large: "easily", "once in 40 times".
std::string chance_html(double p);

/// How much better the data are foretold: "13 times likelier" for ln 13 nats.
std::string likelier_html(double nats);

/// "gap = 0.42 mm", with the 90 % interval if there is one.
std::string strength_html(const DiagnosisResult::Amount& amount);

/// What a term outside the library looks like, by the name of its family; "" for others.
std::string family_html(const std::string& family);

/// "fitted", "held out", "fitted and held out".
std::string use_html(const DiagnosisResult::Observable& o);

/// Mood of a p value for checks and rows: "good", "open", "bad".
const char* mood_of(double p);

/// Names in code type: "a, b and c".
std::string names_html(const std::vector<std::string>& names);

}  // namespace calx
