#include "raytrace/sampling/lit_region.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace retrace::raytrace {
namespace {

// Approximate number of chords that replace the border of the region. For lenses, the true border is curved.
constexpr double kBorderChords = 256.0;
constexpr int kMaxNewtonSteps = 50;
// Accuracy of the corners of the region, and step of difference quotients, relative to the size of the part.
constexpr double kCornerAccuracy = 1e-12, kDifferenceStep = 1e-5;

/// Path of the light of a beam from a plane in front of the shells to the plane of the entrance face.
class BeamPath {
 public:
  BeamPath(const Shells& shells, const Vec3& to_source, double from_mm, double to_mm, double size_mm)
      : shells_(shells), direction_(-to_source), from_mm_(from_mm), to_mm_(to_mm), size_mm_(size_mm) {}

  /// Returns the point at which light reaches the plane of the face, or nothing if it does not pass the shells.
  std::optional<Vec2> end_of(const Vec2& start) const {
    ShellRay ray{Vec3(start.x(), start.y(), from_mm_), direction_, {}};
    ShellLosses losses;
    if (!pass_shells(shells_, ShellPassage::to_part, ray, losses) || !(ray.direction.z() < 0.0)) return std::nullopt;
    return on_plane(ray.position_mm, ray.direction, to_mm_);
  }

  /// Returns the point from which light would reach the point `end` if there were no shells.
  Vec2 straight_start_of(const Vec2& end) const {
    return on_plane(Vec3(end.x(), end.y(), to_mm_), direction_, from_mm_);
  }

  /// Returns the point from which light reaches the point `end` of the face, by Newton's method. If no such point is
  /// found, returns straight_start_of().
  Vec2 start_of(const Vec2& end) const {
    Vec2 start = straight_start_of(end);
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
      const std::optional<Vec2> reached = end_of(start);
      if (!reached) break;
      const Vec2 error = end - *reached;
      if (error.norm() <= kCornerAccuracy * size_mm_) return start;
      const std::optional<Eigen::Matrix2d> slope = slope_at(start, *reached);
      if (!slope || slope->determinant() == 0.0) break;
      start += slope->inverse() * error;
    }
    return straight_start_of(end);
  }

 private:
  static Vec2 on_plane(const Vec3& from, const Vec3& direction, double height_mm) {
    return from.head<2>() + (height_mm - from.z()) / direction.z() * direction.head<2>();
  }

  /// Returns the derivative of the end point with respect to the start point, from difference quotients.
  std::optional<Eigen::Matrix2d> slope_at(const Vec2& start, const Vec2& end) const {
    const double step_mm = kDifferenceStep * size_mm_;
    Eigen::Matrix2d slope;
    for (const Eigen::Index axis : {0, 1}) {
      const std::optional<Vec2> there = end_of(start + step_mm * Vec2::Unit(axis));
      if (!there) return std::nullopt;
      slope.col(axis) = (*there - end) / step_mm;
    }
    return slope;
  }

  const Shells& shells_;
  Vec3 direction_;
  double from_mm_;
  double to_mm_;
  double size_mm_;
};

/// Returns points on the border of a polygon, including its corners. Their spacing is about 1 / kBorderChords of the
/// length of the border.
geometry::Polygon with_points_on_sides(const geometry::Polygon& polygon) {
  double border_mm = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) border_mm += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
  geometry::Polygon points;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 side = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double parts = std::max(1.0, std::ceil(kBorderChords * side.norm() / border_mm));
    for (double part = 0.0; part < parts; part += 1.0) points.emplace_back(polygon[k] + part / parts * side);
  }
  return points;
}

/// Returns the triangles between a centre and the sides of a polygon. Triangles without area, or with the reverse
/// orientation, are omitted.
std::vector<TriangleSampler::Triangle> fan_of(const Vec2& centre, const geometry::Polygon& polygon) {
  std::vector<TriangleSampler::Triangle> triangles;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const TriangleSampler::Triangle triangle = {centre, polygon[k], polygon[(k + 1) % polygon.size()]};
    if (geometry::area({triangle[0], triangle[1], triangle[2]}) > 0.0) triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace

LitRegion::LitRegion(const Shells& shells, const Vec3& to_source, const geometry::Polygon& outline,
                     double face_height_mm)
    : height_mm_(shells.front().outer.vertex_mm.z()) {
  const double size_mm = geometry::bounding_box(outline).size().maxCoeff();
  const BeamPath path(shells, to_source, height_mm_, face_height_mm, size_mm);
  const geometry::Polygon face = with_points_on_sides(outline);
  const Vec2 middle = geometry::centroid(outline);
  geometry::Polygon border;
  for (const Vec2& point : face) border.push_back(path.start_of(point));
  if (geometry::area(border) < 0.0) std::reverse(border.begin(), border.end());
  std::vector<TriangleSampler::Triangle> triangles = fan_of(path.start_of(middle), border);
  if (triangles.empty()) {  // the shells focus all light into a point or a line of the entrance face
    border.clear();
    for (const Vec2& point : face) border.push_back(path.straight_start_of(point));
    triangles = fan_of(path.straight_start_of(middle), border);
  }
  double area_mm2 = 0.0;
  for (const auto& [a, b, c] : triangles) area_mm2 += geometry::area({a, b, c});
  area_ratio_ = area_mm2 / geometry::area(outline);
  triangles_ = TriangleSampler(std::move(triangles), area_mm2);
}

}  // namespace retrace::raytrace
