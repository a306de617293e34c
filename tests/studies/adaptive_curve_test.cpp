// Tests of curves of RRE with automatically chosen angles of incidence. Linear interpolation between a small number of
// points must follow the curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/threads.h"
#include "design/io/design_reader.h"
#include "design/total_reflection.h"
#include "studies/rre/adaptive_curve.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre.h"
#include "tests/support/closed_forms.h"

namespace retrace::studies::adaptive_curve_test {
namespace {

constexpr double kIndex = 1.4917;
const std::vector<std::string> kNoOverrides;

std::string text(const std::string& element, const std::string& array) {
  return "[element]\n" + element + "\n[array]\n" + array + "\n[body]\nthickness_mm = 0.5\nrefractive_index = 1.4917\n";
}

design::Design design(const std::string& element, const std::string& array) {
  return design::parse_design(text(element, array), "d.toml", kNoOverrides);
}

design::Design prisms() {
  return design("kind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5", "extent = \"infinite\"");
}

design::Design single_prism() {
  return design("kind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45", "arrangement = \"single\"");
}

design::Design honeycomb() {
  return design("kind = \"hexagonal_icc\"\naperture_mm = 0.5", "arrangement = \"honeycomb\"\nextent = \"infinite\"");
}

RreSettings chosen(double low, double high, raytrace::Engine engine) {
  RreSettings request;
  request.incidence_deg.clear();
  request.incidence_spans = {{low, high}};
  request.engine = engine;
  if (engine == raytrace::Engine::exact) request.target_error = 1e-5;
  return request;
}

/// Returns the request with these incidences instead of automatically chosen ones.
RreSettings fixed(RreSettings request, std::vector<double> incidence_deg) {
  request.incidence_spans.clear();
  request.incidence_deg = std::move(incidence_deg);
  return request;
}

std::vector<double> grid(double low, double high, double step) {
  std::vector<double> places;
  for (double place = low; place <= high + 1e-9; place += step) places.push_back(place);
  return places;
}

/// Returns the RRE by linear interpolation between the neighbouring points.
/// \pre the points have one design, one azimuth and one cone
double line_at(const std::vector<RrePoint>& points, double incidence_deg) {
  const auto right =
      std::find_if(points.begin(), points.end(), [&](const RrePoint& p) { return p.incidence_deg >= incidence_deg; });
  if (right == points.begin()) return right->rre;
  const auto left = std::prev(right);
  const double share = (incidence_deg - left->incidence_deg) / (right->incidence_deg - left->incidence_deg);
  return (1.0 - share) * left->rre + share * right->rre;
}

/// Expects that linear interpolation between the chosen points agrees with a dense curve.
/// \return number of chosen points
std::size_t expect_followed(const design::Design& given, RreSettings request, double step_deg) {
  const CurveSpan span = request.incidence_spans.front();
  const RreResult curve = RreStudy({given}, request).run();
  const RreResult dense = RreStudy({given}, fixed(request, grid(span.low, span.high, step_deg))).run();
  EXPECT_TRUE(curve.complete);
  EXPECT_TRUE(std::is_sorted(curve.points.begin(), curve.points.end(),
                             [](const RrePoint& a, const RrePoint& b) { return a.incidence_deg < b.incidence_deg; }));
  EXPECT_EQ(curve.points.front().incidence_deg, span.low);
  EXPECT_EQ(curve.points.back().incidence_deg, span.high);
  for (const RrePoint& p : dense.points)
    EXPECT_NEAR(line_at(curve.points, p.incidence_deg), p.rre, 1.2e-3 + 3.0 * p.std_error) << p.incidence_deg;
  return curve.points.size();
}

/// The knee is the incidence at which total reflection ends. Beyond it, the curve of infinite arrays of prisms has
/// features narrower than 0.6 degrees. An equally spaced grid that is as accurate at the knee would have 1300 points.
TEST(AdaptiveCurve, FollowsPrismsPastTheirKnee) {
  EXPECT_LT(expect_followed(prisms(), chosen(-2, 11, raytrace::Engine::exact), 0.05), 350U);
}

TEST(AdaptiveCurve, FollowsPrismsAtAnObliqueAzimuth) {
  RreSettings request = chosen(-5, 40, raytrace::Engine::exact);
  request.azimuth_deg = {25.0};
  request.target_error = 1e-4;
  expect_followed(prisms(), request, 0.25);
}

TEST(AdaptiveCurve, FollowsASinglePrism) {
  expect_followed(single_prism(), chosen(-5, 40, raytrace::Engine::exact), 0.2);
}

TEST(AdaptiveCurve, FollowsAHoneycomb) {
  RreSettings request = chosen(-26, -18, raytrace::Engine::montecarlo);
  request.target_error = 5e-4;
  expect_followed(honeycomb(), request, 0.25);
}

/// Closed form: at the facet with the smaller angle of incidence, this angle is 45 degrees minus the angle of
/// refraction inside the plate.
TEST(AdaptiveCurve, KneeOfPrismsIsWhereTotalReflectionEnds) {
  const double limit_deg =
      std::asin(kIndex * std::sin(std::numbers::pi / 4.0 - std::asin(1.0 / kIndex))) / testing::kDeg;
  const RreResult curve = RreStudy({prisms()}, chosen(0, 20, raytrace::Engine::exact)).run();
  // The steepest fall of the curve begins at the knee.
  double steepest = 0.0;
  double knee_deg = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const RrePoint& left = curve.points[i - 1];
    const RrePoint& right = curve.points[i];
    const double slope = (left.rre - right.rre) / (right.incidence_deg - left.incidence_deg);
    if (slope > steepest) knee_deg = left.incidence_deg;
    steepest = std::max(steepest, slope);
  }
  EXPECT_NEAR(knee_deg, limit_deg, 0.01);
  EXPECT_GT(steepest, 1.0) << "per degree";
}

TEST(AdaptiveCurve, KinksOfPrismsComeInPairsAboutTheNormal) {
  const double limit_deg =
      std::asin(kIndex * std::sin(std::numbers::pi / 4.0 - std::asin(1.0 / kIndex))) / testing::kDeg;
  const auto edges = design::total_reflection_edges_deg(prisms().part(), kIndex, 1.0, Angle{});
  ASSERT_FALSE(edges.empty());
  for (const double edge : edges) EXPECT_NEAR(std::abs(edge), limit_deg, 1e-9);
  EXPECT_NEAR(edges.front(), -edges.back(), 1e-12);
}

/// All azimuths of a design share the chosen incidences, and each design has its own. The values equal those for a list
/// of the same incidences, with any number of threads.
TEST(AdaptiveCurve, ValuesAreThoseOfAList) {
  RreSettings request = chosen(2, 6, raytrace::Engine::montecarlo);
  request.azimuth_deg = {30.0, 0.0};
  request.rays = 4096;
  request.incidence_deg = {15.0, 2.3};
  // Only the first design has its knee in this range.
  const std::vector<std::string> denser = {"body.refractive_index=1.6"};
  const std::string endless = text("kind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5", "extent = \"infinite\"");
  const std::vector<design::Design> designs = {prisms(), design::parse_design(endless, "e.toml", denser)};
  RreResult curve = RreStudy(designs, request).run();
  const auto angles_of = [&](std::size_t d, double azimuth_deg) {
    std::vector<double> places;
    for (const RrePoint& p : curve.points)
      if (p.design == d && p.azimuth_deg == azimuth_deg) places.push_back(p.incidence_deg);
    return places;
  };
  EXPECT_NE(angles_of(0, 30.0), angles_of(1, 30.0));
  for (std::size_t d = 0; d < designs.size(); ++d) {
    const std::vector<double> places = angles_of(d, 30.0);
    EXPECT_EQ(angles_of(d, 0.0), places);
    EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
    EXPECT_EQ(std::count(places.begin(), places.end(), 2.3), 1);
    EXPECT_EQ(places.back(), 15.0);
    const RreResult list = RreStudy({designs[d]}, fixed(request, places)).run();
    std::vector<double> values;
    for (const RrePoint& p : curve.points)
      if (p.design == d) values.push_back(p.rre);
    ASSERT_EQ(list.points.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(list.points[k].rre, values[k]);
    const RreResult own = RreStudy({designs[d]}, request).run();
    EXPECT_EQ(own.points.size(), values.size()) << "the points do not depend on other designs";
  }
  RreResult alone;
  run_with_threads(1, [&] { alone = RreStudy(designs, request).run(); });
  curve.elapsed_s = alone.elapsed_s = 0.0;
  EXPECT_EQ(rre_json(curve), rre_json(alone));
}

bool is_called_coarse(const RreResult& result) {
  return std::ranges::count(result.warnings, "curve_coarse", &Warning::id) > 0;
}

/// The curve of prisms has a knee at 4.3 degrees.
TEST(AdaptiveCurve, CoarseListsAreCalledCoarse) {
  RreSettings request = chosen(0, 20, raytrace::Engine::exact);
  const RreResult resolved = RreStudy({prisms()}, request).run();
  EXPECT_FALSE(is_called_coarse(resolved));
  EXPECT_TRUE(is_called_coarse(RreStudy({prisms()}, fixed(request, grid(0.0, 20.0, 4.0))).run()));
  EXPECT_FALSE(is_called_coarse(RreStudy({prisms()}, fixed(request, {0.0, 4.0, 8.0})).run())) << "no curve";
  EXPECT_FALSE(is_called_coarse(RreStudy({prisms()}, fixed(request, grid(1.0, 2.0, 0.25))).run())) << "a smooth part";
}

class Watch : public Progress {
 public:
  void at(double share) override {
    EXPECT_GE(share, last);
    last = share;
    if (share > 0.9 && cancel != nullptr) cancel->request();
  }
  double last = 0.0;
  Cancellation* cancel = nullptr;
};

TEST(AdaptiveCurve, InterruptedRunKeepsWhatIsFinishedInOrder) {
  Cancellation cancel;
  Watch watch;
  watch.cancel = &cancel;
  const RreResult result = RreStudy({prisms()}, chosen(-12, 12, raytrace::Engine::exact)).run(&watch, &cancel);
  EXPECT_FALSE(result.complete);
  EXPECT_GT(result.points.size(), 10U);
  EXPECT_LT(watch.last, 1.0);
}

TEST(AdaptiveCurve, FootprintsAndFarFieldsFollowThePoints) {
  RreSettings request = chosen(-6, -3, raytrace::Engine::exact);
  request.footprint = request.far_field = request.derivatives = true;
  const RreResult result = RreStudy({prisms()}, request).run();
  ASSERT_EQ(result.returned.size(), result.points.size());
  for (std::size_t i = 0; i < result.points.size(); ++i)
    EXPECT_EQ(result.returned[i].at.incidence_deg, result.points[i].incidence_deg);
}

/// Returns all points that `curve` requests for a known function, without a tracer.
template <typename Function>
std::vector<double> places_for(AdaptiveCurve& curve, const Function& f) {
  std::vector<double> all;
  for (auto places = curve.next(); !places.empty(); places = curve.next())
    for (const double place : places) {
      all.push_back(place);
      curve.add(place, f(place));
    }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(AdaptiveCurve, NoPlaceIsLookedAtTwice) {
  AdaptiveCurve curve({{-10, 5}, {0, 20}, {30, 31}}, {1.0, 1.0 + 1e-9}, {3, 40, 0}, 1e-3);
  const auto places = places_for(curve, [](double x) { return CurveValue{std::sqrt(std::abs(x - 1.0)), 0.0}; });
  EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
  for (const double place : {-10.0, 0.0, 1.0, 3.0, 20.0, 30.0, 31.0, 40.0})
    EXPECT_TRUE(std::binary_search(places.begin(), places.end(), place)) << place;
  EXPECT_EQ(std::count_if(places.begin(), places.end(), [](double x) { return x > 20.0 && x < 30.0; }), 0);
  EXPECT_EQ(curve.residual_error(), 0.0);
}

/// A function with 100 steps requires more points than allowed. The search ends and reports the remaining error.
TEST(AdaptiveCurve, EndsAtTheMostPlacesAndSaysWhatIsLeft) {
  AdaptiveCurve curve({{0, 100}}, {}, {}, 1e-3);
  const auto places = places_for(curve, [](double x) { return CurveValue{std::floor(x + 0.05) / 100.0, 0.0}; });
  EXPECT_EQ(places.size(), AdaptiveCurve::kMaxPoints);
  EXPECT_GE(curve.residual_error(), 5e-4);
}

TEST(AdaptiveCurve, NoiseIsNotFollowed) {
  AdaptiveCurve curve({{0, 20}}, {}, {}, 1e-3);
  const auto places = places_for(curve, [](double x) { return CurveValue{0.01 * std::sin(1e4 * x), 0.01}; });
  EXPECT_EQ(places.size(), 33U);  // end points of eight intervals, each of which is halved two times
}

}  // namespace
}  // namespace retrace::studies::adaptive_curve_test
