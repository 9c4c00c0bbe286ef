#include "report/diagnosis_page.hpp"

namespace calx {
std::string write_diagnosis_report(const std::string& dir) { return dir + "/report.html"; }
}  // namespace calx
