#include "geometry/entrance/entrance_mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::geometry {
namespace {

// Largest z component of the unit normal at which a triangle counts as vertical.
constexpr double kUpright = 1e-6;
// Largest fraction of the outline that may be uncovered or covered twice along its border, because of single precision.
constexpr double kSameArea = 1e-5;
// Rounding error of single precision after a few operations, relative to the largest coordinate.
constexpr double kSingleRounding = 1e-6;

using Triangle = std::array<std::uint32_t, 3>;

/// Returns the portion of a convex polygon on the left of the line through a and b. The corners may have different
/// heights. This is one step of the Sutherland-Hodgman algorithm (Comm. ACM 17, 32, 1974).
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec2& a, const Vec2& b) {
  const Vec2 inward = Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
  const auto depth = [&](const Vec3& p) { return inward.dot(p.head<2>() - a); };
  std::vector<Vec3> left;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& p = polygon[k];
    const Vec3& q = polygon[(k + 1) % polygon.size()];
    const double dp = depth(p);
    const double dq = depth(q);
    if (dp >= 0.0) left.push_back(p);
    if ((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0)) left.push_back(p + dp / (dp - dq) * (q - p));
  }
  return left;
}

/// Returns the portion of a triangle over a convex outline.
std::vector<Vec3> over(const Polygon& outline, const std::vector<Vec3>& vertices, const Triangle& t) {
  std::vector<Vec3> polygon = {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  for (std::size_t k = 0; k < outline.size() && !polygon.empty(); ++k)
    polygon = cut(polygon, outline[k], outline[(k + 1) % outline.size()]);
  return polygon;
}

double plan_area(const std::vector<Vec3>& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& p = polygon[k];
    const Vec3& q = polygon[(k + 1) % polygon.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twice;
}

Vec3 normal_of(const std::vector<Vec3>& vertices, const Triangle& t) {
  const Vec3 twice = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
  const double length = twice.norm();
  return length > 0.0 ? Vec3(twice / length) : Vec3(Vec3::Zero());
}

/// Returns the triangles of the mesh, oriented such that the requested side faces up.
std::vector<Triangle> turned_up(const TriangleMesh& mesh, MeshSide side) {
  std::vector<Triangle> triangles = mesh.triangles;
  if (side == MeshSide::bottom)
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return triangles;
}

/// Returns the maximum distance by which rounding of coordinates to single precision may have moved a vertex.
double rounding_mm(const std::vector<Vec3>& vertices) {
  double largest_mm = 0.0;
  for (const Vec3& p : vertices) largest_mm = std::max(largest_mm, p.cwiseAbs().maxCoeff());
  return kSingleRounding * largest_mm;
}

std::vector<Vec3> moved(const std::vector<Vec3>& vertices, const Vec3& move_mm) {
  std::vector<Vec3> all;
  for (const Vec3& p : vertices) all.push_back(p + move_mm);
  return all;
}

/// Returns the error message for a mesh that has gaps or overlaps within the outline of the part.
std::string refusal_text(const MeshCover& cover, MeshSide side) {
  const bool is_nearly_all = cover.fraction > 0.999 && cover.fraction < 1.001;
  std::string text =
      fmt::format("the {} of the mesh must cover the whole part exactly one time, but covers {} % of it",
                  side == MeshSide::top ? "top" : "bottom", fixed(100.0 * cover.fraction, is_nearly_all ? 6 : 2));
  if (cover.gap)
    text += fmt::format("; at x = {}, y = {} mm of its frame, {}", fixed(cover.gap->at_mm.x(), 4),
                        fixed(cover.gap->at_mm.y(), 4), text_of(cover.gap->fault));
  return text;
}

void add_facet(SurfacePatch& patch, PatchCell& cell, const Triangle& t) {
  PatchFacet facet;
  facet.normal = normal_of(patch.vertices, t);
  facet.offset_mm = facet.normal.dot(patch.vertices[t[0]]);
  facet.role = FacetRole::entrance;
  facet.first_corner = static_cast<std::uint32_t>(patch.corners.size());
  facet.corner_count = 3;
  patch.corners.insert(patch.corners.end(), t.begin(), t.end());
  patch.triangles.push_back(t);
  patch.triangle_facet.push_back(static_cast<std::uint32_t>(patch.facets.size()));
  patch.facets.push_back(facet);
  for (const std::uint32_t v : t) {
    cell.lower = cell.lower.cwiseMin(patch.vertices[v]);
    cell.upper = cell.upper.cwiseMax(patch.vertices[v]);
  }
}

/// Moves a point onto a side of a convex outline if the distance between point and side is below the tolerance.
Vec3 settled(Vec3 p, const Polygon& outline, double tolerance_mm) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2& a = outline[k];
    const Vec2 along = (outline[(k + 1) % outline.size()] - a).normalized();
    const Vec2 inward(-along.y(), along.x());
    const double depth_mm = inward.dot(p.head<2>() - a);
    if (std::abs(depth_mm) <= tolerance_mm) p.head<2>() -= depth_mm * inward;
  }
  return p;
}

}  // namespace

bool MeshCover::is_exact() const {
  return !gap && std::abs(fraction - 1.0) <= kSameArea;
}

MeshCover cover_of_mesh(const TriangleMesh& mesh, MeshSide side, const Vec3& move_mm, const Polygon& outline) {
  const std::vector<Vec3> vertices = moved(mesh.vertices, move_mm);
  const std::vector<Triangle> all = turned_up(mesh, side);
  MeshCover cover;
  double covered_mm2 = 0.0;
  for (const Triangle& t : all) {
    if (normal_of(vertices, t).z() < kUpright) continue;
    const double area_mm2 = plan_area(over(outline, vertices, t));
    if (!(area_mm2 > 0.0)) continue;
    covered_mm2 += area_mm2;
    cover.triangles.push_back(t);
  }
  cover.fraction = covered_mm2 / area(outline);
  cover.gap = find_gap(vertices, cover.triangles, all, outline, rounding_mm(mesh.vertices));
  if (cover.gap) cover.gap->at_mm -= move_mm.head<2>();
  return cover;
}

SurfacePatch entrance_of_mesh(const TriangleMesh& mesh, MeshSide side, const Vec3& move_mm, const Polygon& outline) {
  const MeshCover cover = cover_of_mesh(mesh, side, move_mm, outline);
  if (!cover.is_exact()) throw InputError(refusal_text(cover, side));
  const std::vector<Triangle>& triangles = cover.triangles;
  SurfacePatch patch;
  patch.vertices = moved(mesh.vertices, move_mm);
  // Group nearby triangles into cells of about sixteen triangles.
  const double cell_mm = 4.0 * std::sqrt(area(outline) / static_cast<double>(triangles.size()));
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<Triangle>> bins;
  for (const Triangle& t : triangles) {
    const Vec3 middle = (patch.vertices[t[0]] + patch.vertices[t[1]] + patch.vertices[t[2]]) / 3.0;
    bins[{static_cast<std::int64_t>(std::floor(middle.y() / cell_mm)),
          static_cast<std::int64_t>(std::floor(middle.x() / cell_mm))}]
        .push_back(t);
  }
  for (const auto& [bin, members] : bins) {
    PatchCell cell;
    cell.first_facet = static_cast<std::uint32_t>(patch.facets.size());
    cell.facet_count = static_cast<std::uint32_t>(members.size());
    cell.lower.setConstant(INFINITY);
    cell.upper.setConstant(-INFINITY);
    for (const Triangle& t : members) add_facet(patch, cell, t);
    patch.cells.push_back(cell);
  }
  return patch;
}

EntranceRange range_of_entrance_mesh(const SurfacePatch& patch, const Polygon& outline) {
  EntranceRange range;
  range.lowest_mm = INFINITY;
  range.highest_mm = -INFINITY;
  for (std::size_t k = 0; k < patch.triangles.size(); ++k) {
    const Vec3& normal = patch.facets[k].normal;
    range.steepest_slope = std::max(range.steepest_slope, normal.head<2>().norm() / normal.z());
    for (const Vec3& p : over(outline, patch.vertices, patch.triangles[k])) {
      if (p.z() < range.lowest_mm) {
        range.lowest_mm = p.z();
        range.lowest_at_mm = p.head<2>();
      }
      if (p.z() > range.highest_mm) {
        range.highest_mm = p.z();
        range.highest_at_mm = p.head<2>();
      }
    }
  }
  return range;
}

std::vector<std::vector<Vec3>> entrance_mesh_polygons(const SurfacePatch& patch, const Polygon& outline) {
  const double tolerance_mm = rounding_mm(patch.vertices);
  std::vector<std::vector<Vec3>> polygons;
  for (const Triangle& t : patch.triangles) {
    std::vector<Vec3> polygon = over(outline, patch.vertices, t);
    if (!(plan_area(polygon) > 0.0)) continue;
    for (Vec3& p : polygon) p = settled(p, outline, tolerance_mm);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

}  // namespace retrace::geometry
