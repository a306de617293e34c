#pragma once

#include <filesystem>

namespace retrace {

/// The folder of shipped data (materials): $RETRACE_DATA_DIR if set, else share/retrace beside the program's own bin/
/// folder, which holds for the build tree and for an installation. \throw InputError if there is no such folder.
std::filesystem::path data_directory();

}  // namespace retrace
