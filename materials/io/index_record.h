#pragma once

// Reads records of the refractiveindex.info database (YAML): one material a file.

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// Whether a file's name is that of a record: it ends in .yml or .yaml.
inline bool is_index_record(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".yml" || ending == ".yaml";
}

/// Returns the material that a record describes. Its DATA must contain the refractive index, as one of the formulas 1
/// to 9 or as a table of n. They may also contain a table of k, from which the absorption 4 pi k / w is computed. A
/// table of n gives no index outside its wavelengths. Indices are relative to air unless CONDITIONS or SPECS contain
/// `n_is_absolute: true`. CONDITIONS or SPECS may give the temperature in K. PROPERTIES may give the thermo-optic
/// coefficients (formula A, which is Schott's formula). PROPERTIES or SPECS may give n_d. Other entries have no effect.
/// The warnings of the material report rows of k that cannot be used, and a value of n_d that differs from the index of
/// the data.
/// \param file name of the file, for messages; the name without its ending becomes the name of the material
/// \throw InputError with the file and line, if the text is not YAML, or if data of the index are missing or invalid
Material parse_index_record(std::string_view text, const std::string& file);
/// \throw InputError also if the file cannot be read
Material read_index_record(const std::filesystem::path& file);

}  // namespace retrace::materials
