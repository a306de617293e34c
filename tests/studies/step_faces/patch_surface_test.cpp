// Tests of surfaces that consist of polynomials on rectangles: evaluation with derivatives, choice of the face, and
// continuation beyond the border.
#include "geometry/surface/patch_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/surface/sag.h"

namespace retrace::testing::patch_surface_test {
namespace {

using namespace geometry;

/// Returns a patch with the height a + b u + c v^2 + d u^7 v^3.
HeightPatch patch_of(const Vec2& centre, const Vec2& half, double a, double b, double c, double d) {
  HeightPatch patch;
  patch.centre_mm = centre;
  patch.half_mm = half;
  const auto coefficient = [&](int i, int j) -> double& {
    return patch.coefficients[static_cast<std::size_t>(i * (kPatchDegree + 1) + j)];
  };
  coefficient(0, 0) = a;
  coefficient(1, 0) = b;
  coefficient(0, 2) = c;
  coefficient(7, 3) = d;
  return patch;
}

PatchTree single(const HeightPatch& patch) {
  PatchTree tree;
  tree.nodes.emplace_back().first = 0;
  tree.patches = {patch};
  return tree;
}

std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

TEST(PatchSurface, HasTheDerivativesOfItsPolynomial) {
  const PatchSurface surface({single(patch_of({1, 2}, {4, 3}, 0.5, 0.25, -0.125, 2.0))}, {{rectangle(-3, -1, 5, 5)}});
  const double x = 2.5;
  const double y = 3.1;
  const double u = (x - 1) / 4;
  const double v = (y - 2) / 3;
  const Jet z = surface.evaluate(Jet(x, 1.0, 0.0), Jet(y, 0.0, 1.0));
  EXPECT_NEAR(z.value, 0.5 + 0.25 * u - 0.125 * v * v + 2 * std::pow(u, 7) * std::pow(v, 3), 1e-15);
  EXPECT_NEAR(z.x, (0.25 + 14 * std::pow(u, 6) * std::pow(v, 3)) / 4, 1e-15);
  EXPECT_NEAR(z.y, (-0.25 * v + 6 * std::pow(u, 7) * v * v) / 3, 1e-15);
  EXPECT_NEAR(z.xy, 42 * std::pow(u, 6) * v * v / 12, 1e-15);
}

TEST(PatchSurface, TreeFindsThePatchOfAPoint) {
  PatchTree tree;
  tree.nodes = {{0, 1, 2, 0.0}, {-1, 0, PatchNode::kNone, 0.0}, {1, 3, 4, 0.5}, {-1, 1, PatchNode::kNone, 0.0}, {}};
  tree.patches = {patch_of({-1, 0}, {1, 1}, 1, 0, 0, 0), patch_of({1, -0.25}, {1, 0.75}, 2, 0, 0, 0)};
  const PatchSurface surface({tree}, {{rectangle(-2, -1, 2, 0.5)}});
  EXPECT_EQ(surface.evaluate(-0.5, 0.7), 1.0);
  EXPECT_EQ(surface.evaluate(0.5, 0.3), 2.0);
  EXPECT_EQ(tree.patch_at({0.5, 0.7}), nullptr);
  EXPECT_EQ(tree.patch_at({-2.5, 0.0}), nullptr);
}

TEST(PatchSurface, ContinuesAlongItsTangent) {
  const PatchSurface surface({single(patch_of({0, 0}, {1, 1}, 0, 0.5, -0.25, 0))}, {{rectangle(-1, -1, 1, 1)}});
  const jets::Gradient z = surface.evaluate(jets::Gradient(0.0, 1.0, 0.0), jets::Gradient(3.0, 0.0, 1.0));
  EXPECT_NEAR(z.value, -0.25 - 0.5 * 2.0, 1e-15);
  EXPECT_NEAR(z.x, 0.5, 1e-15);
  EXPECT_NEAR(z.y, -0.5, 1e-15);
}

// Two planes meet along the slanted line x = y / 4, and the patches of both reach beyond it.
TEST(PatchSurface, BorderChoosesTheFace) {
  const std::vector<Vec2> left = {{-2, -2}, {-0.5, -2}, {0.5, 2}, {-2, 2}};
  const std::vector<Vec2> right = {{-0.5, -2}, {2, -2}, {2, 2}, {0.5, 2}};
  const PatchSurface surface(
      {single(patch_of({0, 0}, {2, 2}, 1, 0, 0, 0)), single(patch_of({0, 0}, {2, 2}, 2, 0, 0, 0))}, {{left}, {right}});
  for (const double y : {-1.9, -1.0, 0.0, 0.3, 1.9}) {
    EXPECT_EQ(surface.evaluate(y / 4 - 1e-9, y), 1.0);
    EXPECT_EQ(surface.evaluate(y / 4 + 1e-9, y), 2.0);
  }
  EXPECT_TRUE(surface.covers({0, 0}, 0.0));
  EXPECT_TRUE(surface.covers({2.005, 0}, 0.01));
  EXPECT_FALSE(surface.covers({2.02, 0}, 0.01));
}

TEST(PatchSurface, GapBelongsToTheNearerFace) {
  const PatchSurface surface(
      {single(patch_of({0, 0}, {2, 2}, 1, 0, 0, 0)), single(patch_of({0, 0}, {2, 2}, 2, 0, 0, 0))},
      {{rectangle(-2, -2, -0.1, 2)}, {rectangle(0.1, -2, 2, 2)}});
  EXPECT_EQ(surface.evaluate(-0.01, 0.5), 1.0);
  EXPECT_EQ(surface.evaluate(0.01, 0.5), 2.0);
}

}  // namespace
}  // namespace retrace::testing::patch_surface_test
