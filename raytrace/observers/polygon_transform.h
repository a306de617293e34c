#pragma once

// Fourier transform of a polygonal aperture in closed form: its diffraction pattern.

#include <complex>
#include <vector>

#include "geometry/polygon.h"

namespace retrace::raytrace {

/// The Fourier transform of a polygon, integral of exp(-i kappa . r) over its area, in closed form: the divergence
/// theorem makes it a sum over the edges (Lee and Mittra, IEEE Trans. Antennas Propag. 31, 99 (1983)).
class PolygonTransform {
 public:
  /// \param polygon counter-clockwise, any number of corners from 3 on
  explicit PolygonTransform(const geometry::Polygon& polygon);

  /// \param kappa in radians per mm \return in mm^2
  std::complex<double> at(const geometry::Vec2& kappa) const;

  double area_mm2() const { return area_mm2_; }
  double size_mm() const { return size_mm_; }
  const geometry::Vec2& centroid_mm() const { return centroid_mm_; }
  const geometry::Polygon& polygon() const { return corners_; }

 private:
  geometry::Polygon corners_;
  geometry::Vec2 centroid_mm_;
  double area_mm2_ = 0.0;
  double size_mm_ = 0.0;  ///< greatest distance of a corner from the centroid
};

}  // namespace retrace::raytrace
