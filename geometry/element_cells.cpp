#include <cmath>
#include <numbers>

#include "geometry/lattice.h"

namespace retrace::geometry {
namespace {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// Point at `angle_deg` on the circle of the cell's rim.
Vec2 rim_point(const Vec2& centre, double radius_mm, double angle_deg) {
  const double a = angle_deg * std::numbers::pi / 180.0;
  return centre + radius_mm * Vec2(std::cos(a), std::sin(a));
}

double rtp_depth(const RtpElement& e) {
  return 0.5 * e.base_mm / std::tan(0.5 * e.apex_angle_deg * std::numbers::pi / 180.0);
}

// A cube of edge a: its rim circle has radius R = a sqrt(2/3); the far ends of the dihedral edges rise a/sqrt(3) above
// the apex, the remaining corners of the full cube twice that.
double rise_of_dihedral_edge(double aperture_mm) {
  return 0.5 * aperture_mm / std::numbers::sqrt2;
}

/// The plane over the xy plane through the apex (at `centre`, `apex_height`) that contains the two dihedral edges at
/// `angle_deg` and `angle_deg` + 120, each rising by `rise` over the radius R.
HeightPlane cube_facet_plane(const Vec2& centre, double radius_mm, double apex_height, double rise, double angle_deg) {
  // By symmetry the plane climbs along the bisector; the edges lie 60 degrees off it.
  const Vec2 bisector = rim_point(Vec2::Zero(), 1.0, angle_deg + 60.0);
  HeightPlane plane;
  plane.slope = bisector * (rise / (radius_mm * 0.5));
  plane.height_mm = apex_height - plane.slope.dot(centre);
  return plane;
}

}  // namespace

Cell rtp_cell(const RtpElement& element, const Vec2& corner, bool turned) {
  const Eigen::Index across = turned ? 1 : 0;
  Vec2 size(element.base_mm, element.width_mm);
  if (turned) std::swap(size.x(), size.y());
  const double depth = rtp_depth(element);
  const double steepness = depth / (0.5 * size[across]);
  const double root = corner[across] + 0.5 * size[across];

  Cell cell;
  cell.outline = to_polygon({corner, corner + size});
  for (const double side : {-1.0, 1.0}) {
    Rectangle half{corner, corner + size};
    (side < 0.0 ? half.upper : half.lower)[across] = root;
    CellFacet facet;
    facet.outline = to_polygon(half);
    facet.plane.slope[across] = side * steepness;
    facet.plane.height_mm = -depth - facet.plane.slope[across] * root;
    cell.facets.push_back(std::move(facet));
  }
  return cell;
}

Cell hexagonal_cube_cell(const HexagonalCube& element, const Vec2& centre) {
  const double radius = 0.5 * element.aperture_mm;
  const double rise = rise_of_dihedral_edge(element.aperture_mm);
  Cell cell;
  for (int corner = 0; corner < 6; ++corner) cell.outline.push_back(rim_point(centre, radius, 60.0 * corner));
  for (int k = 0; k < 3; ++k) {
    const auto at = [&](int corner) { return cell.outline[static_cast<std::size_t>(corner % 6)]; };
    cell.facets.push_back({{centre, at(2 * k), at(2 * k + 1), at(2 * k + 2)},
                           cube_facet_plane(centre, radius, -2.0 * rise, rise, 120.0 * k)});
  }
  return cell;
}

Cell triangular_cube_cell(const TriangularCube& element, const Vec2& centre, bool turned) {
  const double radius = 0.5 * element.aperture_mm;
  const double rise = rise_of_dihedral_edge(element.aperture_mm);
  const double start_deg = turned ? 180.0 : 0.0;
  Cell cell;
  for (int k = 0; k < 3; ++k) cell.outline.push_back(rim_point(centre, radius, start_deg + 120.0 * k));
  for (std::size_t k = 0; k < 3; ++k) {
    cell.facets.push_back({{centre, cell.outline[k], cell.outline[(k + 1) % 3]},
                           cube_facet_plane(centre, radius, -rise, rise, start_deg + 120.0 * static_cast<double>(k))});
  }
  return cell;
}

double element_depth_mm(const Element& element) {
  return std::visit(Overloaded{[](const RtpElement& e) { return rtp_depth(e); },
                               [](const HexagonalCube& e) { return 2.0 * rise_of_dihedral_edge(e.aperture_mm); },
                               [](const TriangularCube& e) { return rise_of_dihedral_edge(e.aperture_mm); }},
                    element);
}

Polygon aperture_outline(const Element& element) {
  Polygon outline =
      std::visit(Overloaded{[](const RtpElement& e) { return rtp_cell(e, Vec2::Zero()).outline; },
                            [](const HexagonalCube& e) { return hexagonal_cube_cell(e, Vec2::Zero()).outline; },
                            [](const TriangularCube& e) { return triangular_cube_cell(e, Vec2::Zero()).outline; }},
                 element);
  const Vec2 corner = bounding_box(outline).lower;
  for (Vec2& p : outline) p -= corner;
  return outline;
}

}  // namespace retrace::geometry
