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
// Minimum cosine of the angle between z and the normal of a surface, equal to cos 89 degrees. Steeper surfaces are
// regarded as vertical.
constexpr double kMinUpward = 0.017452406437283512;
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

/// Returns the position of a local maximum of a function over the outline, found by a search from a given point. The
/// search uses decreasing steps along the axes, the diagonals and the edges of the outline (R. Hooke, T. A. Jeeves, J.
/// ACM 8 (1961), 212).
template <class Function>
Vec2 climb(const Function& function, const Polygon& outline, Vec2 from, double step_mm) {
  std::vector<Vec2> directions = {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1).normalized(), Vec2(1, -1).normalized()};
  for (std::size_t k = 0; k < outline.size() && k < 8; ++k)
    directions.push_back((outline[(k + 1) % outline.size()] - outline[k]).normalized());
  double best = function(from);
  const double least_mm = 1e-9 * step_mm;
  while (step_mm > least_mm) {
    bool moved = false;
    for (const Vec2& direction : directions)
      for (const double way : {step_mm, -step_mm}) {
        const Vec2 p = from + way * direction;
        if (!is_inside(outline, p)) continue;
        const double value = function(p);
        if (!(value > best)) continue;
        best = value;
        from = p;
        moved = true;
      }
    if (!moved) step_mm *= 0.5;
  }
  return from;
}

/// Returns the plane that touches an inclined surface from above and is perpendicular to the axis of this surface.
TouchingPlane plane_touching(const EntranceSurface& surface, const Polygon& outline, const std::vector<Vec2>& samples,
                             double step_mm) {
  const Vec3 axis = surface.axis();
  const Vec2 slope = -axis.head<2>() / axis.z();
  const auto height_above = [&](const Vec2& p) { return surface.at(p).height_mm - slope.dot(p); };
  const Vec2 highest = *std::max_element(
      samples.begin(), samples.end(), [&](const Vec2& p, const Vec2& q) { return height_above(p) < height_above(q); });
  return {height_above(climb(height_above, outline, highest, step_mm)), slope};
}

EntranceRange range_of(const EntranceSurface& surface, const Polygon& outline) {
  const Rectangle box = bounding_box(outline);
  const int cells = cells_to_resolve(surface, outline);
  EntranceRange range;
  range.lowest_mm = INFINITY;
  range.highest_mm = -INFINITY;
  const std::vector<Vec2> samples = sample_points(outline, cells);
  for (const Vec2& p : samples) {
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
  const auto height = [&](const Vec2& p) { return surface.at(p).height_mm; };
  const auto depth = [&](const Vec2& p) { return -surface.at(p).height_mm; };
  range.lowest_at_mm = climb(depth, outline, range.lowest_at_mm, step_mm);
  range.lowest_mm = surface.at(range.lowest_at_mm).height_mm;
  range.highest_at_mm = climb(height, outline, range.highest_at_mm, step_mm);
  range.highest_mm = surface.at(range.highest_at_mm).height_mm;
  if (surface.is_inclined()) range.inclined_plane = plane_touching(surface, outline, samples, step_mm);
  return range;
}

}  // namespace

EntranceSurface::EntranceSurface(FreeformSurface surface, const Vec3& origin_mm, double finest_mm)
    : EntranceSurface(std::move(surface), SurfacePose{origin_mm}, finest_mm) {}

EntranceSurface::EntranceSurface(FreeformSurface surface, const SurfacePose& pose, double finest_mm)
    : surface_(std::move(surface)),
      pose_(pose),
      finest_mm_(finest_mm),
      is_rotated_(!pose.part_from_surface.isIdentity(0.0)),
      is_inclined_(!pose.part_from_surface.col(2).head<2>().isZero(0.0)) {
  for (const Lenslet& lenslet : surface_.lenslets()) finest_mm_ = std::min(finest_mm_, lenslet.outer.min_radius_mm);
}

EntranceSurface::SurfaceSample EntranceSurface::at(const Vec2& point_mm) const {
  const Vec2 across = point_mm - pose_.origin_mm.head<2>();
  if (is_inclined_) return inclined_sample(across);
  const Eigen::Matrix2d rotation = pose_.part_from_surface.topLeftCorner<2, 2>();
  const jets::Gradient z = gradient_at(is_rotated_ ? Vec2(rotation.transpose() * across) : across);
  const Vec2 slope(z.x, z.y);
  return {pose_.origin_mm.z() + z.value, is_rotated_ ? Vec2(rotation * slope) : slope};
}

/// Returns height and slope in the frame of the surface. Where the gradient is not finite, the slope is computed from
/// central differences. For example, a formula that contains r has no derivative at r = 0, but its surface may be
/// smooth there.
jets::Gradient EntranceSurface::gradient_at(const Vec2& p) const {
  const jets::Gradient z = surface_.gradient(p.x(), p.y());
  if (std::isfinite(z.x) && std::isfinite(z.y)) return z;
  constexpr double kStep = 1e-5;
  const Vec2 slope = Vec2(surface_.height_mm(p.x() + kStep, p.y()) - surface_.height_mm(p.x() - kStep, p.y()),
                          surface_.height_mm(p.x(), p.y() + kStep) - surface_.height_mm(p.x(), p.y() - kStep)) /
                     (2.0 * kStep);
  return {surface_.height_mm(p.x(), p.y()), slope.x(), slope.y()};
}

/// Returns a vector along the normal of the surface in the part frame. Its length is not 1.
/// \param slope slope in the frame of the surface
Vec3 EntranceSurface::normal_of(const Vec2& slope) const {
  return pose_.part_from_surface * Vec3(-slope.x(), -slope.y(), 1.0);
}

/// Returns the intersection of a vertical line with the surface, found by Newton's method. Returns nothing if the
/// method does not converge, or if the normal of the surface at the intersection does not point upwards.
/// \param across_mm position of the vertical line relative to the origin of the surface
/// \param z_mm height at which the method starts
std::optional<EntranceSurface::Crossing> EntranceSurface::crossing_near(const Vec2& across_mm, double z_mm) const {
  constexpr int kMaxSteps = 40;
  constexpr double kSmallStep = 1e-12;  // relative to the distance from the origin
  // Steps below this length that no longer decrease are regarded as rounding errors of the height.
  constexpr double kRoundingMm = 1e-6;
  double previous_mm = INFINITY;
  for (int k = 0; k < kMaxSteps; ++k) {
    const Vec3 local = pose_.part_from_surface.transpose() * Vec3(across_mm.x(), across_mm.y(), z_mm);
    const jets::Gradient height = gradient_at(local.head<2>());
    const Vec2 slope(height.x, height.y);
    // A step of 1 mm along the line changes the distance between line and surface by normal.z(), measured along the
    // axis of the surface.
    const Vec3 normal = normal_of(slope);
    const double step = (height.value - local.z()) / normal.z();
    if (!std::isfinite(step)) return std::nullopt;
    z_mm += step;
    const double size_mm = std::abs(step);
    const bool is_rounding = size_mm >= 0.5 * previous_mm && size_mm < kRoundingMm;
    previous_mm = size_mm;
    if (size_mm > kSmallStep * (across_mm.norm() + std::abs(z_mm)) && !is_rounding) continue;
    if (normal.z() < kMinUpward * normal.norm()) return std::nullopt;
    return Crossing{z_mm, local.head<2>(), slope};
  }
  return std::nullopt;
}

/// Returns the intersection at `across_mm` that is connected to the origin of the surface. The vertical line is moved
/// from the origin to `across_mm` in small steps, and each intersection is the start of the next search.
std::optional<EntranceSurface::Crossing> EntranceSurface::followed_crossing(const Vec2& across_mm) const {
  constexpr int kSteps = 64;
  const Vec3 from = pose_.part_from_surface * Vec3(0.0, 0.0, surface_.height_mm(0.0, 0.0));
  std::optional<Crossing> crossing = crossing_near(from.head<2>(), from.z());
  const Vec2 step = (across_mm - from.head<2>()) / kSteps;
  for (int k = 1; crossing && k <= kSteps; ++k) {
    const Vec3 normal = normal_of(crossing->local_slope);
    const double rise = -normal.head<2>().dot(step) / normal.z();
    crossing = crossing_near(from.head<2>() + k * step, crossing->z_mm + rise);
  }
  return crossing;
}

std::optional<EntranceSurface::Crossing> EntranceSurface::crossing_at(const Vec2& across_mm) const {
  const Vec3 axis = pose_.part_from_surface.col(2);
  const double z_mm = -axis.head<2>().dot(across_mm) / axis.z();
  if (const std::optional<Crossing> crossing = crossing_near(across_mm, z_mm)) return crossing;
  return followed_crossing(across_mm);
}

EntranceSurface::SurfaceSample EntranceSurface::inclined_sample(const Vec2& across_mm) const {
  const std::optional<Crossing> crossing = crossing_at(across_mm);
  if (!crossing) return {NAN, Vec2::Constant(NAN)};
  const Vec3 normal = normal_of(crossing->local_slope);
  return {pose_.origin_mm.z() + crossing->z_mm, -normal.head<2>() / normal.z()};
}

std::optional<Vec2> EntranceSurface::surface_position(const Vec2& point_mm) const {
  const Vec2 across = point_mm - pose_.origin_mm.head<2>();
  if (!is_inclined_) return Vec2(pose_.part_from_surface.topLeftCorner<2, 2>().transpose() * across);
  const std::optional<Crossing> crossing = crossing_at(across);
  return crossing ? std::optional(crossing->position_mm) : std::nullopt;
}

bool EntranceSurface::faces_up_at(const Vec2& position_mm) const {
  const jets::Gradient height = gradient_at(position_mm);
  const Vec3 normal = normal_of({height.x, height.y});
  return std::isfinite(height.value) && normal.z() >= kMinUpward * normal.norm();
}

namespace {

/// Checks a few points of the surface between the point above `p` and the point above `q`. Returns the plan position of
/// the first point at which the surface is vertical or folds, or nothing if there is no such point. If a surface folds
/// between two points, its normal does not point upwards at some point between them.
std::optional<Vec2> fold_between(const EntranceSurface& surface, const Vec2& p, const Vec2& q) {
  constexpr int kPointsBetween = 8;
  const std::optional<Vec2> a = surface.surface_position(p);
  const std::optional<Vec2> b = surface.surface_position(q);
  if (!a || !b) return a ? q : p;
  for (int k = 0; k <= kPointsBetween; ++k) {
    const double fraction = static_cast<double>(k) / kPointsBetween;
    if (!surface.faces_up_at(*a + fraction * (*b - *a))) return Vec2(p + fraction * (q - p));
  }
  return std::nullopt;
}

}  // namespace

void check_folds(const EntranceSurface& surface, const Polygon& outline) {
  constexpr int kGrid = 64;
  const Rectangle box = bounding_box(outline);
  const auto check_side = [&](const Vec2& p, const Vec2& q) {
    if (!is_inside(outline, p) || !is_inside(outline, q)) return;
    if (const std::optional<Vec2> fold = fold_between(surface, p, q))
      throw InputError(
          fmt::format("must not fold or be vertical over the part, but it does at x = {}, y = {} mm of the part",
                      fixed(fold->x(), 4), fixed(fold->y(), 4)));
  };
  const auto point = [&](int i, int j) { return Vec2(box.lower + Vec2(i, j).cwiseProduct(box.size()) / kGrid); };
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      check_side(point(i, j), point(i + 1, j));
      check_side(point(i, j), point(i, j + 1));
    }
}

namespace {

/// Returns the corners of a triangle and further points within it, at distances of at most `spacing_mm`.
std::vector<Vec3> points_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double spacing_mm) {
  const double longest_mm = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest_mm / spacing_mm)));
  std::vector<Vec3> points;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i + j <= steps; ++i) points.push_back(a + (i * (b - a) + j * (c - a)) / steps);
  return points;
}

/// Returns the corners of a facet and further points within it, in the frame of the facet's patch.
std::vector<Vec3> points_of_facet(const SurfacePatch& patch, const PatchFacet& facet, double spacing_mm) {
  const auto corner = [&](std::uint32_t k) -> const Vec3& {
    return patch.vertices[patch.corners[facet.first_corner + k]];
  };
  std::vector<Vec3> points;
  for (std::uint32_t k = 1; k + 1 < facet.corner_count; ++k) {
    const std::vector<Vec3> own = points_of_triangle(corner(0), corner(k), corner(k + 1), spacing_mm);
    points.insert(points.end(), own.begin(), own.end());
  }
  return points;
}

}  // namespace

std::optional<EntranceContact> find_contact(const EntranceSurface& surface, const Part& part) {
  constexpr double kSpacing = 1.0 / 128.0;
  const double spacing_mm = kSpacing * bounding_box(part.outline).size().maxCoeff();
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    for (const PatchFacet& facet : patch.facets) {
      if (facet.role == FacetRole::border_wall || facet.role == FacetRole::side) continue;
      for (const Vec3& point : points_of_facet(patch, facet, spacing_mm)) {
        const Vec2 position_mm = point.head<2>() + placement.offset_mm;
        const double back_mm = point.z() + placement.height_mm;
        const double entrance_mm = surface.at(position_mm).height_mm;
        if (!(entrance_mm > back_mm)) return EntranceContact{position_mm, back_mm, entrance_mm};
      }
    }
  }
  return std::nullopt;
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
