#include "fabrication/turning/tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fabrication/turning/finish.h"

// Tests of clearance, skew and finish. The results are compared with closed forms (docs/theory/turning.md) and with the
// values of Sohn and Naples.

namespace retrace::fabrication::turning::tool_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TurningTool sharp_tool(double clearance_deg, double skew_deg) {
  return {.window_deg = 179.0, .clearance_deg = clearance_deg, .skew_deg = skew_deg};
}

/// Returns slopes of a convex circular cylinder along y. Its slope at the rim of a round part is `edge_deg`.
std::vector<SlopeSample> cylinder(double edge_deg) {
  std::vector<SlopeSample> samples;
  for (int i = 0; i <= 40; ++i)
    for (int k = 0; k < 1440; ++k) {
      const double r = std::sin(edge_deg * kDegree) * i / 40.0;
      const double theta = k * 0.25 * kDegree;
      const double x = r * std::cos(theta);
      const double slope = -x / std::sqrt(1.0 - x * x);
      // The direction along the cut is the direction of increasing theta.
      samples.push_back({{x, r * std::sin(theta)}, slope * std::cos(theta), -slope * std::sin(theta)});
    }
  return samples;
}

TEST(TurningTool, SinRule) {
  const double skews[] = {30.0, 45.0, 60.0};
  const double of_12[] = {13.89, 17.10, 24.57};
  const double of_20[] = {23.26, 28.93, 43.16};
  for (int i = 0; i < 3; ++i) {
    const Angle skew = Angle::from_deg(skews[i]);
    EXPECT_NEAR(clearance_along_cut(Angle::from_deg(12.0), skew).deg(), of_12[i], 0.005);
    EXPECT_NEAR(clearance_along_cut(Angle::from_deg(20.0), skew).deg(), of_20[i], 0.005);
  }
}

TEST(TurningTool, VectorTestGivesTheSinRuleWithoutRadialSlope) {
  for (const double skew : {-60.0, -20.0, 0.0, 35.0, 60.0}) {
    const TurningTool tool = sharp_tool(12.0, skew);
    const double fall = clearance_along_cut(Angle::from_deg(12.0), Angle::from_deg(skew)).rad();
    const geometry::Vec3 normal(0.0, std::sin(fall), std::cos(fall));
    EXPECT_NEAR(contact_of(tool_frame(tool), normal).clearance_needed_deg, 12.0, 1e-10);
  }
}

TEST(TurningTool, VectorTestIsWhereTheFlankLeavesTheSurface) {
  TurningTool tool = sharp_tool(15.0, 25.0);
  tool.rake_deg = -10.0;
  const ToolFrame frame = tool_frame(tool);
  EXPECT_NEAR(frame.up.dot(frame.across), 0.0, 1e-15);
  EXPECT_NEAR(frame.up.dot(frame.rake_normal), 0.0, 1e-15);
  for (int i = 0; i < 200; ++i) {
    const geometry::Vec3 n =
        geometry::Vec3(std::sin(0.7 * i), std::cos(1.3 * i), 1.0 + std::sin(2.9 * i) * 0.4).normalized();
    const geometry::Vec3 m = (n - n.dot(frame.rake_normal) * frame.rake_normal).normalized();
    const double a = 15.0 * kDegree;
    const bool stays_above = (-std::cos(a) * frame.rake_normal + std::sin(a) * m).dot(n) >= 0.0;
    EXPECT_EQ(contact_of(frame, n).clearance_needed_deg <= 15.0, stays_above) << i;
  }
}

TEST(TurningTool, CylinderLensNeedsTheSkewOfTheRightSign) {
  const std::vector<SlopeSample> lens = cylinder(50.0);
  EXPECT_NEAR(clearance_figures(sharp_tool(12.0, 0.0), lens).clearance_needed_deg, 22.52, 0.01);
  EXPECT_NEAR(clearance_figures(sharp_tool(12.0, -30.0), lens).clearance_needed_deg, 11.04, 0.01);
  EXPECT_NEAR(clearance_figures(sharp_tool(12.0, 30.0), lens).clearance_needed_deg, 35.07, 0.01);
  EXPECT_FALSE(clearance_figures(sharp_tool(12.0, 0.0), lens).clears(sharp_tool(12.0, 0.0)));
  EXPECT_TRUE(clearance_figures(sharp_tool(12.0, -30.0), lens).clears(sharp_tool(12.0, -30.0)));
}

TEST(TurningTool, LeastSkewOfTheCylinderLens) {
  // The required skew follows from sin 50 (1 - sin skew) / 2 = sin 12.
  const double exact = std::asin(1.0 - 2.0 * std::sin(12.0 * kDegree) / std::sin(50.0 * kDegree)) / kDegree;
  const auto skew = min_skew_deg(sharp_tool(12.0, 0.0), cylinder(50.0), 60.0);
  ASSERT_TRUE(skew.has_value());
  EXPECT_NEAR(*skew, -exact, 0.02);
  EXPECT_EQ(min_skew_deg(sharp_tool(25.0, 0.0), cylinder(50.0), 60.0), 0.0);
  EXPECT_FALSE(min_skew_deg(sharp_tool(0.5, 0.0), cylinder(80.0), 60.0).has_value());
}

TEST(TurningTool, WindowIsTheRadialSlope) {
  TurningTool tool = sharp_tool(12.0, 0.0);
  tool.window_deg = 60.0;
  const double steep = std::tan(30.1 * kDegree);
  EXPECT_NEAR(clearance_figures(tool, {{{1.0, 0.0}, steep, 0.0}}).window_needed_deg, 60.2, 1e-9);
  EXPECT_FALSE(clearance_figures(tool, {{{1.0, 0.0}, steep, 0.0}}).clears(tool));
}

TEST(TurningTool, WarnsOutsideOfWhatWasTried) {
  TurningTool tool;
  tool.rake_deg = -45.0;
  tool.skew_deg = 60.0;
  EXPECT_TRUE(tool_warnings(tool).empty());
  tool.rake_deg = 18.1;
  tool.skew_deg = -60.1;
  EXPECT_EQ(tool_warnings(tool).size(), 2U);
  tool.rake_deg = -45.1;
  EXPECT_EQ(tool_warnings(tool).size(), 2U);
}

TEST(TurningFinish, FiguresOfTheExperiment) {
  const FinishFigures f = finish_figures(0.25, 1e-3);
  EXPECT_NEAR(f.rq_nm, 0.149, 5e-4);
  EXPECT_NEAR(f.rq_of_paper_nm, 0.167, 5e-4);
  EXPECT_NEAR(f.peak_to_valley_nm, 0.5, 1e-12);
  EXPECT_NEAR(f.ra_nm, 1.0 / (31.18 * 0.25), 1e-4);
}

TEST(TurningFinish, EffectiveRadius) {
  TurningTool tool;
  tool.nose_radius_mm = 0.25;
  tool.skew_deg = 60.0;
  EXPECT_NEAR(effective_radius_mm(tool), 0.0625, 1e-15);
  tool.skew_deg = 0.0;
  tool.rake_deg = -60.0;
  EXPECT_NEAR(effective_radius_mm(tool), 0.5, 1e-15);
}

TEST(TurningFinish, ExactFiguresAgreeWithAFineProfile) {
  TurningTool tool;
  tool.nose_radius_mm = 0.05;
  tool.skew_deg = 40.0;
  tool.rake_deg = -20.0;
  const double feed = 0.04;
  const double a = 0.05 * std::cos(20.0 * kDegree);
  const double b = 0.05 * std::cos(40.0 * kDegree);
  const int n = 200000;
  std::vector<double> z(n);
  double mean = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = feed * ((i + 0.5) / n - 0.5);
    z[static_cast<std::size_t>(i)] = 1e6 * a * (1.0 - std::sqrt(1.0 - x * x / (b * b)));
    mean += z[static_cast<std::size_t>(i)] / n;
  }
  double ra = 0.0;
  double rq = 0.0;
  for (const double h : z) {
    ra += std::abs(h - mean) / n;
    rq += (h - mean) * (h - mean) / n;
  }
  const FinishFigures f = exact_finish(tool, feed);
  EXPECT_NEAR(f.ra_nm, ra, 1e-6 * ra);
  EXPECT_NEAR(f.rq_nm, std::sqrt(rq), 1e-6 * f.rq_nm);
  EXPECT_NEAR(f.peak_to_valley_nm, 1e6 * a * (1.0 - std::sqrt(1.0 - feed * feed / (4.0 * b * b))), 1e-8);
}

TEST(TurningFinish, ExactFiguresTendToTheClosedForms) {
  TurningTool tool;
  tool.nose_radius_mm = 0.25;
  tool.skew_deg = 30.0;
  tool.rake_deg = 10.0;
  const FinishFigures exact = exact_finish(tool, 1e-3);
  const FinishFigures closed = finish_figures(effective_radius_mm(tool), 1e-3);
  EXPECT_NEAR(exact.peak_to_valley_nm / closed.peak_to_valley_nm, 1.0, 1e-5);
  EXPECT_NEAR(exact.ra_nm / closed.ra_nm, 1.0, 1e-5);
  EXPECT_NEAR(exact.rq_nm / closed.rq_nm, 1.0, 1e-5);
}

TEST(TurningFinish, CuspsOnACurveAreThoseOfCircles) {
  // Circles of radius r around points of the circle of radius R + r intersect at this distance from its centre.
  const double r = 0.2;
  const double feed = 0.01;
  for (const double R : {2.0, 0.5}) {
    const double half = 0.5 * feed / (R + r);
    const double outer = (R + r) * std::cos(half) - std::sqrt(r * r - std::pow((R + r) * std::sin(half), 2)) - R;
    EXPECT_NEAR(finish_figures(r, feed, -1.0 / R).peak_to_valley_nm, 1e6 * outer, 1e-3 * 1e6 * outer);
    const double inside = 0.5 * feed / (R - r);
    const double hollow = R - (R - r) * std::cos(inside) - std::sqrt(r * r - std::pow((R - r) * std::sin(inside), 2));
    EXPECT_NEAR(finish_figures(r, feed, 1.0 / R).peak_to_valley_nm, 1e6 * hollow, 1e-3 * 1e6 * hollow);
  }
}

TEST(TurningFinish, FeedForAScallop) {
  const double feed = feed_for_scallop_mm(0.2, 10.0);
  EXPECT_NEAR(finish_figures(0.2, feed).peak_to_valley_nm, 10.0, 1e-12);
}

}  // namespace
}  // namespace retrace::fabrication::turning::tool_test
