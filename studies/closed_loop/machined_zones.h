#pragma once

// Computes the as-machined design of a part of zones.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Tilts of the three facets of an element relative to the job, in minutes of arc, positive if the facet opens; none:
/// the element is not cut.
using ElementTilts = std::optional<std::array<double, 3>>;

/// Returns the zones of the job's design without partial elements. The facets have the angles given in the job plus the
/// mean tilts over the elements of each zone.
/// \param elements tilts of the elements, in the order of cut_elements()
/// \param warnings receives a warning about each difference that the result does not contain
/// \throw InputError if the design named by the job does not exist or has no zones, or if the job cuts an element that
/// the design does not have
ZonedPart machined_zones(const fabrication::Job& job, const std::filesystem::path& job_file,
                         const std::vector<ElementTilts>& elements, std::vector<std::string>& warnings);

}  // namespace retrace::studies
