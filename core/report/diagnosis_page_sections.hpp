// diagnosis_page_sections.hpp: the sections of a diagnosis' page, in the order of its questions. Private to report/.
#pragma once
#include <string>

#include "report/diagnosis_page_result.hpp"
#include "report/page.hpp"

namespace calx {

struct DiagnosisSections {
  const DiagnosisResult& d;
  Page& page;

  void header();      // verdict, what it means, what to do next, cost
  void wrong();       // what the simulation gets wrong
  void why();         // the evidence: causes, what looks like them, what was not tried
  void model();       // the extended cases, and parameters before and after
  void worth();       // gain on data that were not fitted
  void trust();       // self-test
  void next();        // which measurement tells most
  void limits();      // not tested, assumptions, notes
  void provenance();  // runs, versions

 private:
  /// What was added to the recalibrated simulation: "with the cause", "with the unknown term".
  std::string added() const;
  /// Title, x axis and unit of an observable that is a curve.
  static Chart curve_of(const DiagnosisResult::Observable& o);
  std::string residual_chart(const DiagnosisResult::Observable& o);
  std::string single_values_chart();
  std::string evidence_bars() const;
  std::string cause_table() const;
  std::string alike() const;
  std::string distance_map() const;
  std::string rivals() const;
  std::string terms() const;
  std::string generic_term() const;
  std::string claims() const;
  std::string held_out_table() const;
  std::string held_out_charts();
  std::string confirmation() const;
};

}  // namespace calx
