#pragma once

// Finds scratches and ridges in a measured surface: straight lines that stand out of its roughness.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// A straight line on a surface that lies below (a scratch) or above (a ridge) what is beside it.
struct Scratch {
  Axis along = Axis::x;      ///< where it runs to
  double position_um = 0.0;  ///< of its deepest line, across its direction, from the first row or column
  double depth_nm = 0.0;     ///< mean depth of that line below those beside it; negative for a ridge
  double width_um = 0.0;     ///< over which it stays beyond half of that depth
};

/// Lines along `along` whose mean height lies off that of the lines beside it (the medians of both sides) by more than
/// five robust standard deviations of all lines (1.4826 times the median deviation), and by half as much as its mean or
/// more in at least three quarters of sixteen stretches of its length. In order of position. Regular marks of the feed
/// raise that deviation and are no scratches: they are peaks of the spectrum. \param roughness a map without form and
/// waviness; a profile has no lines \param beside_um how far the lines beside it reach to each side: wider scratches
/// are not seen, longer waves do not matter
std::vector<Scratch> find_scratches(const HeightMap& roughness, Axis along, double beside_um);

}  // namespace retrace::surface_models
