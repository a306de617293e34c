#pragma once

// Internal to the far field: Fourier transforms of polygons and power of fields, for many directions at a time with
// SIMD.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"
#include "raytrace/observers/polygon_transform.h"

namespace retrace::raytrace::field_lanes {

/// Directions at a time: a whole number of lanes of any instruction set.
inline constexpr std::size_t kBlock = 64;
using Block = std::array<double, kBlock>;

/// One number of each direction, complex.
struct ComplexBlock {
  Block re, im;
};

/// Corners and size of the polygon of a PolygonTransform.
struct Outline {
  explicit Outline(const PolygonTransform& transform);

  std::vector<geometry::Vec2> corners_mm;  ///< relative to the centroid
  geometry::Vec2 centroid_mm;
  double area_mm2 = 0.0;
  double size_mm = 0.0;  ///< maximum distance of a corner from the centroid
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

/// Interference fringes of scattered light. They arise if two paths, such as a path and its reverse, meet the same
/// points of a rough facet. Light of such a point leaves the entrance face at r after one path, and at turn r + shift
/// after the other (docs/theory/photometry.md).
struct Fringes {
  Outline outline;  ///< all positions r
  Eigen::Matrix2d turn;
  geometry::Vec2 shift_mm;
  geometry::Vec2 cosines_here, cosines_there;  ///< direction cosines of the specular light of the two paths
  std::array<double, 2> coefficient;           ///< real and imaginary part of the fringe amplitude
  Eigen::Matrix2d spread_mm2;                  ///< second moments of the covariance; symmetric
  Eigen::Matrix2d dip_mm2;   ///< second moments of the term that is subtracted where both points coincide; symmetric
  double dip_mm2_of_places;  ///< area of the points from which that term is subtracted
};

/// Adds the power of the fringes per unit area of direction cosines to `sum`.
/// \param wave_number in radians per mm
/// \param x, y direction cosines
void add_fringes(const Fringes& fringes, double wave_number, const Block& x, const Block& y, Block& sum);

}  // namespace retrace::raytrace::field_lanes
