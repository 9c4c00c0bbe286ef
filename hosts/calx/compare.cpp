// compare.cpp: calx compare: two runs side by side, on the terminal and as a page.
#include "report/compare.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "compare.hpp"
#include "io/io.hpp"

namespace calx {

void add_compare_command(CLI::App& app) {
  struct Flags {
    std::string a, b, page;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  auto* command =
      app.add_subcommand("compare", "two runs side by side: what differs in what they were given and in what came out");
  command->add_option("a", flags->a, "folder of a run")->required();
  command->add_option("b", flags->b, "folder of another run")->required();
  command->add_option("--page", flags->page, "also write a page with their series one over the other to this file");
  command->add_flag("--json", flags->json, "the comparison as JSON on stdout");
  command->callback([flags] {
    const RunComparison comparison = compare_runs(flags->a, flags->b);
    std::fputs((flags->json ? comparison_json(comparison) : comparison_text(comparison)).c_str(), stdout);
    if (!flags->page.empty()) write_text_atomically(flags->page, comparison_page(comparison));
  });
}

}  // namespace calx
