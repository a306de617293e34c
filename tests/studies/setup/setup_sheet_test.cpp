#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/machine/setup.h"
#include "report/page/setup_page.h"
#include "studies/setup/io/setup_files.h"
#include "studies/setup/setup_sheet.h"
#include "tests/support/prism_jobs.h"

// Tests of the sheet for setting up a machine. The effects of errors must equal those that the verifier finds, and the
// page must be complete.

namespace retrace::studies::setup_sheet_test {
namespace {

using namespace fabrication;

const std::string kJob = test::prism_job();

FabricationResult made(const std::string& job = kJob) {
  return test::planned(job);
}

const Sensitivity& row_of(const SetupSheet& sheet, const std::string& key) {
  const auto& rows = sheet.sensitivities.rows;
  return *std::find_if(rows.begin(), rows.end(), [&](const Sensitivity& row) { return row.quantity->key == key; });
}

/// Returns the result of the job's programs on a machine with errors.
Verification cut_on(const FabricationResult& result, const Machine& real) {
  return verify_programs(result.job, real, test::programs_of(result), {}, {});
}

TEST(SetupSheet, TheLargestErrorsComeFirst) {
  const SetupSheet sheet = setup_sheet(made(), false);
  ASSERT_EQ(sheet.sensitivities.kinds.size(), 4U);
  for (std::size_t k = 1; k < sheet.sensitivities.rows.size(); ++k)
    EXPECT_GE(sheet.sensitivities.rows[k - 1].largest_nm(), sheet.sensitivities.rows[k].largest_nm());
  // Facet 1 is cut at C = 0, so that a displacement of the center of C by 1 um does not shift it. Facet 2 is cut at C =
  // 180 degrees, where the workpiece is displaced by 2 um. This shifts facet 2 by sqrt(2) um along its normal.
  const Sensitivity& centre = row_of(sheet, "c_y_um");
  EXPECT_NEAR(centre.facets[0].distance_nm, 0.0, 1e-9);
  EXPECT_NEAR(centre.facets[1].distance_nm, 1000.0 * std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(row_of(sheet, "a_z_um").facets[1].distance_nm, 500.0 * std::numbers::sqrt2, 1e-9);
  EXPECT_FALSE(sheet.light.has_value());
}

/// A displacement of the tool along Z does not shift the plane of a cut, but shifts the end of the cut at the root.
/// Depending on the sign of the displacement, the cut ends above the other facet or gouges it.
TEST(SetupSheet, RootsAreWhatTheVerifierFinds) {
  const FabricationResult result = made();
  const SetupSheet sheet = setup_sheet(result, false);
  const Sensitivity& row = row_of(sheet, "tool_z_um");
  EXPECT_NEAR(row.root_residual_nm, 1000.0, 0.1);
  for (const double amount : {1.0, -1.0}) {
    const Verification v = cut_on(result, with_error(result.machine, *row.quantity, amount));
    double left_nm = 0.0;
    double cut_nm = 0.0;
    for (const ElementResult& element : v.elements)
      for (const FacetFigures& facet : element.figures.facets) {
        left_nm = std::max(left_nm, facet.root.nm);
        cut_nm = std::max(cut_nm, -facet.deepest.nm);
      }
    EXPECT_NEAR(amount > 0.0 ? left_nm : cut_nm, row.root_residual_nm, 0.03 * row.root_residual_nm);
  }
  // A tilted edge has one higher end and one lower end.
  const Sensitivity& level = row_of(sheet, "tool_rotation_y_arcsec");
  const double end_nm = 0.25e6 * std::numbers::pi / 648000.0;
  EXPECT_NEAR(level.root_residual_nm, end_nm, 1e-6);
  EXPECT_NEAR(level.root_cut_nm, end_nm, 1e-6);
}

/// If the cutting edge is displaced along the root, it cuts into a wall by the same amount, whatever the cause of the
/// displacement.
TEST(SetupSheet, WallsAreWhatTheVerifierFinds) {
  const FabricationResult result = made();
  const SetupSheet sheet = setup_sheet(result, false);
  for (const auto& [key, amount] : {std::pair{"z_lean_x_arcsec", 200.0},
                                    {"y_lean_x_arcsec", 200.0},
                                    {"tool_rotation_y_arcsec", 200.0},
                                    {"tool_x_um", 1.0}}) {
    const Sensitivity& row = row_of(sheet, key);
    EXPECT_GT(row.wall_nm, 1.0) << key;
    const Verification v = cut_on(result, with_error(result.machine, *row.quantity, amount));
    EXPECT_NEAR(v.wall_overcut_nm_max, amount * row.wall_nm, 0.2 * amount * row.wall_nm) << key;
  }
  EXPECT_NEAR(row_of(sheet, "tool_x_um").wall_nm, 1000.0, 1e-6);
  EXPECT_NEAR(row_of(sheet, "tool_z_um").wall_nm, 0.0, 1e-6);
}

/// During roughing, facet 2 is ploughed (cut along the root) in the pose of facet 1. An error of A leaves material on
/// facet 2, which the first finishing cut then removes.
TEST(SetupSheet, ChipsAreWhatTheVerifierFinds) {
  std::string job = kJob;
  const std::string roughing = "roughing_depth_um = 50";
  job.replace(job.find(roughing), roughing.size(), "roughing_depth_um = 5");
  const FabricationResult result = made(job);
  const SetupSheet sheet = setup_sheet(result, false);
  const Sensitivity& row = row_of(sheet, "a_z_um");
  EXPECT_NEAR(row.chip_nm, 1000.0, 1.0);
  constexpr double kLowerUm = 2.5;
  const Verification v = cut_on(result, with_error(result.machine, *row.quantity, -kLowerUm));
  EXPECT_NEAR(v.chip_um_max, result.job.process.finishing_depth_um + kLowerUm * 1e-3 * row.chip_nm, 0.005);
}

TEST(SetupSheet, SaysWhereTheProgramsGo) {
  const FabricationResult result = made();
  const SetupSheet sheet = setup_sheet(result, false);
  ASSERT_EQ(sheet.travel.size(), 5U);
  EXPECT_EQ(sheet.travel[2].high, result.machine.first_z_mm());
  EXPECT_EQ(sheet.travel[3].axis, 'A');
  EXPECT_EQ(sheet.travel[3].high, 45.0);
  for (const AxisTravel& axis : sheet.travel) {
    EXPECT_LE(axis.low, axis.high);
    EXPECT_TRUE(axis.limits.contains(axis.low) && axis.limits.contains(axis.high)) << axis.axis;
  }
  // The table rotates below the tool. At this radius, the face rises exactly to the limit of the clearance.
  const double radius = sheet.blank.free_radius_mm;
  const double up = radius * std::sin(Angle::from_deg(45.0).rad());
  EXPECT_NEAR(up + result.job.process.rotary_clearance_mm, result.plan.safe_z_mm, 1e-3);
  EXPECT_EQ(*sheet.blank.fixture_height_mm, 15.0);
}

/// The sheet gives the remaining stock on the facets and the depth of the root at the end of each stage of machining.
TEST(SetupSheet, SaysWhatToMeasureWhen) {
  const SetupSheet sheet = setup_sheet(made(), false);
  ASSERT_EQ(sheet.checks.front().stage, "roughing");
  EXPECT_EQ(sheet.checks.front().remaining_um, 10.0);
  EXPECT_NEAR(sheet.checks.front().root_depth_mm, 0.25 - std::numbers::sqrt2 * 0.010, 1e-12);
  EXPECT_EQ(sheet.checks.back().remaining_um, 0.0);
  EXPECT_NEAR(sheet.checks.back().root_depth_mm, 0.25, 1e-12);
  for (std::size_t k = 1; k < sheet.checks.size(); ++k) EXPECT_GT(sheet.checks[k].ends_s, sheet.checks[k - 1].ends_s);
}

/// If an error displaces facets of perfect prisms so that they no longer meet, there is a wall between them and the RRE
/// decreases. Errors that move no facet have no effect.
TEST(SetupSheet, LightChangesWhereFacetsMove) {
  const FabricationResult result = made();
  const SetupSheet sheet = setup_sheet(result);
  ASSERT_TRUE(sheet.light.has_value()) << sheet.why_no_light;
  EXPECT_EQ(sheet.warnings.size(), 1U) << "the design is not beside the job";
  EXPECT_NEAR(sheet.light->nominal.rre.front(), 1.0, 1e-5) << "words are rounded to a nanometre";
  EXPECT_GT(sheet.light->nominal.r_a, 0.0);
  const PartLight& centre = *sheet.change_of_light(*row_of(sheet, "c_y_um").quantity, Tilt::table);
  // The base is 500 um. With an error of 1 um, the rims of facet 2 are 1 um higher than the rims of the neighbours.
  EXPECT_LT(centre.rre.front(), -1e-3);
  EXPECT_GT(centre.rre.front(), -1e-2);
  const PartLight& clearance = *sheet.change_of_light(*row_of(sheet, "tool_rotation_x_arcsec").quantity, Tilt::table);
  EXPECT_EQ(clearance.rre.front(), 0.0);
  EXPECT_EQ(clearance.r_a, 0.0);
}

TEST(SetupSheet, APartThatIsCutDirectlyHasNoLight) {
  std::string job = kJob;
  job.replace(job.find("[element]"), 0, "[workpiece]\nkind = \"direct\"\n");
  const SetupSheet sheet = setup_sheet(made(job));
  EXPECT_FALSE(sheet.light.has_value());
  EXPECT_FALSE(sheet.why_no_light.empty());
}

TEST(SetupSheet, StopsAreTold) {
  std::string job = kJob;
  job.insert(job.find("[process]\n") + 10, "stop_before_finishing = true\n");
  job.insert(job.find("[tool]\n") + 7, "edge_life_mm = 1e6\n");
  const FabricationResult result = made(job);
  ASSERT_EQ(result.plan.stops.size(), 2U);  // rotated prisms are roughed in a stage of their own
  const SetupSheet sheet = setup_sheet(result, false);
  const nlohmann::ordered_json stops = setup_json(result, sheet)["stops"];
  ASSERT_EQ(stops.size(), 2U);
  EXPECT_EQ(stops[0]["reason"], "finishing");
  EXPECT_EQ(stops[0]["stage"], "finishing-1-facet-1");
  EXPECT_EQ(stops[0]["program"], "program.ngc");
  EXPECT_GT(stops[0]["at_s"], 20.0);
  EXPECT_GT(stops[0]["cut_mm"], 3.0);
  const std::string html = report::setup_html(report::setup_page(result, sheet, {}));
  for (const char* const text :
       {"Stops", "of finishing-1-facet-1", "Every program begins with an unused edge that can cut"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_EQ(report::setup_html(report::setup_page(made(), sheet, {})).find("stops.csv"), std::string::npos);
}

/// The page contains all sections and no scripts.
TEST(SetupSheet, ThePageSaysItAll) {
  const FabricationResult result = made();
  const SetupSheet sheet = setup_sheet(result);
  const std::string html = report::setup_html(report::setup_page(result, sheet, {}));
  EXPECT_EQ(html.find("<script"), std::string::npos);
  for (const char* const text :
       {"Four prisms", "1. Blank and fixture", "2. Tool", "3. Zero", "5. Control", "Needs: G54 without rotation",
        "6. Programs, in this order", "program.ngc", "7. What to measure, and when", "finishing-2-facet-2",
        "8. Effects of set-up errors", "centre of C along Y, um", "1414.2"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  const nlohmann::ordered_json json = setup_json(result, sheet);
  EXPECT_EQ(json["sensitivities"].size(), 17U);
  EXPECT_EQ(json["sensitivities"][0]["rre_change"].size(), 1U);
}

}  // namespace
}  // namespace retrace::studies::setup_sheet_test
