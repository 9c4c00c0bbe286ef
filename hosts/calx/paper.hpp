// paper.hpp: the command that sets a publication's figures beside runs.
#pragma once
namespace CLI {
class App;
}
namespace calx {
/// `calx paper ROWS.json`: computes the runs that are missing and writes paper.html.
void add_paper_command(CLI::App& app);
}  // namespace calx
