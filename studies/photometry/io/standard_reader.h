#pragma once

// Turns the name of a standard with class, colour and dye into a photometry request.

#include <filesystem>
#include <optional>
#include <string>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// How a standard is requested, by the words of the command line or of a study.
struct StandardChoice {
  std::string standard;  ///< of shipped_standards(), or a limits file
  std::optional<std::string> part_class;
  std::optional<std::string> colour;
};

/// The file with the limits: the shipped one, or the user's. \throw InputError at --standard
std::filesystem::path limits_file_of(const std::string& standard);

/// What the standard asks, with its apertures and rotations: a request that lacks area and dye. \throw InputError at
/// --standard, --class, --colour or a line of the limits
PhotometryRequest photometry_request(const StandardChoice& choice);

/// The dye's file; empty for none. \param dye none, red, amber or a file; unless told, that of the colour
/// \param design_is_coloured its absorption is spectral already: then only a dye that is told counts
/// \throw InputError at --dye
std::filesystem::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured,
                                  const std::string& colour);

/// Sets the dye of a request.
/// \param file file of the dye, as returned by dye_file_of()
/// \throw InputError at --dye if the dye cannot be read
void set_dye(PhotometryRequest& request, const std::optional<std::string>& dye, const std::filesystem::path& file);

}  // namespace retrace::studies
