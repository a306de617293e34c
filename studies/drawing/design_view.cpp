#include "studies/drawing/design_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "design/io/design_json.h"
#include "design/part_of_design.h"
#include "geometry/outline/plan_region.h"
#include "geometry/part/mesh_part.h"

namespace retrace::studies {
namespace {

using geometry::EntranceHeights, geometry::FacetRole, geometry::Part, geometry::SurfacePatch, geometry::Vec2,
    geometry::Vec3;

// Tolerance of the cosine between the normals of two neighbouring triangles. Within it, there is no edge between them.
constexpr double kSameDirection = 1e-6;

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

Vec3 normal_of(const std::vector<Vec3>& vertices, const Triangle& t) {
  return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]).normalized();
}

/// Returns the edges between triangles with different normals, and edges that belong to only one triangle.
std::vector<Edge> edges_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  struct Beside {
    Vec3 normal = Vec3::Zero();
    bool is_smooth = false;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Beside> known;
  for (const Triangle& t : triangles) {
    const Vec3 normal = normal_of(vertices, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [it, is_new] = known.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), Beside{normal, false});
      if (!is_new && normal.dot(it->second.normal) > 1.0 - kSameDirection) it->second.is_smooth = true;
    }
  }
  std::vector<Edge> edges;
  for (const auto& [ends, beside] : known)
    if (!beside.is_smooth) edges.push_back({ends.first, ends.second});
  return edges;
}

/// Appends a convex face. The face is not part of a SurfacePatch.
/// \param has_edges true if the outline of the face is drawn
void add_face(DesignView& view, const std::vector<Vec3>& corners, FacetRole role, bool has_edges = true) {
  const auto first = static_cast<std::uint32_t>(view.mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(corners.size());
  view.mesh.vertices.insert(view.mesh.vertices.end(), corners.begin(), corners.end());
  for (std::uint32_t k = 0; k + 2 < count; ++k) {
    view.mesh.triangles.push_back({first, first + k + 1, first + k + 2});
    view.mesh.roles.push_back(role);
  }
  for (std::uint32_t k = 0; has_edges && k < count; ++k) view.edges.push_back({first + k, first + (k + 1) % count});
}

void add_patch(DesignView& view, const SurfacePatch& patch, const std::vector<Edge>& edges, const Vec2& offset) {
  const auto first = static_cast<std::uint32_t>(view.mesh.vertices.size());
  for (const Vec3& v : patch.vertices) view.mesh.vertices.emplace_back(v.x() + offset.x(), v.y() + offset.y(), v.z());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const auto& [a, b, c] = patch.triangles[t];
    view.mesh.triangles.push_back({first + a, first + b, first + c});
    view.mesh.roles.push_back(patch.facets[patch.triangle_facet[t]].role);
  }
  for (const Edge& e : edges) view.edges.push_back({first + e[0], first + e[1]});
  for (const std::vector<std::uint32_t>& wall : patch.border_walls) {
    std::vector<Vec3> corners;
    for (const std::uint32_t k : wall) corners.push_back(view.mesh.vertices[first + k]);
    add_face(view, corners, FacetRole::border_wall);
  }
}

/// Returns a design with only the first elements of a large or infinite array.
design::Design piece_of(const design::Design& design, std::vector<std::string>& remarks) {
  design::Design piece = design;
  if (!design.elements() || design.mask() || design.facet_planes()) return piece;
  geometry::PartSpec& spec = piece.part();
  if (spec.array.arrangement == geometry::Arrangement::single) return piece;
  const Vec2 size = geometry::bounding_box(geometry::aperture_outline(spec.element)).size();
  const Vec2 pitch = size + Vec2(spec.array.x_gap_mm, spec.array.y_gap_mm);
  const bool infinite = spec.array.extent == geometry::Extent::infinite;
  const Vec2 count = Vec2(spec.array.x_length_mm, spec.array.y_length_mm).cwiseQuotient(pitch);
  if (!infinite && count.maxCoeff() <= kMaxElementsAcross) return piece;
  const Vec2 wanted = kExcerptElements * pitch;
  spec.array.extent = geometry::Extent::finite;
  spec.array.outline.reset();
  spec.array.x_length_mm = infinite ? wanted.x() : std::min(spec.array.x_length_mm, wanted.x());
  spec.array.y_length_mm = infinite ? wanted.y() : std::min(spec.array.y_length_mm, wanted.y());
  spec.array.x_offset_mm = spec.array.y_offset_mm = 0.0;
  remarks.emplace_back("a few elements of the array");
  if (spec.thickness_mm > wanted.minCoeff() && !spec.substrate) {
    const double top_mm = geometry::element_top_mm(spec.element, spec.angle_errors);
    spec.thickness_mm = std::max(1.5 * top_mm, 0.3 * wanted.minCoeff());
    remarks.emplace_back("the plate is thicker than shown");
  }
  return piece;
}

/// Number of cells of the grid along the longer side of a part with which its curved entrance face is drawn.
constexpr int kEntranceCells = 220;

/// Returns the lower borders of a part's sides, as lines between vertices of its back surface. If the back is plane,
/// returns the outline of the part at z = 0.
std::vector<std::vector<Vec3>> lower_borders_of_sides(const Part& part) {
  std::vector<std::vector<Vec3>> borders;
  for (const geometry::Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    const Vec3 shift(placement.offset_mm.x(), placement.offset_mm.y(), 0.0);
    for (const std::vector<std::uint32_t>& rim : patch.border_rim) {
      std::vector<Vec3>& border = borders.emplace_back();
      for (const std::uint32_t k : rim) border.push_back(patch.vertices[k] + shift);
    }
  }
  if (!borders.empty()) return borders;
  std::vector<Vec3>& border = borders.emplace_back();
  for (std::size_t k = 0; k <= part.outline.size(); ++k) {
    const Vec2& p = part.outline[k % part.outline.size()];
    border.emplace_back(p.x(), p.y(), 0.0);
  }
  return borders;
}

/// Returns true if a point is a corner of an outline with a change of direction by more than 20 degrees.
bool is_sharp_corner(const geometry::Polygon& outline, const Vec2& point) {
  constexpr double kCosineOfLimit = 0.94;
  const std::size_t count = outline.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec2 before = (outline[k] - outline[(k + count - 1) % count]).normalized();
    const Vec2 after = outline[(k + 1) % count] - outline[k];
    if ((outline[k] - point).norm() < 1e-6 * after.norm()) return before.dot(after.normalized()) < kCosineOfLimit;
  }
  return false;
}

/// Appends the polygons of a side of a part above one line of its lower border. The side is divided into strips with a
/// width of at most `cell_mm`.
/// \param above returns the point of the entrance face above a point in plan
template <class Above>
void add_side(DesignView& view, const Vec3& from, const Vec3& to, double cell_mm, const Above& above) {
  const Vec3 along = to - from;
  const int steps = std::max(1, static_cast<int>(std::ceil(along.head<2>().norm() / cell_mm)));
  const auto first = static_cast<std::uint32_t>(view.mesh.vertices.size());
  for (int s = 0; s <= steps; ++s) {
    const Vec3 p = from + static_cast<double>(s) / steps * along;
    view.mesh.vertices.push_back(p);
    view.mesh.vertices.push_back(above(p.head<2>()));
  }
  for (int s = 0; s < steps; ++s) {
    const std::uint32_t low = first + 2 * static_cast<std::uint32_t>(s);
    for (const Triangle& t : {Triangle{low, low + 2, low + 3}, Triangle{low, low + 3, low + 1}}) {
      view.mesh.triangles.push_back(t);
      view.mesh.roles.push_back(FacetRole::side);
    }
    view.edges.push_back({low, low + 2});
    view.edges.push_back({low + 1, low + 3});
  }
}

/// Appends the sides of a part and its curved entrance face, which is sampled on a grid.
void add_curved_entrance(DesignView& view, const Part& part, const EntranceHeights& height) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const double cell_mm = box.size().maxCoeff() / kEntranceCells;
  const Vec2 centre = box.centre();
  const auto above = [&](const Vec2& p) {
    // Points are moved inwards a little, because the face may end at the outline.
    const double z = height(centre + (1.0 - 1e-7) * (p - centre));
    return Vec3(p.x(), p.y(), std::isfinite(z) ? z : part.thickness_mm);
  };
  for (double y = box.lower.y(); y < box.upper.y() - 1e-9 * cell_mm; y += cell_mm)
    for (double x = box.lower.x(); x < box.upper.x() - 1e-9 * cell_mm; x += cell_mm) {
      const geometry::Polygon cell =
          geometry::clip(part.outline, geometry::Rectangle{{x, y}, {x + cell_mm, y + cell_mm}}, 1e-9 * cell_mm);
      if (cell.size() < 3) continue;
      const auto first = static_cast<std::uint32_t>(view.mesh.vertices.size());
      for (const Vec2& p : cell) view.mesh.vertices.push_back(above(p));
      for (std::uint32_t k = 0; k + 2 < cell.size(); ++k) {
        view.mesh.triangles.push_back({first, first + k + 1, first + k + 2});
        view.mesh.roles.push_back(FacetRole::entrance);
      }
    }
  for (const std::vector<Vec3>& border : lower_borders_of_sides(part))
    for (std::size_t k = 0; k + 1 < border.size(); ++k) {
      const auto first = static_cast<std::uint32_t>(view.mesh.vertices.size());
      add_side(view, border[k], border[k + 1], cell_mm, above);
      if (is_sharp_corner(part.outline, border[k].head<2>())) view.edges.push_back({first, first + 1});
    }
  view.has_curved_entrance = true;
}

/// Returns true if the elements are so many that the view of a whole part does not show them.
bool has_very_small_elements(const Part& part) {
  return part.size_mm * kMaxElementsAcross < geometry::bounding_box(part.outline).size().maxCoeff();
}

/// Returns a part with a plane back.
Part with_plane_back(const Part& part) {
  Part plane = part;
  plane.placements.clear();
  return plane;
}

DesignView view_of_mesh(const design::Design& design) {
  DesignView view;
  view.mesh = geometry::boundary_of(design::mesh_of_design(design, nullptr));
  view.edges = edges_of(view.mesh.vertices, view.mesh.triangles);
  return view;
}

}  // namespace

DesignView view_of(const Part& part, const EntranceHeights& entrance_height) {
  DesignView view;
  std::vector<std::vector<Edge>> edges;
  for (const SurfacePatch& patch : part.patches) edges.push_back(edges_of(patch.vertices, patch.triangles));
  for (const geometry::Placement& placement : part.placements)
    add_patch(view, part.patches[placement.patch], edges[placement.patch], placement.offset_mm);
  if (entrance_height) {
    add_curved_entrance(view, part, entrance_height);
    return view;
  }
  const bool has_pieces = !part.entrance_pieces.empty();
  for (const geometry::PolygonLoop& border :
       has_pieces ? part.spec.array.outline->whole.borders : std::vector<geometry::PolygonLoop>{part.outline}) {
    const auto at = [&](std::size_t k, double z) {
      const Vec2& p = border[k % border.size()];
      return Vec3(p.x(), p.y(), z);
    };
    for (std::size_t k = 0; k < border.size(); ++k)
      add_face(view, {at(k, 0.0), at(k + 1, 0.0), at(k + 1, part.thickness_mm), at(k, part.thickness_mm)},
               FacetRole::side);
  }
  for (const geometry::Polygon& piece : geometry::entrance_polygons(part)) {
    std::vector<Vec3> face;
    for (const Vec2& p : piece) face.emplace_back(p.x(), p.y(), part.thickness_mm);
    add_face(view, face, FacetRole::entrance, !has_pieces);
  }
  return view;
}

DesignView view_of(const design::Design& design) {
  std::vector<std::string> remarks;
  DesignView view;
  if (!design.elements() && !design.zoned()) {
    view = view_of_mesh(design);
  } else {
    const design::Design piece = piece_of(design, remarks);
    view = view_of(design::part_of_design(piece, nullptr));
  }
  view.title = design::short_name(design);
  view.remarks = std::move(remarks);
  return view;
}

DesignView view_of(const design::Design& design, const Part& part, const EntranceHeights& entrance_height) {
  const bool omits_elements = has_very_small_elements(part);
  DesignView view = view_of(omits_elements ? with_plane_back(part) : part, entrance_height);
  if (omits_elements) {
    std::vector<Vec3> back;
    for (auto p = part.outline.rbegin(); p != part.outline.rend(); ++p) back.emplace_back(p->x(), p->y(), 0.0);
    add_face(view, back, FacetRole::flat_back);
    view.remarks.emplace_back("the elements are too small to be shown");
  }
  view.title = design::short_name(design);
  return view;
}

}  // namespace retrace::studies
