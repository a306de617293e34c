#include "fabrication/turning/plan/path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fabrication/post/post.h"
#include "fabrication/turning/check/envelope.h"
#include "fabrication/turning/plan/polynomial_spiral.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/turning/paths.h"
#include "tests/support/polynomials.h"
#include "tests/support/refusals.h"

// Tests of paths. Tool compensation on spheres and planes and the kinematics are compared with closed forms. Programs
// must read back unchanged.

namespace retrace::fabrication::turning::path_test {
namespace {

using namespace geometry;
using namespace jets;

using geometry::Vec2;
constexpr double kDegree = std::numbers::pi / 180.0;
const InputLocation kHere{"part.toml", 3, "path"};

Sag formula_sag(const std::string& text) {
  Sag sag;
  sag.formula = parse_formula(text, sag_variables(), kHere);
  return sag;
}

FreeformSurface plain(const Sag& sag) {
  return {sag, std::nullopt, {}, kHere};
}

TurningTool nose(double radius_mm) {
  return {.nose_radius_mm = radius_mm};
}

PathOptions small_spiral() {
  return spiral_of(1.0, 0.02);
}

TEST(TurningPath, SpiralOfAFlatIsFlat) {
  const auto passes = make_path(plain(Sag{}), nose(0.2), small_spiral(), kHere);
  ASSERT_EQ(passes.size(), 1U);
  ASSERT_EQ(passes.front().size(), 50U * 90U + 1U);
  for (std::size_t i = 0; i < passes.front().size(); ++i) {
    const PathPoint& p = passes.front()[i];
    EXPECT_NEAR(p.z_mm, 0.0, 1e-15);
    EXPECT_NEAR(p.c_deg, 4.0 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(p.x_mm, 1.0 - 0.02 * p.c_deg / 360.0, 1e-12);
  }
  EXPECT_NEAR(path_seconds(passes), 50.0, 1e-9);
}

TEST(TurningPath, NoseOnASphereRunsOnALargerSphere) {
  // On a convex sphere, the distance of the nose's centre from the centre of the sphere is the sum of both radii. On a
  // concave sphere, it is their difference.
  for (const double sphere : {3.0, -3.0})
    for (const double skew : {0.0, 25.0, -50.0}) {
      Sag sag;
      sag.asphere.curvature_per_mm = -1.0 / sphere;
      TurningTool tool = nose(0.2);
      tool.skew_deg = skew;
      const std::vector<Pass> passes = make_path(plain(sag), tool, small_spiral(), kHere);
      for (const PathPoint& p : passes.front()) {
        // The section of the sphere in the plane of the rake face is a circle.
        const double circle = std::copysign(std::sqrt(sphere * sphere - p.y_mm * p.y_mm), sphere);
        const double middle = std::abs(circle + 0.2);
        const double z = std::copysign(std::sqrt(middle * middle - p.x_mm * p.x_mm), sphere) - sphere - 0.2;
        EXPECT_NEAR(p.z_mm, z, 1e-12);
        EXPECT_NEAR(p.y_mm, -std::tan(skew * kDegree) * p.x_mm, 1e-14);
      }
    }
}

TEST(TurningPath, EdgeNeverLiesBelowTheSurface) {
  const FreeformSurface surface = plain(formula_sag("0.1*sin(4*x)*cos(3*y)+0.05*x^2"));
  for (const double rake : {0.0, -20.0, 10.0}) {
    TurningTool tool = nose(0.15);
    tool.rake_deg = rake;
    tool.skew_deg = 15.0;
    const NoseCompensation compensation(surface, tool);
    for (int i = 0; i < 300; ++i) {
      const double c = 0.7 * i;
      const Vec2 across(std::cos(c), -std::sin(c));
      const Vec2 cut(-std::sin(c), -std::cos(c));
      const Vec2 tip(std::sin(1.3 * i), std::cos(2.1 * i));
      double start = 0.0;
      const double z = compensation.height_mm(tip.x(), tip.y(), across, cut, start);
      double least = 1.0;
      for (int k = -600; k <= 600; ++k) {
        const double angle = 60.0 * kDegree * k / 600.0;
        const double lift = 0.15 * (1.0 - std::cos(angle));
        const Vec2 p = tip + 0.15 * std::sin(angle) * across - lift * std::sin(rake * kDegree) * cut;
        least = std::min(least, z + lift * std::cos(rake * kDegree) - surface.height_mm(p.x(), p.y()));
      }
      EXPECT_GE(least, -1e-12);
      EXPECT_LE(least, 1e-6);
    }
  }
}

TEST(TurningPath, PolynomialsTakeTheQuickWayToTheSamePath) {
  Sag quick;
  quick.polynomial =
      testing::polynomial_of(1.0, 6, {{2, 0, 0.1}, {1, 1, -0.05}, {3, 3, 0.03}, {0, 5, -0.02}, {1, 0, 0.07}});
  const FreeformSurface slow = plain(formula_sag("0.1*x^2-0.05*x*y+0.03*x^3*y^3-0.02*y^5+0.07*x"));
  ASSERT_TRUE(polynomial_spiral(plain(quick), nose(0.2), small_spiral()).has_value());
  ASSERT_FALSE(polynomial_spiral(slow, nose(0.2), small_spiral()).has_value());
  const Pass a = make_path(plain(quick), nose(0.2), small_spiral(), kHere).front();
  const Pass b = make_path(slow, nose(0.2), small_spiral(), kHere).front();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].z_mm, b[i].z_mm, 1e-12);
    EXPECT_NEAR(a[i].x_mm, b[i].x_mm, 1e-15);
    EXPECT_NEAR(a[i].c_deg, b[i].c_deg, 1e-9);
  }
}

TEST(TurningPath, EqualArcs) {
  PathOptions o = small_spiral();
  o.sampling = Sampling::arc;
  o.arc_mm = 0.01;
  const Pass pass = make_path(plain(Sag{}), nose(0.2), o, kHere).front();
  for (std::size_t i = 0; i + 1 < pass.size(); ++i) {
    const double arc = pass[i].x_mm * (pass[i + 1].c_deg - pass[i].c_deg) * kDegree;
    if (pass[i].x_mm > 0.1) {
      EXPECT_NEAR(arc, 0.01, 1e-10);
    }
    EXPECT_LT(pass[i].c_deg, pass[i + 1].c_deg);
  }
}

TEST(TurningPath, RasterLines) {
  PathOptions o = raster_of(1.0, 0.5, 0.05, 0.01);
  o.cutting_mm_per_min = 60.0;
  Sag sag;
  sag.asphere.curvature_per_mm = -0.25;
  const auto passes = make_path(plain(sag), nose(0.3), o, kHere);
  ASSERT_EQ(passes.size(), 11U);
  for (const Pass& pass : passes) {
    ASSERT_EQ(pass.size(), 101U);
    for (const PathPoint& p : pass) {
      const double circle = std::sqrt(16.0 - p.y_mm * p.y_mm) + 0.3;
      EXPECT_NEAR(p.z_mm, std::sqrt(circle * circle - p.x_mm * p.x_mm) - 4.3, 1e-12);
    }
  }
  EXPECT_NEAR(path_seconds(passes), 11.0, 1e-9);
}

TEST(TurningPath, RefusesPathsWithoutEnd) {
  PathOptions o = small_spiral();
  o.feed_mm = 1e-9;
  EXPECT_THROW(make_path(plain(formula_sag("x")), nose(0.2), o, kHere), InputError);
}

TEST(TurningKinematics, OfAnInclinedPlaneAreThoseOfASine) {
  // z = 0.1 x at radius r and angular speed w has the amplitude 0.1 r, the acceleration 0.1 r w^2 and the jerk 0.1 r
  // w^3.
  PathOptions o = small_spiral();
  o.points_per_turn = 3600;
  o.feed_mm = 0.5;
  o.spindle_rpm = 60.0;
  const auto passes = make_path(plain(formula_sag("0.1*x")), nose(0.01), o, kHere);
  const AxisFigures z = axis_figures(passes, 2);
  const double w = 2.0 * std::numbers::pi;
  EXPECT_NEAR(z.acceleration_mm_per_s2, 0.1 * w * w, 0.02 * w * w * 0.1 * 2.0);
  EXPECT_NEAR(z.jerk_mm_per_s3, 0.1 * w * w * w, 0.1 * 0.1 * w * w * w * 3.0);
  EXPECT_NEAR(axis_figures(passes, 0).speed_mm_per_s, 0.5, 1e-9);
}

/// The motion of an axis with constant acceleration is reconstructed exactly from points at unequal intervals.
TEST(TurningPath, MotionAtUnequalIntervalsIsExactForAParabola) {
  Pass pass;
  double time_s = 0.0;
  for (const double seconds : {0.0, 0.1, 0.4, 0.2, 0.7, 0.3, 0.1, 0.5}) {
    time_s += seconds;
    PathPoint& point = pass.emplace_back();
    point.z_mm = 1.0 - 2.0 * time_s + 1.5 * time_s * time_s;
    point.seconds = seconds;
  }
  const std::vector<AxisState> states = axis_states(pass, 2);
  ASSERT_EQ(states.size(), pass.size());
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    EXPECT_NEAR(states[i].speed_mm_per_s, -2.0 + 3.0 * states[i].time_s, 1e-12) << i;
    EXPECT_NEAR(states[i].acceleration_mm_per_s2, 3.0, 1e-12) << i;
  }
}

/// Returns the exact acceleration of Z by a series in time, on a spiral of ten revolutions with one revolution per
/// second and a feed of 5 um.
double acceleration(const FreeformSurface& surface, double c) {
  const double w = 2.0 * std::numbers::pi;
  const Series<double> angle = line_series(c, -w, 2);
  const Series<double> radius = line_series(0.65 + 0.005 * c / w, -0.005, 2);
  return 2.0 * surface.evaluate(radius * cos(angle), radius * sin(angle))[2];
}

/// Returns the largest jump of the exact acceleration of Z while a spiral with a nose radius of zero crosses the
/// rectangle.
double acceleration_jump(int order) {
  const Sag base = formula_sag("0.4*x^6-0.5*x^4*y^2+0.3*x^2*y^4-0.2*y^6");
  const Boundary rectangle = rectangle_boundary({0, 0}, 1.2, 0.8, 0.15, {order + 1, 128}, kHere);
  const FreeformSurface surface(base, Extrapolation{rectangle, order}, {}, kHere);
  const double w = 2.0 * std::numbers::pi;
  double jump = 0.0;
  bool was_inside = false;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double c = -10.0 * w * i / n;
    const double r = 0.65 + 0.005 * c / w;
    const bool is_inside = rectangle.contains(r * std::cos(c), r * std::sin(c));
    if (i > 0 && is_inside != was_inside)
      jump = std::max(jump, std::abs(acceleration(surface, c) - acceleration(surface, c + 10.0 * w / n)));
    was_inside = is_inside;
  }
  return jump;
}

TEST(TurningKinematics, QuarticExtrapolationTakesTheJumpsOutOfTheAcceleration) {
  const double linear = acceleration_jump(1);
  const double quartic = acceleration_jump(4);
  EXPECT_GT(linear, 2.0);
  EXPECT_LT(quartic, 1e-2) << "what is left is the change over one step of the sampling";
  EXPECT_GT(linear / quartic, 500.0);
}

TEST(TurningServo, SharesOfTheStrokeAddUp) {
  PathOptions o = small_spiral();
  const FreeformSurface surface = plain(formula_sag("0.1*r^2+0.02*x"));
  const Pass slow = make_path(surface, nose(0.1), o, kHere).front();
  o.servo = Servo::fast;
  const Pass fast = make_path(surface, nose(0.1), o, kHere).front();
  ASSERT_EQ(slow.size(), fast.size());
  double most = 0.0;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    EXPECT_NEAR(slow[i].z_mm, fast[i].z_mm + fast[i].servo_mm, 1e-15);
    if (i > 90 && i + 90 < slow.size()) most = std::max(most, std::abs(fast[i].servo_mm));
  }
  // Within a revolution, only the tilt changes the height: the amplitude is 0.02 r, with r up to 1, plus a small
  // contribution of the nose.
  EXPECT_NEAR(most, 0.02, 0.002);
  EXPECT_LT(axis_figures({fast}, 2).acceleration_mm_per_s2, 0.25 * axis_figures({slow}, 2).acceleration_mm_per_s2);
}

TEST(TurningProgram, ReadsBackTheSameInAllDialects) {
  TurningTool tool = nose(0.1);
  tool.skew_deg = 20.0;
  const PathOptions o = small_spiral();
  const auto passes = make_path(plain(formula_sag("0.05*x^2-0.02*y^3")), tool, o, kHere);
  const Program program = turning_program(passes, o, "part", {"a turned part"});
  constexpr NcDialect dialects_read[] = {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc,
                                         NcDialect::pmac,     NcDialect::a3200,     NcDialect::automation1};
  for (std::size_t d = 0; d < std::size(dialects_read); ++d) {
    const std::string text = nc_text(program, kNcDialectWords[d]);
    EXPECT_EQ(recognise_dialect(text, "part"), dialects_read[d]);
    CutRecorder recorder;
    const NcEnd end = run_nc(parse_nc(text, "part", dialects_read[d]), recorder);
    EXPECT_TRUE(end.is_complete) << end.reason;
    const std::vector<CutPass> cuts = recorder.take();
    EXPECT_TRUE(recorder.findings().empty()) << recorder.findings().front().message;
    ASSERT_EQ(cuts.size(), 1U);
    ASSERT_EQ(cuts[0].x_mm.size(), passes[0].size());
    EXPECT_NEAR(cuts[0].seconds, path_seconds(passes), 1e-4);
    for (std::size_t i = 0; i < passes[0].size(); ++i) {
      EXPECT_NEAR(cuts[0].x_mm[i], passes[0][i].x_mm, 0.51e-6);
      EXPECT_NEAR(cuts[0].y_mm[i], passes[0][i].y_mm, 0.51e-6);
      EXPECT_NEAR(cuts[0].z_mm[i], passes[0][i].z_mm, 0.51e-6);
      EXPECT_NEAR(cuts[0].c_rad[i], passes[0][i].c_deg * kDegree, 1e-9);
    }
  }
}

TEST(TurningProgram, MovesAreTheProgramsOwn) {
  const PathOptions o = small_spiral();
  const auto passes = make_path(plain(Sag{}), nose(0.1), o, kHere);
  double seconds = 0.0;
  int moves = 0;
  for_each_move(turning_program(passes, o, "part", {}), [&](const PlannedMove& move) {
    seconds += move.move.seconds;
    ++moves;
  });
  EXPECT_NEAR(seconds, path_seconds(passes), 1e-9);
  EXPECT_EQ(moves, 4 + static_cast<int>(passes[0].size()) - 1);
}

TEST(TurningProgram, InverseTimeNeedsItsOwnFeed) {
  CutRecorder recorder;
  const auto run = [&](const char* text, NcDialect dialect) { run_nc(parse_nc(text, "p", dialect), recorder); };
  EXPECT_THROW(run("%\nG90 G21 G93\nG1 X1. F60.\nG1 X2.\nM2\n%\n", NcDialect::rs274ngc), InputError);
  EXPECT_THROW(run("G90 G93\nG1 X1. F0.\nM30\n", NcDialect::sinumerik), InputError);
  EXPECT_THROW(run("open prog 1\nabs\nlinear X1. tm 0\nclose\n", NcDialect::pmac), InputError);
  EXPECT_THROW(run("open prog 1\nabs\nta5\nlinear X1. tm 2\nclose\n", NcDialect::pmac), InputError);
  EXPECT_THROW(run("%\nG93 G94\nM2\n%\n", NcDialect::rs274ngc), InputError);
}

TEST(TurningProgram, StopsAndMissingTimesAreFound) {
  CutRecorder stops;
  run_nc(parse_nc("%\nG90 G21 G61 G93\nG0 X0. Y0. C0.\nG1 X1. C1. F60.\nM2\n%\n", "p", NcDialect::rs274ngc), stops);
  ASSERT_EQ(stops.findings().size(), 1U);
  EXPECT_EQ(stops.findings()[0].kind, "stops");
  EXPECT_EQ(stops.findings()[0].line, 4);
  record_message(stops.findings()[0].message);
  CutRecorder untimed;
  run_nc(parse_nc("%\nG90 G21 G64 G94\nG0 X0. Y0. C0.\nG1 X1. C1. F60.\nM2\n%\n", "p", NcDialect::rs274ngc), untimed);
  ASSERT_EQ(untimed.findings().size(), 1U);
  EXPECT_EQ(untimed.findings()[0].kind, "untimed");
  EXPECT_EQ(untimed.findings()[0].line, 4);
  record_message(untimed.findings()[0].message);
}

}  // namespace
}  // namespace retrace::fabrication::turning::path_test
