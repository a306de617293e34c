#pragma once

// Documents and tables of `retrace metrology`, and the [surface] of a design that fits the measurement.

#include <string>

#include "studies/metrology/metrology.h"

namespace retrace::studies {

/// The result as a `retrace.metrology/1` document.
std::string metrology_json(const MetrologyResult& result);

/// The same as lines for a terminal, the design's table at their end.
std::string metrology_text(const MetrologyResult& result);

/// The table `[surface]` of a design file that describes this surface, or the radius of its edge.
std::string surface_toml(const MetrologyResult& result);

/// The spectra, one line a frequency: `direction,frequency_per_mm,psd,unit`.
std::string spectra_csv(const MetrologyResult& result);

}  // namespace retrace::studies
