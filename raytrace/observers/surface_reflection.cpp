#include "raytrace/observers/surface_reflection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytrace/faces/tangent_plane.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {
namespace {

using geometry::EntranceSurface, geometry::Polygon, geometry::Rectangle;

// Minimum and maximum number of successive divisions of the bounding box into quarters.
constexpr int kMinDivisions = 5, kMaxDivisions = 16;
// A rectangle is divided until the directions in which it reflects light differ by less than this fraction of the
// kernel's radius.
constexpr double kFineness = 0.15;
// Safety factor for the range of directions in a rectangle, which is computed from a few sample points.
constexpr double kRangeMargin = 1.5;
// Corners are merged if their distance is less than this fraction of the size of the outline.
constexpr double kMergedCorner = 1e-12;

/// Adds up the reflected light by dividing the outline into rectangles.
class ReflectedSum {
 public:
  ReflectedSum(const EntranceSurface& surface, Polygon lit, const Vec3& to_source, const Vec3& receiver,
               const ApertureKernel& kernel, const std::function<double(const Vec3&)>& reflectance)
      : surface_(surface),
        lit_(std::move(lit)),
        to_source_(to_source),
        receiver_(receiver),
        kernel_(kernel),
        reflectance_(reflectance),
        merge_mm_(kMergedCorner * geometry::bounding_box(lit_).size().norm()) {}

  double sum() const { return sum_; }

  void add(const Rectangle& box, int depth) {
    const Vec3 middle = direction_at(box.centre());
    if (!middle.allFinite()) return;
    double range = 0.0;
    for (const double u : {0.0, 0.5, 1.0})
      for (const double v : {0.0, 0.5, 1.0}) {
        const Vec3 direction = direction_at(box.lower + Vec2(u, v).cwiseProduct(box.size()));
        if (direction.allFinite()) range = std::max(range, kRangeMargin * (direction - middle).norm());
      }
    const double reach = kernel_.reach_rad();
    if (depth >= kMinDivisions && (middle - receiver_).norm() > range + 1.01 * reach) return;
    if ((depth >= kMinDivisions && range < kFineness * reach) || depth >= kMaxDivisions) return add_light(box, middle);
    const Vec2 half = 0.5 * box.size();
    for (const double u : {0.0, 1.0})
      for (const double v : {0.0, 1.0}) {
        const Vec2 lower = box.lower + Vec2(u, v).cwiseProduct(half);
        add({lower, lower + half}, depth + 1);
      }
  }

 private:
  Vec3 normal_at(const Vec2& at) const {
    const Vec2 slope = surface_.at(at).slope;
    return Vec3(-slope.x(), -slope.y(), 1.0).normalized();
  }
  Vec3 direction_at(const Vec2& at) const { return mirrored(-to_source_, normal_at(at)); }

  void add_light(const Rectangle& box, const Vec3& direction) {
    const Vec3 normal = normal_at(box.centre());
    const double cosine = normal.dot(to_source_);
    if (!(cosine > 0.0)) return;
    const double chord = std::min(2.0, (direction - receiver_).norm());
    const double density = kernel_.per_sr(2.0 * std::asin(0.5 * chord));
    if (density == 0.0) return;
    const Polygon own = geometry::clip(lit_, box, merge_mm_);
    if (own.size() < 3) return;
    sum_ += geometry::area(own) * cosine / normal.z() * reflectance_(normal) * density;
  }

  const EntranceSurface& surface_;
  Polygon lit_;
  const Vec3& to_source_;
  const Vec3& receiver_;
  const ApertureKernel& kernel_;
  const std::function<double(const Vec3&)>& reflectance_;
  double merge_mm_;
  double sum_ = 0.0;
};

/// Returns the portion of the outline, in plan, in which the incident beam meets the surface. Only the corners of the
/// beam are projected onto the surface. The edges between them are approximated by straight lines in plan.
Polygon lit_outline(const EntranceSurface& surface, const Polygon& outline, const geometry::TouchingPlane& beam_plane,
                    const Vec3& to_source) {
  Polygon shifted;
  for (const Vec2& corner : outline) {
    const double depth_mm = beam_plane.at(corner) - surface.at(corner).height_mm;
    const double path_mm = std::isfinite(depth_mm) ? depth_mm / rise_above(beam_plane, to_source) : 0.0;
    shifted.push_back(corner - path_mm * to_source.head<2>());
  }
  return geometry::clip(outline, shifted, kMergedCorner * geometry::bounding_box(outline).size().norm());
}

}  // namespace

double reflected_per_sr(const EntranceSurface& surface, const Polygon& outline,
                        const geometry::TouchingPlane& beam_plane, const Vec3& to_source, const Vec3& receiver,
                        const ApertureKernel& kernel, const std::function<double(const Vec3& normal)>& reflectance) {
  Polygon lit = lit_outline(surface, outline, beam_plane, to_source);
  if (lit.size() < 3) return 0.0;
  const Rectangle box = geometry::bounding_box(lit);
  ReflectedSum reflection(surface, std::move(lit), to_source, receiver, kernel, reflectance);
  reflection.add(box, 0);
  return reflection.sum() / (geometry::area(outline) * rise_above(beam_plane, to_source));
}

void visit_reflected(const EntranceSurface& surface, const Polygon& outline, const geometry::TouchingPlane& beam_plane,
                     const Vec3& to_source, std::size_t columns,
                     const std::function<double(const Vec3& normal)>& reflectance,
                     const std::function<void(const Vec3& direction, double power)>& visit) {
  const Polygon lit = lit_outline(surface, outline, beam_plane, to_source);
  if (lit.size() < 3) return;
  const Rectangle box = geometry::bounding_box(lit);
  const Vec2 step = box.size() / static_cast<double>(columns);
  const double per_mm2 = 1.0 / (geometry::area(outline) * rise_above(beam_plane, to_source));
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const Vec2 at = box.lower + Vec2(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5).cwiseProduct(step);
      if (!geometry::contains(lit, at)) continue;
      const Vec2 slope = surface.at(at).slope;
      const Vec3 normal = Vec3(-slope.x(), -slope.y(), 1.0).normalized();
      const double cosine = normal.dot(to_source);
      if (!(cosine > 0.0)) continue;
      visit(mirrored(-to_source, normal), step.prod() * cosine / normal.z() * per_mm2 * reflectance(normal));
    }
}

}  // namespace retrace::raytrace
