#include "geometry/surface/freeform_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/angle.h"
#include "tests/support/refusals.h"

// Tests of extrapolation, blends and lenslets: orders of continuity, values, and closed forms.

namespace retrace::geometry::freeform_surface_test {
namespace {

using namespace jets;

const InputLocation kHere{"part.toml", 3, "lenslets"};

/// Returns a polynomial of degree 6 that increases quickly, similar to Fig. 8 of Naples and Yi.
Sag steep_polynomial() {
  Sag sag;
  sag.formula = parse_formula("0.05*x^6-0.03*x^3*y^3+0.04*y^5-0.1*x^2*y+0.08*x*y+0.02*x", sag_variables(), kHere);
  return sag;
}

Boundary wavy_boundary(Vec2 centre, double radius, int degree = 3) {
  const auto r = [=](double a) { return radius * (1.0 + 0.15 * std::cos(3.0 * a) + 0.05 * std::sin(2.0 * a)); };
  return boundary_from_radius(centre, r, {degree, 40}, kHere);
}

/// Returns the height of a surface along a radial line as a series in the distance from the point at the radius `r` and
/// the angle `angle`. The distance increases outward.
template <class Evaluate>
Series<double> along_radius(const Evaluate& evaluate, Vec2 centre, double angle, double r, int order) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return evaluate(line_series(centre.x() + r * c, c, order), line_series(centre.y() + r * s, s, order));
}

TEST(Extrapolation, HasTheOrderItIsAskedFor) {
  const Vec2 centre(0.1, -0.05);
  for (int n = 1; n <= 6; ++n) {
    const Extrapolation extrapolation{wavy_boundary(centre, 1.0), n};
    const FreeformSurface surface(steep_polynomial(), extrapolation, {}, kHere);
    const auto base = [&](const Series<double>& x, const Series<double>& y) { return surface.base().evaluate(x, y); };
    const auto whole = [&](const Series<double>& x, const Series<double>& y) { return surface.evaluate(x, y); };
    double jump = 0.0;
    for (double angle = 0.05; angle < kTwoPi; angle += 0.37) {
      const double edge = extrapolation.boundary.radius_mm.evaluate(angle);
      const Series<double> inside = along_radius(base, centre, angle, edge, 7);
      const double beyond = 1e-10;
      const Series<double> outside = along_radius(whole, centre, angle, edge + beyond, 7);
      for (int k = 0; k <= n; ++k) EXPECT_NEAR(outside[k], inside[k], 1e-8) << "order " << k << " of " << n;
      jump = std::max(jump, std::abs(outside[n + 1] - inside[n + 1]));
    }
    // The base is a polynomial of degree 6. Its derivatives of higher order are 0, so they cannot jump.
    if (n < 6)
      EXPECT_GT(jump, 1e-2) << n;
    else
      EXPECT_LT(jump, 1e-8);
  }
}

TEST(Extrapolation, DifferenceQuotientsAreTheExactDerivatives) {
  const Vec2 centre(0.0, 0.0);
  for (int n = 1; n <= 4; ++n) {
    const Extrapolation extrapolation{wavy_boundary(centre, 1.0), n};
    const FreeformSurface surface(steep_polynomial(), extrapolation, {}, kHere);
    const auto base = [&](const Series<double>& x, const Series<double>& y) { return surface.base().evaluate(x, y); };
    const double angle = 0.8;
    const double edge = extrapolation.boundary.radius_mm.evaluate(angle);
    const Series<double> exact = along_radius(base, centre, angle, edge, n + 1);
    // For a polynomial of degree n with the leading coefficient c_n, the finite differences of order n are n! c_n h^n
    // for any step h, and the differences of order n + 1 are 0.
    const double h = 0.05;
    std::vector<double> z;
    for (int j = 0; j <= n + 1; ++j)
      z.push_back(
          surface.height_mm((edge + 1e-12 + j * h) * std::cos(angle), (edge + 1e-12 + j * h) * std::sin(angle)));
    double factorial = 1.0;
    for (int order = 1; order <= n; ++order) factorial *= order;
    std::vector<double> d = z;
    for (int order = 1; order <= n + 1; ++order) {
      for (std::size_t j = 0; j + 1 < d.size(); ++j) d[j] = d[j + 1] - d[j];
      d.pop_back();
      if (order == n) {
        EXPECT_NEAR(d[0] / std::pow(h, n), factorial * exact[n], 1e-7 * std::abs(factorial * exact[n]));
      }
    }
    EXPECT_NEAR(d[0] / std::pow(h, n + 1), 0.0, 1e-6);
  }
}

TEST(Extrapolation, IsTheDesignWithin) {
  const FreeformSurface surface(steep_polynomial(), Extrapolation{wavy_boundary({0, 0}, 1.0), 3}, {}, kHere);
  for (int i = 0; i < 500; ++i) {
    const double r = 0.78 * std::sqrt(i / 500.0);
    const double x = r * std::cos(2.4 * i);
    const double y = r * std::sin(2.4 * i);
    const double design = 0.05 * std::pow(x, 6) - 0.03 * std::pow(x * y, 3) + 0.04 * std::pow(y, 5) - 0.1 * x * x * y +
                          0.08 * x * y + 0.02 * x;
    EXPECT_NEAR(surface.height_mm(x, y), design, 1e-12);
    EXPECT_EQ(surface.zone_at(x, y), Zone::base);
  }
  EXPECT_EQ(surface.zone_at(1.3, 0.0), Zone::extrapolation);
}

/// Returns the largest jump, over all knots of the boundary, of a derivative of the surface with respect to the
/// azimuth. The derivative is taken at a radius outside the boundary.
/// \param degree degree of the boundary's spline
/// \param order order of the derivative
double azimuth_jump(int degree, int order) {
  const Boundary boundary = wavy_boundary({0, 0}, 1.0, degree);
  const FreeformSurface surface(steep_polynomial(), Extrapolation{boundary, 4}, {}, kHere);
  double jump = 0.0;
  for (const double knot : boundary.radius_mm.knots_rad()) {
    double side[2];
    for (int i = 0; i < 2; ++i) {
      // Angle along the circle of radius 1.4, as a series about the angle of the knot.
      const Series<double> angle = line_series(knot + (i == 0 ? -1e-9 : 1e-9), 1.0, order);
      side[i] = surface.evaluate(1.4 * cos(angle), 1.4 * sin(angle))[order];
    }
    jump = std::max(jump, std::abs(side[1] - side[0]));
  }
  return jump;
}

TEST(Extrapolation, IsAsSmoothInAzimuthAsItsBoundary) {
  EXPECT_LT(azimuth_jump(3, 2), 1e-5);
  EXPECT_GT(azimuth_jump(3, 3), 1e-2) << "a cubic boundary caps the surface at C2, whatever the order";
  EXPECT_LT(azimuth_jump(5, 3), 1e-4);
  EXPECT_LT(azimuth_jump(5, 4), 1e-5);
  EXPECT_GT(azimuth_jump(5, 5), 1e-2);
}

TEST(Blend, SolvesTheHermiteSystem) {
  // Reference: the system of linear equations of Naples and Yi, eq. 5, for a centred and scaled variable.
  for (int d = 0; d <= kMaxBlendOrder; ++d) {
    const int size = 2 * d + 2;
    const double r1 = 0.7;
    const double r2 = 1.15;
    Series<double> first(d);
    Series<double> second(d);
    for (int k = 0; k <= d; ++k) {
      first[k] = std::sin(1.0 + 2.0 * k);
      second[k] = std::cos(0.5 + 1.7 * k);
    }
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right(size);
    const double half = 0.5 * (r2 - r1);
    for (int k = 0; k <= d; ++k)
      for (int end = 0; end < 2; ++end) {
        for (int i = k; i < size; ++i) {
          double binomial = 1.0;
          for (int j = 0; j < k; ++j) binomial = binomial * (i - j) / (j + 1);
          system(2 * k + end, i) = binomial * std::pow(end == 0 ? -1.0 : 1.0, i - k);
        }
        right[2 * k + end] = (end == 0 ? first[k] : second[k]) * std::pow(half, k);
      }
    const Eigen::VectorXd c = system.fullPivLu().solve(right);
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      double sum = 0.0;
      for (int i = size - 1; i >= 0; --i) sum = sum * (2.0 * share - 1.0) + c[i];
      EXPECT_NEAR(hermite_blend(share, r2 - r1, first, second, d), sum, 1e-13) << "d " << d << " at " << share;
    }
  }
}

/// Returns a curved base with one lenslet, which is tilted unless `tilted` is false. `d` is the order of the blend.
FreeformSurface lens_on_base(int d, bool tilted = true) {
  Sag base;
  base.asphere.curvature_per_mm = -0.08;
  const FreeformSurface bare(base, std::nullopt, {}, kHere);
  Lenslet lenslet;
  lenslet.sag.asphere = {-0.9, -0.5, {0.02}};
  lenslet.sag.formula = parse_formula("0.05*x^3-0.02*x*y", sag_variables(), kHere);
  place_on_base(lenslet, bare, 1.2, -0.7, 0.06, tilted, kHere);
  lenslet.inner = wavy_boundary({1.2, -0.7}, 0.3);
  lenslet.outer = wavy_boundary({1.2, -0.7}, 0.42);
  lenslet.blend_order = d;
  return {base, std::nullopt, {lenslet}, kHere};
}

TEST(Blend, HasItsOrderAtBothBoundaries) {
  const Vec2 centre(1.2, -0.7);
  for (int d = 1; d <= kMaxBlendOrder; ++d) {
    const FreeformSurface surface = lens_on_base(d);
    const Lenslet& lenslet = surface.lenslets().front();
    const auto on_lenslet = [&](const Series<double>& x, const Series<double>& y) { return lenslet.evaluate(x, y); };
    const auto on_base = [&](const Series<double>& x, const Series<double>& y) {
      return surface.base().evaluate(x, y);
    };
    const auto whole = [&](const Series<double>& x, const Series<double>& y) { return surface.evaluate(x, y); };
    double jump = 0.0;
    for (double angle = 0.1; angle < kTwoPi; angle += 0.5) {
      const double r = lenslet.inner.radius_mm.evaluate(angle);
      const double R = lenslet.outer.radius_mm.evaluate(angle);
      const double step = 1e-11;
      const Series<double> a = along_radius(on_lenslet, centre, angle, r, d + 1);
      const Series<double> b = along_radius(whole, centre, angle, r + step, d + 1);
      const Series<double> e = along_radius(whole, centre, angle, R - step, d + 1);
      const Series<double> f = along_radius(on_base, centre, angle, R, d + 1);
      for (int k = 0; k <= d; ++k) {
        const double tolerance = 1e-8 * std::pow(20.0, k);
        EXPECT_NEAR(b[k], a[k], tolerance) << "order " << k << " of " << d;
        EXPECT_NEAR(e[k], f[k], tolerance) << "order " << k << " of " << d;
      }
      jump = std::max(jump, std::abs(b[d + 1] - a[d + 1]));
    }
    EXPECT_GT(jump, 1e-2);
  }
}

TEST(Blend, StaysBetweenItsBoundaries) {
  const FreeformSurface surface = lens_on_base(3);
  const Lenslet& lenslet = surface.lenslets().front();
  int blended = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = 1.2 + 0.6 * std::sin(1.37 * i);
    const double y = -0.7 + 0.6 * std::cos(0.73 * i);
    const double z = surface.height_mm(x, y);
    const double angle = std::atan2(y + 0.7, x - 1.2);
    const double r = std::hypot(x - 1.2, y + 0.7);
    if (r > lenslet.outer.radius_mm.evaluate(angle)) {
      EXPECT_EQ(z, surface.base().evaluate(x, y));
    } else if (r <= lenslet.inner.radius_mm.evaluate(angle)) {
      EXPECT_EQ(z, lenslet.evaluate(x, y));
    } else {
      ++blended;
      EXPECT_EQ(surface.zone_at(x, y), Zone::blend);
    }
  }
  EXPECT_GT(blended, 1000);
}

TEST(Blend, ReachesAnExtrapolatedBase) {
  // The first lenslet extends across the boundary of the base, and the second lenslet is outside this boundary.
  const Extrapolation extrapolation{wavy_boundary({0.1, -0.05}, 1.0, 5), 4};
  const FreeformSurface bare(steep_polynomial(), extrapolation, {}, kHere);
  std::vector<Lenslet> lenslets(2);
  const Vec2 places[] = {{1.2, 0.1}, {-0.9, -1.1}};
  for (std::size_t i = 0; i < 2; ++i) {
    lenslets[i].sag.asphere.curvature_per_mm = -0.8;
    lenslets[i].blend_order = 2;
    place_on_base(lenslets[i], bare, places[i].x(), places[i].y(), 0.01, true, kHere);
    lenslets[i].inner = circle_boundary(places[i], 0.1);
    lenslets[i].outer = circle_boundary(places[i], 0.15);
  }
  const FreeformSurface surface(steep_polynomial(), extrapolation, lenslets, kHere);
  const auto whole = [&](const Series<double>& x, const Series<double>& y) { return surface.evaluate(x, y); };
  int extrapolated = 0;
  for (const Vec2& at : places)
    for (double angle = 0.05; angle < kTwoPi; angle += 0.37) {
      const double beyond = 1e-10;
      const Series<double> inside = along_radius(whole, at, angle, 0.15 - beyond, 3);
      const Series<double> outside = along_radius(whole, at, angle, 0.15 + beyond, 3);
      for (int k = 0; k <= 2; ++k) EXPECT_NEAR(inside[k], outside[k], 1e-6) << k;
      const Vec2 p = at + 0.15 * (1.0 + 1e-9) * Vec2(std::cos(angle), std::sin(angle));
      EXPECT_EQ(surface.height_mm(p.x(), p.y()), bare.height_mm(p.x(), p.y()));
      extrapolated += surface.zone_at(p.x(), p.y()) == Zone::extrapolation ? 1 : 0;
      const Vec2 q = at + 0.12 * Vec2(std::cos(angle), std::sin(angle));
      const Jet2 along = surface.evaluate(Jet2(q.x(), 0.6, 0.0), Jet2(q.y(), 0.8, 0.0));
      const Gradient slopes = surface.gradient(q.x(), q.y());
      EXPECT_NEAR(along[0], slopes.value, 1e-14);
      EXPECT_NEAR(along[1], 0.6 * slopes.x + 0.8 * slopes.y, 1e-11);
      const auto height = [&](double t) { return surface.height_mm(q.x() + 0.6 * t, q.y() + 0.8 * t); };
      EXPECT_NEAR(along[1], (height(1e-5) - height(-1e-5)) / 2e-5, 1e-6);
    }
  EXPECT_GT(extrapolated, 20);
  EXPECT_LT(extrapolated, 34) << "of the first, a part lies within the boundary";
}

TEST(Surface, GradientIsThatOfItsValues) {
  const FreeformSurface surface = lens_on_base(2);
  const FreeformSurface extended(steep_polynomial(), Extrapolation{wavy_boundary({0, 0}, 1.0), 3}, {}, kHere);
  for (int i = 0; i < 400; ++i) {
    const double h = 1e-6;
    for (const FreeformSurface* s : {&surface, &extended}) {
      const double x = (s == &surface ? 1.2 : 0.0) + (s == &surface ? 0.5 : 1.3) * std::sin(1.37 * i);
      const double y = (s == &surface ? -0.7 : 0.0) + (s == &surface ? 0.5 : 1.3) * std::cos(0.73 * i);
      if (s->zone_at(x + 2 * h, y) != s->zone_at(x - 2 * h, y) || s->zone_at(x, y + 2 * h) != s->zone_at(x, y - 2 * h))
        continue;
      const Gradient z = s->gradient(x, y);
      EXPECT_NEAR(z.value, s->height_mm(x, y), 1e-14);
      EXPECT_NEAR(z.x, (s->height_mm(x + h, y) - s->height_mm(x - h, y)) / (2 * h), 2e-8 * (1 + std::abs(z.x)));
      EXPECT_NEAR(z.y, (s->height_mm(x, y + h) - s->height_mm(x, y - h)) / (2 * h), 2e-8 * (1 + std::abs(z.y)));
    }
  }
}

TEST(Lenslet, TiltedSphereIsASphere) {
  Sag base;
  base.formula = parse_formula("0.3*x-0.2*y", sag_variables(), kHere);
  const FreeformSurface bare(base, std::nullopt, {}, kHere);
  Lenslet lenslet;
  const double radius = 2.0;
  lenslet.sag.asphere.curvature_per_mm = -1.0 / radius;
  place_on_base(lenslet, bare, 0.5, 0.25, 0.1, true, kHere);
  const Vec3 normal = Vec3(-0.3, 0.2, 1.0).normalized();
  EXPECT_NEAR((lenslet.part_from_lenslet.col(2) - normal).norm(), 0.0, 1e-15);
  const Vec3 centre = Vec3(0.5, 0.25, 0.3 * 0.5 - 0.2 * 0.25) + (0.1 - radius) * normal;
  for (int i = 0; i < 500; ++i) {
    const double x = 0.5 + 0.9 * std::sin(1.7 * i);
    const double y = 0.25 + 0.9 * std::cos(2.3 * i);
    const double square = radius * radius - (x - centre.x()) * (x - centre.x()) - (y - centre.y()) * (y - centre.y());
    EXPECT_NEAR(lenslet.evaluate(x, y), centre.z() + std::sqrt(square), 1e-12);
    const Gradient z = lenslet.evaluate(Gradient(x, 1, 0), Gradient(y, 0, 1));
    EXPECT_NEAR(z.x, -(x - centre.x()) / std::sqrt(square), 1e-12);
    const Series<double> along = lenslet.evaluate(line_series(x, 1.0, 3), line_series(y, 0.0, 3));
    EXPECT_NEAR(2.0 * along[2], -(square + std::pow(x - centre.x(), 2)) / std::pow(square, 1.5), 1e-10);
  }
}

TEST(Surface, FindsTheLensletOfAPlace) {
  Sag base;
  std::vector<Lenslet> lenslets;
  const FreeformSurface bare(base, std::nullopt, {}, kHere);
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 9; ++k) {
      Lenslet lenslet;
      lenslet.sag.asphere.curvature_per_mm = -1.0;
      place_on_base(lenslet, bare, 0.5 * i, 0.5 * k, 0.01, true, kHere);
      lenslet.inner = circle_boundary({0.5 * i, 0.5 * k}, 0.1);
      lenslet.outer = circle_boundary({0.5 * i, 0.5 * k}, 0.2);
      lenslets.push_back(lenslet);
    }
  const FreeformSurface surface(base, std::nullopt, lenslets, kHere);
  for (int i = 0; i < 5000; ++i) {
    const double x = 3.0 + 3.5 * std::sin(1.37 * i);
    const double y = 2.0 + 2.5 * std::cos(0.73 * i);
    const double r = std::hypot(std::remainder(x, 0.5), std::remainder(y, 0.5));
    const bool is_on_grid = x > -0.25 && x < 5.75 && y > -0.25 && y < 4.25;
    const Zone expected = !is_on_grid || r > 0.2 ? Zone::base : r <= 0.1 ? Zone::lenslet : Zone::blend;
    EXPECT_EQ(surface.zone_at(x, y), expected) << x << " " << y;
  }
  lenslets[5].outer = circle_boundary({0.0, 2.5}, 0.4);
  EXPECT_THROW(FreeformSurface(base, std::nullopt, lenslets, kHere), InputError);
  lenslets[5].outer = circle_boundary({0.0, 2.5}, 0.2);
  EXPECT_NO_THROW(FreeformSurface(base, Extrapolation{circle_boundary({0, 0}, 3.0), 2}, lenslets, kHere));
}

std::string refusal(const std::string& formula, double radius) {
  Sag base;
  base.formula = parse_formula(formula, sag_variables(), kHere);
  try {
    check_surface(FreeformSurface(base, std::nullopt, {}, kHere), radius, kHere);
  } catch (const InputError& error) {
    return recorded_place_of(error);
  }
  return "taken";
}

TEST(Surface, SaysWhereItHasNoHeightOrAVerticalSlope) {
  EXPECT_EQ(refusal("0.1*r^2", 5.0), "taken");
  EXPECT_EQ(refusal("sqrt(4-r^2)", 2.5), "part.toml:3: lenslets");
  EXPECT_EQ(refusal("sqrt(4-r^2)", 2.0), "part.toml:3: lenslets");
  EXPECT_EQ(refusal("100*x", 1.0), "part.toml:3: lenslets");
  EXPECT_EQ(refusal("1/x", 1.0), "part.toml:3: lenslets");
}

}  // namespace
}  // namespace retrace::geometry::freeform_surface_test
