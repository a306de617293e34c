#pragma once

// Reads photometric files of lamps: IESNA LM-63 (.ies) and EULUMDAT (.ldt).

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Reads a lamp by the ending of the file's name. \throw InputError naming file and line, at `option` for another
/// ending
PhotometricLamp read_lamp(const std::filesystem::path& file, const std::string& option);

/// Reads ANSI/IESNA LM-63-86, -91, -95, -2002 and -19: planes C, B and A, with the symmetries of their first and last
/// plane; TILT is NONE or INCLUDE, whose factors are for other positions of burning and left out. Candela are
/// multiplied by the candela multiplier and the ballast factor, and by the ballast-lamp photometric factor if the
/// edition is of 1986 (no header line before TILT) or 1991. The header line and keywords may be in upper or lower case.
/// \param file its name, for messages \throw InputError naming it and the line
PhotometricLamp parse_ies(std::string_view text, const std::string& file);

/// EULUMDAT (A. Stockmar 1990): planes C with the symmetries 0 to 4, cd per 1000 lm of the first set of light sources.
/// \throw InputError likewise
PhotometricLamp parse_ldt(std::string_view text, const std::string& file);

}  // namespace retrace::studies
