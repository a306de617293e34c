#pragma once

// Reads the files of a photometric test, which contain limits and dyes, and resolves requests into settings.

#include <filesystem>
#include <optional>
#include <string>

#include "requests/photometry.h"
#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Returns the path of the file that contains the limits of a standard.
/// \param standard name of a standard in shipped_standards(), or path of a file with limits
/// \throw InputError at the field `standard` if it is neither a known name nor an existing file
std::filesystem::path limits_file_of(const std::string& standard);

/// Returns the path of the file that contains the absorption of a dye. The path is empty if no dye is used.
/// \param dye "none", "red", "amber" or the path of a file. By default, `colour` determines the dye.
/// \param design_is_coloured true if the design has a spectral absorption. There is then no default dye.
/// \param colour colour of the part in the test plan
/// \throw InputError at the field `dye` if it is neither a known name nor an existing file
std::filesystem::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured,
                                  const std::string& colour);

/// Checks a request, reads the limits and the dye, and returns the settings of the study. Empty fields of the request
/// get the values of the standard. The settings request that the colour of the returned light is computed.
/// \param design_is_coloured true if the design has a spectral absorption; see dye_file_of()
/// \throw InputError at a field of the request, or at a line of the file with limits
PhotometrySettings resolve(const PhotometryRequest& request, bool design_is_coloured);

/// Returns the second design of a comparison with its dye. If the request has no dye, a design without spectral
/// absorption gets the dye of the colour.
/// \param colour colour of the part in the test plan
/// \throw InputError at the field `dye` if its file does not exist
ComparedDesign compared_design(const PhotometryRequest& request, design::Design design, const std::string& colour);

}  // namespace retrace::studies
