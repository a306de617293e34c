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

/// The material that a record tells, by its DATA: one of the formulas 1 to 9 or a table of n, and a table of k, from
/// which the absorption is 4 pi k / w. Beyond its wavelengths a table of n has no index. Indices are relative to air,
/// unless CONDITIONS or SPECS say `n_is_absolute: true`; CONDITIONS tell the temperature (in K), PROPERTIES the
/// thermo-optic coefficients (formula A: Schott's) and n_d. Other entries have no effect. The warnings of the material
/// name rows of k that cannot be used, and an n_d that is not that of the data.
/// \param file its name, for messages; without its ending it is that of the material
/// \throw InputError naming file and line for text that is no YAML, and for data of the index that are not there or not
/// understood
Material parse_index_record(std::string_view text, const std::string& file);
/// \throw InputError also if the file cannot be read
Material read_index_record(const std::filesystem::path& file);

}  // namespace retrace::materials
