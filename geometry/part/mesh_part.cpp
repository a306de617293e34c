#include "geometry/part/mesh_part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "core/error.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

// Relative to the size of the mesh: what single precision leaves of planes.
constexpr double kSinglePrecision = 1e-6;
// Sine of the angle to level or upright below which a triangle is so.
constexpr double kLevel = 1e-4;

using Ring = std::vector<std::uint32_t>;

/// The next vertex along the borders of some triangles, which lie on the left of them. \throw InputError if one
/// branches
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

/// Takes one closed walk out of them.
Ring take_ring(std::map<std::uint32_t, std::uint32_t>& next) {
  Ring ring;
  const std::uint32_t first = next.begin()->first;
  for (std::uint32_t v = first;;) {
    const auto it = next.find(v);
    if (it == next.end()) throw InputError("the mesh has a border that does not close");
    ring.push_back(v);
    v = it->second;
    next.erase(it);
    if (v == first) return ring;
  }
}

class PartBuilder {
 public:
  explicit PartBuilder(const TriangleMesh& mesh) : mesh_(mesh) {
    Vec3 lower = Vec3::Constant(INFINITY);
    Vec3 upper = Vec3::Constant(-INFINITY);
    for (const Vec3& p : mesh.vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    top_z_ = upper.z();
    tolerance_mm_ = kSinglePrecision * (upper - lower).norm();
  }

  Part build() {
    find_entrance();
    find_sides();
    settle_vertices();
    sort_triangles();
    Part part;
    part.outline = outline_;
    part.patches.push_back(make_patch(part));
    part.placements.push_back({0, Vec2::Zero()});
    part.entrance_area_mm2 = area(outline_);
    for (const PatchFacet& facet : part.patches[0].facets)
      if (facet.role == FacetRole::retro_facet) part.retro_facet_area_mm2 += facet_area(part.patches[0], facet);
    return part;
  }

 private:
  struct Side {
    Vec2 normal = Vec2::UnitX();  ///< out of the part
    double offset_mm = 0.0;
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
      throw InputError("the mesh has no entrance face: its highest points must be one level face, towards +z");
    auto next = borders(top, "the entrance face of the mesh");
    const Ring ring = take_ring(next);
    if (!next.empty())
      throw InputError("the entrance face of the mesh must be one face without holes, it has several borders");
    for (std::size_t i = 0; i < ring.size(); ++i) add_corner(ring, i);
    require_convex();
  }

  /// Only what is no point of a straight side.
  void add_corner(const Ring& ring, std::size_t i) {
    const auto at = [&](std::size_t k) { return Vec2(mesh_.vertices[ring[k % ring.size()]].head<2>()); };
    const Vec2 before = outline_.empty() ? at(i + ring.size() - 1) : outline_.back();
    const Vec2 along = at(i + 1) - before;
    const Vec2 to = at(i) - before;
    if (std::abs(along.x() * to.y() - along.y() * to.x()) > tolerance_mm_ * along.norm()) outline_.push_back(at(i));
  }

  void require_convex() const {
    if (outline_.size() < 3) throw InputError("the entrance face of the mesh has no area");
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Vec2& p = outline_[i];
      const Vec2 a = outline_[(i + 1) % outline_.size()] - p;
      const Vec2 b = outline_[(i + 2) % outline_.size()] - outline_[(i + 1) % outline_.size()];
      if (a.x() * b.y() - a.y() * b.x() <= 0.0)
        throw InputError(fmt::format("the outline of the mesh's entrance face must be convex, it is not at ({}, {}) mm",
                                     outline_[(i + 1) % outline_.size()].x(), outline_[(i + 1) % outline_.size()].y()));
    }
  }

  void find_sides() {
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Vec2 along = (outline_[(i + 1) % outline_.size()] - outline_[i]).normalized();
      const Vec2 normal(along.y(), -along.x());
      sides_.push_back({normal, normal.dot(outline_[i])});
    }
  }

  /// Onto the planes they are meant to be on; what lies outside of the entrance face's outline is refused.
  void settle_vertices() {
    settled_ = mesh_.vertices;
    for (Vec3& p : settled_) {
      if (top_z_ - p.z() <= tolerance_mm_) p.z() = top_z_;
      for (const Side& side : sides_) {
        const double beyond = side.normal.dot(p.head<2>()) - side.offset_mm;
        if (beyond > 2.0 * tolerance_mm_)
          throw InputError(
              fmt::format("the mesh must lie below its entrance face, ({}, {}, {}) mm is {:.3g} mm outside", p.x(),
                          p.y(), p.z(), beyond));
      }
      settle(p);
    }
  }

  void settle(Vec3& p) const {
    for (const Vec2& corner : outline_)
      if ((p.head<2>() - corner).norm() <= 2.0 * tolerance_mm_) {
        p.head<2>() = corner;
        return;
      }
    for (const Side& side : sides_) {
      const double beyond = side.normal.dot(p.head<2>()) - side.offset_mm;
      if (std::abs(beyond) <= 2.0 * tolerance_mm_) p.head<2>() -= beyond * side.normal;
    }
  }

  bool is_side(const std::array<std::uint32_t, 3>& triangle) const {
    return std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
      return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) {
        return side.offset_mm - side.normal.dot(settled_[v].head<2>()) <= 2.0 * tolerance_mm_;
      });
    });
  }

  void sort_triangles() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (!is_entrance(t) && !is_side(mesh_.triangles[t])) back_.push_back(mesh_.triangles[t]);
    if (back_.empty()) throw InputError("the mesh has no back below its entrance face");
  }

  static FacetRole role_of(const Vec3& normal) {
    if (normal.head<2>().norm() < kLevel) return FacetRole::flat_back;
    return std::abs(normal.z()) < kLevel ? FacetRole::inner_wall : FacetRole::retro_facet;
  }

  /// \param part gets its heights and sizes
  SurfacePatch make_patch(Part& part) {
    double highest = -INFINITY;
    double lowest = INFINITY;
    for (const auto& t : back_)
      for (const std::uint32_t v : t) {
        highest = std::max(highest, settled_[v].z());
        lowest = std::min(lowest, settled_[v].z());
      }
    if (highest >= top_z_) throw InputError("the mesh must have a plate: its back reaches up to the entrance face");
    for (Vec3& p : settled_) p.z() -= highest;
    part.thickness_mm = top_z_ - highest;
    part.top_mm = 0.0;
    part.element_depth_mm = highest - lowest;
    const Rectangle box = bounding_box(outline_);
    // About as large as what four facets cover.
    part.size_mm = std::clamp(2.0 * std::sqrt(area(outline_) / static_cast<double>(back_.size())),
                              1e-3 * box.size().minCoeff(), box.size().minCoeff());
    part.spec.element = RtpElement{part.size_mm, part.size_mm, 90.0};
    part.spec.thickness_mm = part.thickness_mm;
    return fill_patch(part.size_mm);
  }

  /// Triangles that stand near each other make a cell.
  SurfacePatch fill_patch(double cell_mm) {
    using Bin = std::pair<std::int64_t, std::int64_t>;
    std::map<Bin, std::vector<std::array<std::uint32_t, 3>>> bins;
    for (const auto& t : back_) {
      const Vec3 middle = (settled_[t[0]] + settled_[t[1]] + settled_[t[2]]) / 3.0;
      bins[{static_cast<std::int64_t>(std::floor(middle.y() / cell_mm)),
            static_cast<std::int64_t>(std::floor(middle.x() / cell_mm))}]
          .push_back(t);
    }
    SurfacePatch patch;
    patch.vertices = settled_;
    for (const auto& [bin, triangles] : bins) {
      PatchCell cell;
      cell.first_facet = static_cast<std::uint32_t>(patch.facets.size());
      cell.lower.setConstant(INFINITY);
      cell.upper.setConstant(-INFINITY);
      for (const auto& t : triangles) add_facet(patch, cell, t);
      cell.facet_count = static_cast<std::uint32_t>(patch.facets.size()) - cell.first_facet;
      if (cell.facet_count > 0) patch.cells.push_back(cell);
    }
    return patch;
  }

  void add_facet(SurfacePatch& patch, PatchCell& cell, const std::array<std::uint32_t, 3>& t) const {
    const Vec3 twice = (settled_[t[1]] - settled_[t[0]]).cross(settled_[t[2]] - settled_[t[0]]);
    const double longest = std::max({(settled_[t[1]] - settled_[t[0]]).norm(), (settled_[t[2]] - settled_[t[1]]).norm(),
                                     (settled_[t[0]] - settled_[t[2]]).norm()});
    if (twice.norm() <= 1e-3 * tolerance_mm_ * longest) return;  // a needle: no ray meets it, and it has no normal
    PatchFacet facet;
    facet.normal = twice.normalized();
    facet.offset_mm = facet.normal.dot(settled_[t[0]]);
    facet.role = role_of(facet.normal);
    facet.first_corner = static_cast<std::uint32_t>(patch.corners.size());
    facet.corner_count = 3;
    patch.corners.insert(patch.corners.end(), t.begin(), t.end());
    patch.triangles.push_back(t);
    patch.triangle_facet.push_back(static_cast<std::uint32_t>(patch.facets.size()));
    patch.facets.push_back(facet);
    for (const std::uint32_t v : t) {
      cell.lower = cell.lower.cwiseMin(settled_[v]);
      cell.upper = cell.upper.cwiseMax(settled_[v]);
    }
  }

  const TriangleMesh& mesh_;
  double top_z_ = 0.0;
  double tolerance_mm_ = 0.0;
  Polygon outline_;
  std::vector<Side> sides_;
  std::vector<Vec3> settled_;
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
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : ring) middle += mesh.vertices[v];
    const auto hub = static_cast<std::uint32_t>(closed.mesh.vertices.size());
    closed.mesh.vertices.push_back(middle / static_cast<double>(ring.size()));
    // The border has the mesh on its left; what fills the opening runs the other way.
    for (std::size_t i = 0; i < ring.size(); ++i)
      closed.mesh.triangles.push_back({hub, ring[(i + 1) % ring.size()], ring[i]});
  }
  return closed;
}

BoundaryMesh boundary_of(const TriangleMesh& mesh) {
  return {mesh.vertices, mesh.triangles, std::vector<FacetRole>(mesh.triangles.size(), FacetRole::retro_facet)};
}

TriangleMesh turned_over(const TriangleMesh& mesh) {
  TriangleMesh turned = mesh;
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  return turned;
}

Part part_of_mesh(const TriangleMesh& mesh) {
  return PartBuilder(mesh).build();
}

}  // namespace retrace::geometry
