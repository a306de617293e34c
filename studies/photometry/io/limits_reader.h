#pragma once

// Reads tables of photometric limits (CSV): test points of a standard by class and colour.

#include <filesystem>
#include <string>
#include <string_view>

#include "studies/photometry/limits.h"

namespace retrace::studies {

/// Reads a limits file: CSV with lines of comment (#), the header
/// standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status, behind which a source may stand, and one
/// line a limit. Several classes stand with spaces between; `+-10` is both signs; V `0 or +-5` is 0, and the least of
/// both signs of 5 where the face mirrors at 0; a unit of `factor` makes the limits of a colour so many times those of
/// another (`2.5 x red`); a unit of `cm2` bounds the area (`at most 100`), one of
/// `chromaticity` the colour (`z <= 0.008`, `y >= 0.146 + 0.489 x`); a status of `incomplete` marks a standard
/// that the file does not hold whole.
/// \throw InputError naming file, line and column, what is allowed and what was given
LimitTable read_limits(const std::filesystem::path& file);

/// The same for the content of a file called `name`.
LimitTable parse_limits(std::string_view content, const std::string& name);

}  // namespace retrace::studies
