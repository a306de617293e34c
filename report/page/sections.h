#pragma once

// Composes the page of `retrace report` from the documents of a result folder.

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report {

/// Returns the page for the results in a folder. The summary comes first, and the list of sources last. Values that a
/// document lacks are omitted. Page::scene is empty and must be set by the caller.
/// \param title title of the page; if empty, the title of the design is used
Page study_page(const ResultFolder& folder, const std::string& title);

/// Returns the design of the first document that contains one, as JSON, or null if there is none.
const nlohmann::ordered_json* first_design(const ResultFolder& folder);

/// Returns the directions with the smallest and the largest incidence of the first RRE curve, in degrees.
std::vector<std::array<double, 2>> extreme_directions_deg(const ResultFolder& folder);

}  // namespace retrace::report
