// The JSON Schema of a study. Keys follow study.cpp and measured.cpp; tests hold them together.
#include "config/schema.hpp"
#include "study/generic_terms.hpp"
#include "study/study.hpp"

namespace calx {
namespace {

using namespace schema;

const Properties above_zero = {{"exclusiveMinimum", 0}};

/// A number in a unit that the study names elsewhere, or a value with a unit.
Json quantity(const std::string& doc, const Properties& bounds = {}) {
  Json plain = {{"type", "number"}};
  for (const auto& b : bounds) plain[b.first] = b.second;
  const Json with =
      object("a value with a unit", {{"value", {{"type", "number"}}}, {"unit", text("its unit")}}, {"value", "unit"});
  return any_of(doc, {plain, with});
}

Json pointers(const std::string& doc) {
  Json pointer = text("a JSON pointer");
  pointer["pattern"] = "^/";
  Json out = list(doc, pointer);
  out["minItems"] = 1;
  return out;
}

Json study_case() {
  Json set = map("values by JSON pointer", true);
  set["propertyNames"] = {{"pattern", "^/"}};
  return object("a case that the study runs",
                {{"case", text("path of the case file, from this file")},
                 {"set", set},
                 {"reduced", text("path of a cheaper case with the same sensors, for the first wave")},
                 {"reduced_tolerance",
                  preset(number("share of a figure by which the cheaper case may be off (sd)", "1", above_zero),
                         StudyCase().reduced_tolerance)}},
                {"case"});
}

Json parameter() {
  const Json ends = {{"type", "array"},
                     {"items", quantity("an end of the range")},
                     {"minItems", 2},
                     {"maxItems", 2},
                     {"description", "lowest and highest value, in the parameter's unit"}};
  const Json normal =
      object("normal, cut off at the range",
             {{"mean", quantity("in the parameter's unit")}, {"sd", quantity("in the parameter's unit", above_zero)}},
             {"mean", "sd"});
  return object("a parameter to find",
                {{"name", text("what it is called")},
                 {"unit", preset(text("unit of range and prior, \"1\" for none"), "1")},
                 {"set", pointers("the places of the cases that take its value")},
                 {"cases", list("cases it is set in; all when left out", text("name of a case"))},
                 {"range", ends},
                 {"prior", preset(any_of("what is known before the data",
                                         {choice("equally likely anywhere in the range", {"uniform"}),
                                          object("a normal prior", {{"normal", normal}}, {"normal"})}),
                                  "uniform")}},
                {"name", "set", "range"});
}

Json measured() {
  const Json sd = quantity("scatter of one repeat, in the observable's unit", above_zero);
  Json out =
      object("what was measured: one value, values of repeats or of the places \"at\", or a file",
             {{"value", quantity("in the observable's unit")},
              {"values", list("of repeats, or one for each place in \"at\"", quantity("in the observable's unit"))},
              {"repeats", whole("how many measurements a value is the mean of", 1)},
              {"file", text("path of a CSV file, from this file; its columns end in their unit")},
              {"x", text("column of the places of a curve")},
              {"y", text("column of the measured values, or of the places along y of a map")},
              {"z", text("column of the heights of a map")},
              {"repeat", text("column that tells repeats apart")},
              {"sd", sd},
              {"relative", number("scatter of one repeat as a share of the value", "1", above_zero)},
              {"autocorrelation", number("correlation of neighbouring points of one repeat", "1",
                                         {{"exclusiveMinimum", -1}, {"exclusiveMaximum", 1}})}});
  out["oneOf"] = {{{"required", {"value"}}}, {{"required", {"values"}}}, {{"required", {"file", "y"}}}};
  return out;
}

Json observable() {
  std::vector<std::string> kinds;
  for (const auto& kind : observable_kinds()) kinds.push_back(kind.first);
  Json out = object(
      "something that was measured, and the sensor that gives it",
      {{"name", text("what it is called")},
       {"kind", choice("what was measured", kinds)},
       {"case", text("the case of the study that gives it")},
       {"sensor", text("a sensor of that case")},
       {"column", text("a column of the sensor")},
       {"field", text("instead of a column: a map of heights of the sensor, \"height\" for instance")},
       {"against", text("of a curve: the column its places belong to, \"time_s\" for instance")},
       {"unit", text("unit of the measured values, \"1\" for none")},
       {"use", preset(choice("fitted, or only predicted", {"fit", "hold-out"}), "fit")},
       {"measured", measured()},
       {"at", list("places of values that stand in the study, rising", quantity("in the unit of \"against\""))},
       {"tolerance",
        quantity("what the model may miss without being wrong (sd), in the observable's unit", {{"minimum", 0}})},
       {"simulated", object("of a diagnosis: what another program gave; the cases then only say how it changes",
                            {{"value", quantity("in the observable's unit")},
                             {"values", list("one per place", quantity("in the observable's unit"))},
                             {"sd", quantity("from seed to seed", {{"minimum", 0}})}})},
       {"conditions", map("what else was set in the laboratory", quantity("in SI or a unit of its own"))}},
      {"name", "kind", "case", "sensor", "unit", "measured"});
  out["oneOf"] = {{{"required", {"column"}}}, {{"required", {"field"}}}};
  return out;
}

Json effect() {
  const Json strength = number("in the amplitude's unit", "1", above_zero);
  return object("an effect that joins the library of a diagnosis, or how one acts",
                {{"effect", text("its id")},
                 {"on", map("names in the cases by role", text("a name"))},
                 {"parameters", map("parameters that are no amplitude", number("in the parameter's unit", "1"))},
                 {"scale", any_of("a typical strength", {strength, map("by amplitude", strength)})},
                 {"cases", list("cases it may act in; all when left out", text("name of a case"))}},
                {"effect"});
}

Json experiment() {
  const Json sd = quantity("of one number", above_zero);
  return object(
      "a measurement that could be made next",
      {{"name", text("what would be measured")},
       {"cost", preset(number("in any unit, the same for all", "1", above_zero), 1)},
       {"case", text("the case that gives it")},
       {"sensor", text("a sensor of that case")},
       {"column", text("a column of the sensor")},
       {"against", text("of a curve: the column its places belong to")},
       {"at", list("places, or times at which a known load is read", quantity("in the unit of \"against\", or s"))},
       {"unit", text("of its numbers")},
       {"sd", any_of("of the measurement", {sd, list("one per place", sd)})},
       {"tolerance", quantity("what the model may miss", {{"minimum", 0}})},
       {"known_load", object("a load put on a sensor instead of a case",
                             {{"sensor", text("the sensor that shows it")},
                              {"time_s", list("times", quantity("s"))},
                              {"value", list("the load at these times", quantity("SI"))}},
                             {"sensor", "time_s", "value"})}},
      {"name", "sd"});
}

Json generic_term() {
  std::vector<std::string> targets;
  for (const GenericTarget& t : generic_targets()) targets.push_back(t.name);
  return object("a force known by a formula alone",
                {{"name", text("small letters, digits and -")},
                 {"on", choice("where it acts", targets)},
                 {"formula", text("of speed, load, stress and time of a contact; of speed, time, x, y, z for drag")},
                 {"scale", number("a typical amplitude", "1", above_zero)}},
                {"name", "on", "formula", "scale"});
}

Json claim() {
  return object(
      "a cause that somebody claims",
      {{"effect", text("its id")},
       {"observable", text("what it is said to explain")},
       {"simulation", preset(choice("what is said of the simulation", {"lacks it", "has too much of it"}), "lacks it")},
       {"says", text("the claim in words")}},
      {"effect", "observable"});
}

}  // namespace

std::string study_schema() {
  const Study presets;
  Json cases = map("cases to run by name", study_case());
  cases["minProperties"] = 1;
  Json parameters = list("parameters to find", parameter()), observables = list("what was measured", observable());
  observables["minItems"] = 1;
  const Json executor =
      object("how runs are computed",
             {{"kind", preset(choice("this machine, or a cluster", {"local", "slurm"}), presets.executor.kind)},
              {"jobs", whole("runs at a time; this machine's cores, or 100 jobs, when left out", 1)},
              {"options", list("further options of sbatch", text("\"--partition=short\""))}});
  Json out = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Calx study"}};
  out.update(object(
      "a study: parameters of cases to find from measured data",
      {{"$schema", text("where this schema stands, for editors")},
       {"calx_study", {{"const", 1}, {"description", "version of the format"}}},
       {"title", text("a line of text")},
       {"cases", cases},
       {"parameters", parameters},
       {"observables", observables},
       {"seeds", preset(whole("runs with other random numbers at each place of the parameters", 1), presets.seeds)},
       {"seed", preset(whole("seed of all random choices", 0), presets.seed)},
       {"budget", object("runs to spend", {{"runs", preset(whole("in all", 4), presets.budget)}})},
       {"executor", executor},
       {"assumptions", list("what was chosen without a source, in words", text("one assumption"))},
       {"effects", list("of a diagnosis: candidate causes beside those of Calx", effect())},
       {"library", preset(choice("of a diagnosis: all effects of Calx, or those named", {"calx", "named"}), "calx")},
       {"roles", map("of a diagnosis: names in the cases by role, for every effect", text("a name"))},
       {"experiments", list("of a diagnosis: measurements that could be made next", experiment())},
       {"generic_terms", any_of("of a diagnosis: terms by formula, tried where the cause is not in the library",
                                {Json{{"type", "boolean"}, {"description", "true: those that come with Calx"}},
                                 list("some of them", any_of("a term", {text("its name"), generic_term()}))})},
       {"claims", list("of a diagnosis: causes that somebody claims", claim())}},
      {"calx_study", "cases", "parameters", "observables"}));
  return out.dump(2) + "\n";
}

}  // namespace calx
