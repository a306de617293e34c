#pragma once

// Reads a picture as a mask. Its dark pixels determine which elements of an array are cut, or which belong to a zone.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/elements/whole_elements.h"

namespace retrace::geometry {

/// Which pixels of a picture are dark, `#` in a text for each row, that of largest y first. A pixel is dark when its
/// grey (0 black .. 255 white; of colours 0.299 R + 0.587 G + 0.114 B, rounded; on white where it is transparent) is
/// less than threshold * 255. Milliken 2017, section 2.4.
/// \param cells required numbers of columns and rows, one pixel per cell of the array, as Array::pattern; none: any
/// size up to 4e7 pixels \param where position of the mask's name, for messages \throw InputError for a file that
/// cannot be read as a picture, a picture of another size, or one without dark pixels \throw OutputError if pictures
/// cannot be read at all (picture_files())
std::vector<std::string> mask_pattern(const std::filesystem::path& file, double threshold,
                                      const std::optional<CellCounts>& cells, const InputLocation& where);

}  // namespace retrace::geometry
