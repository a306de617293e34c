#include "studies/ranging/cube_array.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/angle.h"

namespace retrace::studies {

using geometry::Vec3;

Eigen::Matrix3d array_from_cube(const ArrayCube& cube) {
  const double across = cube.axis.head<2>().norm();
  const double azimuth = across > 0.0 ? std::atan2(cube.axis.y(), cube.axis.x()) : 0.0;
  const double polar = std::atan2(across, cube.axis.z());
  return (Eigen::AngleAxisd(azimuth, Vec3::UnitZ()) * Eigen::AngleAxisd(polar, Vec3::UnitY()) *
          Eigen::AngleAxisd(cube.clocking_deg * kRadPerDeg, Vec3::UnitZ()))
      .toRotationMatrix();
}

std::vector<ArrayCube> cubes_of(const CubeRing& ring) {
  std::vector<ArrayCube> cubes;
  const double latitude = ring.latitude_deg * kRadPerDeg;
  for (int k = 0; k < ring.count; ++k) {
    const double azimuth = ring.azimuth_deg * kRadPerDeg + kTwoPi * k / ring.count;
    ArrayCube cube;
    cube.axis =
        Vec3(std::cos(latitude) * std::cos(azimuth), std::cos(latitude) * std::sin(azimuth), std::sin(latitude));
    cube.position_mm = ring.radius_mm * cube.axis;
    cube.clocking_deg = ring.clocking_deg + k * ring.clocking_step_deg;
    cubes.push_back(cube);
  }
  return cubes;
}

std::vector<ArrayCube> cubes_of(const CubeGrid& grid) {
  std::vector<ArrayCube> cubes;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      ArrayCube cube;
      cube.position_mm = Vec3((column - 0.5 * (grid.columns - 1)) * grid.pitch_mm,
                              (row - 0.5 * (grid.rows - 1)) * grid.pitch_mm, grid.height_mm);
      cube.clocking_deg = grid.clocking_deg + (row * grid.columns + column) * grid.clocking_step_deg;
      cubes.push_back(cube);
    }
  return cubes;
}

}  // namespace retrace::studies
