#pragma once

// Internal to the far field: transforms of polygons, and what fields made of them carry, in SIMD lanes over directions.

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace::field_lanes {

/// Directions at a time: a whole number of lanes of any instruction set.
inline constexpr std::size_t kBlock = 64;
using Block = std::array<double, kBlock>;

/// One number of each direction, complex.
struct ComplexBlock {
  Block re, im;
};

/// A polygon, as PolygonTransform has it.
struct Outline {
  std::vector<geometry::Vec2> corners_mm;  ///< relative to the centroid
  geometry::Vec2 centroid_mm;
  double area_mm2 = 0.0;
  double size_mm = 0.0;  ///< greatest distance of a corner from the centroid
};

/// As PolygonTransform::at(), at wave vectors (kx, ky), in radians per mm.
void transform(const Outline& outline, const Block& kx, const Block& ky, ComplexBlock& result);

/// A transform with the Jones matrix by which it enters a field: real and imaginary parts, row by row.
struct Use {
  std::size_t outline = 0;
  std::array<double, 8> amplitude{};
};

/// Adds `copies` times the power of a field. \param coherency of the light that comes in: both diagonal elements, then
/// real and imaginary part of the upper one beside them
void add_power(const std::vector<Use>& uses, const std::vector<ComplexBlock>& transforms,
               const std::array<double, 4>& coherency, double copies, Block& sum);

}  // namespace retrace::raytrace::field_lanes
