// Tests of polar maps of RRE: symmetries, means, interpolation, and grids that are refused.
#include "studies/rre/rre_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/rre/rre_request.h"
#include "tests/support/cancel_at.h"

namespace retrace::testing::rre_map_test {
namespace {

using namespace retrace::studies;

/// Returns a design of an infinite part.
/// \param sizes lines with the sizes of the element
/// \param more tables to add
std::string infinite_design(const std::string& kind, const std::string& sizes, const std::string& more = "") {
  return "[element]\nkind = \"" + kind + "\"\n" + sizes + "[array]\nextent = \"infinite\"\n" + more +
         "[body]\nthickness_mm = 2\nrefractive_index = 1.49\n";
}

std::string cubes(const std::string& kind, const std::string& more = "") {
  return infinite_design(kind, "aperture_mm = 1\n", more);
}

RreResult run(const std::string& text, const RreRequest& request) {
  return RreStudy({design::parse_design(text, "design")}, resolve(request)).run();
}

RreRequest map_request(std::vector<double> incidence_deg, std::vector<double> azimuth_deg) {
  RreRequest request;
  request.map = true;
  request.incidence_deg = std::move(incidence_deg);
  request.azimuth_deg = std::move(azimuth_deg);
  request.engine = "exact";
  request.target_error = 1e-5;
  return request;
}

std::vector<double> steps(double last, double step) {
  std::vector<double> values;
  for (double value = 0.0; value <= last; value += step) values.push_back(value);
  return values;
}

struct Shared {
  std::string name;
  std::string design;
  std::size_t traced;  ///< number of directions that are traced
};

/// Directions that share one trace have the values that they have if each is traced on its own. At an incidence of 0,
/// all azimuths are one direction. The number of traced directions at the other incidence is the number of orbits of 12
/// azimuths, 0 to 330 degrees in steps of 30: {0, 120, 240}, {60, 180, 300} and one of the others for rotations by 120
/// degrees with the reflection of y; 2 for all symmetries of a hexagon; 4 for both reflections; 7 for one reflection.
TEST(RreMap, SharesSymmetricDirections) {
  const std::vector<Shared> all = {
      {"honeycomb", cubes("hexagonal_icc"), 1 + 3},
      {"triangular cubes", cubes("triangular_icc"), 1 + 2},
      {"prisms", infinite_design("rtp", "base_mm = 0.5\nwidth_mm = 0.5\n"), 1 + 4},
      {"dihedral errors", cubes("hexagonal_icc", "[surface]\ndihedral_error_arcmin = [2, 3, 3]\n"), 1 + 7},
      {"light that is polarised along x", cubes("hexagonal_icc", "[light]\npolarisation = [1, 0.5, 0, 0]\n"), 1 + 7},
      {"obliquely polarised light", cubes("hexagonal_icc", "[light]\npolarisation = [1, 0, 0.5, 0]\n"), 1 + 12}};
  for (const Shared& shared : all) {
    RreRequest request = map_request({0.0, 11.0}, steps(350.0, 30.0));
    const RreResult map = run(shared.design, request);
    EXPECT_EQ(map.traced_directions, shared.traced) << shared.name;
    request.map = false;
    const RreResult each = run(shared.design, request);
    ASSERT_EQ(map.points.size(), each.points.size());
    for (std::size_t k = 0; k < each.points.size(); ++k) {
      const RrePoint& a = map.points[k];
      const RrePoint& b = each.points[k];
      EXPECT_EQ(a.incidence_deg, b.incidence_deg);
      EXPECT_EQ(a.azimuth_deg, b.azimuth_deg);
      // Beams below the cut-off power are truncated, in different numbers for equivalent directions.
      EXPECT_NEAR(a.rre, b.rre, 1e-5) << shared.name << " at " << b.incidence_deg << ", " << b.azimuth_deg;
      for (std::size_t s = 0; s < 4; ++s) EXPECT_NEAR(a.stokes.values()[s], b.stokes.values()[s], 1e-5) << shared.name;
      for (std::size_t account = 0; account < raytrace::kAccountCount; ++account)
        EXPECT_NEAR(a.ledger.power[account], b.ledger.power[account], 2e-5) << shared.name;
    }
  }
}

/// The rays of equivalent directions are counted one time.
TEST(RreMap, CountsTracedDirectionsOneTime) {
  RreRequest request = map_request({0.0, 20.0}, steps(350.0, 60.0));
  request.engine = "montecarlo";
  request.target_error = std::nullopt;
  request.samples = 64;
  const RreResult map = run(cubes("hexagonal_icc"), request);
  ASSERT_EQ(map.points.size(), 12U);
  EXPECT_EQ(map.traced_directions, 1U + 2U);
  RreRequest one = request;
  one.map = false;
  one.incidence_deg = {20.0};
  one.azimuth_deg = {0.0};
  EXPECT_EQ(map.rays, map.traced_directions * run(cubes("hexagonal_icc"), one).rays);
}

TEST(RreMap, CancelledRunsHaveNoMaps) {
  CancelAt progress(0.0);
  const RreResult result = RreStudy({design::parse_design(cubes("hexagonal_icc"), "design")},
                                    resolve(map_request({0.0, 30.0, 60.0}, steps(350.0, 10.0))))
                               .run(&progress, &progress.cancel);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(rre_maps(result).empty());
  EXPECT_EQ(std::ranges::count(result.warnings, std::string_view("map_incomplete"), &Warning::id), 1);
}

/// Returns the value of the function 0.5 + 0.3 cos(2 azimuth) sin(incidence) + 0.1 cos(incidence).
double smooth(double incidence_deg, double azimuth_deg) {
  const double t = std::numbers::pi / 180.0 * incidence_deg;
  const double a = std::numbers::pi / 180.0 * azimuth_deg;
  return 0.5 + 0.3 * std::cos(2.0 * a) * std::sin(t) + 0.1 * std::cos(t);
}

RreMap map_of_function(double step_deg) {
  RreMap map;
  map.incidence_deg = steps(80.0, step_deg);
  map.azimuth_deg = steps(359.9, step_deg);
  for (const double azimuth : map.azimuth_deg)
    for (const double incidence : map.incidence_deg) map.rre.push_back(smooth(incidence, azimuth));
  map.std_error.assign(map.rre.size(), 0.01);
  return map;
}

/// The mean over the cap of 80 degrees is 0.5 + 0.1 times the mean of the cosine, (1 + cos 80 deg) / 2.
TEST(RreMap, HasTheMeanOverSolidAngle) {
  const double expected = 0.5 + 0.05 * (1.0 + std::cos(std::numbers::pi * 80.0 / 180.0));
  const double coarse = std::abs(map_of_function(10.0).mean() - expected);
  const double fine = std::abs(map_of_function(5.0).mean() - expected);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.3 * coarse);  // The error of linear interpolation decreases with the square of the step.
}

/// The error of linear interpolation in both angles is at most h^2 / 8 times the sum of the second derivatives, 1.2 and
/// 0.4. For steps of h = 5 degrees, it is at most 1.6e-3.
TEST(RreMap, InterpolatesBetweenDirections) {
  const RreMap map = map_of_function(5.0);
  for (const double incidence : {0.0, 3.0, 41.0, 80.0})
    for (const double azimuth : {-7.0, 0.0, 2.5, 123.0, 358.0, 361.0})
      EXPECT_NEAR(map.at(incidence, azimuth), smooth(incidence, azimuth), 2e-3) << incidence << ", " << azimuth;
  EXPECT_TRUE(std::isnan(map.at(80.1, 0.0)));
  const RreMap zero = difference(map, map);
  for (const double value : zero.rre) EXPECT_EQ(value, 0.0);
  EXPECT_NEAR(zero.std_error.front(), 0.01 * std::numbers::sqrt2, 1e-15);
}

/// The mean of a map of cube corners agrees with the mean over directions of a two-dimensional lattice that is uniform
/// in solid angle. The errors of both quadratures are below 1e-3.
TEST(RreMap, MeanAgreesWithOtherDirections) {
  const std::string design = cubes("hexagonal_icc");
  RreRequest request;
  request.map = true;
  request.incidence_deg = steps(40.0, 2.0);
  request.azimuth_deg = steps(357.0, 3.0);
  request.target_error = 1e-4;
  const double mean = rre_maps(run(design, request)).front().mean();
  double sum = 0.0;
  constexpr int kDirections = 300;
  for (int k = 0; k < kDirections; ++k) {
    const double cosine = 1.0 - (k + 0.5) / kDirections * (1.0 - std::cos(std::numbers::pi * 40.0 / 180.0));
    RreRequest one;
    one.incidence_deg = {180.0 / std::numbers::pi * std::acos(cosine)};
    one.azimuth_deg = {360.0 * std::fmod(k * std::numbers::phi, 1.0)};
    one.target_error = 1e-3;
    sum += run(design, one).points.front().rre;
  }
  EXPECT_NEAR(mean, sum / kDirections, 1e-3);
}

TEST(RreMap, GridsAreCompletedAndChecked) {
  RreRequest request;
  request.map = true;
  EXPECT_EQ(resolve(request).incidence_deg, steps(80.0, 5.0));
  EXPECT_EQ(resolve(request).azimuth_deg, steps(350.0, 10.0));
  request.azimuth_deg = {-90.0, 0.0, 90.0, 180.0, 270.0, 360.0};
  EXPECT_EQ(resolve(request).azimuth_deg, (std::vector<double>{0.0, 90.0, 180.0, 270.0}));
  const auto refused_field = [](const RreRequest& refused) -> std::string {
    try {
      resolve(refused);
    } catch (const InputError& error) {
      return std::string(error.field().name);
    }
    return "";
  };
  // A list with the single value 0 also counts as given.
  for (const std::vector<double>& too_few : {std::vector{0.0, 90.0, 180.0}, {30.0}, {0.0}}) {
    request.azimuth_deg = too_few;
    EXPECT_EQ(refused_field(request), "azimuth_deg");
  }
  request.azimuth_deg = {};
  for (const std::vector<double>& unsuitable : {std::vector{20.0}, {0.0}, {-10.0, 0.0, 10.0}}) {
    request.incidence_deg = unsuitable;
    EXPECT_EQ(refused_field(request), "incidence_deg");
  }
  request.incidence_deg = {};
  request.incidence_spans_deg = {{0.0, 20.0}};
  EXPECT_EQ(refused_field(request), "incidence_deg");
}

}  // namespace
}  // namespace retrace::testing::rre_map_test
