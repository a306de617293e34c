#pragma once

// Reads tables of measurements, and plans the jobs that cut the measured parts.

#include <filesystem>
#include <string_view>

#include "studies/calibration/calibration.h"

namespace retrace::studies {

/// Reads a table with the columns `job` (a job file in the table's folder), `element`, `facet`, `what` (a word of
/// kFacetQuantityWords), `value` and `uncertainty`. The columns `from_element`, `from_facet` and `at` (position along
/// the edge, -1 to 1) are needed for some quantities. Rows without a value are skipped.
/// \throw InputError that names file, line and column; also for jobs of several machines
MeasuredParts parse_measurements(std::string_view text, const std::filesystem::path& file, const FileTexts& texts = {});

MeasuredParts read_measurements(const std::filesystem::path& file);

}  // namespace retrace::studies
