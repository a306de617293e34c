#include "studies/inspect/wall_thickness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/centroid.h"

namespace retrace::studies {
namespace {

using geometry::Part, geometry::Vec2, geometry::Vec3;
using Corners = std::vector<Vec3>;

// Number of facets and of triangles of an entrance mesh whose distance is computed exactly. They are those with the
// smallest estimates of the distance.
constexpr std::size_t kMaxCandidates = 96;
// Number of points along each side of a facet at which the search begins.
constexpr int kStartPoints = 6;
constexpr int kMaxProjections = 2000;
// Relative change of the distance at which alternating projections end.
constexpr double kSameDistance = 1e-14;
constexpr int kFootSteps = 30;

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? Vec3(a + std::clamp((p - a).dot(along) / length2, 0.0, 1.0) * along) : a;
}

/// Returns the point of a plane convex polygon that is nearest to a point.
Vec3 nearest_on_polygon(const Vec3& p, const Corners& polygon, const Vec3& normal) {
  const Vec3 foot = p - (p - polygon.front()).dot(normal) * normal;
  bool is_inside = true;
  Vec3 nearest = polygon.front();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& a = polygon[k];
    const Vec3& b = polygon[(k + 1) % polygon.size()];
    is_inside = is_inside && normal.cross(b - a).dot(foot - a) >= 0.0;
    const Vec3 at = nearest_on_segment(p, a, b);
    if ((at - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = at;
  }
  return is_inside ? foot : nearest;
}

/// Returns the point of a convex outline that is nearest to a point in plan.
Vec2 within_outline(const Vec2& p, const geometry::Polygon& outline) {
  if (geometry::contains(outline, p)) return p;
  Corners corners;
  for (const Vec2& corner : outline) corners.emplace_back(corner.x(), corner.y(), 0.0);
  return nearest_on_polygon({p.x(), p.y(), 0.0}, corners, Vec3::UnitZ()).head<2>();
}

/// Facet of the back in the part frame.
struct BackFacet {
  Corners corners;
  Vec3 normal = Vec3::UnitZ();
};

BackFacet facet_of(const Part& part, const geometry::Placement& placement, const geometry::PatchFacet& facet) {
  const geometry::SurfacePatch& patch = part.patches[placement.patch];
  const Vec3 move(placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm);
  BackFacet found{{}, facet.normal};
  for (std::uint32_t k = 0; k < facet.corner_count; ++k)
    found.corners.push_back(patch.vertices[patch.corners[facet.first_corner + k]] + move);
  return found;
}

/// Calls `visit` for each facet of the back that is not a side.
template <class Visit>
void for_each_facet(const Part& part, const Visit& visit) {
  for (const geometry::Placement& placement : part.placements)
    for (const geometry::PatchFacet& facet : part.patches[placement.patch].facets)
      if (facet.role != geometry::FacetRole::side) visit(placement, facet);
}

/// The items with the smallest estimates.
template <class Item>
class Candidates {
 public:
  void add(double estimate, const Item& item) {
    if (items_.size() == kMaxCandidates && estimate >= items_.front().first) return;
    items_.emplace_back(estimate, item);
    std::push_heap(items_.begin(), items_.end(), is_less);
    if (items_.size() <= kMaxCandidates) return;
    std::pop_heap(items_.begin(), items_.end(), is_less);
    items_.pop_back();
  }
  const std::vector<std::pair<double, Item>>& all() const { return items_; }

 private:
  static bool is_less(const std::pair<double, Item>& a, const std::pair<double, Item>& b) { return a.first < b.first; }

  std::vector<std::pair<double, Item>> items_;
};

using FacetOfPart = std::pair<const geometry::Placement*, const geometry::PatchFacet*>;

/// Returns the facets with the smallest estimates of their distance from the entrance face.
/// \param estimate function of a point of the back
template <class Estimate>
Candidates<FacetOfPart> nearest_facets(const Part& part, const Estimate& estimate) {
  Candidates<FacetOfPart> candidates;
  for_each_facet(part, [&](const geometry::Placement& placement, const geometry::PatchFacet& facet) {
    const BackFacet made = facet_of(part, placement, facet);
    double least = estimate(geometry::centroid(std::span<const Vec3>(made.corners)));
    for (const Vec3& p : made.corners) least = std::min(least, estimate(p));
    candidates.add(least, {&placement, &facet});
  });
  return candidates;
}

/// Moves a pair of points towards the smallest distance by projecting each point onto the other face in turn. For two
/// convex sets, this converges to their distance (Cheney and Goldstein, Proc. Am. Math. Soc. 10, 448, 1959).
template <class ToBack, class ToEntrance>
WallThickness alternating_projections(Vec3 back, const ToBack& to_back, const ToEntrance& to_entrance) {
  WallThickness wall;
  double last_mm = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMaxProjections; ++step) {
    const Vec3 entrance = to_entrance(back);
    back = to_back(entrance);
    wall = {(entrance - back).norm(), back, entrance};
    if (last_mm - wall.thickness_mm <= kSameDistance * wall.thickness_mm) break;
    last_mm = wall.thickness_mm;
  }
  return wall;
}

/// Finds the foot of a point on an exact entrance surface by Gauss-Newton steps.
class SurfaceFoot {
 public:
  SurfaceFoot(const geometry::EntranceSurface& surface, const geometry::Polygon& outline)
      : surface_(surface), outline_(outline) {}

  Vec3 operator()(const Vec3& p) const {
    Vec2 at = within_outline(p.head<2>(), outline_);
    for (int step = 0; step < kFootSteps; ++step) {
      const auto sample = surface_.at(at);
      const Vec2 gradient = (at - p.head<2>()) + (sample.height_mm - p.z()) * sample.slope;
      // The inverse of I + s s^T is I - s s^T / (1 + s^2).
      const Vec2 newton = gradient - sample.slope.dot(gradient) / (1.0 + sample.slope.squaredNorm()) * sample.slope;
      const Vec2 next = within_outline(at - newton, outline_);
      const double moved_mm = (next - at).norm();
      at = next;
      if (moved_mm <= kSameDistance * (1.0 + at.norm())) break;
    }
    return {at.x(), at.y(), surface_.at(at).height_mm};
  }

  /// Returns an estimate of the distance of a point from the surface.
  double estimate(const Vec3& p) const {
    const auto sample = surface_.at(within_outline(p.head<2>(), outline_));
    return (sample.height_mm - p.z()) / std::sqrt(1.0 + sample.slope.squaredNorm());
  }

 private:
  const geometry::EntranceSurface& surface_;
  const geometry::Polygon& outline_;
};

/// Returns the point of a facet at which an estimate of the distance is smallest, from points on a grid.
Vec3 best_start(const BackFacet& facet, const SurfaceFoot& foot) {
  Vec3 best = facet.corners.front();
  double least = foot.estimate(best);
  for (std::size_t k = 1; k + 1 < facet.corners.size(); ++k)
    for (int i = 0; i <= kStartPoints; ++i)
      for (int j = 0; i + j <= kStartPoints; ++j) {
        const double u = static_cast<double>(i) / kStartPoints;
        const double v = static_cast<double>(j) / kStartPoints;
        const Vec3 p = (1.0 - u - v) * facet.corners[0] + u * facet.corners[k] + v * facet.corners[k + 1];
        const double estimate = foot.estimate(p);
        if (estimate >= least) continue;
        least = estimate;
        best = p;
      }
  return best;
}

WallThickness wall_under_surface(const Part& part, const geometry::EntranceSurface& surface) {
  const SurfaceFoot foot(surface, part.outline);
  const auto candidates = nearest_facets(part, [&](const Vec3& p) { return foot.estimate(p); });
  WallThickness least;
  least.thickness_mm = std::numeric_limits<double>::infinity();
  for (const auto& [estimate, item] : candidates.all()) {
    const BackFacet facet = facet_of(part, *item.first, *item.second);
    const WallThickness wall = alternating_projections(
        best_start(facet, foot), [&](const Vec3& p) { return nearest_on_polygon(p, facet.corners, facet.normal); },
        foot);
    if (wall.thickness_mm < least.thickness_mm) least = wall;
  }
  return least;
}

WallThickness wall_under_mesh(const Part& part, const geometry::SurfacePatch& mesh) {
  const geometry::Entrance entrance = std::make_shared<const geometry::SurfacePatch>(mesh);
  const auto candidates = nearest_facets(part, [&](const Vec3& p) {
    return geometry::height_mm(entrance, within_outline(p.head<2>(), part.outline)) - p.z();
  });
  WallThickness least;
  least.thickness_mm = std::numeric_limits<double>::infinity();
  for (const auto& [estimate, item] : candidates.all()) {
    const BackFacet facet = facet_of(part, *item.first, *item.second);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Corners triangle;
      for (const std::uint32_t v : mesh.triangles[t]) triangle.push_back(mesh.vertices[v]);
      const Vec3& normal = mesh.facets[mesh.triangle_facet[t]].normal;
      const auto to_triangle = [&](const Vec3& p) { return nearest_on_polygon(p, triangle, normal); };
      // A triangle is skipped if it is farther away than the smallest wall found so far.
      const Vec3 middle = geometry::centroid(std::span<const Vec3>(facet.corners));
      double radius_mm = 0.0;
      for (const Vec3& p : facet.corners) radius_mm = std::max(radius_mm, (p - middle).norm());
      if ((to_triangle(middle) - middle).norm() - radius_mm > least.thickness_mm) continue;
      const WallThickness wall = alternating_projections(
          middle, [&](const Vec3& p) { return nearest_on_polygon(p, facet.corners, facet.normal); }, to_triangle);
      if (wall.thickness_mm < least.thickness_mm) least = wall;
    }
  }
  return least;
}

/// Returns the wall under a plane entrance face, which is the vertical distance of the highest point of the back.
WallThickness wall_under_plane(const Part& part) {
  Vec3 highest(0.0, 0.0, -std::numeric_limits<double>::infinity());
  for_each_facet(part, [&](const geometry::Placement& placement, const geometry::PatchFacet& facet) {
    for (const Vec3& p : facet_of(part, placement, facet).corners)
      if (p.z() > highest.z()) highest = p;
  });
  return {part.thickness_mm - highest.z(), highest, {highest.x(), highest.y(), part.thickness_mm}};
}

}  // namespace

WallThickness smallest_wall(const Part& part, const std::optional<geometry::Entrance>& entrance) {
  if (!entrance) return wall_under_plane(part);
  if (const auto* const surface = std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&*entrance))
    return wall_under_surface(part, **surface);
  return wall_under_mesh(part, *std::get<1>(*entrance));
}

}  // namespace retrace::studies
