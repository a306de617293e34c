#pragma once

// The order in which a pose visits its elements, so that moves between them stay short.

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Elements that the same poses cut: CutElement::turned and CutElement::orientation.
using ElementGroup = std::pair<bool, std::int32_t>;

/// The elements of each group in the order in which a pose cuts them: to and fro along lines that lie on machine X
/// (columns of the array; of rotated elements rows), so that most moves are one pitch long and keep their height.
std::map<ElementGroup, std::vector<std::int32_t>> cutting_orders(const std::vector<CutElement>& elements);

}  // namespace retrace::fabrication
