#pragma once

// Reads tables of photometric limits (CSV): test points of a standard for each class and colour.

#include <filesystem>
#include <string>
#include <string_view>

#include "studies/photometry/limits.h"

namespace retrace::studies {

/// Reads a limits file. It is a CSV file with comment lines (#) and the header
/// standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status. A column for the source may follow. Each
/// further line contains one limit.
/// Several classes are separated by spaces. `+-10` means both signs. V `0 or +-5` means 0. If the entrance face
/// reflects the lamp directly to the receiver at 0, readings are taken at 5 and -5 instead, and the smaller one counts.
/// The unit `factor` defines the limits of a colour as multiples of those of another colour (`2.5 x red`). The unit
/// `cm2` limits the area (`at most 100`). The unit `chromaticity` limits the colour (`z <= 0.008`, `y >= 0.146 + 0.489
/// x`).
/// The status `incomplete` marks a standard of which the file contains only a part.
/// \throw InputError that contains file, line and column, the allowed values and the given value
LimitTable read_limits(const std::filesystem::path& file);

/// Reads the content of a limits file with the name `name`.
LimitTable parse_limits(std::string_view content, const std::string& name);

}  // namespace retrace::studies
