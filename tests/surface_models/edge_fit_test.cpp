#include "surface_models/edge_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/support/synthetic_surface.h"

namespace retrace::surface_models::edge_fit_test {
namespace {

constexpr double kPixelUm = 0.25;
constexpr std::size_t kPoints = 801;
constexpr double kCrestUm = 103.4;

double rad(double deg) {
  return deg * std::numbers::pi / 180.0;
}

/// Returns the profile of two facets with these slopes on both sides of the crest. `top` replaces the heights of the
/// facets near the crest.
/// \param top height relative to the crest, in um, as a function of the distance x from the crest and of the height of
/// the facet there
template <class Top>
std::vector<double> profile(double left_deg, double right_deg, Top top) {
  std::vector<double> heights_nm;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double x = static_cast<double>(i) * kPixelUm - kCrestUm;
    const double facets = x < 0.0 ? x * std::tan(rad(left_deg)) : -x * std::tan(rad(right_deg));
    heights_nm.push_back(1e3 * (500.0 + top(x, facets)));
  }
  return heights_nm;
}

/// Returns the profile of symmetric facets at 45 degrees. The center of a circle of radius r is sqrt(2) r below the
/// crest.
std::vector<double> rounded(double radius_um) {
  return profile(45.0, 45.0, [&](double x, double facets) {
    if (std::abs(x) >= radius_um / std::numbers::sqrt2) return facets;
    return -std::numbers::sqrt2 * radius_um + std::sqrt(radius_um * radius_um - x * x);
  });
}

std::vector<double> chamfered(double width_um) {
  return profile(45.0, 45.0, [&](double, double facets) { return std::min(facets, -0.5 * width_um); });
}

void add_noise(std::vector<double>& heights_nm, double sq_nm) {
  const HeightMap noise = testing::white_noise(heights_nm.size(), 1, 4);
  for (std::size_t i = 0; i < heights_nm.size(); ++i) heights_nm[i] += sq_nm * noise.heights_nm[i];
}

TEST(EdgeFit, FindsTheRadius) {
  for (const double radius : {2.4, 5.96, 12.0, 28.0, 49.8}) {
    std::vector<double> heights = rounded(radius);
    add_noise(heights, 10.0);
    const EdgeFit fit = fit_edge(heights, kPixelUm);
    EXPECT_NEAR(fit.radius_um / radius, 1.0, 0.01) << radius;
    EXPECT_EQ(fit.better, EdgeShape::radius) << radius;
    EXPECT_NEAR(fit.dihedral_deg, 90.0, 0.05) << radius;
    EXPECT_NEAR(fit.radius_residual_nm, 10.0, 1.5) << radius;
  }
}

TEST(EdgeFit, FindsTheWidthOfAChamfer) {
  for (const double width : {4.0, 15.0, 40.0}) {
    std::vector<double> heights = chamfered(width);
    add_noise(heights, 20.0);
    const EdgeFit fit = fit_edge(heights, kPixelUm);
    EXPECT_NEAR(fit.chamfer_um / width, 1.0, 0.01) << width;
    EXPECT_EQ(fit.better, EdgeShape::chamfer) << width;
  }
}

TEST(EdgeFit, TakesValleysTiltedFacetsAndHoles) {
  std::vector<double> valley = rounded(20.0);
  for (double& z : valley) z = -z;
  const EdgeFit inverted = fit_edge(valley, kPixelUm);
  EXPECT_NEAR(inverted.radius_um, 20.0, 0.05);
  EXPECT_NEAR(inverted.dihedral_deg, 270.0, 0.01);

  // Facets at 50 and 10 degrees include 120 degrees, like neighbouring hexagonal pins on a tilted holder.
  const double radius = 15.0;
  const double tan_l = std::tan(rad(50.0));
  const double tan_r = std::tan(rad(10.0));
  const double xc = radius * (1.0 / std::cos(rad(50.0)) - 1.0 / std::cos(rad(10.0))) / (tan_l + tan_r);
  const double zc = xc * tan_l - radius / std::cos(rad(50.0));
  std::vector<double> tilted = profile(50.0, 10.0, [&](double x, double facets) {
    const bool is_round = x > xc - radius * std::sin(rad(50.0)) && x < xc + radius * std::sin(rad(10.0));
    return is_round ? zc + std::sqrt(radius * radius - (x - xc) * (x - xc)) : facets;
  });
  for (std::size_t i = 3; i < tilted.size(); i += 9) tilted[i] = kMissing;
  const EdgeFit fit = fit_edge(tilted, kPixelUm);
  EXPECT_NEAR(fit.radius_um, radius, 0.05);
  EXPECT_NEAR(fit.dihedral_deg, 120.0, 0.01);
  EXPECT_EQ(fit.residual_nm.size(), tilted.size());
  EXPECT_TRUE(std::isnan(fit.residual_nm[3]));
  for (std::size_t i = 0; i < tilted.size(); ++i)
    EXPECT_NEAR(std::isfinite(tilted[i]) ? fit.residual_nm[i] : 0.0, 0.0, 20.0) << i;
}

TEST(EdgeFit, OfASharpEdgeIsBelowThePixel) {
  const EdgeFit fit = fit_edge(rounded(1e-6), kPixelUm);
  EXPECT_LT(fit.radius_um, kPixelUm);
  EXPECT_LT(fit.chamfer_um, kPixelUm);
}

TEST(EdgeFit, RefusesWhatIsNoEdge) {
  EXPECT_THROW(fit_edge(std::vector<double>(100, 5.0), 1.0), std::invalid_argument);
  EXPECT_THROW(fit_edge(std::vector<double>(100, kMissing), 1.0), std::invalid_argument);
  EXPECT_THROW(fit_edge({1.0, 2.0, 3.0}, 1.0), std::invalid_argument);
  std::vector<double> hook(100, 0.0);  // the lines of the facets intersect outside of the profile
  for (std::size_t i = 0; i < 20; ++i) hook[i] = 1e5 * static_cast<double>(i);
  EXPECT_THROW(fit_edge(hook, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace retrace::surface_models::edge_fit_test
