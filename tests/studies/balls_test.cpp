// Tests of designs with balls: reading, refused values, and the results of rre, photometry and inspect.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "design/design_part.h"
#include "design/io/design_json.h"
#include "design/io/design_reader.h"
#include "raytrace/balls/ball_forms.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/photometry/photometry.h"
#include "studies/rre/rre.h"
#include "tests/support/refusals.h"

namespace retrace::studies::balls_test {
namespace {

using std::numbers::pi;

const std::string kBalls = R"([element]
kind = "ball"
diameter_mm = 0.05
[body]
refractive_index = 1.93
[idealisation]
facets = "mirror"
)";

design::Design balls(const std::vector<std::string>& overrides = {}) {
  return design::parse_design(kBalls, "balls.toml", overrides);
}

std::string refusal(const std::vector<std::string>& overrides, const std::string& text = kBalls) {
  return refusal_of([&] { design::parse_design(text, "balls.toml", overrides); }, "accepted");
}

TEST(BallDesign, DefaultsAreAPackedLayerWithAMirrorOnTheBalls) {
  const design::Design design = balls();
  ASSERT_TRUE(design.balls());
  EXPECT_EQ(design.balls()->diameter_mm, 0.05);
  EXPECT_EQ(design.balls()->pitch_mm, 0.05);
  EXPECT_EQ(design.balls()->mirror_offset_mm, 0.0);
  EXPECT_EQ(design.balls()->mirror_half_angle_deg, 90.0);
}

TEST(BallDesign, BowlsReachAsFarAsTheirNeighboursLet) {
  const design::Design design = balls({"element.mirror_offset_mm=0.025", "array.gap_mm=0.01"});
  EXPECT_NEAR(*design.balls()->pitch_mm, 0.06, 1e-15);
  EXPECT_NEAR(design.balls()->mirror_half_angle_deg, std::asin(0.03 / 0.05) * 180.0 / pi, 1e-12);
  const design::Design single = balls({"element.mirror_offset_mm=0.025", "array.arrangement=single"});
  EXPECT_EQ(single.balls()->mirror_half_angle_deg, 90.0);
  EXPECT_FALSE(single.balls()->pitch_mm);
}

TEST(BallDesign, JsonReadsBackAsTheSameDesign) {
  const auto json = design::to_json(balls({"array.gap_mm=0.01"}));
  EXPECT_EQ(json["element"]["kind"], "ball");
  EXPECT_EQ(json["element"]["diameter_mm"], 0.05);
  EXPECT_EQ(json["array"]["arrangement"], "packed");
  EXPECT_NEAR(json["array"]["gap_mm"].get<double>(), 0.01, 1e-15);
  EXPECT_FALSE(json.contains("surface"));
  EXPECT_FALSE(json["body"].contains("thickness_mm"));
}

TEST(BallDesign, WhatMeansNothingForBallsIsRefused) {
  EXPECT_EQ(refusal({"element.diameter_mm=0"}), "--set element.diameter_mm=0: element.diameter_mm");
  EXPECT_EQ(refusal({}, "[element]\nkind = \"ball\"\n"), "balls.toml:1: element.diameter_mm");
  EXPECT_EQ(refusal({"element.base_mm=1"}), "--set element.base_mm=1: element.base_mm");
  EXPECT_EQ(refusal({"array.x_length_mm=1"}), "--set array.x_length_mm=1: array.x_length_mm");
  EXPECT_EQ(refusal({"array.arrangement=honeycomb"}), "--set array.arrangement=honeycomb: array.arrangement");
  EXPECT_EQ(refusal({"array.extent=finite"}), "--set array.extent=finite: array.extent");
  EXPECT_EQ(refusal({"array.arrangement=single", "array.gap_mm=1"}), "--set array.gap_mm=1: array.gap_mm");
  EXPECT_EQ(refusal({"array.gap_mm=-1"}), "--set array.gap_mm=-1: array.gap_mm");
  EXPECT_EQ(refusal({"body.thickness_mm=1"}), "--set body.thickness_mm=1: body.thickness_mm");
  EXPECT_EQ(refusal({"surface.roughness_sq_nm=5"}), "--set surface.roughness_sq_nm=5: surface");
  EXPECT_EQ(refusal({"element.mirror_half_angle_deg=91"}),
            "--set element.mirror_half_angle_deg=91: element.mirror_half_angle_deg");
  EXPECT_EQ(refusal({"element.mirror_offset_mm=0.025", "element.mirror_half_angle_deg=31"}),
            "--set element.mirror_half_angle_deg=31: element.mirror_half_angle_deg");
  EXPECT_EQ(refusal({"element.mirror_offset_mm=0.01", "idealisation.facets=real"}),
            "--set element.mirror_offset_mm=0.01: element.mirror_offset_mm");
}

TEST(BallDesign, KeysOfBallsAreRefusedForPrisms) {
  const std::string prism =
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n"
      "[body]\nthickness_mm = 1\n";
  EXPECT_EQ(refusal({"element.diameter_mm=1"}, prism), "--set element.diameter_mm=1: element.diameter_mm");
  EXPECT_EQ(refusal({"array.gap_mm=1"}, prism), "--set array.gap_mm=1: array.gap_mm");
}

TEST(BallDesign, WhatTakesNoBallsSaysWhatDoes) {
  const std::string text = "balls.toml:2: element.kind";
  const auto message = [](const auto& work) -> std::string { return refusal_of(work, "accepted"); };
  EXPECT_EQ(message([] { design::make_model(balls(), materials::MaterialLibrary::shipped()); }), text);
  EXPECT_EQ(message([] { design::part_of(balls()); }), text);
  EXPECT_EQ(message([] { design::require_supported(balls(), {.what = "retrace job"}); }), text);
}

RreSettings some_rays() {
  RreSettings request;
  request.rays = 1U << 15;
  return request;
}

TEST(BallStudies, RreIsThatOfTheTracerAndOfTheClosedForm) {
  design::Design design = balls({"idealisation.entrance=lossless", "detector.acceptance_half_angle_deg=1"});
  const RreResult result = RreStudy({design}, some_rays()).run();
  EXPECT_EQ(result.engine, "balls");
  ASSERT_EQ(result.points.size(), 1U);
  EXPECT_NEAR(result.points[0].rre,
              raytrace::packing_fraction(*design.balls()) * raytrace::fraction_within(pi / 180.0, 1.93, 1.0, 1.0),
              5.0 * result.points[0].std_error + 1e-3);
  EXPECT_NEAR(result.points[0].ledger.total(), 1.0, 1e-9);
}

TEST(BallStudies, ASpectrumIsTheMeanOfItsLines) {
  const design::Design design = balls({"light.spectrum=[[480,1],[620,1]]", "light.weighting=radiant"});
  const RreResult result = RreStudy({design}, some_rays()).run();
  ASSERT_EQ(result.points[0].by_wavelength.size(), 2U);
  EXPECT_NEAR(result.points[0].rre,
              0.5 * (result.points[0].by_wavelength[0].rre + result.points[0].by_wavelength[1].rre), 1e-12);
}

TEST(BallStudies, BallsAndPrismsStandInOneTable) {
  const design::Design prism = design::parse_design(
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = "
      "1\n",
      "rtp.toml", {});
  const RreResult result = RreStudy({balls(), prism}, some_rays()).run();
  EXPECT_EQ(result.engine, "montecarlo");
  ASSERT_EQ(result.points.size(), 2U);
  EXPECT_GT(result.points[1].rre, 0.99);
}

TEST(BallStudies, OtherEnginesAreRefused) {
  RreSettings request = some_rays();
  request.rays.reset();
  request.engine = raytrace::Engine::exact;
  EXPECT_THROW(RreStudy({balls()}, request), InputError);
  request.engine = raytrace::Engine::automatic;
  request.footprint = true;
  EXPECT_THROW(RreStudy({balls()}, request), InputError);
}

TestPlan straight_back() {
  TestPlan programme;
  programme.points.push_back({0.0, 0.0, 0.0, 1.0, PhotometricUnit::cd_per_lx_per_m2, LimitStatus::confirmed, 2});
  return programme;
}

PhotometrySettings request_of(double receiver_deg) {
  PhotometrySettings request;
  request.test_plan = straight_back();
  request.area_cm2 = 10.0;
  request.apertures.source = Angle::from_deg(0.0);
  request.apertures.receiver = Angle::from_deg(receiver_deg);
  request.light = PhotometricLight::of_design;
  request.diffraction = false;
  request.advice = false;
  request.rays = 1U << 17;
  return request;
}

TEST(BallStudies, CoefficientOfAWideReceiverIsItsShareOfThePower) {
  // A receiver with a diameter of 1 degree around the source receives the light that returns within half a degree. R_A
  // is the power of this light divided by the solid angle of the receiver.
  const design::Design design = balls();
  const PhotometryResult result = PhotometryStudy(design, request_of(1.0)).run();
  EXPECT_EQ(result.engine, "balls");
  const RrePoint point = RreStudy({design}, some_rays()).run().points[0];
  const double solid_angle_sr = 2.0 * pi * (1.0 - std::cos(0.5 * pi / 180.0));
  const double expected = point.rre / solid_angle_sr;
  EXPECT_NEAR(result.points[0].r_a, expected, 5.0 * point.std_error / solid_angle_sr + 0.01 * expected);
}

TEST(BallStudies, PhotometryNeedsALayer) {
  EXPECT_THROW(PhotometryStudy(balls({"array.arrangement=single"}), request_of(1.0)), InputError);
}

TEST(BallStudies, InspectionIsTheClosedForm) {
  const Inspection two = inspect(balls({"body.refractive_index=2"}), materials::MaterialLibrary::shipped());
  ASSERT_TRUE(two.balls);
  EXPECT_NEAR(two.balls->paraxial_error, 0.0, 1e-15);
  EXPECT_FALSE(two.balls->focal_offset_mm);
  EXPECT_NEAR(two.balls->packing_fraction, pi / (2.0 * std::sqrt(3.0)), 1e-14);
  EXPECT_NEAR(two.balls->largest_return_error_deg, 60.0, 1e-9);
  EXPECT_NEAR(two.entrance_area_mm2, 0.05 * 0.05 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(two.facet_area_mm2, 4.0 * pi * 0.025 * 0.025, 1e-15);
  const Inspection plain = inspect(balls({"body.refractive_index=1.5"}), materials::MaterialLibrary::shipped());
  EXPECT_NEAR(*plain.balls->focal_offset_mm, 0.0125, 1e-15);
  EXPECT_NE(inspect_text(plain).find("0.012500 mm"), std::string::npos);
  EXPECT_NE(inspect_json(plain).find("\"focal_offset_mm\""), std::string::npos);
}

}  // namespace
}  // namespace retrace::studies::balls_test
