// Tests of single cube corners with a circular face. Closed forms give the effective aperture and the effects of mount
// and chamfer. Results of beams are also compared with results of rays and of hexagonal cube corners.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/outline/plan_region.h"
#include "raytrace/paths/ray_tracer.h"
#include "tests/support/engines.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/outlined_parts.h"

namespace retrace::testing::round_cube_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kDiameter = 38.1;
constexpr double kSilica = 1.4607;
/// Tolerance for areas of intersections. The reference uses circles, and the part uses polygons with 180 sides.
constexpr double kPolygons = 2e-4;

PartSpec part_of(const RoundCube& cube, double plate_mm = 0.86) {
  return single(cube, plate_mm);
}

double length_mm(const PartSpec& spec) {
  return element_depth_mm(spec.element) + spec.thickness_mm;
}

/// Returns optics of an entrance face without reflection. Walls absorb all light, so the cylinder returns no light.
Optics lossless(double index, bool has_mirrors) {
  Optics optics;
  optics.index = index;
  optics.mirror_facets = has_mirrors;
  optics.lossless_entrance = true;
  optics.absorbing_walls = true;
  return optics;
}

Ledger beams(const PartSpec& spec, const Optics& optics, const Illumination& light, double cone_deg = 0.01) {
  BeamPolicy policy;
  policy.cutoff = 1e-7;
  return BeamTracer(build_part(spec)).trace(optics, light, {cone_deg}, policy).ledgers[0];
}

/// Returns the area of the intersection of two equal circles, divided by the area of one circle.
double overlap(double radius_mm, double separation_mm) {
  const double x = separation_mm / (2.0 * radius_mm);
  return x >= 1.0 ? 0.0 : 2.0 * (std::acos(x) - x * std::sqrt(1.0 - x * x)) / std::numbers::pi;
}

double tan_refracted(double incidence_deg, double index) {
  const double sine = std::sin(incidence_deg * std::numbers::pi / 180.0) / index;
  return sine / std::sqrt(1.0 - sine * sine);
}
double tan_deg(double angle_deg) {
  return std::tan(angle_deg * std::numbers::pi / 180.0);
}

/// Returns the maximum cosine of the angle of incidence over the three facets, which are perpendicular to each other.
double max_facet_cosine(double incidence_deg, double azimuth_deg, double index) {
  const double sine = std::sin(incidence_deg * std::numbers::pi / 180.0) / index;
  const double cosine = std::sqrt(1.0 - sine * sine);
  double most = 0.0;
  for (const double facet_deg : {60.0, 180.0, 300.0}) {
    const double across = std::cos((azimuth_deg - facet_deg) * std::numbers::pi / 180.0);
    most = std::max(most, std::abs(std::sqrt(2.0) * sine * across - cosine) / std::sqrt(3.0));
  }
  return most;
}

/// Centre of a disc, projected onto the plane of the entrance face along the direction to the source.
struct CirclePosition {
  double at_mm;
  double radius_mm;
};

/// Returns the area of the intersection of several discs, divided by the area of one disc. The area is determined by
/// counting points of a grid.
double common_area(const std::vector<CirclePosition>& discs, double radius_mm) {
  constexpr int kPoints = 800;
  const double step = 2.0 * radius_mm / kPoints;
  int inside = 0;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double x = -radius_mm + (i + 0.5) * step;
      const double y = -radius_mm + (j + 0.5) * step;
      bool is_in_all = true;
      for (const CirclePosition& disc : discs) is_in_all &= std::hypot(x - disc.at_mm, y) <= disc.radius_mm;
      inside += is_in_all ? 1 : 0;
    }
  return inside * step * step / (std::numbers::pi * radius_mm * radius_mm);
}

TEST(RoundCube, FaceHasTheAreaOfTheCircle) {
  const Part part = build_part(part_of({kDiameter}));
  EXPECT_NEAR(part.entrance_area_mm2, 0.25 * std::numbers::pi * kDiameter * kDiameter, 1e-9);
  EXPECT_EQ(part.outline.size(), 180U);
  EXPECT_EQ(part.elements_full, 1);
  EXPECT_NEAR(part.element_depth_mm, kDiameter / std::numbers::sqrt2, 1e-12);
  // All facets have the same inclination, so their area follows from the area of the entrance face.
  EXPECT_NEAR(part.retro_facet_area_mm2, std::numbers::sqrt3 * part.entrance_area_mm2, 1e-9);
}

TEST(RoundCube, SolidsAreClosed) {
  for (const double plate_mm : {1e-6, 0.86, 5.0}) expect_closed_part(part_of({kDiameter}, plate_mm));
  PartSpec errors = part_of({kDiameter, {3.0, 40.0}}, 3.0);
  errors.angle_errors.dihedral_error_arcmin = {3.0, -2.0, 1.0};
  expect_closed_part(errors);
}

// The light that returns enters through the intersection of two circles. The first circle is the entrance face. The
// second circle is the point reflection of the entrance face in the apex, projected onto the face along the refracted
// light.
TEST(RoundCube, MirrorsReturnTheOverlapOfTwoCircles) {
  for (const double plate_mm : {1e-6, 0.86, 6.0}) {
    const PartSpec spec = part_of({kDiameter}, plate_mm);
    for (const double azimuth_deg : {0.0, 37.0, 60.0, 180.0})
      for (const double incidence_deg : {0.0, 5.0, 15.0, 30.0, 45.0}) {
        const Ledger ledger = beams(spec, lossless(kSilica, true), from(incidence_deg, azimuth_deg));
        const double shift_mm = 2.0 * length_mm(spec) * tan_refracted(incidence_deg, kSilica);
        EXPECT_NEAR(ledger[Account::retroreflected], overlap(0.5 * kDiameter, shift_mm), kPolygons)
            << plate_mm << " " << incidence_deg << " " << azimuth_deg;
        EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
      }
  }
}

// If the reflection at all facets is total, an uncoated cube corner returns the same fraction of light as a cube corner
// with mirrors. Otherwise, the uncoated cube corner returns less light.
TEST(RoundCube, TotalReflectionReturnsTheOverlapUpToItsLimit) {
  const PartSpec spec = part_of({kDiameter});
  const double critical = std::sqrt(1.0 - 1.0 / (kSilica * kSilica));
  int total = 0;
  int partial = 0;
  for (const double azimuth_deg : {0.0, 25.0, 60.0, 120.0, 180.0})
    for (const double incidence_deg : {0.0, 4.0, 10.0, 20.0, 30.0}) {
      const Ledger ledger = beams(spec, lossless(kSilica, false), from(incidence_deg, azimuth_deg));
      const double expected = overlap(0.5 * kDiameter, 2.0 * length_mm(spec) * tan_refracted(incidence_deg, kSilica));
      const std::string name = std::to_string(incidence_deg) + " " + std::to_string(azimuth_deg);
      if (max_facet_cosine(incidence_deg, azimuth_deg, kSilica) < critical) {
        EXPECT_NEAR(ledger[Account::retroreflected], expected, kPolygons) << name;
        ++total;
      } else {
        EXPECT_LT(ledger[Account::retroreflected], expected - 0.01) << name;
        ++partial;
      }
    }
  EXPECT_GE(total, 12);
  EXPECT_GE(partial, 4);
}

// Without absorption, all light returns at normal incidence, including light that the face reflects several times.
TEST(RoundCube, ReturnsAllLightAtNormalIncidence) {
  Optics silica;
  silica.index = kSilica;
  BeamPolicy policy;
  policy.cutoff = 1e-9;
  const Ledger ledger =
      BeamTracer(build_part(part_of({kDiameter}))).trace(silica, from(0.0), {0.01}, policy).ledgers[0];
  EXPECT_NEAR(ledger[Account::retroreflected], 1.0, 1e-6);
}

// The reference is the intersection of four discs that the light crosses: the edge of the mount and the face on its way
// in, and the face and the edge on its way out. Their positions follow from the directions of the light in air and in
// the body.
TEST(RoundCube, MountReturnsTheCommonAreaOfItsDiscs) {
  for (const auto& [recess_mm, mount_mm, index] :
       {std::tuple{3.0, kDiameter, kSilica}, std::tuple{8.0, kDiameter, kSilica},
        std::tuple{4.0, 0.8 * kDiameter, kSilica}, std::tuple{5.0, 1.1 * kDiameter, 1.0},
        std::tuple{0.0, 0.7 * kDiameter, kSilica}}) {
    RoundCube cube{kDiameter};
    cube.recess_mm = recess_mm;
    cube.mount_diameter_mm = mount_mm;
    const PartSpec spec = part_of(cube);
    for (const double incidence_deg : {0.0, 7.0, 20.0, 35.0}) {
      const double radius_mm = 0.5 * kDiameter;
      const double face_mm = 2.0 * length_mm(spec) * tan_refracted(incidence_deg, index);
      const double edge_mm = recess_mm * tan_deg(incidence_deg);
      const double expected = common_area(
          {{0.0, radius_mm}, {-edge_mm, 0.5 * mount_mm}, {face_mm, radius_mm}, {face_mm + edge_mm, 0.5 * mount_mm}},
          radius_mm);
      const Ledger ledger = beams(spec, lossless(index, true), from(incidence_deg, 37.0));
      const std::string name = std::to_string(recess_mm) + " " + std::to_string(incidence_deg);
      EXPECT_NEAR(ledger[Account::retroreflected], expected, kPolygons) << name;
      EXPECT_NEAR(ledger.total(), 1.0, 1e-9) << name;
      const double entering = common_area({{0.0, radius_mm}, {-edge_mm, 0.5 * mount_mm}}, radius_mm);
      EXPECT_GE(ledger[Account::stopped], 1.0 - entering - kPolygons) << name;
    }
  }
}

TEST(RoundCube, ChamferReducesTheFace) {
  RoundCube cube{kDiameter};
  cube.chamfer_mm = 1.2;
  const PartSpec spec = part_of(cube);
  const double ratio = 1.0 - 2.0 * cube.chamfer_mm / kDiameter;
  for (const double incidence_deg : {0.0, 10.0, 25.0}) {
    const Ledger ledger = beams(spec, lossless(kSilica, true), from(incidence_deg));
    const double shift_mm = 2.0 * length_mm(spec) * tan_refracted(incidence_deg, kSilica);
    EXPECT_NEAR(ledger[Account::retroreflected], ratio * ratio * overlap(0.5 * kDiameter * ratio, shift_mm), kPolygons);
    EXPECT_GE(ledger[Account::stopped], 1.0 - ratio * ratio - 1e-12);
    EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
  }
  // The outer side of the chamfer must not return light by reflection either.
  Optics silica;
  silica.index = kSilica;
  const Ledger ledger = beams(spec, silica, from(0.0));
  EXPECT_NEAR(ledger[Account::stopped], 1.0 - ratio * ratio, 1e-9);
  EXPECT_NEAR(ledger[Account::retroreflected], ratio * ratio, 1e-6);
}

// The outer side of the face reflects light by the law of reflection. Unlike the light from the cube corner, this light
// does not travel back to the source.
TEST(RoundCube, MountStopsTheReflectionOfTheFace) {
  RoundCube cube{kDiameter};
  cube.recess_mm = 6.0;
  cube.mount_diameter_mm = kDiameter;
  const PartSpec spec = part_of(cube);
  constexpr double kIncidence = 25.0;
  Optics silica;
  silica.index = kSilica;
  silica.absorbing_walls = true;
  const Ledger ledger = beams(spec, silica, from(kIncidence));
  const double radius_mm = 0.5 * kDiameter;
  const double edge_mm = cube.recess_mm * tan_deg(kIncidence);
  const double cosine = std::cos(kIncidence * std::numbers::pi / 180.0);
  const double inside = std::sqrt(1.0 - std::pow(std::sin(kIncidence * std::numbers::pi / 180.0) / kSilica, 2.0));
  const double s = (cosine - kSilica * inside) / (cosine + kSilica * inside);
  const double p = (kSilica * cosine - inside) / (kSilica * cosine + inside);
  const double common = common_area({{0.0, radius_mm}, {-edge_mm, radius_mm}, {edge_mm, radius_mm}}, radius_mm);
  EXPECT_NEAR(ledger[Account::front_specular], 0.5 * (s * s + p * p) * common, 1e-5);
}

TEST(RoundCube, BeamsAndRaysAgree) {
  RoundCube cube{kDiameter};
  cube.recess_mm = 4.0;
  cube.mount_diameter_mm = 0.95 * kDiameter;
  cube.chamfer_mm = 0.7;
  Optics mirrors;
  mirrors.index = kSilica;
  mirrors.absorption_per_mm = 0.002;
  mirrors.facet_layers = opaque({0.8, 6.0});
  Optics uncoated;
  uncoated.index = kSilica;
  Optics hollow;
  hollow.facet_layers = opaque({0.8, 6.0});
  for (const Optics& optics : {mirrors, uncoated, hollow})
    for (const double incidence_deg : {0.0, 12.0, 28.0}) {
      const Part part = build_part(part_of(cube));
      BeamPolicy policy;
      policy.cutoff = 1e-6;
      const Ledger exact = BeamTracer(part).trace(optics, from(incidence_deg, 50.0), {0.5}, policy).ledgers[0];
      const ConeResult traced =
          MonteCarlo(part).trace(optics, from(incidence_deg, 50.0), {0.5}, rays(1U << 15), {}).cones[0];
      EXPECT_NEAR(exact.total(), 1.0, 1e-9);
      EXPECT_NEAR(traced.ledger.total(), 1.0, 1e-9);
      EXPECT_NEAR(exact[Account::retroreflected], traced.rre,
                  4.0 * traced.std_error + exact[Account::truncated] + 1e-4);
      for (std::size_t k = 0; k < kAccountCount; ++k)
        EXPECT_NEAR(exact.power[k], traced.ledger.power[k], exact[Account::truncated] + 3e-3)
            << incidence_deg << " " << kAccountNames[k];
    }
}

// An entrance surface that coincides with the plane face must give the same results. For such a surface, other
// functions of the tracer test whether rays meet the chamfer or the mount.
TEST(RoundCube, AnEntranceSurfaceInThePlaneOfTheFaceChangesNothing) {
  RoundCube cube{kDiameter};
  cube.recess_mm = 4.0;
  cube.mount_diameter_mm = 0.95 * kDiameter;
  cube.chamfer_mm = 0.7;
  const Part part = build_part(part_of(cube));
  Optics silica;
  silica.index = kSilica;
  const Entrance plane = plane_entrance(part.thickness_mm);
  for (const double incidence_deg : {0.0, 15.0, 30.0}) {
    const Illumination light = from(incidence_deg, 70.0);
    const ConeResult a = MonteCarlo(part).trace(silica, light, {0.5}, rays(1U << 15), {}).cones[0];
    const ConeResult b =
        MonteCarlo(part, MonteCarlo::Engine::embree, &plane).trace(silica, light, {0.5}, rays(1U << 15), {}).cones[0];
    for (std::size_t k = 0; k < kAccountCount; ++k)
      EXPECT_NEAR(a.ledger.power[k], b.ledger.power[k], 3e-3) << incidence_deg << " " << kAccountNames[k];
    EXPECT_NEAR(b.ledger.total(), 1.0, 1e-9);
  }
}

// A hexagonal outline cuts the circular face. The result must be equal to a hexagonal cube corner.
TEST(RoundCube, WithAHexagonalOutlineIsTheHexagonalCube) {
  constexpr double kAperture = 10.0;
  std::vector<Vec2> corners;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3.0;
    corners.emplace_back(0.5 * kAperture * std::cos(angle), 0.5 * kAperture * std::sin(angle));
  }
  RoundCube cube{1.2 * kAperture};
  cube.outline = plan_of_outline(oriented({polygon_of_corners(corners)}));
  PartSpec round = part_of(cube, 0.5);
  PartSpec hexagonal = single(HexagonalCube{kAperture}, 0.5 + 0.2 * kAperture / std::numbers::sqrt2);
  for (PartSpec* const spec : {&round, &hexagonal}) spec->angle_errors.dihedral_error_arcmin = {0.5, -0.2, 0.1};
  for (const Optics& optics : {pmma(), ideal()})
    for (const double incidence_deg : {0.0, 8.0, 25.0}) {
      const Ledger a = beams(round, optics, from(incidence_deg, 20.0), 0.5);
      const Ledger b = beams(hexagonal, optics, from(incidence_deg, 20.0), 0.5);
      EXPECT_NEAR(a[Account::retroreflected], b[Account::retroreflected], 1e-9) << incidence_deg;
    }
}

// Light sees a hollow cube corner as a cube corner with the refractive index 1. Its effective aperture therefore
// follows from the direction of the light in air.
TEST(RoundCube, HollowCubeReturnsTheOverlapInAir) {
  Optics hollow;
  hollow.mirror_facets = true;
  const PartSpec spec = part_of({kDiameter});
  for (const double incidence_deg : {0.0, 10.0, 20.0, 30.0}) {
    const Ledger ledger = beams(spec, hollow, from(incidence_deg, 15.0));
    EXPECT_NEAR(ledger[Account::retroreflected],
                overlap(0.5 * kDiameter, 2.0 * length_mm(spec) * tan_deg(incidence_deg)), kPolygons);
    EXPECT_EQ(ledger[Account::front_specular], 0.0);
    // Light that misses a mirror leaves through the plane of the face or through the side of the cylinder.
    EXPECT_NEAR(ledger[Account::retroreflected] + ledger[Account::side_exit] + ledger[Account::returned_elsewhere], 1.0,
                1e-9);
  }
}

/// Returns the ledger for a single ray of power 1. The position is relative to the centre of the face.
RayLedger ray_through(const Part& part, const Vec3& position_mm, const Vec3& direction) {
  RayTracer tracer(part, nullptr, 0.5, {}, 1);
  IncidentRay ray;
  ray.optics = tracer.add(lossless(kSilica, true));
  const Vec2 centre = bounding_box(part.outline).centre();
  ray.position_mm = {position_mm.x() + centre.x(), position_mm.y() + centre.y(), position_mm.z() + part.thickness_mm};
  ray.direction = direction.normalized();
  ray.light.stokes = kUnpolarised;
  ray.light.s_axis = ray.direction.unitOrthogonal();
  return tracer.trace(std::span(&ray, 1), 0, nullptr).ledger;
}

TEST(RoundCube, MountStopsSingleRays) {
  RoundCube cube{20.0};
  cube.recess_mm = 5.0;
  cube.mount_diameter_mm = 16.0;
  const Part part = build_part(part_of(cube));
  const Vec3 down = -Vec3::UnitZ();
  EXPECT_NEAR(ray_through(part, {2.0, 1.0, 50.0}, down).ledger[Account::retroreflected], 1.0, 1e-12);
  EXPECT_NEAR(ray_through(part, {9.0, 0.0, 50.0}, down).ledger[Account::stopped], 1.0, 1e-12);
  // This ray starts between the face and the edge of the mount, so the mount can block it only on its way back.
  EXPECT_NEAR(ray_through(part, {9.0, 0.0, 1.0}, down).ledger[Account::stopped], 1.0, 1e-12);
  EXPECT_NEAR(ray_through(part, {7.5, 0.0, 1.0}, down).ledger[Account::retroreflected], 1.0, 1e-12);
  // This ray meets the face at x = -1 mm and leaves it near x = 7 mm. On its way back, it crosses the plane of the
  // mount's edge outside the circular opening.
  EXPECT_NEAR(ray_through(part, {14.0, 0.0, 50.0}, {-0.3, 0.0, -1.0}).ledger[Account::stopped], 1.0, 1e-12);
  EXPECT_NEAR(ray_through(part, {15.0, 0.0, 50.0}, {-0.3, 0.0, -1.0}).ledger[Account::retroreflected], 1.0, 1e-12);
  EXPECT_EQ(ray_through(part, {30.0, 0.0, 50.0}, down).rays_missed, 1U);
}

}  // namespace
}  // namespace retrace::testing::round_cube_test
