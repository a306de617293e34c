#pragma once

// Reads pictures that are shown behind the part.

#include <filesystem>

#include "core/field.h"
#include "studies/image/background.h"

namespace retrace::studies {

/// Reads a background. Files whose names end in .exr contain luminances, in the channels R, G and B or Y. Other files
/// contain sRGB values.
/// \param field field of the request that names the file, for messages
/// \throw InputError if the file cannot be read or is too large
Background read_background(const std::filesystem::path& file, Field field);

}  // namespace retrace::studies
