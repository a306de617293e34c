#pragma once

// Measured heights on a regular grid, areal or as a profile. They are the input of all surface metrology.

#include <cstddef>
#include <limits>
#include <vector>

namespace retrace::surface_models {

/// Height of a point that was not measured.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Axis { x, y };

/// Heights on a regular grid. A map with one row is a profile along x.
struct HeightMap {
  std::size_t columns = 0;  ///< points along x
  std::size_t rows = 0;     ///< points along y
  double x_pixel_um = 0.0;  ///< distance between neighbours along x, > 0
  double y_pixel_um = 0.0;  ///< distance between neighbours along y, > 0
  /// Heights row by row, positive out of the material. NaN where nothing was measured.
  std::vector<double> heights_nm;

  double& at(std::size_t column, std::size_t row) { return heights_nm[row * columns + column]; }
  double at(std::size_t column, std::size_t row) const { return heights_nm[row * columns + column]; }
  bool is_profile() const { return rows == 1; }
  /// Returns the number of axes along which the map extends: 1 for a profile, otherwise 2.
  int dimensions() const { return is_profile() ? 1 : 2; }
};

/// Returns the number of points that have a height.
std::size_t measured_points(const HeightMap& map);

/// Returns the map rotated by 90 degrees. The direction +y becomes +x, and +x becomes -y.
HeightMap rotated_by_90_degrees(const HeightMap& map);

/// Returns the map without a margin of `x_um` at both ends of its rows and of `y_um` at both ends of its columns. The
/// margins are rounded up to points. A profile keeps its row.
/// \pre the result is not empty
HeightMap cropped(const HeightMap& map, double x_um, double y_um);

}  // namespace retrace::surface_models
