#pragma once

// Reads the files of a photometric test: limits and dyes.

#include <filesystem>
#include <optional>
#include <string>

#include "requests/photometry.h"
#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Returns the file with the limits: a shipped file, or a file of the user.
/// \param standard name in shipped_standards(), or a file with limits
/// \throw InputError at the field `standard`
std::filesystem::path limits_file_of(const std::string& standard);

/// Returns the file of a dye. Empty if there is no dye.
/// \param dye none, red, amber or the name of a file; by default the dye of the colour
/// \param design_is_coloured true if the design has a spectral absorption; only an explicit dye is then used
/// \throw InputError at the field `dye`
std::filesystem::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured,
                                  const std::string& colour);

/// Checks a request, reads the limits and the dye, and returns the settings of the study. The colour of the returned
/// light is computed. For empty fields, the settings of the standard are used.
/// \param design_is_coloured see dye_file_of()
/// \throw InputError at a field of the request, or at a line of the file with limits
PhotometrySettings resolve(const PhotometryRequest& request, bool design_is_coloured);

}  // namespace retrace::studies
