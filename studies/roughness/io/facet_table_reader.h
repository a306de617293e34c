#pragma once

// Reads tables of measured facet roughness (CSV), grouped by process.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "studies/roughness/roughness.h"

namespace retrace::studies {

/// Reads a table of measured facets: CSV with lines of comment (#), a line of column names and one line a facet.
/// Columns: `roughness_sa_nm` (or `sa_nm`), `waviness_sa_nm` (0 where it is missing), `process`, `facet`. Others are
/// passed over. The facets of one process make one group, in the order of the file; without that column each facet is
/// one.
/// \throw InputError naming file, line and column, what is allowed and what was given
std::vector<FacetGroup> read_facet_table(const std::filesystem::path& file);

/// The same for the content of a table called `name`.
std::vector<FacetGroup> parse_facet_table(std::string_view content, const std::string& name);

}  // namespace retrace::studies
