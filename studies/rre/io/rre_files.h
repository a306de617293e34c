#pragma once

// Output documents and tables of `retrace rre`: RRE, derivatives, footprints, far fields.

#include <string>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.rre/1`.
std::string rre_json(const RreResult& result);

/// Returns the points as CSV. The header contains the keys of the JSON document.
std::string rre_csv(const RreResult& result);

/// Returns a table for the terminal with RRE and its standard error in percent.
std::string rre_table(const RreResult& result);

/// Returns the polar maps as CSV: one line for each map and azimuth, with one column for each incidence.
/// \pre result.has_complete_maps()
std::string rre_map_csv(const RreResult& result);

/// Returns a summary of the polar maps for the terminal, in percent: for each map, the mean, the extreme values and at
/// most 17 incidences with the smallest, the mean and the largest value over the azimuths.
/// \pre result.has_complete_maps()
std::string rre_map_table(const RreResult& result);

/// Returns a table of limited length for the terminal: for each curve, the number of points, RRE at normal incidence
/// (or at the first angle), the maximum and its angle, and the angles at which RRE falls to half of its value at normal
/// incidence. If there are too many curves, the azimuths of a design have one line.
/// \param max_lines maximum number of lines, >= 3
std::string rre_summary(const RreResult& result, std::size_t max_lines);

/// Returns a table for the terminal with the derivatives of RRE, as a fraction, per unit of each parameter. Empty if
/// none were requested.
std::string derivative_table(const RreResult& result);

/// Returns the active regions of every direction as a document of the format `retrace.footprint/2`. It is a GeoJSON
/// feature collection in mm.
/// \pre a footprint was requested
std::string footprint_json(const RreResult& result);

/// Returns the directions in which light leaves the entrance face as a document of the format `retrace.far_field/1`.
/// \pre a far field was requested
std::string far_field_json(const RreResult& result);

/// Returns the spots of the far fields as CSV. The header contains the keys of the JSON document.
std::string far_field_csv(const RreResult& result);

}  // namespace retrace::studies
