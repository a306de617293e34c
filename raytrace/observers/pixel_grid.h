#pragma once

// Pixels over the plane of the part, and the exact area that a polygon covers of each.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "geometry/polygon.h"

namespace retrace::raytrace {

/// Equal pixels over a rectangle of the part's plane: row 0 at the largest y, column 0 at the smallest x, as
/// they look from above the entrance face with +x to the right.
class PixelGrid {
 public:
  /// \pre bounds not empty, columns and rows > 0
  PixelGrid(const geometry::Rectangle& bounds_mm, std::size_t columns, std::size_t rows);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t size() const { return columns_ * rows_; }
  const geometry::Rectangle& bounds_mm() const { return bounds_mm_; }
  double pixel_area_mm2() const { return pixel_mm_.prod(); }
  geometry::Rectangle pixel_mm(std::size_t column, std::size_t row) const;

  /// The pixel that holds a point; nothing outside. The grid's right and lower borders belong to it.
  std::optional<std::size_t> pixel_at(const geometry::Vec2& point_mm) const;

  /// Calls `add(pixel, area_mm2)` for every pixel that a convex polygon covers, with the area of it that lies there:
  /// exact but for rounding, so that the areas add up to that of the polygon within the grid.
  void cover(const geometry::Polygon& polygon_mm, const std::function<void(std::size_t, double)>& add) const;

 private:
  geometry::Rectangle bounds_mm_;
  std::size_t columns_;
  std::size_t rows_;
  geometry::Vec2 pixel_mm_;
};

}  // namespace retrace::raytrace
