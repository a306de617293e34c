#pragma once

#include <string>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// The active regions of every direction as a `retrace.footprint/1` document, a GeoJSON feature collection in mm.
/// \pre a footprint was asked for
std::string footprint_json(const RreResult& result);

}  // namespace retrace::studies
