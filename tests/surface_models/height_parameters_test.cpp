#include "surface_models/height_parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surface_models/form.h"
#include "tests/support/synthetic_surface.h"

namespace retrace::surface_models::height_parameters_test {
namespace {

TEST(HeightParameters, OfFewHeightsAreThoseByHand) {
  const std::vector<double> heights = {1.0, kMissing, 3.0, 5.0, 11.0};  // mean 5: -4, -2, 0, 6
  const HeightParameters p = height_parameters(heights);
  EXPECT_DOUBLE_EQ(p.sa_nm, 3.0);
  EXPECT_DOUBLE_EQ(p.sq_nm, std::sqrt(14.0));
  EXPECT_DOUBLE_EQ(p.sz_nm, 10.0);
  EXPECT_DOUBLE_EQ(p.ssk, 36.0 / std::pow(14.0, 1.5));
  EXPECT_DOUBLE_EQ(p.sku, 392.0 / 196.0);
}

TEST(HeightParameters, OfAGaussianSurfaceAreTheKnownOnes) {
  const HeightMap map = testing::white_noise(1024, 1024, 5);
  const HeightParameters p = height_parameters(map.heights_nm);
  EXPECT_NEAR(p.sq_nm, 1.0, 0.003);
  EXPECT_NEAR(p.sa_nm, std::sqrt(2.0 / std::numbers::pi), 0.003);
  // The standard errors of Ssk and Sku are sqrt(6 / n) and sqrt(24 / n).
  EXPECT_NEAR(p.ssk, 0.0, 4.0 * std::sqrt(6.0) / 1024.0);
  EXPECT_NEAR(p.sku, 3.0, 4.0 * std::sqrt(24.0) / 1024.0);
}

TEST(HeightParameters, OfASineAndOfAConstant) {
  HeightMap map{1000, 1, 1.0, 1.0, std::vector<double>(1000, 0.0)};
  testing::add_wave(map, 2.0, 0.01, 0.0, 0.3);
  const HeightParameters sine = height_parameters(map.heights_nm);
  EXPECT_NEAR(sine.sq_nm, 2.0, 1e-12);
  EXPECT_NEAR(sine.sa_nm, 2.0 * std::numbers::sqrt2 * 2.0 / std::numbers::pi, 2e-3);
  EXPECT_NEAR(sine.ssk, 0.0, 1e-9);
  EXPECT_NEAR(sine.sku, 1.5, 1e-9);
  const HeightParameters flat = height_parameters(std::vector<double>(7, 123.4));
  EXPECT_EQ(flat.sz_nm, 0.0);
  EXPECT_EQ(flat.ssk, 0.0);
  EXPECT_EQ(flat.sku, 0.0);
}

TEST(Summary, OfValuesWithGaps) {
  const Summary s = summarise(std::vector<double>{4.0, kMissing, 1.0, 2.0, 9.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 4.0);
  EXPECT_DOUBLE_EQ(s.standard_deviation, std::sqrt((0.0 + 9.0 + 4.0 + 25.0) / 3.0));
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_EQ(summarise({}).count, 0U);
}

TEST(HeightMap, TurnedByAQuarter) {
  const HeightMap map{3, 2, 0.5, 2.0, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
  const HeightMap turned = rotated_by_90_degrees(map);
  EXPECT_EQ(turned.columns, 2U);
  EXPECT_EQ(turned.rows, 3U);
  EXPECT_EQ(turned.x_pixel_um, 2.0);
  EXPECT_EQ(turned.y_pixel_um, 0.5);
  // The map is rotated, not mirrored. Heights that increased along y (1 to 4) increase along x. Heights that increased
  // along x (1 to 3) decrease along y.
  EXPECT_EQ(turned.heights_nm, (std::vector<double>{3.0, 6.0, 2.0, 5.0, 1.0, 4.0}));
}

TEST(Form, IsRemovedWhateverIsMissing) {
  for (const int degree : {1, 2, 5}) {
    HeightMap map{83, 61, 0.5, 0.7, std::vector<double>(83 * 61)};
    for (std::size_t row = 0; row < map.rows; ++row)
      for (std::size_t column = 0; column < map.columns; ++column) {
        const double x = static_cast<double>(column) / 83.0;
        const double y = static_cast<double>(row) / 61.0;
        map.at(column, row) = 1e4 + 3e3 * x - 2e3 * y + (degree > 1 ? 500.0 * x * y - 700.0 * y * y : 0.0) +
                              (degree > 4 ? 90.0 * std::pow(x, 3) * y * y : 0.0);
        if ((7 * column + 3 * row) % 11 == 0 || (column > 60 && row < 20)) map.at(column, row) = kMissing;
      }
    const HeightMap residual = without_form(map, degree);
    EXPECT_EQ(measured_points(residual), measured_points(map));
    EXPECT_LT(height_parameters(residual.heights_nm).sz_nm, 1e-7) << degree;
  }
}

TEST(Form, OfAPlaneKeepsWhatIsNoPlane) {
  HeightMap map = testing::gaussian_surface(200, 150, 10.0, 4.0, 3);
  const double sq = height_parameters(without_form(map, 1).heights_nm).sq_nm;
  testing::add_plane(map, 1e5, 4e4, -3e4);
  EXPECT_NEAR(height_parameters(without_form(map, 1).heights_nm).sq_nm, sq, 1e-8);
}

TEST(Form, OfTooFewPointsIsTheSmallestThatFits) {
  HeightMap map{4, 4, 1.0, 1.0, std::vector<double>(16, kMissing)};
  map.at(1, 2) = 5.0;
  map.at(3, 0) = 7.0;
  const HeightMap residual = without_form(map, 3);
  EXPECT_NEAR(residual.at(1, 2), 0.0, 1e-9);
  EXPECT_NEAR(residual.at(3, 0), 0.0, 1e-9);
}

}  // namespace
}  // namespace retrace::surface_models::height_parameters_test
