#pragma once

// Converts the name of a standard, with class, colour and dye, to a photometry request.

#include <filesystem>
#include <optional>
#include <string>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Selection of a standard, in the words of the command line or of a study.
struct StandardChoice {
  std::string standard;  ///< name in shipped_standards(), or a file with limits
  std::optional<std::string> part_class;
  std::optional<std::string> colour;
};

/// Returns the file with the limits: a shipped file, or a file of the user.
/// \throw InputError whose location is the option --standard
std::filesystem::path limits_file_of(const std::string& standard);

/// Returns the request for a standard, with the apertures and rotations of the standard. The caller must still set the
/// area and the dye.
/// \throw InputError whose location is the option --standard, --class or --colour, or a line of the file with limits
PhotometryRequest photometry_request(const StandardChoice& choice);

/// Returns the file of a dye. Empty if there is no dye.
/// \param dye none, red, amber or the name of a file; by default the dye of the colour
/// \param design_is_coloured true if the design has a spectral absorption; only an explicit dye is then used
/// \throw InputError whose location is the option --dye
std::filesystem::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured,
                                  const std::string& colour);

/// Sets the dye of a request.
/// \param file file of the dye, as returned by dye_file_of()
/// \throw InputError whose location is the option --dye, if the dye cannot be read
void set_dye(PhotometryRequest& request, const std::optional<std::string>& dye, const std::filesystem::path& file);

}  // namespace retrace::studies
