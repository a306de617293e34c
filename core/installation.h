#pragma once

// Where retrace is installed, or built.

#include <filesystem>

namespace retrace {

/// The folder with share/retrace and lib/retrace: the nearest one above the file that this code is in - the program, or
/// a library that has retrace within itself - in a build folder and in an installation. Beside the file's own folder if
/// there is none.
const std::filesystem::path& installation_folder();

}  // namespace retrace
