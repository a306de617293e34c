// Tests of arrays of cube corners: sums of single cubes, ranges, pulses and single shots.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "raytrace/light/light_setup.h"
#include "studies/ranging/aberration.h"
#include "studies/ranging/lit_cubes.h"
#include "studies/ranging/ranging.h"

namespace retrace::testing::ranging_array_test {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::Stokes;
using studies::ArrayCube, studies::CubeCorner, studies::CubeEcho, studies::CubeSet, studies::LitCubes;

constexpr double kArcsec = std::numbers::pi / (180.0 * 3600.0);

design::Design cube_design(const std::string& errors = "[0.02, 0.02, 0.02]") {
  return design::parse_design(
      "schema = \"retrace.design/1\"\n[element]\nkind = \"hexagonal_icc\"\naperture_mm = 25\n[array]\narrangement = "
      "\"single\"\n[body]\nrefractive_index = 1.46\nthickness_mm = 0.5\n[surface]\nwalls = \"absorbing\"\n"
      "dihedral_error_arcmin = " +
          errors + "\n[light]\nwavelength_nm = 532\n",
      "cube.toml");
}

CubeSet set_of(std::vector<ArrayCube> cubes) {
  CubeSet set;
  set.variant_of_cube.assign(cubes.size(), 0);
  set.cubes = std::move(cubes);
  set.variants.emplace_back(cube_design(), std::vector<double>{}, false);
  return set;
}

/// Returns cubes with random positions, random clocking, and axes within 40 degrees of +z.
std::vector<ArrayCube> random_array(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<ArrayCube> cubes;
  for (int k = 0; k < count; ++k) {
    ArrayCube cube;
    cube.position_mm = 100.0 * Vec3(unit(random), unit(random), unit(random));
    cube.axis = Vec3(0.4 * unit(random), 0.4 * unit(random), 1.0).normalized();
    cube.clocking_deg = 180.0 * unit(random);
    cubes.push_back(cube);
  }
  return cubes;
}

/// Returns the Stokes parameters of the light that a single cube returns. The light is traced in the part frame of this
/// cube, without using symmetries.
Stokes alone(const CubeCorner& corner, const ArrayCube& cube, const raytrace::ReturnFrame& frame, const Vec2& angles,
             const Stokes& sent) {
  const Eigen::Matrix3d own = studies::array_from_cube(cube).transpose();
  const Vec3 to_source = own * frame.to_source;
  const Vec3 right = raytrace::source_axis(to_source);
  const double c = right.dot(own * frame.right);
  const double s = right.dot(own * frame.up);
  Eigen::Matrix2d axes;  // maps the axes of the array to the axes of the cube
  axes << c, s, -s, c;
  const std::vector<Vec3> directions = {own * frame.direction(angles)};
  studies::DirectionField field = corner.field(to_source, 0, nullptr).at(directions).front();
  for (raytrace::JonesMatrix& jones : field) jones = axes.transpose() * jones * axes;
  return studies::returned_stokes(field, sent);
}

TEST(RangingArray, IsTheSumOfItsCubes) {
  const CubeSet set = set_of(random_array(6));
  const Vec3 to_source = Vec3(0.1, -0.2, 1.0).normalized();
  const LitCubes lit(set, to_source, 0, nullptr);
  ASSERT_EQ(lit.count(), 6u);
  const Stokes sent{1.0, 0.48, 0.6, -0.64};
  const std::vector<Vec2> angles = {Vec2::Zero(), 3.0 * kArcsec * Vec2(1.0, 2.0), 8.0 * kArcsec * Vec2(-1.0, 0.3)};
  const std::vector<Stokes> sums = lit.stokes(angles, sent, nullptr);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    Stokes expected;
    for (const ArrayCube& cube : set.cubes) expected += alone(set.variants[0], cube, lit.frame(), angles[k], sent);
    for (std::size_t component = 0; component < 4; ++component)
      EXPECT_NEAR(sums[k].values()[component], expected.values()[component], 1e-5 * sums[0].i);
    double of_echoes = 0.0;
    for (const CubeEcho& echo : lit.echoes(angles[k], sent)) of_echoes += echo.cross_section_m2;
    EXPECT_NEAR(of_echoes, sums[k].i, 1e-9 * sums[0].i);
  }
}

TEST(RangingArray, CubesWithTheSameIncidenceShareOneTrace) {
  const CubeSet ring = set_of(studies::cubes_of(studies::CubeRing{150.0, 60.0, 12, 5.0, 0.0, 0.0}));
  const LitCubes along_axis(ring, Vec3::UnitZ(), 0, nullptr);
  EXPECT_EQ(along_axis.count(), 12u);
  EXPECT_EQ(along_axis.traced(), 1u);
  const LitCubes below(ring, -Vec3::UnitZ(), 0, nullptr);
  EXPECT_EQ(below.count(), 0u);
  EXPECT_EQ(below.traced(), 0u);
  // The plane y = 0 is a symmetry plane of the ring. Light reaches the cubes at the azimuths a and -a from directions
  // that are mirror images of each other.
  const CubeSet symmetric = set_of(studies::cubes_of(studies::CubeRing{150.0, 60.0, 12, 0.0, 0.0, 0.0}));
  const LitCubes oblique(symmetric, Vec3(0.3, 0.0, 1.0).normalized(), 0, nullptr);
  EXPECT_EQ(oblique.traced(), 7u);
}

TEST(RangingArray, RangesFollowFromPositionsAndPaths) {
  const CubeSet set = set_of(random_array(5));
  const Vec3 to_source = Vec3(-0.2, 0.1, 1.0).normalized();
  const std::vector<CubeEcho> echoes =
      LitCubes(set, to_source, 0, nullptr).echoes(Vec2::Zero(), raytrace::kUnpolarised);
  ASSERT_EQ(echoes.size(), 5u);
  double sum = 0.0, moment = 0.0;
  for (const CubeEcho& echo : echoes) {
    const ArrayCube& cube = set.cubes[echo.cube];
    const double cosine = cube.axis.dot(to_source);
    const double path = set.variants[0].depth_mm() * std::sqrt(1.46 * 1.46 - (1.0 - cosine * cosine));
    EXPECT_NEAR(echo.range_mm, path - cube.position_mm.dot(to_source), 1e-9);
    sum += echo.cross_section_m2;
    moment += echo.cross_section_m2 * echo.range_mm;
  }
  const studies::RangeDistribution all = studies::distribution_of(echoes);
  EXPECT_NEAR(all.centroid_mm, moment / sum, 1e-9);
  EXPECT_LE(all.nearest_mm, all.centroid_mm);
}

TEST(RangingArray, ResponseHasThePowerAndTheMomentsOfTheArray) {
  const std::vector<CubeEcho> echoes = {{0, 10.0, 3e5, {}}, {1, 14.0, 1e5, {}}, {2, 25.0, 2e5, {}}};
  const studies::PulseResponse response = studies::response_of(echoes, 40.0);
  const studies::RangeDistribution all = studies::distribution_of(echoes);
  double sum = 0.0, moment = 0.0, squares = 0.0;
  for (std::size_t k = 1; k < response.range_mm.size(); ++k) {
    const double step = response.range_mm[k] - response.range_mm[k - 1];
    sum += step * response.per_mm[k];
    moment += step * response.per_mm[k] * response.range_mm[k];
    squares += step * response.per_mm[k] * std::pow(response.range_mm[k] - all.centroid_mm, 2.0);
  }
  EXPECT_NEAR(sum, 6e5, 1.0);
  EXPECT_NEAR(moment / sum, all.centroid_mm, 1e-4);
  const double sigma = studies::pulse_sigma_mm(40.0);
  EXPECT_NEAR(sigma, 0.5 * 0.299792458 * 40.0 / (2.0 * std::sqrt(2.0 * std::log(2.0))), 1e-12);
  EXPECT_NEAR(squares / sum, all.rms_mm * all.rms_mm + sigma * sigma, 1e-3);
}

/// Returns light of several cubes with equal cross sections and polarisations, at equal distances in range.
std::vector<CubeEcho> equal_echoes(std::size_t count, double distance_mm) {
  std::vector<CubeEcho> echoes;
  for (std::size_t k = 0; k < count; ++k)
    echoes.push_back({k, distance_mm * static_cast<double>(k), 4e4, {200.0 * raytrace::JonesMatrix::Identity()}});
  return echoes;
}

/// Reference: the squared modulus of the sum of N unit phasors with random phases has the mean N and the variance N (N
/// - 1).
TEST(RangingShots, ContinuousLightHasTheMomentsOfRandomPhasors) {
  const std::size_t count = 20, shots = 40000;
  const std::vector<CubeEcho> echoes = equal_echoes(count, 3.0);
  const Stokes sent{1.0, 1.0, 0.0, 0.0};
  const auto simulated = studies::simulated_shots(echoes, {shots, sent, std::nullopt, 1}, nullptr);
  const studies::ShotSummary summary = studies::summary_of(simulated);
  const double mean = 4e4 * static_cast<double>(count);
  EXPECT_NEAR(summary.mean_m2, mean, 5.0 * mean / std::sqrt(static_cast<double>(shots)));
  EXPECT_NEAR(summary.deviation_m2, mean * std::sqrt(1.0 - 1.0 / static_cast<double>(count)), 0.03 * mean);
  // The cross section is exponentially distributed. The fractions of shots above the mean and above twice the mean are
  // therefore known.
  for (const double times : {1.0, 2.0}) {
    const auto above = std::count_if(simulated.begin(), simulated.end(),
                                     [&](const studies::Shot& shot) { return shot.cross_section_m2 > times * mean; });
    EXPECT_NEAR(static_cast<double>(above) / static_cast<double>(shots), std::exp(-times), 0.02);
  }
  // Different seeds must give different shots, and equal seeds must give equal shots.
  EXPECT_EQ(studies::simulated_shots(echoes, {3, sent, std::nullopt, 1}, nullptr)[2].cross_section_m2,
            simulated[2].cross_section_m2);
  EXPECT_NE(studies::simulated_shots(echoes, {3, sent, std::nullopt, 2}, nullptr)[2].cross_section_m2,
            simulated[2].cross_section_m2);
}

TEST(RangingShots, ShortPulsesDoNotInterfere) {
  const std::vector<CubeEcho> echoes = equal_echoes(6, 30.0);
  for (const studies::Shot& shot : studies::simulated_shots(echoes, {10, raytrace::kUnpolarised, 5.0, 1}, nullptr)) {
    EXPECT_NEAR(shot.cross_section_m2, 6 * 4e4, 1e-3);
    EXPECT_NEAR(shot.centroid_mm, 75.0, 1e-6);
  }
}

/// Very long pulses must interfere like continuous light. Two cubes of cross section 1 with the phase difference f have
/// the cross section 2 + 2 cos f.
TEST(RangingShots, LongPulsesInterfere) {
  const std::vector<CubeEcho> echoes = equal_echoes(2, 0.01);
  const Stokes sent{1.0, 0.0, 0.0, 1.0};
  const auto pulsed = studies::simulated_shots(echoes, {200, sent, 1e5, 1}, nullptr);
  const auto continuous = studies::simulated_shots(echoes, {200, sent, std::nullopt, 1}, nullptr);
  for (std::size_t k = 0; k < pulsed.size(); ++k) {
    EXPECT_NEAR(pulsed[k].cross_section_m2, continuous[k].cross_section_m2, 1e-3);
    EXPECT_LE(pulsed[k].cross_section_m2, 4 * 4e4 * (1.0 + 1e-9));
  }
}

TEST(RangingShots, PureStatesAddUpToTheLight) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 20; ++k) {
    const Vec3 v = 0.7 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const Stokes sent{1.0, v.x(), v.y(), v.z()};
    const auto states = studies::pure_states(sent);
    raytrace::JonesMatrix jones;
    jones << std::complex(normal(random), 1.0), normal(random), std::complex(0.3, normal(random)), 1.0;
    const double expected = studies::returned_stokes(jones, sent).i;
    EXPECT_NEAR((jones * states[0]).squaredNorm() + (jones * states[1]).squaredNorm(), expected, 1e-12 * expected);
  }
}

TEST(Aberration, OfAnOrbitLiesBetweenBothDirectionsOfTheVelocity) {
  const studies::Annulus at_horizon = studies::aberration_of_orbit(5860.0, 0.0);
  const double r = 6378.1366 + 5860.0;
  const double v = std::sqrt(398600.4418 / r);
  EXPECT_NEAR(at_horizon.outer_rad, 2.0 * v / 299792.458, 1e-15);
  EXPECT_NEAR(at_horizon.inner_rad, at_horizon.outer_rad * std::sqrt(1.0 - std::pow(6378.1366 / r, 2.0)), 1e-15);
  const studies::Annulus at_zenith = studies::aberration_of_orbit(5860.0, 90.0);
  EXPECT_NEAR(at_zenith.inner_rad, at_zenith.outer_rad, 1e-15);
}

TEST(Aberration, StatisticsOfAPolynomialAreExact) {
  // The test function is 2 + x + 3 (x^2 + y^2) on the annulus from 1 to 2. The unit of x and y is 1e-5 rad.
  const auto values = [](const std::vector<Vec2>& angles) {
    std::vector<double> result;
    for (const Vec2& a : angles) result.push_back(2.0 + 1e5 * a.x() + 3e10 * a.squaredNorm());
    return result;
  };
  const studies::AnnulusStatistics s = studies::statistics_over({1e-5, 2e-5}, 1e-5, values);
  EXPECT_NEAR(s.mean, 2.0 + 3.0 * 2.5, 1e-9);  // the mean of x^2 + y^2 over the annulus is (1 + 4) / 2
  EXPECT_NEAR(s.max, 2.0 + 2.0 + 12.0, 1e-6);
  EXPECT_NEAR(s.min, 2.0 - 1.0 + 3.0, 1e-6);
  const studies::AnnulusStatistics ring = studies::statistics_over({1e-5, 1e-5}, 1e-5, values);
  EXPECT_NEAR(ring.mean, 5.0, 1e-9);
}

RangingRequest small_map() {
  RangingRequest request;
  request.map_points = 9;
  return request;
}

TEST(Ranging, PolarisationsAddUpToTheTotal) {
  for (const char* const state : {"linear", "right", "left"}) {
    RangingRequest request = small_map();
    request.polarisation = state;
    request.incidence_deg = {12.0};
    request.aberration_arcsec = {6.0, 8.0};
    const studies::RangingResult result = studies::RangingStudy(cube_design(), request).run();
    for (const auto& value : result.map.values)
      EXPECT_NEAR(*value.parallel + *value.crossed, value.total, 1e-9 * result.points[0].mirror_m2);
    const auto& annulus = *result.points[0].annulus;
    EXPECT_NEAR(annulus.parallel->mean + annulus.crossed->mean, annulus.total.mean, 1e-9 * annulus.total.mean);
    EXPECT_GE(annulus.total.max, annulus.total.mean);
    EXPECT_LE(annulus.total.min, annulus.total.mean);
  }
  const studies::RangingResult unpolarised = studies::RangingStudy(cube_design(), small_map()).run();
  EXPECT_FALSE(unpolarised.map.values[0].parallel);
  EXPECT_FALSE(unpolarised.points[0].centre.crossed);
}

/// A cube corner of mirrors reverses the handedness of circularly polarised light and preserves linear polarisation.
TEST(Ranging, MirrorsCrossCircularLight) {
  const design::Design mirrors = design::with(
      cube_design("0"), std::vector<std::string>{"idealisation.facets=mirror", "idealisation.entrance=lossless"});
  RangingRequest request = small_map();
  request.polarisation = "right";
  const auto circular = studies::RangingStudy(mirrors, request).run().points[0];
  EXPECT_NEAR(*circular.centre.crossed, circular.mirror_m2, 1e-6 * circular.mirror_m2);
  EXPECT_NEAR(*circular.centre.parallel, 0.0, 1e-6 * circular.mirror_m2);
  request.polarisation = "linear";
  request.polarisation_deg = 33.0;
  const auto linear = studies::RangingStudy(mirrors, request).run().points[0];
  EXPECT_NEAR(*linear.centre.parallel, linear.mirror_m2, 1e-6 * linear.mirror_m2);
}

TEST(Ranging, DiscsAverageTheFarField) {
  RangingRequest request = small_map();
  const auto point = studies::RangingStudy(cube_design(), request).run().points[0];
  request.receiver_arcsec = 0.006;  // 0.0001 arc minutes
  const auto tiny = studies::RangingStudy(cube_design(), request).run().points[0];
  EXPECT_NEAR(tiny.centre.total, point.centre.total, 1e-5 * point.centre.total);
  request.receiver_arcsec = 4.0;
  const auto wide = studies::RangingStudy(cube_design(), request).run().points[0];
  RangingRequest annulus = small_map();
  annulus.aberration_arcsec = {0.0, 2.0};
  const auto disc = studies::RangingStudy(cube_design(), annulus).run().points[0];
  EXPECT_NEAR(wide.centre.total, disc.annulus->total.mean, 1e-4 * point.centre.total);
}

TEST(Ranging, CubesWithOwnErrorsReplaceThoseOfTheDesign) {
  ArrayCube cube;
  cube.dihedral_error_arcsec = {{2.0, 1.0, 3.0}};
  RangingRequest request = small_map();
  request.cubes = "cubes.toml";
  const auto array = studies::RangingStudy(cube_design("0"), request, {cube}).run().points[0];
  const auto alone =
      studies::RangingStudy(cube_design("[0.03333333333333333, 0.016666666666666666, 0.05]"), small_map())
          .run()
          .points[0];
  EXPECT_NEAR(array.centre.total, alone.centre.total, 1e-9 * alone.mirror_m2);
}

TEST(Ranging, DesignsThatAreNoCubeCornersAreRefused) {
  const auto refused = [](const std::string& override_text) {
    try {
      const design::Design design = design::with(cube_design("0"), std::vector<std::string>{override_text});
      studies::RangingStudy(design, {});
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused("body.thickness_mm=1"));
  EXPECT_TRUE(refused("array.arrangement=honeycomb"));
}

}  // namespace
}  // namespace retrace::testing::ranging_array_test
