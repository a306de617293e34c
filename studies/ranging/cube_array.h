#pragma once

// Arrays of cube corners. Each cube has a position, an axis and a clocking angle. Cubes may be placed on a plate, on a
// sphere or anywhere.

#include <array>
#include <optional>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Cube of an array. The reference point of a cube is the point of its entrance face in front of its apex.
struct ArrayCube {
  geometry::Vec3 position_mm = geometry::Vec3::Zero();
  geometry::Vec3 axis = geometry::Vec3::UnitZ();  ///< unit vector out of the entrance face
  double clocking_deg = 0.0;                      ///< rotation of the cube about its axis
  /// Errors of the dihedral angles of this cube. Empty: the errors of the design apply.
  std::optional<std::array<double, 3>> dihedral_error_arcsec = {};
};

/// Returns the rotation from the part frame of a cube to the frame of the array. With zero clocking, the x axis of the
/// cube points along a meridian, away from the +z axis of the array. If the axis of the cube is +z, both frames are
/// parallel at the clocking 0.
Eigen::Matrix3d array_from_cube(const ArrayCube& cube);

/// Ring of cubes on a sphere around the origin. The axes of the cubes point away from the origin.
struct CubeRing {
  double radius_mm = 0.0;  ///< distance of the entrance faces from the origin
  double latitude_deg = 0.0;
  int count = 1;
  double azimuth_deg = 0.0;  ///< azimuth of the first cube
  double clocking_deg = 0.0;
  double clocking_step_deg = 0.0;  ///< additional clocking from one cube to the next
};
std::vector<ArrayCube> cubes_of(const CubeRing& ring);

/// Rectangular grid of cubes on a plate. The grid is centred at the origin, and the axes of all cubes are +z.
struct CubeGrid {
  int columns = 1;
  int rows = 1;
  double pitch_mm = 0.0;
  double height_mm = 0.0;  ///< height of the entrance faces
  double clocking_deg = 0.0;
  double clocking_step_deg = 0.0;  ///< additional clocking from one cube to the next, row by row
};
std::vector<ArrayCube> cubes_of(const CubeGrid& grid);

}  // namespace retrace::studies
