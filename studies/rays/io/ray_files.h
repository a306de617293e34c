#pragma once

// Opens files of rays. The ending of the name determines the format: .tm25ray or .csv.

#include <filesystem>
#include <memory>

#include "core/field.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Opens a file of rays.
/// \throw InputError with the file and the position of an error, or with the location `field` for an unknown ending
std::unique_ptr<RaySource> open_ray_file(const std::filesystem::path& file, Field field);

/// Creates a file of rays. The file exists under its name only after RaySink::finish().
/// \throw InputError with the location `field` for an unknown ending
/// \throw OutputError if the file cannot be written
std::unique_ptr<RaySink> make_ray_file(const std::filesystem::path& file, Field field);
/// Checks that a file of rays can be created.
/// \throw InputError, OutputError in the same cases as make_ray_file()
void check_ray_file(const std::filesystem::path& file, Field field);

}  // namespace retrace::studies
