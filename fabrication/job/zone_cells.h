#pragma once

// Jobs of zones: where their elements stand, and whether these have room.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// The elements of a job's zones, zone by zone as they are listed; rows and columns are those of each zone's own frame.
/// \pre job.zones are there, a mould
std::vector<CutElement> elements_of_zones(const Job& job);

/// What is wrong with an element of a zone.
struct ZoneMisfit {
  std::size_t zone = 0;
  std::string text;  ///< of a message, which begins with the element's place
};
/// The first element that reaches beyond the extent, or into another one; none if all have room.
std::optional<ZoneMisfit> misfit_of_zones(const Job& job);

}  // namespace retrace::fabrication
