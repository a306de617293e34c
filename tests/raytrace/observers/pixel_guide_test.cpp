// Tests of pixel points that an importance map selects: mean luminances do not change, and rare bright strips are
// sampled.
#include "raytrace/observers/pixel_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/random.h"

namespace retrace::testing::pixel_guide_test {
namespace {

using geometry::Vec2;
using raytrace::PixelGuide, raytrace::PixelProjection;

const Vec2 kPeriod(2.0, 3.0);
constexpr std::uint32_t kPasses = 4000;

/// Luminance as a function of the position on the face.
using Seen = std::function<double(const Vec2& place_mm)>;

/// Returns the luminance of a scene with one strip per period. The strip is 0.01 mm wide, parallel to y, and brighter
/// than its surroundings by `bright`.
Seen strip(double x_mm, double bright) {
  return [=](const Vec2& at) {
    const double x = at.x() - kPeriod.x() * std::floor(at.x() / kPeriod.x());
    return 1.0 + (std::abs(x - x_mm) < 0.005 ? bright : 0.0);
  };
}

/// Returns a guide for two tiles that has learnt from evenly distributed positions. The second tile has uniform
/// luminance.
PixelGuide guide_of(const Seen& seen) {
  constexpr std::size_t kPaths = 800'000;
  PixelGuide guide(kPeriod, 2, kPaths);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-50.0, 50.0);
  PixelGuide::Samples samples;
  for (std::size_t k = 0; k < kPaths; ++k) {
    const double x = place(random);
    const Vec2 at(x, place(random));
    const auto tile = static_cast<std::uint32_t>(k % 2);
    samples.push_back(guide.sample(at, tile, tile == 0 ? static_cast<float>(seen(at) - 1.0) : 0.0F));
  }
  guide.train({samples});
  return guide;
}

Vec2 place_of(const PixelProjection& pixel, const Vec2& within) {
  return pixel.corner_mm + within.x() * pixel.along_row_mm + within.y() * pixel.along_column_mm;
}

struct Mean {
  double mean = 0.0;
  double variance = 0.0;  ///< variance of the luminance that one pass gives for the pixel
  double error() const { return std::sqrt(variance / kPasses); }
};

template <class PassOf>
Mean mean_over_passes(const PassOf& pass_of) {
  Mean result;
  for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
    const double value = pass_of(pass);
    const double off = value - result.mean;
    result.mean += off / (pass + 1.0);
    result.variance += off * (value - result.mean) / (kPasses - 1.0);
  }
  return result;
}

Mean guided(const PixelGuide& guide, const PixelProjection& pixel, const Seen& seen) {
  return mean_over_passes([&](std::uint32_t pass) {
    const auto words = philox({7, 1}, pass, 0);
    double sum = 0.0;
    for (const auto& [within, weight] : guide.points(pixel, {words[0], words[1], words[2], words[3]}))
      sum += weight * seen(place_of(pixel, within));
    return sum;
  });
}

Mean even(const PixelProjection& pixel, const Seen& seen) {
  return mean_over_passes([&](std::uint32_t pass) {
    double sum = 0.0;
    for (std::uint32_t k = 0; k < PixelGuide::kPointsPerPixel; ++k) {
      const auto words = philox({7, 2}, pass, k);
      sum += seen(place_of(pixel, {unit_interval(words[0]), unit_interval(words[1])})) / PixelGuide::kPointsPerPixel;
    }
    return sum;
  });
}

/// Returns pixels of both tiles: small, large, rotated and mirrored ones, and pixels that cover several periods.
std::vector<PixelProjection> pixels() {
  return {{{0.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 0},  {{-7.3, 4.4}, {0.3, 0.2}, {0.2, -0.3}, 0},
          {{1.7, -9.0}, {-0.6, 0.1}, {0.1, 0.6}, 0}, {{12.0, 30.0}, {5.3, 0.0}, {0.0, -7.1}, 0},
          {{0.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 1},  {{-40.0, 0.0}, {0.05, 0.01}, {0.0, -0.05}, 1}};
}

TEST(PixelGuide, LeavesMeansAsTheyAre) {
  const PixelGuide guide = guide_of(strip(0.505, 100.0));
  const Seen ones = [](const Vec2&) { return 1.0; };
  const Seen waves = [](const Vec2& at) { return 2.0 + std::sin(9.0 * at.x()) * std::cos(4.0 * at.y()); };
  for (const PixelProjection& pixel : pixels())
    for (const Seen& seen : {ones, waves, strip(0.505, 100.0), strip(0.3, 5.0)}) {
      const Mean by_map = guided(guide, pixel, seen);
      // The expected mean is computed independently on a fine grid over the pixel.
      double expected = 0.0;
      constexpr int kColumns = 6000;
      constexpr int kRows = 100;
      for (int i = 0; i < kColumns; ++i)
        for (int j = 0; j < kRows; ++j)
          expected += seen(place_of(pixel, {(i + 0.5) / kColumns, (j + 0.5) / kRows})) / (1.0 * kColumns * kRows);
      EXPECT_NEAR(by_map.mean, expected, 4.5 * by_map.error() + 2e-3 * expected);
    }
}

TEST(PixelGuide, MeetsWhatIsRare) {
  const Seen seen = strip(0.505, 100.0);
  const PixelGuide guide = guide_of(seen);
  const PixelProjection pixel{{0.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 0};
  ASSERT_TRUE(guide.reduces_noise(pixel));
  const Mean by_map = guided(guide, pixel, seen);
  EXPECT_LT(5.0 * by_map.variance, even(pixel, seen).variance);
}

TEST(PixelGuide, ServesOnlyWhereItsMapIsUneven) {
  const PixelGuide guide = guide_of(strip(0.505, 100.0));
  EXPECT_TRUE(guide.reduces_noise({{4.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 0}));
  // The guide serves neither a pixel next to the strip nor a pixel of the tile with uniform luminance.
  EXPECT_FALSE(guide.reduces_noise({{0.8, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 0}));
  EXPECT_FALSE(guide.reduces_noise({{0.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 1}));
}

/// Learning from the paths that the guide itself has selected reduces the variance further.
TEST(PixelGuide, LearnsFromItsOwnPoints) {
  const Seen seen = strip(0.505, 100.0);
  PixelGuide guide = guide_of(seen);
  const PixelProjection pixel{{0.2, 0.1}, {0.5, 0.0}, {0.0, -0.5}, 0};
  const double before = guided(guide, pixel, seen).variance;
  PixelGuide::Samples samples;
  for (std::uint32_t pass = 0; pass < 20'000; ++pass) {
    const auto words = philox({7, 3}, pass, 0);
    const Vec2 shift(2.0 * std::floor(50.0 * unit_interval(philox({7, 4}, pass, 0)[0])), 0.0);
    for (const auto& [within, weight] : guide.points(pixel, {words[0], words[1], words[2], words[3]})) {
      const Vec2 at = place_of(pixel, within) + shift;
      samples.push_back(guide.sample(at, 0, static_cast<float>(seen(at) - 1.0)));
    }
  }
  guide.train({samples});
  EXPECT_LT(guided(guide, pixel, seen).variance, before);
}

}  // namespace
}  // namespace retrace::testing::pixel_guide_test
