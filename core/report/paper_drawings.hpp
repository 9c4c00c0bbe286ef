// paper_drawings.hpp: the charts and pictures of a publication's row.
#pragma once
#include <string>

#include "report/page.hpp"
#include "report/paper_figures.hpp"

namespace calx {

/// Measured, simulated and computed figures side by side, then the row's plots, one line a seed, and pictures; HTML for
/// a grid of charts. results: by form.
std::string paper_drawings(Page& page, const PaperRow& row, const PaperResult (&results)[2]);

}  // namespace calx
