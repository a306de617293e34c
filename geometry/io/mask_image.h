#pragma once

// Reads a picture as a mask. Dark pixels select the elements of an array that are cut, or that belong to a zone.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/elements/whole_elements.h"

namespace retrace::geometry {

/// Reads a picture and marks its dark pixels. Returns one string per row of pixels, in which `#` marks a dark pixel.
/// The first string is the row with the largest y. A pixel is dark if its grey value is less than threshold * 255. The
/// grey value is 0 (black) to 255 (white): 0.299 R + 0.587 G + 0.114 B, rounded, on a white background (Milliken 2017,
/// section 2.4).
/// \param cells required numbers of columns and rows; each pixel is a cell of the array, as in ArrayLayout::pattern. If
///     there is no value, the picture may have any size up to 4e7 pixels
/// \param where location of the mask's file name, for messages
/// \throw InputError if the file is not a readable picture, has another size, or has no dark pixels
/// \throw OutputError if this build cannot read pictures (picture_files())
std::vector<std::string> mask_pattern(const std::filesystem::path& file, double threshold,
                                      const std::optional<CellCounts>& cells, const InputLocation& where);

}  // namespace retrace::geometry
