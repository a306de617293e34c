#pragma once

// Finds scratches and ridges in a measured surface: straight lines whose depth or height exceeds the roughness.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Straight line on a surface that is below (scratch) or above (ridge) the surface next to it.
struct Scratch {
  Axis along = Axis::x;  ///< direction of the line
  /// position of its deepest grid line, measured across its direction from the first row or column
  double position_um = 0.0;
  double depth_nm = 0.0;  ///< mean depth of this grid line below the neighbouring surface; negative for a ridge
  double width_um = 0.0;  ///< width over which the depth is more than half of depth_nm
};

/// Returns the grid lines along `along` that are scratches or ridges, in order of position. The height of a line is
/// compared with the medians of the neighbouring lines on both sides. Two conditions must hold. The mean difference
/// must exceed five robust standard deviations (1.4826 times the median absolute deviation) of all lines. In addition,
/// the line is divided into sixteen sections: in at least three quarters of them, the difference must be at least half
/// of the mean difference.
/// Regular feed marks increase the standard deviation and are therefore not reported as scratches. They appear as peaks
/// of the spectrum.
/// \param roughness a map without form and waviness; a profile has no lines
/// \param neighbourhood_um range of neighbouring lines on each side. Wider scratches are not detected. Longer waves
///        have no effect.
std::vector<Scratch> find_scratches(const HeightMap& roughness, Axis along, double neighbourhood_um);

}  // namespace retrace::surface_models
