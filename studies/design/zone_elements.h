#pragma once

// Which elements of an array are which zone's, where zones are no regions but rows, columns or masks of elements.

#include <functional>
#include <string>
#include <vector>

#include "studies/design/design.h"

namespace retrace::studies {

/// How many rows (axis 1) or columns (axis 0) of elements an array has. A row is what has its middle at one height.
std::size_t count_of_lines(const geometry::ArrayPlan& plan, Eigen::Index axis);

/// Gives each zone its cells. \pre `part.elements` has one for each zone, `part.spec` all but the cells
/// \param dark what is dark in the mask of a zone (geometry::mask_pattern()); of a zone without one not asked
void choose_cells(ZonedPart& part, const std::function<std::vector<std::string>(std::size_t zone)>& dark);

/// \param where the location of a key of the design
/// \throw InputError for zones that do not cover the part (geometry::fault_of_zones())
void check_zones(const ZonedPart& part, const std::function<InputLocation(const std::string& key)>& where);

/// The zones of a design, with the cells of masks. \pre design.zoned()
/// \throw InputError for a mask that cannot be read, and elements that are of no zone or of two
geometry::ZonedSpec zones_of(const Design& design);

}  // namespace retrace::studies
