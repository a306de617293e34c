#include "geometry/elements/substrate_checks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/part/faceted_solid.h"
#include "tests/geometry/part_checks.h"
#include "tests/support/part_specs.h"
#include "tests/support/refusals.h"

// Tests of elements on inclined, curved and freeform substrates: the elements are at the correct positions, and the
// part is a closed solid.

namespace retrace::geometry::substrate_part_test {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

Substrate formula(const std::string& text, ElementAxes element_axes = ElementAxes::normal) {
  return {formula_substrate(text), element_axes};
}

PartSpec spec_of(const Element& element, Arrangement arrangement, double x_length_mm, double y_length_mm) {
  return retrace::testing::finite(element, arrangement, x_length_mm, y_length_mm, 3.0);
}

std::vector<PartSpec> arrays() {
  const RtpElement prism{0.5, 0.4, 90.0};
  std::vector<PartSpec> specs = {spec_of(prism, Arrangement::aligned, 3.2, 2.7),
                                 spec_of(prism, Arrangement::offset, 3.0, 2.8),
                                 spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 3.0, 2.6),
                                 spec_of(HexagonalCube{0.8}, Arrangement::honeycomb, 3.3, 2.9),
                                 spec_of(TriangularCube{0.8}, Arrangement::triangular, 3.3, 2.9)};
  specs[0].array.x_gap_mm = 0.05;
  specs[0].array.y_gap_mm = 0.03;
  specs[1].array.partial_elements = PartialElements::omit;
  return specs;
}

std::vector<Substrate> substrates() {
  return {{PlaneSubstrate{17.0, 0.0}, ElementAxes::normal},
          {PlaneSubstrate{12.0, 70.0}, ElementAxes::normal},
          {PlaneSubstrate{25.0, 200.0}, ElementAxes::parallel},
          {CylinderSubstrate{6.0, false}, ElementAxes::normal},
          {CylinderSubstrate{-9.0, true}, ElementAxes::normal},
          {CylinderSubstrate{5.0, true}, ElementAxes::parallel},
          {SphereSubstrate{8.0}, ElementAxes::normal},
          {SphereSubstrate{-8.0}, ElementAxes::parallel},
          formula("0.02*x^2*y + 0.1*sin(x) - 0.03*y^2"),
          formula("0.1*x - 0.05*y + 0.01*x*y", ElementAxes::parallel)};
}

/// Returns the height and the slope of the back surface of the part at a point of the xy plane.
HeightPlane surface_at(const Part& part, const Vec2& p) {
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    const Vec2 local = p - placement.offset_mm;
    for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
      const PatchFacet& facet = patch.facets[patch.triangle_facet[t]];
      if (std::abs(facet.normal.z()) < 1e-9) continue;
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 a = patch.vertices[patch.triangles[t][k]].head<2>();
        const Vec2 along = patch.vertices[patch.triangles[t][(k + 1) % 3]].head<2>() - a;
        const Vec2 to = local - a;
        inside = inside && along.x() * to.y() - along.y() * to.x() <= 0.0;  // clockwise as seen from above
      }
      if (!inside) continue;
      HeightPlane plane;
      plane.slope = -facet.normal.head<2>() / facet.normal.z();
      plane.height_mm = facet.offset_mm / facet.normal.z() + plane.slope.dot(local) + placement.height_mm;
      return plane;
    }
  }
  ADD_FAILURE() << "nothing stands over " << p.transpose();
  return {};
}

/// Expects that the boundary is closed, encloses the volume of the part and does not intersect itself. On a curved
/// substrate, the heights of the four cells at a corner may alternate between high and low. The part then touches
/// itself along the vertical line through this corner, and its boundary is not a manifold.
void expect_solid(const PartSpec& spec) {
  const Part part = build_part(spec);
  const BoundaryMesh mesh = closed_boundary(part);
  const BoundaryReport report = check_boundary(mesh);
  EXPECT_TRUE(report.is_closed);
  const bool four_meet = !std::holds_alternative<HexagonalCube>(spec.element);
  const bool is_curved = !std::holds_alternative<PlaneSubstrate>(spec.substrate->shape);
  EXPECT_TRUE(report.is_manifold || (four_meet && is_curved));
  EXPECT_TRUE(report.ok() || !report.is_manifold);
  double lowest_mm = 0.0;
  for (const Vec3& p : mesh.vertices) lowest_mm = std::min(lowest_mm, p.z());
  EXPECT_NEAR(lowest_mm, -part.element_depth_mm, 1e-12);
  EXPECT_NEAR(volume_mm3(mesh), part.entrance_area_mm2 * part.thickness_mm + volume_below(part), 1e-9);
}

void expect_same_surface(const Part& a, const Part& b, double tolerance) {
  EXPECT_EQ(a.elements_full, b.elements_full);
  EXPECT_EQ(a.elements_partial, b.elements_partial);
  EXPECT_NEAR(a.retro_facet_area_mm2, b.retro_facet_area_mm2, tolerance * a.retro_facet_area_mm2);
  for (int k = 1; k < 200; ++k) {
    // Points of a low-discrepancy sequence. None of them is on a symmetry line of the arrays.
    const Vec2 p(a.spec.array.x_length_mm * std::fmod(0.618033988749895 * k, 1.0),
                 a.spec.array.y_length_mm * std::fmod(0.754877666246693 * k, 1.0));
    const HeightPlane of_a = surface_at(a, p);
    const HeightPlane of_b = surface_at(b, p);
    EXPECT_NEAR(of_a.height_mm, of_b.height_mm, tolerance) << p.transpose();
    EXPECT_NEAR((of_a.slope - of_b.slope).norm(), 0.0, tolerance) << p.transpose();
  }
}

TEST(SubstratePart, OnEverySubstrateAndOfEveryKindIsAClosedSolid) {
  for (PartSpec spec : arrays())
    for (const Substrate& substrate : substrates()) {
      spec.substrate = substrate;
      SCOPED_TRACE("base " + std::to_string(substrate.shape.index()) +
                   (substrate.element_axes == ElementAxes::normal ? " n" : " p") + " arrangement " +
                   std::to_string(static_cast<int>(spec.array.arrangement)));
      expect_solid(spec);
    }
}

/// Expects that the part has the elements whose positions place() returns.
void expect_placed(const PartSpec& spec) {
  const Part part = build_part(spec);
  std::int64_t whole = 0;
  std::int64_t cut = 0;
  double lowest = 0.0;
  for (const PlacedElement& at : place_elements(spec)) {
    ++(at.border_relation == BorderRelation::inside ? whole : cut);
    if (at.border_relation != BorderRelation::inside) continue;
    lowest = std::min(lowest, (at.frame.origin - element_depth_mm(spec.element) * at.frame.normal).z());
  }
  EXPECT_EQ(whole, part.elements_full);
  EXPECT_EQ(cut, part.elements_partial);
  EXPECT_GE(lowest, -part.element_depth_mm - 1e-12) << "the roots of whole elements lie in the part";
}

TEST(SubstratePart, PlacesTheElementsThatPartsHave) {
  for (PartSpec spec : arrays()) {
    expect_placed(spec);
    for (const Substrate& substrate : substrates()) {
      spec.substrate = substrate;
      expect_placed(spec);
    }
  }
}

TEST(SubstratePart, APlaneGivenAsAFormulaIsThePlanarArray) {
  for (PartSpec spec : arrays()) {
    const Part plain = build_part(spec);
    for (const Substrate& substrate : {formula("0"), formula("0.7", ElementAxes::parallel),
                                       Substrate{PlaneSubstrate{0.0, 33.0}, ElementAxes::normal},
                                       Substrate{PlaneSubstrate{0.0, 0.0}, ElementAxes::parallel}}) {
      spec.substrate = substrate;
      expect_same_surface(plain, build_part(spec), 1e-9);
    }
  }
}

TEST(SubstratePart, AHugeCylinderIsThePlanarArray) {
  for (PartSpec spec : arrays()) {
    const Part plain = build_part(spec);
    for (const bool along_x : {false, true})
      for (const double radius : {1e7, -1e7}) {
        spec.substrate = Substrate{CylinderSubstrate{radius, along_x}, ElementAxes::normal};
        expect_same_surface(plain, build_part(spec), 1e-6);
      }
  }
}

// Planes, cylinders and spheres are computed by closed forms. A substrate that is given by a formula is integrated
// numerically. Both must give the same part.
TEST(SubstratePart, AFormulaIsTheShapeThatItDescribes) {
  for (PartSpec spec : arrays())
    for (const auto& [shape, text] :
         {std::pair<SubstrateShape, std::string>{SphereSubstrate{8.0}, "sqrt(64 - x^2 - y^2)"},
          {CylinderSubstrate{-7.0, false}, "-sqrt(49 - x^2)"},
          {CylinderSubstrate{6.0, true}, "sqrt(36 - y^2) - 6"},
          {PlaneSubstrate{20.0, 0.0}, "x * tan(20 * pi / 180)"},
          {PlaneSubstrate{15.0, 270.0}, "-y * tan(15 * pi / 180)"}})
      for (const ElementAxes element_axes : {ElementAxes::normal, ElementAxes::parallel}) {
        spec.substrate = Substrate{shape, element_axes};
        const Part closed = build_part(spec);
        spec.substrate = formula(text, element_axes);
        Part integrated = build_part(spec);
        SCOPED_TRACE(text);
        expect_same_surface(closed, integrated, 1e-8);
      }
}

/// The normals of the facets of an inclined part are the normals of the planar part, rotated by the inclination.
TEST(SubstratePart, AnInclinedArrayIsThePlanarOneTurnedAsOne) {
  for (PartSpec spec : arrays()) {
    spec.array.x_gap_mm = spec.array.y_gap_mm = 0.0;
    spec.substrate = Substrate{PlaneSubstrate{21.0, 35.0}, ElementAxes::normal};
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(21.0 * kDeg, Vec3(std::sin(35.0 * kDeg), -std::cos(35.0 * kDeg), 0.0)).toRotationMatrix();
    std::vector<Vec3> nominal;
    const Part plain = build_part([&] {
      PartSpec level = spec;
      level.substrate.reset();
      return level;
    }());
    for (const PatchFacet& facet : plain.patches[0].facets)
      if (facet.role == FacetRole::retro_facet) nominal.emplace_back(turn * facet.normal);
    const Part inclined = build_part(spec);
    for (const PatchFacet& facet : inclined.patches[0].facets) {
      if (facet.role != FacetRole::retro_facet) continue;
      double nearest = 2.0;
      for (const Vec3& n : nominal) nearest = std::min(nearest, (n - facet.normal).norm());
      EXPECT_LT(nearest, 1e-12);
    }
    // The substrate rises by tan(21 degrees) towards the azimuth of 35 degrees. The depth of the part is the
    // height difference of the substrate plus the depth of an element.
    EXPECT_GT(inclined.element_depth_mm, std::tan(21.0 * kDeg) * spec.array.x_length_mm * std::cos(35.0 * kDeg));
  }
}

// The rim of an element is the upper edge of its outline. If all neighbours have the same orientation and their rims
// meet on the substrate, there are no vertical walls between them.
TEST(SubstratePart, CubesOnAnInclineLeaveNoWalls) {
  for (PartSpec spec : {spec_of(HexagonalCube{0.8}, Arrangement::honeycomb, 3.3, 2.9),
                        spec_of(TriangularCube{0.8}, Arrangement::triangular, 3.3, 2.9),
                        spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 3.3, 2.9)}) {
    spec.substrate = Substrate{PlaneSubstrate{25.0, std::holds_alternative<RtpElement>(spec.element) ? 0.0 : 52.0},
                               ElementAxes::normal};
    const Part part = build_part(spec);
    EXPECT_LT(inner_walls(part, Vec3::UnitZ()).area_mm2, 1e-6);
    spec.substrate->element_axes = ElementAxes::parallel;
    EXPECT_GT(inner_walls(build_part(spec), Vec3::UnitZ()).area_mm2, 1.0);
  }
}

/// The roots (valley edges) of prisms on a cylinder are spaced by one pitch, measured along the arc. They are below the
/// cylinder by the depth of an element, and every prism keeps its right angle.
TEST(SubstratePart, PrismsOnACylinderAreSpacedByArcLengthAndStandNormal) {
  const double radius = 5.0;
  PartSpec spec = spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 4.2, 2.0);
  spec.substrate = Substrate{CylinderSubstrate{radius, false}, ElementAxes::normal};
  const Part part = build_part(spec);
  const double arc = 2.0 * radius * std::asin(2.1 / radius);
  const auto columns = static_cast<int>(std::floor(arc / 0.5));
  EXPECT_EQ(part.elements_full, columns * 4);
  for (int k = 0; k < columns; ++k) {
    const double angle = (k - 0.5 * (columns - 1)) * 0.5 / radius;  // angle between the axis of the prism and z
    const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
    const Vec3 root = Vec3(2.1, 0.9, -radius) + (radius - 0.25) * normal;  // z = 0 is the highest line of the cylinder
    const HeightPlane at = surface_at(part, root.head<2>() + Vec2(1e-9, 0.0));
    EXPECT_NEAR(at.at(Vec2(1e-9, 0.0)) - at.slope.x() * 1e-9, root.z(), 1e-8) << k;
    const HeightPlane left = surface_at(part, root.head<2>() - Vec2(0.01, 0.0));
    const HeightPlane right = surface_at(part, root.head<2>() + Vec2(0.01, 0.0));
    const Vec3 a = Vec3(left.slope.x(), left.slope.y(), -1.0).normalized();
    const Vec3 b = Vec3(right.slope.x(), right.slope.y(), -1.0).normalized();
    EXPECT_NEAR(a.dot(b), 0.0, 1e-12);
    EXPECT_NEAR((a + b).normalized().dot(normal), -1.0, 1e-12);
  }
}

PartSpec pins(double aperture_mm, int columns, int rows, const Substrate& substrate) {
  PartSpec spec = spec_of(HexagonalCube{aperture_mm}, Arrangement::honeycomb, 1.5 * aperture_mm * columns,
                          0.5 * std::numbers::sqrt3 * aperture_mm * rows);
  spec.is_pin_bundle = true;
  spec.substrate = substrate;
  return spec;
}

// A bundle consists of hexagonal pins with a cube corner at the end of each pin. The axes of neighbouring pins have the
// distance d; the direction from one to the other is psi. On an incline with the angle t and the azimuth p, the height
// difference of two neighbours is d tan(t) |cos(psi - p)|. The wall between them is as long as a side of the hexagon. A
// period of the bundle contains two pins, and each pin counts three of its six sides, because two pins share a side.
TEST(PinBundle, PocketsHaveTheAreaOfTheirSteps) {
  const double aperture = 2.5;
  const double side = 0.5 * aperture;
  const double distance = std::numbers::sqrt3 * side;
  for (const double incline : {1.0, 5.0, 20.0, 35.0})
    for (const double azimuth : {0.0, 25.0, 90.0, -140.0}) {
      const PartSpec spec = pins(aperture, 3, 4, {PlaneSubstrate{incline, azimuth}, ElementAxes::parallel});
      const double t = incline * kDeg;
      double area = 0.0;
      double projected = 0.0;
      double highest = 0.0;
      for (const double psi : {30.0, 90.0, 150.0}) {
        const double along = std::abs(std::cos((psi - azimuth) * kDeg));
        // The part has twelve periods, each with two sides in each direction. The three sides along x on the border of
        // the part are not inner walls.
        const int walls = psi == 90.0 ? 24 - 3 : 24;
        area += walls * side * distance * std::tan(t) * along;
        projected += walls * side * distance * std::tan(t) * along * std::sin(t) * along;
        highest = std::max(highest, distance * std::tan(t) * along);
      }
      const Vec3 normal = substrate_surface_of(spec).normal_at(Vec2::Zero());
      const InnerWalls walls = inner_walls(build_part(spec), normal);
      EXPECT_NEAR(walls.area_mm2, area, 1e-9 * area) << incline << " " << azimuth;
      EXPECT_NEAR(walls.projected_mm2, projected, 1e-9 * projected);
      EXPECT_NEAR(walls.highest_mm, highest, 1e-9);
    }
}

// A height difference of 200 um between rows of 3 mm pins corresponds to an inclination of 5.08 degrees, because the
// pitch of the rows is 2.25 mm. Both values are reference data.
TEST(PinBundle, AStepOf200UmBetweenRowsOf3MmPinsIs5Degrees) {
  const double incline = std::atan(0.2 / 2.25) / kDeg;
  EXPECT_NEAR(incline, 5.08, 0.005);
  const Part part = build_part(pins(3.0, 3, 4, {PlaneSubstrate{incline, 0.0}, ElementAxes::parallel}));
  EXPECT_NEAR(inner_walls(part, Vec3::UnitZ()).highest_mm, 0.2, 1e-12);
}

TEST(PinBundle, OnAPlaneIsTheHoneycomb) {
  PartSpec spec = pins(2.0, 3, 3, {PlaneSubstrate{0.0, 0.0}, ElementAxes::parallel});
  const Part bundle = build_part(spec);
  spec.substrate.reset();
  spec.is_pin_bundle = false;
  const Part plain = build_part(spec);
  expect_same_surface(plain, bundle, 1e-12);
  ASSERT_EQ(plain.patches[0].facets.size(), bundle.patches[0].facets.size());
  for (std::size_t k = 0; k < plain.patches[0].facets.size(); ++k)
    EXPECT_EQ(plain.patches[0].facets[k].normal, bundle.patches[0].facets[k].normal);
}

TEST(PinBundle, WornEdgesAreRoundedOnEveryPin) {
  PartSpec spec = pins(3.0, 2, 2, {PlaneSubstrate{8.0, 20.0}, ElementAxes::parallel});
  spec.edges.root_radius_mm = 0.03;
  expect_valid(spec);
  spec.edges = {};
  spec.edges.root_chamfer_mm = 0.04;
  expect_valid(spec);
}

TEST(SubstratePart, RoundsRootsAndRimsOfElementsThatStandNormal) {
  PartSpec spec = spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 3.0, 2.0);
  spec.edges.root_radius_mm = 0.01;
  spec.substrate = Substrate{SphereSubstrate{20.0}, ElementAxes::normal};
  expect_solid(spec);
  spec.edges.rim_radius_mm = 0.01;
  spec.substrate = Substrate{PlaneSubstrate{10.0, 0.0}, ElementAxes::normal};
  expect_solid(spec);
}

// Part::patches stores groups of cells, and each patch may be placed at many positions. A large array on an incline
// therefore needs few patches. On a cylinder, a column needs few patches because the substrate is constant along the
// axis.
TEST(SubstratePart, RepeatsPatchesWhereTheSubstrateRepeats) {
  PartSpec spec = spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 100.0, 100.0);
  spec.thickness_mm = 60.0;
  spec.substrate = Substrate{PlaneSubstrate{10.0, 0.0}, ElementAxes::normal};
  const Part plane = build_part(spec);
  EXPECT_GT(plane.elements_full, 39000);
  EXPECT_LE(plane.patches.size(), 16U);
  spec.substrate = Substrate{CylinderSubstrate{300.0, false}, ElementAxes::normal};
  const Part cylinder = build_part(spec);
  std::size_t facets = 0;
  for (const SurfacePatch& patch : cylinder.patches) facets += patch.facets.size();
  EXPECT_LT(facets, 16 * 3 * 200 * 10U);  // 3 bands of 16 rows, 200 columns, 10 facets per element
  // The substrate is constant along the axis of the cylinder.
  for (int k = 0; k < 10; ++k) {
    const Vec2 p(7.13 + 4.3 * k, 40.1);
    const HeightPlane left = surface_at(cylinder, p);
    EXPECT_NEAR(left.height_mm, surface_at(cylinder, p + Vec2(0.0, 20.0)).height_mm, 1e-9);  // 20 mm along the axis
  }
}

std::string complaint(const PartSpec& spec) {
  return refusal_of([&] { check_substrate(spec); });
}

TEST(SubstrateCheck, RefusesWhatCannotCarryTheElements) {
  PartSpec spec = spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 3.0, 2.0);
  spec.substrate = Substrate{CylinderSubstrate{0.6, true}, ElementAxes::normal};
  EXPECT_EQ(complaint(spec), "refused");
  spec.substrate = Substrate{SphereSubstrate{1.5}, ElementAxes::normal};
  EXPECT_EQ(complaint(spec), "refused");
  spec.substrate = formula("0.5*sin(20*x)");
  EXPECT_EQ(complaint(spec), "refused");
  spec.substrate = formula("sqrt(1 - x^2 - y^2)");
  EXPECT_EQ(complaint(spec), "refused");
  spec.substrate = Substrate{PlaneSubstrate{44.0, 0.0}, ElementAxes::normal};
  EXPECT_EQ(complaint(spec), "refused");
  // The plane rises along the roof edges. The facets then have the slope angle acos(cos 45 cos 44), which is allowed.
  spec.substrate->shape = PlaneSubstrate{44.0, 90.0};
  EXPECT_EQ(complaint(spec), "");
  EXPECT_EQ(complaint(pins(3.0, 3, 3, {PlaneSubstrate{40.0, 90.0}, ElementAxes::parallel})), "refused");
  EXPECT_EQ(complaint(pins(3.0, 3, 3, {PlaneSubstrate{38.0, 90.0}, ElementAxes::parallel})), "");
}

TEST(SubstrateCheck, MeasuresASphere) {
  PartSpec spec = spec_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 6.0, 6.0);
  spec.substrate = Substrate{SphereSubstrate{10.0}, ElementAxes::normal};
  const SubstrateMeasures measures = check_substrate(spec);
  // The curvature is computed with the square root of a small difference, which increases its rounding error.
  EXPECT_NEAR(measures.min_radius_mm, 10.0, 1e-6);
  EXPECT_NEAR(measures.highest_mm - measures.lowest_mm, 10.0 - std::sqrt(100.0 - 18.0), 1e-9);
  EXPECT_NEAR(measures.steepest_deg, std::asin(std::sqrt(18.0) / 10.0) / kDeg, 1e-9);
  // Area of a sphere over a square: integral of R / sqrt(R^2 - x^2 - y^2), by the midpoint rule with Richardson
  // extrapolation.
  const auto midpoint = [](int n) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = -3.0 + 6.0 * (i + 0.5) / n;
        const double y = -3.0 + 6.0 * (j + 0.5) / n;
        sum += 10.0 / std::sqrt(100.0 - x * x - y * y);
      }
    return sum * 36.0 / (n * n);
  };
  EXPECT_NEAR(measures.area_mm2, (4.0 * midpoint(200) - midpoint(100)) / 3.0, 1e-6);
}

}  // namespace
}  // namespace retrace::geometry::substrate_part_test
