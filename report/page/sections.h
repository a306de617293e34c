#pragma once

// Composes the page of `retrace report` from the documents of a result folder.

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report {

/// What the page says of a folder's results, the summary first and where everything comes from last. Documents that
/// lack values that they should have are shown without them, not refused. Page::scene is left empty for the caller.
/// \param title empty: that of the design
Page study_page(const ResultFolder& folder, const std::string& title);

/// The design of the first document that quotes one, as JSON; null if none does.
const nlohmann::ordered_json* first_design(const ResultFolder& folder);

/// The directions of light in the results: the least and the greatest incidence of the first RRE curve.
std::vector<std::array<double, 2>> extreme_directions_deg(const ResultFolder& folder);

}  // namespace retrace::report
