#pragma once

// Arrays of cube corners on a plate, on a sphere or at arbitrary positions. Each cube has a position, an axis and a
// clocking angle.

#include <array>
#include <optional>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Cube of an array. Its position is the point of the entrance face that is in front of the apex.
struct ArrayCube {
  geometry::Vec3 position_mm = geometry::Vec3::Zero();
  geometry::Vec3 axis = geometry::Vec3::UnitZ();  ///< unit vector that points out of the entrance face
  /// rotation of the cube about its axis from the orientation of array_from_cube()
  double clocking_deg = 0.0;
  /// Errors of the dihedral angles of this cube. If empty, the errors of the design apply.
  std::optional<std::array<double, 3>> dihedral_error_arcsec = {};
};

/// Returns the rotation from the part frame of a cube to the frame of the array. At clocking 0, the x axis of the cube
/// points along the meridian of the array, away from its +z axis. If the cube's axis is +z, the two frames are parallel
/// at clocking 0.
Eigen::Matrix3d array_from_cube(const ArrayCube& cube);

/// Ring of cubes on a sphere around the origin. The axes of the cubes point away from the centre of the sphere.
struct CubeRing {
  double radius_mm = 0.0;  ///< distance of the entrance faces from the centre of the sphere
  double latitude_deg = 0.0;
  int count = 1;
  double azimuth_deg = 0.0;  ///< azimuth of the first cube
  double clocking_deg = 0.0;
  double clocking_step_deg = 0.0;  ///< additional rotation from one cube to the next
};
std::vector<ArrayCube> cubes_of(const CubeRing& ring);

/// Rectangular grid of cubes on a plate. Its centre is on the z axis, and the axis of every cube is +z.
struct CubeGrid {
  int columns = 1;
  int rows = 1;
  double pitch_mm = 0.0;
  double height_mm = 0.0;  ///< height (z) of the entrance faces
  double clocking_deg = 0.0;
  double clocking_step_deg = 0.0;  ///< additional rotation from one cube to the next, counted row by row
};
std::vector<ArrayCube> cubes_of(const CubeGrid& grid);

}  // namespace retrace::studies
