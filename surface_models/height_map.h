#pragma once

// Measured heights on a regular grid, areal or as a profile: what all of surface metrology here works on.

#include <cstddef>
#include <limits>
#include <vector>

namespace retrace::surface_models {

/// The height of a place that was not measured.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Axis { x, y };

/// Heights on a regular grid. A map of one row is a profile along x.
struct HeightMap {
  std::size_t columns = 0;  ///< points along x
  std::size_t rows = 0;     ///< points along y
  double x_pixel_um = 0.0;  ///< distance of neighbours along x, > 0
  double y_pixel_um = 0.0;  ///< and along y, > 0
  /// Row by row, positive out of the material; NaN where nothing was measured.
  std::vector<double> heights_nm;

  double& at(std::size_t column, std::size_t row) { return heights_nm[row * columns + column]; }
  double at(std::size_t column, std::size_t row) const { return heights_nm[row * columns + column]; }
  bool is_profile() const { return rows == 1; }
  /// Along how many axes it extends: 1 for a profile, else 2.
  int dimensions() const { return is_profile() ? 1 : 2; }
};

/// How many points have a height.
std::size_t measured_points(const HeightMap& map);

/// The map turned by a quarter: what lay along y lies along x, what lay along x lies along -y.
HeightMap turned_by_quarter(const HeightMap& map);

/// The map without `x_um` at both ends of its rows and `y_um` at both ends of its columns (rounded up to points; a
/// profile keeps its row). \pre something is left
HeightMap cropped(const HeightMap& map, double x_um, double y_um);

}  // namespace retrace::surface_models
