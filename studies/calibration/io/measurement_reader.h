#pragma once

// Reads tables of what was measured of parts, and plans the jobs that these were cut by.

#include <filesystem>
#include <string_view>

#include "studies/calibration/calibration.h"

namespace retrace::studies {

/// The table of a text. Columns `job` (a job file, from the table's folder), `element`, `facet`, `what` (a word of
/// kFacetQuantityWords), `value`, `uncertainty`, and where they are needed `from_element`, `from_facet` and `at`
/// (along the edge, -1 to 1). Rows without a value are passed over.
/// \throw InputError naming file, line and column, also for jobs of several machines
MeasuredParts parse_measurements(std::string_view text, const std::filesystem::path& file, const FileTexts& texts = {});

MeasuredParts read_measurements(const std::filesystem::path& file);

}  // namespace retrace::studies
