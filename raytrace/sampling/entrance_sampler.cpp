#include "raytrace/sampling/entrance_sampler.h"

#include <utility>

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
  std::vector<TriangleSampler::Triangle> triangles;
  for (const geometry::Polygon& piece : geometry::entrance_polygons(part)) {
    const geometry::Polygon face = geometry::moved(piece, -centre_mm_);
    whole += geometry::area(face);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) triangles.push_back({face[0], face[k], face[k + 1]});
  }
  is_rectangle_ = whole >= kAllOfBox * size_.prod();
  triangles_ = TriangleSampler(std::move(triangles), whole);
}

Vec2 EntranceSampler::operator()(const std::array<double, 2>& u) const {
  if (is_rectangle_) return lower_ + size_.cwiseProduct(Vec2(u[0], u[1]));
  return triangles_(u);
}

}  // namespace retrace::raytrace
