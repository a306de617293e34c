#pragma once

// The sheet for who sets up a machine for a job: one page that prints.

#include <string>
#include <vector>

#include "report/page/page.h"
#include "studies/setup/setup_sheet.h"

namespace retrace::report {

/// \param drawings of the arrangement and of the tool's way
Page setup_page(const studies::FabricationResult& result, const studies::SetupSheet& sheet,
                std::vector<PageFigure> drawings);

/// The page as one HTML file without scripts. \throw InputError where shipped styles are missing
std::string setup_html(const Page& page);

}  // namespace retrace::report
