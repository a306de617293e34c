// Tests of detector maps: closed forms, the ledger, and agreement of the engines.
#include "raytrace/observers/detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/threads.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/image/detector_study.h"
#include "studies/rre/rre.h"
#include "tests/support/cancel_at.h"
#include "tests/support/designs.h"
#include "tests/support/return_frames.h"
#include "tests/support/statistics.h"

namespace retrace::testing::detector_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kTruncated = 1e-4;

DetectorSetting setting_of(const Part& part, std::size_t columns, std::size_t rows, const Illumination& light = {}) {
  const Rectangle bounds = part.period_mm ? Rectangle{Vec2::Zero(), *part.period_mm} : bounding_box(part.outline);
  const ReturnFrame frame = frame_at(light);
  return {{bounds, columns, rows}, {DirectionGrid::Layout::square, 0.02, 21, 21}, frame, 0.5};
}

double mean_over_face(const Part& part, const DetectorSetting& setting, const std::vector<double>& irradiance) {
  double sum = 0.0;
  for (const double e : irradiance) sum += e;
  return sum * setting.face.pixel_area_mm2() / part.entrance_area_mm2;
}

/// Returns the power in the angular map, plus the power outside of its window.
double power_of_directions(const DetectorMaps& maps, const DirectionGrid& grid) {
  double power = maps.outside;
  for (std::size_t k = 0; k < grid.size(); ++k) power += maps.per_sr.value[k] * grid.solid_angle_sr(k);
  return power;
}

DetectorMaps exact(const Part& part, const Optics& optics, const Illumination& light, const DetectorSetting& setting) {
  BeamPolicy policy;
  policy.truncated_goal = kTruncated;
  return exact_detector_maps(part, optics, light, setting, policy);
}

TEST(DetectorMaps, MeansAreRre) {
  const std::vector<PartSpec> specs = {
      finite(RtpElement{2.0, 2.0}, Arrangement::offset, 10.0, 10.0, 2.0),
      infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0),
      infinite(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0),
  };
  for (const PartSpec& spec : specs)
    for (const double incidence : {0.0, 5.0}) {
      const Part part = build_part(spec);
      const DetectorSetting setting = setting_of(part, 37, 31, from(incidence));
      const DetectorMaps maps = exact(part, pmma(), from(incidence), setting);
      BeamPolicy policy;
      policy.truncated_goal = kTruncated;
      // If beams are observed, all beams are traced down to the same cut-off. Without an observer, the cut-off may
      // differ between beams.
      const auto ignored = [](const ReturnedBeam&) {};
      const BeamResult whole = BeamTracer(part).trace(pmma(), from(incidence), {0.5}, policy, nullptr, ignored);
      const double rre = whole.ledgers.front()[Account::retroreflected];
      EXPECT_NEAR(maps.rre, rre, 1e-9);
      EXPECT_NEAR(mean_over_face(part, setting, maps.leaving.value), maps.rre, 1e-9);
      EXPECT_NEAR(mean_over_face(part, setting, maps.entering.value), maps.rre, 1e-9);
      const Ledger& ledger = whole.ledgers.front();
      EXPECT_NEAR(power_of_directions(maps, setting.angles),
                  rre + ledger[Account::front_specular] + ledger[Account::returned_elsewhere], 1e-9);
    }
}

/// At normal incidence, a triangular cube corner returns light in the overlap of the triangle and its point reflection
/// about the apex. This overlap is a hexagon with two thirds of the area and uniform irradiance (Eckhardt 1971). The
/// three corners of the triangle return nothing.
TEST(DetectorMaps, TriangleIsAliveInItsHexagonAlone) {
  const Part part = build_part(single(TriangularCube{kCubeAperture}, 1.0));
  const DetectorSetting setting = setting_of(part, 120, 104);
  const DetectorMaps maps = exact(part, ideal(), {}, setting);
  EXPECT_NEAR(maps.rre, 2.0 / 3.0, 1e-9);
  const Vec2 apex = centroid(part.outline);
  const auto depth_in_triangle = [&](const Vec2& p) {
    double least = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 a = part.outline[k];
      const Vec2 along = (part.outline[(k + 1) % 3] - a).normalized();
      least = std::min(least, along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x()));
    }
    return least;
  };
  std::size_t judged = 0;
  for (std::size_t row = 0; row < setting.face.rows(); ++row)
    for (std::size_t column = 0; column < setting.face.columns(); ++column) {
      const Rectangle pixel = setting.face.pixel_mm(column, row);
      const Vec2 p = 0.5 * (pixel.lower + pixel.upper);
      const double inside = std::min(depth_in_triangle(p), depth_in_triangle(2.0 * apex - p));
      if (std::abs(inside) < pixel.size().norm()) continue;  // on the edge of the hexagon
      ++judged;
      const double expected = inside > 0.0 ? 1.0 : 0.0;
      const std::size_t k = row * setting.face.columns() + column;
      ASSERT_NEAR(maps.entering.value[k], expected, 1e-9) << p.transpose();
      ASSERT_NEAR(maps.leaving.value[k], expected, 1e-9) << p.transpose();
    }
  EXPECT_GT(judged, 9000U);
}

/// Light leaves a prism at the mirror image of its entry point about the roof edge, on the other half of the prism.
/// Some halves of prisms therefore return nothing, and other halves are not illuminated.
TEST(DetectorMaps, PathsAndBeamsRecordTheSame) {
  const Part part = build_part(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 6.0, 6.0, 1.0));
  for (const double incidence : {0.0, 4.0}) {
    const Illumination light = from(incidence, 20.0);
    const DetectorSetting setting = setting_of(part, 24, 24, light);
    const DetectorMaps beams = exact(part, pmma(), light, setting);
    const DetectorMaps paths = sampled_detector_maps(part, pmma(), light, setting, 1U << 19, 3, {});
    EXPECT_EQ(paths.rays, 1U << 19);
    EXPECT_NEAR(paths.rre, beams.rre, student_bound(2) * paths.std_error + beams.truncated);
    std::size_t compared = 0;
    double most = 0.0;
    for (const auto& [mine, theirs] :
         {std::pair{&paths.leaving, &beams.leaving}, std::pair{&paths.entering, &beams.entering}})
      for (std::size_t k = 0; k < mine->value.size(); ++k) {
        ++compared;
        // The standard errors of pixels with few rays are unreliable, so 1e-4 is added.
        most = std::max(most, std::abs(mine->value[k] - theirs->value[k]) / (mine->std_error[k] + 1e-4));
      }
    EXPECT_LT(most, student_bound(2 * compared)) << "at incidence " << incidence;
  }
}

TEST(DetectorMaps, AreTheSameWithAnyNumberOfThreads) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0));
  const DetectorSetting setting = setting_of(part, 16, 16, from(10.0));
  const auto traced = [&](unsigned threads) {
    DetectorMaps maps;
    run_with_threads(threads, [&] { maps = sampled_detector_maps(part, pmma(), from(10.0), setting, 70'000, 5, {}); });
    return maps;
  };
  const DetectorMaps one = traced(1);
  const DetectorMaps five = traced(5);
  EXPECT_EQ(one.leaving.value, five.leaving.value);
  EXPECT_EQ(one.leaving.std_error, five.leaving.std_error);
  EXPECT_EQ(one.entering.value, five.entering.value);
  EXPECT_EQ(one.per_sr.value, five.per_sr.value);
}

/// Table 1 of Hamilton et al. 2017: brick rows have spots along two borders that return no light. They explain the loss
/// of RRE.
TEST(DetectorStudy, MapOfTheBrickArrayHoldsItsRre) {
  design::Design design;
  design.part() = finite(RtpElement{2.0, 2.0}, Arrangement::offset, 10.0, 10.0, 2.0);
  design.part().array.shifted_rows = RowParity::odd;
  design.substance.refractive_index = kPmma;
  studies::RreSettings asked;
  asked.engine = raytrace::Engine::exact;
  const double rre = studies::RreStudy({design}, asked).run().points.front().rre;
  DetectorRequest request;
  request.pixels = 50;
  const studies::DetectorResult result = studies::DetectorStudy(design, request).run();
  EXPECT_EQ(result.engine, "exact");
  EXPECT_EQ(result.face.columns(), 50U);
  double sum = 0.0;
  for (const double e : result.maps.leaving.value) sum += e;
  EXPECT_NEAR(sum / 2500.0, rre, 2e-5);
  // At both ends of the shifted rows there are halves of elements. They send all light to the border wall. Only the
  // light that a plate reflects returns: R + T^2 R / (1 - R^2) = 2 R / (1 + R).
  const double r = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  EXPECT_NEAR(result.maps.entering.value[45 * 50 + 1], 2.0 * r / (1.0 + r), 1e-4);
  EXPECT_GT(result.maps.entering.value[25 * 50 + 25], 0.9);
}

/// Merged bins reach the requested error where there is light. Their deviations from the exact maps agree with their
/// standard errors over many seeds, and the sums do not change.
TEST(DetectorMaps, BinsReachTheRequestedError) {
  const Part part = build_part(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 6.0, 6.0, 1.0));
  const Illumination light = from(4.0, 20.0);
  DetectorSetting setting = setting_of(part, 48, 48, light);
  const DetectorMaps beams = exact(part, pmma(), light, setting);
  const double goal = 0.02;
  setting.face_bins = {goal, 0.01};
  setting.angle_bins = {goal, 0.01};
  double squares = 0.0;
  double count = 0.0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    const DetectorMaps merged = sampled_detector_maps(part, pmma(), light, setting, 1U << 19, seed, {});
    EXPECT_LE(largest_relative_error(merged.leaving, 0.02), goal);
    EXPECT_LE(largest_relative_error(merged.entering, 0.02), goal);
    EXPECT_NEAR(mean_over_face(part, setting, merged.leaving.value), merged.rre, 1e-9);
    EXPECT_NEAR(mean_over_face(part, setting, merged.entering.value), merged.rre, 1e-9);
    // Pixels of one bin have the same value, and bins are blocks of 2^k pixels. The exact value of a bin is the mean of
    // its pixels.
    std::map<std::pair<double, double>, std::pair<double, double>> bins;
    for (std::size_t k = 0; k < merged.leaving.value.size(); ++k) {
      auto& [sum, pixels] = bins[{merged.leaving.value[k], merged.leaving.std_error[k]}];
      sum += beams.leaving.value[k];
      pixels += 1.0;
    }
    EXPECT_LT(bins.size(), merged.leaving.value.size());
    EXPECT_GT(bins.size(), 10U);
    for (const auto& [bin, exact_value] : bins) {
      if (bin.first < 0.02) continue;
      squares += std::pow((bin.first - exact_value.first / exact_value.second) / bin.second, 2.0);
      count += 1.0;
    }
  }
  EXPECT_LT(squares / count, 1.3) << "errors are not larger than stated";
  EXPECT_GT(squares / count, 0.3) << "stated errors are not much too large";
}

TEST(PixelPyramid, WithoutARuleEveryPixelIsABin) {
  PixelPyramid pyramid(3, 2, {});
  for (int replicate = 0; replicate < 4; ++replicate) {
    for (std::size_t k = 0; k < 6; ++k)
      pyramid.replicate()[k] = static_cast<double>(k) + (replicate % 2 == 0 ? 0.1 : -0.1);
    pyramid.close(2.0);
  }
  const PixelValues values = pyramid.values(1000, 0.0);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(values.value[k], 2.0 * static_cast<double>(k), 1e-12);
    EXPECT_GT(values.std_error[k], 0.0);
  }
}

TEST(PixelPyramid, DividesOnlyWhereTheErrorAllowsIt) {
  // The left half has no noise, and the right half has pixels with noise.
  PixelPyramid pyramid(8, 4, {0.05, 0.01});
  for (int replicate = 0; replicate < 16; ++replicate) {
    for (std::size_t k = 0; k < 32; ++k) {
      const bool is_noisy = k % 8 >= 4;
      // The signs are opposite in neighbouring pixels, so that blocks have no noise.
      const double sign = (k + k / 8 + static_cast<std::size_t>(replicate)) % 2 == 0 ? 1.0 : -1.0;
      pyramid.replicate()[k] = 1.0 + (is_noisy ? 0.9 * sign : 0.1 * static_cast<double>(k % 8));
    }
    pyramid.close(1.0);
  }
  const PixelValues values = pyramid.values(1'000'000, 0.0);
  for (std::size_t k = 0; k < 32; ++k)
    EXPECT_NEAR(values.value[k], k % 8 >= 4 ? 1.0 : 1.0 + 0.1 * static_cast<double>(k % 8), 1e-9) << k;
  EXPECT_LE(largest_relative_error(values, 0.01), 0.05);
}

/// The far field of the exact engine has the sum of RRE and is wider than without diffraction.
TEST(DetectorStudy, AngularMapHasDiffraction) {
  design::Design design;
  design.part() = infinite(HexagonalCube{0.2}, Arrangement::honeycomb, 0.5);
  design.substance.refractive_index = kPmma;
  DetectorRequest request;
  request.pixels = 20;
  request.angle_pixels = 61;
  const studies::DetectorResult result = studies::DetectorStudy(design, request).run();
  ASSERT_TRUE(result.has_diffraction);
  EXPECT_EQ(result.engine, "exact");
  // The pattern of a cell of 0.2 mm has a width of 0.17 degrees.
  EXPECT_GT(result.window_deg, 0.5);
  EXPECT_LT(result.window_deg, 3.0);
  const DirectionGrid grid{DirectionGrid::Layout::square, Angle::from_deg(result.window_deg).rad(), 61, 61};
  const std::vector<double>& per_sr = result.maps.per_sr.value;
  const double brightest = *std::ranges::max_element(per_sr);
  EXPECT_GT(std::ranges::count_if(per_sr, [&](double value) { return value > 0.02 * brightest; }), 20);
  const double leaving = power_of_directions(result.maps, grid);
  const double inside = leaving - result.maps.outside;
  const Part part = build_part(design.part());
  const DetectorSetting plain = setting_of(part, 4, 4);
  const DetectorMaps without = exact(part, pmma(), {}, plain);
  EXPECT_NEAR(leaving, power_of_directions(without, plain.angles), 1e-3);
  EXPECT_NEAR(without.rre, result.maps.rre, 1e-3);
  EXPECT_GT(inside, 0.9 * result.maps.rre);
  EXPECT_LT(inside, result.maps.rre + 1e-3);
  request.engine = "montecarlo";
  request.samples = 1U << 14;
  const studies::DetectorResult by_rays = studies::DetectorStudy(design, request).run();
  EXPECT_FALSE(by_rays.has_diffraction);
  EXPECT_FALSE(by_rays.without_diffraction.empty());
  EXPECT_LT(by_rays.window_deg, 0.2) << "without diffraction, the light returns in one direction";
}

/// Without a requested number of rays, rays are added in passes until bins are small, or until the maximum number of
/// passes is reached.
TEST(DetectorStudy, RaysAreAddedUntilBinsAreSmall) {
  constexpr std::uint64_t kRays = 1U << 16;
  design::Design design;
  design.part() = infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 1.0);
  design.substance.refractive_index = kPmma;
  DetectorRequest request;
  request.engine = "montecarlo";
  request.pixels = 40;
  request.angle_pixels = 21;
  const auto run = [&](double error) {
    request.bin_error = error;
    return studies::DetectorStudy(design, request, kRays).run();
  };
  const studies::DetectorResult coarse = run(0.5);
  EXPECT_EQ(coarse.maps.rays, kRays);
  EXPECT_EQ(coarse.face_bin_pixels, 1U);
  EXPECT_FALSE(coarse.is_limit_reached);
  // This error is smaller than that of the pixels after one pass, so that more passes are needed.
  const studies::DetectorResult fine = run(0.6 * coarse.face_error);
  EXPECT_GT(fine.maps.rays, kRays);
  EXPECT_EQ(fine.is_limit_reached, fine.face_bin_pixels > 1 || fine.angle_bin_pixels > 1);
  const studies::DetectorResult limited = run(0.05 * coarse.face_error);
  EXPECT_TRUE(limited.is_limit_reached);
  EXPECT_EQ(limited.maps.rays, studies::kMaxDetectorPasses * kRays);
  EXPECT_GT(limited.face_bin_pixels, 1U);
  EXPECT_LT(limited.maps.std_error, coarse.maps.std_error);
  request.samples = 1U << 14;
  const studies::DetectorResult fixed = run(0.05);
  EXPECT_EQ(fixed.maps.rays, 1U << 14);
  EXPECT_FALSE(fixed.is_limit_reached);
}

/// An interrupted run returns the maps of the finished replicates, if there are enough of them.
TEST(DetectorStudy, FinishedReplicatesRemainAfterAnInterrupt) {
  design::Design design;
  design.part() = infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 1.0);
  design.substance.refractive_index = kPmma;
  DetectorRequest request;
  request.engine = "montecarlo";
  request.pixels = 20;
  request.samples = 1U << 18;
  CancelAt late(0.5);
  const studies::DetectorResult half = studies::DetectorStudy(design, request).run(&late, &late.cancel);
  EXPECT_FALSE(half.complete);
  ASSERT_TRUE(half.has_maps());
  EXPECT_LT(half.maps.rays, 1U << 18);
  const studies::DetectorResult whole = studies::DetectorStudy(design, request).run();
  EXPECT_NEAR(half.maps.rre, whole.maps.rre, student_bound(1) * std::hypot(half.maps.std_error, whole.maps.std_error));
  CancelAt early(0.0);
  const studies::DetectorResult none = studies::DetectorStudy(design, request).run(&early, &early.cancel);
  EXPECT_FALSE(none.complete);
  EXPECT_FALSE(none.has_maps());
  request = {};
  Cancellation now;
  now.request();
  const studies::DetectorResult exact = studies::DetectorStudy(design, request).run(nullptr, &now);
  EXPECT_EQ(exact.engine, "exact");
  EXPECT_FALSE(exact.has_maps());
  EXPECT_GT(exact.window_deg, 0.0);
}

/// The maps of light of several wavelengths are the weighted sums of the maps of single wavelengths.
TEST(DetectorMaps, WavelengthsAreAdded) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0));
  const Illumination light = from(20.0);
  const DetectorSetting setting = setting_of(part, 12, 12, light);
  Optics other = pmma();
  other.index = 1.55;
  const Optics first = pmma();
  const std::vector<DetectorLight> lights = {{&first, 0.3, 5}, {&other, 0.7, 6}};
  DetectorSampler sampler(part, lights, light, setting, 1U << 16, {});
  ASSERT_TRUE(sampler.add_pass());
  const DetectorMaps both = sampler.maps();
  const DetectorMaps a = sampled_detector_maps(part, first, light, setting, 1U << 15, 5, {});
  const DetectorMaps b = sampled_detector_maps(part, other, light, setting, 1U << 15, 6, {});
  EXPECT_NEAR(both.rre, 0.3 * a.rre + 0.7 * b.rre, 1e-12);
  for (std::size_t k = 0; k < both.leaving.value.size(); ++k)
    EXPECT_NEAR(both.leaving.value[k], 0.3 * a.leaving.value[k] + 0.7 * b.leaving.value[k], 1e-9);
  ASSERT_TRUE(sampler.add_pass());
  const DetectorMaps twice = sampler.maps();
  EXPECT_EQ(twice.rays, 2U * both.rays);
  EXPECT_LT(twice.std_error, both.std_error);
  EXPECT_NEAR(power_of_directions(twice, setting.angles), power_of_directions(both, setting.angles), 5e-3);
}

/// The window contains 99.9 % of the light, or is the given one.
TEST(DetectorStudy, WindowFitsTheLight) {
  design::Design design;
  design.part() = infinite(RtpElement{0.5, 0.5}, Arrangement::offset, 0.5);
  design.substance.refractive_index = kPmma;
  DetectorRequest request;
  request.engine = "montecarlo";
  request.samples = 1U << 16;
  request.pixels = 10;
  const studies::DetectorResult fitted = studies::DetectorStudy(design, request).run();
  EXPECT_LT(fitted.maps.outside, 1e-9) << "all light returns to the source";
  EXPECT_LT(fitted.window_deg, 0.2);
  request.window_deg = 2.5;
  EXPECT_EQ(studies::DetectorStudy(design, request).run().window_deg, 2.5);
  AngularRings rings;
  std::fill_n(rings.power.begin(), 1000, 1.0);
  EXPECT_NEAR(rings.half_angle_deg(0.5).value(), 2.5, 1e-9);
  EXPECT_FALSE(AngularRings{}.half_angle_deg(0.999));
}

// If the entrance face scatters, the maps also contain the light that the face reflects or scatters without entering.
// The maps then contain all light that leaves the face.
TEST(DetectorMaps, OfASoiledEntrance) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5}, Arrangement::offset, 0.5));
  Optics optics = pmma();
  optics.entrance.dust = {0.3, 0.9, 0.5};
  const DetectorSetting setting = setting_of(part, 8, 8, from(5.0));
  const DetectorMaps maps = sampled_detector_maps(part, optics, from(5.0), setting, 1U << 13, 1, {});
  const ConeResult traced = MonteCarlo(part).trace(optics, from(5.0), {0.5}, rays(1U << 13), {}).cones[0];
  double left = 0.0;
  for (const Account a :
       {Account::retroreflected, Account::front_specular, Account::returned_elsewhere, Account::scattered_out})
    left += traced.ledger[a];
  EXPECT_NEAR(power_of_directions(maps, setting.angles), left, 5e-3);
  EXPECT_NEAR(maps.rre, traced.rre, student_bound(1) * std::hypot(maps.std_error, traced.std_error));
}

}  // namespace
}  // namespace retrace::testing::detector_test
