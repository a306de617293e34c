#pragma once

#include <cstdint>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// The elements of one orientation in the order in which a pose cuts them: to and fro along lines that lie on machine X
/// (columns of the array; of turned elements rows), so that most moves are one pitch long and keep their height.
std::vector<std::int32_t> cutting_order(const std::vector<CutElement>& elements, bool turned);

}  // namespace retrace::fabrication
