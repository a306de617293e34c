#pragma once

// Documents and tables of `retrace photometry`.

#include <string>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// The result as JSON, schema retrace.photometry/1.
std::string photometry_json(const PhotometryResult& result);

/// One line a test point.
std::string photometry_csv(const PhotometryResult& result);

/// R_A around the return, one line a direction: of every map, in degrees to the right of the direction back to the
/// source and above it.
std::string far_field_map_csv(const PhotometryResult& result);

/// Returns a table of the preliminary readings with their standard errors, for the terminal.
std::string first_answer_table(const PhotometricFirstAnswer& answer);

/// For people at a terminal: the table, the verdict, and what to change.
std::string photometry_table(const PhotometryResult& result);

}  // namespace retrace::studies
