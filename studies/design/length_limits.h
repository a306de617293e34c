#pragma once

// Largest lengths that requests of several studies have in common.

namespace retrace::studies {

/// Largest coordinate, distance and diameter, in mm, of lamps, eyes and ray sources. At larger distances, rays have too
/// few digits to meet the part, and squares of coordinates overflow in Embree.
inline constexpr double kFarthestMm = 1e9;

}  // namespace retrace::studies
