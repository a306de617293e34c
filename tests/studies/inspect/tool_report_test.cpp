#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/part/faceted_solid.h"
#include "geometry/part/mesh_part.h"
#include "geometry/part/plate.h"
#include "geometry/part/welded_part.h"
#include "studies/inspect/tool_report.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/part_specs.h"

// Tests of the figures for toolmakers: smallest wall, draft, undercuts, optical area and axes of the elements.

namespace retrace::testing::tool_report_test {
namespace {

using geometry::Arrangement, geometry::FacetRole, geometry::Part, geometry::Vec2, geometry::Vec3;
using studies::DraftOfFaces, studies::report_tool, studies::ToolReport;

constexpr double kDegree = std::numbers::pi / 180.0;

DraftOfFaces draft_of(const ToolReport& report, FacetRole role) {
  for (const DraftOfFaces& draft : report.draft)
    if (draft.role == role) return draft;
  ADD_FAILURE() << "no faces with this role";
  return {};
}

/// A convex sphere is nearest to the back at the corners of the plate, and a concave one in the middle.
TEST(SmallestWall, OfPlatesUnderSpheresIsInClosedForm) {
  const Part plate = geometry::build_plate({4.0, 3.0}, 2.0);
  EXPECT_EQ(report_tool(plate, std::nullopt, {}).wall.thickness_mm, 2.0);
  const double r = 20.0;
  const double sag_mm = r - std::sqrt(r * r - 2.5 * 2.5);  // the corners are 2.5 mm from the centre
  const auto convex = report_tool(plate, sphere_entrance(r, 2.0, {2.0, 1.5}), {}).wall;
  EXPECT_NEAR(convex.thickness_mm, 2.0 - sag_mm, 1e-12);
  EXPECT_NEAR((convex.back_mm.head<2>() - Vec2(2.0, 1.5)).norm(), 2.5, 1e-6);
  const auto concave = report_tool(plate, sphere_entrance(-r, 2.0, {2.3, 1.1}), {}).wall;
  EXPECT_NEAR(concave.thickness_mm, 2.0, 1e-12);
  EXPECT_NEAR((concave.entrance_mm - Vec3(2.3, 1.1, 2.0)).norm(), 0.0, 1e-4);
}

/// The highest part of the back is a step whose edge is at x = 2. Its distance from an inclined plane z = h + s x is
/// (h + 2 s) / sqrt(1 + s^2), and the foot is within the part.
TEST(SmallestWall, BelowAnInclinedPlaneIsPerpendicular) {
  // A profile in x and z, extruded along y: the back is at z = -1 except for a step to z = 0 at x = 2 to 3.
  const std::vector<Vec2> profile = {{0, -1}, {2, -1}, {2, 0}, {3, 0}, {3, -1}, {4, -1}, {4, 2}, {0, 2}};
  geometry::TriangleMesh mesh;
  for (const double y : {0.0, 3.0})
    for (const Vec2& p : profile) mesh.vertices.emplace_back(p.x(), y, p.y());
  const std::vector<std::array<std::uint32_t, 3>> front = {{0, 1, 7}, {1, 2, 7}, {2, 3, 7},
                                                           {3, 6, 7}, {3, 4, 6}, {4, 5, 6}};
  for (const auto& t : front) {
    mesh.triangles.push_back(t);
    mesh.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t next = (k + 1) % 8;
    mesh.triangles.push_back({next, k, k + 8});
    mesh.triangles.push_back({next, k + 8, next + 8});
  }
  ASSERT_GT(geometry::volume_mm3(geometry::boundary_of(mesh)), 0.0);
  const Part part = geometry::part_of_mesh(mesh);
  const double h = 0.5;
  const double s = 0.5;
  const auto wall = report_tool(part, plane_entrance(h, s, 0.0), {}).wall;
  EXPECT_NEAR(wall.thickness_mm, (h + 2.0 * s) / std::sqrt(1.0 + s * s), 1e-10);
  EXPECT_NEAR(wall.back_mm.x(), 2.0, 1e-7);
}

/// The facets of a prism are inclined by 45 degrees. A demoulding direction that is tilted by t across the roof edge
/// leaves a draft of 45 - t on one facet of each prism.
TEST(Draft, OfPrismsFollowsTheDemouldingDirection) {
  const Part part =
      geometry::build_welded_part(finite(geometry::RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 2.0, 2.0, 1.0));
  ASSERT_EQ(part.elements_full, 16);
  for (const double tilt_deg : {0.0, 20.0, 50.0}) {
    const ToolReport report = report_tool(
        part, std::nullopt, {.min_draft_deg = 10.0, .demould_tilt_deg = tilt_deg, .demould_azimuth_deg = 0.0});
    const DraftOfFaces facets = draft_of(report, FacetRole::retro_facet);
    EXPECT_NEAR(facets.min_draft_deg, 45.0 - tilt_deg, 1e-9);
    EXPECT_EQ(facets.faces, 32);
    EXPECT_EQ(facets.undercuts, tilt_deg > 45.0 ? 16 : 0);
    EXPECT_EQ(facets.below_limit, tilt_deg > 35.0 ? 16 : 0);
    EXPECT_NEAR(facets.undercut_mm2, tilt_deg > 45.0 ? 0.5 * part.retro_facet_area_mm2 : 0.0, 1e-12);
    EXPECT_NEAR(draft_of(report, FacetRole::entrance).min_draft_deg, 90.0 - tilt_deg, 1e-9);
    EXPECT_NEAR(draft_of(report, FacetRole::side).min_draft_deg, 0.0, 1e-9);
    EXPECT_EQ(report.steep_faces.size(), static_cast<std::size_t>(report.below_limit()));
    for (std::size_t k = 1; k < report.steep_faces.size(); ++k)
      EXPECT_LE(report.steep_faces[k - 1].draft_deg, report.steep_faces[k].draft_deg);
    EXPECT_NEAR(report.optical_area_fraction, 1.0, 1e-12);
  }
}

/// The angle between a facet of a cube corner and its axis is atan(1 / sqrt(2)). A cant of c degrees reduces the draft
/// of the facet towards which the axis is tilted.
TEST(Draft, OfCubeCornersIsInClosedForm) {
  const double facet_deg = std::atan(std::sqrt(0.5)) / kDegree;
  const auto draft = [](const geometry::Element& element) {
    const Part part = geometry::build_welded_part(single(element, 2.0));
    return draft_of(report_tool(part, std::nullopt, {}), FacetRole::retro_facet).min_draft_deg;
  };
  EXPECT_NEAR(draft(geometry::HexagonalCube{1.0}), facet_deg, 1e-9);
  EXPECT_NEAR(draft(geometry::TriangularCube{1.0}), facet_deg, 1e-9);
  // One of the facets is opposite to the edge at azimuth 0. Its normal is in the plane of the cant.
  const double towards = draft(geometry::HexagonalCube{1.0, {8.0, 0.0}});
  const double away = draft(geometry::HexagonalCube{1.0, {8.0, 180.0}});
  EXPECT_NEAR(std::min(towards, away), facet_deg - 8.0, 1e-9);
}

TEST(OpticalArea, OfPrismsWithGapsIsTheirFractionOfThePlan) {
  geometry::PartSpec spec = finite(geometry::RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 3.0, 2.0, 1.0);
  spec.array.x_gap_mm = 0.1;
  spec.array.y_gap_mm = 0.1;
  spec.array.x_offset_mm = 0.05;
  const Part part = geometry::build_welded_part(spec);
  ASSERT_EQ(part.elements_full, 20);
  const ToolReport report = report_tool(part, std::nullopt, {});
  EXPECT_NEAR(report.optical_area_fraction, 20.0 * 0.5 * 0.4 / 6.0, 1e-12);
  EXPECT_NEAR(report.wall.thickness_mm, 1.0, 1e-14);
}

/// The axes of the elements are parallel to z. Below a sphere, the angle to the normal is asin(r / R).
TEST(PinAxes, BelowASphereHaveTheAngleOfItsNormal) {
  const Part part = geometry::build_part(finite(geometry::HexagonalCube{1.0}, Arrangement::honeycomb, 6.0, 5.0, 1.0));
  const double radius_mm = 15.0;
  const ToolReport report = report_tool(part, sphere_entrance(radius_mm, 1.5, {3.0, 2.5}), {});
  EXPECT_GE(static_cast<std::int64_t>(report.pin_axes.size()), part.elements_full);
  for (const studies::PinAxis& pin : report.pin_axes) {
    EXPECT_NEAR((pin.axis - Vec3::UnitZ()).norm(), 0.0, 1e-12);
    const Vec2 from_centre = pin.centre_mm - Vec2(3.0, 2.5);
    EXPECT_NEAR(pin.angle_deg(), std::asin(from_centre.norm() / radius_mm) / kDegree, 1e-9);
    const double azimuth = std::atan2(-from_centre.y(), -from_centre.x());
    if (from_centre.norm() > 1e-6) {
      EXPECT_NEAR(std::cos(pin.azimuth_deg() * kDegree - azimuth), 1.0, 1e-9);
    }
  }
  EXPECT_TRUE(report_tool(part, std::nullopt, {}).pin_axes.empty());
}

/// Canted axes have the angle of the cant below a plane that is perpendicular to z.
TEST(PinAxes, OfCantedElementsHaveTheAngleOfTheCant) {
  geometry::PartSpec spec = finite(geometry::HexagonalCube{1.0, {7.0, 90.0}}, Arrangement::honeycomb, 5.0, 5.0, 1.5);
  const ToolReport report = report_tool(geometry::build_part(spec), plane_entrance(2.0), {});
  ASSERT_FALSE(report.pin_axes.empty());
  for (const studies::PinAxis& pin : report.pin_axes) EXPECT_NEAR(pin.angle_deg(), 7.0, 1e-9);
}

}  // namespace
}  // namespace retrace::testing::tool_report_test
