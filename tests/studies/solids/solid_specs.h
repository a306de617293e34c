#pragma once

#include <cmath>

#include "tests/support/part_specs.h"

namespace retrace::test {

inline geometry::PartSpec single_part(const geometry::Element& element) {
  return testing::single(element, 0.7);
}

inline geometry::PartSpec array_part(const geometry::Element& element, geometry::Arrangement arrangement, double x_mm,
                                     double y_mm) {
  return testing::finite(element, arrangement, x_mm, y_mm, 0.7);
}

/// Returns the volume of a prism below z = 0 in closed form: b^2 w / 4 for the base b and the width w.
inline double prism_volume_mm3(double base_mm, double width_mm) {
  return 0.25 * base_mm * base_mm * width_mm;
}

/// Returns the volume of a full cube corner below the plane of its highest rims: a^3 for the edge a. This is the mean
/// depth of its three square facets, a / sqrt(3), times the area of the hexagon, sqrt(3) a^2. The circumscribed circle
/// of the hexagon has the diameter 2 a sqrt(2/3).
inline double hexagonal_volume_mm3(double aperture_mm) {
  return std::pow(aperture_mm / (2.0 * std::sqrt(2.0 / 3.0)), 3.0);
}

/// Returns the volume of a triangular cube corner: a^3 / 6 for the edge a. It is the tetrahedron that a plane cuts off
/// a cube. Its base has the side a sqrt(2) and a circumscribed circle with the diameter 2 a sqrt(2/3).
inline double triangular_volume_mm3(double aperture_mm) {
  return hexagonal_volume_mm3(aperture_mm) / 6.0;
}

/// Returns the area of a regular hexagon whose circumscribed circle has the diameter `aperture_mm`.
inline double hexagon_area_mm2(double aperture_mm) {
  return 6.0 * std::sqrt(3.0) / 4.0 * std::pow(0.5 * aperture_mm, 2.0);
}
inline double triangle_area_mm2(double aperture_mm) {
  return 3.0 * std::sqrt(3.0) / 4.0 * std::pow(0.5 * aperture_mm, 2.0);
}

}  // namespace retrace::test
