#include "geometry/surface/boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "tests/support/refusals.h"

namespace retrace::geometry::boundary_test {
namespace {

using namespace jets;

const InputLocation kHere{"part.toml", 9, "boundary.points_mm"};

/// Sets `sites` to unevenly spaced angles and `values` to the radii of a wavy curve at these angles.
void wavy(int count, std::vector<double>& sites, std::vector<double>& values) {
  for (int i = 0; i < count; ++i) {
    sites.push_back(kTwoPi * (i + 0.3 * std::sin(2.1 * i)) / count - 1.0);
    values.push_back(2.0 + 0.4 * std::cos(3.0 * sites.back()) + 0.1 * std::sin(7.0 * i));
  }
}

double falling_factorial(int n, int k) {
  double f = 1.0;
  for (int i = 0; i < k; ++i) f *= n - i;
  return f;
}

/// Returns the k-th derivative of a polynomial piece of a spline.
/// \param at distance from the knot at which the piece begins
double derivative_of(const double* piece, int degree, int k, double at) {
  double sum = 0.0;
  for (int i = degree; i >= k; --i) sum = sum * at + falling_factorial(i, k) * piece[i];
  return sum;
}

TEST(PeriodicSpline, IsAsSmoothAsItsDegreeSaysAtEveryKnotAndTheSeam) {
  for (int degree = 2; degree <= 6; ++degree) {
    std::vector<double> sites;
    std::vector<double> values;
    wavy(25, sites, values);
    const PeriodicSpline spline(sites, values, degree);
    const std::vector<double>& knots = spline.knots_rad();
    ASSERT_EQ(knots.size(), sites.size());
    double jump = 0.0;
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const std::size_t next = (i + 1) % knots.size();
      const double width = knots[next] + (next == 0 ? kTwoPi : 0.0) - knots[i];
      for (int k = 0; k <= degree; ++k) {
        const double left = derivative_of(spline.piece(i), degree, k, width);
        const double right = derivative_of(spline.piece(next), degree, k, 0.0);
        if (k < degree)
          EXPECT_NEAR(left, right, 1e-9 * (1.0 + std::abs(right)) * std::pow(10.0, std::max(0, k - 2)))
              << "degree " << degree << ", derivative " << k << ", knot " << next;
        else
          jump = std::max(jump, std::abs(left - right));
      }
    }
    EXPECT_GT(jump, 1.0) << "the derivative of order " << degree << " is known to jump";
    for (std::size_t i = 0; i < sites.size(); ++i) EXPECT_NEAR(spline.evaluate(sites[i]), values[i], 1e-12);
    EXPECT_NEAR(spline.evaluate(0.3), spline.evaluate(0.3 + kTwoPi), 1e-13);
    EXPECT_NEAR(spline.evaluate(0.3), spline.evaluate(0.3 - 3 * kTwoPi), 1e-13);
  }
}

TEST(PeriodicSpline, ConvergesWithItsOrder) {
  const auto worst = [](int count, int degree) {
    std::vector<double> sites;
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      sites.push_back(kTwoPi * i / count);
      values.push_back(std::cos(2.0 * sites.back()));
    }
    const PeriodicSpline spline(sites, values, degree);
    double error = 0.0;
    for (int i = 0; i < 1000; ++i)
      error = std::max(error, std::abs(spline.evaluate(0.00628 * i) - std::cos(2.0 * 0.00628 * i)));
    return error;
  };
  for (const int degree : {3, 5})
    EXPECT_NEAR(std::log2(worst(24, degree) / worst(48, degree)), degree + 1.0, 0.35) << degree;
  EXPECT_LT(worst(48, 4), worst(24, 4) / 20.0);
}

TEST(PeriodicSpline, RefusesWhatItCannotInterpolate) {
  EXPECT_THROW(PeriodicSpline({0, 1, 2}, {1, 1, 1}, 3), std::invalid_argument);
  EXPECT_THROW(PeriodicSpline({0, 1, 1, 2, 3}, {1, 1, 1, 1, 1}, 3), std::invalid_argument);
  EXPECT_THROW(PeriodicSpline({0, 1, 2, 3, 6.3}, {1, 1, 1, 1, 1}, 3), std::invalid_argument);
}

std::vector<Vec2> ellipse_points(int count, Vec2 centre) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i)
    points.push_back(centre + Vec2(3.0 * std::cos(kTwoPi * i / count), 2.0 * std::sin(kTwoPi * i / count)));
  return points;
}

TEST(Boundary, OfAnEllipseTellsInsideFromOutside) {
  const Vec2 centre(5.0, -1.0);
  const Boundary boundary = boundary_from_points(ellipse_points(60, centre), std::nullopt, false, 3, kHere);
  EXPECT_NEAR((boundary.centre_mm - centre).norm(), 0.0, 1e-12);
  int differences = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec2 p = centre + Vec2(4.0 * std::sin(1.1 * i), 3.0 * std::cos(1.7 * i));
    const double share = std::hypot((p.x() - centre.x()) / 3.0, (p.y() - centre.y()) / 2.0);
    if (std::abs(share - 1.0) > 1e-4 && boundary.contains(p.x(), p.y()) != (share < 1.0)) ++differences;
  }
  EXPECT_EQ(differences, 0);
  EXPECT_TRUE(boundary.contains(centre.x(), centre.y()));
}

TEST(Boundary, TakesPointsEitherWayRoundAndScattered) {
  std::vector<Vec2> points = ellipse_points(30, Vec2::Zero());
  const Boundary there = boundary_from_points(points, std::nullopt, false, 3, kHere);
  std::reverse(points.begin(), points.end());
  const Boundary back = boundary_from_points(points, std::nullopt, false, 3, kHere);
  std::swap(points[3], points[17]);
  EXPECT_THROW(boundary_from_points(points, Vec2(0, 0), false, 3, kHere), InputError);
  const Boundary sorted = boundary_from_points(points, std::nullopt, true, 3, kHere);
  for (double a = 0.0; a < 6.3; a += 0.1) {
    EXPECT_NEAR(there.radius_mm.evaluate(a), back.radius_mm.evaluate(a), 1e-12);
    EXPECT_NEAR(there.radius_mm.evaluate(a), sorted.radius_mm.evaluate(a), 1e-12);
  }
}

TEST(Boundary, RefusesCurvesThatAreNotOne) {
  std::vector<Vec2> eight;
  std::vector<Vec2> twice;
  std::vector<Vec2> dented = ellipse_points(30, Vec2::Zero());
  dented[4] = {2.0, 0.1};  // the angle about the centre decreases here
  for (int i = 0; i < 40; ++i) {
    const double t = kTwoPi * i / 40.0;
    eight.push_back({std::sin(t), std::sin(2.0 * t) + 1e-3});
    twice.push_back({(2.0 + 0.1 * std::cos(0.5 * t)) * std::cos(2.0 * t), 2.0 * std::sin(2.0 * t)});
  }
  std::vector<Vec2> outside = ellipse_points(30, {10.0, 0.0});
  const auto message = [](const std::vector<Vec2>& points, std::optional<Vec2> centre) -> std::string {
    try {
      boundary_from_points(points, centre, false, 3, kHere);
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "taken";
  };
  for (const auto& points : {eight, twice, dented, outside}) {
    const std::string text = message(points, Vec2(0.0, 0.0));
    EXPECT_EQ(text, "part.toml:9: boundary.points_mm");
  }
  EXPECT_EQ(message(dented, std::nullopt), "part.toml:9: boundary.points_mm");
  EXPECT_EQ(message({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, std::nullopt), "part.toml:9: boundary.points_mm");
}

TEST(Boundary, OfTwoSurfacesThatMeet) {
  // A sphere of radius 2, whose centre is 1 below a plane, intersects the plane in a circle of radius sqrt(3).
  const auto difference = [](double x, double y) { return std::sqrt(4.0 - x * x - y * y) - 1.0; };
  const Boundary circle = boundary_of_intersection({0.0, 0.0}, difference, 1.9, {}, kHere);
  const Boundary shifted = boundary_of_intersection({0.3, 0.0}, difference, 1.7 + 0.35, {3, 360}, kHere);
  for (double a = 0.0; a < 6.3; a += 0.01) {
    EXPECT_NEAR(circle.radius_mm.evaluate(a), std::sqrt(3.0), 1e-12);
    const double exact = -0.3 * std::cos(a) + std::sqrt(3.0 - 0.09 * std::sin(a) * std::sin(a));
    EXPECT_NEAR(shifted.radius_mm.evaluate(a), exact, 1e-9);
  }
  EXPECT_THROW(boundary_of_intersection({0, 0}, difference, 1.0, {}, kHere), InputError);
}

TEST(Boundary, RectangleWithRoundCorners) {
  const Boundary rectangle = rectangle_boundary({0, 0}, 4.0, 2.0, 0.5, {3, 720}, kHere);
  EXPECT_NEAR(rectangle.radius_mm.evaluate(0.0), 2.0, 1e-6);
  EXPECT_NEAR(rectangle.radius_mm.evaluate(0.5 * std::numbers::pi), 1.0, 1e-6);
  // The rounded corner is an arc about (1.5, 0.5). The radius is tested in the direction of this centre.
  const double angle = std::atan2(0.5, 1.5);
  EXPECT_NEAR(rectangle.radius_mm.evaluate(angle), std::hypot(1.5, 0.5) + 0.5, 1e-4);
}

TEST(Boundary, ScalesAndNests) {
  for (const int degree : {3, 4}) {
    const Boundary boundary = boundary_from_points(ellipse_points(60, {1, 1}), std::nullopt, false, degree, kHere);
    const Boundary larger = scaled(boundary, 1.1, 0.2, kHere);
    for (double a = 0.0; a < 6.3; a += 0.1)
      EXPECT_NEAR(larger.radius_mm.evaluate(a), 1.1 * boundary.radius_mm.evaluate(a) + 0.2, 1e-10);
    EXPECT_NO_THROW(check_nested(boundary, larger, kHere));
    EXPECT_THROW(check_nested(larger, boundary, kHere), InputError);
    EXPECT_THROW(check_nested(circle_boundary({1, 1}, 2.5), boundary, kHere), InputError);
    EXPECT_THROW(scaled(boundary, 1.0, -2.5, kHere), InputError);
  }
}

TEST(Boundary, RefusesARadiusThatIsNotPositive) {
  EXPECT_THROW(boundary_from_radius(
                   {0, 0}, [](double a) { return std::cos(a); }, {}, kHere),
               InputError);
  EXPECT_THROW(boundary_from_radius(
                   {0, 0}, [](double a) { return std::log(a); }, {}, kHere),
               InputError);
}

}  // namespace
}  // namespace retrace::geometry::boundary_test
