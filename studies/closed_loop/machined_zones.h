#pragma once

// Computes the as-machined design of a part with zones.

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "fabrication/job/job.h"

namespace retrace::studies {

/// Deviations of the three facets of an element from the tilts in the job, in arcmin. A positive value opens the facet.
/// Empty if the element is not cut.
using ElementTilts = std::optional<std::array<double, 3>>;

/// Returns the zones of the design as machined, without partial elements. The facet angles of a zone are the angles in
/// the job plus the mean deviation of its elements.
/// \param elements deviations of each element, in the order of cut_elements()
/// \param warnings receives a warning about each deviation that the result does not represent
/// \throw InputError if the job's design does not exist or has no zones, or if the job cuts an element that the design
///        does not have
design::ZonedPart machined_zones(const fabrication::Job& job, const std::filesystem::path& job_file,
                                 const std::vector<ElementTilts>& elements, Warnings& warnings);

}  // namespace retrace::studies
