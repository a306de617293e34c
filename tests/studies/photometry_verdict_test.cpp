// Tests of verdicts of photometry if diffraction is left out, if errors are large, or if facets are rough.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <tuple>

#include "studies/photometry/io/photometry_files.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::photometry_verdict_test {
namespace {

using namespace photometric_requests;
using retrace::testing::kPmma;
using std::numbers::pi;
using Cause = UndeterminedReason::Cause;

PhotometricPoint point_of(double value, double std_error) {
  PhotometricPoint point;
  point.r_i_mcd_per_lx = value;
  point.std_error_mcd_per_lx = std_error;
  point.limit_mcd_per_lx = 10.0;
  return point;
}

TEST(PhotometryVerdict, PointsNearerToTheirLimitThanTwoErrorsAreUndetermined) {
  EXPECT_EQ(point_of(10.0, 0.0).verdict(), Verdict::pass);
  EXPECT_EQ(point_of(12.0, 1.0).verdict(), Verdict::pass);
  EXPECT_EQ(point_of(11.99, 1.0).verdict(), Verdict::undetermined);
  EXPECT_EQ(point_of(8.01, 1.0).verdict(), Verdict::undetermined);
  EXPECT_EQ(point_of(8.0, 1.0).verdict(), Verdict::fail);
}

TEST(PhotometryVerdict, WhatLacksDiffractionNeitherPassesNorFailsAndALowerBoundNeverFails) {
  for (const double value : {1.0, 100.0}) {
    PhotometricPoint point = point_of(value, 0.0);
    point.lacks_diffraction = true;
    EXPECT_EQ(point.verdict(), Verdict::undetermined);
    point.lacks_diffraction = false;
    point.is_lower_bound = true;
    EXPECT_EQ(point.verdict(), value > 10.0 ? Verdict::pass : Verdict::undetermined);
  }
}

TEST(PhotometryVerdict, AFailDecidesThenAnUndeterminedPoint) {
  TestPlan programme;
  const PhotometricPoint pass = point_of(20.0, 1.0);
  const PhotometricPoint open = point_of(11.0, 1.0);
  const PhotometricPoint fail = point_of(5.0, 1.0);
  EXPECT_EQ(verdict_of({pass, open}, programme), Verdict::undetermined);
  EXPECT_EQ(verdict_of({open, fail, pass}, programme), Verdict::fail);
  PhotometricPoint recalled = pass;
  recalled.test_point.status = LimitStatus::recalled;
  EXPECT_EQ(verdict_of({recalled, open}, programme), Verdict::undetermined);
}

design::Design rough(design::Design design, double sq_nm) {
  design.surface.texture = design::HarveyShackTexture{.roughness_sq_nm = sq_nm, .correlation_length_um = 20.0};
  return design;
}

/// With these parameters, every facet scatters the fraction pi a ln(1 + 4 / b) of the light. The direction cosines of
/// scattered and specular light differ by at most 2.
constexpr double kAbgA = 1e-3, kAbgB = 1e-3;

design::Design scattering_by_abg(design::Design design, double a = kAbgA) {
  design.surface.texture = design::AbgTexture{a, kAbgB, 2.0};
  return design;
}

/// Returns a request for two points with diffraction. The limits of the regulation are multiplied by `share_of_limits`.
/// Smooth cube corners with errors of 0.75 arcmin reach the limits of the regulation.
PhotometrySettings diffracted_request(double share_of_limits) {
  PhotometrySettings request = request_of(r150("IA", "red"));
  request.test_plan.points.resize(2);
  for (TestPoint& point : request.test_plan.points) point.minimum *= share_of_limits;
  request.area_cm2 = 30.0;
  request.diffraction = true;
  request.advice = true;
  request.rays = 1U << 14;
  return request;
}

// A roughness of 0.1 nm must not change the readings measurably.
TEST(PhotometryVerdict, IsContinuousInTheRoughness) {
  const design::Design smooth = design_of(honeycomb(0.75, 0.5));
  PhotometrySettings request = diffracted_request(0.5);
  // With this engine, weak beams are truncated for smooth as well as for rough facets.
  request.engine = raytrace::Engine::exact;
  request.rays.reset();
  const PhotometryResult before = run(smooth, request);
  const PhotometryResult after = run(rough(smooth, 0.1), request);
  EXPECT_EQ(before.verdict, Verdict::pass);
  EXPECT_EQ(after.verdict, Verdict::pass);
  EXPECT_EQ(after.reason.cause, Cause::none);
  ASSERT_EQ(after.points.size(), before.points.size());
  for (std::size_t k = 0; k < after.points.size(); ++k) {
    EXPECT_FALSE(after.points[k].is_lower_bound);
    EXPECT_NEAR(after.points[k].r_a, before.points[k].r_a, 1e-4 * before.points[k].r_a);
  }
}

// Machined and moulded parts have a diffracted value of their own, and therefore a verdict of pass or fail.
TEST(PhotometryVerdict, RoughPartsPassAndFailByTheirDiffractedValue) {
  const design::Design part = rough(design_of(honeycomb(0.75, 0.5)), 20.0);
  for (const auto& [share_of_limits, verdict] : {std::pair{0.5, Verdict::pass}, {1e3, Verdict::fail}}) {
    PhotometrySettings request = diffracted_request(share_of_limits);
    request.advice = false;
    const PhotometryResult result = run(part, request);
    EXPECT_EQ(result.verdict, verdict);
    EXPECT_TRUE(result.has_diffraction);
    EXPECT_EQ(result.engine, "stochastic");
    EXPECT_EQ(result.reason.cause, Cause::none);
    for (const PhotometricPoint& point : result.points) EXPECT_FALSE(point.is_lower_bound || point.lacks_diffraction);
  }
}

// In a perfect cube corner of mirrors at normal incidence, every path hits three facets at 54.74 degrees. Without
// scattered light, R_A in every direction would be that of smooth facets times the three specular fractions. Scattered
// light increases R_A above this value.
TEST(PhotometryVerdict, RoughPartsShowTheirSpecularShareAndWhatTheyScatter) {
  const design::Design smooth = design_of(honeycomb(0.0, 0.5), true);
  PhotometrySettings request = request_of(points_at({0.05}, 1e-3));
  request.diffraction = true;
  const PhotometryResult before = run(smooth, request);
  const double sq_nm = 15.0;
  const PhotometryResult after = run(rough(smooth, sq_nm), request);
  const double phase = 4.0 * pi * kPmma * sq_nm * std::sqrt(1.0 / 3.0) / smooth.light.wavelength_nm();
  const double specular = std::exp(-3.0 * phase * phase);
  EXPECT_GT(after.points[0].r_a, specular * before.points[0].r_a);
  // For Gaussian heights with a correlation length of 20 um, the scattered lobe has a maximum of at most (1 - specular)
  // pi l^2 cos t / w^2 per steradian. This follows from docs/theory/scatter.md, without diffraction at the edges.
  const double middle_per_sr = (1.0 - specular) * pi * std::pow(20e-3 / (1e-6 * smooth.light.wavelength_nm()), 2.0);
  EXPECT_LT(after.points[0].r_a, specular * before.points[0].r_a + 2.0 * middle_per_sr);
}

// Textures that contain no information on phases are traced by rays, and diffraction includes only the mean field.
TEST(PhotometryVerdict, MeanFieldIsTheSmoothPatternTimesTheSpecularShares) {
  const design::Design smooth = design_of(honeycomb(0.0, 0.5), true);
  PhotometrySettings request = request_of(points_at({0.1, 1.0 / 3.0}, 1e-3));
  request.diffraction = true;
  request.rays = 1U << 12;
  const PhotometryResult before = run(smooth, request);
  const PhotometryResult after = run(scattering_by_abg(smooth), request);
  const double scattered = pi * kAbgA * std::log1p(4.0 / kAbgB);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(after.points[k].is_lower_bound);
    EXPECT_NEAR(after.points[k].r_a / before.points[k].r_a, std::pow(1.0 - scattered, 3.0), 1e-6);
  }
}

TEST(PhotometryVerdict, TexturesWithoutPhasesThatTheBoundDoesNotLiftAreUndeterminedAndNothingIsAdvised) {
  const PhotometryResult result = run(scattering_by_abg(design_of(honeycomb(0.75, 0.5))), diffracted_request(1e3));
  EXPECT_EQ(result.verdict, Verdict::undetermined);
  EXPECT_EQ(result.reason.cause, Cause::diffraction);
  EXPECT_EQ(result.reason.no_diffraction, NoDiffraction(raytrace::Obstacle::texture_without_phases));
  record_message(result.reason.text);
  EXPECT_FALSE(result.change);
  EXPECT_NE(photometry_table(result).find(result.reason.text), std::string::npos);
  const auto json = nlohmann::json::parse(photometry_json(result));
  EXPECT_EQ(json.at("verdict"), "undetermined");
  EXPECT_EQ(json.at("reason"), result.reason.text);
}

TEST(PhotometryVerdict, ReasonsForMissingDiffraction) {
  const design::Design smooth = design_of(honeycomb(0.0, 0.5));
  PhotometrySettings request = diffracted_request(1e-6);
  const auto reason = [&](const design::Design& design) {
    const PhotometryResult result = run(design, request);
    EXPECT_EQ(result.verdict, Verdict::undetermined);
    EXPECT_EQ(result.reason.cause, Cause::diffraction);
    record_message(result.reason.text);
    return result.reason.no_diffraction;
  };
  request.engine = raytrace::Engine::montecarlo;
  EXPECT_EQ(reason(smooth), NoDiffraction(Undiffracted::monte_carlo));
  EXPECT_EQ(reason(rough(smooth, 0.1)), NoDiffraction(Undiffracted::monte_carlo));
  EXPECT_EQ(reason(scattering_by_abg(smooth)), NoDiffraction(raytrace::Obstacle::texture_without_phases));
  request.engine = raytrace::Engine::automatic;
  request.diffraction = false;
  EXPECT_EQ(reason(smooth), NoDiffraction(Undiffracted::not_requested));
}

// With discs of 10 arcmin, diffraction is negligible for cells of at least 64 wavelengths divided by 10 arcmin, which
// is 12.9 mm. Rays are then sufficient for a verdict, so that cube corners of 13 mm pass or fail.
TEST(PhotometryVerdict, WideCellsNeedNoDiffraction) {
  for (const auto& [aperture_mm, limit, verdict] :
       {std::tuple{13.0, 1e9, Verdict::fail}, {13.0, 1.0, Verdict::pass}, {12.8, 1e9, Verdict::undetermined}}) {
    PhotometrySettings request = request_of(points_at({0.05}, limit));
    request.engine = raytrace::Engine::montecarlo;
    request.rays = 1U << 14;
    EXPECT_EQ(run(design_of(honeycomb(0.0, aperture_mm)), request).verdict, verdict) << aperture_mm << " " << limit;
  }
}

// The receiver is between the spots, and none of the few rays hits it. This does not prove that it receives no light.
TEST(PhotometryVerdict, AReceiverThatNoRayMetHasTheErrorOfOne) {
  PhotometrySettings request = request_of(points_at({1.0}, 100.0));
  request.engine = raytrace::Engine::montecarlo;
  request.rays = 1U << 10;
  const PhotometryResult result = run(design_of(honeycomb(0.0, 20.0)), request);
  EXPECT_EQ(result.points[0].r_a, 0.0);
  EXPECT_EQ(result.verdict, Verdict::undetermined);
  EXPECT_EQ(result.reason.cause, Cause::noise);
  EXPECT_FALSE(result.reason.no_diffraction);
  record_message(result.reason.text);
  request.rays = 1U << 13;
  EXPECT_EQ(run(design_of(honeycomb(0.0, 20.0)), request).verdict, Verdict::fail);
}

// A table of limited length shows the smallest margins, also if several points have equal margins.
TEST(PhotometryTable, KeepsTheSmallestMargins) {
  PhotometryResult result;
  result.request.test_plan = points_at({0.1, 0.2, 0.3, 0.4}, 1.0);
  for (const TestPoint& test_point : result.request.test_plan.points) {
    PhotometricPoint point;
    point.test_point = test_point;
    point.limit_mcd_per_lx = 100.0;
    point.r_i_mcd_per_lx = test_point.observation_deg == 0.4 ? 110.0 : 150.0;
    result.points.push_back(point);
  }
  const std::string table = photometry_table(result, 2);
  EXPECT_NE(table.find("   0.10 "), std::string::npos) << table;
  EXPECT_NE(table.find("   0.40 "), std::string::npos) << table;
  EXPECT_EQ(table.find("   0.20 "), std::string::npos) << table;
  EXPECT_NE(table.find("and 2 points"), std::string::npos) << table;
}

}  // namespace
}  // namespace retrace::studies::photometry_verdict_test
