#pragma once

// Writes pictures of results as files: linear values as OpenEXR, displayed colours as PNG.

#include <cstddef>
#include <string>
#include <vector>

#include "core/pictures.h"

namespace retrace::report {

/// Returns the content of an OpenEXR file. Equal pictures give equal bytes.
/// \throw OutputError if the file cannot be created
std::string exr_file(const FloatPicture& picture);

/// Returns the content of a PNG file with 8-bit sRGB pixels, three bytes each. Throws like exr_file().
std::string png_file(std::size_t columns, std::size_t rows, const std::vector<unsigned char>& rgb);

}  // namespace retrace::report
