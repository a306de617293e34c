#include "raytrace/sampling/entrance_sampler.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

// An outline is treated as an axis-aligned rectangle if its area is at least this fraction of the area of its bounding
// box.
constexpr double kAllOfBox = 1.0 - 1e-12;

}  // namespace

EntranceSampler::EntranceSampler(const geometry::Part& part) {
  if (part.period_mm) {
    is_rectangle_ = true;
    size_ = *part.period_mm;
    centre_mm_ = 0.5 * size_;
    lower_ = -0.5 * size_;
    return;
  }
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  centre_mm_ = box.centre();
  lower_ = box.lower - centre_mm_;
  size_ = box.size();
  double whole = 0.0;
  for (const geometry::Polygon& piece : geometry::entrance_polygons(part)) {
    const geometry::Polygon face = geometry::moved(piece, -centre_mm_);
    whole += geometry::area(face);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) triangles_.push_back({face[0], face[k], face[k + 1]});
  }
  is_rectangle_ = whole >= kAllOfBox * size_.prod();
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles_) {
    sum += geometry::area({a, b, c});
    cumulative_fraction_.push_back(sum / whole);
  }
  cumulative_fraction_.back() = 1.0;
}

Vec2 EntranceSampler::operator()(const std::array<double, 2>& u) const {
  if (is_rectangle_) return lower_ + size_.cwiseProduct(Vec2(u[0], u[1]));
  const auto it = std::upper_bound(cumulative_fraction_.begin(), cumulative_fraction_.end() - 1, u[0]);
  const auto k = static_cast<std::size_t>(it - cumulative_fraction_.begin());
  const double before = k == 0 ? 0.0 : cumulative_fraction_[k - 1];
  const double within = (u[0] - before) / (cumulative_fraction_[k] - before);
  // The square root makes the distribution over the triangle uniform.
  const double away = std::sqrt(std::clamp(within, 0.0, 1.0));
  const auto& [a, b, c] = triangles_[k];
  const Vec2 far_side = b + u[1] * (c - b);
  return a + away * (far_side - a);
}

}  // namespace retrace::raytrace
