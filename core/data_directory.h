#pragma once

// Finds the data that is shipped with retrace: materials, machines, processes, limits, and the JSON Schemas of its file
// formats.

#include <filesystem>
#include <string_view>
#include <vector>

namespace retrace {

/// Returns the folder of shipped data: $RETRACE_DATA_DIR if this variable is set, and otherwise share/retrace of
/// installation_folder().
/// \throw InputError if there is no such folder
std::filesystem::path data_directory();

/// Returns the file with the JSON Schema of a file format. It is in share/retrace_schemas of installation_folder().
/// \throw InputError if the file does not exist
std::filesystem::path schema_file(std::string_view format);

/// Returns the TOML files in a folder of data_directory(), sorted by name.
/// \throw InputError if the folder cannot be read
std::vector<std::filesystem::path> shipped_files(std::string_view folder);

}  // namespace retrace
