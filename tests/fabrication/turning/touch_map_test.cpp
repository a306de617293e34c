#include "fabrication/turning/plan/single_contact_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fabrication/turning/plan/path.h"
#include "geometry/surface/concavity_bound.h"
#include "tests/fabrication/turning/paths.h"

// Tests of proven bounds on the curvature of a surface, which are compared with samples. Paths that use these bounds
// are compared with paths that search the whole arc at every point.

namespace retrace::fabrication::turning::touch_map_test {
namespace {

using namespace geometry;
using namespace jets;

using geometry::Vec2;
constexpr double kTurn = 2.0 * std::numbers::pi;
const InputLocation kHere{"part.toml", 3, "path"};

TurningTool nose(double radius_mm) {
  TurningTool tool;
  tool.nose_radius_mm = radius_mm;
  return tool;
}

Sag sphere(double curvature_per_mm) {
  Sag sag;
  sag.asphere.curvature_per_mm = curvature_per_mm;
  return sag;
}

/// Returns the largest second derivative in any direction. It is computed from the second derivatives in three
/// directions.
double concavity_bound(const std::function<Jet2(const Jet2&, const Jet2&)>& z, const Vec2& p) {
  const auto along = [&](double c, double s) { return 2.0 * z(Jet2(p.x(), c, 0.0), Jet2(p.y(), s, 0.0))[2]; };
  const double xx = along(1.0, 0.0);
  const double yy = along(0.0, 1.0);
  const double xy = 0.5 * (along(1.0, 1.0) - xx - yy);
  return 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
}

/// Parameters of a lenslet.
struct Kind {
  double curvature_per_mm = -0.8;
  double height_mm = 5e-3;
  int blend_order = 2;
  bool tilted = true;
  bool round = true;
  double base_curvature_per_mm = -0.02;
};

Lenslet lenslet_at(const Kind& kind, const Vec2& at) {
  const FreeformSurface bare(sphere(kind.base_curvature_per_mm), std::nullopt, {}, kHere);
  Lenslet lenslet;
  lenslet.sag.asphere = {kind.curvature_per_mm, -0.5, {1e-3}};
  lenslet.blend_order = kind.blend_order;
  place_on_base(lenslet, bare, at.x(), at.y(), kind.height_mm, kind.tilted, kHere);
  if (kind.round) {
    lenslet.inner = circle_boundary(at, 0.11);
    lenslet.outer = circle_boundary(at, 0.14);
    return lenslet;
  }
  const auto wavy = [](double radius) {
    return [radius](double angle) { return radius * (1.0 + 0.02 * std::cos(3.0 * angle)); };
  };
  lenslet.inner = boundary_from_radius(at, wavy(0.11), {4, 40}, kHere);
  lenslet.outer = boundary_from_radius(at, wavy(0.14), {4, 40}, kHere);
  return lenslet;
}

FreeformSurface array_of(const Kind& kind, int side = 4) {
  std::vector<Lenslet> lenslets;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k)
      lenslets.push_back(lenslet_at(kind, {0.3 * (i - 0.5 * (side - 1)), 0.3 * (k - 0.5 * (side - 1))}));
  return {sphere(kind.base_curvature_per_mm), std::nullopt, lenslets, kHere};
}

const Kind kKinds[] = {{},
                       {-0.8, 5e-3, 1},
                       {-0.8, 5e-3, 3},
                       {-0.8, 5e-3, 4},
                       {-0.8, 5e-3, 2, false},
                       {-0.8, 5e-3, 2, true, false},
                       {-0.8, 5e-3, 3, true, true, -0.3},
                       {0.9, -4e-3, 2},
                       {0.9, -4e-3, 2, true, true, 0.25}};

/// Returns the maximum sampled concavity of the inside of a lenslet and of its blend.
std::pair<double, double> sampled(const FreeformSurface& surface, const Lenslet& lenslet) {
  const auto z = [&](const Jet2& x, const Jet2& y) { return surface.evaluate(x, y); };
  double inside = -1e300;
  double blend = -1e300;
  constexpr int kAngles = 60;
  constexpr int kRadii = 40;
  for (int i = 0; i < kAngles; ++i)
    for (int k = 0; k < kRadii; ++k) {
      const double angle = kTurn * (i + 0.17) / kAngles;
      const Vec2 outward(std::cos(angle), std::sin(angle));
      const double r = lenslet.inner.radius_mm.evaluate(angle);
      const double R = lenslet.outer.radius_mm.evaluate(angle);
      const double share = (k + 0.5) / kRadii;
      inside = std::max(inside, concavity_bound(z, lenslet.inner.centre_mm + r * share * outward));
      blend = std::max(blend, concavity_bound(z, lenslet.inner.centre_mm + (r + share * (R - r)) * outward));
    }
  return {inside, blend};
}

TEST(Hollowness, WhatIsProvedHoldsAndIsNotFarFromTheTruth) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(&kind - kKinds);
    for (const Vec2& at : {Vec2(0.0, 0.0), Vec2(0.9, -0.6)}) {
      const Lenslet lenslet = lenslet_at(kind, at);
      const Sag base = sphere(kind.base_curvature_per_mm);
      const FreeformSurface surface(base, std::nullopt, {lenslet}, kHere);
      const auto [inside, blend] = sampled(surface, lenslet);
      EXPECT_FALSE(is_blend_concavity_bounded(lenslet, base, 0.999 * blend));
      EXPECT_TRUE(is_blend_concavity_bounded(lenslet, base, 1.6 * blend)) << blend;
      EXPECT_TRUE(is_concavity_bounded(lenslet, std::max(0.1, 1.5 * inside))) << inside;
      if (inside > 0.0) {
        EXPECT_FALSE(is_concavity_bounded(lenslet, 0.999 * inside));
      }
    }
  }
}

TEST(Hollowness, OfABaseFailsWhereItIsHollowAndOnlyThere) {
  Sag sag;
  sag.polynomial = XyPolynomial{1.0, 4, std::vector<double>(XyPolynomial::count(4), 0.0)};
  sag.polynomial->coefficients[sag.polynomial->index(4, 0)] = 0.5;  // z'' = 6 x^2
  std::vector<PlanBox> failed;
  bound_concavity(
      sag, {{-2.0, -2.0}, {2.0, 2.0}}, 6.0, [](const PlanBox&) { return true; },
      [&](const PlanBox& box) { failed.push_back(box); });
  ASSERT_FALSE(failed.empty());
  const auto is_failed = [&](const Vec2& p) {
    for (const PlanBox& box : failed)
      if ((p - box.low_mm).minCoeff() >= 0.0 && (box.high_mm - p).minCoeff() >= 0.0) return true;
    return false;
  };
  for (double y = -1.9; y < 2.0; y += 0.3) {
    for (const double x : {-1.95, -1.3, -1.001, 1.001, 1.5}) EXPECT_TRUE(is_failed({x, y})) << x;
    for (const double x : {-0.85, -0.4, 0.0, 0.3, 0.85}) EXPECT_FALSE(is_failed({x, y})) << x;
  }
}

TEST(Hollowness, OfAFormulaIsNotProved) {
  Sag sag;
  sag.formula = parse_formula("0*x", sag_variables(), kHere);
  int failed = 0;
  bound_concavity(
      sag, {{-1.0, -1.0}, {1.0, 1.0}}, 1e9, [](const PlanBox&) { return true; }, [&](const PlanBox&) { ++failed; });
  EXPECT_EQ(failed, 1);
  Lenslet lenslet = lenslet_at({}, {0.0, 0.0});
  lenslet.sag.formula = sag.formula;
  EXPECT_FALSE(is_concavity_bounded(lenslet, 1e9));
  EXPECT_FALSE(is_blend_concavity_bounded(lenslet, sphere(-0.02), 1e9));
}

PathOptions spiral() {
  return spiral_of(0.6, 0.02, 400);
}

/// Returns the largest difference between the heights of a path and the heights that a search of the whole arc gives at
/// every point.
/// \param once receives the number of points without a search
/// \param searched receives the number of points with a search
double largest_difference(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& o, int& once,
                          int& searched) {
  const NoseCompensation slow(surface, tool);
  const SingleContactMap map(surface, tool, o.radius_mm);
  double most = 0.0;
  double angle = 0.0;
  const std::vector<Pass> passes = make_path(surface, tool, o, kHere);
  for (const PathPoint& p : passes.front()) {
    const double c = p.c_deg * kTurn / 360.0;
    const Vec2 across(std::cos(c), -std::sin(c));
    const Vec2 cut(-std::sin(c), -std::cos(c));
    const Vec2 tip = p.x_mm * across - p.y_mm * cut;
    most = std::max(most, std::abs(p.z_mm - slow.height_mm(tip.x(), tip.y(), across, cut, angle)));
    ++(map.has_single_contact(tip.x(), tip.y()) ? once : searched);
  }
  return most;
}

TEST(SingleContactMap, QuickPathsAreThoseOfTheSearch) {
  for (const Kind& kind : kKinds)
    for (const double skew : {0.0, 20.0}) {
      SCOPED_TRACE(&kind - kKinds);
      TurningTool tool = nose(0.01);
      tool.skew_deg = skew;
      int once = 0;
      int searched = 0;
      EXPECT_LT(largest_difference(array_of(kind), tool, spiral(), once, searched), 1e-12);
      EXPECT_GT(once, 11000);
      EXPECT_EQ(searched, 0) << "nothing but what is proved is compared here";
    }
}

TEST(SingleContactMap, SearchesRoundWhatIsHollowerThanTheNose) {
  // One of four lenslets has a blend that is too concave for the nose.
  std::vector<Lenslet> lenslets;
  for (const double x : {-0.25, 0.25})
    for (const double y : {-0.25, 0.25}) lenslets.push_back(lenslet_at({}, {x, y}));
  lenslets.front() = lenslet_at({-0.8, 20e-3, 2}, {-0.25, -0.25});
  const FreeformSurface surface(sphere(-0.02), std::nullopt, lenslets, kHere);
  const TurningTool tool = nose(0.03);
  int once = 0;
  int searched = 0;
  EXPECT_LT(largest_difference(surface, tool, spiral(), once, searched), 1e-12);
  EXPECT_GT(once, 8000);
  EXPECT_GT(searched, 500);
  const SingleContactMap map(surface, tool, 0.6);
  EXPECT_FALSE(map.has_single_contact(-0.25, -0.25));
  EXPECT_FALSE(map.has_single_contact(-0.25 - 0.14 - 0.02, -0.25)) << "the edge reaches into it";
  EXPECT_TRUE(map.has_single_contact(0.25, 0.25));
  EXPECT_FALSE(map.has_single_contact(5.0, 0.0)) << "outside of what was looked at";
}

TEST(SingleContactMap, KnowsNothingBeyondABoundaryAndOfToolsWithRake) {
  const FreeformSurface surface(sphere(-0.1), Extrapolation{circle_boundary({0.1, 0.0}, 0.4), 2}, {}, kHere);
  const SingleContactMap map(surface, nose(0.02), 0.6);
  EXPECT_TRUE(map.has_single_contact(0.1, 0.3));
  EXPECT_FALSE(map.has_single_contact(0.1, 0.39)) << "the edge reaches beyond";
  EXPECT_FALSE(map.has_single_contact(-0.4, 0.0));
  TurningTool leaning = nose(0.02);
  leaning.rake_deg = -5.0;
  EXPECT_FALSE(SingleContactMap(surface, leaning, 0.6).has_single_contact(0.1, 0.0));
  EXPECT_FALSE(SingleContactMap().has_single_contact(0.0, 0.0));
}

}  // namespace
}  // namespace retrace::fabrication::turning::touch_map_test
