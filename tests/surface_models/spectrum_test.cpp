#include "surface_models/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surface_models/autocorrelation.h"
#include "surface_models/height_parameters.h"
#include "surface_models/scratches.h"
#include "tests/support/synthetic_surface.h"

namespace retrace::surface_models::spectrum_test {
namespace {

double line_power(const Spectrum& s) {
  double sum = 0.0;
  for (const double density : s.density) sum += density * s.frequency_per_mm.front();
  return sum;
}

TEST(Spectrum, AlongALineHoldsTheVariance) {
  const HeightMap map = testing::gaussian_surface(512, 512, 12.0, 1.5, 2);
  const double variance = std::pow(height_parameters(map.heights_nm).sq_nm, 2);
  EXPECT_NEAR(line_power(line_spectrum(map, Axis::x)) / variance, 1.0, 0.03);
  EXPECT_NEAR(line_power(line_spectrum(map, Axis::y)) / variance, 1.0, 0.03);
}

TEST(Spectrum, OfGaussianRoughnessIsTheClosedForm) {
  constexpr double kSq = 12.0;
  constexpr double kLength = 4.0;  // correlation length, um
  const HeightMap map = testing::gaussian_surface(1024, 1024, kSq, kLength, 4);
  const Spectrum radial = radial_spectrum(map);
  const Spectrum along = line_spectrum(map, Axis::x);
  const double length_mm = kLength * 1e-3;
  // Densities are summed over bands of frequencies, because the densities of single bins fluctuate randomly.
  for (const double f : {20.0, 40.0, 80.0, 120.0}) {
    double measured = 0.0;
    double expected = 0.0;
    double line_measured = 0.0;
    double line_expected = 0.0;
    for (std::size_t k = 0; k < radial.density.size(); ++k) {
      const double v = radial.frequency_per_mm[k];
      if (std::abs(v - f) > 8.0) continue;
      const double falls = std::exp(-std::pow(std::numbers::pi * length_mm * v, 2));
      measured += radial.density[k];
      expected += kSq * kSq * std::numbers::pi * length_mm * length_mm * falls;
      line_measured += along.density[k];
      line_expected += 2.0 * kSq * kSq * std::sqrt(std::numbers::pi) * length_mm * falls;
    }
    EXPECT_NEAR(measured / expected, 1.0, 0.06) << f;
    EXPECT_NEAR(line_measured / line_expected, 1.0, 0.06) << f;
  }
}

TEST(Spectrum, ToleratesMissingPoints) {
  HeightMap map = testing::gaussian_surface(256, 256, 12.0, 4.0, 2);
  const double whole = line_power(line_spectrum(map, Axis::x));
  for (std::size_t i = 0; i < map.heights_nm.size(); ++i)
    if (philox({9, 0}, static_cast<std::uint32_t>(i), 0)[0] % 20 == 0) map.heights_nm[i] = kMissing;
  EXPECT_NEAR(line_power(line_spectrum(map, Axis::x)) / whole, 1.0, 0.03);
  EXPECT_TRUE(line_spectrum({7, 1, 1.0, 1.0, std::vector<double>(7, 0.0)}, Axis::x).density.empty());
  EXPECT_TRUE(radial_spectrum({100, 1, 1.0, 1.0, std::vector<double>(100, 0.0)}).density.empty());
}

TEST(DominantPeaks, FindWavesBetweenTheBins) {
  HeightMap map = testing::gaussian_surface(700, 500, 3.0, 2.0, 6);
  testing::add_wave(map, 8.0, 42.4e-3, 0.0, 0.7);
  testing::add_wave(map, 4.0, 0.0, 97.3e-3, 0.1);
  const std::vector<SpectralPeak> peaks = dominant_peaks(map);
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_EQ(peaks[0].axis, Axis::x);
  EXPECT_NEAR(peaks[0].frequency_per_mm, 42.4, 0.03);
  EXPECT_NEAR(peaks[0].sq_nm, 8.0, 0.1);
  EXPECT_EQ(peaks[1].axis, Axis::y);
  EXPECT_NEAR(peaks[1].frequency_per_mm, 97.3, 0.03);
  EXPECT_NEAR(peaks[1].sq_nm, 4.0, 0.1);
}

TEST(DominantPeaks, FindWeakMarksOnManyLines) {
  HeightMap map = testing::gaussian_surface(400, 400, 8.0, 5.0, 9);
  testing::add_wave(map, 3.0, 60.0e-3, 0.0, 0.7);
  const std::vector<SpectralPeak> peaks = dominant_peaks(map);
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_NEAR(peaks[0].frequency_per_mm, 60.0, 0.3);
  EXPECT_NEAR(peaks[0].sq_nm, 3.0, 0.3);
}

TEST(DominantPeaks, OfRandomSurfacesAreNone) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    EXPECT_TRUE(dominant_peaks(testing::gaussian_surface(300, 300, 5.0, 3.0, seed)).empty()) << seed;
    EXPECT_TRUE(dominant_peaks(testing::white_noise(2000, 1, seed)).empty()) << seed;
  }
  EXPECT_TRUE(dominant_peaks({50, 50, 1.0, 1.0, std::vector<double>(2500, 0.0)}).empty());
}

TEST(Autocorrelation, EqualsTheDirectSumWithMissingPoints) {
  HeightMap map = testing::gaussian_surface(31, 26, 4.0, 3.0, 7);
  for (std::size_t i = 0; i < map.heights_nm.size(); i += 5) map.heights_nm[i] = kMissing;
  const double mean = summarise(map.heights_nm).mean;
  const Autocorrelation r = autocorrelation(map, 6.0);
  ASSERT_EQ(r.x_lags, 7U);
  for (std::ptrdiff_t dy = -6; dy <= 6; ++dy)
    for (std::size_t dx = 0; dx <= 6; ++dx) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t row = 0; row < map.rows; ++row)
        for (std::size_t column = 0; column + dx < map.columns; ++column) {
          const std::ptrdiff_t other = static_cast<std::ptrdiff_t>(row) + dy;
          if (other < 0 || other >= static_cast<std::ptrdiff_t>(map.rows)) continue;
          const double product =
              (map.at(column, row) - mean) * (map.at(column + dx, static_cast<std::size_t>(other)) - mean);
          if (std::isnan(product)) continue;
          sum += product;
          count += 1.0;
        }
      EXPECT_NEAR(r.at(dx, dy), sum / count, 1e-9) << dx << " " << dy;
    }
}

TEST(Autocorrelation, LengthOfAGaussianSurface) {
  const Autocorrelation r = autocorrelation(testing::gaussian_surface(1024, 1024, 10.0, 6.0, 3), 50.0);
  EXPECT_NEAR(*correlation_length_um(r, Axis::x), 6.0, 0.12);
  EXPECT_NEAR(*correlation_length_um(r, Axis::y), 6.0, 0.12);
  EXPECT_FALSE(correlation_length_um(autocorrelation({9, 9, 1.0, 1.0, std::vector<double>(81, 2.0)}, 5.0), Axis::x));
}

TEST(Scratches, AreCountedWithPlaceDepthAndWidth) {
  HeightMap map = testing::gaussian_surface(400, 300, 2.0, 2.0, 5);
  for (std::size_t column = 0; column < map.columns; ++column) {
    for (std::size_t row = 80; row < 83; ++row) map.at(column, row) -= 25.0;
    map.at(column, 200) += 15.0;
  }
  testing::add_wave(map, 10.0, 0.0, 1.0 / 150.0);  // a long wave, like remaining waviness
  const std::vector<Scratch> along = find_scratches(map, Axis::x, 20.0);
  ASSERT_EQ(along.size(), 2U);
  EXPECT_NEAR(along[0].position_um, 81.0, 1.0);
  EXPECT_NEAR(along[0].depth_nm, 25.0, 3.0);
  EXPECT_NEAR(along[0].width_um, 3.0, 1e-12);
  EXPECT_NEAR(along[1].position_um, 200.0, 1e-12);
  EXPECT_NEAR(along[1].depth_nm, -15.0, 3.0);
  EXPECT_TRUE(find_scratches(map, Axis::y, 20.0).empty());
}

TEST(Scratches, AreNeitherPitsNorFeedMarksNorChance) {
  HeightMap map = testing::gaussian_surface(400, 300, 2.0, 2.0, 11);
  EXPECT_TRUE(find_scratches(map, Axis::x, 20.0).empty());
  for (std::size_t column = 10; column < 60; ++column) map.at(column, 100) -= 300.0;  // a deep but short scratch
  EXPECT_TRUE(find_scratches(map, Axis::x, 20.0).empty());
  HeightMap marks = testing::gaussian_surface(400, 300, 2.0, 2.0, 12);
  testing::add_wave(marks, 10.0, 0.0, 0.1);
  EXPECT_TRUE(find_scratches(marks, Axis::x, 20.0).empty());
  EXPECT_TRUE(find_scratches({500, 1, 1.0, 1.0, std::vector<double>(500, 1.0)}, Axis::y, 20.0).empty());
}

}  // namespace
}  // namespace retrace::surface_models::spectrum_test
