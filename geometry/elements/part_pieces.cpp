#include "geometry/elements/part_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace retrace::geometry {

AngleErrors errors_of(const PartSpec& spec, std::int64_t i, std::int64_t j, std::uint32_t number) {
  constexpr std::uint32_t kTiltStream = 3;
  const auto words = philox({spec.random_tilts.seed, kTiltStream}, static_cast<std::uint32_t>(i),
                            static_cast<std::uint32_t>(j), number);
  // Box and Muller; the shift keeps 0 out of the logarithm.
  const auto radius = [&](std::size_t k) { return std::sqrt(-2.0 * std::log(unit_interval(words[k]) + 0x1p-33)); };
  const auto angle = [&](std::size_t k) { return 2.0 * std::numbers::pi * unit_interval(words[k]); };
  const std::array<double, 3> normal = {radius(0) * std::cos(angle(1)), radius(0) * std::sin(angle(1)),
                                        radius(2) * std::cos(angle(3))};
  AngleErrors errors = spec.angle_errors;
  for (std::size_t k = 0; k < 3; ++k) errors.facet_tilt_arcmin[k] += spec.random_tilts.sigma_arcmin * normal[k];
  return errors;
}

IndexRange indices_over(const Lattice& lattice, const Rectangle& extent, const Vec2& anchor) {
  Rectangle reach = bounding_box(lattice.cells.front().outline);
  for (const Cell& cell : lattice.cells) {
    const Rectangle box = bounding_box(cell.outline);
    reach.lower = reach.lower.cwiseMin(box.lower);
    reach.upper = reach.upper.cwiseMax(box.upper);
  }
  IndexRange range;
  for (const Eigen::Index axis : {0, 1}) {
    const auto k = static_cast<std::size_t>(axis);
    const double period = lattice.period_mm[axis];
    const double low = (extent.lower[axis] - anchor[axis] - reach.upper[axis]) / period;
    const double high = (extent.upper[axis] - anchor[axis] - reach.lower[axis]) / period;
    range.lower[k] = static_cast<std::int64_t>(std::floor(low));
    range.upper[k] = static_cast<std::int64_t>(std::ceil(high)) + 1;
  }
  return range;
}

std::array<Rectangle, 4> margins(const Rectangle& extent, const Rectangle& block) {
  return {Rectangle{extent.lower, {block.lower.x(), extent.upper.y()}},
          Rectangle{{block.upper.x(), extent.lower.y()}, extent.upper},
          Rectangle{{block.lower.x(), extent.lower.y()}, {block.upper.x(), block.lower.y()}},
          Rectangle{{block.lower.x(), block.upper.y()}, {block.upper.x(), extent.upper.y()}}};
}

Polygon moved(const Polygon& polygon, const Vec2& by) {
  Polygon result = polygon;
  for (Vec2& p : result) p += by;
  return result;
}

Vec2 middle_of(const Polygon& outline) {
  const Rectangle box = bounding_box(outline);
  return 0.5 * (box.lower + box.upper);
}

}  // namespace retrace::geometry
