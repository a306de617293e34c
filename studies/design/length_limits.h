#pragma once

// Upper limits of lengths, used by several studies.

namespace retrace::studies {

/// Maximum coordinate, distance and diameter, in mm, of lamps, eyes and ray sources. At larger distances, double
/// precision is too coarse for rays to hit the part, and the squares of coordinates overflow in Embree.
inline constexpr double kFarthestMm = 1e9;

}  // namespace retrace::studies
