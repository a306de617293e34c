#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/edge_cuts.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/setup.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"

// Tests of programs that are planned for a machine without errors and cut on a machine with an error. For each quantity
// of the set-up, the changes of the facets that the verifier measures must agree with the changes that the derivatives
// predict.

namespace retrace::fabrication::test::setup_cuts_test {
namespace {

using geometry::Arrangement;
using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

/// A job with its programs, and the final cut of each facet.
struct Made {
  Job job;
  Machine taken_for;  ///< machine for which the programs are planned
  std::map<std::pair<std::size_t, std::size_t>, FacetEdgeCut>
      last;  ///< final cut of each facet; the key is the element and the facet
  std::vector<NcProgram> programs;
};

Made made(Job job, Machine taken_for) {
  Made result{std::move(job), std::move(taken_for), {}, {}};
  const Plan plan = make_plan(result.job, result.taken_for);
  for (const FacetEdgeCut& cut : facet_edge_cuts(result.job, plan)) result.last[{cut.element, cut.facet}] = cut;
  for (const Program& program : plan.programs)
    result.programs.push_back(parse_nc(nc_text(program, "rs274ngc"), "p.ngc", NcDialect::rs274ngc));
  return result;
}

Verification cut_on(const Made& made, const Machine& real) {
  return verify_programs(made.job, real, made.programs, {}, {});
}

/// Effect of an error on a facet, as predicted by the derivatives: the change of the height at the mean point of the
/// facet, and the changes of the slopes.
struct Effect {
  double height_nm = 0.0;
  double slope_up = 0.0;
  double slope_along = 0.0;
};

Effect predicted(const Made& made, const DesignElement& groove, const FacetEdgeCut& cut, const FacetFigures& figures,
                 const SetupQuantity& quantity, double amount) {
  const DesignFacet& design = groove.facets[cut.facet];
  const Vec3& level = design.along;
  const Vec3 there = groove.root_mm + figures.mean_up_mm * design.up_slope + figures.mean_along_mm * level;
  const CutPlane plane = cut_plane(made.taken_for, cut.cut, design.normal);
  const PlaneChange change = plane_change(made.taken_for, cut.cut, quantity, design.normal);
  const auto height = [&](const Vec3& p) { return amount * change.height_mm(plane, p, design.normal); };
  return {1e6 * height(there), height(there + design.up_slope) - height(there), height(there + level) - height(there)};
}

void expect_effects(const Made& made, const SetupQuantity& quantity, double amount, double tolerance_nm) {
  SCOPED_TRACE(fmt::format("{}, {} {}", quantity.key, amount, quantity.unit()));
  const Machine real = with_error(made.taken_for, quantity, amount);
  const Verification without = cut_on(made, made.taken_for);
  const Verification with = cut_on(made, real);
  const VerificationModel workpiece = verification_model_of(made.job, made.taken_for);
  for (const auto& [place, cut] : made.last) {
    SCOPED_TRACE(fmt::format("element {} facet {}", cut.element, cut.facet + 1));
    const DesignElement& groove = workpiece.design(cut.element);
    const FacetFigures& before = without.elements[cut.element].figures.facets[cut.facet];
    const FacetFigures& after = with.elements[cut.element].figures.facets[cut.facet];
    const Effect effect = predicted(made, groove, cut, after, quantity, amount);
    const double moved_nm = 1e6 * (before.slope_up * (after.mean_up_mm - before.mean_up_mm) +
                                   before.slope_along * (after.mean_along_mm - before.mean_along_mm));
    EXPECT_NEAR(after.mean_nm - before.mean_nm - moved_nm, effect.height_nm, tolerance_nm);
    const double tolerance = 1e-6 * tolerance_nm / groove.facet_length_mm;
    EXPECT_NEAR(after.slope_up - before.slope_up, effect.slope_up, tolerance);
    EXPECT_NEAR(after.slope_along - before.slope_along, effect.slope_along, tolerance);
  }
}

double amount_of(const SetupQuantity& quantity) {
  return quantity.is_angle() ? 20.0 : 1.0;
}

/// Errors of 1 um and 20 arcsec move facets by up to 1.4 um. The difference from the prediction is of second order.
TEST(SetupCuts, VerifiedFacetsOfPrismsAreAsPredicted) {
  Job job = square_job(2, Arrangement::checker);
  job.strategy = Strategy::two_step;
  job.process.roughing_depth_um = 50;
  job.process.finishing_cuts = 1;
  const Made cut = made(job, machine("ideal"));
  ASSERT_EQ(cut.last.size(), 8U);
  for (const SetupQuantity& quantity : setup_quantities(Tilt::table))
    expect_effects(cut, quantity, amount_of(quantity), 0.5);
}

TEST(SetupCuts, VerifiedFacetsOnAMachineThatLeansAreAsPredicted) {
  Job job = square_job(1);
  job.strategy = Strategy::bidirectional;
  job.process.roughing_depth_um = 50;
  Machine m = machine("paper");
  m.a.point_mm.value = Vec3(0, 20, -10);
  m.c.point_mm.value = Vec3(3, -4, 0);
  m.mount.rotation_deg.value = Vec3(0.01, -0.01, 0.02);
  m.mount.offset_mm.value = Vec3(0.002, -0.003, 0.001);
  const Made cut = made(job, m);
  for (const SetupQuantity& quantity : setup_quantities(Tilt::table))
    expect_effects(cut, quantity, amount_of(quantity), 0.5);
}

/// Quantities that rotate the edge of a V-shaped tool relative to its path split a facet into two adjacent planes.
/// These quantities are excluded.
TEST(SetupCuts, VerifiedFacetsOfCubeCornersAreAsPredicted) {
  Job job = cube_job(false);
  job.process.roughing_depth_um = 40.0;
  const Made cut = made(job, machine("ideal-dmc"));
  for (const char* const key : {"c_x_um", "c_y_um", "c_lean_x_arcsec", "c_lean_y_arcsec", "b_x_um", "b_z_um",
                                "tool_x_um", "tool_y_um", "tool_z_um"}) {
    const SetupQuantity& quantity = *setup_quantity(Tilt::head, key);
    expect_effects(cut, quantity, amount_of(quantity), 0.5);
  }
}

/// Programs that are planned for the actual mount of the tool cut the designed facets.
TEST(SetupCuts, AMountThatIsKnownIsPlannedFor) {
  Machine m = machine("paper");
  m.mount.offset_mm.value = Vec3(0.02, -0.03, 0.01);
  m.mount.rotation_deg.value = Vec3(0.3, 0.0, -0.02);
  for (const auto strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step}) {
    Job job = square_job(2, Arrangement::checker);
    job.strategy = strategy;
    job.process.roughing_depth_um = 50;
    const Made cut = made(job, m);
    const Verification v = cut_on(cut, m);
    EXPECT_TRUE(v.passes()) << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
    EXPECT_GT(cut_on(cut, machine("paper")).facet_distance_nm_max, 1000.0) << "the mount matters";
  }
  const Made cubes = made(
      cube_job(false), with_error(machine("ideal-dmc"), *setup_quantity(Tilt::head, "tool_rotation_z_arcsec"), 600.0));
  const Verification v = cut_on(cubes, cubes.taken_for);
  EXPECT_TRUE(v.passes()) << listed(v);
}

/// A tilted edge leaves a strip at the root, which cannot be removed by the axes. The verifier predicts the height of
/// this strip.
TEST(SetupCuts, AnEdgeThatIsNotLevelLeavesItsRise) {
  Job job = square_job(1);
  job.strategy = Strategy::two_step;
  const Machine m = with_error(machine("ideal"), *setup_quantity(Tilt::table, "tool_rotation_y_arcsec"), 60.0);
  const Made cut = made(job, m);
  const Verification v = cut_on(cut, m);
  EXPECT_TRUE(v.passes()) << listed(v);
  const double rise_nm = 1e6 * 0.451 * std::tan(Angle::from_deg(60.0 / 3600.0).rad());  // 131 nm
  EXPECT_NEAR(v.root_residual_nm_predicted, rise_nm, 0.01);
  EXPECT_NEAR(v.root_residual_nm_max, rise_nm, 2.0);
}

}  // namespace
}  // namespace retrace::fabrication::test::setup_cuts_test
