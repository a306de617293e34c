#include "geometry/entrance/entrance_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/entrance/entrance_mesh.h"

namespace retrace::geometry {
namespace {

constexpr int kCellsPerFeature = 8;
constexpr int kFewestCells = 64;
// Two grids of different density resolve the same features if the ratio of the mean curvatures that they measure is at
// most this value.
constexpr double kSameBend = 1.3;
// Changes of slope below this value are rounding errors; the surface is then treated as a plane.
constexpr double kFlat = 1e-9;
// Distance from a corner at which the local curvature is measured, relative to the size of a grid cell.
constexpr double kSmall = 1e-3;

bool is_inside(const Polygon& outline, const Vec2& p) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 along = outline[(k + 1) % outline.size()] - outline[k];
    const Vec2 to = p - outline[k];
    if (along.x() * to.y() - along.y() * to.x() < -1e-12 * along.squaredNorm()) return false;
  }
  return true;
}

/// Returns the grid points over the outline and points on its edges.
std::vector<Vec2> sample_points(const Polygon& outline, int cells) {
  const Rectangle box = bounding_box(outline);
  std::vector<Vec2> points;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const Vec2 share(static_cast<double>(i) / cells, static_cast<double>(j) / cells);
      const Vec2 p = box.lower + share.cwiseProduct(box.size());
      if (is_inside(outline, p)) points.push_back(p);
      const Vec2 within = p + Vec2(kWithinEntranceCell[0], kWithinEntranceCell[1]).cwiseProduct(box.size()) / cells;
      if (is_inside(outline, within)) points.push_back(within);
    }
  for (std::size_t k = 0; k < outline.size(); ++k)
    for (int i = 0; i < cells; ++i) {
      const double share = static_cast<double>(i) / cells;
      points.push_back(outline[k] + share * (outline[(k + 1) % outline.size()] - outline[k]));
    }
  return points;
}

/// Returns the mean change of slope per mm from the corners of a grid's cells to points within the cells.
/// \param reach scale of the distance from the corner: 1 for points well within the cell, less for points nearer to the
///     corner
double mean_bend(const EntranceSurface& surface, const Rectangle& box, int cells, double reach) {
  const Vec2 cell_mm = box.size() / cells;
  // Two displacements are used. A periodic surface may have equal slopes at both ends of one displacement by
  // coincidence, but not at both ends of the other displacement.
  const std::array<Vec2, 2> ways = {reach * Vec2(kWithinEntranceCell[0], kWithinEntranceCell[1]).cwiseProduct(cell_mm),
                                    reach * Vec2(0.7548776662, 0.5698402910).cwiseProduct(cell_mm)};
  double sum = 0.0;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Vec2 corner = box.lower + Vec2(i, j).cwiseProduct(cell_mm);
      const Vec2 slope = surface.at(corner).slope;
      for (const Vec2& way : ways) {
        const double bend = (surface.at(corner + way).slope - slope).norm() / way.norm();
        if (std::isfinite(bend)) sum += bend;
      }
    }
  return sum / (2.0 * cells * cells);
}

bool same_bend(double a, double b, double size_mm) {
  return std::max(a, b) * size_mm < kFlat || (a <= kSameBend * b && b <= kSameBend * a);
}

/// Searches for the nearest local maximum (sign 1) or minimum (sign -1) over the outline, beginning at a point. The
/// search uses decreasing steps along the axes, the diagonals and the edges of the outline (R. Hooke, T. A. Jeeves, J.
/// ACM 8 (1961), 212).
Vec2 climb(const EntranceSurface& surface, const Polygon& outline, Vec2 from, double step_mm, double sign) {
  std::vector<Vec2> directions = {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1).normalized(), Vec2(1, -1).normalized()};
  for (std::size_t k = 0; k < outline.size() && k < 8; ++k)
    directions.push_back((outline[(k + 1) % outline.size()] - outline[k]).normalized());
  double best = sign * surface.at(from).height_mm;
  const double least_mm = 1e-9 * step_mm;
  while (step_mm > least_mm) {
    bool moved = false;
    for (const Vec2& direction : directions)
      for (const double way : {step_mm, -step_mm}) {
        const Vec2 p = from + way * direction;
        if (!is_inside(outline, p)) continue;
        const double value = sign * surface.at(p).height_mm;
        if (!(value > best)) continue;
        best = value;
        from = p;
        moved = true;
      }
    if (!moved) step_mm *= 0.5;
  }
  return from;
}

EntranceRange range_of(const EntranceSurface& surface, const Polygon& outline) {
  const Rectangle box = bounding_box(outline);
  const int cells = cells_to_resolve(surface, outline);
  EntranceRange range;
  range.lowest_mm = INFINITY;
  range.highest_mm = -INFINITY;
  for (const Vec2& p : sample_points(outline, cells)) {
    const EntranceSurface::SurfaceSample place = surface.at(p);
    if (!std::isfinite(place.height_mm) || !place.slope.allFinite())
      throw InputError(fmt::format(
          "the surface must have a finite height and slope over the whole part, but has none at x = {}, y = {} mm",
          fixed(p.x(), 4), fixed(p.y(), 4)));
    range.steepest_slope = std::max(range.steepest_slope, place.slope.norm());
    if (place.height_mm < range.lowest_mm) {
      range.lowest_mm = place.height_mm;
      range.lowest_at_mm = p;
    }
    if (place.height_mm > range.highest_mm) {
      range.highest_mm = place.height_mm;
      range.highest_at_mm = p;
    }
  }
  const double step_mm = box.size().maxCoeff() / cells;
  range.lowest_at_mm = climb(surface, outline, range.lowest_at_mm, step_mm, -1.0);
  range.lowest_mm = surface.at(range.lowest_at_mm).height_mm;
  range.highest_at_mm = climb(surface, outline, range.highest_at_mm, step_mm, 1.0);
  range.highest_mm = surface.at(range.highest_at_mm).height_mm;
  return range;
}

}  // namespace

EntranceSurface::EntranceSurface(FreeformSurface surface, const Vec3& origin_mm, double finest_mm)
    : surface_(std::move(surface)), origin_mm_(origin_mm), finest_mm_(finest_mm) {
  for (const Lenslet& lenslet : surface_.lenslets()) finest_mm_ = std::min(finest_mm_, lenslet.outer.min_radius_mm);
}

EntranceSurface::SurfaceSample EntranceSurface::at(const Vec2& point_mm) const {
  const Vec2 place = point_mm - origin_mm_.head<2>();
  const jets::Gradient z = surface_.gradient(place.x(), place.y());
  if (std::isfinite(z.x) && std::isfinite(z.y)) return {origin_mm_.z() + z.value, {z.x, z.y}};
  return {origin_mm_.z() + surface_.height_mm(place.x(), place.y()), slope_across(place)};
}

/// Returns the slope from central differences. It is used where the gradient is not finite. For example, a formula of
/// the radius r has no derivative at r = 0, although its surface may be smooth there.
Vec2 EntranceSurface::slope_across(const Vec2& p) const {
  constexpr double kStep = 1e-5;
  return Vec2(surface_.height_mm(p.x() + kStep, p.y()) - surface_.height_mm(p.x() - kStep, p.y()),
              surface_.height_mm(p.x(), p.y() + kStep) - surface_.height_mm(p.x(), p.y() - kStep)) /
         (2.0 * kStep);
}

int cells_to_resolve(const EntranceSurface& surface, const Polygon& outline) {
  const Rectangle box = bounding_box(outline);
  const double size_mm = box.size().maxCoeff();
  const auto refuse = [] {
    throw InputError(fmt::format(
        "must have features that {} sample points across the part can resolve; make its smallest features larger",
        kMaxEntranceCells));
  };
  const double wanted = std::max(std::ceil(kCellsPerFeature * size_mm / surface.finest_mm()), double{kFewestCells});
  if (wanted > kMaxEntranceCells) refuse();
  int cells = static_cast<int>(wanted);
  const bool is_known = std::isfinite(surface.finest_mm());
  double before = mean_bend(surface, box, cells, 1.0);
  for (int same = 0; same < (is_known ? 1 : 2);) {
    if (2 * cells > kMaxEntranceCells) {
      if (!is_known) refuse();
      break;
    }
    cells *= 2;
    const double bend = mean_bend(surface, box, cells, 1.0);
    // Features below the grid spacing have a higher local curvature than the grid shows.
    const double in_the_small = mean_bend(surface, box, cells, kSmall);
    const bool sees_all = in_the_small <= bend || same_bend(in_the_small, bend, size_mm);
    same = sees_all && same_bend(before, bend, size_mm) ? same + 1 : 0;
    before = bend;
  }
  return cells;
}

double height_mm(const Entrance& entrance, const Vec2& point_mm) {
  if (const auto* const surface = std::get_if<std::shared_ptr<const EntranceSurface>>(&entrance))
    return (*surface)->at(point_mm).height_mm;
  const SurfacePatch& mesh = *std::get<std::shared_ptr<const SurfacePatch>>(entrance);
  for (const PatchFacet& facet : mesh.facets) {
    Polygon triangle;
    for (std::uint32_t k = 0; k < facet.corner_count; ++k)
      triangle.emplace_back(mesh.vertices[mesh.corners[facet.first_corner + k]].head<2>());
    if (contains(triangle, point_mm))
      return (facet.offset_mm - facet.normal.head<2>().dot(point_mm)) / facet.normal.z();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

EntranceRange entrance_range(const Entrance& entrance, const Polygon& outline) {
  if (const auto* const mesh = std::get_if<std::shared_ptr<const SurfacePatch>>(&entrance))
    return range_of_entrance_mesh(**mesh, outline);
  return range_of(*std::get<0>(entrance), outline);
}

}  // namespace retrace::geometry
