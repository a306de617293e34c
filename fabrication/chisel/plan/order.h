#pragma once

// Determines the order in which the elements are cut in one pose, so that the moves between them are short.

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Key of a group of elements that are cut in the same poses: CutElement::rotated and CutElement::orientation.
using ElementGroup = std::pair<bool, std::int32_t>;

/// Returns the elements of each group in the order of cutting. The order runs back and forth along lines that are
/// parallel to machine X in the pose (columns of the array, or rows for rotated elements). Most moves are then one
/// pitch long and do not change the height.
std::map<ElementGroup, std::vector<std::int32_t>> cutting_orders(const std::vector<CutElement>& elements);

}  // namespace retrace::fabrication
