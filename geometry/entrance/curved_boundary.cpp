#include "geometry/entrance/curved_boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/centroid.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/vertex_index.h"

namespace retrace::geometry {
namespace {

/// Maximum distance at which two vertices are merged, as a fraction of the size of an element.
constexpr double kMergeFraction = 1e-8;
/// Number of square cells along the longer side of an exact surface, before cells are divided.
constexpr int kFirstCells = 8;
/// Maximum number of times that a cell is divided into four cells.
constexpr int kMaxDivisions = 12;
/// Maximum error of the triangles of a cell when the cell is made, as a fraction of the permitted error. It is less
/// than 1 because the triangles change later, when vertices of smaller neighbouring cells are inserted on the sides of
/// the cell.
constexpr double kFractionOfError = 0.7;
/// Height of the inner vertices of a side above the side's lower edge, as a fraction of the smallest gap between this
/// edge and the entrance face.
constexpr double kInnerHeight = 0.5;

using Ring = std::vector<std::uint32_t>;

/// Measures the distances between triangles and an exact surface.
class ChordError {
 public:
  /// \param spacing_mm maximum distance between points at which the distance is measured
  ChordError(const EntranceSurface& surface, double spacing_mm) : surface_(surface), spacing_mm_(spacing_mm) {}

  /// Returns the maximum distance along z between a triangle and the surface, at points of a grid within the triangle.
  /// If a distance exceeds `enough_mm`, returns it without checking further points.
  double of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double enough_mm) const {
    const double longest_mm = std::max({(b - a).head<2>().norm(), (c - b).head<2>().norm(), (a - c).head<2>().norm()});
    const int steps = std::max(3, static_cast<int>(std::ceil(longest_mm / spacing_mm_)));
    double error_mm = 0.0;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3 p = a + (static_cast<double>(i) / steps) * (b - a) + (static_cast<double>(j) / steps) * (c - a);
        error_mm = std::max(error_mm, std::abs(surface_.at(p.head<2>()).height_mm - p.z()));
        if (error_mm > enough_mm) return error_mm;
      }
    return error_mm;
  }

  Vec3 on_surface(const Vec2& p) const { return {p.x(), p.y(), surface_.at(p).height_mm}; }

  /// Returns the maximum distance between the surface and the triangles that join the centroid of a polygon to its
  /// sides.
  double of_polygon(const Polygon& polygon, double enough_mm) const {
    const Vec3 hub = on_surface(centroid(polygon));
    double error_mm = 0.0;
    for (std::size_t k = 0; k < polygon.size() && error_mm <= enough_mm; ++k)
      error_mm = std::max(
          error_mm, of_triangle(hub, on_surface(polygon[k]), on_surface(polygon[(k + 1) % polygon.size()]), enough_mm));
    return error_mm;
  }

 private:
  const EntranceSurface& surface_;
  double spacing_mm_;
};

/// Divides the plan of an entrance face into convex polygons that are small enough for accurate triangles.
class PlanDivision {
 public:
  PlanDivision(const ChordError& chords, double max_error_mm, double tolerance_mm)
      : chords_(chords), max_error_mm_(max_error_mm), tolerance_mm_(tolerance_mm) {}

  std::vector<Polygon> polygons_of(const Polygon& outline) {
    const Rectangle box = bounding_box(outline);
    const double cell_mm = box.size().maxCoeff() / kFirstCells;
    const auto count = [&](Eigen::Index axis) {
      return std::max(1, static_cast<int>(std::ceil(box.size()[axis] / cell_mm - 1e-9)));
    };
    const Vec2 size = box.size().cwiseQuotient(Vec2(count(0), count(1)));
    for (int j = 0; j < count(1); ++j)
      for (int i = 0; i < count(0); ++i) {
        const Vec2 lower = box.lower + Vec2(i, j).cwiseProduct(size);
        divide(outline, {lower, lower + size}, 0);
      }
    return std::move(polygons_);
  }

 private:
  void divide(const Polygon& outline, const Rectangle& cell, int divisions) {
    const Polygon polygon = clip(outline, cell, tolerance_mm_);
    if (polygon.size() < 3) return;
    const double enough_mm = kFractionOfError * max_error_mm_;
    if (divisions == kMaxDivisions || chords_.of_polygon(polygon, enough_mm) <= enough_mm) {
      polygons_.push_back(polygon);
      if (polygons_.size() > kMaxEntrancePolygons)
        throw BudgetError(fmt::format("an entrance surface within {} mm needs more than {} polygons: use a larger {}",
                                      shortest(max_error_mm_), kMaxEntrancePolygons, reference({"surface_error_mm"})));
      return;
    }
    const Vec2 half = 0.5 * cell.size();
    for (const Vec2& share : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
      const Vec2 lower = cell.lower + share.cwiseProduct(half);
      divide(polygon, {lower, lower + half}, divisions + 1);
    }
  }

  const ChordError& chords_;
  double max_error_mm_;
  double tolerance_mm_;
  std::vector<Polygon> polygons_;
};

/// Builds a closed boundary from the back of a part by adding the sides and the entrance face. A vertex of the entrance
/// face is identified by its position in plan, so that sides and neighbouring polygons share vertices.
class BoundaryBuilder {
 public:
  /// \param cell_mm typical distance between the vertices of the entrance face
  BoundaryBuilder(const Part& part, double cell_mm)
      : mesh_(back_boundary(part)), tolerance_mm_(kMergeFraction * part.size_mm), plan_(tolerance_mm_, cell_mm) {
    rims_ = part.patches[part.placements.front().patch].border_rim;
    if (rims_.empty()) rims_ = rims_of_open_edges();
    // The ends of the sides are the first vertices, so that later vertices near them are merged with them.
    for (const Ring& rim : rims_) ends_.emplace_back(plan_.add(place(rim.front())), plan_.add(place(rim.back())));
  }

  /// Adds a polygon of the entrance face. The polygon must be convex in plan and counter-clockwise seen from above.
  void add_polygon(const std::vector<Vec3>& corners) {
    Ring ring;
    for (const Vec3& p : corners) {
      const std::uint32_t k = plan_.add(p.head<2>());
      heights_mm_.try_emplace(k, p.z());
      if (ring.empty() || (ring.back() != k && ring.front() != k)) ring.push_back(k);
    }
    if (ring.size() >= 3) polygons_.push_back(std::move(ring));
  }

  /// Adds all triangles of the entrance face and the sides, and returns the boundary.
  /// \param height heights of the entrance face; empty: heights are interpolated along the sides of the polygons
  BoundaryMesh build(const EntranceHeights& height) {
    for (Ring& ring : polygons_) ring = with_vertices_on_sides(ring, height);
    first_ = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t k = 0; k < plan_.size(); ++k)
      mesh_.vertices.emplace_back(plan_[k].x(), plan_[k].y(), heights_mm_.at(k));
    for (const Ring& ring : polygons_) add_cover_polygon(ring, height);
    for (std::size_t k = 0; k < rims_.size(); ++k) add_side(rims_[k], ends_[k]);
    return std::move(mesh_);
  }

 private:
  Vec2 place(std::uint32_t vertex) const { return mesh_.vertices[vertex].head<2>(); }

  /// Returns the lower borders of the sides, for a back whose SurfacePatch::border_rim is not set. The borders are
  /// found from the edges that belong to only one triangle of the back.
  std::vector<Ring> rims_of_open_edges() const {
    const auto edges = open_edges(mesh_);
    std::map<std::pair<double, double>, std::vector<std::pair<double, std::uint32_t>>> columns;
    const auto column_at = [&](std::uint32_t v) -> auto& {
      return columns[{place(v).x(), place(v).y()}];
    };
    for (const auto& [a, b] : edges)
      for (const std::uint32_t v : {a, b}) column_at(v).emplace_back(mesh_.vertices[v].z(), v);
    for (auto& [at, column] : columns) {
      std::sort(column.begin(), column.end());
      column.erase(std::unique(column.begin(), column.end()), column.end());
    }
    std::vector<Ring> rims;
    for (const auto& [to, from] : edges) {
      if (place(from) == place(to)) continue;  // a vertical edge, whose vertices are in one column
      Ring rim;
      const auto& before = column_at(from);
      for (auto it = before.rbegin(); it != before.rend() && it->first > mesh_.vertices[from].z(); ++it)
        rim.push_back(it->second);
      rim.insert(rim.end(), {from, to});
      for (const auto& [z, v] : column_at(to))
        if (z > mesh_.vertices[to].z()) rim.push_back(v);
      rims.push_back(std::move(rim));
    }
    return rims;
  }

  /// Returns a copy of a polygon, with all plan vertices on its sides inserted. If the height of an inserted vertex is
  /// not known yet, it is set.
  Ring with_vertices_on_sides(const Ring& corners, const EntranceHeights& height) {
    Ring ring;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[(k + 1) % corners.size()];
      ring.push_back(a);
      for (const std::uint32_t v : plan_.on_segment(a, b)) {
        ring.push_back(v);
        if (heights_mm_.contains(v)) continue;
        const double share = (plan_[v] - plan_[a]).norm() / (plan_[b] - plan_[a]).norm();
        heights_mm_[v] = height ? height(plan_[v]) : std::lerp(heights_mm_.at(a), heights_mm_.at(b), share);
      }
    }
    return ring;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, FacetRole role) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.roles.push_back(role);
  }

  void add_cover_polygon(const Ring& ring, const EntranceHeights& height) {
    Ring vertices;
    for (const std::uint32_t k : ring) vertices.push_back(first_ + k);
    if (!height && ring.size() == 3) return add_triangle(vertices[0], vertices[1], vertices[2], FacetRole::entrance);
    add_fan(mesh_, vertices, FacetRole::entrance);
    Vec3& hub = mesh_.vertices.back();
    if (height) hub.z() = height(hub.head<2>());
  }

  /// Adds the side between a rim and the entrance face.
  /// \param ends plan vertices above both ends of the rim
  void add_side(const Ring& rim, const std::pair<std::uint32_t, std::uint32_t>& ends) {
    // First comes the part of the side below the straight line between the upper ends of the rim. This part is convex.
    if (rim.size() > 2) add_fan(mesh_, rim, FacetRole::side);
    Ring top = {first_ + ends.first};
    for (const std::uint32_t k : plan_.on_segment(ends.first, ends.second)) top.push_back(first_ + k);
    top.push_back(first_ + ends.second);
    add_strip(rim.front(), rim.back(), top);
  }

  /// Adds triangles between a straight lower edge and a curved upper edge. If the upper edge has inner vertices, a row
  /// of vertices is added between the two edges, parallel to the lower edge. This keeps all triangles within the strip.
  void add_strip(std::uint32_t from, std::uint32_t to, const Ring& top) {
    const std::size_t last = top.size() - 1;
    std::vector<double> line_mm;
    double gap_mm = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : top) {
      const double share = (place(v) - place(from)).norm() / (place(to) - place(from)).norm();
      line_mm.push_back(std::lerp(mesh_.vertices[from].z(), mesh_.vertices[to].z(), share));
      gap_mm = std::min(gap_mm, mesh_.vertices[v].z() - line_mm.back());
    }
    if (!(gap_mm > tolerance_mm_))
      throw InputError(fmt::format("must be above the back of the part, but touches it near x = {}, y = {} mm",
                                   fixed(place(from).x(), 4), fixed(place(from).y(), 4)));
    constexpr FacetRole kSide = FacetRole::side;
    if (last == 1) {
      add_triangle(from, to, top[1], kSide);
      add_triangle(from, top[1], top[0], kSide);
      return;
    }
    Ring inner = {0};
    for (std::size_t k = 1; k < last; ++k) {
      inner.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
      mesh_.vertices.emplace_back(place(top[k]).x(), place(top[k]).y(), line_mm[k] + kInnerHeight * gap_mm);
    }
    add_triangle(from, to, inner[last - 1], kSide);
    for (std::size_t k = 1; k + 1 < last; ++k) {
      add_triangle(from, inner[k + 1], inner[k], kSide);
      add_triangle(inner[k], inner[k + 1], top[k + 1], kSide);
      add_triangle(inner[k], top[k + 1], top[k], kSide);
    }
    add_triangle(from, inner[1], top[1], kSide);
    add_triangle(from, top[1], top[0], kSide);
    add_triangle(to, top[last], top[last - 1], kSide);
    add_triangle(to, top[last - 1], inner[last - 1], kSide);
  }

  BoundaryMesh mesh_;
  double tolerance_mm_;
  VertexIndex plan_;
  std::vector<Ring> rims_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends_;  ///< plan vertices above both ends of each rim
  std::vector<Ring> polygons_;                                 ///< polygons of the entrance face as plan vertices
  std::map<std::uint32_t, double> heights_mm_;                 ///< heights of plan vertices
  std::uint32_t first_ = 0;                                    ///< mesh vertex of the first plan vertex
};

CurvedBoundary with_exact_surface(const Part& part, const EntranceSurface& surface, double max_error_mm) {
  const Rectangle box = bounding_box(part.outline);
  const ChordError chords(surface, box.size().maxCoeff() / cells_to_resolve(surface, part.outline));
  std::vector<Polygon> polygons;
  for (const Polygon& piece : entrance_polygons(part)) {
    PlanDivision division(chords, max_error_mm, kMergeFraction * part.size_mm);
    for (Polygon& polygon : division.polygons_of(piece)) polygons.push_back(std::move(polygon));
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, polygons.size()));
  BoundaryBuilder builder(part, std::sqrt(box.size().prod() / count));
  for (const Polygon& polygon : polygons) {
    std::vector<Vec3> corners;
    for (const Vec2& p : polygon) corners.push_back(chords.on_surface(p));
    builder.add_polygon(corners);
  }
  CurvedBoundary boundary{builder.build([&](const Vec2& p) { return surface.at(p).height_mm; })};
  const std::vector<Vec3>& vertices = boundary.mesh.vertices;
  for (std::size_t t = 0; t < boundary.mesh.triangles.size(); ++t) {
    if (boundary.mesh.roles[t] != FacetRole::entrance) continue;
    const auto& [a, b, c] = boundary.mesh.triangles[t];
    boundary.entrance_error_mm =
        std::max(boundary.entrance_error_mm, chords.of_triangle(vertices[a], vertices[b], vertices[c], INFINITY));
  }
  return boundary;
}

}  // namespace

CurvedBoundary curved_boundary(const Part& part, const Entrance& entrance, double max_error_mm) {
  if (const auto* const surface = std::get_if<std::shared_ptr<const EntranceSurface>>(&entrance))
    return with_exact_surface(part, **surface, max_error_mm);
  const SurfacePatch& mesh = *std::get<1>(entrance);
  BoundaryBuilder builder(part, std::sqrt(area(part.outline) / static_cast<double>(mesh.triangles.size())));
  for (const std::vector<Vec3>& polygon : entrance_mesh_polygons(mesh, part.outline)) builder.add_polygon(polygon);
  return {builder.build({})};
}

}  // namespace retrace::geometry
