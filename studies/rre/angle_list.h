#pragma once

// Makes lists of angles for grids of directions.

#include <cstddef>
#include <vector>

namespace retrace::studies {

/// Minimum difference between two angles that are regarded as different.
inline constexpr double kSameAngleDeg = 1e-9;

/// Returns equidistant angles from 0 to `last`, both included.
/// \param count number of angles; >= 2
std::vector<double> equidistant(double last, std::size_t count);

/// Sorts angles and removes those that repeat an earlier angle within kSameAngleDeg.
void sort_and_remove_repeated(std::vector<double>& angles_deg);

}  // namespace retrace::studies
