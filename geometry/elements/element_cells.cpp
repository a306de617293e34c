#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/overloaded.h"
#include "geometry/direction.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/ruled_pattern.h"
#include "geometry/outline/plan_region.h"

namespace retrace::geometry {
namespace {

double rad_from_arcmin(double arcmin) {
  return arcmin / 60.0 * std::numbers::pi / 180.0;
}

/// Returns the point at `angle_deg` on a circle about `centre`.
Vec2 rim_point(const Vec2& centre, double radius_mm, double angle_deg) {
  return centre + radius_mm * direction_at(Angle::from_deg(angle_deg));
}

/// Angles between the vertical and each facet of a prism.
struct HalfAngles {
  std::array<double, 2> rad{};
  double mean_rad = 0.0;
};

HalfAngles half_angles(const RtpElement& e, const AngleErrors& errors) {
  const double half_deg = 0.5 * (e.apex_angle_deg + errors.dihedral_error_arcmin[0] / 60.0);
  HalfAngles half;
  for (const std::size_t k : {0U, 1U})
    half.rad[k] = half_deg * std::numbers::pi / 180.0 + rad_from_arcmin(errors.facet_tilt_arcmin[k]);
  half.mean_rad = 0.5 * (half.rad[0] + half.rad[1]);
  return half;
}

double rtp_depth(const RtpElement& e, const AngleErrors& errors) {
  return 0.5 * e.base_mm / std::tan(half_angles(e, errors).mean_rad);
}

// Returns the height of the outer ends of the dihedral edges above the apex. A cube with the edge length a has a rim
// circle with the radius a sqrt(2/3). The ends of its dihedral edges are a / sqrt(3) above the apex, and the other
// corners of the full cube are twice as high.
double rise_of_dihedral_edge(double aperture_mm) {
  return 0.5 * aperture_mm / std::numbers::sqrt2;
}

/// Returns the slopes of the three facet planes of a cube corner that is neither rotated nor canted. Facet k is between
/// the dihedral edges k and k + 1.
std::array<Vec2, 3> upright_cube_slopes(const AngleErrors& errors) {
  std::array<Vec2, 3> slopes;
  for (std::size_t k = 0; k < 3; ++k)
    slopes[k] = rim_point(Vec2::Zero(), std::numbers::sqrt2, 120.0 * static_cast<double>(k) + 60.0);
  if (errors == AngleErrors{}) return slopes;

  Eigen::Matrix3d normals;  // outward normals of the part, one per column
  Eigen::Matrix3d products = Eigen::Matrix3d::Identity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto index = static_cast<std::size_t>(k);
    normals.col(k) << slopes[index], -1.0;
    normals.col(k).normalize();
    // If the angle between two facets is 90 degrees + e, the angle between their outward normals is 90 degrees - e.
    const Eigen::Index before = (k + 2) % 3;
    products(before, k) = products(k, before) = std::sin(rad_from_arcmin(errors.dihedral_error_arcmin[index]));
  }
  // Many sets of unit normals have these scalar products. The set that is nearest to the nominal normals is chosen.
  // This is the inverse of symmetric orthogonalisation (Loewdin, J. Chem. Phys. 18, 365 (1950)). It rotates the two
  // facets of an edge by equal angles.
  normals *= Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(products).operatorSqrt();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 normal = normals.col(static_cast<Eigen::Index>(k));
    const double inclination = std::atan2(normal.head<2>().norm(), -normal.z());
    slopes[k] = std::tan(inclination - rad_from_arcmin(errors.facet_tilt_arcmin[k])) * normal.head<2>().normalized();
  }
  return slopes;
}

/// Returns the slopes of the facet planes of a canted cube corner. Errors of angle are applied first, then the whole
/// cube is rotated about its apex.
std::array<Vec2, 3> cube_slopes(const AngleErrors& errors, const Cant& cant) {
  std::array<Vec2, 3> slopes = upright_cube_slopes(errors);
  if (cant.deg == 0.0) return slopes;
  const Vec2 towards = rim_point(Vec2::Zero(), 1.0, cant.azimuth_deg);
  const Eigen::Matrix3d turn = rotation_about(Vec3(-towards.y(), towards.x(), 0.0), Angle::from_deg(cant.deg));
  for (Vec2& slope : slopes) {
    const Vec3 normal = turn * Vec3(slope.x(), slope.y(), -1.0);
    slope = -normal.head<2>() / normal.z();
  }
  return slopes;
}

/// Finds the point at which a ray from `centre` leaves an outline around it. Returns the index of the previous corner
/// plus the fraction of the distance to the next corner. If the point is a corner within rounding errors, returns the
/// index of this corner.
double exit_of_ray(const Polygon& outline, const Vec2& centre, const Vec2& direction) {
  constexpr double rounding = 1e-10;
  const auto left_of = [&](const Vec2& p) {
    return direction.x() * (p.y() - centre.y()) - direction.y() * (p.x() - centre.x());
  };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const double a = left_of(outline[k]);
    const double b = left_of(outline[(k + 1) % outline.size()]);
    if (a > 0.0 || b <= 0.0) continue;
    const double share = a / (a - b);
    if (share < rounding) return static_cast<double>(k);
    return share > 1.0 - rounding ? static_cast<double>((k + 1) % outline.size()) : static_cast<double>(k) + share;
  }
  return 0.0;
}

/// Returns a cube corner from the slopes of its facet planes, which pass through the apex. The facets end where their
/// planes intersect.
Cell cube_cell(Polygon outline, const Vec2& centre, double apex_height, const std::array<Vec2, 3>& slopes) {
  std::array<double, 3> ends{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 across = slopes[k] - slopes[(k + 2) % 3];
    ends[k] = exit_of_ray(outline, centre, {across.y(), -across.x()});
  }
  const auto point_at = [&](double along) {
    const double corner = std::floor(along);
    const auto k = static_cast<std::size_t>(corner);
    const Vec2& a = outline[k];
    return along == corner ? a : Vec2(a + (along - corner) * (outline[(k + 1) % outline.size()] - a));
  };
  Cell cell;
  cell.at_mm = centre;
  for (std::size_t k = 0; k < 3; ++k) {
    CellFacet facet;
    facet.outline = {centre, point_at(ends[k])};
    const double last = ends[(k + 1) % 3] + (ends[(k + 1) % 3] < ends[k] ? static_cast<double>(outline.size()) : 0.0);
    for (double corner = std::floor(ends[k]) + 1.0; corner < last; corner += 1.0)
      facet.outline.push_back(outline[static_cast<std::size_t>(corner) % outline.size()]);
    facet.outline.push_back(point_at(ends[(k + 1) % 3]));
    facet.plane = {apex_height - slopes[k].dot(centre), slopes[k]};
    facet.centroid_mm = centroid(facet.outline);
    cell.facets.push_back(std::move(facet));
  }
  cell.outline = std::move(outline);
  return cell;
}

}  // namespace

Cell rtp_cell(const RtpElement& element, const AngleErrors& errors, const Vec2& corner, bool rotated) {
  const Eigen::Index across = rotated ? 1 : 0;
  Vec2 size(element.base_mm, element.width_mm);
  if (rotated) std::swap(size.x(), size.y());
  const HalfAngles half = half_angles(element, errors);
  const double depth = rtp_depth(element, errors);
  const double steepness = depth / (0.5 * size[across]);
  const double root = corner[across] + 0.5 * size[across];

  Cell cell;
  cell.at_mm = corner;
  cell.rotated = rotated;
  cell.outline = to_polygon({corner, corner + size});
  for (const std::size_t k : {0U, 1U}) {
    const double side = k == 0 ? -1.0 : 1.0;
    Rectangle area{corner, corner + size};
    (k == 0 ? area.upper : area.lower)[across] = root;
    CellFacet facet;
    facet.outline = to_polygon(area);
    facet.plane.slope[across] = side * steepness * (std::tan(half.mean_rad) / std::tan(half.rad[k]));
    facet.plane.height_mm = -depth - facet.plane.slope[across] * root;
    facet.centroid_mm = centroid(facet.outline);
    cell.facets.push_back(std::move(facet));
  }
  return cell;
}

Cell hexagonal_cube_cell(const HexagonalCube& element, const AngleErrors& errors, const Vec2& centre) {
  Polygon outline;
  for (int k = 0; k < 6; ++k) outline.push_back(rim_point(centre, 0.5 * element.aperture_mm, 60.0 * k));
  return cube_cell(std::move(outline), centre, -2.0 * rise_of_dihedral_edge(element.aperture_mm),
                   cube_slopes(errors, element.cant));
}

Cell triangular_cube_cell(const TriangularCube& element, const AngleErrors& errors, const Vec2& centre, bool rotated) {
  const double start_deg = rotated ? 180.0 : 0.0;
  Polygon outline;
  for (int k = 0; k < 3; ++k) outline.push_back(rim_point(centre, 0.5 * element.aperture_mm, start_deg + 120.0 * k));
  std::array<Vec2, 3> slopes = cube_slopes(errors, element.cant);
  if (rotated)
    for (Vec2& slope : slopes) slope = -slope;
  Cell cell = cube_cell(std::move(outline), centre, -rise_of_dihedral_edge(element.aperture_mm), slopes);
  cell.rotated = rotated;
  return cell;
}

Polygon polygon_of_circle(const Vec2& centre, double diameter_mm) {
  // Number of sides of the polygon that approximates a circle. It is a multiple of 12, so that the polygon has all
  // symmetries of a cube corner.
  constexpr int kSides = 180;
  constexpr double kStepDeg = 360.0 / kSides;
  const double step_rad = 2.0 * std::numbers::pi / kSides;
  const double radius_mm = 0.5 * diameter_mm * std::sqrt(step_rad / std::sin(step_rad));
  Polygon polygon;
  for (int k = 0; k < kSides; ++k) polygon.push_back(rim_point(centre, radius_mm, (k + 0.5) * kStepDeg));
  return polygon;
}

Cell round_cube_cell(const RoundCube& element, const AngleErrors& errors, const Vec2& centre) {
  constexpr double kSliver = 1e-9;  // merge distance as a fraction of the diameter
  Polygon outline = polygon_of_circle(centre, element.diameter_mm);
  if (element.outline)
    outline = clip(outline, moved(element.outline->hull, centre - element.outline->box_mm.centre()),
                   kSliver * element.diameter_mm);
  return cube_cell(std::move(outline), centre, -2.0 * rise_of_dihedral_edge(element.diameter_mm),
                   cube_slopes(errors, element.cant));
}

Cell element_in_place_of(const Cell& cell, const Element& element, const AngleErrors& errors) {
  return std::visit(
      Overloaded{[&](const RtpElement& e) { return rtp_cell(e, errors, cell.at_mm, cell.rotated); },
                 [&](const HexagonalCube& e) { return hexagonal_cube_cell(e, errors, cell.at_mm); },
                 [&](const TriangularCube& e) { return triangular_cube_cell(e, errors, cell.at_mm, cell.rotated); },
                 [&](const RoundCube& e) { return round_cube_cell(e, errors, cell.at_mm); },
                 [&](const RuledCells&) { return cell; }},
      element);
}

Cell element_cell(const Element& element, const AngleErrors& errors) {
  return std::visit(Overloaded{[&](const RtpElement& e) { return rtp_cell(e, errors, Vec2::Zero()); },
                               [&](const HexagonalCube& e) { return hexagonal_cube_cell(e, errors, Vec2::Zero()); },
                               [&](const TriangularCube& e) { return triangular_cube_cell(e, errors, Vec2::Zero()); },
                               [&](const RoundCube& e) { return round_cube_cell(e, errors, Vec2::Zero()); },
                               [&](const RuledCells& e) { return largest_cell(*e.pattern); }},
                    element);
}

double element_depth_mm(const Element& element, const AngleErrors& errors) {
  return std::visit(Overloaded{[&](const RtpElement& e) { return rtp_depth(e, errors); },
                               [](const HexagonalCube& e) { return 2.0 * rise_of_dihedral_edge(e.aperture_mm); },
                               [](const TriangularCube& e) { return rise_of_dihedral_edge(e.aperture_mm); },
                               [](const RoundCube& e) { return 2.0 * rise_of_dihedral_edge(e.diameter_mm); },
                               [](const RuledCells& e) { return -e.pattern->lowest_mm; }},
                    element);
}

Cant cant_of(const Element& element) {
  return std::visit(Overloaded{[](const RtpElement&) { return Cant{}; }, [](const RuledCells&) { return Cant{}; },
                               [](const auto& cube) { return cube.cant; }},
                    element);
}

std::vector<Cell> distinct_cells(const Element& element, const AngleErrors& errors) {
  if (const auto* const ruled = std::get_if<RuledCells>(&element)) return ruled->pattern->cells;
  return {element_cell(element, errors)};
}

double steepest_facet_deg(const Element& element, const AngleErrors& errors) {
  double steepest = 0.0;
  for (const Cell& cell : distinct_cells(element, errors))
    for (const CellFacet& facet : cell.facets) steepest = std::max(steepest, std::atan(facet.plane.slope.norm()));
  return steepest * 180.0 / std::numbers::pi;
}

double element_top_mm(const Element& element, const AngleErrors& errors) {
  double top = 0.0;
  if (errors == AngleErrors{} && cant_of(element).deg == 0.0) return top;
  for (const CellFacet& facet : element_cell(element, errors).facets)
    for (const Vec2& p : facet.outline) top = std::max(top, facet.plane.at(p));
  constexpr double rounding = 1e-12;
  return top > rounding * element_depth_mm(element, errors) ? top : 0.0;
}

Polygon aperture_outline(const Element& element) {
  Polygon outline = element_cell(element).outline;
  const Vec2 corner = bounding_box(outline).lower;
  for (Vec2& p : outline) p -= corner;
  return outline;
}

}  // namespace retrace::geometry
