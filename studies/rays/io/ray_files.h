#pragma once

// Opens files of rays. The ending of the name determines the format: .tm25ray or .csv.

#include <filesystem>
#include <memory>

#include "core/field.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Opens a ray file for reading. The extension of the file name determines the format.
/// \param field request field that contains the file name, for error messages
/// \throw InputError at the position of an error in the file, or at `field` if the extension is unknown
std::unique_ptr<RaySource> open_ray_file(const std::filesystem::path& file, Field field);

/// Creates a ray file for writing. The file does not appear under its name until RaySink::finish() is called.
/// \param field request field that contains the file name, for error messages
/// \throw InputError at `field` if the extension of the file name is unknown
/// \throw OutputError if the file cannot be written
std::unique_ptr<RaySink> make_ray_file(const std::filesystem::path& file, Field field);
/// Checks that make_ray_file() can create a file.
/// \throw InputError at `field` if the extension of the file name is unknown
/// \throw OutputError if the file cannot be written
void check_ray_file(const std::filesystem::path& file, Field field);

}  // namespace retrace::studies
