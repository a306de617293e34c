#pragma once

// Makes the set-up sheet for the operator of a machine: one page for printing.

#include <string>
#include <vector>

#include "report/page/page.h"
#include "studies/setup/setup_sheet.h"

namespace retrace::report {

/// Returns the set-up sheet.
/// \param drawings drawings of the arrangement and of the tool path
Page setup_page(const studies::FabricationResult& result, const studies::SetupSheet& sheet,
                std::vector<PageFigure> drawings);

/// Returns the page as one HTML file without scripts.
/// \throw InputError if the shipped styles are missing
std::string setup_html(const Page& page);

}  // namespace retrace::report
