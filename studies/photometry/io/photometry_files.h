#pragma once

// Output documents and tables of `retrace photometry`.

#include <cstddef>
#include <limits>
#include <string>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Returns the result as JSON with the schema retrace.photometry/2.
std::string photometry_json(const PhotometryResult& result);

/// Returns the readings as CSV, with one line for each test point.
std::string photometry_csv(const PhotometryResult& result);

/// Returns the maps of R_A around the direction back to the source as CSV, with one line for each direction of view.
/// Directions are in degrees to the right of the direction to the source and above it.
std::string far_field_map_csv(const PhotometryResult& result);

/// Returns a table of the preliminary readings with their standard errors, for the terminal.
std::string first_answer_table(const PhotometricFirstAnswer& answer);

/// Returns the table, the verdict and the advice for the terminal.
/// \param max_rows maximum number of rows for the points of the design, and of the changed design; those with the
/// smallest margins are kept. > 0
std::string photometry_table(const PhotometryResult& result,
                             std::size_t max_rows = std::numeric_limits<std::size_t>::max());

}  // namespace retrace::studies
