#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/chisel/plan/section.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests of jobs with rarely used keys. Programs are planned for different machines, read back and simulated. The result
// must match the design. A plunge cuts down one facet of a prism, the wall. A plough cuts from the root along the other
// facet, the floor.

namespace retrace::fabrication::test::planned_jobs_test {
namespace {

using geometry::Arrangement;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

Verification verified(const std::vector<Program>& planned, const Job& job, const Machine& m) {
  std::vector<NcProgram> programs;
  for (const Program& program : planned)
    programs.push_back(parse_nc(nc_text(program, "rs274ngc"), "p.ngc", NcDialect::rs274ngc));
  return verify_programs(job, m, programs, {}, {});
}

/// Verifies the programs that are planned for the job `planned` against another job.
Verification verified(const Job& planned, const Job& job, const Machine& m) {
  return verified(make_plan(planned, m).programs, job, m);
}

/// Returns the programs with the visits of one element (calls of cutting subroutines) moved along Z.
/// \param title first words of the titles of the subroutines whose visits are moved. If it is empty, the visits of all
///        subroutines are moved
std::vector<Program> raised(std::vector<Program> programs, std::int32_t element, Nanometres by_nm,
                            const std::string& title = "") {
  int moved = 0;
  for (Program& program : programs)
    for (Item& item : program.items)
      if (auto* visit = std::get_if<CycleCall>(&item))
        if (visit->element == element && program.subroutines[visit->subroutine].title.starts_with(title)) {
          visit->start.z() += by_nm;
          ++moved;
        }
  EXPECT_GT(moved, 0);
  return programs;
}

bool has_kind(const Verification& v, const std::string& kind) {
  for (const Finding& f : v.findings)
    if (f.kind == kind) return true;
  return false;
}

std::string listed(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings)
    text +=
        fmt::format("{}:{} {} [{}] {} ({} > {})\n", f.program, f.line, f.kind, f.element, f.message, f.value, f.limit);
  return text.substr(0, 2000);
}

struct Variant {
  std::string what;
  std::function<void(Job&)> change;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"narrow tool", [](Job& job) { job.tool.width_mm = 0.2; }},
      {"gaps", [](Job& job) { job.array.x_gap_mm = job.array.y_gap_mm = 0.03; }},
      {"opened apex", [](Job& job) { prism_of(job).apex_angle_deg = 90.05; }},
      {"closed apex", [](Job& job) { prism_of(job).apex_angle_deg = 89.95; }},
      {"narrow apex", [](Job& job) { prism_of(job).apex_angle_deg = 80.0; }},
      {"wide apex", [](Job& job) { prism_of(job).apex_angle_deg = 95.0; }},
      {"blunt edge", [](Job& job) { job.tool.edge_radius_um = 0.5; }},
      {"blunt edge, opened apex",
       [](Job& job) {
         job.tool.edge_radius_um = 0.5;
         prism_of(job).apex_angle_deg = 90.05;
       }},
      {"blunt edge, wide apex",
       [](Job& job) {
         job.tool.edge_radius_um = 1.0;
         prism_of(job).apex_angle_deg = 95.0;
       }},
      {"blunt edge, narrow apex",
       [](Job& job) {
         job.tool.edge_radius_um = 5.0;
         prism_of(job).apex_angle_deg = 80.0;
       }},
      {"apex of 100", [](Job& job) { prism_of(job).apex_angle_deg = 100.0; }},
      {"two passes 20 nm apart", [](Job& job) { prism_of(job).width_mm += 2e-5; }},
      {"two passes 0.3 um apart", [](Job& job) { prism_of(job).width_mm += 3e-4; }},
      {"two passes 4 um apart", [](Job& job) { prism_of(job).width_mm += 4e-3; }},
      {"two passes 100 um apart", [](Job& job) { prism_of(job).width_mm += 0.1; }},
      {"direct", [](Job& job) { job.workpiece.kind = WorkpieceKind::direct; }},
      {"shrinkage",
       [](Job& job) {
         job.workpiece.shrinkage_percent = 0.6;
         job.tool.width_mm = blank_prism(job).width_mm;
       }},
      {"pattern",
       [](Job& job) {
         job.array.pattern = {"-##", "#-#", "###"};
       }},
      {"odd rows", [](Job& job) { job.array.shifted_rows = geometry::RowParity::odd; }},
      {"short plough with lift",
       [](Job& job) {
         job.process.plough_lift_um = 2.0;
         job.process.slow_retract_um = 5.0;
       }},
      {"shortest plough", [](Job& job) { job.process.shortest_plough = true; }},
      {"other clearance", [](Job& job) { job.tool.clearance_deg = 10.0; }},
      {"one finishing cut", [](Job& job) { job.process.finishing_cuts = 1; }}};
  return all;
}

TEST(PlannedJobs, EveryKeyIsCutAsDesigned) {
  for (const char* name : {"ideal", "paper"}) {
    const Machine m = machine(name);
    for (const Variant& variant : variants())
      for (const auto strategy : {Strategy::unidirectional, Strategy::two_step}) {
        Job job = square_job(3, Arrangement::offset);
        job.strategy = strategy;
        job.process.roughing_depth_um = 40.0;
        variant.change(job);
        job.array.y_length_mm = std::max(job.array.y_length_mm, 3.0 * prism_of(job).width_mm);
        const Verification v = verified(job, job, m);
        const std::string what = fmt::format("{}, {}, strategy {}", variant.what, name, static_cast<int>(strategy));
        EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
        EXPECT_EQ(v.elements_cut, static_cast<std::int64_t>(cut_elements(job).size())) << what;
        // Several ploughs next to each other form steps. The mean plane of the steps is tilted less than the facet of a
        // single plough. The angle is therefore checked only for two_step, where no facet is ploughed.
        if (strategy == Strategy::two_step) {
          EXPECT_LT(v.facet_angle_arcmin_max, 0.01) << what;
        }
      }
  }
}

TEST(PlannedJobs, AnotherApexIsFound) {
  for (const double apex_deg : {89.95, 90.05, 80.0}) {
    Job planned = square_job(2, Arrangement::aligned);
    planned.process.roughing_depth_um = 40.0;
    Job job = planned;
    prism_of(planned).apex_angle_deg = apex_deg + 0.02;
    prism_of(job).apex_angle_deg = apex_deg;
    EXPECT_FALSE(verified(planned, job, machine("ideal")).passes()) << apex_deg;
  }
}

/// An edge of radius r extends beyond a sharp edge by r (1 - sin a + cos a) towards the floor, where a is the apex
/// angle. The test runs a program for a sharp edge with a blunt edge. The edge gouges if this distance is positive, and
/// leaves excess material if it is negative.
TEST(PlannedJobs, AnEdgeThatTheProgramForgotIsFound) {
  for (const auto& [apex_deg, kind] : {std::pair{85.0, "gouge"}, {95.0, "excess"}}) {
    Job planned = square_job(2, Arrangement::aligned);
    planned.strategy = Strategy::unidirectional;
    planned.process.roughing_depth_um = 40.0;
    prism_of(planned).apex_angle_deg = apex_deg;
    Job job = planned;
    job.tool.edge_radius_um = 1.0;
    for (const char* name : {"ideal", "paper"}) {
      const Verification v = verified(planned, job, machine(name));
      EXPECT_TRUE(has_kind(v, kind)) << name << " " << apex_deg << "\n" << listed(v);
      const double apex = Angle::from_deg(apex_deg).rad();
      const double missed_nm = 1e3 * (1.0 - std::sin(apex) + std::cos(apex));
      // Use the smallest deviation. It belongs to the floor, that is, to the facet along which the tool ploughs. Lines
      // normal to the wall intersect the floor at a small angle close to the root and give larger deviations.
      double found_nm = 1e9;
      for (const Finding& f : v.findings)
        if (f.kind == kind) found_nm = std::min(found_nm, std::abs(f.value));
      EXPECT_NEAR(found_nm, std::abs(missed_nm), 2.0) << name << " " << apex_deg << "\n" << listed(v);
    }
  }
}

/// The heights of floors that are ploughed in several passes are predicted to 1 nm. The verifier must find a floor that
/// is 15 nm too high or too low.
TEST(PlannedJobs, PassesAtAnotherHeightAreFound) {
  for (const double wider_mm : {2e-5, 3e-4, 4e-3, 0.1}) {
    Job job = square_job(2, Arrangement::aligned);
    job.strategy = Strategy::unidirectional;
    job.process.roughing_depth_um = 40.0;
    prism_of(job).width_mm += wider_mm;
    job.array.y_length_mm = 2.0 * prism_of(job).width_mm;
    const Machine paper = machine("paper");
    const std::vector<Program> programs = make_plan(job, paper).programs;
    EXPECT_TRUE(verified(programs, job, paper).passes()) << wider_mm;
    EXPECT_TRUE(has_kind(verified(raised(programs, 1, 15), job, paper), "excess")) << wider_mm;
    EXPECT_TRUE(has_kind(verified(raised(programs, 1, -15), job, paper), "gouge")) << wider_mm;
  }
}

/// Returns a job with prisms of 0.97 x 1.754 mm in brick rows on 2.231 x 2.231 mm. `retrace job` makes these sizes for
/// a tool of 1.754 mm.
Job wide_job() {
  Job job = square_job(2, Arrangement::offset);
  job.strategy = Strategy::unidirectional;
  prism_of(job).base_mm = 0.97;
  prism_of(job).width_mm = job.tool.width_mm = 1.754;
  job.array.x_length_mm = job.array.y_length_mm = 2.231;
  return job;
}

/// On machine `paper`, the ploughed facet is tilted. It rises by 596.9 nm from one end of the tool's edge to the other.
/// The tip of one cut ends 0.894 um below the rim (the upper end of the facet). Half-way between this tip and the rim,
/// the face of the blank is only 446.8 nm above the design facet, which is less than the rise. The ploughed facet
/// therefore meets the face of the blank below the rim and ends there. This is not a gouge.
TEST(PlannedJobs, APloughedFacetThatLeavesTheBlankBelowItsRimIsNoGouge) {
  const Job job = wide_job();
  const Machine paper = machine("paper");
  const std::vector<Program> programs = make_plan(job, paper).programs;
  const Verification v = verified(programs, job, paper);
  EXPECT_TRUE(v.passes()) << listed(v);
  EXPECT_EQ(v.elements_cut, 2);
  EXPECT_LT(v.facet_distance_nm_max, 2.0);
  // 15 nm along Z are 10.6 nm along the normal of the facet. This is more than the tolerance, even at the rim (the
  // upper end of the facet).
  EXPECT_TRUE(has_kind(verified(raised(programs, 0, -15), job, paper), "gouge"));
  EXPECT_TRUE(has_kind(verified(raised(programs, 0, 15), job, paper), "excess"));
}

/// Random sizes place the tips of cuts close to the rim, where a tilted facet leaves the blank. The array is longer
/// than a whole number of elements by a random amount.
RC_GTEST_PROP(PlannedJobs, PloughedFacetsOfAnySizeAreCutAsDesigned, ()) {
  Job job = square_job(2, Arrangement::offset);
  job.strategy = Strategy::unidirectional;
  job.process.roughing_depth_um = *rc::gen::element(10.0, 15.0, 25.0);
  geometry::RtpElement& prism = prism_of(job);
  const double facet_um = job.process.roughing_depth_um * *rc::gen::inRange(15, 30) + 0.05 * *rc::gen::inRange(1, 60);
  prism.base_mm = 1e-3 * facet_um * std::numbers::sqrt2;
  prism.width_mm = 1e-3 * *rc::gen::inRange(300, 2500);
  // One pass, or several passes side by side.
  job.tool.width_mm = std::clamp(prism.width_mm / *rc::gen::inRange(1, 4), 0.25, std::min(2.0, prism.width_mm));
  job.array.x_length_mm = prism.base_mm * (1.0 + 0.01 * *rc::gen::inRange(0, 200));
  job.array.y_length_mm = prism.width_mm * (1.0 + 0.01 * *rc::gen::inRange(0, 200));
  const Verification v = verified(job, job, machine("paper"));
  if (!v.passes()) RC_FAIL(listed(v));
  RC_ASSERT(v.elements_cut == static_cast<std::int64_t>(cut_elements(job).size()));
  RC_ASSERT(v.facet_distance_nm_max < 2.0);
}

/// A tilted edge leaves a strip at the root. The width of the strip up the facet is w tan(delta) for every apex angle,
/// with the tool width w and the tilt delta. The verifier must find a strip that is 20 nm wider.
TEST(PlannedJobs, RootsAreAsPredictedAtEveryApex) {
  for (const double apex_deg : {80.0, 90.0, 95.0, 100.0}) {
    Job job = square_job(2, Arrangement::aligned);
    job.process.roughing_depth_um = 40.0;
    prism_of(job).apex_angle_deg = apex_deg;
    const Machine paper = machine("paper");
    const std::vector<Program> programs = make_plan(job, paper).programs;
    const Verification v = verified(programs, job, paper);
    EXPECT_TRUE(v.passes()) << apex_deg << "\n" << listed(v);
    EXPECT_NEAR(v.root_residual_nm_max, v.root_residual_nm_predicted, 3.0) << apex_deg;
    const Verification high = verified(raised(programs, 0, 20, "finishing-2-facet-2"), job, paper);
    EXPECT_TRUE(has_kind(high, "root_residual")) << apex_deg << "\n" << listed(high);
  }
}

/// Returns a machine whose axis A is not parallel to X.
/// \param slope tangent of the largest angle between a root and the edge of the tool
Machine with_root_slope(const Job& job, double slope) {
  Machine m = machine("ideal");
  const auto lean = [&](double angle) {
    m.a.direction.value = geometry::Vec3(std::cos(angle), std::sin(angle), 0.6 * std::sin(angle));
    m.a.direction.value.normalize();
    double largest = 0.0;
    for (const int facet : {1, 2}) {
      const PlungePose pose = solve_plunge_pose(m, facet_normal(prism_of(job), {false, facet}),
                                                root_direction({false, facet}), {45.0, facet == 1 ? 0.0 : 180.0});
      largest = std::max(largest, std::abs(std::tan(pose.root_tilt.rad())));
    }
    return largest;
  };
  double angle = 1e-4;
  for (int step = 0; step < 4; ++step) angle *= slope / lean(angle);
  lean(angle);
  return m;
}

/// A tilted edge leaves a strip at the root. A plunge separates its chip only if this strip is narrower than the depth
/// of cut, so that jobs with wider strips are refused. A plough separates its chip for any width of the strip.
/// Unidirectional jobs are therefore refused only if the direction of the ploughed facet deviates by more than acos
/// 0.985 = 9.94 degrees. The programs of all other jobs pass verification.
TEST(PlannedJobs, RootsThatStandObliqueByMoreThanACutAreRefused) {
  for (const Strategy strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step})
    for (const double share : {0.3, 0.9, 0.99, 1.01, 1.3, 2.5, 3.5, 5.0, 10.0}) {
      Job job = square_job(1);
      job.strategy = strategy;
      job.process.roughing_depth_um = 20.0;
      job.process.finishing_depth_um = 4.0;
      // One end of the oblique edge is closer to the blank than the reference point of the tool. Rapid moves may be
      // closer by at most 5 % of the clearance. A larger clearance is therefore needed.
      job.process.clearance_mm = 1.0;
      const double depth_mm = strategy == Strategy::two_step ? 4e-3 : 20e-3;
      const Machine m = with_root_slope(job, share * depth_mm / job.tool.width_mm);
      try {
        const Verification v = verified(job, job, m);
        EXPECT_TRUE(v.passes()) << static_cast<int>(strategy) << ' ' << share << "\n" << listed(v);
        EXPECT_LT(share, strategy == Strategy::unidirectional ? 5.0 : 1.0) << static_cast<int>(strategy);
      } catch (const InputError& error) {
        EXPECT_GT(share, strategy == Strategy::unidirectional ? 3.5 : 1.0) << error.what();
        EXPECT_EQ(recorded_place_of(error), "machine");
      }
    }
}

/// The floor that a plough leaves at an oblique root is predicted exactly, even for slides that are not perpendicular
/// to each other, and for several passes. Correct programs pass. Programs that are 30 nm too high or too low fail.
/// Terms of third order are up to 0.4 um here.
TEST(PlannedJobs, PloughedFloorsOfObliqueRootsAreAsDerived) {
  for (const double slope : {0.01, 0.05, 0.1, 0.15})
    for (const double lean : {0.0, 0.002})
      for (const double width_share : {1.0, 0.6}) {
        Job job = square_job(1);
        job.strategy = Strategy::unidirectional;
        job.process.roughing_depth_um = 60.0;
        job.process.clearance_mm = 4.0;
        job.tool.width_mm *= width_share;
        Machine m = with_root_slope(job, slope);
        m.y.direction.value = geometry::Vec3(-lean, 1.0, 0.0).normalized();
        m.z.direction.value = geometry::Vec3(lean, 0.0, 1.0).normalized();
        const std::vector<Program> programs = make_plan(job, m).programs;
        const std::string what = fmt::format("slope {}, lean {}, width {}", slope, lean, width_share);
        const Verification v = verified(programs, job, m);
        EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
        EXPECT_TRUE(has_kind(verified(raised(programs, 0, 30), job, m), "excess")) << what;
        EXPECT_TRUE(has_kind(verified(raised(programs, 0, -30), job, m), "gouge")) << what;
      }
}

}  // namespace
}  // namespace retrace::fabrication::test::planned_jobs_test
