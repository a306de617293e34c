#include "geometry/surface/patch_surface.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace retrace::geometry {
namespace {

double distance_to_side(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from;
  const double length2 = along.squaredNorm();
  const double fraction = length2 > 0.0 ? std::clamp(along.dot(point - from) / length2, 0.0, 1.0) : 0.0;
  return (point - from - fraction * along).norm();
}

/// Returns true if a point is inside polygons, which may have holes, or near their sides.
bool is_within(const FaceBorder& border, const Vec2& point, double tolerance_mm) {
  bool inside = false;
  for (const std::vector<Vec2>& loop : border)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec2& a = loop[k];
      const Vec2& b = loop[(k + 1) % loop.size()];
      if (distance_to_side(point, a, b) <= tolerance_mm) return true;
      if ((a.y() > point.y()) == (b.y() > point.y())) continue;
      const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > point.x()) inside = !inside;
    }
  return inside;
}

}  // namespace

const HeightPatch* PatchTree::patch_at(const Vec2& point_mm) const {
  const PatchNode* node = nodes.data();
  while (node->axis >= 0) node = &nodes[point_mm[node->axis] < node->split_mm ? node->first : node->second];
  if (node->first == PatchNode::kNone) return nullptr;
  const HeightPatch& patch = patches[node->first];
  // Points outside of the root's rectangle are also found by the search.
  constexpr double kRoom = 1.0 + 1e-9;
  const bool is_inside = ((point_mm - patch.centre_mm).cwiseAbs().array() <= kRoom * patch.half_mm.array()).all();
  return is_inside ? &patch : nullptr;
}

PatchSurface::PatchSurface(std::vector<PatchTree> faces, std::vector<FaceBorder> borders)
    : faces_(std::move(faces)), borders_(std::move(borders)) {
  if (faces_.size() > 1) make_slabs();
  std::size_t points = 0;
  for (const FaceBorder& border : borders_)
    for (const std::vector<Vec2>& loop : border) points += loop.size();
  constexpr std::size_t kMaxPoints = 1024;
  const std::size_t stride = points / kMaxPoints + 1;
  for (const FaceBorder& border : borders_)
    for (const std::vector<Vec2>& loop : border)
      for (std::size_t k = 0; k < loop.size(); k += stride) {
        const Vec2& next = loop[(k + stride) % loop.size()];
        // Sides of the border are divided, so that the surface continues nearly perpendicular to them.
        constexpr int kPartsOfSide = 8;
        const int parts = points < kMaxPoints / kPartsOfSide ? kPartsOfSide : 1;
        for (int i = 0; i < parts; ++i)
          coarse_border_.push_back(loop[k] + (static_cast<double>(i) / parts) * (next - loop[k]));
      }
}

PatchSurface::TangentBeyond PatchSurface::tangent_beyond(const Vec2& point_mm) const {
  const auto nearest = std::min_element(
      coarse_border_.begin(), coarse_border_.end(),
      [&](const Vec2& a, const Vec2& b) { return (a - point_mm).squaredNorm() < (b - point_mm).squaredNorm(); });
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (nearest == coarse_border_.end()) return {point_mm, none, Vec2::Constant(none)};
  const HeightPatch* const patch = faces_[face_at(*nearest)].patch_at(*nearest);
  if (patch == nullptr) return {point_mm, none, Vec2::Constant(none)};
  const jets::Gradient z =
      patch->evaluate(jets::Gradient(nearest->x(), 1.0, 0.0), jets::Gradient(nearest->y(), 0.0, 1.0));
  return {*nearest, z.value, {z.x, z.y}};
}

void PatchSurface::make_slabs() {
  struct Side {
    Vec2 lower;
    Vec2 upper;
    int face;
  };
  std::vector<Side> sides;
  for (std::size_t face = 0; face < borders_.size(); ++face)
    for (const std::vector<Vec2>& loop : borders_[face])
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2& a = loop[k];
        const Vec2& b = loop[(k + 1) % loop.size()];
        slab_y_mm_.push_back(a.y());
        // A side that runs downwards has its face on the left, which is the side of greater x.
        if (a.y() > b.y()) sides.push_back({b, a, static_cast<int>(face)});
        if (a.y() < b.y()) sides.push_back({a, b, -1});
      }
  std::sort(slab_y_mm_.begin(), slab_y_mm_.end());
  slab_y_mm_.erase(std::unique(slab_y_mm_.begin(), slab_y_mm_.end()), slab_y_mm_.end());
  slabs_.assign(slab_y_mm_.empty() ? 0 : slab_y_mm_.size() - 1, {});
  for (const Side& side : sides) {
    const auto x_at = [&](double y) {
      const double fraction = (y - side.lower.y()) / (side.upper.y() - side.lower.y());
      return (1.0 - fraction) * side.lower.x() + fraction * side.upper.x();
    };
    const auto first = std::lower_bound(slab_y_mm_.begin(), slab_y_mm_.end(), side.lower.y());
    for (auto y = first; y + 1 != slab_y_mm_.end() && *y < side.upper.y(); ++y)
      slabs_[static_cast<std::size_t>(y - slab_y_mm_.begin())].push_back({x_at(*y), x_at(*(y + 1)), side.face});
  }
  for (std::vector<SideInSlab>& slab : slabs_)
    // If two sides have the same position, the side with a face on its right must be the second one.
    std::sort(slab.begin(), slab.end(), [](const SideInSlab& a, const SideInSlab& b) {
      const double difference = (a.lower_x_mm + a.upper_x_mm) - (b.lower_x_mm + b.upper_x_mm);
      return difference != 0.0 ? difference < 0.0 : a.face < b.face;
    });
}

std::size_t PatchSurface::face_at(const Vec2& point_mm) const {
  if (slabs_.empty()) return 0;
  const auto above = std::upper_bound(slab_y_mm_.begin() + 1, slab_y_mm_.end() - 1, point_mm.y());
  const auto k = static_cast<std::size_t>(above - slab_y_mm_.begin()) - 1;
  const double fraction = std::clamp((point_mm.y() - slab_y_mm_[k]) / (slab_y_mm_[k + 1] - slab_y_mm_[k]), 0.0, 1.0);
  const std::vector<SideInSlab>& slab = slabs_[k];
  const auto x_of = [&](const SideInSlab& side) {
    return (1.0 - fraction) * side.lower_x_mm + fraction * side.upper_x_mm;
  };
  const auto right = std::partition_point(slab.begin(), slab.end(),
                                          [&](const SideInSlab& side) { return x_of(side) <= point_mm.x(); });
  // In a gap, the nearer of the faces on both sides is used.
  const auto left_face = std::find_if(std::make_reverse_iterator(right), slab.rend(),
                                      [](const SideInSlab& side) { return side.face >= 0; });
  if (right != slab.begin() && (right - 1)->face >= 0) return static_cast<std::size_t>((right - 1)->face);
  const auto right_face = std::find_if(right, slab.end(), [](const SideInSlab& side) { return side.face >= 0; });
  if (left_face == slab.rend()) return right_face == slab.end() ? 0 : static_cast<std::size_t>(right_face->face);
  if (right_face == slab.end()) return static_cast<std::size_t>(left_face->face);
  const double to_left = point_mm.x() - x_of(*(right - 1));
  return static_cast<std::size_t>(to_left <= x_of(*right_face) - point_mm.x() ? left_face->face : right_face->face);
}

bool PatchSurface::covers(const Vec2& point_mm, double tolerance_mm) const {
  return std::any_of(borders_.begin(), borders_.end(),
                     [&](const FaceBorder& border) { return is_within(border, point_mm, tolerance_mm); });
}

std::size_t PatchSurface::patch_count() const {
  std::size_t count = 0;
  for (const PatchTree& face : faces_) count += face.patches.size();
  return count;
}

}  // namespace retrace::geometry
