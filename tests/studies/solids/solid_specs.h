#pragma once

#include <cmath>
#include <numbers>

#include "tests/support/part_specs.h"

namespace retrace::test {

inline geometry::PartSpec single_part(const geometry::Element& element) {
  return testing::single(element, 0.7);
}

inline geometry::PartSpec array_part(const geometry::Element& element, geometry::Arrangement arrangement, double x_mm,
                                     double y_mm) {
  return testing::finite(element, arrangement, x_mm, y_mm, 0.7);
}

/// Below z = 0, in closed form: a prism of base b and width w holds b^2 w / 4.
inline double prism_volume_mm3(double base_mm, double width_mm) {
  return 0.25 * base_mm * base_mm * width_mm;
}

/// A full cube corner of edge a leaves a^3 below the plane of its highest rims: its three squares' mean depth is
/// a / sqrt(3) over the hexagon's sqrt(3) a^2. The circle round the hexagon has the diameter 2 a sqrt(2/3).
inline double hexagonal_volume_mm3(double aperture_mm) {
  return std::pow(aperture_mm / (2.0 * std::sqrt(2.0 / 3.0)), 3.0);
}

/// A tetrahedron cut off a cube: a^3 / 6, with the side a sqrt(2) and the circle's diameter 2 a sqrt(2/3).
inline double triangular_volume_mm3(double aperture_mm) {
  return hexagonal_volume_mm3(aperture_mm) / 6.0;
}

/// Of the apertures: regular polygons in a circle.
inline double hexagon_area_mm2(double aperture_mm) {
  return 6.0 * std::sqrt(3.0) / 4.0 * std::pow(0.5 * aperture_mm, 2.0);
}
inline double triangle_area_mm2(double aperture_mm) {
  return 3.0 * std::sqrt(3.0) / 4.0 * std::pow(0.5 * aperture_mm, 2.0);
}

}  // namespace retrace::test
