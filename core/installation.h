#pragma once

// Finds the folder in which retrace is installed or built.

#include <filesystem>

namespace retrace {

/// Returns the folder that contains share/retrace and lib/retrace. It is the nearest such folder above the file that
/// contains this code, which is the program or a library that includes retrace. This works in build folders and in
/// installations. If there is no such folder, returns the parent of the file's folder.
const std::filesystem::path& installation_folder();

}  // namespace retrace
