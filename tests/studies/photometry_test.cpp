// Tests of the photometry of designs: closed forms, agreement with `retrace rre` at the same directions, dyes, and
// advice on what to change.
#include "studies/photometry/photometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "core/threads.h"
#include "design/io/design_reader.h"
#include "materials/io/spectrum_reader.h"
#include "requests/descriptions.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/standards.h"
#include "studies/rre/rre.h"
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

// Cube corners with all dihedral errors of 2.46 arcmin and n = 1.49 return six equal spots at 0.2 degrees. A receiver
// at 0.2 degrees that is smaller than the source sees the lamp in one spot, so that R_A = 1 / (6 Omega_source). If the
// part is rotated by 30 degrees, the receiver is between two spots.
TEST(Photometry, ReceiverSeesOneOfSixSpots) {
  design::Design design = design_of(honeycomb(2.46), true);
  design.substance.refractive_index = 1.49;
  PhotometrySettings request = request_of(points_at({0.2}, 1.0));
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
  // If several rotations are measured, the smallest value counts.
  request.rotation_deg = {0.0, 30.0, 60.0, 90.0};
  const PhotometricPoint all = run(design, request).points[0];
  EXPECT_EQ(all.r_a, 0.0);
  EXPECT_EQ(all.rotation_deg, seen[0] > 0.0 ? 30.0 : 0.0);
}

// The directions V and H are converted to incidence and azimuth. The RRE must equal that of `retrace rre`.
TEST(Photometry, VhGridAgreesWithRre) {
  for (const geometry::PartSpec& spec :
       {honeycomb(), infinite(geometry::TriangularCube{1.0}, Arrangement::triangular, 1.0)}) {
    const design::Design design = design_of(spec, true);
    PhotometrySettings request = request_of(r150("IA", "red"));
    request.cutoff = 1e-9;
    const PhotometryResult result = run(design, request);
    ASSERT_EQ(result.directions.size(), 7U);
    for (const PhotometricDirection& at : result.directions) {
      const double v = at.v_deg * kDeg;
      const double h = at.h_deg * kDeg;
      RreSettings asked;
      asked.incidence_deg = {std::acos(std::cos(v) * std::cos(h)) / kDeg};
      asked.azimuth_deg = {std::atan2(std::sin(v), std::sin(h) * std::cos(v)) / kDeg};
      asked.engine = raytrace::Engine::exact;
      asked.cutoff = 1e-9;
      const RreResult rre = RreStudy({design}, asked).run();
      EXPECT_NEAR(at.rre, rre.points[0].rre, 1e-8) << at.v_deg << " " << at.h_deg;
      EXPECT_GT(at.rre, 0.3);
    }
  }
}

// UN R3: if the entrance face returns the mirror image of the lamp, the smaller of the values at V = 5 and V = -5
// counts.
TEST(Photometry, IsMeasuredBesideTheMirrorImage) {
  TestPlan beside = points_at({0.2}, 1.0);
  beside.points[0].substitute_v_deg = {5.0, -5.0};
  TestPlan both = points_at({0.2, 0.2}, 1.0);
  both.points[0].v_deg = 5.0;
  both.points[1].v_deg = -5.0;
  // The dihedral errors are unequal, so that V = 5 and V = -5 give different values.
  geometry::PartSpec spec = honeycomb();
  spec.angle_errors.dihedral_error_arcmin = {2.0, 1.0, 3.0};
  const PhotometryResult found = run(design_of(spec), request_of(beside));
  const PhotometryResult apart = run(design_of(spec), request_of(both));
  const PhotometricPoint& up = apart.points[0];
  const PhotometricPoint& down = apart.points[1];
  ASSERT_GT(std::abs(up.r_a - down.r_a), 1e-3 * up.r_a);
  EXPECT_EQ(found.points[0].r_a, std::min(up.r_a, down.r_a));
  EXPECT_EQ(found.points[0].v_deg, up.r_a < down.r_a ? 5.0 : -5.0);
  EXPECT_EQ(found.points[0].test_point.v_deg, 0.0);
  EXPECT_NE(photometry_table(found).find("away from the mirror image of the lamp"), std::string::npos);
  // A face without reflection has no mirror image.
  const PhotometryResult lossless = run(design_of(spec, true), request_of(beside));
  EXPECT_EQ(lossless.points[0].v_deg, 0.0);
  EXPECT_EQ(lossless.points[0].r_a, run(design_of(spec, true), request_of(points_at({0.2}, 1.0))).points[0].r_a);
}

// Some directions share one trace: rotations at normal incidence, and mirrored directions. Their values must equal
// those of separate traces.
TEST(Photometry, DirectionsThatShareTheirLightHaveTheirOwnValues) {
  TestPlan all = points_at({0.2, 0.33, 0.33, 0.33}, 1.0);
  const std::vector<std::pair<double, double>> v_and_h = {{0.0, 0.0}, {5.0, 20.0}, {-5.0, 20.0}, {-5.0, -20.0}};
  for (std::size_t k = 0; k < v_and_h.size(); ++k) std::tie(all.points[k].v_deg, all.points[k].h_deg) = v_and_h[k];
  PhotometrySettings request = request_of(all);
  request.diffraction = true;
  request.engine = raytrace::Engine::exact;
  request.cutoff = 1e-6;
  const design::Design design = design_of(honeycomb(2.0));
  for (const double turn : {0.0, 40.0}) {
    request.rotation_deg = {turn};
    request.test_plan = all;
    const PhotometryResult together = run(design, request);
    for (std::size_t k = 0; k < v_and_h.size(); ++k) {
      request.test_plan = all;
      request.test_plan.points = {all.points[k]};
      const PhotometryResult alone = run(design, request);
      EXPECT_NEAR(together.points[k].r_a, alone.points[0].r_a, 1e-4 * alone.points[0].r_a) << k << ", turned " << turn;
      EXPECT_EQ(together.points[k].v_deg, alone.points[0].v_deg);
      EXPECT_NEAR(together.directions[k].rre, alone.directions[0].rre, 1e-5) << k;
    }
  }
}

/// Returns a request with diffraction at an angle of 20 degrees, at which light is trapped in the part.
PhotometrySettings diffracted(raytrace::Engine engine) {
  TestPlan programme = points_at({0.0, 0.2, 0.33, 0.5}, 1.0);
  for (TestPoint& point : programme.points) point.h_deg = 20.0;
  PhotometrySettings request = request_of(programme);
  request.diffraction = true;
  request.engine = engine;
  return request;
}

// Beams below the cut-off are resampled. No light is then truncated, and the standard errors of the points are known.
// The exact engine truncates these beams.
TEST(Photometry, ResamplesWeakBeams) {
  geometry::PartSpec small = finite(geometry::HexagonalCube{1.0}, Arrangement::honeycomb, 4.0, 4.0, 1.0);
  small.angle_errors.dihedral_error_arcmin.fill(2.0);
  for (const geometry::PartSpec& spec : {honeycomb(2.0), small}) {
    const design::Design design = design_of(spec);
    PhotometrySettings request = diffracted(raytrace::Engine::exact);
    const PhotometryResult exact = run(design, request);
    request.cutoff = 1e-7;
    const PhotometryResult further = run(design, request);
    const PhotometryResult resampled = run(design, diffracted(raytrace::Engine::automatic));
    EXPECT_EQ(exact.engine, "exact");
    EXPECT_EQ(resampled.engine, "stochastic");
    EXPECT_GT(exact.directions[0].truncated, 1e-5);
    EXPECT_EQ(exact.directions[0].std_error, 0.0);
    EXPECT_LT(std::abs(resampled.directions[0].truncated), 1e-12);
    EXPECT_GT(resampled.directions[0].std_error, 0.0);
    EXPECT_NEAR(resampled.directions[0].rre, further.directions[0].rre,
                student_bound(2, 16) * resampled.directions[0].std_error + further.directions[0].truncated);
    for (std::size_t k = 0; k < resampled.points.size(); ++k) {
      const PhotometricPoint& point = resampled.points[k];
      // The standard errors of the exact engine allow for truncated light.
      EXPECT_LE(std::abs(exact.points[k].r_i_mcd_per_lx - further.points[k].r_i_mcd_per_lx),
                1.96 * std::hypot(exact.points[k].std_error_mcd_per_lx, further.points[k].std_error_mcd_per_lx))
          << k;
      EXPECT_GT(point.std_error_mcd_per_lx, 0.0);
      EXPECT_LT(point.std_error_mcd_per_lx, 2e-3 * point.r_i_mcd_per_lx);
      // Resampled beams do not interfere, which changes readings by some 1e-3.
      EXPECT_NEAR(point.r_i_mcd_per_lx, further.points[k].r_i_mcd_per_lx,
                  student_bound(8, 16) * point.std_error_mcd_per_lx + 2e-3 * point.r_i_mcd_per_lx)
          << k;
    }
  }
}

design::Design rough(design::Design design, double sq_nm) {
  design.surface.texture = design::HarveyShackTexture{.roughness_sq_nm = sq_nm, .correlation_length_um = 5.0};
  return design;
}

// A roughness of 0.001 nm changes neither the readings nor their errors, for both bright and faint readings.
TEST(Photometry, InvisibleRoughnessChangesNoReading) {
  geometry::PartSpec small = finite(geometry::HexagonalCube{1.0}, Arrangement::honeycomb, 4.0, 4.0, 1.0);
  small.angle_errors.dihedral_error_arcmin.fill(2.0);
  PhotometrySettings request = diffracted(raytrace::Engine::automatic);
  for (TestPoint& point : points_at({0.8, 1.5}, 1.0).points) {
    point.h_deg = 20.0;
    request.test_plan.points.push_back(point);
  }
  for (const geometry::PartSpec& spec : {honeycomb(2.0), small}) {
    const design::Design design = design_of(spec);
    const PhotometryResult smooth = run(design, request);
    const PhotometryResult after = run(rough(design, 1e-3), request);
    EXPECT_EQ(after.engine, smooth.engine);
    ASSERT_EQ(after.points.size(), smooth.points.size());
    for (std::size_t k = 0; k < after.points.size(); ++k) {
      const double value = smooth.points[k].r_i_mcd_per_lx;
      EXPECT_NEAR(after.points[k].r_i_mcd_per_lx, value, 1e-5 * value) << k;
      EXPECT_NEAR(after.points[k].std_error_mcd_per_lx, smooth.points[k].std_error_mcd_per_lx, 1e-5 * value) << k;
    }
  }
}

// Readings and their errors include the light that resampled beams scatter at rough facets. The readings are compared
// with those of a run that follows beams exactly down to a lower cut-off.
TEST(Photometry, ResampledBeamsOfRoughFacetsScatterAsFollowedOnesDo) {
  const design::Design design = rough(design_of(honeycomb(2.0)), 20.0);
  PhotometrySettings request = diffracted(raytrace::Engine::exact);
  request.cutoff = 1e-6;
  const PhotometryResult further = run(design, request);
  const PhotometryResult resampled = run(design, diffracted(raytrace::Engine::automatic));
  EXPECT_EQ(resampled.engine, "stochastic");
  EXPECT_LT(resampled.directions[0].truncated, further.directions[0].truncated);
  EXPECT_NEAR(resampled.directions[0].rre, further.directions[0].rre,
              student_bound(1, 16) * resampled.directions[0].std_error + further.directions[0].truncated);
  for (std::size_t k = 0; k < resampled.points.size(); ++k) {
    const PhotometricPoint& point = resampled.points[k];
    EXPECT_GT(point.std_error_mcd_per_lx, 0.0);
    // Resampled beams do not interfere, which changes readings by some 1e-3.
    EXPECT_NEAR(point.r_i_mcd_per_lx, further.points[k].r_i_mcd_per_lx,
                student_bound(4, 16) * std::hypot(point.std_error_mcd_per_lx, further.points[k].std_error_mcd_per_lx) +
                    2e-3 * point.r_i_mcd_per_lx)
        << k;
  }
}

// Beams of facets with a form are not resampled but truncated. The standard errors cover the truncated light, and are
// small enough for a verdict.
TEST(Photometry, StandardErrorsOfFormsCoverTruncatedLight) {
  const design::Design design = design::read_design(std::string(RETRACE_SOURCE_DIR) + "/examples/sunk_reflector.toml",
                                                    std::vector<std::string>{"light.wavelength_nm=620"});
  PhotometrySettings request = diffracted(raytrace::Engine::automatic);
  const PhotometryResult found = run(design, request);
  request.cutoff = 1e-7;
  const PhotometryResult further = run(design, request);
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    const PhotometricPoint& point = found.points[k];
    EXPECT_GT(point.std_error_mcd_per_lx, 0.0) << k;
    EXPECT_LT(point.std_error_mcd_per_lx, 0.1 * point.r_i_mcd_per_lx) << k;
    EXPECT_NEAR(point.r_i_mcd_per_lx, further.points[k].r_i_mcd_per_lx, 1.96 * point.std_error_mcd_per_lx) << k;
  }
}

TEST(Photometry, ResampledBeamsDependOnTheSeedAndNotOnThreads) {
  const design::Design design = design_of(honeycomb(2.0));
  PhotometrySettings request = diffracted(raytrace::Engine::automatic);
  std::vector<PhotometryResult> results;
  for (const unsigned threads : {1U, 3U}) run_with_threads(threads, [&] { results.push_back(run(design, request)); });
  request.seed = 2;
  const PhotometryResult other = run(design, request);
  for (std::size_t k = 0; k < other.points.size(); ++k) {
    EXPECT_EQ(results[0].points[k].r_a, results[1].points[k].r_a);
    EXPECT_EQ(results[0].points[k].std_error_mcd_per_lx, results[1].points[k].std_error_mcd_per_lx);
    EXPECT_NE(results[0].points[k].r_a, other.points[k].r_a);
  }
}

// A part with an area outside the limits of its class fails, however bright it is. No change of its elements can help.
TEST(Photometry, APartOfTheWrongAreaFails) {
  PhotometrySettings request = request_of(points_at({0.1}, 1.0));
  LimitArea most;
  most.area_cm2 = 5.0;
  most.status = LimitStatus::read;
  request.test_plan.areas = {most};
  request.advice = true;
  const design::Design design = design_of(honeycomb(0.0, 20.0), true);
  const PhotometryResult large = run(design, request);
  EXPECT_EQ(large.verdict, Verdict::fail);
  EXPECT_EQ(large.points[0].verdict(), Verdict::pass);
  EXPECT_FALSE(large.change);
  EXPECT_NE(photometry_table(large).find("area: FAIL - must be at most 5 cm2, is 10 cm2"), std::string::npos);
  EXPECT_NE(photometry_json(large).find("\"limit\": \"at most 5 cm2\""), std::string::npos);
  request.area_cm2 = 4.0;
  EXPECT_EQ(run(design, request).verdict, Verdict::pass);
}

// A grey dye transmits exp(-a L) at normal incidence, where L = 2 (plate + depth) in a perfect array of prisms.
TEST(Photometry, DyeTakesItsShareOfTheFlux) {
  const design::Design design =
      design_of(infinite(geometry::RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 2.0), true);
  PhotometrySettings request = request_of(points_at({0.05}, 1.0));
  request.light = PhotometricLight::illuminant_a;
  const double clear = run(design, request).points[0].r_a;
  const double way_mm = 2.0 * 2.25;
  request.dye_absorption_per_mm = {{380.0, 780.0}, {0.2, 0.2}};
  EXPECT_NEAR(run(design, request).points[0].r_a / clear, std::exp(-0.2 * way_mm), 1e-9);
  // For the shipped dyes, the flux is compared with a sum over wavelengths. Each term is the product of the spectrum of
  // illuminant A, the luminous efficiency and the transmittance of the dye.
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
    const double dyed = run(design, request).points[0].r_a;
    EXPECT_NEAR(dyed / clear, behind / all, 2e-3 * behind / all) << name;
    // The key `absorption_per_mm` of the design gives the same result as the absorption of the dye in the request.
    design::Design coloured = design;
    std::vector<design::SpectralAbsorption> curve;
    for (std::size_t k = 0; k < request.dye_absorption_per_mm.values.size(); ++k)
      curve.push_back({request.dye_absorption_per_mm.wavelengths_nm[k], request.dye_absorption_per_mm.values[k]});
    coloured.substance.absorption_per_mm = curve;
    PhotometrySettings undyed = request;
    undyed.dye_absorption_per_mm = {};
    EXPECT_NEAR(run(coloured, undyed).points[0].r_a, dyed, 1e-12 * dyed) << name;
    EXPECT_GT(behind / all, 0.1);
    EXPECT_LT(behind / all, 0.7);
  }
}

// Monte Carlo agrees with the exact engine for equal apertures of source and receiver, within its standard error.
TEST(Photometry, MonteCarloAgreesWithTheExactEngine) {
  const design::Design design = design_of(honeycomb(4.0));
  PhotometrySettings request = request_of(r150("IA", "red"));
  request.test_plan.points.resize(4);
  request.engine = raytrace::Engine::exact;
  const PhotometryResult exact = run(design, request);
  request.engine = raytrace::Engine::montecarlo;
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

// Diffracted light reaches the region between the spots. The power outside of the window is reported.
TEST(Photometry, DiffractionReachesWhereRaysDoNot) {
  const design::Design design = design_of(honeycomb(0.0, 0.4));
  PhotometrySettings request = request_of(points_at({1.0 / 3.0}, 1.0));
  EXPECT_EQ(run(design, request).points[0].r_a, 0.0);
  request.diffraction = true;
  EXPECT_FALSE(run(design, request).directions[0].split) << "takes long, and was not asked for";
  request.window_power = true;
  const PhotometryResult result = run(design, request);
  EXPECT_GT(result.points[0].r_a, 50.0);
  ASSERT_TRUE(result.directions[0].split);
  const auto& split = *result.directions[0].split;
  EXPECT_NEAR(split.window + split.outside, split.geometric, 1e-3);
  EXPECT_GT(split.outside, 5e-3);
}

// Perfect cube corners return no light to a driver above the lamps. The program finds a dihedral error with which the
// part returns enough light, and reports the table of the changed design.
TEST(Photometry, FindsTheAngleErrorThatPasses) {
  const design::Design design = design_of(honeycomb(0.0, 10.0), true);
  PhotometrySettings request = request_of(points_at({1.0 / 3.0}, 300.0));
  request.rotation_deg = {0.0, 30.0};
  // The source has an angular diameter of half a degree, so that one ring of six spots is sufficient for both
  // rotations.
  request.apertures = {Angle::from_deg(0.5), Angle::from_deg(0.1)};
  request.advice = true;
  const PhotometryResult result = run(design, request);
  EXPECT_EQ(result.verdict, Verdict::fail);
  ASSERT_TRUE(result.change);
  const PhotometricChange& change = *result.change;
  EXPECT_EQ(change.key, "surface.dihedral_error_arcmin");
  EXPECT_EQ(change.verdict, Verdict::pass);
  design::Design changed = design;
  changed.part().angle_errors.dihedral_error_arcmin.fill(change.to);
  request.advice = false;
  const PhotometryResult again = run(changed, request);
  ASSERT_EQ(again.points.size(), change.points.size());
  for (std::size_t k = 0; k < again.points.size(); ++k)
    EXPECT_EQ(again.points[k].r_i_mcd_per_lx, change.points[k].r_i_mcd_per_lx);
  EXPECT_EQ(again.verdict, Verdict::pass);
}

/// Cancels the run during the search for a change of the design. The earlier stages, readings and colour, end at the
/// fraction 1.3 / 2.3 = 0.57 of the progress.
struct InterruptDuringTheSearch : Progress {
  Cancellation cancellation;
  void at(double share) override {
    if (share > 0.6) cancellation.request();
  }
};

TEST(Photometry, AnInterruptedSearchForWhatToChangeIsNotComplete) {
  PhotometrySettings request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  InterruptDuringTheSearch interrupt;
  const PhotometryResult result =
      PhotometryStudy(design_of(honeycomb(0.0, 60.0), true), request).run(&interrupt, &interrupt.cancellation);
  EXPECT_EQ(result.points.size(), 1U);
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.change);
}

TEST(Photometry, WhatCannotPassIsToldWithTheBestThatWasTried) {
  const design::Design design = design_of(honeycomb(0.0, 60.0), true);
  PhotometrySettings request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  const PhotometryResult result = run(design, request);
  ASSERT_TRUE(result.change);
  EXPECT_EQ(result.change->verdict, Verdict::fail);
  EXPECT_NE(photometry_table(result).find("not sufficient"), std::string::npos);
}

// The manual defines the default cut-off. It is 1e-5 of the power that enters one element. For resampled beams of a
// part with N elements, it is the larger of 5e-5 and 5e-7 N.
TEST(Photometry, ReportsItsCutoff) {
  PhotometrySettings request = request_of(points_at({0.2}, 1.0));
  const auto cutoff = [&](const geometry::PartSpec& part) {
    return PhotometryStudy(design_of(part, true), request).cutoff();
  };
  const auto finite = [](double length_mm) {
    geometry::PartSpec part = honeycomb();
    part.array.extent = geometry::Extent::finite;
    part.array.x_length_mm = part.array.y_length_mm = length_mm;
    return part;
  };
  EXPECT_DOUBLE_EQ(cutoff(honeycomb()), 1e-5);
  EXPECT_DOUBLE_EQ(cutoff(finite(4.0)), 5e-5);
  const geometry::PartSpec large = finite(12.0);
  const double elements = static_cast<double>(geometry::build_part(large).elements_full);
  ASSERT_GT(elements, 100.0);
  EXPECT_DOUBLE_EQ(cutoff(large), 5e-7 * elements);
  request.engine = raytrace::Engine::exact;
  EXPECT_DOUBLE_EQ(cutoff(finite(4.0)), 1e-5);
  request.cutoff = 3e-4;
  EXPECT_DOUBLE_EQ(cutoff(finite(4.0)), 3e-4);
}

TEST(Photometry, RefusesWhatItCannotMeasure) {
  const design::Design design = design_of(honeycomb(), true);
  const auto refusal = [&](const std::function<void(PhotometrySettings&)>& spoil) -> std::string {
    PhotometrySettings settings = request_of(points_at({0.2, 1.5}, 1.0));
    settings.limits_source = "l.csv";
    spoil(settings);
    return refusal_of([&] { PhotometryStudy(design, settings); }, "accepted");
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_EQ(refusal([](auto& s) { s.window_deg = 1.0; }), "l.csv:2: observation_deg");
  // The message gives the true bound and shows the rejected value with enough digits to be below the bound.
  for (const double arcmin : {0.0, 0.005, 0.0059})
    EXPECT_EQ(refusal([&](auto& s) { s.apertures = {Angle::from_deg(arcmin / 60.0), {}}; }), "source_arcmin");
  EXPECT_EQ(refusal([](auto& s) { s.apertures = {Angle::from_deg(0.006 / 60.0), {}}; }), "accepted");
  EXPECT_EQ(refusal([](auto& s) { s.engine = raytrace::Engine::cell; }), "engine");
  EXPECT_EQ(refusal([](auto& s) { s.cutoff = 0.0; }), "cutoff");
}

TEST(Photometry, RefusesRequestsOutOfRange) {
  const auto refusal = [](const std::function<void(PhotometryRequest&)>& spoil) -> std::string {
    PhotometryRequest request;
    request.standard = "r150";
    request.part_class = "IA";
    request.colour = "red";
    request.area_cm2 = 30.0;
    spoil(request);
    return refusal_of([&] { resolve(request, false); }, "accepted");
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_EQ(refusal([](auto& r) { r.standard = "r151"; }), "standard");
  EXPECT_EQ(refusal([](auto& r) { r.part_class = "XX"; }), "part_class");
  EXPECT_EQ(refusal([](auto& r) { r.colour = std::nullopt; }), "colour");
  EXPECT_EQ(refusal([](auto& r) { r.area_cm2 = 0.0; }), "area_cm2");
  EXPECT_EQ(refusal([](auto& r) { r.area_cm2 = -1.0; }), "area_cm2");
  EXPECT_EQ(refusal([](auto& r) { r.rotation_deg = std::vector<double>(); }), "rotation_deg");
  EXPECT_EQ(refusal([](auto& r) { r.rotation_deg = std::vector<double>(721, 0.0); }), "rotation_deg");
  EXPECT_EQ(refusal([](auto& r) { r.rotation_deg = std::vector<double>{0.0, 361.0}; }), "rotation_deg");
  EXPECT_EQ(refusal([](auto& r) { r.dye = "blue"; }), "dye");
  EXPECT_EQ(refusal([](auto& r) { r.source_arcmin = 300.1; }), "source_arcmin");
  EXPECT_EQ(refusal([](auto& r) { r.window_deg = 20.0; }), "window_deg");
  EXPECT_EQ(refusal([](auto& r) { r.engine = "cell"; }), "engine");
  EXPECT_EQ(refusal([](auto& r) { r.cutoff = 0.0; }), "cutoff");
}

TEST(Photometry, RequestsNameTheShippedStandards) {
  const requests::Row* const row = requests::row_of(requests::description<PhotometryRequest>(), "standard");
  ASSERT_NE(row, nullptr);
  std::vector<std::string_view> names;
  for (const ShippedStandard& standard : shipped_standards()) names.push_back(standard.name);
  const auto words = std::get<schema::WordOrFile>(row->kind).words;
  EXPECT_EQ(std::vector(words.begin(), words.end()), names);
}

}  // namespace
}  // namespace retrace::studies::photometry_test
