// Photometry of whole designs: limits files, closed forms, retrace rre at the same directions, dyes, what to change.
#include "studies/photometry/photometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "core/error.h"
#include "materials/io/spectrum_reader.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/standards.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"

namespace retrace::studies::photometry_test {
namespace {

using namespace testing;
using namespace photometric_requests;
using geometry::Arrangement;
using std::numbers::pi;

constexpr const char* kHeader = "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n";

std::string message_of(const std::string& table) {
  return refusal_of([&] { parse_limits(table, "l.csv"); }, "accepted");
}

TEST(Limits, ShippedProgrammesHoldTheirPoints) {
  const TestProgramme ia = r150("IA", "red");
  ASSERT_EQ(ia.points.size(), 14U);
  EXPECT_TRUE(ia.is_complete);
  EXPECT_EQ(ia.points[0].minimum, 300.0);
  EXPECT_NEAR(ia.points[0].observation_deg, 1.0 / 3.0, 1e-6);
  EXPECT_EQ(ia.points[0].status, LimitStatus::read);
  // Both signs of V, and four combinations of signs.
  EXPECT_EQ(ia.points[1].v_deg, 10.0);
  EXPECT_EQ(ia.points[2].v_deg, -10.0);
  EXPECT_EQ(ia.points[6].v_deg, -5.0);
  EXPECT_EQ(ia.points[6].h_deg, -20.0);
  EXPECT_EQ(programme_of(shipped(), "SAE J594 / FMVSS 108 XVI-a", {}, "amber").points.size(), 10U);
  const TestProgramme bicycle = programme_of(shipped(), "16 CFR 1512", {}, "white");
  EXPECT_EQ(bicycle.part_class, "bicycle");
  EXPECT_FALSE(bicycle.is_complete);
  for (const ShippedStandard& standard : shipped_standards())
    EXPECT_THROW(programme_of(shipped(), std::string(standard.in_table), {}, "no such"), InputError) << standard.name;
}

TEST(Limits, FactorsMultiplyAnotherColourAndAreNoBetterConfirmed) {
  const TestProgramme red = r150("IIIA", "red");
  for (const auto& [colour, factor] : {std::pair{"amber", 2.5}, {"white", 4.0}}) {
    const TestProgramme other = r150("IIIA", colour);
    ASSERT_EQ(other.points.size(), red.points.size());
    for (std::size_t k = 0; k < red.points.size(); ++k) {
      EXPECT_DOUBLE_EQ(other.points[k].minimum, factor * red.points[k].minimum);
      EXPECT_EQ(other.points[k].status, LimitStatus::recalled);
    }
  }
}

TEST(Limits, UnitsAreThoseOfTheStandards) {
  EXPECT_NEAR(in_mcd_per_lx(1.0, PhotometricUnit::cd_per_fc, 1.0), 92.903, 5e-4);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::cd_per_lx, 1.0), 2000.0);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::mcd_per_lx, 5.0), 2.0);
  // 100 cd/(lx m^2) of 30 cm^2.
  EXPECT_NEAR(in_mcd_per_lx(100.0, PhotometricUnit::cd_per_lx_per_m2, 30.0), 300.0, 1e-12);
}

TEST(Limits, MalformedLinesAreRefusedByTheirLine) {
  const std::string good = "S,A,red,0.2,0,0,10,mcd/lx,read\n";
  EXPECT_EQ(message_of(kHeader + good), "accepted");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"S,A,red,0.2,0,0,10,lm,read", "l.csv:3: unit: must be"},
      {"S,A,red,0.2,0,0,10,mcd/lx,rumoured", "l.csv:3: status: must be"},
      {"S,A,red,0.2,0,0,10,mcd/lx", "l.csv:3: must have the 9 values of the header, got 8"},
      {"S,A,red,x,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be a number"},
      {"S,A,red,-0.2,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be"},
      {"S,A,red,21,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be"},
      {"S,A,red,0.2,90,0,10,mcd/lx,read", "l.csv:3: v_deg: must be"},
      {"S,A,red,0.2,0,+-0,10,mcd/lx,read", "l.csv:3: h_deg: must be"},
      {"S,A,red,0.2,0,nan,10,mcd/lx,read", "l.csv:3: h_deg: must be"},
      {"S,A,red,0.2,0,0,0,mcd/lx,read", "l.csv:3: minimum: must be a number > 0"},
      {"S,A,red,0.2,0,0,inf,mcd/lx,read", "l.csv:3: minimum: must be"},
      {",A,red,0.2,0,0,10,mcd/lx,read", "l.csv:3: standard: must name"},
      {"S,A,,0.2,0,0,10,mcd/lx,read", "l.csv:3: colour: must name"},
      {"S,A,amber,,,,2.5 times red,factor,read", "l.csv:3: minimum: must be a number above 0, to 1000, x and a colour"},
      {"S,A,amber,0.2,,,2.5 x red,factor,read", "l.csv:3: observation_deg: must be empty"},
      {"S,A,red,,,,5,,incomplete", "l.csv:3: minimum: must be empty"},
  };
  for (const auto& [line, begin] : cases) {
    const std::string message = message_of(kHeader + good + line + "\n");
    EXPECT_TRUE(message.starts_with(begin)) << message << " should begin: " << begin;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_TRUE(message_of("standard,limit\n").starts_with("l.csv:1: must be the header"));
  EXPECT_TRUE(message_of("").starts_with("l.csv: must have the header"));
  const LimitTable twice = parse_limits(kHeader + good + good, "l.csv");
  EXPECT_THROW(programme_of(twice, {}, {}, {}), InputError);
  const LimitTable nothing_to_multiply = parse_limits(kHeader + good + "S,B,amber,,,,2 x red,factor,read\n", "l.csv");
  EXPECT_THROW(programme_of(nothing_to_multiply, {}, "B", "amber"), InputError);
}

TEST(Limits, OnlyConfirmedAndCompleteProgrammesPass) {
  PhotometricPoint point;
  point.limit_mcd_per_lx = 10.0;
  point.r_i_mcd_per_lx = 10.0;
  TestProgramme programme;
  for (const auto& [status, complete, verdict] : {std::tuple{LimitStatus::confirmed, true, Verdict::pass},
                                                  {LimitStatus::read, true, Verdict::pass},
                                                  {LimitStatus::recalled, true, Verdict::unconfirmed},
                                                  {LimitStatus::read, false, Verdict::unconfirmed}}) {
    point.asked.status = status;
    programme.is_complete = complete;
    EXPECT_EQ(verdict_of({point}, programme), verdict);
    PhotometricPoint below = point;
    below.r_i_mcd_per_lx = 9.999;
    EXPECT_EQ(verdict_of({point, below}, programme), Verdict::fail);
  }
}

// Perfect cubes with all dihedral errors 2.46 arcmin at n = 1.49 put six spots of a sixth at 0.2 degrees: a receiver
// there, smaller than the source, sees the lamp in one of them, R_A = 1 / (6 Omega_source); turned by 30 degrees it
// sees between two.
TEST(Photometry, ReceiverSeesOneOfSixSpots) {
  Design design = design_of(honeycomb(2.46), true);
  design.substance.refractive_index = 1.49;
  PhotometryRequest request = request_of(points_at({0.2}, 1.0));
  request.apertures = {Angle::from_deg(0.1), Angle::from_deg(0.05)};
  const double source_sr = pi * std::pow(0.05 * kDeg, 2.0);
  std::vector<double> seen;
  double rre = 0.0;
  for (const double turn : {0.0, 30.0, 60.0, 90.0, 180.0}) {
    request.rotation_deg = {turn};
    const PhotometryResult result = run(design, request);
    seen.push_back(result.points[0].r_a);
    rre = result.directions[0].rre;
  }
  EXPECT_NEAR(rre, 1.0, 0.01) << "rims that errors of angle lift take a little";
  const double most = *std::max_element(seen.begin(), seen.end());
  EXPECT_NEAR(most, rre / (6.0 * source_sr), 1e-6 * most);
  EXPECT_EQ(*std::min_element(seen.begin(), seen.end()), 0.0);
  EXPECT_NEAR(seen[0], seen[2], 1e-9 * most) << "a sixth of a turn";
  EXPECT_NEAR(seen[1], seen[3], 1e-9 * most);
  // Over several turns the least counts.
  request.rotation_deg = {0.0, 30.0, 60.0, 90.0};
  const PhotometricPoint all = run(design, request).points[0];
  EXPECT_EQ(all.r_a, 0.0);
  EXPECT_EQ(all.rotation_deg, seen[0] > 0.0 ? 30.0 : 0.0);
}

// The directions of V and H, turned into incidence and azimuth: RRE there is that of retrace rre.
TEST(Photometry, VhGridAgreesWithRre) {
  for (const geometry::PartSpec& spec :
       {honeycomb(), infinite(geometry::TriangularCube{1.0}, Arrangement::triangular, 1.0)}) {
    const Design design = design_of(spec, true);
    PhotometryRequest request = request_of(r150("IA", "red"));
    request.cutoff = 1e-9;
    const PhotometryResult result = run(design, request);
    ASSERT_EQ(result.directions.size(), 7U);
    for (const PhotometricDirection& at : result.directions) {
      const double v = at.v_deg * kDeg;
      const double h = at.h_deg * kDeg;
      RreRequest asked;
      asked.incidence_deg = {std::acos(std::cos(v) * std::cos(h)) / kDeg};
      asked.azimuth_deg = {std::atan2(std::sin(v), std::sin(h) * std::cos(v)) / kDeg};
      asked.engine = Engine::exact;
      asked.cutoff = 1e-9;
      const RreResult rre = RreStudy({design}, asked).run();
      EXPECT_NEAR(at.rre, rre.points[0].rre, 1e-8) << at.v_deg << " " << at.h_deg;
      EXPECT_GT(at.rre, 0.3);
    }
  }
}

// A grey dye takes exp(-a L) of every direction at normal incidence, L = 2 (plate + depth) in a perfect prism array.
TEST(Photometry, DyeTakesItsShareOfTheFlux) {
  const Design design = design_of(infinite(geometry::RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 2.0), true);
  PhotometryRequest request = request_of(points_at({0.05}, 1.0));
  request.own_light = false;
  const double clear = run(design, request).points[0].r_a;
  const double way_mm = 2.0 * 2.25;
  request.dye_absorption_per_mm = {{380.0, 780.0}, {0.2, 0.2}};
  EXPECT_NEAR(run(design, request).points[0].r_a / clear, std::exp(-0.2 * way_mm), 1e-9);
  // The shipped ones: the sum over the table of the lamp and the eye.
  const materials::CieTable cie =
      materials::read_cie_table(std::string(RETRACE_SOURCE_DIR) + "/data/cie_v_a_d65_5nm.csv");
  for (const std::string name : {"red", "amber"}) {
    request.dye_absorption_per_mm =
        materials::read_spectral_absorption(std::string(RETRACE_SOURCE_DIR) + "/data/dye_" + name + ".csv");
    double all = 0.0;
    double behind = 0.0;
    for (std::size_t k = 0; k < cie.illuminant_a.values.size(); ++k) {
      const double w = cie.illuminant_a.wavelengths_nm[k];
      const double flux = cie.illuminant_a.values[k] * cie.photopic_efficiency.at(w);
      all += flux;
      behind += flux * std::exp(-request.dye_absorption_per_mm.at(w) * way_mm);
    }
    EXPECT_NEAR(run(design, request).points[0].r_a / clear, behind / all, 2e-3 * behind / all) << name;
    EXPECT_GT(behind / all, 0.1);
    EXPECT_LT(behind / all, 0.7);
  }
}

// Monte Carlo through the same discs, within its own error.
TEST(Photometry, MonteCarloAgreesWithTheExactEngine) {
  const Design design = design_of(honeycomb(4.0));
  PhotometryRequest request = request_of(r150("IA", "red"));
  request.programme.points.resize(4);
  const PhotometryResult exact = run(design, request);
  request.engine = Engine::montecarlo;
  request.rays = 1U << 17;
  const PhotometryResult found = run(design, request);
  EXPECT_EQ(exact.engine, "exact");
  EXPECT_EQ(found.engine, "embree");
  const double bound = student_bound(exact.points.size());
  for (std::size_t k = 0; k < exact.points.size(); ++k) {
    EXPECT_GT(found.points[k].std_error_mcd_per_lx, 0.0);
    EXPECT_NEAR(found.points[k].r_i_mcd_per_lx, exact.points[k].r_i_mcd_per_lx,
                bound * found.points[k].std_error_mcd_per_lx + 1e-3 * exact.points[k].r_i_mcd_per_lx);
  }
}

// Diffraction fills the place between the spots, and what leaves the window is told.
TEST(Photometry, DiffractionReachesWhereRaysDoNot) {
  const Design design = design_of(honeycomb(0.0, 0.4));
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1.0));
  EXPECT_EQ(run(design, request).points[0].r_a, 0.0);
  request.diffraction = true;
  const PhotometryResult result = run(design, request);
  EXPECT_GT(result.points[0].r_a, 50.0);
  ASSERT_TRUE(result.directions[0].split);
  const auto& split = *result.directions[0].split;
  EXPECT_NEAR(split.window + split.outside, split.geometric, 1e-3);
  EXPECT_GT(split.outside, 5e-3);
}

// Flawless cubes send nothing to a driver above the lamps; the program finds the error that does, and its table is that
// of the changed design.
TEST(Photometry, FindsTheAngleErrorThatPasses) {
  const Design design = design_of(honeycomb(0.0, 10.0), true);
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 300.0));
  request.rotation_deg = {0.0, 30.0};
  // Half a degree of receiver, so that one ring of six spots serves both turns.
  request.apertures = {Angle::from_deg(0.5), Angle::from_deg(0.1)};
  request.advice = true;
  const PhotometryResult result = run(design, request);
  EXPECT_EQ(result.verdict, Verdict::fail);
  ASSERT_EQ(result.changes.size(), 1U);
  const PhotometricChange& change = result.changes[0];
  EXPECT_EQ(change.key, "surface.dihedral_error_arcmin");
  EXPECT_EQ(change.verdict, Verdict::pass);
  Design changed = design;
  changed.part().angle_errors.dihedral_error_arcmin.fill(change.to);
  request.advice = false;
  const PhotometryResult again = run(changed, request);
  ASSERT_EQ(again.points.size(), change.points.size());
  for (std::size_t k = 0; k < again.points.size(); ++k)
    EXPECT_EQ(again.points[k].r_i_mcd_per_lx, change.points[k].r_i_mcd_per_lx);
  EXPECT_EQ(again.verdict, Verdict::pass);
}

/// Interrupts when all of the table has been measured.
struct InterruptAfterTheTable : Progress {
  Cancellation cancellation;
  void at(double share) override {
    if (share >= 1.0) cancellation.request();
  }
};

TEST(Photometry, AnInterruptedSearchForWhatToChangeIsNotComplete) {
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  InterruptAfterTheTable interrupt;
  const PhotometryResult result =
      PhotometryStudy(design_of(honeycomb(0.0, 60.0), true), request).run(&interrupt, &interrupt.cancellation);
  EXPECT_EQ(result.points.size(), 1U);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.changes.empty());
}

TEST(Photometry, WhatCannotPassIsToldWithTheBestThatWasTried) {
  const Design design = design_of(honeycomb(0.0, 60.0), true);
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  const PhotometryResult result = run(design, request);
  ASSERT_EQ(result.changes.size(), 2U);
  for (const PhotometricChange& change : result.changes) EXPECT_EQ(change.verdict, Verdict::fail);
  EXPECT_NE(photometry_table(result).find("not enough"), std::string::npos);
}

TEST(Photometry, RefusesWhatItCannotMeasure) {
  const Design design = design_of(honeycomb(), true);
  const auto refusal = [&](const std::function<void(PhotometryRequest&)>& spoil) -> std::string {
    PhotometryRequest request = request_of(points_at({0.2, 1.5}, 1.0));
    request.limits_source = "l.csv";
    spoil(request);
    return refusal_of([&] { PhotometryStudy(design, request); }, "accepted");
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_TRUE(refusal([](auto& r) { r.area_cm2 = 0.0; }).starts_with("--area-cm2: must be a number above 0"));
  EXPECT_TRUE(refusal([](auto& r) { r.window_deg = 1.0; }).starts_with("l.csv:2: observation_deg: must lie within"));
  EXPECT_TRUE(refusal([](auto& r) { r.window_deg = 20.0; }).starts_with("--window-deg: must be"));
  EXPECT_TRUE(refusal([](auto& r) { r.apertures = {}; }).starts_with("--source-arcmin: must be"));
  EXPECT_TRUE(refusal([](auto& r) { r.engine = Engine::cell; }).starts_with("--engine: must be"));
}

}  // namespace
}  // namespace retrace::studies::photometry_test
