#include "geometry/part/mesh_part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "core/error.h"
#include "geometry/centroid.h"
#include "geometry/outline/convex_decomposition.h"
#include "geometry/part/region_elements.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

// Maximum distance from the entrance plane at which a vertex is moved onto that plane, relative to the size of the
// mesh. For the sides, twice this distance is used. Rounding to single precision causes smaller deviations.
constexpr double kSinglePrecision = 1e-6;
// Maximum sine of the angle between a facet and the horizontal at which the facet is classified as horizontal. The same
// limit applies to the angle between a facet and the vertical.
constexpr double kLevel = 1e-4;
// Maximum error of a vertex, relative to the largest coordinate: a few rounding errors of single precision.
constexpr double kVertexRounding = 0x1p-21;
// Edges shorter than this length are removed by merging their two ends. The length is in multiples of the maximum error
// of a vertex, and is measured after the vertices were moved onto their planes.
constexpr double kSamePoint = 0x1p-4;
// Maximum number of facets in a cell. An element with more facets is divided into several cells by position, so that
// each ray is tested against few facets.
constexpr std::size_t kMaxFacetsOfCell = 16;

using Ring = std::vector<std::uint32_t>;

/// Returns, for each border vertex of some triangles, the next vertex along the border. The triangles are on the left
/// of the border.
/// \throw InputError if a border branches
std::map<std::uint32_t, std::uint32_t> borders(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                               const char* what) {
  std::unordered_map<std::uint64_t, int> passed;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++passed[directed_edge(t[k], t[(k + 1) % 3])];
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, times] : passed) {
    if (passed.contains((edge << 32) | (edge >> 32))) continue;
    const auto [it, is_new] = next.emplace(static_cast<std::uint32_t>(edge >> 32), static_cast<std::uint32_t>(edge));
    if (!is_new || times > 1) throw InputError(fmt::format("{} has a border that branches", what));
  }
  return next;
}

/// Removes one closed border from `next` and returns its vertices.
Ring take_ring(std::map<std::uint32_t, std::uint32_t>& next) {
  Ring ring;
  const std::uint32_t first = next.begin()->first;
  for (std::uint32_t v = first;;) {
    const auto it = next.find(v);
    if (it == next.end()) throw InputError("the mesh has a border that is not a closed curve");
    ring.push_back(v);
    v = it->second;
    next.erase(it);
    if (v == first) return ring;
  }
}

class PartBuilder {
 public:
  PartBuilder(const TriangleMesh& mesh, std::optional<double> rounding_mm) : mesh_(mesh) {
    Vec3 lower = Vec3::Constant(INFINITY);
    Vec3 upper = Vec3::Constant(-INFINITY);
    for (const Vec3& p : mesh.vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    top_z_ = upper.z();
    tolerance_mm_ = kSinglePrecision * (upper - lower).norm();
    rounding_mm_ =
        rounding_mm.value_or(kVertexRounding * std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()));
  }

  Part build() {
    find_entrance();
    find_sides();
    settle_vertices();
    sort_triangles();
    Part part;
    part.outline = outline_;
    part.entrance_pieces = pieces_;
    part.patches.push_back(make_patch(part));
    part.placements.push_back({0, Vec2::Zero()});
    for (const Polygon& piece : entrance_polygons(part)) part.entrance_area_mm2 += area(piece);
    for (const PatchFacet& facet : part.patches[0].facets)
      if (facet.role == FacetRole::retro_facet) part.retro_facet_area_mm2 += facet_area(part.patches[0], facet);
    return part;
  }

 private:
  struct Side {
    Vec2 from = Vec2::Zero();
    Vec2 to = Vec2::Zero();
    Vec2 normal = Vec2::UnitX();  ///< points out of the part
    double offset_mm = 0.0;
    bool is_on_hull = true;  ///< false for the sides of notches and holes

    double distance(const Vec2& p) const {
      const Vec2 along = to - from;
      const double share = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (from + share * along - p).norm();
    }
  };

  Vec3 twice_area(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]);
  }

  bool is_entrance(std::size_t t) const {
    for (const std::uint32_t v : mesh_.triangles[t])
      if (top_z_ - mesh_.vertices[v].z() > tolerance_mm_) return false;
    return twice_area(t).z() > 0.0;
  }

  void find_entrance() {
    std::vector<std::array<std::uint32_t, 3>> top;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (is_entrance(t)) top.push_back(mesh_.triangles[t]);
    if (top.empty())
      throw InputError(
          "the mesh has no entrance face: its highest points must form one horizontal face that points towards +z");
    auto next = borders(top, "the entrance face of the mesh");
    while (!next.empty()) loops_.push_back(corners_of(take_ring(next)));
    std::stable_sort(loops_.begin(), loops_.end(),
                     [](const Polygon& a, const Polygon& b) { return area(a) > area(b); });
    if (loops_.front().size() < 3) throw InputError("the entrance face of the mesh has no area");
    if (loops_.size() > 1 && area(loops_[1]) >= 0.0)
      throw InputError("the entrance face of the mesh must be one face, but it consists of several faces");
    outline_ = loops_.front();
    if (loops_.size() == 1 && is_convex(outline_)) return;
    pieces_ = convex_decomposition(loops_);
    outline_ = convex_hull(loops_.front());
  }

  /// Returns the corners of a ring in plan, without those on straight sides.
  Polygon corners_of(const Ring& ring) const {
    const auto at = [&](std::size_t k) { return Vec2(mesh_.vertices[ring[k % ring.size()]].head<2>()); };
    Polygon corners;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 before = corners.empty() ? at(i + ring.size() - 1) : corners.back();
      const Vec2 along = at(i + 1) - before;
      const Vec2 to = at(i) - before;
      if (std::abs(along.x() * to.y() - along.y() * to.x()) > tolerance_mm_ * along.norm()) corners.push_back(at(i));
    }
    return corners;
  }

  static bool is_convex(const Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& p = polygon[(i + 1) % polygon.size()];
      const Vec2 a = p - polygon[i];
      const Vec2 b = polygon[(i + 2) % polygon.size()] - p;
      if (a.x() * b.y() - a.y() * b.x() <= 0.0) return false;
    }
    return true;
  }

  void find_sides() {
    for (const Polygon& loop : loops_)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2& from = loop[i];
        const Vec2& to = loop[(i + 1) % loop.size()];
        const Vec2 along = (to - from).normalized();
        const Vec2 normal(along.y(), -along.x());
        sides_.push_back({from, to, normal, normal.dot(from), is_on_hull(from, to)});
      }
  }

  bool is_on_hull(const Vec2& from, const Vec2& to) const {
    if (pieces_.empty()) return true;
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Side side{outline_[i], outline_[(i + 1) % outline_.size()]};
      if (side.distance(from) <= tolerance_mm_ && side.distance(to) <= tolerance_mm_) return true;
    }
    return false;
  }

  /// Returns the distance by which a point is outside the outline in plan, or 0 if it is inside.
  double distance_outside(const Vec2& p) const {
    if (pieces_.empty()) {
      double beyond = 0.0;
      for (const Side& side : sides_) beyond = std::max(beyond, side.normal.dot(p) - side.offset_mm);
      return beyond;
    }
    if (std::any_of(pieces_.begin(), pieces_.end(), [&](const Polygon& piece) { return contains(piece, p); }))
      return 0.0;
    double nearest = INFINITY;
    for (const Side& side : sides_) nearest = std::min(nearest, side.distance(p));
    return nearest;
  }

  /// Moves vertices that are near the entrance plane or near a side onto that plane or side.
  /// \throw InputError if a vertex is outside the outline of the entrance face
  void settle_vertices() {
    settled_ = mesh_.vertices;
    freedom_.reserve(settled_.size());
    for (Vec3& p : settled_) {
      if (top_z_ - p.z() <= tolerance_mm_) p.z() = top_z_;
      const double beyond = distance_outside(p.head<2>());
      if (beyond > 2.0 * tolerance_mm_)
        throw InputError(fmt::format(
            "the mesh must be within the outline of its entrance face, but ({}, {}, {}) mm is {:.3g} mm outside", p.x(),
            p.y(), p.z(), beyond));
      freedom_.push_back(settle(p));
    }
  }

  /// Moves a vertex that is near a corner or side of the outline onto this corner or side. Returns the projection onto
  /// the directions in which the vertex may still move. On a corner, it may move along z. On a side, it may move within
  /// the side's plane. Elsewhere, it may move in any direction.
  VertexConstraint settle(Vec3& p) const {
    for (const Side& side : sides_)
      if ((p.head<2>() - side.from).norm() <= 2.0 * tolerance_mm_) {
        p.head<2>() = side.from;
        return Vec3::UnitZ() * Vec3::UnitZ().transpose();
      }
    const Side* nearest = nullptr;
    double least_mm = 2.0 * tolerance_mm_;
    for (const Side& side : sides_) {
      const double away_mm = side.distance(p.head<2>());
      if (away_mm > least_mm) continue;
      nearest = &side;
      least_mm = away_mm;
    }
    VertexConstraint free = VertexConstraint::Identity();
    if (nearest == nullptr) return free;
    p.head<2>() -= (nearest->normal.dot(p.head<2>()) - nearest->offset_mm) * nearest->normal;
    free.topLeftCorner<2, 2>() -= nearest->normal * nearest->normal.transpose();
    return free;
  }

  /// Returns the side that contains a triangle, or null if there is none.
  const Side* side_of(const std::array<std::uint32_t, 3>& triangle) const {
    const auto found = std::find_if(sides_.begin(), sides_.end(), [&](const Side& side) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return side.distance(settled_[v].head<2>()) <= 2.0 * tolerance_mm_; });
    });
    return found == sides_.end() ? nullptr : &*found;
  }

  /// Collects the triangles of the back. Sides of notches and holes belong to the back.
  void sort_triangles() {
    bool has_back = false;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (is_entrance(t)) continue;
      const Side* const side = side_of(mesh_.triangles[t]);
      has_back = has_back || side == nullptr;
      if (side == nullptr || !side->is_on_hull) back_.push_back(mesh_.triangles[t]);
    }
    if (!has_back) throw InputError("the mesh has no back below its entrance face");
  }

  FacetRole role_of(const FacetPlane& plane) const {
    const Vec3& normal = plane.normal;
    if (is_open_side(plane)) return FacetRole::side;
    if (normal.head<2>().norm() < kLevel) return FacetRole::flat_back;
    return std::abs(normal.z()) < kLevel ? FacetRole::inner_wall : FacetRole::retro_facet;
  }

  /// Returns true if a plane contains a side of a notch or hole.
  bool is_open_side(const FacetPlane& plane) const {
    return std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
      const auto height = [&](const Vec2& p) { return std::abs(plane.height({p.x(), p.y(), 0.0})); };
      return !side.is_on_hull && std::abs(plane.normal.z()) < kLevel && plane.normal.head<2>().dot(side.normal) > 0.0 &&
             height(side.from) <= 2.0 * tolerance_mm_ && height(side.to) <= 2.0 * tolerance_mm_;
    });
  }

  /// Builds the back surface, and sets the heights and sizes of `part`.
  SurfacePatch make_patch(Part& part) {
    check_plate();
    PlaneRegions regions = settled_regions();
    move_to_zero(part, regions.planes);
    const Rectangle box = bounding_box(outline_);
    // Typical size of an element: the side of a square that has the area of four average facets.
    part.size_mm = std::clamp(2.0 * std::sqrt(area(outline_) / static_cast<double>(regions.planes.size())),
                              1e-3 * box.size().minCoeff(), box.size().minCoeff());
    part.spec.element = RtpElement{part.size_mm, part.size_mm, 90.0};
    part.spec.thickness_mm = part.thickness_mm;
    return fill_patch(regions, part.size_mm);
  }

  /// Finds the plane regions of the back and moves its vertices onto the planes of their regions. The movement can make
  /// vertices coincide, and can leave strips too narrow to be facets. A second pass therefore merges coincident
  /// vertices and finds the regions again.
  PlaneRegions settled_regions() {
    PlaneRegions regions;
    for (int pass = 0; pass < 2; ++pass) {
      if (pass > 0) weld_short_edges(settled_, kSamePoint * rounding_mm_, back_);
      regions = plane_regions(settled_, back_, rounding_mm_);
      snap_to_planes(settled_, back_, freedom_, regions);
    }
    return regions;
  }

  void check_plate() const {
    for (const auto& t : back_)
      for (const std::uint32_t v : t)
        if (settled_[v].z() >= top_z_ && side_of(t) == nullptr)
          throw InputError(
              "the mesh must have a plate: its back must be below the entrance face, but the back touches this face");
  }

  /// Moves the mesh along z so that the highest point of its back is at z = 0, and sets the heights of the part.
  void move_to_zero(Part& part, std::vector<FacetPlane>& planes) {
    double highest = -INFINITY;
    double lowest = INFINITY;
    for (const auto& t : back_)
      for (const std::uint32_t v : t) {
        if (settled_[v].z() < top_z_) highest = std::max(highest, settled_[v].z());
        lowest = std::min(lowest, settled_[v].z());
      }
    for (Vec3& p : settled_) p.z() -= highest;
    for (FacetPlane& plane : planes) plane.offset_mm -= highest * plane.normal.z();
    part.thickness_mm = top_z_ - highest;
    part.top_mm = pieces_.empty() ? 0.0 : part.thickness_mm;
    part.element_depth_mm = highest - lowest;
  }

  /// Builds the patch: the convex polygons of the plane regions become facets, grouped by element.
  SurfacePatch fill_patch(const PlaneRegions& regions, double cell_mm) const {
    const RegionTriangles needed =
        without_redundant_vertices(settled_, {back_, regions.region_of}, regions.planes, rounding_mm_);
    std::vector<FacetRole> roles;
    for (const FacetPlane& plane : regions.planes) roles.push_back(role_of(plane));
    const std::vector<std::uint32_t> element_of =
        elements_of_regions(settled_, needed, regions.planes, roles, rounding_mm_);
    std::map<std::uint32_t, std::vector<RegionPolygon>> elements;
    for (RegionPolygon& piece : convex_polygons(settled_, needed, regions.planes))
      elements[element_of[piece.region]].push_back(std::move(piece));
    SurfacePatch patch;
    patch.vertices = settled_;
    for (const auto& [number, pieces] : elements) add_element(patch, pieces, regions.planes, roles, cell_mm);
    return patch;
  }

  void add_element(SurfacePatch& patch, const std::vector<RegionPolygon>& pieces, const std::vector<FacetPlane>& planes,
                   const std::vector<FacetRole>& roles, double cell_mm) const {
    std::map<std::pair<std::int64_t, std::int64_t>, std::vector<const RegionPolygon*>> bins;
    for (const RegionPolygon& piece : pieces) {
      const Vec3 place =
          pieces.size() > kMaxFacetsOfCell ? Vec3(ring_centroid(settled_, piece.corners) / cell_mm) : Vec3::Zero();
      bins[{static_cast<std::int64_t>(std::floor(place.y())), static_cast<std::int64_t>(std::floor(place.x()))}]
          .push_back(&piece);
    }
    const auto first_of_element = static_cast<std::uint32_t>(patch.cells.size());
    for (const auto& [bin, own] : bins) {
      PatchCell cell;
      cell.first_facet = static_cast<std::uint32_t>(patch.facets.size());
      cell.facet_count = static_cast<std::uint32_t>(own.size());
      cell.lower.setConstant(INFINITY);
      cell.upper.setConstant(-INFINITY);
      cell.first_of_element = first_of_element;
      for (const RegionPolygon* piece : own)
        add_facet(patch, cell, *piece, planes[piece->region], roles[piece->region]);
      patch.cells.push_back(cell);
    }
  }

  void add_facet(SurfacePatch& patch, PatchCell& cell, const RegionPolygon& piece, const FacetPlane& plane,
                 FacetRole role) const {
    const std::vector<std::uint32_t>& corners = piece.corners;
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      patch.triangles.push_back({corners[0], corners[k], corners[k + 1]});
      patch.triangle_facet.push_back(static_cast<std::uint32_t>(patch.facets.size()));
    }
    PatchFacet facet;
    facet.normal = plane.normal;
    facet.offset_mm = plane.offset_mm;
    facet.role = role;
    facet.first_corner = static_cast<std::uint32_t>(patch.corners.size());
    facet.corner_count = static_cast<std::uint32_t>(corners.size());
    patch.corners.insert(patch.corners.end(), corners.begin(), corners.end());
    patch.facets.push_back(facet);
    for (const std::uint32_t v : corners) {
      cell.lower = cell.lower.cwiseMin(settled_[v]);
      cell.upper = cell.upper.cwiseMax(settled_[v]);
    }
  }

  const TriangleMesh& mesh_;
  double top_z_ = 0.0;
  double tolerance_mm_ = 0.0;
  double rounding_mm_ = 0.0;
  Polygon outline_;              ///< convex outline, or the convex hull of an outline with notches or holes
  std::vector<Polygon> loops_;   ///< borders of the entrance face: the outer border and those of holes
  std::vector<Polygon> pieces_;  ///< convex pieces of an entrance face with notches or holes; otherwise empty
  std::vector<Side> sides_;
  std::vector<Vec3> settled_;
  std::vector<VertexConstraint> freedom_;
  std::vector<std::array<std::uint32_t, 3>> back_;
};

}  // namespace

ClosedMesh with_openings_closed(const TriangleMesh& mesh) {
  ClosedMesh closed{mesh, 0, 0};
  auto next = borders(mesh.triangles, "an opening of the mesh");
  closed.open_edges = next.size();
  while (!next.empty()) {
    const Ring ring = take_ring(next);
    ++closed.openings;
    if (ring.size() == 3) {
      closed.mesh.triangles.push_back({ring[0], ring[2], ring[1]});
      continue;
    }
    const auto hub = static_cast<std::uint32_t>(closed.mesh.vertices.size());
    closed.mesh.vertices.push_back(ring_centroid(mesh.vertices, ring));
    // The mesh is on the left of the ring. The new triangles run in the opposite direction.
    for (std::size_t i = 0; i < ring.size(); ++i)
      closed.mesh.triangles.push_back({hub, ring[(i + 1) % ring.size()], ring[i]});
  }
  return closed;
}

BoundaryMesh boundary_of(const TriangleMesh& mesh) {
  return {mesh.vertices, mesh.triangles, std::vector<FacetRole>(mesh.triangles.size(), FacetRole::retro_facet)};
}

std::optional<Vec3> mixed_winding(const TriangleMesh& mesh) {
  struct Passes {
    int low_to_high = 0;
    int high_to_low = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Passes> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      Passes& passes = edges[{low, high}];
      ++(t[k] == low ? passes.low_to_high : passes.high_to_low);
    }
  for (const auto& [edge, passes] : edges)
    if ((passes.low_to_high + passes.high_to_low) % 2 == 0 && passes.low_to_high != passes.high_to_low)
      return 0.5 * (mesh.vertices[edge.first] + mesh.vertices[edge.second]);
  return std::nullopt;
}

TriangleMesh with_reversed_orientation(const TriangleMesh& mesh) {
  TriangleMesh turned = mesh;
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  return turned;
}

Part part_of_mesh(const TriangleMesh& mesh, std::optional<double> rounding_mm) {
  return PartBuilder(mesh, rounding_mm).build();
}

}  // namespace retrace::geometry
