#pragma once

// Internal functions of the far field: Fourier transforms of polygons, and the power of fields. SIMD instructions
// process many directions at a time.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"
#include "raytrace/observers/polygon_transform.h"

namespace retrace::raytrace::field_lanes {

/// Number of directions per block. It is a multiple of the number of lanes of any instruction set.
inline constexpr std::size_t kBlock = 64;
using Block = std::array<double, kBlock>;

/// Complex values, one per direction.
struct ComplexBlock {
  Block re, im;
};

/// Polygon of a PolygonTransform, with its centroid, area and size.
struct Outline {
  explicit Outline(const PolygonTransform& transform);

  std::vector<geometry::Vec2> corners_mm;  ///< relative to the centroid
  geometry::Vec2 centroid_mm;
  double area_mm2 = 0.0;
  double size_mm = 0.0;  ///< maximum distance of a corner from the centroid
};

/// Computes PolygonTransform::at() for the wave vectors (kx, ky), in radians per mm.
void transform(const Outline& outline, const Block& kx, const Block& ky, ComplexBlock& result);

/// Contribution of a polygon to a field: the index of its transform and a Jones matrix. The matrix is stored row by
/// row, as real and imaginary parts.
struct Use {
  std::size_t outline = 0;
  std::array<double, 8> amplitude{};
};

/// Adds `copies` times the power of a field to `sum`.
/// \param coherency coherency matrix of the incident light: both diagonal elements, then the real and the imaginary
///        part of the upper off-diagonal element
void add_power(const std::vector<Use>& uses, const std::vector<ComplexBlock>& transforms,
               const std::array<double, 4>& coherency, double copies, Block& sum);

/// Interference fringes of scattered light. They arise if two paths, such as a path and its reverse, meet the same
/// points of a rough facet. Light of such a point leaves the entrance face at r on the first path. On the second path,
/// it leaves at partner_map * r + shift_mm (docs/theory/photometry.md).
struct Fringes {
  Outline outline;  ///< polygon that contains all points r
  Eigen::Matrix2d partner_map;
  geometry::Vec2 shift_mm;
  geometry::Vec2 first_cosines,
      second_cosines;                 ///< direction cosines of the specular light of the first and second path
  std::array<double, 2> coefficient;  ///< real and imaginary part of the amplitude of the fringes
  Eigen::Matrix2d spread_mm2;         ///< second moments of the covariance; a symmetric matrix
  /// Second moments of a Gaussian term; a symmetric matrix. Its subtraction removes the contribution of points r that
  /// nearly coincide with partner_map * r + shift_mm.
  Eigen::Matrix2d dip_mm2;
  double dip_area_mm2;  ///< area of the points r from which the term of `dip_mm2` is subtracted
};

/// Adds the power of the fringes to `sum`, per unit area of direction cosines.
/// \param wave_number in radians per mm
/// \param x, y direction cosines
void add_fringes(const Fringes& fringes, double wave_number, const Block& x, const Block& y, Block& sum);

}  // namespace retrace::raytrace::field_lanes
