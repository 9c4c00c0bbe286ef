// Writes a sample run and its report into the folder given, to look at the page in a browser.
#include <cstdio>
#include <cstdlib>

#include "report/report.hpp"
#include "sample_run.hpp"

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: report_sample FOLDER [GRAINS]\n"), 2;
  calx_test::SampleOptions options;
  if (argc == 3) options.grains = static_cast<std::size_t>(std::strtoul(argv[2], nullptr, 10));
  calx_test::write_sample_run(argv[1], options);
  std::printf("%s\n", calx::write_report(argv[1]).c_str());
  return 0;
}
