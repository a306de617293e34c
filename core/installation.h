#pragma once

// Finds the folder in which retrace is installed or built.

#include <filesystem>

namespace retrace {

/// Returns the folder that contains share/retrace and lib/retrace. It is searched upwards from the file that contains
/// this code, which is the program or a library that includes retrace. This works in build folders and in
/// installations. If there is no such folder, returns the parent of the folder of that file.
const std::filesystem::path& installation_folder();

}  // namespace retrace
