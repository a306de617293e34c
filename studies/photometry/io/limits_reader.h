#pragma once

// Reads tables of photometric limits (CSV): test points of a standard by class and colour.

#include <filesystem>
#include <string>
#include <string_view>

#include "studies/photometry/limits.h"

namespace retrace::studies {

/// Reads a limits file: CSV with lines of comment (#), the header
/// standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status and one line a limit. Several classes stand
/// with spaces between; `+-10` is both signs; a unit of `factor` makes the limits of a colour so many times those of
/// another (`2.5 x red`); a status of `incomplete` marks a standard that the file does not hold whole.
/// \throw InputError naming file, line and column, what is allowed and what was given
LimitTable read_limits(const std::filesystem::path& file);

/// The same for the content of a file called `name`.
LimitTable parse_limits(std::string_view content, const std::string& name);

}  // namespace retrace::studies
