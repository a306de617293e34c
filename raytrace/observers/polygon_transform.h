#pragma once

// Fourier transform of a polygonal aperture in closed form. The transform is the diffraction pattern of the aperture.

#include <complex>

#include "geometry/polygon.h"

namespace retrace::raytrace {

/// Fourier transform of a polygon: the integral of exp(-i kappa . r) over its area. The divergence theorem converts it
/// into a sum over the edges (Lee and Mittra, IEEE Trans. Antennas Propag. 31, 99 (1983)).
class PolygonTransform {
 public:
  /// \param polygon counter-clockwise, with at least three corners
  explicit PolygonTransform(const geometry::Polygon& polygon);

  /// Returns the transform in mm^2.
  /// \param kappa in radians per mm
  std::complex<double> at(const geometry::Vec2& kappa) const;

  double area_mm2() const { return area_mm2_; }
  double size_mm() const { return size_mm_; }
  const geometry::Vec2& centroid_mm() const { return centroid_mm_; }
  const geometry::Polygon& polygon() const { return corners_; }

 private:
  geometry::Polygon corners_;
  geometry::Vec2 centroid_mm_;
  double area_mm2_ = 0.0;
  double size_mm_ = 0.0;  ///< maximum distance of a corner from the centroid
};

}  // namespace retrace::raytrace
