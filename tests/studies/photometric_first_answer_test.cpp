// Tests of preliminary readings of photometry, which are computed in parallel with a long measurement.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "design/io/design_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/photometry.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/sample_size.h"

namespace retrace::studies::photometric_first_answer_test {
namespace {

using namespace photometric_requests;

/// Number of rays of the preliminary readings, divided by that of the measurement.
constexpr double kRayShare = 1.0 / 32.0;

design::Design cubes() {
  return design_of(honeycomb(2.0));
}

/// Returns a photometry request with two observation angles, at an entrance angle at which some light is trapped in the
/// part. The Monte Carlo engine uses one wavelength without diffraction. All other engines use diffraction and the
/// wavelengths of illuminant A.
PhotometrySettings request_by(raytrace::Engine engine) {
  TestPlan programme = points_at({0.1, 0.2}, 1.0);
  for (TestPoint& point : programme.points) point.h_deg = 20.0;
  PhotometrySettings request = request_of(programme);
  request.engine = engine;
  if (engine == raytrace::Engine::montecarlo) {
    request.rays = std::uint64_t{1} << 19U;
  } else {
    request.diffraction = true;
    request.light = PhotometricLight::illuminant_a;
  }
  return request;
}

/// A measurement with an engine, and its preliminary readings. They are computed only one time, because several tests
/// use them.
struct Measured {
  explicit Measured(raytrace::Engine engine)
      : study(cubes(), request_by(engine)), result(study.run()), first(study.first_answer(kRayShare)) {}

  PhotometryStudy study;
  PhotometryResult result;
  std::optional<PhotometricFirstAnswer> first;
};
const Measured& measured(raytrace::Engine engine) {
  static const Measured by_rays(raytrace::Engine::montecarlo);
  static const Measured by_beams(raytrace::Engine::automatic);
  return engine == raytrace::Engine::montecarlo ? by_rays : by_beams;
}

TEST(PhotometricFirstAnswer, AgreesWithTheFinalReadingsWithinItsErrors) {
  for (const raytrace::Engine engine : {raytrace::Engine::montecarlo, raytrace::Engine::automatic}) {
    const auto& [study, result, first] = measured(engine);
    ASSERT_TRUE(first.has_value());
    EXPECT_FALSE(first->lacks_diffraction);
    ASSERT_EQ(first->points.size(), result.points.size());
    for (std::size_t k = 0; k < result.points.size(); ++k) {
      const double value = result.points[k].r_i_mcd_per_lx;
      const double error = first->points[k].std_error_mcd_per_lx;
      EXPECT_GT(value, 0.0);
      EXPECT_GT(error, 0.0);
      EXPECT_LT(error, 0.2 * value) << k;
      EXPECT_NEAR(
          first->points[k].r_i_mcd_per_lx, value,
          3.0 * std::hypot(error, result.points[k].std_error_mcd_per_lx) + kSystematicErrorOfFirstAnswer * value)
          << engine_name(engine) << ", point " << k;
    }
    const std::string table = first_answer_table(*first);
    EXPECT_TRUE(table.starts_with("preliminary readings")) << table;
    EXPECT_EQ(table.find("verdict"), std::string::npos) << table;
  }
}

TEST(PhotometricFirstAnswer, CostsLess) {
  const Measured& by_beams = measured(raytrace::Engine::automatic);
  EXPECT_LT(3 * by_beams.first->wavelengths_nm.size(), by_beams.result.wavelengths_nm.size());
  // The preliminary readings use 1/32 of the rays. Their expected standard error is sqrt(32) = 5.7 times as large.
  const auto& [study, result, first] = measured(raytrace::Engine::montecarlo);
  EXPECT_GT(first->points[0].std_error_mcd_per_lx, 2.0 * result.points[0].std_error_mcd_per_lx);
  EXPECT_EQ(study.first_answer(1.0)->points[0].r_a, result.points[0].r_a) << "with all rays it is the final reading";
}

/// Stores all reported values of the progress, which are fractions from 0 to 1.
class Shares : public Progress {
 public:
  void at(double share) override { shares.push_back(share); }
  std::vector<double> shares;
};

// If only readings are requested, the progress is 1 when they are complete. Otherwise, a part of the progress is
// reserved for the colour, and for the search for a change of the design with which it passes.
TEST(PhotometricFirstAnswer, ProgressCoversEveryStage) {
  PhotometrySettings request = request_by(raytrace::Engine::automatic);
  for (TestPoint& point : request.test_plan.points) point.minimum = 1e6;
  request.light = PhotometricLight::illuminant_a;
  const auto shares_of = [&](bool has_colour, bool has_advice) {
    request.colour = has_colour;
    request.advice = has_advice;
    Shares progress;
    EXPECT_TRUE(PhotometryStudy(cubes(), request).run(&progress).complete);
    EXPECT_TRUE(std::ranges::is_sorted(progress.shares));
    EXPECT_LE(progress.shares.back(), 1.0 + 1e-12);
    return progress.shares;
  };
  const std::vector<double> readings = shares_of(false, false), with_colour = shares_of(true, false),
                            with_change = shares_of(true, true);
  EXPECT_NEAR(readings.back(), 1.0, 1e-12);
  EXPECT_NEAR(with_colour.back(), 1.0, 1e-12);
  EXPECT_GT(with_colour.size(), readings.size());
  EXPECT_LT(with_colour[readings.size() - 1], 0.9);
  EXPECT_LT(with_change[with_colour.size() - 1], 0.7);
  EXPECT_GT(with_change.size(), with_colour.size() + 14) << "one report for each change that was tried";
}

/// Starts the computation of preliminary readings on another thread when a measurement first reports progress.
class Meanwhile : public Progress {
 public:
  explicit Meanwhile(const PhotometryStudy& study) : study_(study) {}
  ~Meanwhile() override { join(); }
  Meanwhile(const Meanwhile&) = delete;
  Meanwhile& operator=(const Meanwhile&) = delete;

  void at(double) override {
    if (is_begun_) return;
    is_begun_ = true;
    thread_ = std::thread([this] { answer_ = study_.first_answer(kRayShare); });
  }
  const std::optional<PhotometricFirstAnswer>& answer() {
    join();
    return answer_;
  }

 private:
  void join() {
    if (thread_.joinable()) thread_.join();
  }

  const PhotometryStudy& study_;
  std::optional<PhotometricFirstAnswer> answer_;
  bool is_begun_ = false;
  std::thread thread_;
};

TEST(PhotometricFirstAnswer, ChangesNothingOfTheMeasurementThatRunsMeanwhile) {
  for (const raytrace::Engine engine : {raytrace::Engine::montecarlo, raytrace::Engine::automatic}) {
    const auto& [study, result, first] = measured(engine);
    PhotometryResult alone = result;
    Meanwhile meanwhile(study);
    PhotometryResult with_first = study.run(&meanwhile);
    ASSERT_TRUE(meanwhile.answer().has_value());
    alone.elapsed_s = with_first.elapsed_s = 0.0;
    EXPECT_EQ(photometry_json(with_first), photometry_json(alone));
    EXPECT_EQ(photometry_table(with_first), photometry_table(alone));
    EXPECT_EQ(first_answer_table(*meanwhile.answer()), first_answer_table(*first));
  }
}

TEST(PhotometricFirstAnswer, StopsWithTheMeasurementThatItBelongsTo) {
  for (const raytrace::Engine engine : {raytrace::Engine::montecarlo, raytrace::Engine::automatic}) {
    const PhotometryStudy& study = measured(engine).study;
    Cancellation whole;
    const Cancellation part(&whole);
    EXPECT_TRUE(study.first_answer(kRayShare, &part).has_value());
    whole.request();
    EXPECT_FALSE(study.first_answer(kRayShare, &part).has_value());
  }
}

/// A user may stop a run at any time. A rough finite part is used because most of its time is spent on far fields.
TEST(PhotometricFirstAnswer, MeasurementsStopAtAnyMoment) {
  using Clock = std::chrono::steady_clock;
  const design::Design rough = design::parse_design(
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2.5\n[array]\narrangement = \"honeycomb\"\n"
      "x_length_mm = 5\ny_length_mm = 5\n[body]\nthickness_mm = 2\nrefractive_index = 1.49\n"
      "[surface]\ndihedral_error_arcmin = 0.75\nroughness_sq_nm = 0.1\ncorrelation_length_um = 2\n",
      "rough.toml");
  PhotometrySettings request = request_of(points_at({0.1, 0.2, 0.5}, 1.0));
  request.diffraction = true;
  for (const design::Design& design : {rough, cubes()}) {
    const PhotometryStudy study(design, request);
    const Clock::time_point begin = Clock::now();
    ASSERT_TRUE(study.run().complete);
    const std::chrono::duration<double> whole = Clock::now() - begin;
    // The stops are spread evenly over the run. A shorter test only has fewer of them.
    const int stops = test::sample_size(5, 16);
    for (int k = 0; k < stops; ++k) {
      Cancellation cancel;
      std::thread user([&] {
        std::this_thread::sleep_for(whole * (k + 0.5) / stops);
        cancel.request();
      });
      const PhotometryResult result = study.run(nullptr, &cancel);
      user.join();
      // The run may have ended before it was stopped. Points that were not measured are not in the result.
      if (result.complete) {
        EXPECT_EQ(result.points.size(), 3U);
      }
      for (const PhotometricPoint& point : result.points) EXPECT_GT(point.r_i_mcd_per_lx, 0.0);
    }
  }
}

}  // namespace
}  // namespace retrace::studies::photometric_first_answer_test
