#pragma once

// Documents and tables of `retrace rre`: RRE, derivatives, footprints, far fields.

#include <string>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// The result as a `retrace.rre/1` document.
std::string rre_json(const RreResult& result);

/// One line a point; the header holds the keys of the JSON.
std::string rre_csv(const RreResult& result);

/// A table for a terminal: RRE and its standard error in percent.
std::string rre_table(const RreResult& result);

/// A table for a terminal: the change of RRE, as a fraction, per unit of each parameter. Empty if none was requested.
std::string derivative_table(const RreResult& result);

/// The active regions of every direction as a `retrace.footprint/1` document, a GeoJSON feature collection in mm.
/// \pre a footprint was requested
std::string footprint_json(const RreResult& result);

/// The directions in which light leaves the entrance face as a `retrace.far_field/1` document.
/// \pre a far field was requested
std::string far_field_json(const RreResult& result);

/// One line a spot; the header holds the keys of the JSON.
std::string far_field_csv(const RreResult& result);

}  // namespace retrace::studies
