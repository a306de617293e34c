#include "raytrace/observers/pixel_grid.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using geometry::Polygon, geometry::Rectangle, geometry::Vec2;

/// Returns the indices of the first and the last step that the interval from `low` to `high` overlaps. There are
/// `count` steps of equal length, and the first one starts at `from`.
std::pair<std::size_t, std::size_t> steps_over(double low, double high, double from, double step, std::size_t count) {
  const double last = static_cast<double>(count - 1);
  const double first_step = std::clamp(std::floor((low - from) / step), 0.0, last);
  const double last_step = std::clamp(std::floor((high - from) / step), 0.0, last);
  return {static_cast<std::size_t>(first_step), static_cast<std::size_t>(last_step)};
}

}  // namespace

PixelGrid::PixelGrid(const Rectangle& bounds_mm, std::size_t columns, std::size_t rows)
    : bounds_mm_(bounds_mm),
      columns_(columns),
      rows_(rows),
      pixel_mm_(bounds_mm.size().cwiseQuotient(Vec2(static_cast<double>(columns), static_cast<double>(rows)))) {}

Rectangle PixelGrid::pixel_mm(std::size_t column, std::size_t row) const {
  // Adjacent pixels compute their common border with the same expression, so that the values are identical.
  const auto x = [&](std::size_t k) { return bounds_mm_.lower.x() + pixel_mm_.x() * static_cast<double>(k); };
  const auto y = [&](std::size_t k) { return bounds_mm_.lower.y() + pixel_mm_.y() * static_cast<double>(rows_ - k); };
  return {{x(column), y(row + 1)}, {x(column + 1), y(row)}};
}

std::optional<std::size_t> PixelGrid::pixel_at(const Vec2& point_mm) const {
  const Vec2 at = point_mm - bounds_mm_.lower;
  const Vec2 size = bounds_mm_.size();
  if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() <= size.x() && at.y() <= size.y())) return std::nullopt;
  const auto column = std::min(static_cast<std::size_t>(at.x() / pixel_mm_.x()), columns_ - 1);
  const auto from_below = std::min(static_cast<std::size_t>(at.y() / pixel_mm_.y()), rows_ - 1);
  return (rows_ - 1 - from_below) * columns_ + column;
}

void PixelGrid::cover(const Polygon& polygon_mm, const std::function<void(std::size_t, double)>& add) const {
  if (polygon_mm.size() < 3) return;
  const Rectangle box = geometry::bounding_box(polygon_mm);
  const auto [below, above] = steps_over(box.lower.y(), box.upper.y(), bounds_mm_.lower.y(), pixel_mm_.y(), rows_);
  for (std::size_t from_below = below; from_below <= above; ++from_below) {
    const std::size_t row = rows_ - 1 - from_below;
    const Rectangle first = pixel_mm(0, row);
    const Rectangle line{first.lower, {bounds_mm_.upper.x(), first.upper.y()}};
    const Polygon strip = geometry::clip(polygon_mm, line, 0.0);
    if (strip.size() < 3) continue;
    const Rectangle strip_box = geometry::bounding_box(strip);
    const auto [left, right] =
        steps_over(strip_box.lower.x(), strip_box.upper.x(), bounds_mm_.lower.x(), pixel_mm_.x(), columns_);
    for (std::size_t column = left; column <= right; ++column) {
      const double area =
          left == right ? geometry::area(strip) : geometry::area(geometry::clip(strip, pixel_mm(column, row), 0.0));
      if (area > 0.0) add(row * columns_ + column, area);
    }
  }
}

}  // namespace retrace::raytrace
