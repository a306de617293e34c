// Tests of maps of R_A over entrance and observation angle: geometry, agreement with single readings, symmetries,
// ratios, refused grids, cancelled runs, and documents.
#include "studies/photometry/coefficient_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/photometer.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/cancel_at.h"
#include "tests/support/closed_forms.h"
#include "tests/support/lines.h"
#include "tests/support/refusals.h"

namespace retrace::studies::coefficient_map_test {
namespace {

using namespace testing;
using namespace photometric_requests;
using Json = nlohmann::ordered_json;

/// Returns a request for maps of R_A.
/// \param grid grid that is not yet resolved
PhotometrySettings map_request(CoefficientGrid grid, const std::vector<double>& rotation_deg = {0.0}) {
  PhotometrySettings request = request_of(points_at({0.2, 0.5}, 1.0));
  request.engine = raytrace::Engine::exact;
  request.cutoff = 1e-6;
  request.diffraction = true;
  request.rotation_deg = rotation_deg;
  request.map_grid = resolve_grid(std::move(grid), request.window_deg);
  return request;
}

// The components of the entrance angle satisfy the relations of ASTM E808. A negative entrance angle is its magnitude
// at the presentation angle plus 180 degrees.
TEST(CoefficientMap, GeometryFollowsTheIntrinsicSystem) {
  for (const double entrance : {5.0, 30.0, 60.0})
    for (const double presentation : {-180.0, -90.0, -30.0, 0.0, 17.0, 90.0, 120.0, 180.0}) {
      const PhotometerSetting setting = setting_at(entrance, presentation, 0.0);
      const double beta1 = -setting.v_deg * kDeg;
      const double beta2 = -setting.h_deg * kDeg;
      EXPECT_NEAR(std::cos(entrance * kDeg), std::cos(beta1) * std::cos(beta2), 1e-12);
      EXPECT_NEAR(std::sin(beta2), std::sin(entrance * kDeg) * std::sin(presentation * kDeg), 1e-12);
      EXPECT_NEAR(std::tan(beta1), std::tan(entrance * kDeg) * std::cos(presentation * kDeg), 1e-12);
      if (presentation > 0.0) continue;
      const PhotometerSetting opposite = setting_at(-entrance, presentation + 180.0, 0.0);
      EXPECT_NEAR(opposite.v_deg, setting.v_deg, 1e-9);
      EXPECT_NEAR(opposite.h_deg, setting.h_deg, 1e-9);
    }
  EXPECT_EQ(setting_at(30.0, 0.0, 7.0).v_deg, -30.0) << "beta1 of standards for sheeting";
  EXPECT_EQ(setting_at(30.0, 90.0, 7.0).h_deg, -30.0);
  EXPECT_EQ(setting_at(30.0, 90.0, 7.0).rotation_deg, 7.0);
}

// Each value of a map equals a reading at the same geometry.
TEST(CoefficientMap, HasTheValuesOfSingleReadings) {
  const design::Design design = design_of(honeycomb(2.0));
  PhotometrySettings request = map_request({{4.0, 20.0}, {0.2, 0.5}, {0.0, 90.0}}, {0.0, 30.0});
  const PhotometryResult found = run(design, request);
  ASSERT_EQ(found.coefficient_maps.size(), 4U);
  EXPECT_EQ(found.map_directions, 8U);
  for (const CoefficientMap& map : found.coefficient_maps)
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t o = 0; o < 2; ++o) {
        PhotometrySettings single = request;
        single.map_grid.reset();
        single.rotation_deg = {map.rotation_deg};
        single.test_plan = points_at({map.observation_deg[o]}, 1.0);
        (map.presentation_deg == 0.0 ? single.test_plan.points[0].v_deg : single.test_plan.points[0].h_deg) =
            -map.entrance_deg[e];
        const PhotometricPoint point = run(design, single).points[0];
        const double r_a = map.r_a[map.index(e, o)];
        // Symmetric directions share one trace. The values differ slightly, because different weak beams are truncated.
        EXPECT_NEAR(r_a, point.r_a, 1e-4 * point.r_a) << map.presentation_deg << ", " << map.entrance_deg[e];
        EXPECT_GT(r_a, 0.0);
      }
}

// A honeycomb is symmetric under rotations by 120 degrees. At normal incidence, only one direction is traced for all
// rotations.
TEST(CoefficientMap, SymmetricDirectionsAreTracedOneTime) {
  const PhotometryResult found =
      run(design_of(honeycomb(2.0)), map_request({{0.0, 20.0}, {0.2, 0.5}, {}}, {0.0, 120.0, 240.0}));
  EXPECT_EQ(found.map_directions, 6U);
  EXPECT_EQ(found.traced_map_directions, 2U);
  const CoefficientMap& first = found.coefficient_maps.front();
  for (const CoefficientMap& map : found.coefficient_maps)
    for (std::size_t k = 0; k < map.r_a.size(); ++k) EXPECT_NEAR(map.r_a[k], first.r_a[k], 1e-4 * first.r_a[k]) << k;
}

TEST(CoefficientMap, RatiosOfEqualDesignsAreOne) {
  PhotometrySettings request = map_request({{0.0, 10.0}, {0.1, 0.3, 0.6}, {}});
  request.compared = ComparedDesign{design_of(honeycomb(2.0)), {}, {}};
  const PhotometryResult found = run(design_of(honeycomb(2.0)), request);
  ASSERT_EQ(found.coefficient_maps.size(), 2U);
  EXPECT_EQ(found.coefficient_maps[1].design, 1U);
  const std::vector<CoefficientMap> ratios = ratio_maps(found);
  ASSERT_EQ(ratios.size(), 1U);
  for (const double value : ratios[0].r_a) EXPECT_EQ(value, 1.0);
  CoefficientMap dark = found.coefficient_maps[0];
  dark.r_a.assign(dark.r_a.size(), 0.0);
  for (const double value : ratio(dark, found.coefficient_maps[0]).r_a) EXPECT_TRUE(std::isnan(value));
  for (const double value : ratio(found.coefficient_maps[0], dark).r_a) EXPECT_EQ(value, 0.0);
}

// The engine and the warnings of the compared design are checked like those of the first one.
TEST(CoefficientMap, ComparedDesignsAreChecked) {
  design::Design rough = design_of(honeycomb(2.0));
  rough.surface.texture = design::AbgTexture{.a = 1e-4, .b = 1e-2, .g = 2.0};
  PhotometrySettings request = map_request({{0.0, 10.0}, {0.1, 0.3}, {}});
  request.engine = raytrace::Engine::exact;
  request.compared = ComparedDesign{rough, {}, {}};
  EXPECT_EQ(refusal_of([&] { PhotometryStudy(design_of(honeycomb(2.0)), request); }), "engine");
  request.engine = raytrace::Engine::montecarlo;
  request.rays = 4096;
  const Warnings warnings = run(design_of(honeycomb(2.0)), request).warnings;
  EXPECT_EQ(std::ranges::count(warnings, "no_diffraction", &Warning::id), 2);
}

TEST(CoefficientMap, GridsAreCompletedAndChecked) {
  const CoefficientGrid usual = resolve_grid({}, 2.0);
  EXPECT_EQ(usual.entrance_deg.size(), 13U);
  EXPECT_EQ(usual.entrance_deg.back(), 60.0);
  EXPECT_EQ(usual.observation_deg.size(), 41U);
  EXPECT_EQ(usual.observation_deg.back(), 2.0);
  EXPECT_EQ(usual.presentation_deg, std::vector<double>{0.0});
  EXPECT_EQ(resolve_grid({{30.0, -4.0, 30.0}, {}, {}}, 2.0).entrance_deg, (std::vector<double>{-4.0, 30.0}));
  const auto refused_field = [](const CoefficientGrid& grid) -> std::string {
    try {
      resolve_grid(grid, 1.0);
    } catch (const InputError& error) {
      return std::string(error.field().name);
    }
    return "";
  };
  EXPECT_EQ(refused_field({{10.0}, {}, {}}), "map_entrance_deg");
  EXPECT_EQ(refused_field({{10.0, 10.0}, {}, {}}), "map_entrance_deg");
  EXPECT_EQ(refused_field({{}, {0.2}, {}}), "map_observation_deg");
  EXPECT_EQ(refused_field({{}, {0.2, 1.5}, {}}), "map_observation_deg");
}

TEST(CoefficientMap, CancelledRunsHaveNoMaps) {
  CancelAt progress(0.4);
  const PhotometryResult found =
      PhotometryStudy(design_of(honeycomb(2.0)), map_request({})).run(&progress, &progress.cancel);
  EXPECT_FALSE(found.complete);
  EXPECT_TRUE(found.coefficient_maps.empty());
  EXPECT_EQ(std::ranges::count(found.warnings, std::string_view("map_incomplete"), &Warning::id), 1);
  EXPECT_TRUE(coefficient_map_csv(found).empty());
  EXPECT_TRUE(coefficient_map_table(found).empty());
  EXPECT_FALSE(Json::parse(photometry_json(found)).contains("maps"));
}

// The JSON document contains R_A. The CSV file contains the quantity that the standard limits: R_I is R_A times the
// area.
TEST(CoefficientMap, DocumentsHoldTheValues) {
  PhotometryResult found;
  found.request = map_request({{0.0, 30.0}, {0.1, 0.2, 0.3}, {}});
  found.request.area_cm2 = 20.0;
  found.coefficient_maps = {
      {0, 0.0, 0.0, {0.0, 30.0}, {0.1, 0.2, 0.3}, {1.0, 2.0, 3.0, 4.0, 5.0, 0.0}, std::vector<double>(6, 0.5), false}};
  const Json json = Json::parse(photometry_json(found));
  EXPECT_EQ(json["map_quantity"], "r_a");
  EXPECT_EQ(json["maps"][0]["r_a_cd_per_lx_m2"], Json::parse("[[1.0, 2.0, 3.0], [4.0, 5.0, 0.0]]"));
  const std::vector<std::string> lines = lines_of(coefficient_map_csv(found));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0],
            "design,quantity,rotation_deg,presentation_deg,entrance_deg,observation_deg=0.1,observation_deg=0.2,"
            "observation_deg=0.3");
  EXPECT_EQ(lines[2], "0,r_a_cd_per_lx_m2,0,0,30,4,5,0");
  found.request.test_plan.points.front().unit = PhotometricUnit::mcd_per_lx;
  EXPECT_EQ(lines_of(coefficient_map_csv(found))[2], "0,r_i_mcd_per_lx,0,0,30,8,10,0");
  EXPECT_EQ(Json::parse(photometry_json(found))["map_quantity"], "r_i");
  EXPECT_TRUE(coefficient_ratio_csv(found).empty());
}

}  // namespace
}  // namespace retrace::studies::coefficient_map_test
