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

/// Returns the maps over entrance and observation angle as CSV: one line for each map and entrance angle, with one
/// column for each observation angle. The values are R_A in cd/(lx m^2), or R_I in mcd/lx if the standard limits R_I.
/// Empty if there are no maps.
std::string coefficient_map_csv(const PhotometryResult& result);

/// Returns the ratios of the maps of two designs as CSV, see coefficient_map_csv(). Ratios that are not defined,
/// because the first value is 0, are empty. Empty unless there are maps of two designs.
std::string coefficient_ratio_csv(const PhotometryResult& result);

/// Returns tables of the maps over entrance and observation angle for the terminal, with at most 8 angles in each
/// direction. Empty if there are no maps.
/// \param max_tables maximum number of tables; a line gives the number of the others
std::string coefficient_map_table(const PhotometryResult& result,
                                  std::size_t max_tables = std::numeric_limits<std::size_t>::max());

/// Returns a table of the preliminary readings with their standard errors, for the terminal.
std::string first_answer_table(const PhotometricFirstAnswer& answer);

/// Returns the table, the verdict and the advice for the terminal.
/// \param max_rows maximum number of rows for the points of the design, and of the changed design; those with the
/// smallest margins are kept. > 0
std::string photometry_table(const PhotometryResult& result,
                             std::size_t max_rows = std::numeric_limits<std::size_t>::max());

}  // namespace retrace::studies
