#pragma once

// Output documents and tables of `retrace metrology`, and the table [surface] of a design file that describes the
// measured surface.

#include <string>

#include "studies/metrology/metrology.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.metrology/1`.
std::string metrology_json(const MetrologyResult& result);

/// Returns the result as lines for the terminal. The last lines are the table [surface] of a design file.
std::string metrology_text(const MetrologyResult& result);

/// Returns the table [surface] of a design file, which describes the measured surface or the radius or chamfer of the
/// measured edge.
std::string surface_toml(const MetrologyResult& result);

/// Returns the spectra as CSV with one line for each frequency and the columns `direction,frequency_per_mm,psd,unit`.
std::string spectra_csv(const MetrologyResult& result);

}  // namespace retrace::studies
