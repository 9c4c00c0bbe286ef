// measured.hpp: reads the measured data of one observable. Private to study/.
#pragma once
#include "config/node.hpp"
#include "study/study.hpp"

namespace calx {

/// Fills o.measured and o.tolerance from the key "measured" (and "at", "tolerance") of the observable's object.
void read_measured(Object& observable, StudyObservable& o);

/// Fills in where an observable is read: case, sensor, column, against, unit and factor.
void read_reading(Object& observable, const std::vector<StudyCase>& cases, StudyObservable& o);

/// A list of numbers, each in unit or with its own.
std::vector<double> read_numbers(const Node& node, const std::string& unit);
/// Fails unless they rise strictly.
void need_rising(const Node& node, const std::vector<double>& places);

/// Factor from one unit to another. Throws Error(Fault::settings) through node when they measure different things.
double unit_factor(const Node& node, const std::string& from, const std::string& to, const std::string& what);

}  // namespace calx
