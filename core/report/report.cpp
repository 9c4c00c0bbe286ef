#include "report/report.hpp"

#include "io/io.hpp"
#include "report/sections.hpp"

namespace calx {

std::string write_report(const std::string& dir) {
  const RunFolder run = read_run_folder(dir);
  Page page(run.title);
  Sections sections{run, key_figures(run), page};
  sections.header();
  sections.overview();
  sections.pictures();
  sections.flow();
  sections.lab();
  sections.dosing();
  sections.pile();
  sections.ledgers();
  sections.loads();
  sections.other_sensors();
  sections.time_step();
  sections.provenance();
  sections.case_text();
  const std::string path = dir + "/report.html";
  write_text_atomically(path, page.html());
  return path;
}

}  // namespace calx
