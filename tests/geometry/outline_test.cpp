#include "geometry/outline/outline.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/outline/convex_decomposition.h"
#include "geometry/outline/plan_region.h"
#include "tests/geometry/outline_random.h"

namespace retrace::geometry {
namespace outline_test {

constexpr double kPi = std::numbers::pi;

double sum_of_areas(const std::vector<Polygon>& polygons) {
  double sum = 0.0;
  for (const Polygon& polygon : polygons) sum += area(polygon);
  return sum;
}

double area_of(const std::vector<PolygonLoop>& borders) {
  double sum = 0.0;
  for (const PolygonLoop& border : borders) sum += area(border);
  return sum;
}

PlanRegion plan_of(const Outline& outline, double margin_mm = 0.0, double tolerance_mm = 0.01) {
  std::optional<OutlineFault> fault;
  PlanRegion plan = plan_region(outline, margin_mm, tolerance_mm, fault);
  EXPECT_FALSE(fault) << fault->text;
  return plan;
}

OutlineLoop rectangle(double x_mm, double y_mm) {
  return polygon_of_corners({{0, 0}, {x_mm, 0}, {x_mm, y_mm}, {0, y_mm}});
}

bool is_refused(const std::vector<OutlineLoop>& loops) {
  std::optional<OutlineFault> fault;
  plan_region(oriented(loops), 0.0, 0.01, fault);
  return fault.has_value();
}

/// Maximum distance of the corners and side midpoints of a polygon from a circle about the origin.
double deviation_from_circle(double radius_mm, const PolygonLoop& polygon) {
  double most = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    for (const double at : {0.0, 0.5}) {
      const Vec2 p = polygon[k] + at * (polygon[(k + 1) % polygon.size()] - polygon[k]);
      most = std::max(most, std::abs(p.norm() - radius_mm));
    }
  return most;
}

TEST(Outline, AreasAgreeWithClosedForms) {
  EXPECT_NEAR(oriented({circle({3, -2}, 7)}).area_mm2(), kPi * 49.0, 1e-12);
  EXPECT_NEAR(oriented({rounded(rectangle(62, 34), 3)}).area_mm2(), 62 * 34 - (4 - kPi) * 9, 1e-11);
  EXPECT_NEAR(oriented({rectangle(10, 8), circle({4, 4}, 1.5)}).area_mm2(), 80 - kPi * 2.25, 1e-12);
  // A parallelogram with an angle of 60 degrees: each corner of angle a loses r^2 (cot(a / 2) - (pi - a) / 2).
  const double height = 10.0 * std::sqrt(3.0);
  const OutlineLoop oblique = polygon_of_corners({{0, 0}, {40, 0}, {50, height}, {10, height}});
  const auto lost = [](double deg, double r) {
    const double a = deg * kPi / 180.0;
    return r * r * (1.0 / std::tan(a / 2) - (kPi - a) / 2);
  };
  EXPECT_NEAR(oriented({rounded(oblique, 2)}).area_mm2(), 40 * height - 2 * lost(60, 2) - 2 * lost(120, 2), 1e-11);
  // A reflex corner gains what a convex corner loses.
  const OutlineLoop angle = polygon_of_corners({{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}});
  EXPECT_NEAR(oriented({rounded(angle, 1)}).area_mm2(), 300 - 4 * (1 - kPi / 4), 1e-12);
}

TEST(Outline, ArcSidesAddCircularSegments) {
  // Sagitta h over a chord c: R = (c^2 / 4 + h^2) / (2 h).
  const double h = 0.7;
  const double radius = (25.0 + h * h) / (2 * h);
  const double angle = 2 * std::asin(5.0 / radius);
  const double segment = 0.5 * radius * radius * (angle - std::sin(angle));
  OutlineLoop loop = rectangle(10, 6);
  loop[0].bulge = h / 5.0;
  EXPECT_NEAR(oriented({loop}).area_mm2(), 60 + segment, 1e-12);
  EXPECT_NEAR(oriented({loop}).bounding_box().lower.y(), -h, 1e-12);
  loop[0].bulge = -h / 5.0;
  EXPECT_NEAR(oriented({loop}).area_mm2(), 60 - segment, 1e-12);
  loop[0].bulge = 1e-7;
  EXPECT_NEAR(oriented({loop}).area_mm2() - 60, 2.0 / 3.0 * 10 * 5e-7, 1e-12);
}

TEST(Outline, FilletsBetweenArcsAndLinesAreTangent) {
  OutlineLoop loop = rectangle(10, 6);
  loop[0].bulge = 0.15;
  loop[2].bulge = -0.2;
  loop[1].bulge = 0.1;
  const OutlineLoop result = rounded(loop, 0.4);
  EXPECT_EQ(result.size(), 8U);
  for (std::size_t k = 0; k < result.size(); ++k) {
    const OutlineSide& next = result[(k + 1) % result.size()];
    EXPECT_LT((result[k].tangent_at(1.0) - next.tangent_at(0.0)).norm(), 1e-9) << k;
    EXPECT_EQ(result[k].to_mm, next.from_mm);
    if (k % 2 == 0) {
      EXPECT_NEAR(result[k].radius_mm(), 0.4, 1e-9);
    }
  }
}

TEST(Outline, RadiiThatFillASideAreAllowedAndLargerOnesAreNot) {
  const OutlineLoop stadium = rounded(rectangle(20, 6), 3);
  EXPECT_NEAR(oriented({stadium}).area_mm2(), 14 * 6 + kPi * 9, 1e-11);
  std::optional<CornerFault> fault;
  with_rounded_corners(rectangle(20, 6), {0, 3.001, 3, 0}, fault);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->corner, 1U);
}

TEST(Outline, PolygonsHaveEqualAreasWithinTheTolerance) {
  for (const double tolerance : {0.1, 0.01, 1e-4}) {
    const OutlineLoop disc = circle({0, 0}, 20);
    const PolygonLoop polygon = equal_area_polygon(disc, tolerance);
    EXPECT_NEAR(area(polygon), kPi * 400, 1e-10);
    EXPECT_LE(deviation_from_circle(20, polygon), tolerance);
    EXPECT_LT(static_cast<double>(polygon.size()), 2.0 * kPi / std::sqrt(4.0 * tolerance / 20) + 8);
    EXPECT_TRUE(is_convex(polygon, 0.0));
  }
  EXPECT_TRUE(is_convex(equal_area_polygon(rounded(rectangle(20, 6), 3), 0.05), 0.0));
}

TEST(Outline, RandomOutlinesKeepTheirAreas) {
  std::mt19937 random(7);
  int concave = 0;
  for (int k = 0; k < 200; ++k) {
    const Outline outline = random_outline(random, 20.0);
    const PlanRegion plan = plan_of(outline, 0.0, 0.02);
    const double exact = outline.area_mm2();
    EXPECT_NEAR(area_of(plan.whole.borders), exact, 1e-12 * exact);
    EXPECT_NEAR(sum_of_areas(plan.whole.pieces), exact, 1e-9 * exact);
    for (const Polygon& piece : plan.whole.pieces) EXPECT_TRUE(is_convex(piece, 1e-9));
    EXPECT_NEAR(plan.box_mm.lower.norm(), 0.0, 1e-12);
    concave += plan.is_convex() ? 0 : 1;
    EXPECT_GE(area(plan.hull), exact * (1 - 1e-12));
    EXPECT_EQ(plan.is_convex(), area(plan.hull) <= exact * (1 + 1e-12));
  }
  EXPECT_GT(concave, 50);
  EXPECT_LT(concave, 195);
}

/// Returns the area from Green's theorem, as the integral of (x dy - y dx) / 2 along the border. Each arc is divided
/// into 16 portions, which are integrated with Gauss's rule of five points.
double area_by_green(const Outline& outline) {
  constexpr std::array<double, 5> kAt = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                         0.9061798459386640};
  constexpr std::array<double, 5> kWeight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                             0.4786286704993665, 0.2369268850561891};
  constexpr int kPortions = 16;
  double sum = 0.0;
  for (const OutlineLoop& loop : outline.loops)
    for (const OutlineSide& side : loop) {
      if (!side.is_arc()) {
        sum += 0.5 * (side.from_mm.x() * side.to_mm.y() - side.from_mm.y() * side.to_mm.x());
        continue;
      }
      // The centre and the angles of the arc follow from the chord and the sagitta. The arc is on the right side of the
      // chord if the sagitta is positive.
      const Vec2 chord = side.to_mm - side.from_mm;
      const double sagitta = 0.5 * side.bulge * chord.norm();
      const Vec2 right = Vec2(chord.y(), -chord.x()) / chord.norm();
      const double radius = (0.25 * chord.squaredNorm() + sagitta * sagitta) / (2.0 * sagitta);
      const Vec2 centre = 0.5 * (side.from_mm + side.to_mm) + (sagitta - radius) * right;
      const Vec2 start = side.from_mm - centre;
      const double sweep = 4.0 * std::atan(2.0 * sagitta / chord.norm());
      for (int k = 0; k < kPortions; ++k)
        for (std::size_t i = 0; i < kAt.size(); ++i) {
          const double t = (k + 0.5 + 0.5 * kAt[i]) / kPortions * sweep;
          const Vec2 v(std::cos(t) * start.x() - std::sin(t) * start.y(),
                       std::sin(t) * start.x() + std::cos(t) * start.y());
          const Vec2 p = centre + v;
          sum += 0.5 * (p.x() * v.x() + p.y() * v.y()) * 0.5 * kWeight[i] * sweep / kPortions;
        }
    }
  return sum;
}

TEST(Outline, ReportedAreasAgreeWithGreensTheorem) {
  std::mt19937 random(23);
  for (int k = 0; k < 200; ++k) {
    const Outline outline = random_outline(random, 20.0);
    EXPECT_NEAR(outline.area_mm2() / area_by_green(outline), 1.0, 1e-9);
  }
}

TEST(Outline, CoordinatesDivideTheArea) {
  std::mt19937 random(29);
  for (int k = 0; k < 50; ++k) {
    const PlanRegion plan = plan_of(random_outline(random, 20.0), 0.0, 0.02);
    const double all = sum_of_areas(plan.whole.pieces);
    for (const Eigen::Index axis : {0, 1})
      for (const double fraction : {0.1, 0.5, 0.83}) {
        Rectangle below = plan.box_mm;
        below.upper[axis] = coordinate_of_area_fraction(plan, plan.box_mm, axis, fraction);
        double sum = 0.0;
        for (const Polygon& piece : plan.whole.pieces)
          if (const Polygon part = clip(piece, below, 1e-12); !part.empty()) sum += area(part);
        EXPECT_NEAR(sum / all, fraction, 1e-9);
      }
  }
}

TEST(Outline, PlansWithoutMarginHaveElementsUpToTheBorder) {
  const PlanRegion plan = without_margin(plan_of(oriented({circle({0, 0}, 10), circle({1, 2}, 3)}), 1.0));
  EXPECT_EQ(plan.margin_mm, 0.0);
  EXPECT_TRUE(plan.margin.pieces.empty());
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces), kPi * 91.0, 1e-9);
}

TEST(Outline, SegmentsAreClipped) {
  const Polygon square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const auto inside = clip_segment({-1, 1}, {3, 1}, square);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(((*inside)[0] - Vec2(0, 1)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(((*inside)[1] - Vec2(2, 1)).norm(), 0.0, 1e-15);
  EXPECT_FALSE(clip_segment({-1, 3}, {3, 3}, square));
  EXPECT_FALSE(clip_segment({-1, 0.5}, {0.5, -1}, square));
  EXPECT_TRUE(clip_segment({0.5, 0.5}, {1, 1}, square));
}

TEST(Outline, CirclesAreRecognised) {
  EXPECT_TRUE(is_circle(circle({3, 4}, 2)));
  EXPECT_TRUE(is_circle(reversed(circle({3, 4}, 2))));
  EXPECT_FALSE(is_circle(rectangle(2, 3)));
  EXPECT_FALSE(is_circle(OutlineLoop{{{0, 0}, {2, 0}, 1.0}, {{2, 0}, {0, 0}, 0.3}}));
}

TEST(Outline, ReversedAndMovedOutlinesAreEqual) {
  OutlineLoop loop = rounded(rectangle(10, 6), 1);
  loop[1].bulge = 0.1;
  const Outline plain = oriented({loop});
  const Outline back = oriented({moved(reversed(loop), {100, -30})});
  EXPECT_NEAR(plain.area_mm2(), back.area_mm2(), 1e-10);
  EXPECT_NEAR(area_of(plan_of(plain).whole.borders), area_of(plan_of(back).whole.borders), 1e-10);
}

TEST(Outline, MarginOfARectangleIsARectangle) {
  const PlanRegion plan = plan_of(oriented({rectangle(10, 8)}), 1.0);
  EXPECT_TRUE(plan.is_box());
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces), 48.0, 1e-12);
  EXPECT_NEAR(sum_of_areas(plan.margin.pieces), 32.0, 1e-12);
}

TEST(Outline, MarginOfACircleIsACircle) {
  const PlanRegion plan = plan_of(oriented({circle({0, 0}, 10)}), 2.0, 1e-4);
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces), kPi * 64, 0.02);
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces) + sum_of_areas(plan.margin.pieces), kPi * 100, 1e-9);
}

TEST(Outline, MarginOfANonconvexOutlineWithAHole) {
  const OutlineLoop angle = polygon_of_corners({{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}});
  const PlanRegion plan = plan_of(oriented({rounded(angle, 0.5), circle({5, 5}, 1)}), 1.0, 1e-4);
  EXPECT_FALSE(plan.is_convex());
  const double hole = kPi * 4;
  const double inner = 18 * 8 + 8 * 10 - (1.5 * 1.5) * (1 - kPi / 4) * -1;
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces), inner - hole, 0.01);
  EXPECT_NEAR(sum_of_areas(plan.elements.pieces) + sum_of_areas(plan.margin.pieces), plan.area_mm2(), 1e-9);
}

TEST(Outline, MarginsOfRandomOutlines) {
  std::mt19937 random(11);
  int allowed = 0;
  for (int k = 0; k < 200; ++k) {
    const Outline outline = random_outline(random, 20.0);
    std::optional<OutlineFault> fault;
    const PlanRegion plan = plan_region(outline, 0.6, 0.02, fault);
    if (fault) continue;
    ++allowed;
    const double exact = outline.area_mm2();
    EXPECT_NEAR(sum_of_areas(plan.elements.pieces) + sum_of_areas(plan.margin.pieces), exact, 1e-9 * exact);
  }
  EXPECT_GT(allowed, 150);
}

TEST(Outline, FaultsAreFound) {
  EXPECT_TRUE(is_refused({polygon_of_corners({{0, 0}, {10, 10}, {10, 0}, {0, 10}})}));  // crosses itself
  EXPECT_TRUE(is_refused({polygon_of_corners({{0, 0}, {10, 0}, {5, 0}})}));             // no area
  EXPECT_TRUE(is_refused({polygon_of_corners({{0, 0}, {10, 0}, {10, 0}, {0, 10}})}));   // a corner twice
  EXPECT_TRUE(is_refused({rectangle(10, 10), circle({20, 5}, 1)}));                     // hole outside
  EXPECT_TRUE(is_refused({rectangle(10, 10), circle({10, 5}, 1)}));                     // hole at the border
  EXPECT_TRUE(is_refused({rectangle(10, 10), circle({4, 5}, 1), circle({5, 5}, 1)}));   // holes cross
  EXPECT_TRUE(is_refused({rectangle(10, 10), circle({5, 5}, 2), circle({5, 5}, 1)}));   // hole in a hole
  OutlineLoop open = rectangle(10, 10);
  open[2].to_mm.x() = 0.1;
  EXPECT_TRUE(is_refused({open}));
  OutlineLoop bulging = rectangle(10, 2);
  bulging[0].bulge = -0.9;  // this arc crosses the opposite side
  EXPECT_TRUE(is_refused({bulging}));
  EXPECT_FALSE(is_refused({rectangle(10, 10), circle({3, 5}, 1), circle({7, 5}, 1)}));
}

TEST(Outline, PolygonsAreClippedByPieces) {
  std::mt19937 random(3);
  for (int k = 0; k < 50; ++k) {
    const PlanRegion plan = plan_of(random_outline(random, 20.0), 0.0, 0.02);
    double sum = 0.0;
    const Vec2 step = plan.box_mm.size() / 7.0;
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < 7; ++j) {
        const Vec2 lower = step.cwiseProduct(Vec2(i, j));
        const Polygon cell = to_polygon({lower, lower + step});
        for (const Polygon& inside : clip(cell, plan.whole, 1e-9)) sum += area(inside);
        EXPECT_EQ(is_within(cell, plan.whole, 1e-9), clip(cell, plan.whole, 1e-9) == std::vector<Polygon>{cell});
      }
    EXPECT_NEAR(sum, plan.area_mm2(), 1e-8 * plan.area_mm2());
  }
}

}  // namespace outline_test
}  // namespace retrace::geometry
