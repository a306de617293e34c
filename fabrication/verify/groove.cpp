#include "fabrication/verify/groove.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace retrace::fabrication {

using geometry::Vec3;

Groove groove_of(const CutElement& element, const geometry::RtpElement& size) {
  const double half_apex = 0.5 * Angle::from_deg(size.apex_angle_deg).rad();
  const Vec3 across = element.turned ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  Groove groove;
  groove.half_base_mm = 0.5 * size.base_mm;
  groove.half_width_mm = 0.5 * size.width_mm;
  groove.facet_length_mm = groove.half_base_mm / std::sin(half_apex);
  groove.root_mm = {element.centre_mm.x(), element.centre_mm.y(), -groove.half_base_mm / std::tan(half_apex)};
  groove.root_direction = element.turned ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  for (std::size_t f = 0; f < 2; ++f) {
    const double side = f == 0 ? 1.0 : -1.0;  // facet 1 lies on the far side of the root and faces back
    DesignFacet& facet = groove.facets[f];
    facet.normal = -side * std::cos(half_apex) * across + std::sin(half_apex) * Vec3::UnitZ();
    facet.offset_mm = facet.normal.dot(groove.root_mm);
    facet.up_slope = side * std::sin(half_apex) * across + std::cos(half_apex) * Vec3::UnitZ();
  }
  return groove;
}

GrooveMap::GrooveMap(const std::vector<Groove>& grooves) : grooves_(grooves) {
  for (const Groove& groove : grooves)
    cell_mm_ = std::max({cell_mm_ == 1.0 ? 0.0 : cell_mm_, groove.half_base_mm, groove.half_width_mm});
  cells_.reserve(grooves.size());
  for (std::size_t i = 0; i < grooves.size(); ++i)
    cells_.emplace(cell_of(grooves[i].root_mm.x(), grooves[i].root_mm.y(), 0, 0), i);
}

GrooveMap::Cell GrooveMap::cell_of(double x_mm, double y_mm, int dx, int dy) const {
  constexpr double furthest = 1e9;  // keeps absurd positions of faulty programs within whole numbers
  const auto index = [&](double v) {
    return static_cast<Cell>(std::floor(std::clamp(v / cell_mm_, -furthest, furthest)));
  };
  return (index(x_mm) + dx) * (Cell{1} << 32) + index(y_mm) + dy;
}

std::optional<std::size_t> GrooveMap::at(double x_mm, double y_mm) const {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const auto [first, last] = cells_.equal_range(cell_of(x_mm, y_mm, dx, dy));
      for (auto entry = first; entry != last; ++entry) {
        const Groove& groove = grooves_[entry->second];
        const Vec3 from_root = Vec3(x_mm, y_mm, groove.root_mm.z()) - groove.root_mm;
        const double along = std::abs(groove.root_direction.dot(from_root));
        const double across = (from_root - groove.root_direction * groove.root_direction.dot(from_root)).norm();
        if (along <= groove.half_width_mm && across <= groove.half_base_mm) return entry->second;
      }
    }
  return std::nullopt;
}

}  // namespace retrace::fabrication
