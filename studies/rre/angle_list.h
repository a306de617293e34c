#pragma once

// Lists of angles for grids of directions.

#include <cstddef>
#include <vector>

namespace retrace::studies {

/// Angles that differ by less are equal.
inline constexpr double kSameAngleDeg = 1e-9;

/// Returns equidistant angles from 0 to `last`.
/// \param count number of angles; >= 2
std::vector<double> equidistant(double last, std::size_t count);

/// Sorts angles and removes repeated ones, see kSameAngleDeg.
void sort_and_remove_repeated(std::vector<double>& angles_deg);

}  // namespace retrace::studies
