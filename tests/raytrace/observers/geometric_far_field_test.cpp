// Tests of the far fields of traced parts: sums of the ledger, closed forms, agreement of the engines, a Lambertian
// surface and a mirror.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/observers/coefficients.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/photometric_geometry.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/sampling/sobol.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/return_frames.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::geometric_far_field_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;

using Traced = TracedFarField;

Traced trace(const Part& part, const Optics& optics, const Illumination& light, const FarFieldPolicy& policy,
             double truncated = 1e-6) {
  BeamPolicy beams;
  beams.truncated_goal = truncated;
  beams.separate_cells = true;
  return traced_far_field(part, optics, light, policy, beams);
}

FarFieldPolicy geometric() {
  FarFieldPolicy policy;
  policy.diffraction = false;
  return policy;
}

ReturnFrame frame_at(double incidence_deg, double azimuth_deg) {
  return testing::frame_at({Angle::from_deg(incidence_deg), Angle::from_deg(azimuth_deg)});
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

double through_entrance(const Ledger& ledger) {
  return ledger[Account::retroreflected] + ledger[Account::front_specular] + ledger[Account::returned_elsewhere] +
         ledger[Account::scattered_out];
}

PartSpec cubes(double error_arcmin = 0.0) {
  PartSpec spec = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  spec.angle_errors.dihedral_error_arcmin.fill(error_arcmin);
  return spec;
}

TEST(GeometricFarField, HemisphereSumsToTheLedger) {
  for (const auto& [spec, t, p] :
       {std::tuple{cubes(3.0), 10.0, 20.0},
        {infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0), 20.0, 70.0},
        {finite(RtpElement{0.5, 0.5, 90.2}, Arrangement::offset, 3.0, 3.0, 1.0), 3.0, 0.0}}) {
    const Part part = build_part(spec);
    const Traced traced = trace(part, pmma(), from(t, p), geometric(), 1e-4);
    const double expected = through_entrance(traced.result.ledgers[0]);
    EXPECT_NEAR(traced.field.total_power(), expected, 1e-12);
    for (const auto layout : {DirectionGrid::Layout::square, DirectionGrid::Layout::polar}) {
      const std::vector<double> bins = traced.field.binned(frame_at(t, p), {layout, 0.03, 40, 60});
      EXPECT_NEAR(sum_of(bins), expected, 1e-6);
    }
    const FarField::Split split = traced.field.split(frame_at(t, p), 0.5 * kDeg);
    EXPECT_NEAR(split.inside, traced.result.ledgers[0][Account::retroreflected], 1e-12);
    EXPECT_NEAR(split.inside + split.outside, expected, 1e-12);
  }
}

// With diffraction, the power within the window and the power outside the window are integrated separately.
TEST(DiffractedFarField, WindowAndOutsideAddUpToTheLedger) {
  for (const auto& [spec, t, p] : {std::tuple{cubes(3.0), 0.0, 0.0},
                                   {cubes(), 12.0, 30.0},
                                   {infinite(TriangularCube{0.4}, Arrangement::triangular, 1.0), 5.0, 70.0},
                                   {infinite(RtpElement{0.3, 0.3, 90.0}, Arrangement::offset, 1.0), 2.0, 0.0}}) {
    const Part part = build_part(spec);
    const Traced traced = trace(part, pmma(), from(t, p), {}, 1e-4);
    const FarField::Split split = traced.field.split(frame_at(t, p), 0.035);
    EXPECT_GT(traced.field.diffracted_power(), 0.2);
    EXPECT_NEAR(split.inside + split.outside, through_entrance(traced.result.ledgers[0]), 1e-3) << t;
  }
}

// The solid angles of the bins of a circular grid add up to 2 pi (1 - cos).
TEST(DirectionGrid, SolidAnglesAddUp) {
  const DirectionGrid polar(DirectionGrid::Layout::polar, 0.7, 13, 7);
  double sum = 0.0;
  for (std::size_t bin = 0; bin < polar.size(); ++bin) {
    sum += polar.solid_angle_sr(bin);
    EXPECT_EQ(polar.bin_of(polar.centre_rad(bin)), bin);
  }
  EXPECT_NEAR(sum, 2.0 * pi * (1.0 - std::cos(0.7)), 1e-12);
  const DirectionGrid square(DirectionGrid::Layout::square, 0.02, 9, 11);
  sum = 0.0;
  for (std::size_t bin = 0; bin < square.size(); ++bin) {
    sum += square.solid_angle_sr(bin);
    EXPECT_EQ(square.bin_of(square.centre_rad(bin)), bin);
  }
  EXPECT_NEAR(sum, 0.04 * 0.04, 1e-3 * 0.04 * 0.04);
  EXPECT_FALSE(square.bin_of({0.021, 0.0}));
  EXPECT_FALSE(square.bin_of({0.0, -0.021}));
  EXPECT_FALSE(polar.bin_of({0.71, 0.0}));
}

// If all three dihedral errors are e, the light returns in six spots at the angle (8 / sqrt 6) n e. For 2.46 arcmin and
// n = 1.49, this angle is 0.2 degrees.
TEST(GeometricFarField, SixSpotsOfDihedralErrors) {
  for (const auto& [index, error_arcmin, expected_deg] :
       {std::tuple{1.49, 2.46, 0.2}, {1.585, 1.0, 8.0 / std::sqrt(6.0) * 1.585 / 60.0}}) {
    Optics optics = pmma();
    optics.index = index;
    const Traced traced = trace(build_part(cubes(error_arcmin)), optics, {}, geometric(), 1e-6);
    const double radius = 8.0 / std::sqrt(6.0) * index * error_arcmin / 60.0;
    // The published values are rounded to three digits.
    EXPECT_NEAR(radius, expected_deg, 3e-3 * expected_deg);
    int spots = 0;
    std::array<int, 6> sixths{};
    for (const FarFieldRay& ray : traced.field.rays()) {
      if (ray.power < 0.01) continue;
      const Vec2 at = ReturnFrame{}.angles_rad(ray.direction) / kDeg;
      if (at.norm() < 0.01) continue;  // reflection of the entrance face
      ++spots;
      EXPECT_NEAR(at.norm(), radius, 2e-3 * radius);
      const double turn = std::atan2(at.y(), at.x()) / (pi / 3.0) + 6.0;
      ++sixths[static_cast<std::size_t>(std::floor(turn)) % 6];
    }
    EXPECT_EQ(spots, 6);
    for (const int count : sixths) EXPECT_EQ(count, 1);
  }
}

// For any polarisation, the power of the field from Jones matrices equals the power from Stokes parameters.
TEST(DiffractedFarField, FieldsCarryThePowerOfTheStokesParameters) {
  const Part part = build_part(infinite(TriangularCube{0.7}, Arrangement::triangular, 0.6));
  for (const Stokes& s : {Stokes{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 0, 1, 0}, {1, 0, 0, 1}, {1, 0.5, -0.4, 0.6}}) {
    Illumination light = from(17.0, 33.0);
    light.stokes = s;
    Eigen::Matrix2cd incident;
    incident << s.i + s.q, std::complex<double>(s.u, -s.v), std::complex<double>(s.u, s.v), s.i - s.q;
    BeamPolicy policy;
    policy.truncated_goal = 1e-2;
    int count = 0;
    BeamTracer(part).trace(pmma(), light, {0.5}, policy, nullptr, [&](const ReturnedBeam& beam) {
      if (beam.depth == 0) return;
      ++count;
      const Eigen::Matrix2cd out = 0.5 * beam.transmission * beam.jones * incident * beam.jones.adjoint();
      EXPECT_NEAR(out.trace().real(), beam.stokes.i, 1e-12);
      EXPECT_NEAR((out(0, 0) - out(1, 1)).real(), beam.stokes.q, 1e-12);
      EXPECT_NEAR(2.0 * out(0, 1).real(), beam.stokes.u, 1e-12);
      EXPECT_NEAR(2.0 * out(0, 1).imag(), beam.stokes.v, 1e-12);
    });
    EXPECT_GT(count, 10);
  }
}

// The six paths through a cube corner have equal lengths: twice the path from the entrance face to the apex.
TEST(DiffractedFarField, PathsThroughACubeCornerAreEquallyLong) {
  const Part part = build_part(single(HexagonalCube{kCubeAperture}, 0.4));
  const double inner = std::asin(std::sin(12.0 * kDeg) / kPmma);
  int count = 0;
  BeamPolicy policy;
  policy.truncated_goal = 1e-3;
  BeamTracer(part).trace(pmma(), from(12.0, 40.0), {0.5}, policy, nullptr, [&](const ReturnedBeam& beam) {
    if (beam.depth != 4 || beam.cone != 0) return;
    ++count;
    // A wave through the apex, which is at x = y = 0, travels down along the inner direction and straight back.
    const double depth = part.thickness_mm + part.element_depth_mm;
    const double expected = 2.0 * kPmma * depth * std::cos(inner);
    EXPECT_NEAR(beam.phase_mm, expected, 1e-12);
  });
  EXPECT_GE(count, 6);
}

// At normal incidence, light stays within its cell. An infinite array of equal cells has the far field of one cell.
// Finite arrays are tested by EqualCellsOfAFiniteArrayAreCounted.
TEST(DiffractedFarField, EndlessArrayShowsThePatternOfOneCell) {
  const Optics optics = ideal();
  const FarField one = trace(build_part(single(HexagonalCube{0.6}, 0.5)), optics, {}, {}).field;
  PartSpec spec = cubes();
  spec.element = HexagonalCube{0.6};
  const FarField endless = trace(build_part(spec), optics, {}, {}).field;
  ASSERT_FALSE(endless.groups().empty());
  for (const Vec2& q : {Vec2(0.0, 0.0), Vec2(3e-4, 5e-4), Vec2(-1e-3, 2e-4)}) {
    const Vec3 d(q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm()));
    const double peak = one.diffracted_per_sr(Vec3::UnitZ());
    EXPECT_NEAR(endless.diffracted_per_sr(d), one.diffracted_per_sr(d), 1e-6 * peak);
  }
}

TEST(DiffractedFarField, EqualCellsOfAFiniteArrayAreCounted) {
  const Optics optics = ideal();
  const Traced traced =
      trace(build_part(finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 5.0, 4.0, 1.0)), optics, {}, {});
  double copies = 0.0;
  for (const CoherentGroup& group : traced.field.groups()) copies += group.copies;
  EXPECT_EQ(traced.field.groups().size(), 1U);
  EXPECT_NEAR(copies, 80.0, 1e-9);
  EXPECT_NEAR(traced.field.diffracted_power(), 1.0, 1e-6);
}

// The kernel of two discs has the integral 1. It equals the probability density of the difference between random points
// of both discs.
TEST(ApertureKernel, IsTheDensityOfTheDifferenceOfTwoDiscs) {
  const ApertureKernel kernel({Angle::from_rad(0.03), Angle::from_rad(0.02)});
  const auto nodes = kernel.nodes(0.002);
  double sum = 0.0;
  double square = 0.0;
  for (const auto& node : nodes) {
    sum += node.weight;
    square += node.weight * node.offset_rad.squaredNorm();
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  // The mean squares of the distances in both discs add up.
  EXPECT_NEAR(square, 0.5 * (0.015 * 0.015 + 0.01 * 0.01), 1e-6 * square);
  double integral = 0.0;
  for (int k = 0; k < 100000; ++k) {
    const double r = (k + 0.5) * 1e-5 * kernel.reach_rad();
    integral += 2.0 * pi * r * kernel.per_sr(r) * 1e-5 * kernel.reach_rad();
  }
  EXPECT_NEAR(integral, 1.0, 1e-7);
}

/// The transform of a disc is 2 J1(x) / x. Near x = 0, it is computed from a series, which must be equally
/// accurate up to the largest x for which it is used.
TEST(ApertureKernel, TransformOfADiscIsThatOfBessel) {
  EXPECT_EQ(disc_transform(0.0), 1.0);
  for (const double x : {1e-6, 1e-3, 0.005, 0.00999, 0.01001, 0.1, 1.0, 5.0})
    EXPECT_NEAR(disc_transform(x), 2.0 * std::cyl_bessel_j(1.0, x) / x, 1e-10) << x;
}

// A Lambertian surface has R_A = rho cos(beta) cos(nu) / pi and R_L = rho cos(beta) / pi, with the reflectance rho, the
// entrance angle beta and the viewing angle nu.
TEST(Coefficients, LambertianGivesTheCosines) {
  constexpr double kRho = 0.8;
  PhotometricGeometry geometry{Angle::from_deg(1.0), Angle::from_deg(30.0), Angle::from_deg(-15.0), Angle()};
  DirectionScore score{return_frame(geometry),
                       ApertureKernel({Angle::from_deg(4.0), Angle::from_deg(3.0)}),
                       {directions_of(geometry).to_observer},
                       {}};
  std::vector<double> sums(score.size(), 0.0);
  const SobolSquare square(11, 12);
  constexpr std::uint32_t kCount = 1U << 21;
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const auto [u, v] = square(k);
    const double across = std::sqrt(u);
    score.add({across * std::cos(2.0 * pi * v), across * std::sin(2.0 * pi * v), std::sqrt(1.0 - u)}, kRho / kCount,
              sums);
  }
  const Angle beta = Angle::from_rad(std::acos(directions_of(geometry).to_source.z()));
  const double nu = viewing_angle(geometry).rad();
  const double expected = kRho * std::cos(beta.rad()) * std::cos(nu) / pi;
  const double r_a = coefficient_of_retroreflection(sums[0], beta);
  EXPECT_NEAR(r_a, expected, 3e-3 * expected);
  EXPECT_NEAR(coefficient_of_luminance(r_a, viewing_angle(geometry)), kRho * std::cos(beta.rad()) / pi,
              3e-3 * expected);
}

// In a mirror, the receiver sees an image of the lamp: R_L = rho / Omega_source for any receiver within this image. The
// front face of a plate is a mirror with the reflectance rho = ((n - 1) / (n + 1))^2.
TEST(Coefficients, MirrorShowsTheLamp) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0));
  const Traced traced = trace(part, pmma(), from(0.02, 90.0), geometric());
  const double rho = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  FarField front;
  const ApertureKernel kernel({Angle::from_deg(10.0 / 60.0), Angle::from_deg(4.0 / 60.0)});
  const double lamp_sr = pi * std::pow(5.0 / 60.0 * kDeg, 2.0);
  const Vec3 image(0.0, -std::sin(0.02 * kDeg), std::cos(0.02 * kDeg));
  double mirror = 0.0;
  for (const FarFieldRay& ray : traced.field.rays())
    if ((ray.direction - image).norm() < 1e-9) mirror += ray.power * kernel.per_sr(0.03 * kDeg);
  EXPECT_GE(mirror, rho / lamp_sr * (1.0 - 1e-6));
  const double r_a = coefficient_of_retroreflection(rho * kernel.per_sr(0.03 * kDeg), Angle::from_deg(0.02));
  EXPECT_NEAR(coefficient_of_luminance(r_a, Angle::from_deg(0.02)), rho / lamp_sr, 1e-9 * rho / lamp_sr);
  EXPECT_EQ(kernel.per_sr(0.12 * kDeg), 0.0);
}

// The Monte Carlo engines (Embree, and cell by cell) give the same spots as the exact engine, for the same discs of
// source and receiver.
TEST(GeometricFarField, MonteCarloAgreesWithTheExactEngine) {
  const Part part = build_part(cubes(3.0));
  const Illumination light = from(8.0, 25.0);
  const Traced exact = trace(part, pmma(), light, geometric(), 1e-5);
  const ReturnFrame frame = frame_at(8.0, 25.0);
  DirectionScore score{frame, ApertureKernel({Angle::from_deg(0.2), Angle::from_deg(0.1)}), {}, {}};
  for (const Vec2& at : {Vec2(0.0, 0.0), Vec2(0.25, 0.0), Vec2(0.1, 0.2), Vec2(-0.2, 0.12)})
    score.receivers.push_back(frame.direction(at * kDeg));
  score.grid.emplace(DirectionGrid::Layout::polar, 0.6 * kDeg, 3, 1);
  const std::vector<double> bins = exact.field.binned(frame, *score.grid);
  const double bound = student_bound(2 * (score.receivers.size() + bins.size()));
  for (const auto engine : {MonteCarlo::Engine::embree, MonteCarlo::Engine::cell}) {
    const MonteCarloResult found =
        MonteCarlo(part, engine).trace(pmma(), light, {0.5}, rays(1U << 16), {}, nullptr, &score);
    ASSERT_EQ(found.score.size(), score.size());
    for (std::size_t k = 0; k < score.receivers.size(); ++k) {
      const double expected = exact.field.intensity(score.receivers[k], score.kernel).per_sr;
      EXPECT_NEAR(found.score[k], expected, bound * found.score_error[k] + 1e-4 * expected) << k;
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < bins.size(); ++k) {
      const std::size_t at = score.receivers.size() + k;
      EXPECT_NEAR(found.score[at], bins[k], bound * found.score_error[at] + 2e-5) << k;
      sum += found.score[at];
    }
    EXPECT_NEAR(sum, through_entrance(found.cones[0].ledger), 1e-9);
  }
}

// With rough facets, the power in all bins of the far field must equal the accounts of the ledger for light that leaves
// through the entrance face, including scattered light.
TEST(GeometricFarField, ScatteredLightSumsToTheLedger) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 1.0));
  Optics optics = pmma();
  optics.facet_scatter = surface_models::HarveyShack({20.0, 20.0, 10.0, 200.0});
  const ReturnFrame frame = frame_at(2.0, 0.0);
  DirectionScore score{frame,
                       ApertureKernel({Angle::from_deg(0.2), Angle::from_deg(0.1)}),
                       {},
                       DirectionGrid(DirectionGrid::Layout::square, 2.0 * kDeg, 5, 5)};
  const MonteCarloResult found = MonteCarlo(part).trace(optics, from(2.0), {0.5}, rays(1U << 15), {}, nullptr, &score);
  EXPECT_GT(found.cones[0].ledger[Account::scattered_out], 1e-3);
  EXPECT_NEAR(sum_of(found.score), through_entrance(found.cones[0].ledger), 1e-9);
}

}  // namespace
}  // namespace retrace::testing::geometric_far_field_test
