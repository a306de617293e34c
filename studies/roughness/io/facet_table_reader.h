#pragma once

// Reads tables of measured facet roughness (CSV), grouped by process.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "studies/roughness/roughness.h"

namespace retrace::studies {

/// Reads a table of measured facets. It is a CSV file with comment lines (#), a line of column names and one line for
/// each facet.
/// The columns are `roughness_sa_nm` (or `sa_nm`), `waviness_sa_nm` (0 if missing), `process` and `facet`. Other
/// columns are ignored. The facets of one process form a group, in the order of the file. Without the column `process`,
/// each facet is a group.
/// \throw InputError that contains file, line and column, the allowed values and the given value
std::vector<FacetGroup> read_facet_table(const std::filesystem::path& file);

/// Reads the content of a table with the name `name`.
std::vector<FacetGroup> parse_facet_table(std::string_view content, const std::string& name);

}  // namespace retrace::studies
