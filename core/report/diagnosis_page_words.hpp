// diagnosis_page_words.hpp: the numbers of a diagnosis in words that need no statistics. All texts are HTML. Private to
// report/.
#pragma once
#include <string>
#include <vector>

#include "report/diagnosis_page_result.hpp"

namespace calx {

/// Plain digits where a person reads them easily, else a power of ten: "10000", "9.7 10^-13".
std::string number_html(double value, int digits = 3);

/// A number of standard deviations; what is next to none is "0".
std::string distance_html(double deviations);

/// "4.2 g", in the unit given; without unit for "1". "-" when not finite.
std::string amount_html(double value, const std::string& unit, int digits = 3);

/// "42 %"; "below 0.1 %", "above 99.9 %", since nothing is certain.
std::string share_html(double share);

/// "1.1 g too much": signed_error is simulation - measured.
std::string error_html(double signed_error, const std::string& unit);

/// Whether chance alone gives a difference as large: "yes, easily", "hardly, about once in 40 times".
std::string chance_html(double p);

/// Whole minutes, rounded up: "5 min".
std::string minutes_html(double seconds);

/// How much better the data are foretold: "13 times likelier" for ln 13 nats, "as likely" for none.
std::string likelier_html(double nats);

/// A value in SI with the prefix that suits it: "2.37 mm".
std::string quantity_html(double value, const std::string& si_unit, int digits = 3);

/// "0.4 to 0.6 mm", both with the same prefix.
std::string range_html(double low, double high, const std::string& si_unit);

/// "gap = 0.42 mm", with the 90 % interval if there is one.
std::string strength_html(const DiagnosisResult::Amount& amount);

/// The shape of a departure by the name of its family: a word or two ("jump"), and what such a shape can mean.
std::string shape_html(const std::string& family);
std::string shape_meaning_html(const std::string& family);

/// "fitted", "held out", "fitted and held out".
std::string use_html(const DiagnosisResult::Observable& o);

/// Mood of a p value for checks and rows: "good", "open", "bad".
const char* mood_of(double p);

/// Names in code type: "a, b and c".
std::string names_html(const std::vector<std::string>& names);

}  // namespace calx
