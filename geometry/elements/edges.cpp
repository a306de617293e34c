// Rounds and chamfers the edges of elements. An edge is replaced by a row of plane strips, and a corner at which edges
// meet is replaced by small plane faces.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/elements/edges.h"
#include "geometry/elements/plane_polygon.h"

namespace retrace::geometry {

namespace {

// Minimum width of a facet (kSliver) and of an edge (kMinRelativeEdgeWidth), relative to an element's size. Narrower
// facets result from rounding errors and are omitted. Narrower edges are not built.
constexpr double kSliver = 1e-9;
constexpr double kMinRelativeEdgeWidth = 1e-7;
// Number of times that the spherical triangle at a corner is subdivided. Two subdivisions give 16 faces.
constexpr int kSphereHalvings = 2;
// A rim is rounded only if the angle between its two planes is at least this value (approximately, in radians). A rim
// is the edge between an element and its neighbour.
constexpr double kMinEdgeAngle = 1e-3;

double size_of(const Polygon& outline) {
  return bounding_box(outline).size().minCoeff();
}

Vec3 outward_normal(const HeightPlane& plane) {
  return Vec3(plane.slope.x(), plane.slope.y(), -1.0).normalized();
}

Vec3 lifted(const Vec2& p, const HeightPlane& plane) {
  return {p.x(), p.y(), plane.at(p)};
}

CellFacet face_through(const Vec3& point, const Vec3& normal) {
  CellFacet face;
  face.is_edge = true;
  face.plane.slope = -normal.head<2>() / normal.z();
  face.plane.height_mm = point.z() - face.plane.slope.dot(point.head<2>());
  return face;
}

bool is_sliver(const Polygon& polygon, double width_mm) {
  if (polygon.size() < 3) return true;
  return area(polygon) <= 0.5 * width_mm * bounding_box(polygon).size().norm();
}

/// Returns the upper envelope of several planes over an outline.
std::vector<CellFacet> upper_envelope(const Polygon& outline, const std::vector<CellFacet>& planes, double sliver_mm) {
  std::vector<CellFacet> facets = upper_envelope_of(outline, planes);
  std::erase_if(facets, [&](const CellFacet& facet) { return is_sliver(facet.outline, sliver_mm); });
  return facets;
}

/// Clips a facet to the planes that are below it, and adds the resulting facets.
void add_lower_envelope(std::vector<CellFacet>& facets, const CellFacet& facet, const std::vector<CellFacet>& planes,
                        double sliver_mm) {
  std::vector<CellFacet> cutting;
  for (const CellFacet& plane : planes)
    if (std::any_of(facet.outline.begin(), facet.outline.end(),
                    [&](const Vec2& p) { return plane.plane.at(p) < facet.plane.at(p); }))
      cutting.push_back(plane);
  cutting.push_back(facet);
  for (std::size_t i = 0; i < cutting.size(); ++i) {
    CellFacet piece = cutting[i];
    piece.outline = facet.outline;
    for (std::size_t j = 0; j < cutting.size() && !piece.outline.empty(); ++j)
      if (j != i) piece.outline = where_higher(piece.outline, cutting[j].plane, cutting[i].plane);
    if (!is_sliver(piece.outline, sliver_mm)) facets.push_back(std::move(piece));
  }
}

/// Shape of edges of one kind.
struct Rounding {
  double radius_mm = 0.0;
  double chamfer_mm = 0.0;
  int chords = 0;
  double side = 1.0;  ///< 1 for a root, a convex edge of the material; -1 for a rim, a concave edge
};

Rounding root_rounding(const EdgeShape& edges) {
  return {edges.root_radius_mm, edges.root_chamfer_mm, edges.chords, 1.0};
}

Rounding rim_rounding(const EdgeShape& edges) {
  return {edges.rim_radius_mm, edges.rim_chamfer_mm, edges.chords, -1.0};
}

/// Adds strips over the edge of two planes. `on_edge` is a point of this edge. The strips approximate a circle that is
/// tangent to both planes. They extend from the first plane to the second, or only to the centre if `half` is true. A
/// chamfer is a single strip.
void add_arc(std::vector<CellFacet>& planes, const Vec3& normal_a, const Vec3& normal_b, const Vec3& on_edge,
             const Rounding& how, bool half) {
  const double between = std::acos(std::clamp(normal_a.dot(normal_b), -1.0, 1.0));
  const bool is_chamfer = how.chamfer_mm > 0.0;
  const int chords = is_chamfer ? 1 : how.chords;
  const double radius_mm = how.side * (is_chamfer ? 0.5 * how.chamfer_mm / std::sin(0.5 * between) : how.radius_mm);
  const Vec3 centre = on_edge - radius_mm * (normal_a + normal_b) / (1.0 + normal_a.dot(normal_b));
  const double offset_mm = radius_mm * std::cos(0.5 * between / chords);
  for (int k = 0; k < (half && !is_chamfer ? chords / 2 : chords); ++k) {
    const double share = (k + 0.5) / chords;
    const Vec3 normal =
        (std::sin((1.0 - share) * between) * normal_a + std::sin(share * between) * normal_b) / std::sin(between);
    planes.push_back(face_through(centre + offset_mm * normal, normal));
  }
}

/// Adds faces whose corners are on a sphere. The faces cover the spherical triangle between three directions.
void add_sphere_faces(std::vector<CellFacet>& planes, const Vec3& centre, double radius_mm,
                      const std::array<Vec3, 3>& triangle, int halvings) {
  const auto& [a, b, c] = triangle;
  if (halvings == 0) {
    Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(a) < 0.0) normal = -normal;
    planes.push_back(face_through(centre + radius_mm * a, normal));
    return;
  }
  const Vec3 ab = (a + b).normalized();
  const Vec3 bc = (b + c).normalized();
  const Vec3 ca = (c + a).normalized();
  for (const std::array<Vec3, 3>& quarter :
       {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
    add_sphere_faces(planes, centre, radius_mm, quarter, halvings - 1);
}

/// Adds a ball, approximated by plane faces, where three rounded edges meet. It touches the three planes that meet in
/// `corner`. No ball is added to chamfers.
void add_sphere(std::vector<CellFacet>& planes, const std::array<Vec3, 3>& normals, const Vec3& corner,
                const Rounding& how) {
  // minimum volume of the parallelepiped of the three normals; if it is smaller, the planes nearly share a line, and no
  // ball is added
  constexpr double least_volume = 0.05;
  if (how.radius_mm <= 0.0) return;
  Eigen::Matrix3d rows;
  for (Eigen::Index k = 0; k < 3; ++k) rows.row(k) = normals[static_cast<std::size_t>(k)];
  if (std::abs(rows.determinant()) < least_volume) return;
  const double radius_mm = how.side * how.radius_mm;
  const Vec3 centre = corner - radius_mm * rows.inverse() * Vec3::Ones();
  add_sphere_faces(planes, centre, radius_mm, normals, kSphereHalvings);
}

/// Returns the point at which all planes of an element meet: its apex, or a point of its roof edge.
Vec3 lowest_point(const Cell& cell) {
  const HeightPlane& a = cell.facets[0].plane;
  const HeightPlane& b = cell.facets[1].plane;
  Eigen::Matrix2d slopes;
  Vec2 heights(b.height_mm - a.height_mm, 0.0);
  slopes.row(0) = a.slope - b.slope;
  if (cell.facets.size() > 2) {
    slopes.row(1) = a.slope - cell.facets[2].plane.slope;
    heights.y() = cell.facets[2].plane.height_mm - a.height_mm;
  } else {
    // direction across the roof; any point of the roof edge may be returned
    slopes.row(1) = Vec2(-slopes(0, 1), slopes(0, 0));
  }
  return lifted(slopes.fullPivLu().solve(heights), a);
}

/// Returns the planes of the facets and of the rounded roots. The element is their upper envelope.
std::vector<CellFacet> planes_with_roots(const Cell& cell, const EdgeShape& edges) {
  std::vector<CellFacet> planes = cell.facets;
  if (!edges.rounds_roots()) return planes;
  const Vec3 lowest = lowest_point(cell);
  const std::size_t n = cell.facets.size();
  const auto normal = [&](std::size_t k) { return outward_normal(cell.facets[k % n].plane); };
  for (std::size_t k = 0; k < (n == 2 ? 1 : n); ++k)
    add_arc(planes, normal(k), normal(k + 1), lowest, root_rounding(edges), false);
  if (n == 3) add_sphere(planes, {normal(0), normal(1), normal(2)}, lowest, root_rounding(edges));
  return planes;
}

/// Assumption about the surface beyond a rim: the element's mirror image, or horizontal land (surface without
/// elements).
enum class Beyond { mirror_image, land };

/// Rim of a facet: a point on it and the normal of the plane beyond it.
struct Rim {
  Vec3 from;
  Vec3 normal_beyond;
};

/// Returns the rim over a side of a facet's outline. Returns nothing for roots and gables, and if the facet descends
/// towards this side.
std::optional<Rim> rim_over(const Cell& cell, const CellFacet& facet, std::size_t side, Beyond beyond) {
  const Vec2& a = facet.outline[side];
  const Vec2& b = facet.outline[(side + 1) % facet.outline.size()];
  const double tolerance_mm = kSliver * size_of(cell.outline);
  const auto on_one_line = [&](std::size_t k) {
    const Vec2& from = cell.outline[k];
    const Vec2 along = (cell.outline[(k + 1) % cell.outline.size()] - from).normalized();
    const auto off = [&](const Vec2& p) { return std::abs(along.x() * (p - from).y() - along.y() * (p - from).x()); };
    return off(a) <= tolerance_mm && off(b) <= tolerance_mm;
  };
  bool is_border = false;
  for (std::size_t k = 0; k < cell.outline.size(); ++k) is_border = is_border || on_one_line(k);
  if (!is_border) return std::nullopt;
  const Vec3 normal = outward_normal(facet.plane);
  const Vec2 along = (b - a).normalized();
  const Vec3 outward(along.y(), -along.x(), 0.0);
  if (normal.dot(outward) < kMinEdgeAngle) return std::nullopt;
  return Rim{lifted(a, facet.plane),
             beyond == Beyond::land ? Vec3(-Vec3::UnitZ()) : Vec3(normal - 2.0 * normal.dot(outward) * outward)};
}

/// Adds the strips that round one side of a rim. Their number is the same whether the rim continues as a mirror image
/// or ends on land.
void add_rim_arc(std::vector<CellFacet>& planes, const Vec3& normal, const Rim& rim, const EdgeShape& edges,
                 Beyond beyond) {
  Rounding how = rim_rounding(edges);
  if (beyond == Beyond::land) how.chords /= 2;
  add_arc(planes, normal, rim.normal_beyond, rim.from, how, beyond == Beyond::mirror_image);
}

/// Returns the planes that round the rims of one facet. Over this facet, the surface is nowhere above these planes.
std::vector<CellFacet> rim_planes(const Cell& cell, const CellFacet& facet, const EdgeShape& edges, Beyond beyond) {
  std::vector<CellFacet> planes;
  const Vec3 normal = outward_normal(facet.plane);
  const std::size_t sides = facet.outline.size();
  for (std::size_t k = 0; k < sides; ++k) {
    const std::optional<Rim> rim = rim_over(cell, facet, k, beyond);
    if (!rim) continue;
    add_rim_arc(planes, normal, *rim, edges, beyond);
    const std::optional<Rim> next = rim_over(cell, facet, (k + 1) % sides, beyond);
    if (next) add_sphere(planes, {normal, rim->normal_beyond, next->normal_beyond}, next->from, rim_rounding(edges));
  }
  return planes;
}

EdgeShape without_negligible(EdgeShape edges, double size_mm) {
  for (double* width_mm : {&edges.root_radius_mm, &edges.root_chamfer_mm, &edges.rim_radius_mm, &edges.rim_chamfer_mm})
    if (*width_mm < kMinRelativeEdgeWidth * size_mm) *width_mm = 0.0;
  return edges;
}

/// Returns Beyond::land if land separates a prism from its neighbours, and Beyond::mirror_image otherwise.
Beyond beyond_rims(const PartSpec& spec, bool rotated) {
  return (rotated ? spec.array.y_gap_mm : spec.array.x_gap_mm) > 0.0 ? Beyond::land : Beyond::mirror_image;
}

}  // namespace

Cell with_edges(const Cell& cell, const PartSpec& spec) {
  if (!cell.is_element) return cell;
  const double size_mm = size_of(cell.outline);
  const EdgeShape edges = without_negligible(spec.edges, size_mm);
  if (edges.is_sharp()) return cell;
  const double sliver_mm = kSliver * size_mm;
  const std::vector<CellFacet> planes = planes_with_roots(cell, edges);
  Cell rounded = cell;
  if (!edges.rounds_rims()) {
    rounded.facets = upper_envelope(cell.outline, planes, sliver_mm);
    return rounded;
  }
  rounded.facets.clear();
  for (const CellFacet& facet : cell.facets) {
    const std::vector<CellFacet> rims = rim_planes(cell, facet, edges, beyond_rims(spec, cell.rotated));
    for (const CellFacet& piece : upper_envelope(facet.outline, planes, sliver_mm))
      add_lower_envelope(rounded.facets, piece, rims, sliver_mm);
  }
  return rounded;
}

Cell land_cell(const Rectangle& rectangle, const PartSpec& spec, Eigen::Index axis, bool lower, bool upper) {
  Cell cell;
  cell.is_element = false;
  cell.outline = to_polygon(rectangle);
  const CellFacet land{cell.outline, HeightPlane{}, false};
  const Cell element = element_cell(spec.element, spec.angle_errors);
  const EdgeShape edges = without_negligible(spec.edges, size_of(element.outline));
  std::vector<CellFacet> planes;
  // The land is between two prisms. The second facet of one prism ends at the lower side of the land, and the first
  // facet of the next prism ends at the upper side.
  for (const bool from_below : {true, false}) {
    if (!edges.rounds_rims() || !(from_below ? lower : upper)) continue;
    const double steepness = element.facets[from_below ? 1 : 0].plane.slope.norm();
    Vec3 normal = -Vec3::UnitZ();
    normal[axis] = from_below ? steepness : -steepness;
    const Vec2& corner = from_below ? rectangle.lower : rectangle.upper;
    add_rim_arc(planes, normal.normalized(), {Vec3(corner.x(), corner.y(), 0.0), -Vec3::UnitZ()}, edges, Beyond::land);
  }
  add_lower_envelope(cell.facets, land, planes, kSliver * size_of(element.outline));
  return cell;
}

double rim_reach_over_land_mm(const PartSpec& spec) {
  double steepest = 0.0;
  for (const CellFacet& facet : element_cell(spec.element, spec.angle_errors).facets)
    steepest = std::max(steepest, std::atan(facet.plane.slope.norm()));
  return spec.edges.rim_radius_mm * std::tan(0.5 * steepest) +
         0.5 * spec.edges.rim_chamfer_mm / std::cos(0.5 * steepest);
}

double edge_fraction(const Cell& cell) {
  double on_edges = 0.0;
  for (const CellFacet& facet : cell.facets)
    if (facet.is_edge) on_edges += area(facet.outline);
  return on_edges / area(cell.outline);
}

}  // namespace retrace::geometry
