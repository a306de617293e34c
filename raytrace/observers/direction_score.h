#pragma once

// Sums over the directions in which light leaves: intensity towards receivers, power by bins of angle.

#include <cstddef>
#include <optional>
#include <vector>

#include "raytrace/observers/aperture_kernel.h"
#include "raytrace/observers/return_frame.h"

namespace retrace::raytrace {

/// Directions around the one back to the source, divided into bins: rows and columns of a square, or rings of equal
/// width divided into sectors. Angles are those of ReturnFrame.
class DirectionGrid {
 public:
  enum class Layout { square, polar };
  /// \param half_width_rad of the square, or radius of the disc; > 0
  /// \param rows rings of the disc \param columns sectors, from "right" towards "up"
  DirectionGrid(Layout layout, double half_width_rad, std::size_t rows, std::size_t columns)
      : layout_(layout), half_width_rad_(half_width_rad), rows_(rows), columns_(columns) {}

  std::size_t size() const { return rows_ * columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  double half_width_rad() const { return half_width_rad_; }
  /// Nothing outside.
  std::optional<std::size_t> bin_of(const geometry::Vec2& angles_rad) const;
  geometry::Vec2 middle_rad(std::size_t bin) const;
  double solid_angle_sr(std::size_t bin) const;

 private:
  Layout layout_;
  double half_width_rad_;
  std::size_t rows_;
  std::size_t columns_;
};

/// What is asked of the directions in which light leaves the entrance face: the intensity that receivers see, and how
/// much power goes into the bins of a grid. Tracers keep the sums, one vector for each Tally.
struct DirectionScore {
  ReturnFrame frame;
  ApertureKernel kernel;
  std::vector<geometry::Vec3> receivers;  ///< their directions
  std::optional<DirectionGrid> grid;

  /// How many sums: one a receiver (intensity per steradian), one a bin (power), and at the end the power outside.
  std::size_t size() const { return receivers.size() + (grid ? grid->size() + 1 : 0); }

  void add(const geometry::Vec3& direction, double power, std::vector<double>& sums) const;
};

}  // namespace retrace::raytrace
