#pragma once

// Sums over the directions in which light leaves: the intensity towards receivers, and the power in bins of angles.

#include <cstddef>
#include <optional>
#include <vector>

#include "raytrace/light/aperture_kernel.h"
#include "raytrace/light/return_frame.h"

namespace retrace::raytrace {

/// Bins of directions around the direction to the source: rows and columns of a square, or rings of equal width divided
/// into sectors. The angles are those of ReturnFrame.
class DirectionGrid {
 public:
  enum class Layout { square, polar };
  /// \param half_width_rad half width of the square, or radius of the disc; > 0
  /// \param rows rows of the square, or rings of the disc
  /// \param columns columns of the square, or sectors of the disc, counted from ReturnFrame::right towards
  ///        ReturnFrame::up
  DirectionGrid(Layout layout, double half_width_rad, std::size_t rows, std::size_t columns)
      : layout_(layout), half_width_rad_(half_width_rad), rows_(rows), columns_(columns) {}

  std::size_t size() const { return rows_ * columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  double half_width_rad() const { return half_width_rad_; }
  /// Returns the bin that contains a direction, or nothing outside of the grid.
  std::optional<std::size_t> bin_of(const geometry::Vec2& angles_rad) const;
  geometry::Vec2 centre_rad(std::size_t bin) const;
  double solid_angle_sr(std::size_t bin) const;

 private:
  Layout layout_;
  double half_width_rad_;
  std::size_t rows_;
  std::size_t columns_;
};

/// Sums over the light that leaves the entrance face: the intensity towards receivers, and the power in the bins of a
/// grid. Tracers keep one vector of sums per Tally.
struct DirectionScore {
  ReturnFrame frame;
  ApertureKernel kernel;
  std::vector<geometry::Vec3> receivers;  ///< unit vectors to the receivers
  std::optional<DirectionGrid> grid;

  /// Returns the number of sums: one intensity per steradian for each receiver, one power for each bin, and the power
  /// outside of the grid.
  std::size_t size() const { return receivers.size() + (grid ? grid->size() + 1 : 0); }

  void add(const geometry::Vec3& direction, double power, std::vector<double>& sums) const;
};

}  // namespace retrace::raytrace
