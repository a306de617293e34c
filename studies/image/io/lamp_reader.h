#pragma once

// Reads photometric files of lamps: IESNA LM-63 (.ies) and EULUMDAT (.ldt).

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Reads the photometric data of a lamp. The extension of the file name determines the format.
/// \param field request field that contains the file name, for error messages
/// \throw InputError at the file and line of an error, or at `field` if the extension is unknown
PhotometricLamp read_lamp(const std::filesystem::path& file, Field field);

/// Reads a photometric file of the editions LM-63-86, -91, -95, -2002 and -19 (ANSI/IESNA). The planes may be of type
/// C, B or A. The angles of the first and the last plane determine the symmetry.
/// TILT must be NONE or INCLUDE. The factors of INCLUDE have no effect because they apply to lamps that are operated in
/// a tilted position.
/// Intensities are multiplied by the candela multiplier and the ballast factor. In the editions of 1986 (no header line
/// before TILT) and 1991, they are also multiplied by the ballast-lamp photometric factor.
/// The header line and keywords may be in upper or lower case.
/// \param file name of the file, for messages
/// \throw InputError that names the file and the line
PhotometricLamp parse_ies(std::string_view text, const std::string& file);

/// Reads a EULUMDAT file (A. Stockmar 1990) with C planes and any of the symmetries 0 to 4. The intensities in the file
/// are in cd per 1000 lm. They refer to the luminous flux of the first set of light sources.
/// \throw InputError that names the file and the line
PhotometricLamp parse_ldt(std::string_view text, const std::string& file);

}  // namespace retrace::studies
