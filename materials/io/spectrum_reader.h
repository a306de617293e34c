#pragma once

// Reads tables over wavelength: V and the illuminants of the CIE, spectral powers of lamps, and absorptions of dyes.

#include <filesystem>
#include <string>
#include <string_view>

#include "materials/chromaticity.h"
#include "materials/spectrum.h"

namespace retrace::materials {

/// Curves standardised by the CIE, in steps of 5 nm from 380 to 780 nm.
struct CieTable {
  SpectralCurve photopic_efficiency;  ///< V, 1 at 555 nm
  SpectralCurve illuminant_a;         ///< relative spectral power per nm, 100 at 560 nm
  SpectralCurve illuminant_d65;
};

/// Reads the CIE table in the data folder.
/// \throw InputError with file and line
CieTable shipped_cie_table();

/// Reads a CIE table from a file.
/// \throw InputError with file and line
CieTable read_cie_table(const std::filesystem::path& file);

/// Reads the colour matching functions in the data folder.
/// \throw InputError with file and line
ColourMatching shipped_colour_matching();

/// Reads colour matching functions from a file.
/// \throw InputError with file and line
ColourMatching read_colour_matching(const std::filesystem::path& file);

/// Reads the spectral power of a lamp from a CSV file with the header wavelength_nm,power. Wavelengths in vacuum must
/// ascend from 1 to 100000 nm. Powers are per nm in any unit and >= 0. The file must have at least two lines of data
/// and at most 1 MiB. Empty lines and lines that begin with # are skipped.
/// \throw InputError with file, line and column
SpectralCurve read_spectral_power(const std::filesystem::path& file);

/// Reads the spectral power of a lamp from a text.
/// \param name name of the file, for messages
SpectralCurve parse_spectral_power(std::string_view text, const std::string& name);

/// Reads the absorption of a dyed material from a CSV file with the header wavelength_nm,absorption_per_mm. All other
/// rules are the same as for read_spectral_power(). The absorption coefficient is Napierian (base e), for power, and
/// not negative.
/// \throw InputError with file, line and column
SpectralCurve read_spectral_absorption(const std::filesystem::path& file);

/// Reads the absorption of a dyed material from a text.
/// \param name name of the file, for messages
SpectralCurve parse_spectral_absorption(std::string_view text, const std::string& name);

}  // namespace retrace::materials
