// Tests of the number of paths that a camera traces through each pixel (PixelPoints).
#include "raytrace/observers/pixel_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace retrace::testing::pixel_points_test {
namespace {

using namespace raytrace;

constexpr std::size_t kColumns = 40;
constexpr std::size_t kRows = 30;
constexpr std::uint32_t kSamples = 8;
constexpr std::uint32_t kMinPoints = 4;

/// Returns the moments of a pixel. Half of its samples have the luminance 0, and the other half has the given
/// luminance.
PixelMoments flickering(double luminance) {
  PixelMoments moments;
  for (std::uint32_t k = 0; k < kSamples; ++k) moments.add(k % 2 == 0 ? 0.0 : luminance);
  return moments;
}

PixelMoments constant(double luminance) {
  PixelMoments moments;
  for (std::uint32_t k = 0; k < kSamples; ++k) moments.add(luminance);
  return moments;
}

TEST(PixelPoints, AreEqualIfAllPixelsHaveTheSameNoise) {
  for (const PixelMoments& moments : {flickering(3.0), constant(5.0), constant(0.0)}) {
    const PixelPoints points(std::vector<PixelMoments>(kColumns * kRows, moments), kSamples, kColumns, kMinPoints);
    for (std::size_t k = 0; k < kColumns * kRows; ++k) EXPECT_EQ(points[k], kMinPoints);
    EXPECT_EQ(points.total(), kMinPoints * kColumns * kRows);
  }
}

/// Noisy pixels and the two pixels around them have more points than all others. Every number is the minimum times a
/// power of two. The sum of the numbers is about 2.7 times the sum for equal numbers, within the rounding to powers of
/// two.
TEST(PixelPoints, AreConcentratedOnNoisyPixels) {
  std::vector<PixelMoments> moments(kColumns * kRows, constant(7.0));
  for (std::size_t row = 10; row < 18; ++row)
    for (std::size_t column = 20; column < 28; ++column) moments[row * kColumns + column] = flickering(100.0);
  const PixelPoints points(moments, kSamples, kColumns, kMinPoints);
  std::uint64_t sum = 0;
  for (std::size_t row = 0; row < kRows; ++row)
    for (std::size_t column = 0; column < kColumns; ++column) {
      const std::uint32_t number = points[row * kColumns + column];
      sum += number;
      EXPECT_EQ(number % kMinPoints, 0U);
      EXPECT_TRUE(std::has_single_bit(number / kMinPoints)) << number;
      const bool is_near = row >= 8 && row < 20 && column >= 18 && column < 30;
      if (is_near)
        EXPECT_GT(number, kMinPoints) << row << ' ' << column;
      else
        EXPECT_EQ(number, kMinPoints) << row << ' ' << column;
    }
  EXPECT_EQ(points.total(), sum);
  const double ratio = static_cast<double>(sum) / (kMinPoints * kColumns * kRows);
  EXPECT_GT(ratio, 1.0 + 1.7 / std::numbers::sqrt2);
  EXPECT_LT(ratio, 1.0 + 1.7 * std::numbers::sqrt2);
}

/// The picture contains noisy areas with two different standard deviations. The numbers of points must be proportional
/// to the 2/3 power of the standard deviations. The tolerance allows for the rounding to powers of two.
TEST(PixelPoints, IncreaseWithTheStandardDeviation) {
  std::vector<PixelMoments> moments(kColumns * kRows, constant(0.0));
  for (std::size_t row = 5; row < 15; ++row)
    for (std::size_t column = 0; column < 10; ++column) {
      moments[row * kColumns + column] = flickering(10.0);
      moments[row * kColumns + column + 25] = flickering(40.0);
    }
  const PixelPoints points(moments, kSamples, kColumns, kMinPoints);
  const std::uint32_t weak = points[10 * kColumns + 5];
  const std::uint32_t strong = points[10 * kColumns + 30];
  const double expected = std::pow(4.0, 2.0 / 3.0);
  EXPECT_GE(strong, expected / 2.0 * weak);
  EXPECT_LE(strong, expected * 2.0 * weak);
}

/// A single bright pixel does not receive an unlimited number of points.
TEST(PixelPoints, AreLimited) {
  std::vector<PixelMoments> moments(kColumns * kRows, constant(0.0));
  moments[500] = flickering(1e9);
  const PixelPoints points(moments, kSamples, kColumns, kMinPoints);
  std::uint32_t max = 0;
  for (std::size_t k = 0; k < moments.size(); ++k) max = std::max(max, points[k]);
  EXPECT_EQ(max, 64 * kMinPoints);
}

}  // namespace
}  // namespace retrace::testing::pixel_points_test
