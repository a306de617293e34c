#include <gtest/gtest.h>

#include <cmath>

#include "surface_models/gaussian_filter.h"
#include "surface_models/height_parameters.h"
#include "tests/support/synthetic_surface.h"

namespace retrace::surface_models::filter_test {
namespace {

/// Returns the amplitude of the wave of frequency (fx, fy): its Fourier coefficient over a map of whole periods.
double amplitude(const HeightMap& map, double fx, double fy) {
  double c = 0.0;
  double s = 0.0;
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double t =
          2.0 * std::numbers::pi *
          (fx * static_cast<double>(column) * map.x_pixel_um + fy * static_cast<double>(row) * map.y_pixel_um);
      c += map.at(column, row) * std::cos(t);
      s += map.at(column, row) * std::sin(t);
    }
  return 2.0 * std::hypot(c, s) / static_cast<double>(map.columns * map.rows);
}

TEST(GaussianFilter, PassesWavesAsTheStandardSays) {
  constexpr double kCutoff = 80.0;
  const double a = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  for (const double wavelength : {20.0, 40.0, 60.0, 80.0, 100.0, 160.0, 240.0})
    for (const double direction_deg : {0.0, 90.0, 36.87}) {
      const double fx = std::cos(direction_deg * std::numbers::pi / 180.0) / wavelength;
      const double fy = std::sin(direction_deg * std::numbers::pi / 180.0) / wavelength;
      HeightMap map{640, 640, 1.0, 1.0, std::vector<double>(640 * 640, 0.0)};
      testing::add_wave(map, 1.0 / std::numbers::sqrt2, fx, fy, 0.4);
      const Split split = gaussian_split(map, kCutoff);
      const double expected = std::exp(-std::numbers::pi * std::pow(a * kCutoff / wavelength, 2));
      EXPECT_NEAR(gaussian_transmission(1.0 / wavelength, kCutoff), expected, 1e-15);
      // Away from the border, the filter changes only the amplitude of a wave and not its phase, so that the maps can
      // be compared point by point.
      for (const auto& [x, y] : {std::pair{320U, 320U}, {100U, 540U}, {431U, 207U}}) {
        EXPECT_NEAR(split.waviness.at(x, y), expected * map.at(x, y), 1e-3) << wavelength << " " << direction_deg;
        EXPECT_NEAR(split.roughness.at(x, y), (1.0 - expected) * map.at(x, y), 1e-3);
      }
    }
}

TEST(GaussianFilter, PassesHalfAtItsCutoffWhateverThePixel) {
  for (const double pixel : {0.5, 2.0, 7.0}) {
    HeightMap map{800, 1, pixel, 1.0, std::vector<double>(800, 0.0)};
    testing::add_wave(map, 10.0, 1.0 / 56.0, 0.0);
    const Split split = gaussian_split(map, 56.0);
    const HeightMap before = cropped(map, 112.0, 0.0);
    const HeightMap after = cropped(split.waviness, 112.0, 0.0);
    EXPECT_NEAR(amplitude(after, 1.0 / 56.0, 0.0) / amplitude(before, 1.0 / 56.0, 0.0), 0.5, 1e-3) << pixel;
  }
}

TEST(GaussianFilter, TakesPixelsThatAreNotSquare) {
  HeightMap map{300, 500, 2.0, 0.8, std::vector<double>(300 * 500, 0.0)};
  testing::add_wave(map, 10.0, 0.0, 1.0 / 50.0, 0.2);
  testing::add_wave(map, 10.0, 1.0 / 40.0, 0.0, 0.1);
  const Split split = gaussian_split(map, 50.0);
  const HeightMap inside = cropped(split.waviness, 100.0, 100.0);
  EXPECT_NEAR(amplitude(inside, 0.0, 1.0 / 50.0), 10.0 * std::numbers::sqrt2 * 0.5, 0.02);
  EXPECT_NEAR(amplitude(inside, 1.0 / 40.0, 0.0), 10.0 * std::numbers::sqrt2 * gaussian_transmission(1.0 / 40.0, 50.0),
              0.02);
}

TEST(GaussianFilter, KeepsAConstantAtBordersAndAroundHoles) {
  HeightMap map{90, 70, 1.0, 1.0, std::vector<double>(90 * 70, 42.0)};
  for (std::size_t row = 20; row < 50; ++row)
    for (std::size_t column = 30; column < 80; ++column) map.at(column, row) = kMissing;
  map.at(55, 35) = 42.0;  // single valid point in the hole
  const Split split = gaussian_split(map, 10.0);
  for (std::size_t i = 0; i < map.heights_nm.size(); ++i) {
    EXPECT_EQ(std::isnan(split.waviness.heights_nm[i]), std::isnan(map.heights_nm[i]));
    EXPECT_EQ(std::isnan(split.roughness.heights_nm[i]), std::isnan(map.heights_nm[i]));
    if (std::isnan(map.heights_nm[i])) continue;
    EXPECT_NEAR(split.waviness.heights_nm[i], 42.0, 1e-9);
  }
}

TEST(GaussianFilter, EqualsTheDirectSumWithMissingPoints) {
  HeightMap map = testing::white_noise(40, 33, 8);
  for (std::size_t i = 0; i < map.heights_nm.size(); i += 7) map.heights_nm[i] = kMissing;
  const double cutoff = 9.0;
  const Split split = gaussian_split(map, cutoff);
  const double a2 = std::numbers::ln2 / std::numbers::pi;
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      if (std::isnan(map.at(column, row))) continue;
      double sum = 0.0;
      double weight = 0.0;
      for (std::size_t j = 0; j < map.rows; ++j)
        for (std::size_t i = 0; i < map.columns; ++i) {
          const double dx = static_cast<double>(i) - static_cast<double>(column);
          const double dy = static_cast<double>(j) - static_cast<double>(row);
          if (std::isnan(map.at(i, j))) continue;
          const double s = std::exp(-std::numbers::pi * (dx * dx + dy * dy) / (a2 * cutoff * cutoff));
          sum += s * map.at(i, j);
          weight += s;
        }
      EXPECT_NEAR(split.waviness.at(column, row), sum / weight, 1e-6);
    }
}

TEST(GaussianFilter, PartsAddUpAndAreTheSameInEveryRun) {
  const HeightMap map = testing::gaussian_surface(130, 170, 5.0, 3.0, 1);
  const Split one = gaussian_split(map, 20.0);
  const Split two = gaussian_split(map, 20.0);
  EXPECT_EQ(one.waviness.heights_nm, two.waviness.heights_nm);
  for (std::size_t i = 0; i < map.heights_nm.size(); ++i)
    EXPECT_NEAR(one.waviness.heights_nm[i] + one.roughness.heights_nm[i], map.heights_nm[i], 1e-12);
}

TEST(GaussianFilter, OfACutoffBeyondTheMapGivesAMean) {
  const HeightMap map = testing::white_noise(20, 30, 2);
  const Split split = gaussian_split(map, 1e6);
  EXPECT_LT(height_parameters(split.waviness.heights_nm).sz_nm, 1e-6);
}

}  // namespace
}  // namespace retrace::surface_models::filter_test
