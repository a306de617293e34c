#pragma once

// Elements of the zones of a job, and the check that they do not overlap.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Returns the elements of all zones, in the order of the job. Rows and columns are counted in the frame of each zone.
/// \pre the job has zones and is a mould
std::vector<CutElement> elements_of_zones(const Job& job);

/// A misplaced element of a zone.
struct ZoneMisfit {
  std::size_t zone = 0;
  std::string text;  ///< error message, which begins with the position of the element
};
/// Returns the first element that is not inside the extent of the array or overlaps another element.
std::optional<ZoneMisfit> misfit_of_zones(const Job& job);

}  // namespace retrace::fabrication
