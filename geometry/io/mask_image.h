#pragma once

// Reads a picture as a mask of an array: dark pixels are elements that are cut, light ones are left out.

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/elements/whole_elements.h"

namespace retrace::geometry {

/// Which cells of an array a picture says to cut, as Array::pattern: one pixel a cell, row 0 at the largest y. A pixel
/// is cut when its grey (0 black .. 255 white; of colours 0.299 R + 0.587 G + 0.114 B, rounded; on white where it is
/// transparent) is less than threshold * 255. Milliken 2017, section 2.4.
/// \param where names the mask in messages
/// \throw InputError for a file that cannot be read as a picture, a picture that has not one pixel for each cell, or
/// one that leaves nothing to cut
/// \throw OutputError if pictures cannot be read at all (picture_files())
std::vector<std::string> mask_pattern(const std::filesystem::path& file, double threshold, const CellCounts& cells,
                                      const InputLocation& where);

}  // namespace retrace::geometry
