#pragma once

// Computes the elements of a job with zones, and checks that they do not overlap.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Returns the elements of all zones, zone by zone. Rows and columns are counted for each zone, along the directions of
/// its rotated elements.
/// \pre the job has zones and is a mould
std::vector<CutElement> elements_of_zones(const Job& job);

/// Error about an element of a zone at a wrong position.
struct ZoneError {
  std::size_t zone = 0;  ///< index of the zone
  std::string text;      ///< error message, which begins with the position of the element
};
/// Returns the first element that is not completely inside the array's extent or overlaps another element. Returns
/// nothing if all elements are placed correctly.
std::optional<ZoneError> first_zone_error(const Job& job);

}  // namespace retrace::fabrication
