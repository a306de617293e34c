#pragma once

// Reads tables over wavelength: the CIE's V and illuminants, spectral power of lamps, absorption of dyes.

#include <filesystem>
#include <string>
#include <string_view>

#include "materials/chromaticity.h"
#include "materials/spectrum.h"

namespace retrace::materials {

/// What the CIE standardises, tabulated in steps of 5 nm from 380 to 780 nm.
struct CieTable {
  SpectralCurve photopic_efficiency;  ///< V, 1 at 555 nm
  SpectralCurve illuminant_a;         ///< relative spectral power per nm, 100 at 560 nm
  SpectralCurve illuminant_d65;
};

/// The table in the data folder. \throw InputError naming file and line
CieTable shipped_cie_table();

/// Reads the table from a file. \throw InputError naming file and line
CieTable read_cie_table(const std::filesystem::path& file);

/// The colour matching functions in the data folder. \throw InputError naming file and line
ColourMatching shipped_colour_matching();

/// Reads them from a file. \throw InputError naming file and line
ColourMatching read_colour_matching(const std::filesystem::path& file);

/// Reads the spectral power of a lamp: CSV with the header wavelength_nm,power, wavelengths in vacuum that ascend from
/// 1 to 100000 nm, power per nm in any unit, >= 0; at least two lines, at most 1 MiB. Lines that are empty or begin
/// with # are skipped. \throw InputError naming file, line and column
SpectralCurve read_spectral_power(const std::filesystem::path& file);

/// The same of a text. \param name of the file, for messages
SpectralCurve parse_spectral_power(std::string_view text, const std::string& name);

/// Reads the absorption of a dyed material, likewise: header wavelength_nm,absorption_per_mm; Napierian, for power, >=
/// 0. \throw InputError naming file, line and column
SpectralCurve read_spectral_absorption(const std::filesystem::path& file);

/// The same of a text. \param name of the file, for messages
SpectralCurve parse_spectral_absorption(std::string_view text, const std::string& name);

}  // namespace retrace::materials
