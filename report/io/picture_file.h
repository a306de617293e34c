#pragma once

// Pictures of results as files: linear values as OpenEXR, displayed colours as PNG.

#include <cstddef>
#include <string>
#include <vector>

#include "core/pictures.h"

namespace retrace::report {

/// The picture as an OpenEXR file; the same picture gives the same bytes. \throw OutputError if it cannot be made
std::string exr_file(const FloatPicture& picture);

/// Eight-bit sRGB pixels, three bytes each, as a PNG file. \throw as exr_file()
std::string png_file(std::size_t columns, std::size_t rows, const std::vector<unsigned char>& rgb);

}  // namespace retrace::report
