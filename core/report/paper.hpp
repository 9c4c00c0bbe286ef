// paper.hpp: one self-contained HTML page that sets a publication's figures beside finished runs, row by row.
#pragma once
#include <string>

#include "report/paper_rows.hpp"

namespace calx {

/// Writes out/paper.html (out is made when missing) from the rows and the run folders below out/runs; a row without a
/// finished run says so. seeds: how many of each run's seeds are asked for. Returns the page's path. Throws
/// Error(Fault::files).
std::string write_paper(const PaperRows& rows, std::size_t seeds, const std::string& out);

}  // namespace calx
