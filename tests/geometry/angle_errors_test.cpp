#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/part/part.h"
#include "tests/geometry/part_checks.h"

// Tests of dihedral errors and facet tilts: the facets have the requested angles, and the part is a closed solid.

namespace retrace::geometry::angle_errors_test {
namespace {

constexpr double kArcmin = std::numbers::pi / 180.0 / 60.0;
/// Slope angle of the facets of a nominal cube corner, rad.
const double kInclination = std::atan(std::numbers::sqrt2);

PartSpec single(const Element& element, const AngleErrors& errors) {
  PartSpec spec;
  spec.element = element;
  spec.angle_errors = errors;
  spec.array.arrangement = Arrangement::single;
  spec.thickness_mm = 0.5;
  return spec;
}

/// Returns the normals of a cell's facets, which point out of the part.
std::vector<Vec3> normals_of(const Cell& cell) {
  std::vector<Vec3> normals;
  for (const CellFacet& facet : cell.facets)
    normals.push_back(Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized());
  return normals;
}

/// Returns the angle in the material between two facets with the outward normals `a` and `b`.
double included_rad(const Vec3& a, const Vec3& b) {
  return std::numbers::pi - std::atan2(a.cross(b).norm(), a.dot(b));
}

const std::array<AngleErrors, 9> kErrors = {{{{1.0, 1.0, 1.0}, {}},
                                             {{-1.0, -1.0, -1.0}, {}},
                                             {{5.0, -3.0, 0.5}, {}},
                                             {{0.0, -7.0, 0.0}, {}},
                                             {{300.0, 300.0, 300.0}, {}},
                                             {{}, {4.0, -4.0, 1.0}},
                                             {{}, {-2.0, -2.0, -2.0}},
                                             {{0.0, 0.0, 1e-3}, {1e-3, 0.0, -1e-3}},
                                             {{2.0, -1.0, 3.0}, {-6.0, 0.5, 10.0}}}};

TEST(AngleErrors, CubeCornersIncludeTheDihedralAnglesAskedFor) {
  for (const AngleErrors& errors : kErrors) {
    if (errors.facet_tilt_arcmin != std::array<double, 3>{}) continue;
    for (const Cell& cell :
         {hexagonal_cube_cell({1.3}, errors, {0.2, 0.3}), triangular_cube_cell({1.3}, errors, {0.2, 0.3}),
          triangular_cube_cell({1.3}, errors, {0.2, 0.3}, true)}) {
      const bool rotated = cell.outline[0].x() < 0.2;
      const std::vector<Vec3> normals = normals_of(cell);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& before = normals[(k + 2) % 3];
        const double expected = 0.5 * std::numbers::pi + errors.dihedral_error_arcmin[k] * kArcmin;
        EXPECT_NEAR(included_rad(before, normals[k]), expected, 1e-12);
        // Seen from the apex outward, the projection of edge k has the azimuth 120 k degrees.
        const Vec3 edge = before.cross(normals[k]).normalized();
        EXPECT_GT(edge.z(), 0.0);
        const double angle = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k) + (rotated ? std::numbers::pi : 0.0);
        EXPECT_GT(edge.head<2>().normalized().dot(Vec2(std::cos(angle), std::sin(angle))), 0.99);
      }
    }
  }
}

// The two facets of the edge rotate in opposite directions, each by half of the error. The third facet does not move.
TEST(AngleErrors, DihedralErrorIsSplitEvenly) {
  const double error = 10.0 * kArcmin;
  const std::vector<Vec3> nominal = normals_of(triangular_cube_cell({1.0}, {}, Vec2::Zero()));
  const std::vector<Vec3> normals = normals_of(triangular_cube_cell({1.0}, {{10.0, 0.0, 0.0}, {}}, Vec2::Zero()));
  EXPECT_NEAR(std::acos(normals[0].dot(nominal[0])), 0.5 * error, 1e-5 * error);
  EXPECT_NEAR(std::acos(normals[2].dot(nominal[2])), 0.5 * error, 1e-5 * error);
  EXPECT_NEAR((normals[1] - nominal[1]).norm(), 0.0, 1e-14);
  EXPECT_NEAR((normals[0] - Vec3(normals[2].x(), -normals[2].y(), normals[2].z())).norm(), 0.0, 1e-14);
}

TEST(AngleErrors, FacetTiltOpensOneFacetOfACubeCorner) {
  const AngleErrors errors{{}, {12.0, -7.0, 0.0}};
  const Cell cell = hexagonal_cube_cell({1.0}, errors, Vec2::Zero());
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& slope = cell.facets[k].plane.slope;
    EXPECT_NEAR(std::atan(slope.norm()), kInclination - errors.facet_tilt_arcmin[k] * kArcmin, 1e-14);
    EXPECT_NEAR(std::atan2(slope.y(), slope.x()),
                std::remainder((2.0 * static_cast<double>(k) + 1.0) / 3.0, 2.0) * std::numbers::pi, 1e-14);
  }
}

TEST(AngleErrors, ApexOfACubeCornerStaysInPlace) {
  for (const AngleErrors& errors : kErrors) {
    for (const Element& element : {Element(HexagonalCube{1.3}), Element(TriangularCube{1.3})}) {
      const Part part = build_part(single(element, errors));
      EXPECT_EQ(part.element_depth_mm, element_depth_mm(element));
      for (const CellFacet& facet : element_cell(element, errors).facets)
        EXPECT_NEAR(facet.plane.at(Vec2::Zero()), -part.element_depth_mm, 1e-15);
    }
  }
}

// Light that is reflected by all three facets leaves approximately towards its source. If all three dihedral angles
// have the same error, the deviation from this direction is 4 sqrt(2/3) times the error (Chandler, J. Opt. Soc. Am. 50,
// 1203 (1960)).
TEST(AngleErrors, EqualDihedralErrorsDeviateTheSixBeamsAlike) {
  const double error = 0.5 * kArcmin;
  const std::vector<Vec3> normals = normals_of(hexagonal_cube_cell({1.0}, {{0.5, 0.5, 0.5}, {}}, Vec2::Zero()));
  std::array<std::size_t, 3> order = {0, 1, 2};
  do {
    Vec3 direction = -Vec3::UnitZ();
    for (const std::size_t k : order) direction -= 2.0 * normals[k].dot(direction) * normals[k];
    EXPECT_NEAR(std::asin(direction.head<2>().norm()), 4.0 * std::sqrt(2.0 / 3.0) * error, 1e-3 * error);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(AngleErrors, DihedralErrorOfAPrismIsItsApexAngle) {
  for (const double arcmin : {-300.0, -1.0, 0.25, 90.0}) {
    const Part error = build_part(single(RtpElement{0.5, 0.4, 90.0}, {{arcmin, 0.0, 0.0}, {}}));
    const Part apex = build_part(single(RtpElement{0.5, 0.4, 90.0 + arcmin / 60.0}, {}));
    EXPECT_EQ(error.element_depth_mm, apex.element_depth_mm);
    EXPECT_NEAR(error.top_mm, 0.0, 1e-16);
    ASSERT_EQ(error.patches[0].vertices.size(), apex.patches[0].vertices.size());
    for (std::size_t k = 0; k < apex.patches[0].vertices.size(); ++k)
      EXPECT_EQ(error.patches[0].vertices[k], apex.patches[0].vertices[k]);
  }
}

TEST(AngleErrors, FacetTiltsOfAPrismAddUpToItsApexError) {
  const auto normals = [](const AngleErrors& errors) {
    return normals_of(rtp_cell({0.5, 0.4, 91.0}, errors, Vec2::Zero()));
  };
  const std::vector<Vec3> tilted = normals({{6.0, 0.0, 0.0}, {9.0, -2.0, 0.0}});
  EXPECT_NEAR(included_rad(tilted[0], tilted[1]), (91.0 * 60.0 + 6.0 + 9.0 - 2.0) * kArcmin, 1e-12);
  // The angle between the facet towards -x and the vertical is half of the apex angle plus the tilt of this facet.
  EXPECT_NEAR(std::acos(-tilted[0].x()), (91.0 * 30.0 + 3.0 + 9.0) * kArcmin, 1e-12);
  EXPECT_NEAR(std::acos(tilted[1].x()), (91.0 * 30.0 + 3.0 - 2.0) * kArcmin, 1e-12);
  const std::vector<Vec3> symmetric = normals({{}, {4.0, 4.0, 0.0}});
  const std::vector<Vec3> opened = normals({{8.0, 0.0, 0.0}, {}});
  for (std::size_t k : {0U, 1U}) EXPECT_NEAR((symmetric[k] - opened[k]).norm(), 0.0, 1e-15);
}

TEST(AngleErrors, AntisymmetricTiltsOfAPrismTurnItAboutItsRoot) {
  const AngleErrors errors{{}, {-5.0, 5.0, 0.0}};
  const Cell cell = rtp_cell({0.5, 0.4, 90.0}, errors, Vec2::Zero());
  EXPECT_NEAR(element_depth_mm(RtpElement{0.5, 0.4, 90.0}, errors), 0.25, 1e-15);
  for (const CellFacet& facet : cell.facets) EXPECT_NEAR(facet.plane.at({0.25, 0.0}), -0.25, 1e-15);
  // The steeper facet rises above z = 0. To first order, the other facet ends below z = 0 by the same distance.
  const double lift = 0.25 / std::tan(0.25 * std::numbers::pi - 5.0 * kArcmin) - 0.25;
  EXPECT_NEAR(cell.facets[0].plane.at({0.0, 0.0}), lift, 1e-15);
  EXPECT_NEAR(cell.facets[1].plane.at({0.5, 0.0}), -lift, 2.0 * lift * lift / 0.25);
  EXPECT_NEAR(element_top_mm(RtpElement{0.5, 0.4, 90.0}, errors), lift, 1e-15);
}

TEST(AngleErrors, TurnedPrismsCarryTheirErrorsWithThem) {
  const AngleErrors errors{{2.0, 0.0, 0.0}, {3.0, -1.0, 0.0}};
  const std::vector<Vec3> plain = normals_of(rtp_cell({0.5, 0.5, 90.0}, errors, Vec2::Zero()));
  const std::vector<Vec3> rotated = normals_of(rtp_cell({0.5, 0.5, 90.0}, errors, Vec2::Zero(), true));
  for (std::size_t k : {0U, 1U})
    EXPECT_NEAR((rotated[k] - Vec3(-plain[k].y(), plain[k].x(), plain[k].z())).norm(), 0.0, 1e-15);
}

TEST(AngleErrors, SurfaceLiesBetweenDepthAndTop) {
  for (const AngleErrors& errors : kErrors) {
    for (const Element& element :
         {Element(RtpElement{0.5, 0.4, 90.0}), Element(HexagonalCube{1.0}), Element(TriangularCube{1.0})}) {
      const Part part = build_part(single(element, errors));
      double lowest = INFINITY;
      double highest = 0.0;
      for (const PatchCell& cell : part.patches[0].cells) {
        lowest = std::min(lowest, cell.lower.z());
        highest = std::max(highest, cell.upper.z());
      }
      EXPECT_NEAR(lowest, -part.element_depth_mm, 1e-9);
      EXPECT_NEAR(highest, part.top_mm, 1e-9);
    }
  }
  EXPECT_EQ(build_part(single(HexagonalCube{1.0}, {})).top_mm, 0.0);
}

TEST(AngleErrors, SingleElementsAreClosed) {
  for (const AngleErrors& errors : kErrors)
    for (const Element& element :
         {Element(RtpElement{0.45, 0.4, 90.0}), Element(HexagonalCube{1.6}), Element(TriangularCube{1.6})})
      expect_valid(single(element, errors));
}

TEST(AngleErrors, RtpArraysAreClosed) {
  for (const AngleErrors& errors : kErrors) {
    for (const Arrangement arrangement : {Arrangement::aligned, Arrangement::offset, Arrangement::checker}) {
      PartSpec spec = single(RtpElement{0.5, 0.5, 90.0}, errors);
      spec.array.arrangement = arrangement;
      spec.array.x_length_mm = spec.array.y_length_mm = 2.5;
      expect_valid(spec);
      spec.array.x_gap_mm = 0.05;
      expect_valid(spec);
      spec.array.y_gap_mm = 0.1;
      spec.array.x_offset_mm = 0.2;
      spec.array.overlap_percent = 30.0;
      expect_valid(spec);
      spec.array.partial_elements = PartialElements::omit;
      expect_valid(spec);
    }
  }
}

bool alike(const std::array<double, 3>& values) {
  return values[0] == values[1] && values[1] == values[2];
}

PartSpec cube_array(const Element& element, const AngleErrors& errors) {
  PartSpec spec = single(element, errors);
  spec.array.arrangement =
      std::holds_alternative<HexagonalCube>(element) ? Arrangement::honeycomb : Arrangement::triangular;
  spec.array.x_length_mm = 4.3;
  spec.array.y_length_mm = 3.4;
  return spec;
}

TEST(AngleErrors, CubeCornerArraysAreClosed) {
  for (const AngleErrors& errors : kErrors) {
    for (const PartialElements partial : {PartialElements::cut, PartialElements::omit}) {
      for (const Element& element : {Element(HexagonalCube{1.0}), Element(TriangularCube{1.0})}) {
        const bool may_touch = std::holds_alternative<TriangularCube>(element) &&
                               !(alike(errors.dihedral_error_arcmin) && alike(errors.facet_tilt_arcmin));
        if (may_touch) continue;
        PartSpec spec = cube_array(element, errors);
        spec.array.partial_elements = partial;
        expect_valid(spec);
        spec.array.x_offset_mm = 0.3;
        expect_valid(spec);
      }
    }
  }
}

void expect_volume(const Part& part, const BoundaryMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles)
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
  EXPECT_NEAR(volume, part.entrance_area_mm2 * part.thickness_mm + volume_below(part), 1e-9);
}

// Six triangles meet at a point. With unequal errors, their heights at this point alternate between high and low. The
// part then touches itself along the vertical line through the point, but its boundary is still closed.
TEST(AngleErrors, TriangularArraysOfUnlikeErrorsTouchThemselves) {
  for (const AngleErrors& errors : kErrors) {
    if (alike(errors.dihedral_error_arcmin) && alike(errors.facet_tilt_arcmin)) continue;
    const Part part = build_part(cube_array(TriangularCube{1.0}, errors));
    const BoundaryMesh mesh = closed_boundary(part);
    const BoundaryReport report = check_boundary(mesh);
    EXPECT_TRUE(report.is_closed);
    EXPECT_FALSE(report.is_manifold);
    expect_volume(part, mesh);
  }
}

/// Returns the edges that the triangles traverse more often in one direction than in the opposite direction.
std::vector<std::pair<std::uint32_t, std::uint32_t>> open_edges(
    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      balance[{low, high}] += t[k] == low ? 1 : -1;
    }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  for (const auto& [edge, passes] : balance)
    if (passes != 0) open.push_back(edge);
  return open;
}

TEST(AngleErrors, InfiniteSurfacesHaveNoGaps) {
  for (const AngleErrors& errors : kErrors) {
    for (const Arrangement arrangement : {Arrangement::aligned, Arrangement::offset, Arrangement::checker,
                                          Arrangement::honeycomb, Arrangement::triangular}) {
      PartSpec spec = single(RtpElement{0.5, 0.5, 90.0}, errors);
      if (arrangement == Arrangement::honeycomb) spec.element = HexagonalCube{1.0};
      if (arrangement == Arrangement::triangular) spec.element = TriangularCube{1.0};
      spec.array.arrangement = arrangement;
      spec.array.extent = Extent::infinite;
      const Part part = build_part(spec);
      const SurfacePatch& patch = part.patches[0];
      const Vec2 middle = (part.periods_beyond + 0.5) * *part.period_mm;
      for (const auto& [from, to] : open_edges(patch.triangles)) {
        const Vec2 from_middle =
            (0.5 * (patch.vertices[from] + patch.vertices[to]).head<2>() - middle).cwiseQuotient(*part.period_mm);
        EXPECT_GT(from_middle.cwiseAbs().maxCoeff(), 1.5);
      }
    }
  }
}

}  // namespace
/// Returns the tilt of each facet: 45 degrees minus its slope angle, in arc minutes.
std::vector<double> tilts_of(const Part& part) {
  std::vector<double> tilts;
  for (const SurfacePatch& patch : part.patches)
    for (const PatchFacet& facet : patch.facets)
      if (facet.role == FacetRole::retro_facet)
        tilts.push_back(60.0 * (45.0 - std::acos(-facet.normal.z()) * 180.0 / std::numbers::pi));
  return tilts;
}

PartSpec random_prisms(double sigma_arcmin, std::uint32_t seed) {
  PartSpec spec;
  spec.element = RtpElement{0.5, 0.5, 90.0};
  spec.array.x_length_mm = spec.array.y_length_mm = 10.0;
  spec.thickness_mm = 1.0;
  spec.random_tilts = {sigma_arcmin, seed};
  return spec;
}

// 400 prisms have 800 facets. The standard deviation of 800 tilts has a relative standard error of 2.5 %.
TEST(RandomTilts, HaveTheDeviationAskedFor) {
  const std::vector<double> tilts = tilts_of(build_part(random_prisms(2.0, 1)));
  ASSERT_GE(tilts.size(), 800U);
  double sum = 0.0;
  double squares = 0.0;
  for (const double t : tilts) {
    sum += t;
    squares += t * t;
  }
  const auto n = static_cast<double>(tilts.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 2.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 2.0, 4.0 * 2.0 / std::sqrt(2.0 * n));
}

TEST(RandomTilts, DependOnTheSeedAlone) {
  const std::vector<double> first = tilts_of(build_part(random_prisms(2.0, 1)));
  EXPECT_EQ(tilts_of(build_part(random_prisms(2.0, 1))), first);
  EXPECT_NE(tilts_of(build_part(random_prisms(2.0, 2))), first);
}

// Four cells meet at a point. Two opposite cells may be lower at this point than the other two. The part then touches
// itself along the vertical line through the point, so the boundary is closed but may not be a manifold.
TEST(RandomTilts, ArraysAreClosed) {
  std::vector<PartSpec> specs(4, random_prisms(5.0, 3));
  specs[1].array.arrangement = Arrangement::offset;
  specs[2].array.arrangement = Arrangement::checker;
  specs[3].element = HexagonalCube{0.7};
  specs[3].array.arrangement = Arrangement::honeycomb;
  for (PartSpec& spec : specs) {
    spec.array.x_length_mm = spec.array.y_length_mm = 2.0;
    for (const double gap_mm : {0.0, 0.1}) {
      if (spec.array.arrangement != Arrangement::honeycomb) spec.array.x_gap_mm = spec.array.y_gap_mm = gap_mm;
      const Part part = build_part(spec);
      const BoundaryMesh mesh = closed_boundary(part);
      EXPECT_TRUE(check_boundary(mesh).is_closed);
      expect_volume(part, mesh);
    }
  }
  PartSpec one = random_prisms(5.0, 3);
  one.array.arrangement = Arrangement::single;
  expect_valid(one);
}

TEST(RandomTilts, LayerHoldsTheSurface) {
  const Part part = build_part(random_prisms(20.0, 4));
  EXPECT_GT(part.top_mm, 0.0);
  for (const SurfacePatch& patch : part.patches)
    for (const Vec3& vertex : patch.vertices) {
      EXPECT_LE(vertex.z(), part.top_mm);
      EXPECT_GE(vertex.z(), -part.element_depth_mm);
    }
  PartSpec thin = random_prisms(20.0, 4);
  thin.thickness_mm = 0.5 * part.top_mm;
  EXPECT_THROW(build_part(thin), InputError);
}

}  // namespace retrace::geometry::angle_errors_test
