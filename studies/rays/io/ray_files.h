#pragma once

// Files of rays by their endings: .tm25ray and .csv.

#include <filesystem>
#include <memory>
#include <string>

#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// \throw InputError naming file and place, at `option` for another ending
std::unique_ptr<RaySource> open_ray_file(const std::filesystem::path& file, const std::string& option);

/// The file that rays are written to appears when it is finished. \throw InputError at `option` for another ending;
/// OutputError
std::unique_ptr<RaySink> make_ray_file(const std::filesystem::path& file, const std::string& option);
/// Whether it could be made. \throw InputError likewise
void check_ray_file(const std::filesystem::path& file, const std::string& option);

}  // namespace retrace::studies
