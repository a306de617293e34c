#pragma once

// Reads the cubes of an array from a file, which is either TOML (retrace.cubes/1) or CSV.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/schema/schema.h"
#include "studies/ranging/cube_array.h"

namespace retrace::studies {

/// Returns the keys of the TOML format `retrace.cubes/1`.
const schema::Format& cubes_format();

/// Reads a TOML file of cubes. The result contains the cubes of all rings first, then of all grids, then single cubes.
/// \throw InputError with file, line and key
std::vector<ArrayCube> parse_cubes(std::string_view text, const std::string& source_name);

/// Reads a CSV file of cubes. Its columns are x_mm, y_mm, z_mm, axis_x, axis_y and axis_z. Optional columns are
/// clocking_deg, dihedral_error_1_arcsec, dihedral_error_2_arcsec and dihedral_error_3_arcsec.
/// \throw InputError with file, line and column
std::vector<ArrayCube> parse_cube_table(std::string_view text, const std::string& source_name);

/// Reads a file of cubes. A file with the extension .csv is read as CSV, and any other file as TOML.
/// \throw InputError that names the field `cubes`
std::vector<ArrayCube> read_cubes(const std::filesystem::path& file);

}  // namespace retrace::studies
