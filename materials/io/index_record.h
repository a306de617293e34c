#pragma once

// Reads records of the refractiveindex.info database (YAML). Each file contains one material.

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// Returns true if the name of a file ends in .yml or .yaml.
inline bool is_index_record(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".yml" || ending == ".yaml";
}

/// Returns the material that a record describes. In the record, DATA must contain the refractive index, as one of the
/// formulas 1 to 9 or as a table of n. A table of n gives no index outside its wavelengths. DATA may also contain a
/// table of the extinction coefficient k, from which the absorption 4 pi k / w is computed (w: wavelength).
/// Indices are relative to air unless CONDITIONS or SPECS contain `n_is_absolute: true`. CONDITIONS or SPECS may
/// contain the temperature in K. PROPERTIES may contain thermo-optic coefficients (formula A, which is Schott's
/// formula). PROPERTIES or SPECS may contain n_d. Other entries have no effect.
/// The material has warnings for rows of k that cannot be used, and for a value of n_d that differs from the index of
/// the data.
/// \param file name of the file, for messages; the name without its ending becomes the name of the material
/// \throw InputError with the file and line, if the text is not YAML, or if data of the index are missing or invalid
Material parse_index_record(std::string_view text, const std::string& file);
/// Reads a file and parses it with parse_index_record().
/// \throw InputError in the same cases as parse_index_record(), and if the file cannot be read
Material read_index_record(const std::filesystem::path& file);

}  // namespace retrace::materials
