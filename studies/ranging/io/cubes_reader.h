#pragma once

// Reads the cubes of an array from a file of cubes: TOML (retrace.cubes/1) or CSV.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/schema/schema.h"
#include "studies/ranging/cube_array.h"

namespace retrace::studies {

/// Returns the keys of files of cubes in TOML.
const schema::Format& cubes_format();

/// Reads a file of cubes in TOML. Rings come first, then grids, then single cubes.
/// \throw InputError with file, line and key
std::vector<ArrayCube> parse_cubes(std::string_view text, const std::string& source_name);

/// Reads a table of cubes: x_mm,y_mm,z_mm,axis_x,axis_y,axis_z, and optionally clocking_deg and the three columns
/// dihedral_error_1_arcsec, dihedral_error_2_arcsec and dihedral_error_3_arcsec.
/// \throw InputError with file, line and column
std::vector<ArrayCube> parse_cube_table(std::string_view text, const std::string& source_name);

/// Reads a file of cubes. A file with the extension .csv is read as a table, and any other file as TOML.
/// \throw InputError that names the field `cubes`
std::vector<ArrayCube> read_cubes(const std::filesystem::path& file);

}  // namespace retrace::studies
