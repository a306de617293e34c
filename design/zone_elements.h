#pragma once

// Assigns the elements of an array to zones, if the zones are given as rows, columns or masks of elements instead of
// regions.

#include <functional>
#include <string>
#include <vector>

#include "design/design.h"

namespace retrace::design {

/// Returns the number of rows (axis 1) or columns (axis 0) of an array. A row contains all elements whose centres have
/// the same y.
std::size_t row_or_column_count(const geometry::ArrayPlan& plan, Eigen::Index axis);

/// Assigns the cells of the array to the zones.
/// \pre `part.elements` has an entry for each zone, and `part.spec` is complete except for the cells
/// \param dark function that returns the mask of a zone (geometry::mask_pattern()); it is called only for zones with a
///        mask
void choose_cells(ZonedPart& part, const std::function<std::vector<std::string>(std::size_t zone)>& dark);

/// Checks the zones of a part.
/// \param where function that returns the position of a key of the design
/// \throw InputError if the zones do not cover the part correctly (geometry::fault_of_zones())
void check_zones(const ZonedPart& part, const std::function<InputLocation(const std::string& key)>& where);

/// Returns the zones of a design, including the cells of masks.
/// \pre design.zoned()
/// \throw InputError for an invalid mask, and if an element belongs to no zone or to two zones
geometry::ZonedSpec zones_of(const Design& design);

}  // namespace retrace::design
