#include "studies/inspect/ruled_report.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/elements/plane_polygon.h"

namespace retrace::studies {
namespace {

using geometry::Cell, geometry::CellFacet, geometry::HeightPlane, geometry::Polygon, geometry::Vec2, geometry::Vec3;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

Vec3 outward_normal_of(const CellFacet& facet) {
  return Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized();
}

bool is_face(const CellFacet& facet) {
  return !facet.is_flat && !facet.is_edge;
}

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
  return direction - 2.0 * direction.dot(normal) * normal;
}

/// Affine map in plan: matrix p + shift.
struct PlanMap {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity();
  Vec2 shift = Vec2::Zero();

  Vec2 operator()(const Vec2& p) const { return matrix * p + shift; }
  PlanMap then(const PlanMap& next) const { return {next.matrix * matrix, next.matrix * shift + next.shift}; }
};

/// Returns the map from points on one plane to the points at which light in a direction meets another plane.
PlanMap along(const Vec3& direction, const HeightPlane& from, const HeightPlane& to) {
  // The light rises over the second plane by `closing` per unit length.
  const double closing = to.slope.dot(direction.head<2>()) - direction.z();
  const Vec2 per_height = direction.head<2>() / closing;
  PlanMap map;
  map.matrix += per_height * (from.slope - to.slope).transpose();
  map.shift = per_height * (from.height_mm - to.height_mm);
  return map;
}

/// Returns the points of a polygon that a map takes into a convex region.
Polygon mapped_into(Polygon polygon, const PlanMap& map, const Polygon& region) {
  for (std::size_t k = 0; k < region.size() && !polygon.empty(); ++k) {
    const Vec2& a = region[k];
    const Vec2 side = region[(k + 1) % region.size()] - a;
    const Vec2 inward(-side.y(), side.x());
    polygon =
        geometry::where_higher(polygon, {inward.dot(map.shift - a), map.matrix.transpose() * inward}, HeightPlane{});
  }
  return polygon;
}

}  // namespace

double effective_aperture(const Cell& cell, const Vec3& direction) {
  // The volume over the faces is convex: it is bounded by the planes from below. Two points on faces therefore see
  // each other, and light that goes from a point of one face towards a point of another face meets nothing else.
  const HeightPlane level;
  double area_mm2 = 0.0;
  const std::vector<CellFacet>& all = cell.facets;
  for (const CellFacet& first : all)
    for (const CellFacet& second : all)
      for (const CellFacet& third : all) {
        const bool are_different = &first != &second && &second != &third && &third != &first;
        if (!are_different || !is_face(first) || !is_face(second) || !is_face(third)) continue;
        const Vec3 to_second = mirrored(direction, outward_normal_of(first));
        const Vec3 to_third = mirrored(to_second, outward_normal_of(second));
        const Vec3 out = mirrored(to_third, outward_normal_of(third));
        if (to_second.dot(outward_normal_of(second)) <= 0.0 || to_third.dot(outward_normal_of(third)) <= 0.0 ||
            direction.dot(outward_normal_of(first)) <= 0.0 || out.z() <= 0.0)
          continue;
        const PlanMap on_first = along(direction, level, first.plane);
        const PlanMap on_second = on_first.then(along(to_second, first.plane, second.plane));
        const PlanMap on_third = on_second.then(along(to_third, second.plane, third.plane));
        Polygon lit = mapped_into(cell.outline, on_first, first.outline);
        lit = mapped_into(std::move(lit), on_second, second.outline);
        lit = mapped_into(std::move(lit), on_third, third.outline);
        lit = mapped_into(std::move(lit), on_third.then(along(out, third.plane, level)), cell.outline);
        if (!lit.empty()) area_mm2 += geometry::area(lit);
      }
  return area_mm2 / geometry::area(cell.outline);
}

namespace {

/// Returns the three angles of a triangle in ascending order. Returns nothing for other polygons.
std::optional<std::array<double, 3>> angles_of_triangle(const Polygon& outline) {
  if (outline.size() != 3) return std::nullopt;
  std::array<double, 3> angles{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 a = outline[(k + 1) % 3] - outline[k];
    const Vec2 b = outline[(k + 2) % 3] - outline[k];
    angles[k] = std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * kDegPerRad;
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

/// Adds the angles between the faces and the direction of the axis.
void measure_cube(RuledCellReport& report, const std::vector<Vec3>& normals) {
  std::array<double, 3> dihedral{};
  Eigen::Matrix3d rows;
  for (std::size_t k = 0; k < 3; ++k) {
    const double cosine = normals[k].dot(normals[(k + 1) % 3]);
    dihedral[k] = 180.0 - std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegPerRad;
    rows.row(static_cast<Eigen::Index>(k)) = -normals[k];
  }
  report.dihedral_deg = dihedral;
  const Vec3 axis = (rows.inverse() * Vec3::Ones()).normalized();
  const double across = axis.head<2>().norm();
  report.cant_deg = std::atan2(across, axis.z()) * kDegPerRad;
  constexpr double kUpright = 1e-12;
  if (across > kUpright) report.cant_azimuth_deg = std::atan2(axis.y(), axis.x()) * kDegPerRad;
}

RuledCellReport report_cell(const Cell& cell, const geometry::RuledPattern& pattern) {
  RuledCellReport report;
  report.area_mm2 = geometry::area(cell.outline);
  std::vector<Vec3> normals;
  for (const CellFacet& facet : cell.facets) {
    const double fraction = geometry::area(facet.outline) / report.area_mm2;
    const bool is_top = facet.is_flat && pattern.depth_mm && facet.plane.height_mm == -*pattern.depth_mm;
    if (is_face(facet))
      normals.push_back(outward_normal_of(facet));
    else
      (is_top ? report.truncated_fraction : report.bottom_fraction) += fraction;
  }
  // A face is stored in several polygons if groove bottoms divide it.
  std::vector<Vec3> distinct;
  for (const Vec3& normal : normals)
    if (std::none_of(distinct.begin(), distinct.end(), [&](const Vec3& n) { return (n - normal).norm() < 1e-12; }))
      distinct.push_back(normal);
  report.faces = static_cast<int>(distinct.size());
  if (distinct.size() == 3) measure_cube(report, distinct);
  report.base_deg = angles_of_triangle(cell.outline);
  report.effective_aperture = effective_aperture(cell, -Vec3::UnitZ());
  return report;
}

}  // namespace

RuledReport report_ruled(const geometry::RuledPattern& pattern) {
  RuledReport report;
  report.is_period = pattern.period_mm.has_value();
  double dead_mm2 = 0.0, all_mm2 = 0.0;
  for (const Cell& cell : pattern.cells) {
    report.cells.push_back(report_cell(cell, pattern));
    const RuledCellReport& last = report.cells.back();
    dead_mm2 += (last.truncated_fraction + last.bottom_fraction) * last.area_mm2;
    all_mm2 += last.area_mm2;
  }
  report.dead_fraction = dead_mm2 / all_mm2;
  return report;
}

}  // namespace retrace::studies
