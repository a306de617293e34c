#include "raytrace/sampling/triangle_sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/polygon.h"

namespace retrace::raytrace {

using geometry::Vec2;

TriangleSampler::TriangleSampler(std::vector<Triangle> triangles, double area_mm2) : triangles_(std::move(triangles)) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles_) {
    sum += geometry::area({a, b, c});
    cumulative_fraction_.push_back(sum / area_mm2);
  }
  cumulative_fraction_.back() = 1.0;
}

Vec2 TriangleSampler::operator()(const std::array<double, 2>& u) const {
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
