#pragma once

// Where the data that retrace ships lies: materials, machines, processes, limits, and the JSON Schemas of its file
// formats.

#include <filesystem>
#include <string_view>
#include <vector>

namespace retrace {

/// The folder of shipped data: $RETRACE_DATA_DIR if set, else share/retrace of installation_folder().
/// \throw InputError if there is no such folder
std::filesystem::path data_directory();

/// The JSON Schema of a file format, which lies beside that folder. \throw InputError if it is not there
std::filesystem::path schema_file(std::string_view format);

/// The TOML files of one of its folders, by name. \throw InputError if it cannot be read
std::vector<std::filesystem::path> shipped_files(std::string_view folder);

}  // namespace retrace
