// Tests of shells, the separate lenses in front of a part. Shells of index 1 must change nothing. Plates and wedges are
// compared with Fresnel's and Snell's laws, and lenses with ray matrices. Power must be conserved, and the engines must
// agree.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/part/plate.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/paths/ray_tracer.h"
#include "raytrace/sampling/lit_region.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/exit_recorder.h"

namespace retrace::testing::shells_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kIndex = 1.4917;

Vec3 normal_at(double about_x_deg, double about_y_deg) {
  return Eigen::AngleAxisd(about_y_deg * kDeg, Vec3::UnitY()) *
         (Eigen::AngleAxisd(about_x_deg * kDeg, Vec3::UnitX()) * Vec3::UnitZ());
}

/// Returns a plane-parallel shell.
Shell plate(double gap_mm, double thickness_mm, double index, const Vec3& normal = Vec3::UnitZ(),
            double absorption_per_mm = 0.0) {
  Shell shell;
  shell.inner = {{0.0, 0.0, gap_mm}, normal, 0.0};
  shell.outer = {shell.inner.vertex_mm + thickness_mm * normal, normal, 0.0};
  shell.thickness_mm = thickness_mm;
  shell.index = index;
  shell.absorption_per_mm = absorption_per_mm;
  return shell;
}

/// Returns a shell with spherical surfaces. A radius of 0 is a plane.
Shell lens(double gap_mm, double thickness_mm, double index, double outer_radius_mm, double inner_radius_mm) {
  Shell shell = plate(gap_mm, thickness_mm, index);
  if (outer_radius_mm != 0.0) shell.outer.curvature_per_mm = 1.0 / outer_radius_mm;
  if (inner_radius_mm != 0.0) shell.inner.curvature_per_mm = 1.0 / inner_radius_mm;
  return shell;
}

/// Returns a plate whose inner surface is rotated.
Shell wedge(double gap_mm, double thickness_mm, double index, double about_x_deg, double about_y_deg) {
  Shell shell = plate(gap_mm, thickness_mm, index);
  shell.inner.normal = normal_at(about_x_deg, about_y_deg);
  return shell;
}

/// Returns the power transmittance of a surface between air and a medium (Born and Wolf, 1.5.2).
double through_face(double incidence_deg, double index, bool s_polarised) {
  const double a = incidence_deg * kDeg;
  const double b = std::asin(std::sin(a) / index);
  if (a < 1e-9) return 4.0 * index / ((1.0 + index) * (1.0 + index));
  const double r = s_polarised ? std::sin(a - b) / std::sin(a + b) : std::tan(a - b) / std::tan(a + b);
  return 1.0 - r * r;
}

/// Returns a mirror behind air, so that the part itself has no losses.
Optics mirror_in_air() {
  Optics optics;
  optics.mirror_facets = true;
  return optics;
}

Optics mirrored_pmma() {
  Optics optics = pmma();
  optics.mirror_facets = true;
  return optics;
}

PathPolicy every_branch() {
  PathPolicy policy;
  policy.cutoff = 1e-13;
  policy.split_power = 0.0;
  return policy;
}

/// Returns the ledger of exact beams.
Ledger by_beams(const Part& part, const Optics& optics, const Illumination& light, double cutoff = 1e-6) {
  BeamPolicy policy;
  policy.cutoff = cutoff;
  return BeamTracer(part).trace(optics, light, {0.5}, policy).ledgers[0];
}

MonteCarloResult by_rays(const Part& part, const Optics& optics, const Illumination& light, std::uint64_t count,
                         double cone_deg = 0.5, MonteCarlo::Engine engine = MonteCarlo::Engine::embree,
                         const Entrance* entrance = nullptr) {
  return MonteCarlo(part, engine, entrance).trace(optics, light, {cone_deg}, rays(count), {});
}

void expect_same(const Ledger& a, const Ledger& b, double tolerance) {
  for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(a.power[k], b.power[k], tolerance) << kAccountNames[k];
}

const Part& cubes() {
  static const Part part = build_part(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0));
  return part;
}

const Part& plate_of_cubes() {
  static const Part part = build_part(finite(HexagonalCube{2.0}, Arrangement::honeycomb, 14.0, 10.0, 1.5));
  return part;
}

// Shells of index 1 change no result, even if they are tilted.
TEST(Shells, OfIndexOneChangeNothing) {
  Illumination light = from(23.0, 30.0);
  light.stokes = {1.0, 0.3, -0.5, -0.4};
  const Optics bare = pmma();
  Optics flat = bare;
  flat.shells = {plate(4.0, 2.0, 1.0), plate(1.0, 1.5, 1.0)};
  Optics tilted = bare;
  tilted.shells = {plate(9.0, 2.0, 1.0, normal_at(10.0, -17.0)), plate(1.0, 1.5, 1.0)};
  const Part& finite_part = plate_of_cubes();
  expect_same(by_beams(finite_part, tilted, light, 1e-4), by_beams(finite_part, bare, light, 1e-4), 1e-12);
  expect_same(by_beams(cubes(), flat, light), by_beams(cubes(), bare, light), 1e-12);
  expect_same(by_rays(finite_part, tilted, light, 4096).cones[0].ledger,
              by_rays(finite_part, bare, light, 4096).cones[0].ledger, 1e-12);
  expect_same(by_rays(cubes(), flat, light, 4096).cones[0].ledger, by_rays(cubes(), bare, light, 4096).cones[0].ledger,
              1e-12);
}

// Tests entrance faces that scatter light. Shells of index 1 must not change the result. Behind an absorbing plate, the
// accounts of the ledger must still add up to 1.
TEST(Shells, ContaminatedEntranceFacesKeepAllLight) {
  Optics bare = pmma();
  bare.entrance.haze = {0.2, 0.1};
  bare.entrance.dust = {0.1, 0.5, 0.4};
  Optics behind_air = bare;
  behind_air.shells = {plate(1.0, 1.5, 1.0)};
  Optics behind_plate = bare;
  behind_plate.shells = {plate(1.0, 1.5, kIndex, Vec3::UnitZ(), 0.02)};
  for (const auto engine : {MonteCarlo::Engine::embree, MonteCarlo::Engine::cell}) {
    const auto ledger = [&](const Optics& optics) {
      return by_rays(cubes(), optics, from(15.0, 10.0), 4096, 0.5, engine).cones[0].ledger;
    };
    expect_same(ledger(behind_air), ledger(bare), 1e-12);
    EXPECT_NEAR(ledger(behind_plate).total(), 1.0, 1e-9);
    EXPECT_LT(ledger(behind_plate)[Account::retroreflected], ledger(bare)[Account::retroreflected]);
  }
}

// A plate in front of a mirror multiplies the returned light by the transmittance of four surfaces, for s and p
// separately, and by the absorption on both passages through the plate.
TEST(Shells, PlateTransmitsBothPolarisationsTwice) {
  const Part part = build_plate({6.0, 5.0}, 0.1);
  for (const double incidence : {0.0, 20.0, 45.0, 70.0})
    for (const double absorption_per_mm : {0.0, 0.08}) {
      Optics optics = mirror_in_air();
      const double thickness_mm = 2.5;
      optics.shells = {plate(3.0, thickness_mm, kIndex, Vec3::UnitZ(), absorption_per_mm)};
      const double inside = std::asin(std::sin(incidence * kDeg) / kIndex);
      const double kept = std::exp(-2.0 * absorption_per_mm * thickness_mm / std::cos(inside));
      const auto expected = [&](bool s) { return std::pow(through_face(incidence, kIndex, s), 4.0) * kept; };
      for (const double q : {-1.0, 1.0, 0.0}) {
        Illumination light = from(incidence);
        light.stokes = {1.0, q, 0.0, 0.0};  // the first axis is in the plane of incidence
        const double factor = 0.5 * (1.0 - q) * expected(true) + 0.5 * (1.0 + q) * expected(false);
        const Optics bare = mirror_in_air();
        const auto returned = [](const Ledger& ledger) {
          return ledger[Account::retroreflected] + ledger[Account::returned_elsewhere];
        };
        const Ledger beams = by_beams(part, optics, light, 1e-13);
        EXPECT_NEAR(returned(beams) / returned(by_beams(part, bare, light, 1e-13)), factor, 1e-11)
            << incidence << " " << q;
        EXPECT_NEAR(beams.total(), 1.0, 1e-12);
        const Ledger sampled = by_rays(part, optics, light, 2048).cones[0].ledger;
        EXPECT_NEAR(returned(sampled) / returned(by_rays(part, bare, light, 2048).cones[0].ledger), factor, 1e-11);
        EXPECT_NEAR(sampled.total(), 1.0, 1e-12);
      }
    }
}

// At normal incidence, a plate multiplies the efficiency of cube corners by the transmittance of four surfaces. This
// includes the light that the entrance face reflects.
TEST(Shells, PlateReducesTheEfficiencyOfCubeCornersForAllEngines) {
  const double factor = std::pow(through_face(0.0, 1.6, true), 4.0);
  Optics optics = mirrored_pmma();
  const double bare = by_beams(cubes(), optics, from(0.0))[Account::retroreflected];
  const double bare_cells =
      by_rays(cubes(), optics, from(0.0), 8192, 0.5, MonteCarlo::Engine::cell).cones[0].ledger[Account::retroreflected];
  const double bare_rays = by_rays(cubes(), optics, from(0.0), 8192).cones[0].ledger[Account::retroreflected];
  optics.shells = {plate(3.0, 2.0, 1.6)};
  EXPECT_NEAR(by_beams(cubes(), optics, from(0.0))[Account::retroreflected], factor * bare, 3e-6);
  const Ledger cells = by_rays(cubes(), optics, from(0.0), 8192, 0.5, MonteCarlo::Engine::cell).cones[0].ledger;
  EXPECT_NEAR(cells[Account::retroreflected], factor * bare_cells, 1e-4);
  EXPECT_NEAR(cells.total(), 1.0, 1e-9);
  EXPECT_NEAR(by_rays(cubes(), optics, from(0.0), 8192).cones[0].ledger[Account::retroreflected], factor * bare_rays,
              1e-4);
}

// Beams, rays and cells agree in all accounts, for absorbing and tilted plates and polarised light.
TEST(Shells, EnginesAgree) {
  Illumination light = from(17.0, 40.0);
  light.stokes = {1.0, 0.5, 0.4, -0.3};
  Optics optics = pmma();
  optics.shells = {plate(9.0, 2.0, 1.6, Vec3::UnitZ(), 0.03), plate(2.0, 1.0, 1.4, Vec3::UnitZ(), 0.1)};
  const Ledger beams = by_beams(cubes(), optics, light);
  expect_same(by_rays(cubes(), optics, light, 1U << 17).cones[0].ledger, beams, 1e-3);
  expect_same(by_rays(cubes(), optics, light, 1U << 17, 0.5, MonteCarlo::Engine::cell).cones[0].ledger, beams, 1e-3);
  optics.shells[0].outer.normal = optics.shells[0].inner.normal = normal_at(-12.0, 25.0);
  // The exact engine truncates weak beams. Their power is missing from the other accounts.
  const Ledger exact = by_beams(plate_of_cubes(), optics, light, 1e-5);
  expect_same(by_rays(plate_of_cubes(), optics, light, 1U << 17).cones[0].ledger, exact,
              1e-3 + exact[Account::truncated]);
  EXPECT_LT(exact[Account::truncated], 0.03);
}

// A wedge deflects light as Snell's law requires at each surface, in both directions.
TEST(Shells, WedgeDeflectsLikeAPrism) {
  for (const double angle : {2.0, -7.0, 15.0})
    for (const double incidence : {0.0, 12.0, -30.0}) {
      const Shells shells = {wedge(5.0, 3.0, kIndex, 0.0, angle)};
      const double inside = std::asin(std::sin(incidence * kDeg) / kIndex);
      const double behind = angle * kDeg + std::asin(kIndex * std::sin(inside - angle * kDeg));
      const auto towards = [](double t) { return Vec3(-std::sin(t), 0.0, -std::cos(t)); };
      ShellRay ray{{0.3, 0.2, 20.0}, towards(incidence * kDeg), {}};
      ShellLosses losses;
      ASSERT_TRUE(pass_shells(shells, ShellPassage::to_part, ray, losses));
      EXPECT_LT((ray.direction - towards(behind)).norm(), 1e-14) << angle << " " << incidence;
      EXPECT_NEAR(ray.light.power() + losses.reflected, 1.0, 1e-14);
      ray.direction = -ray.direction;
      ASSERT_TRUE(pass_shells(shells, ShellPassage::from_part, ray, losses));
      EXPECT_LT((ray.direction + towards(incidence * kDeg)).norm(), 1e-14);
    }
}

// Cube corners behind a wedge return light to the source, because each path is reversed. The efficiency is that for
// light from the deflected direction without a wedge, times the transmittance of four surfaces.
TEST(Shells, CubeCornersBehindAWedgeReturnLightToTheSource) {
  const double angle = 5.0;
  const double incidence = 10.0;
  Optics optics = ideal();
  const double inside = std::asin(std::sin(incidence * kDeg) / kIndex);
  const double behind_deg = angle + std::asin(kIndex * std::sin(inside - angle * kDeg)) / kDeg;
  const double bare =
      by_rays(plate_of_cubes(), optics, from(behind_deg), 1U << 16).cones[0].ledger[Account::retroreflected];
  optics.shells = {wedge(4.0, 3.0, kIndex, 0.0, angle)};
  const auto through = [&](bool s) {
    return std::pow(through_face(incidence, kIndex, s) * through_face(behind_deg - angle, kIndex, s), 2.0);
  };
  const MonteCarloResult result = by_rays(plate_of_cubes(), optics, from(incidence), 1U << 16, 1e-4);
  const Ledger& ledger = result.cones[0].ledger;
  EXPECT_NEAR(ledger[Account::retroreflected], bare * 0.5 * (through(true) + through(false)), 2e-3);
  EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
  EXPECT_LT(ledger[Account::transmitted], 1e-5);
}

/// Ray height and angle behind a surface, for paraxial light (Hecht, Optics, 6.2.1).
struct Paraxial {
  double height;
  double angle;
  void refract(double before, double behind, double curvature) {
    angle = (before * angle - height * (behind - before) * curvature) / behind;
  }
  void travel(double length) { height += length * angle; }
};

// A lens in front of a mirror returns light at the angle that ray matrices give.
TEST(Shells, LensInFrontOfAMirrorFollowsRayMatrices) {
  const double thickness = 2.0;
  const double gap = 5.0;
  const double air = 0.5;  // thickness of the part, whose body is air
  const Part part = build_plate({8.0, 6.0}, air);
  const Vec2 centre(4.0, 3.0);
  const BackSurface back(part, centre);
  for (const auto& [outer, inner] : {std::pair(40.0, 0.0), {0.0, -60.0}, {50.0, 45.0}, {-80.0, 0.0}}) {
    Optics optics = mirror_in_air();
    optics.shells = {lens(gap, thickness, kIndex, outer, inner)};
    const double c1 = optics.shells[0].outer.curvature_per_mm;
    const double c2 = optics.shells[0].inner.curvature_per_mm;
    const double height = 1e-3;
    Paraxial ray{height, 0.0};
    ray.refract(1.0, kIndex, c1);
    ray.travel(thickness);
    ray.refract(kIndex, 1.0, c2);
    ray.travel(2.0 * (gap + air));
    ray.refract(1.0, kIndex, -c2);
    ray.travel(thickness);
    ray.refract(kIndex, 1.0, -c1);
    const PathSetup setup(part, back, centre, optics, from(0.0), {0.5}, every_branch());
    Tally tally(1);
    ExitRecorder exits;
    PathWalker(setup, tally, &exits).trace({height, 0.0}, {1, 2}, 0, 0);
    const ExitRecorder::Exit& exit = exits.strongest();
    EXPECT_NEAR(exit.direction.x() / exit.direction.z(), ray.angle, 1e-6 * std::abs(ray.angle))
        << outer << " " << inner;
    EXPECT_NEAR(exit.position.x(), ray.height, 1e-6 * height);
    EXPECT_NEAR(exit.position.z(), air + gap + thickness, 1e-6);
  }
}

// At the distance g behind a thin lens of focal length f, the width of a beam has changed by the factor 1 - g / f. The
// area of the region of the incident beam is therefore the area of the entrance face divided by the square of this
// factor.
TEST(Shells, RegionOfTheBeamIsTheFaceMagnifiedByTheLens) {
  const Polygon outline = to_polygon(Rectangle{{-0.02, -0.01}, {0.02, 0.01}});
  for (const double radius : {50.0, -50.0, 20.0}) {
    const double gap = 6.0;
    const double thickness = 1e-4;
    const LitRegion region({lens(gap, thickness, kIndex, radius, 0.0)}, Vec3::UnitZ(), outline, 0.0);
    const double factor = 1.0 - gap * (kIndex - 1.0) / radius;
    EXPECT_NEAR(region.area_ratio(), 1.0 / (factor * factor), 1e-4 * region.area_ratio()) << radius;
  }
}

// A plate that is treated as a lens of very large radius gives the results of a plate. A plate displaces light at
// oblique incidence, but the beam still covers the whole entrance face, and nothing passes next to the part.
TEST(Shells, LensesOfLargeRadiusAreLikePlates) {
  const Part& part = plate_of_cubes();
  for (const double incidence : {0.0, 35.0}) {
    Optics optics = mirrored_pmma();
    optics.shells = {plate(3.0, 2.0, kIndex)};
    const Ledger flat = by_rays(part, optics, from(incidence, 20.0), 1U << 16).cones[0].ledger;
    optics.shells = {lens(3.0, 2.0, kIndex, 1e8, 1e8)};
    const MonteCarloResult curved = by_rays(part, optics, from(incidence, 20.0), 1U << 16);
    expect_same(curved.cones[0].ledger, flat, 3e-3);
    EXPECT_NEAR(curved.beam_area_ratio, 1.0, 1e-6);
    EXPECT_LT(curved.cones[0].ledger[Account::transmitted], 1e-5);
  }
}

// The light that enters through a lens meets the part and does not pass beside it. This is also tested at oblique
// incidence, and for a curved entrance surface that is higher than the rim of the lens.
TEST(Shells, LensLightsTheWholePart) {
  const Part part = build_plate({8.0, 6.0}, 0.5);
  for (const double incidence : {0.0, 25.0}) {
    Optics optics = mirror_in_air();
    optics.shells = {lens(2.0, 2.0, kIndex, 30.0, 28.0)};
    const MonteCarloResult result = by_rays(part, optics, from(incidence, 50.0), 1U << 14, 89.0);
    EXPECT_LT(result.cones[0].ledger[Account::transmitted], 2e-4) << incidence;
    EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
  }
  const Entrance dome = sphere_entrance(30.0, 0.7, {4.0, 3.0});
  Optics optics = mirrored_pmma();
  optics.shells = {lens(0.1, 2.0, kIndex, 32.0, 30.0)};
  const MonteCarloResult result = by_rays(part, optics, from(0.0), 1U << 13, 0.5, MonteCarlo::Engine::embree, &dome);
  // The lens deflects the light, and a small fraction of it passes beside the lower rim of the dome.
  EXPECT_LT(result.cones[0].ledger[Account::transmitted], 1e-3);
  EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
}

// For random shells, the accounts of the ledger add up to 1, and no ray is lost.
TEST(Shells, LedgersAddUpToOne) {
  std::mt19937_64 generator(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  const auto curvature = [&] { return (between(0.0, 1.0) < 0.3 ? 0.0 : 1.0) / between(60.0, 400.0); };
  for (int k = 0; k < 24; ++k) {
    Optics optics = pmma();
    for (const double gap : {16.0, 6.0}) {
      Shell shell =
          plate(gap, 3.0, between(1.2, 1.8), normal_at(between(-10.0, 10.0), between(-10.0, 10.0)), between(0.0, 0.05));
      shell.outer.curvature_per_mm = between(-1.0, 1.0) < 0.0 ? -curvature() : curvature();
      shell.inner.curvature_per_mm = shell.outer.curvature_per_mm * between(0.7, 1.3);
      shell.inner.normal = normal_at(between(-10.0, 10.0), between(-10.0, 10.0));
      optics.shells.push_back(shell);
    }
    Illumination light = from(between(0.0, 50.0), between(0.0, 360.0));
    light.stokes = {1.0, 0.6, -0.3, 0.5};
    const MonteCarloResult result = by_rays(plate_of_cubes(), optics, light, 2048);
    const Ledger& ledger = result.cones[0].ledger;
    EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
    EXPECT_EQ(ledger[Account::lost], 0.0);
    EXPECT_GT(ledger[Account::shell_reflected], 0.02);
    for (const double power : ledger.power) EXPECT_GE(power, 0.0);
  }
}

// A plate displaces a ray on its way in and on its way out. A ray that starts behind the plate crosses it only on its
// way out.
TEST(Shells, RaysFromOutsideAreDisplacedByAPlate) {
  const double thickness = 2.0;
  const double gap = 3.0;
  const double air = 0.5;
  const Part part = build_plate({40.0, 30.0}, air);
  const double incidence = 30.0 * kDeg;
  const double inside = std::asin(std::sin(incidence) / kIndex);
  Optics optics = mirror_in_air();
  optics.shells = {plate(gap, thickness, kIndex)};
  RayTracer tracer(part, nullptr, 0.5, every_branch(), 1);
  const std::uint32_t number = tracer.add(optics);
  const Vec3 direction(std::sin(incidence), 0.0, -std::cos(incidence));
  const double top = air + gap + thickness;
  const double per_crossing = thickness * std::tan(inside);
  const double above = 4.0;
  for (const bool starts_behind : {false, true}) {
    const double height = starts_behind ? air + 1.0 : top + above;
    IncidentRay ray{{12.0, 15.0, height}, direction, light_of_beam(kUnpolarised, -direction), number};
    const TracedRays traced = tracer.trace(std::span(&ray, 1), 0, nullptr);
    ASSERT_EQ(traced.leaving.size(), 1U);
    const double in =
        starts_behind ? std::tan(incidence) * height : std::tan(incidence) * (above + gap + air) + per_crossing;
    const double out = std::tan(incidence) * (gap + air) + per_crossing;
    EXPECT_NEAR(traced.leaving[0].position_mm.x(), 12.0 + in + out, 1e-12);
    EXPECT_NEAR(traced.leaving[0].position_mm.z(), top, 1e-12);
    const auto plate_power = [&](bool s) { return std::pow(through_face(30.0, kIndex, s), starts_behind ? 2.0 : 4.0); };
    EXPECT_NEAR(traced.leaving[0].light.power(), 0.5 * (plate_power(true) + plate_power(false)), 1e-12);
    EXPECT_NEAR(traced.ledger.ledger.total(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace retrace::testing::shells_test
