#pragma once

#include <string>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/light/light_setup.h"
#include "tests/support/designs.h"

// Arrays that trap light, for tests of weak beams.

namespace retrace::testing {

/// Part and light of a test case, and its name in messages.
struct PartInLight {
  std::string name;
  geometry::Part part;
  raytrace::Illumination light;
};

/// Returns arrays that trap light, so that weak beams are important.
/// \param dihedral_error_arcmin dihedral errors of the finite array
inline std::vector<PartInLight> light_traps(double dihedral_error_arcmin = 0.0) {
  using namespace geometry;
  PartSpec finite_cubes = finite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 8.0, 8.0, 1.0);
  finite_cubes.angle_errors.dihedral_error_arcmin.fill(dihedral_error_arcmin);
  return {
      {"honeycomb", build_part(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0)), from(20, 10)},
      {"triangular", build_part(infinite(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0)), from(10, 10)},
      {"prisms", build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 1.0)), from(20, 25)},
      {"finite cubes", build_part(finite_cubes), from(15, 40)}};
}

}  // namespace retrace::testing
