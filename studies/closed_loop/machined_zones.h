#pragma once

// Parts of zones as programs leave them.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// By how much the facets of an element are turned open from what its job asks, in arc minutes; none: it is not cut.
using ElementTilts = std::optional<std::array<double, 3>>;

/// The zones of the job's design with whole elements alone, at the angles that the job asks for and tilted by the mean
/// over each zone's elements.
/// \param elements in the order of cut_elements() \param warnings is told what that leaves out
/// \throw InputError if the design is not beside the job or has no zones, or has no such element where the job cuts one
ZonedPart machined_zones(const fabrication::Job& job, const std::filesystem::path& job_file,
                         const std::vector<ElementTilts>& elements, std::vector<std::string>& warnings);

}  // namespace retrace::studies
