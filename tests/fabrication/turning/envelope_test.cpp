#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fabrication/post/post.h"
#include "fabrication/turning/check/inspection.h"
#include "fabrication/turning/finish.h"
#include "fabrication/turning/plan/path.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/turning/paths.h"

// Tests of the surface that programs leave. It is computed from the text of the programs and compared with closed forms
// of cusps and with the design.

namespace retrace::fabrication::turning::envelope_test {
namespace {

using namespace geometry;
using namespace jets;

constexpr double kDegree = std::numbers::pi / 180.0;
const InputLocation kHere{"part.toml", 3, "path"};

Envelope cut(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& o, double lower_nm = 0.0) {
  std::vector<Pass> passes = make_path(surface, tool, o, kHere);
  for (Pass& pass : passes)
    for (PathPoint& p : pass) p.z_mm -= 1e-6 * lower_nm;
  CutRecorder recorder;
  run_nc(parse_nc(nc_text(turning_program(passes, o, "part", {}), "rs274ngc"), "part", NcDialect::rs274ngc), recorder);
  return {tool, recorder.take()};
}

InspectedRegion disc(const PathOptions& o) {
  return {.radius_mm = o.radius_mm, .feed_mm = o.feed_mm};
}

InspectedRegion rectangle(const PathOptions& o) {
  return {
      .is_round = false, .half_width_mm = 0.5 * o.width_mm, .half_height_mm = 0.5 * o.height_mm, .feed_mm = o.feed_mm};
}

FreeformSurface sphere(double curvature_per_mm) {
  Sag sag;
  sag.asphere.curvature_per_mm = curvature_per_mm;
  return {sag, std::nullopt, {}, kHere};
}

void expect_cusps(const Inspection& i, std::size_t least_samples) {
  EXPECT_GE(i.compared, least_samples);
  EXPECT_GT(i.scallop_ratio_low, 0.99);
  EXPECT_LT(i.scallop_ratio_high, 1.01);
  EXPECT_LT(i.form_error_nm, 1.0);
  EXPECT_LT(i.interference_nm, 1.0);
}

TEST(TurningEnvelope, CuspsOfAFlat) {
  TurningTool tool;
  const PathOptions o = spiral_of(0.8, 0.02);
  const Inspection i = inspect(cut(sphere(0.0), tool, o), sphere(0.0), tool, disc(o), 41);
  expect_cusps(i, 200);
  // The cusp height is f^2 / (8 r) = 250 nm.
  EXPECT_NEAR(i.scallop_nm, 250.0, 2.5);
}

TEST(TurningEnvelope, CuspsOfAFlatWithSkewAndRake) {
  TurningTool tool;
  tool.skew_deg = 40.0;
  tool.rake_deg = -25.0;
  const PathOptions o = spiral_of(1.6, 0.02);
  const Inspection i = inspect(cut(sphere(0.0), tool, o), sphere(0.0), tool, disc(o), 21);
  expect_cusps(i, 200);
  const double c = std::cos(40.0 * kDegree);
  EXPECT_NEAR(i.scallop_nm, 250.0 * std::cos(25.0 * kDegree) / (c * c), 4.0);
}

TEST(TurningEnvelope, CuspsOfSpheres) {
  TurningTool tool;
  for (const double curvature : {-0.5, 0.5}) {
    const PathOptions o = spiral_of(0.8, 0.02);
    expect_cusps(inspect(cut(sphere(curvature), tool, o), sphere(curvature), tool, disc(o), 21), 200);
  }
}

TEST(TurningEnvelope, CuspsOfARaster) {
  TurningTool tool;
  const PathOptions o = raster_of(1.0, 1.0, 0.02, 0.002);
  const InspectedRegion region = rectangle(o);
  expect_cusps(inspect(cut(sphere(-0.2), tool, o), sphere(-0.2), tool, region, 21), 200);
}

TEST(TurningEnvelope, CuspsOfARasterWithSkewAndRake) {
  const PathOptions o = raster_of(0.8, 0.5, 0.02, 0.002);
  const InspectedRegion region = rectangle(o);
  Sag tilted;
  tilted.formula = parse_formula("0.1*x-0.15*y-0.1*x^2-0.05*x*y", sag_variables(), kHere);
  const FreeformSurface surface(tilted, std::nullopt, {}, kHere);
  for (const double skew : {35.0, -50.0})
    for (const double rake : {0.0, -15.0}) {
      SCOPED_TRACE(skew);
      TurningTool tool;
      tool.skew_deg = skew;
      tool.rake_deg = rake;
      const Inspection flat = inspect(cut(sphere(0.0), tool, o), sphere(0.0), tool, region, 21);
      expect_cusps(flat, 200);
      EXPECT_NEAR(flat.scallop_nm, finish_figures(effective_radius_mm(tool), o.feed_mm).peak_to_valley_nm,
                  0.01 * flat.scallop_nm);
      // On an inclined and curved surface, there is no closed form with skew. The form error must nevertheless be zero.
      const Inspection bent = inspect(cut(surface, tool, o), surface, tool, region, 21);
      EXPECT_LT(bent.form_error_nm, 1.0);
      EXPECT_LT(bent.interference_nm, 1.0);
      EXPECT_GT(bent.cusps.size(), 200U);
    }
}

TEST(TurningEnvelope, ARasterWithSkewIsThatOfEdgesLaidOutOneByOne) {
  TurningTool tool;
  tool.nose_radius_mm = 0.05;
  tool.skew_deg = 30.0;
  PathOptions o;
  o.strategy = Strategy::raster;
  o.width_mm = o.height_mm = 0.3;
  o.feed_mm = 0.02;
  o.arc_mm = 0.005;
  Sag sag;
  sag.formula = parse_formula("0.1*x^2+0.3*x*y", sag_variables(), kHere);
  const FreeformSurface surface(sag, std::nullopt, {}, kHere);
  const std::vector<Pass> passes = make_path(surface, tool, o, kHere);
  const Envelope envelope = cut(surface, tool, o);
  for (int s = 0; s < 6; ++s) {
    // The tool moves along y of the part. Its edge is rotated by the skew, from x towards y.
    const geometry::Vec2 p(0.08 * std::cos(1.1 * s + 0.2), 0.08 * std::sin(1.1 * s + 0.2));
    const geometry::Vec2 edge(std::cos(30.0 * kDegree), std::sin(30.0 * kDegree));
    double lowest = 1.0;
    for (const Pass& pass : passes)
      for (std::size_t i = 0; i + 1 < pass.size(); ++i)
        for (int k = 0; k < 100; ++k) {
          const double share = k / 100.0;
          const auto between = [&](double a, double b) { return a + share * (b - a); };
          // The part is rotated by C = -30 degrees. Rotate the point back from the axes of the machine.
          const double x = between(pass[i].x_mm, pass[i + 1].x_mm);
          const double y = between(pass[i].y_mm, pass[i + 1].y_mm);
          const geometry::Vec2 tip(x * edge.x() - y * edge.y(), x * edge.y() + y * edge.x());
          const double aside = (p - tip).dot(edge);
          const double ahead = (p - tip).dot(geometry::Vec2(-edge.y(), edge.x()));
          if (std::abs(ahead) < 5e-5 && std::abs(aside) < 0.05 * std::sin(60.0 * kDegree))
            lowest =
                std::min(lowest, between(pass[i].z_mm, pass[i + 1].z_mm) + 0.05 - std::sqrt(0.0025 - aside * aside));
        }
    EXPECT_NEAR(*envelope.height_mm(p.x(), p.y()), lowest, 3e-5);
    EXPECT_NEAR(passes[3][5].x_mm * edge.x() - passes[3][5].y_mm * edge.y(), 0.15 - 3 * 0.02, 1e-12);
    EXPECT_NEAR(passes[3][5].x_mm * edge.y() + passes[3][5].y_mm * edge.x(), 0.15 - 5 * 0.005, 1e-12);
    EXPECT_EQ(passes[3][5].c_deg, -30.0);
  }
}

TEST(TurningEnvelope, MapsShowCuspsAndNoWavesOfThePixels) {
  // The cusps of a plane have the same height everywhere. The map must therefore be uniform for every number of pixels.
  TurningTool tool;
  const PathOptions o = spiral_of(0.8, 0.02);
  const Envelope envelope = cut(sphere(0.0), tool, o);
  const double cusp = finish_figures(effective_radius_mm(tool), o.feed_mm).peak_to_valley_nm;
  for (const std::size_t pixels : {std::size_t{20}, std::size_t{39}, std::size_t{79}, std::size_t{200}}) {
    SCOPED_TRACE(pixels);
    const Inspection i = inspect(envelope, sphere(0.0), tool, disc(o), pixels);
    for (std::size_t k = 0; k < i.map_nm.size(); ++k) {
      const double x = (static_cast<double>(k % pixels) + 0.5) / static_cast<double>(pixels) - 0.5;
      const double y = (static_cast<double>(k / pixels) + 0.5) / static_cast<double>(pixels) - 0.5;
      // Skip pixels near the rim and near the centre, where the map does not cover a whole feed. Near the centre, the
      // cusps have other heights.
      const double r = 1.6 * std::hypot(x, y);
      if (r < 0.4 || r > 0.6) continue;
      EXPECT_NEAR(i.map_nm[k], cusp, 0.02 * cusp) << r;
    }
    // The mean square of parabolas above their valleys is a fifth of the square of their height.
    EXPECT_NEAR(i.rms_nm, cusp / std::sqrt(5.0), 0.1 * cusp);
  }
}

/// Returns a spiral over lenslets whose blocks have equal arcs.
PathOptions fine_spiral() {
  PathOptions o = spiral_of(0.32, 0.01);
  o.sampling = Sampling::arc;
  // The sagitta of the chord of a block is arc^2 k / 8: 0.3 nm at k = 2 per mm.
  o.arc_mm = 0.001;
  return o;
}

TEST(TurningEnvelope, FormOfALensletThatReachesTheExtrapolatedBase) {
  const TurningTool tool{.nose_radius_mm = 0.1};
  const PathOptions o = fine_spiral();
  Sag base;
  base.asphere.curvature_per_mm = -0.2;
  const Extrapolation extrapolation{circle_boundary({0.0, 0.0}, 0.2, 5), 4};
  const FreeformSurface bare(base, extrapolation, {}, kHere);
  Lenslet lenslet;
  lenslet.sag.asphere.curvature_per_mm = -0.7;
  lenslet.blend_order = 3;
  place_on_base(lenslet, bare, 0.16, 0.05, 0.002, true, kHere);
  lenslet.inner = circle_boundary({0.16, 0.05}, 0.06, 4);
  lenslet.outer = circle_boundary({0.16, 0.05}, 0.11, 4);
  const FreeformSurface design(base, extrapolation, {lenslet}, kHere);
  const Inspection i = inspect(cut(design, tool, o), design, tool, disc(o), 31);
  expect_cusps(i, 60);
}

/// Returns lenslets of individual form that are tilted with a curved base.
FreeformSurface lenslet_array() {
  Sag base;
  base.asphere.curvature_per_mm = -0.2;
  const FreeformSurface bare(base, std::nullopt, {}, kHere);
  std::vector<Lenslet> lenslets;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 3.0;
    const geometry::Vec2 at(0.16 * std::cos(angle), 0.16 * std::sin(angle));
    Lenslet lenslet;
    lenslet.sag.asphere.curvature_per_mm = -0.7 - 0.1 * k;
    lenslet.sag.formula = parse_formula("0.2*x^3-0.1*x*y", sag_variables(), kHere);
    place_on_base(lenslet, bare, at.x(), at.y(), 0.002, true, kHere);
    lenslet.inner = circle_boundary(at, 0.07, 4);
    lenslet.outer = circle_boundary(at, 0.13, 4);
    lenslet.blend_order = 3;
    lenslets.push_back(lenslet);
  }
  return {base, std::nullopt, lenslets, kHere};
}

TEST(TurningEnvelope, CuspsAndFormOfALensletArray) {
  const TurningTool tool{.nose_radius_mm = 0.1};
  const PathOptions o = fine_spiral();
  const FreeformSurface design = lenslet_array();
  const Inspection i = inspect(cut(design, tool, o), design, tool, disc(o), 31);
  expect_cusps(i, 60);
}

TEST(TurningEnvelope, FindsAnErrorOfTheProgram) {
  TurningTool tool;
  const PathOptions o = spiral_of(0.5, 0.02);
  const Inspection low = inspect(cut(sphere(-0.5), tool, o, 7.0), sphere(-0.5), tool, disc(o), 15);
  EXPECT_NEAR(low.interference_nm, 7.0, 1.0);
  // The program is planned for another nose radius. A concave sphere is then cut too deep or too flat.
  TurningTool other = tool;
  other.nose_radius_mm = 0.21;
  CutRecorder recorder;
  const std::vector<Pass> passes = make_path(sphere(0.5), other, o, kHere);
  run_nc(parse_nc(nc_text(turning_program(passes, o, "part", {}), "fanuc"), "part", NcDialect::fanuc), recorder);
  const Inspection wrong = inspect(Envelope(tool, recorder.take()), sphere(0.5), tool, disc(o), 15);
  EXPECT_GT(wrong.form_error_nm, 100.0);
}

TEST(TurningEnvelope, EveryTurnIsMetWhereItBegins) {
  // With a skew, the points that the edge passes at C = 0 form a curve. The simulation must include every revolution at
  // this curve.
  TurningTool tool;
  tool.skew_deg = -27.0;
  PathOptions o = spiral_of(0.8, 0.02);
  o.sampling = Sampling::arc;
  o.arc_mm = 0.01;
  const Envelope envelope = cut(sphere(0.0), tool, o);
  const double cusp_mm = 1e-6 * finish_figures(effective_radius_mm(tool), o.feed_mm).peak_to_valley_nm;
  double highest = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const double r = 0.3 + 0.4 * (i % 200) / 200.0;
    const double angle = 27.0 * kDegree + 0.2 * (i / 200 / 200.0 - 0.5);
    highest = std::max(highest, *envelope.height_mm(r * std::cos(angle), r * std::sin(angle)));
  }
  EXPECT_GT(highest, 0.9 * cusp_mm);
  EXPECT_LT(highest, 1.1 * cusp_mm);
}

TEST(TurningEnvelope, RefusesPlacesLeftUncut) {
  TurningTool tool;
  const PathOptions o = spiral_of(0.3, 0.02);
  PathOptions larger = o;
  larger.radius_mm = 0.9;
  EXPECT_THROW(inspect(cut(sphere(0.0), tool, o), sphere(0.0), tool, disc(larger), 15), InputError);
}

TEST(TurningEnvelope, IsThatOfEdgesLaidOutOneByOne) {
  // Compute the points of the edge at many poses of the path, and take the lowest point close to a given position.
  TurningTool tool;
  tool.nose_radius_mm = 0.05;
  tool.skew_deg = 20.0;
  PathOptions o = spiral_of(0.2, 0.02);
  Sag sag;
  sag.formula = parse_formula("0.1*x^2+0.3*x*y", sag_variables(), kHere);
  const FreeformSurface surface(sag, std::nullopt, {}, kHere);
  const std::vector<Pass> passes = make_path(surface, tool, o, kHere);
  const Envelope envelope = cut(surface, tool, o);
  const Pass& pass = passes.front();
  for (int s = 0; s < 6; ++s) {
    const geometry::Vec2 p(0.1 * std::cos(1.1 * s + 0.2), 0.1 * std::sin(1.1 * s + 0.2));
    double lowest = 1.0;
    for (std::size_t i = 0; i + 1 < pass.size(); ++i)
      for (int k = 0; k < 40; ++k) {
        const double share = k / 40.0;
        const auto between = [&](double a, double b) { return a + share * (b - a); };
        const double c = between(pass[i].c_deg, pass[i + 1].c_deg) * kDegree;
        const double x = p.x() * std::cos(c) - p.y() * std::sin(c) - between(pass[i].x_mm, pass[i + 1].x_mm);
        const double y = p.x() * std::sin(c) + p.y() * std::cos(c) - between(pass[i].y_mm, pass[i + 1].y_mm);
        if (std::abs(y) < 1e-4 && std::abs(x) < 0.05 * std::sin(60.0 * kDegree))
          lowest = std::min(lowest, between(pass[i].z_mm, pass[i + 1].z_mm) + 0.05 - std::sqrt(0.0025 - x * x));
      }
    EXPECT_NEAR(*envelope.height_mm(p.x(), p.y()), lowest, 2e-5);
  }
}

}  // namespace
}  // namespace retrace::fabrication::turning::envelope_test
