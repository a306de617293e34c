// Tests of derivatives of RRE with respect to parameters of a design: closed forms, symmetry, and cases without a
// derivative.
#include "studies/rre/derivatives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "core/error.h"
#include "geometry/elements/element_cells.h"
#include "studies/rre/rre.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"

namespace retrace::studies::derivatives_test {
namespace {

using namespace geometry;
using namespace testing;

design::Design design_of(const PartSpec& part, double index = kPmma) {
  design::Design design;
  design.source = "test.toml";
  design.part() = part;
  design.substance.refractive_index = index;
  design.substance.absorption_per_mm = 0.0;
  return design;
}

design::Design idealised(design::Design design) {
  design.idealisation = {true, true};
  return design;
}

RreSettings exactly(double incidence_deg, double azimuth_deg = 0.0) {
  RreSettings request;
  request.incidence_deg = {incidence_deg};
  request.azimuth_deg = {azimuth_deg};
  request.engine = raytrace::Engine::exact;
  request.derivatives = true;
  return request;
}

RrePoint point_of(const design::Design& design, const RreSettings& request) {
  return RreStudy({design}, request).run().points.at(0);
}

RreDerivative by(RreParameter parameter, const RrePoint& point) {
  for (const RreDerivative& derivative : point.derivatives)
    if (derivative.parameter == parameter) return derivative;
  ADD_FAILURE() << parameter_name(parameter) << " is missing";
  return {};
}

/// Returns the reason why a derivative is missing, and records its text. Returns nothing if the derivative exists.
std::optional<NoDerivative> reason(RreParameter parameter, const RrePoint& point) {
  const std::optional<NoDerivative> found = by(parameter, point).missing_reason;
  if (found) record_message(text_of(*found));
  return found;
}

/// Expects a derivative within the tolerance and within the reported error.
void expect_derivative(const RrePoint& point, RreParameter parameter, double expected, double tolerance = 1e-6) {
  const RreDerivative found = by(parameter, point);
  EXPECT_EQ(found.missing_reason, std::nullopt) << parameter_name(parameter);
  const double error = std::abs(found.derivative.value - expected);
  EXPECT_LE(error, tolerance) << parameter_name(parameter);
  EXPECT_LE(error, found.derivative.error) << parameter_name(parameter);
}

/// Returns the derivative of a closed form from differences of sixth order. Their error is about 1e-11 in these tests.
double slope(const std::function<double(double)>& f, double x, double step = 2e-3) {
  const auto difference = [&](double k) { return (f(x + k * step) - f(x - k * step)) / (2.0 * k * step); };
  return 1.5 * difference(1) - 0.6 * difference(2) + 0.1 * difference(3);
}

PartSpec brick(double base_mm) {
  PartSpec spec = finite(RtpElement{base_mm, base_mm, 90.0}, Arrangement::offset, 10.0, 10.0, 2.0);
  spec.array.shifted_rows = RowParity::odd;
  return spec;
}

// Compares with derivatives of the closed form RRE = f + (1 - f) 2R / (1 + R), with 2R / (1 + R) = (n - 1)^2 / (n^2 +
// 1). f is the fraction of the area with whole elements, and R the reflectance of the entrance face.
TEST(RreDerivatives, IndexOfABrickArray) {
  for (const double base : {5.0, 2.0}) {
    const design::Design design = design_of(brick(base));
    const double full = base == 5.0 ? 3.0 / 4.0 : 22.0 / 25.0;
    const double n2 = kPmma * kPmma;
    const double by_index = (1.0 - full) * 2.0 * (n2 - 1.0) / ((n2 + 1.0) * (n2 + 1.0));
    const RrePoint point = point_of(design, exactly(0.0));
    expect_derivative(point, RreParameter::refractive_index, by_index);
    expect_derivative(point, RreParameter::thickness_mm, 0.0);
    EXPECT_EQ(reason(RreParameter::size_mm, point), NoDerivative::count_changes);
  }
}

TEST(RreDerivatives, IndexAndIncidenceOfAnIdealHoneycomb) {
  design::Design design = idealised(design_of(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0)));
  design.detector.acceptance_half_angle_deg = {0.01};
  for (const auto& [t, p] : {std::pair{10.0, 10.0}, {30.0, 10.0}, {30.0, 47.0}, {-50.0, 25.0}, {70.0, 100.0}}) {
    const RrePoint point = point_of(design, exactly(t, p));
    expect_derivative(point, RreParameter::incidence_deg,
                      slope([&, p = p](double x) { return honeycomb_rre(x, p, kPmma); }, t));
    expect_derivative(point, RreParameter::refractive_index,
                      slope([&, t = t, p = p](double x) { return honeycomb_rre(t, p, x); }, kPmma));
    expect_derivative(point, RreParameter::thickness_mm, 0.0);
    expect_derivative(point, RreParameter::size_mm, 0.0);
  }
}

// Compares with derivatives of the closed form RRE = 2 - (4/3) / cos^2 t', which is valid up to t' = 19.47 degrees at
// any azimuth. t' is the angle of refraction inside the plate.
TEST(RreDerivatives, IncidenceOfAnIdealTriangularArray) {
  design::Design design = idealised(design_of(infinite(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0)));
  design.detector.acceptance_half_angle_deg = {0.01};
  for (const double t : {0.0, 12.0, -12.0}) {
    const double c = cos_inner(t, kPmma);
    const double s = std::sin(t * kDeg);
    const double by_sine2 = -4.0 / 3.0 / (c * c * c * c * kPmma * kPmma);
    const RrePoint point = point_of(design, exactly(t, 20.0));
    expect_derivative(point, RreParameter::incidence_deg, by_sine2 * 2.0 * s * std::cos(t * kDeg) * kDeg);
    expect_derivative(point, RreParameter::refractive_index, -by_sine2 * 2.0 * s * s / kPmma);
  }
}

// Compares with derivatives of the closed form RRE = exp(-a (2 h + base)), which holds for any width of the prism
// (docs/theory/closed_forms.md, section 5). a is the absorption and h the thickness of the plate.
TEST(RreDerivatives, ThicknessAndSizeOfAnAbsorbingPrism) {
  for (const double a : {0.01, 0.3, 2.0}) {
    design::Design design = idealised(design_of(single(RtpElement{0.6, 0.4, 90.0}, 0.7)));
    design.substance.absorption_per_mm = a;
    const RrePoint point = point_of(design, exactly(0.0));
    EXPECT_NEAR(point.rre, std::exp(-a * (2.0 * 0.7 + 0.6)), 1e-12);
    expect_derivative(point, RreParameter::thickness_mm, -2.0 * a * point.rre);
    expect_derivative(point, RreParameter::size_mm, -a * point.rre);
    expect_derivative(point, RreParameter::refractive_index, 0.0);
  }
}

// For incidence along the roof edge, RRE is an even function of the incidence. It is smooth until light leaves the
// cone.
TEST(RreDerivatives, VanishesBySymmetry) {
  design::Design design = design_of(infinite(RtpElement{1.0, 1.0, 90.0}, Arrangement::aligned, 1.0));
  design.substance.absorption_per_mm = 0.05;
  expect_derivative(point_of(design, exactly(0.0, 90.0)), RreParameter::incidence_deg, 0.0);
  design = design_of(infinite(TriangularCube{1.0}, Arrangement::triangular, 0.7));
  design.substance.absorption_per_mm = 1.0;
  RreSettings request = exactly(0.0, 0.0);
  request.cutoff = 1e-8;
  EXPECT_NEAR(by(RreParameter::incidence_deg, point_of(design, request)).derivative.value, 0.0, 1e-5);
}

// The array is symmetric about x = 0. It therefore returns the same light for the incidences t and -t.
TEST(RreDerivatives, IsOddInTheIncidence) {
  design::Design design = design_of(infinite(RtpElement{1.0, 1.0, 90.0}, Arrangement::aligned, 1.0));
  design.substance.absorption_per_mm = 0.5;  // limits the number of beams by absorbing light on long paths
  const RreDerivative from_right = by(RreParameter::incidence_deg, point_of(design, exactly(23.0)));
  const RreDerivative from_left = by(RreParameter::incidence_deg, point_of(design, exactly(-23.0)));
  ASSERT_FALSE(from_right.missing_reason || from_left.missing_reason);
  EXPECT_NEAR(from_right.derivative.value, -from_left.derivative.value,
              from_right.derivative.error + from_left.derivative.error);
  EXPECT_GT(std::abs(from_right.derivative.value), 1e-4);
}

/// Expects that RRE does not change if size and thickness are multiplied by a common factor.
void expect_in_proportion(const RrePoint& point, double size_mm, double thickness_mm) {
  const RreDerivative size = by(RreParameter::size_mm, point);
  const RreDerivative thickness = by(RreParameter::thickness_mm, point);
  ASSERT_FALSE(size.missing_reason || thickness.missing_reason);
  EXPECT_NEAR(size_mm * size.derivative.value + thickness_mm * thickness.derivative.value, 0.0,
              size_mm * size.derivative.error + thickness_mm * thickness.derivative.error);
  EXPECT_GT(std::abs(size.derivative.value), 1e-3);
}

// RRE has no length scale. If all lengths of a transparent part are multiplied by one factor, RRE does not change.
TEST(RreDerivatives, SizeAndThicknessAreInProportion) {
  const design::Design design = design_of(single(RtpElement{0.45, 0.6, 90.0}, 0.5));
  const RrePoint point = point_of(design, exactly(-11.0, 20.0));
  expect_in_proportion(point, 0.45, 0.5);
}

// All light passes the plate of thickness h perpendicularly, two times. RRE is therefore exp(-2 a h) times a factor
// that does not depend on h.
TEST(RreDerivatives, ThicknessAboveCantedCubes) {
  for (const double cant_deg : {4.0, 12.0}) {
    design::Design design =
        idealised(design_of(infinite(HexagonalCube{1.0, {cant_deg, 25.0}}, Arrangement::honeycomb, 0.9)));
    design.substance.absorption_per_mm = 0.3;
    const RrePoint point = point_of(design, exactly(0.0));
    EXPECT_GT(point.rre, 0.2);
    expect_derivative(point, RreParameter::thickness_mm, -2.0 * 0.3 * point.rre);
  }
}

TEST(RreDerivatives, SizeAndThicknessOfACantedCubeAreInProportion) {
  const design::Design design = idealised(design_of(single(TriangularCube{0.8, {7.0, 40.0}}, 0.5)));
  const RrePoint point = point_of(design, exactly(8.0, 70.0));
  expect_in_proportion(point, 0.8, 0.5);
}

// The highest rim of the canted cube corners almost touches the entrance face. Parts with thinner plates or larger cube
// corners are therefore invalid.
TEST(RreDerivatives, EndAtPartsThatCannotBeBuilt) {
  const HexagonalCube cube{1.0, {10.0, 0.0}};
  const double top_mm = element_top_mm(cube, {});
  const design::Design design = idealised(design_of(infinite(cube, Arrangement::honeycomb, top_mm * (1.0 + 1e-7))));
  const RrePoint point = point_of(design, exactly(0.0));
  EXPECT_EQ(reason(RreParameter::size_mm, point), NoDerivative::count_changes) << "larger parts have no elements";
}

TEST(RreDerivatives, ApexAngleAgainstRoughDifferences) {
  design::Design design = design_of(infinite(RtpElement{1.0, 1.0, 90.02}, Arrangement::aligned, 1.0));
  const auto rre = [&](double apex) {
    std::get<RtpElement>(design.part().element).apex_angle_deg = apex;
    return point_of(design, exactly(3.0)).rre;
  };
  const double rough = (rre(90.0201) - rre(90.0199)) / 0.0002;
  rre(90.02);
  expect_derivative(point_of(design, exactly(3.0)), RreParameter::apex_angle_deg, rough, 1e-4);
}

TEST(RreDerivatives, DihedralErrorAgainstRoughDifferences) {
  design::Design design = idealised(design_of(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.7)));
  const auto rre = [&](double arcmin) {
    design.part().angle_errors.dihedral_error_arcmin = {1.0 + arcmin, 2.0 + arcmin, 3.0 + arcmin};
    return point_of(design, exactly(25.0, 10.0)).rre;
  };
  const double rough = (rre(0.003) - rre(-0.003)) / 1e-4;
  rre(0.0);
  expect_derivative(point_of(design, exactly(25.0, 10.0)), RreParameter::dihedral_error_deg, rough, 1e-4);
  EXPECT_GT(std::abs(rough), 1e-3);
}

// The knee is the incidence at which total reflection ends. Beyond it, RRE falls like the square root of the angle to
// the knee, so that there is no derivative at the knee.
TEST(RreDerivatives, KneeOfTotalReflectionIsLeftOut) {
  const design::Design design = design_of(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  const double knee = std::asin(kPmma * std::sin(45.0 * kDeg - std::asin(1.0 / kPmma))) / kDeg;
  EXPECT_NEAR(knee, 4.33, 0.01);
  for (const double at : {knee, knee + 1e-6, -knee, -knee - 1e-6})
    EXPECT_EQ(reason(RreParameter::incidence_deg, point_of(design, exactly(at))), NoDerivative::not_smooth) << at;
  for (const double at : {knee - 1.0, knee + 1.0})
    EXPECT_EQ(reason(RreParameter::incidence_deg, point_of(design, exactly(at))), std::nullopt) << at;
}

// Light that is tilted to either side of the normal is lost through the sides of the single prism. RRE therefore has a
// kink at normal incidence, and no derivative.
TEST(RreDerivatives, KinkAtNormalIncidenceIsLeftOut) {
  const design::Design design = design_of(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  EXPECT_EQ(reason(RreParameter::incidence_deg, point_of(design, exactly(0.0))), NoDerivative::not_smooth);
}

// Tests that the reported errors of derivatives cover the effect of the cut-off. The reference derivatives are computed
// with a negligible cut-off.
TEST(RreDerivatives, ErrorEstimateCoversTheCutOff) {
  design::Design prism = design_of(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  design::Design prisms = design_of(infinite(RtpElement{1.0, 1.0, 90.0}, Arrangement::aligned, 1.0));
  design::Design cubes = design_of(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.7));
  prism.substance.absorption_per_mm = 0.01;
  prisms.substance.absorption_per_mm = 0.5;
  cubes.substance.absorption_per_mm = 3.0;
  int given = 0;
  int covered = 0;
  for (const design::Design& design : {prism, prisms, cubes})
    for (const auto& [t, p] : {std::pair{-11.0, 20.0}, {7.0, 50.0}, {23.0, 5.0}, {31.0, 80.0}}) {
      RreSettings request = exactly(t, p);
      request.cutoff = 1e-11;
      const RrePoint fine = point_of(design, request);
      for (const double cutoff : {1e-6, 1e-7, 1e-8, 1e-9}) {
        request.cutoff = cutoff;
        const RrePoint coarse = point_of(design, request);
        for (std::size_t k = 0; k < fine.derivatives.size(); ++k) {
          const RreDerivative& at_cutoff = coarse.derivatives[k];
          const Derivative& found = at_cutoff.derivative;
          const Derivative& expected = fine.derivatives[k].derivative;
          if (at_cutoff.missing_reason || fine.derivatives[k].missing_reason) continue;
          const double ratio = std::abs(found.value - expected.value) / (found.error + expected.error);
          ++given;
          covered += ratio <= 1.0 ? 1 : 0;
          EXPECT_LE(ratio, 3.0) << parameter_name(at_cutoff.parameter) << " at " << t << ", " << p << ", cut-off "
                                << cutoff;
        }
      }
    }
  EXPECT_GE(given, 60);
  EXPECT_GE(covered, given - 2);
}

TEST(RreDerivatives, CutOffThatHidesThemIsSaid) {
  const design::Design design = design_of(infinite(TriangularCube{1.0}, Arrangement::triangular, 0.7));
  RreSettings request = exactly(20.0, 10.0);
  request.cutoff = 1e-3;
  EXPECT_EQ(reason(RreParameter::incidence_deg, point_of(design, request)), NoDerivative::truncated_power);
}

TEST(RreDerivatives, AtTheEndsOfARangeOneSideServes) {
  design::Design design =
      idealised(design_of(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0), 1.0));
  design.detector.acceptance_half_angle_deg = {0.01};
  expect_derivative(point_of(design, exactly(15.0, 10.0)), RreParameter::refractive_index,
                    slope([](double n) { return honeycomb_rre(15.0, 10.0, n); }, 1.0));
  design.substance.refractive_index = kPmma;
  expect_derivative(point_of(design, exactly(89.99, 100.0)), RreParameter::incidence_deg,
                    slope([](double t) { return honeycomb_rre(t, 100.0, kPmma); }, 89.99), 1e-6);
}

TEST(RreDerivatives, OneACone) {
  design::Design design = idealised(design_of(single(RtpElement{0.6, 0.4, 90.0}, 0.7)));
  design.substance.absorption_per_mm = 0.3;
  design.detector.acceptance_half_angle_deg = {0.5, 2.0};
  const RreResult result = RreStudy({design, design}, exactly(0.0)).run();
  ASSERT_EQ(result.points.size(), 4U);
  for (const RrePoint& point : result.points) expect_derivative(point, RreParameter::thickness_mm, -0.6 * point.rre);
}

TEST(RreDerivatives, NeedTheExactEngine) {
  RreSettings request = exactly(0.0);
  request.engine = raytrace::Engine::montecarlo;
  EXPECT_THROW(RreStudy({design_of(brick(5.0))}, request), InputError);
}

TEST(RreDerivatives, CancelledRunsHoldNoPoint) {
  Cancellation cancel;
  cancel.request();
  const RreResult result = RreStudy({design_of(brick(5.0))}, exactly(0.0)).run(nullptr, &cancel);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.points.empty());
}

}  // namespace
}  // namespace retrace::studies::derivatives_test
