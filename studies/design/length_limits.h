#pragma once

// Upper limits of lengths that several studies use.

namespace retrace::studies {

/// Maximum coordinate, distance and diameter, in mm, of lamps, eyes and ray sources. At larger distances, double
/// precision is too coarse for rays to meet the part, and squares of coordinates overflow in Embree.
inline constexpr double kFarthestMm = 1e9;

}  // namespace retrace::studies
