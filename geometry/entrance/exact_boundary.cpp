#include "geometry/entrance/exact_boundary.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/centroid.h"
#include "geometry/entrance/curved_boundary.h"

namespace retrace::geometry {
namespace {

// Maximum distance between an edge of a patch and the patch, mm. OpenCASCADE treats points nearer than 1e-7 mm as
// equal.
constexpr double kEdgeError_mm = 2e-8;
constexpr std::size_t kMaxEdgePoints = 4097;
constexpr std::size_t kMinPatchCells = 6;
// Distance between the points at which the curvature at the border of a part is measured, relative to its size.
constexpr double kCurvatureStep = 1e-3;
// Relative change of volume and area at which the quadrature ends.
constexpr double kQuadratureError = 1e-11;
constexpr int kMaxQuadratureCells = 64;

/// Positions and weights of Gauss-Legendre quadrature with six points on 0..1 (Abramowitz and Stegun, table 25.4).
constexpr std::array<double, 6> kGaussPosition = {0.033765242898423989, 0.16939530676686775, 0.38069040695840155,
                                                  0.61930959304159845,  0.83060469323313225, 0.96623475710157601};
constexpr std::array<double, 6> kGaussWeight = {0.085662246189585178, 0.18038078652406930, 0.23395696728634552,
                                                0.23395696728634552,  0.18038078652406930, 0.085662246189585178};

/// Heights of an entrance surface, which are continued outside the outline of the part.
class ContinuedHeights {
 public:
  ContinuedHeights(const EntranceSurface& surface, std::vector<Polygon> pieces, double size_mm)
      : surface_(surface), pieces_(std::move(pieces)), step_mm_(kCurvatureStep * size_mm) {}

  /// Returns the height at a point. Where the surface is undefined, a parabola continues it from the nearest point of
  /// the part.
  double operator()(const Vec2& point_mm) const {
    const EntranceSurface::SurfaceSample sample = surface_.at(point_mm);
    if (std::isfinite(sample.height_mm)) return sample.height_mm;
    const Vec2 nearest = nearest_point(point_mm);
    const Vec2 away = point_mm - nearest;
    const double distance_mm = away.norm();
    const Vec2 along = away / distance_mm;
    const EntranceSurface::SurfaceSample border = surface_.at(nearest);
    const EntranceSurface::SurfaceSample inner = surface_.at(nearest - step_mm_ * along);
    const double curvature = (border.slope - inner.slope).dot(along) / step_mm_;
    return border.height_mm + border.slope.dot(away) + 0.5 * curvature * distance_mm * distance_mm;
  }

  bool is_over_part(const Vec2& point_mm) const {
    return std::any_of(pieces_.begin(), pieces_.end(), [&](const Polygon& piece) { return contains(piece, point_mm); });
  }

 private:
  Vec2 nearest_point(const Vec2& point_mm) const {
    Vec2 nearest = pieces_.front().front();
    for (const Polygon& piece : pieces_)
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const Vec2 along = piece[(k + 1) % piece.size()] - piece[k];
        const double share = std::clamp((point_mm - piece[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const Vec2 at = piece[k] + share * along;
        if ((at - point_mm).squaredNorm() < (nearest - point_mm).squaredNorm()) nearest = at;
      }
    return nearest;
  }

  const EntranceSurface& surface_;
  std::vector<Polygon> pieces_;
  double step_mm_;
};

struct FittedPatch {
  SplinePatch patch;
  double error_mm = 0.0;
};

/// Returns the maximum distance between a patch and the heights, at points within the cells that are over the part.
double patch_error_mm(const SplinePatch& patch, const ContinuedHeights& heights) {
  double error_mm = 0.0;
  for (std::size_t j = 0; j + 1 < patch.y.count(); ++j)
    for (std::size_t i = 0; i + 1 < patch.x.count(); ++i)
      for (const double down : kWithinEntranceCell)
        for (const double across : kWithinEntranceCell) {
          const Vec2 at(patch.x.site(i) + across * patch.x.step(), patch.y.site(j) + down * patch.y.step());
          if (heights.is_over_part(at)) error_mm = std::max(error_mm, std::abs(patch.height_mm(at) - heights(at)));
        }
  return error_mm;
}

FittedPatch fitted_patch(const Part& part, const EntranceSurface& surface, double max_error_mm) {
  const Rectangle box = bounding_box(part.outline);
  const double size_mm = box.size().maxCoeff();
  const ContinuedHeights heights(surface, entrance_polygons(part), size_mm);
  std::size_t cells = std::max(kMinPatchCells, static_cast<std::size_t>(cells_to_resolve(surface, part.outline)) / 2);
  for (;; cells *= 2) {
    const std::size_t longest = std::min(cells, kMaxPatchPoints - 1);
    const auto points = [&](Eigen::Index axis) {
      const double share = box.size()[axis] / size_mm;
      return std::max(kMinPatchCells, static_cast<std::size_t>(std::ceil(share * static_cast<double>(longest)))) + 1;
    };
    FittedPatch fitted{interpolated_patch(SplineAxis(box.lower.x(), box.upper.x(), points(0)),
                                          SplineAxis(box.lower.y(), box.upper.y(), points(1)), heights)};
    fitted.error_mm = patch_error_mm(fitted.patch, heights);
    if (fitted.error_mm <= max_error_mm) return fitted;
    if (cells >= kMaxPatchPoints - 1)
      throw BudgetError(fmt::format(
          "a B-spline of {} points along the part deviates from the entrance surface by {:.3g} mm, but at most {} mm "
          "are allowed: use a larger {}",
          kMaxPatchPoints, fitted.error_mm, shortest(max_error_mm), reference({"surface_error_mm"})));
  }
}

/// Returns the edge of a patch above the line between two vertices.
PatchEdge edge_of(const SplinePatch& patch, const std::vector<Vec3>& vertices, std::uint32_t from, std::uint32_t to) {
  const Vec2 start = vertices[from].head<2>();
  const Vec2 along = vertices[to].head<2>() - start;
  const auto height = [&](double share) { return patch.height_mm(start + share * along); };
  for (std::size_t points = 17;; points = 2 * points - 1) {
    PatchEdge edge{from, to, SplineAxis(0.0, 1.0, points), {}};
    std::vector<double> heights;
    for (std::size_t k = 0; k < points; ++k) heights.push_back(height(edge.axis.site(k)));
    edge.heights_mm = edge.axis.interpolated(std::move(heights));
    if (points >= kMaxEdgePoints) return edge;
    double error_mm = 0.0;
    for (std::size_t k = 0; k + 1 < points; ++k)
      for (const double within : kWithinEntranceCell) {
        const double share = edge.axis.site(k) + within * edge.axis.step();
        error_mm = std::max(error_mm, std::abs(spline_value(edge.axis, edge.heights_mm, share) - height(share)));
      }
    if (error_mm <= kEdgeError_mm) return edge;
  }
}

/// Volume below a surface and area of the surface.
struct SurfaceMeasures {
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
};

/// Integrates over a triangle in plan: Gauss quadrature in collapsed coordinates, on cells x cells triangles.
void add_triangle_measures(const EntranceSurface& surface, const std::array<Vec2, 3>& corners, int cells,
                           SurfaceMeasures& sum) {
  const Vec2 u = (corners[1] - corners[0]) / cells;
  const Vec2 v = (corners[2] - corners[0]) / cells;
  const double twice_area = u.x() * v.y() - u.y() * v.x();
  const auto add = [&](const Vec2& corner, const Vec2& a, const Vec2& b) {
    for (std::size_t i = 0; i < kGaussPosition.size(); ++i)
      for (std::size_t j = 0; j < kGaussPosition.size(); ++j) {
        const double s = kGaussPosition.at(i);
        const Vec2 at = corner + s * (1.0 - kGaussPosition.at(j)) * a + s * kGaussPosition.at(j) * b;
        const EntranceSurface::SurfaceSample sample = surface.at(at);
        const double weight = kGaussWeight.at(i) * kGaussWeight.at(j) * s * twice_area;
        sum.volume_mm3 += weight * sample.height_mm;
        sum.area_mm2 += weight * std::sqrt(1.0 + sample.slope.squaredNorm());
      }
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i + j < cells; ++i) {
      const Vec2 corner = corners[0] + i * u + j * v;
      add(corner, u, v);
      if (i + j + 1 < cells) add(corner + u + v, -u, -v);
    }
}

/// Returns the volume between z = 0 and a surface over the polygons, and the area of the surface. The number of cells
/// is doubled until the result no longer changes.
SurfaceMeasures surface_measures(const EntranceSurface& surface, const std::vector<Polygon>& polygons,
                                 int first_cells) {
  SurfaceMeasures last;
  for (int cells = first_cells;; cells *= 2) {
    SurfaceMeasures sum;
    for (const Polygon& polygon : polygons) {
      const Vec2 middle = centroid(polygon);
      for (std::size_t k = 0; k < polygon.size(); ++k)
        add_triangle_measures(surface, {middle, polygon[k], polygon[(k + 1) % polygon.size()]}, cells, sum);
    }
    const bool is_same = std::abs(sum.volume_mm3 - last.volume_mm3) <= kQuadratureError * std::abs(sum.volume_mm3) &&
                         std::abs(sum.area_mm2 - last.area_mm2) <= kQuadratureError * sum.area_mm2;
    if ((cells > first_cells && is_same) || cells >= kMaxQuadratureCells) return sum;
    last = sum;
  }
}

/// Returns the area between a horizontal line and the surface above a line in plan.
/// \param top_mm height of the horizontal line, above the surface
double area_above_edge(const EntranceSurface& surface, const Vec2& from, const Vec2& to, double top_mm, int cells) {
  double sum = 0.0;
  for (int cell = 0; cell < cells; ++cell)
    for (std::size_t k = 0; k < kGaussPosition.size(); ++k) {
      const double share = (cell + kGaussPosition.at(k)) / cells;
      sum += kGaussWeight.at(k) / cells * (top_mm - surface.at(from + share * (to - from)).height_mm);
    }
  return sum * (to - from).norm();
}

/// Returns a height above a part and its entrance surface.
double height_of_cover_mm(const Part& part, double highest_mm) {
  for (const Placement& placement : part.placements)
    for (const Vec3& p : part.patches[placement.patch].vertices)
      highest_mm = std::max(highest_mm, p.z() + placement.height_mm);
  return highest_mm + 0.1 * bounding_box(part.outline).size().maxCoeff();
}

/// Returns the edges of the faces with the role `entrance`. The value is true for edges that belong to only one of
/// these faces.
std::map<std::pair<std::uint32_t, std::uint32_t>, bool> entrance_edges(const FacetedSolid& solid) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
  for (const SolidFace& face : solid.faces) {
    if (face.role != FacetRole::entrance) continue;
    for (const auto& loop : face.loops)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const auto [low, high] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
        const auto [it, is_new] = edges.emplace(std::pair(low, high), true);
        if (!is_new) it->second = false;
      }
  }
  return edges;
}

BoundaryMesh covered_boundary(const Part& part, double top_mm) {
  const Entrance cover =
      std::make_shared<const EntranceSurface>(FreeformSurface(Sag{}, std::nullopt, {}, {}), Vec3(0.0, 0.0, top_mm));
  return curved_boundary(part, cover, 1.0).mesh;
}

}  // namespace

ExactBoundary exact_boundary(const Part& part, const EntranceSurface& surface,
                             const std::optional<FaceSurface>& closed_form, double max_error_mm) {
  // The part is first covered by a horizontal plane above its entrance surface. The edges of this cover are then moved
  // down onto the surface.
  ExactBoundary boundary;
  boundary.highest_mm = entrance_range(std::make_shared<const EntranceSurface>(surface), part.outline).highest_mm;
  const double top_mm = height_of_cover_mm(part, boundary.highest_mm);
  const BoundaryMesh covered = covered_boundary(part, top_mm);
  if (!is_closed_manifold(covered)) throw InputError("must not be above a part that touches itself along edges");
  boundary.solid.faces = faceted_solid(covered);
  if (closed_form) {
    boundary.solid.entrance = CurvedFace{*closed_form, {}};
  } else {
    FittedPatch fitted = fitted_patch(part, surface, max_error_mm);
    boundary.entrance_error_mm = fitted.error_mm;
    boundary.solid.entrance = CurvedFace{std::move(fitted.patch), {}};
  }
  CurvedFace& entrance = *boundary.solid.entrance;
  const auto* const patch = std::get_if<SplinePatch>(&entrance.surface);

  const int cells = std::clamp(cells_to_resolve(surface, part.outline) / 8, 1, kMaxQuadratureCells / 2);
  boundary.area_mm2 = area_mm2(covered);
  std::vector<Vec3>& vertices = boundary.solid.faces.vertices;
  for (const auto& [edge, is_border] : entrance_edges(boundary.solid.faces)) {
    const auto [from, to] = edge;
    for (const std::uint32_t v : {from, to}) {
      const Vec2 at = vertices[v].head<2>();
      vertices[v].z() = patch != nullptr ? patch->height_mm(at) : surface.at(at).height_mm;
    }
    if (is_border)
      boundary.area_mm2 -=
          area_above_edge(surface, vertices[from].head<2>(), vertices[to].head<2>(), top_mm, 16 * cells);
    if (patch != nullptr) entrance.edges.push_back(edge_of(*patch, vertices, from, to));
  }
  const std::vector<Polygon> polygons = entrance_polygons(part);
  const SurfaceMeasures measures = surface_measures(surface, polygons, cells);
  double plan_mm2 = 0.0;
  for (const Polygon& polygon : polygons) plan_mm2 += area(polygon);
  boundary.volume_mm3 = volume_mm3(covered) - plan_mm2 * top_mm + measures.volume_mm3;
  boundary.area_mm2 += measures.area_mm2 - plan_mm2;
  return boundary;
}

}  // namespace retrace::geometry
