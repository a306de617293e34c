#pragma once

// Pixels in the plane of the part, and the exact area of each pixel that a polygon covers.

#include <cstddef>
#include <functional>
#include <optional>

#include "geometry/polygon.h"

namespace retrace::raytrace {

/// Equal pixels of a rectangle in the plane of the part. Row 0 has the largest y, and column 0 the smallest x. This is
/// the view from above the entrance face with +x to the right.
class PixelGrid {
 public:
  /// \pre the bounds are not empty, columns and rows are > 0
  PixelGrid(const geometry::Rectangle& bounds_mm, std::size_t columns, std::size_t rows);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t size() const { return columns_ * rows_; }
  const geometry::Rectangle& bounds_mm() const { return bounds_mm_; }
  double pixel_area_mm2() const { return pixel_mm_.prod(); }
  geometry::Rectangle pixel_mm(std::size_t column, std::size_t row) const;

  /// Returns the pixel that contains a point, or nothing if the point is outside of the grid. All borders belong to the
  /// grid.
  std::optional<std::size_t> pixel_at(const geometry::Vec2& point_mm) const;

  /// Calls `add(pixel, area_mm2)` for every pixel that a convex polygon covers, with the covered area. The areas are
  /// exact except for rounding. They add up to the area of the polygon inside the grid.
  void cover(const geometry::Polygon& polygon_mm, const std::function<void(std::size_t, double)>& add) const;

 private:
  geometry::Rectangle bounds_mm_;
  std::size_t columns_;
  std::size_t rows_;
  geometry::Vec2 pixel_mm_;
};

}  // namespace retrace::raytrace
