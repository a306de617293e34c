#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/edge_cut.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/setup.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/support/sample_size.h"

// Tests with machines whose slides, rotary axes and tool are tilted. Programs that are planned for such a machine must
// pass verification. The unavoidable errors must agree with closed forms.

namespace retrace::fabrication::test::random_machines_test {
namespace {

using geometry::Vec3;

constexpr double kRadPerArcsec = std::numbers::pi / 648000.0;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

Machine machine_with(const char* key, double amount) {
  return with_error(machine("ideal"), *setup_quantity(Tilt::table, key), amount);
}

/// Verifies the programs of a job on a machine.
/// \param along_x_nm distance by which all cuts are shifted along X
Verification verified(const Job& job, const Machine& m, Nanometres along_x_nm = 0) {
  std::vector<NcProgram> programs;
  for (Program& program : make_plan(job, m).programs) {
    for (Item& item : program.items)
      if (auto* const visit = std::get_if<CycleCall>(&item)) visit->start.x() += along_x_nm;
    programs.push_back(parse_nc(nc_text(program, "rs274ngc"), "p.ngc", NcDialect::rs274ngc));
  }
  return verify_programs(job, m, programs, {}, {});
}

Job prism(Strategy strategy) {
  Job job = square_job(1);
  job.strategy = strategy;
  job.process.roughing_depth_um = 30.0;
  return job;
}

struct Lean {
  const char* key;
  Strategy strategy;
  double min_ratio;  ///< minimum ratio of the simulated to the predicted cut into a wall
};

/// If a slide or the edge is tilted, the tool cuts into a wall at one end of its edge. The depth of this cut is the
/// tilt of the slide times its travel: Z moves up facet 1, and Y moves along facet 2. A tilted edge tilts the side of
/// the tool towards the wall by the same angle. The simulated depth is smaller than the prediction in two cases. First,
/// roughing cuts begin below the rim, which shortens the travel of Y. Second, the clearance face is at 3 degrees to the
/// wall, so that only cos 3 sin 45 / sin 48 = 0.95 of its length is in the blank.
TEST(RandomMachines, WhatGoesIntoWallsIsTheDirectionOfTravel) {
  const double facet_nm = 1e6 * 0.451 / std::numbers::sqrt2;
  for (const auto& [key, strategy, least_share] :
       {Lean{"z_lean_x_arcsec", Strategy::two_step, 0.999}, Lean{"z_lean_x_arcsec", Strategy::bidirectional, 0.999},
        Lean{"y_lean_x_arcsec", Strategy::unidirectional, 0.8},
        Lean{"tool_rotation_y_arcsec", Strategy::two_step, 0.95}})
    for (const double arcsec : {-100.0, 10.0, 300.0}) {
      SCOPED_TRACE(fmt::format("{} {}", key, arcsec));
      const Verification v = verified(prism(strategy), machine_with(key, arcsec));
      EXPECT_TRUE(v.passes()) << listed(v);
      const double into_wall_nm = facet_nm * std::abs(arcsec) * kRadPerArcsec;
      EXPECT_NEAR(v.wall_overcut_nm_predicted, into_wall_nm, 1e-3 * into_wall_nm);
      EXPECT_LT(v.wall_overcut_nm_max, v.wall_overcut_nm_predicted + 2.0);
      EXPECT_GT(v.wall_overcut_nm_max, least_share * v.wall_overcut_nm_predicted - 2.0);
      EXPECT_LT(v.facet_distance_nm_max, 2.0);
    }
}

/// The verifier allows only the predicted cut into a wall. It must find a further shift of 15 nm towards the wall.
TEST(RandomMachines, AnEdgeTooFarInAWallIsFound) {
  for (const double arcsec : {-200.0, 200.0}) {
    const Machine m = machine_with("z_lean_x_arcsec", arcsec);
    const Job job = prism(Strategy::bidirectional);
    const Verification v = verified(job, m, arcsec > 0.0 ? 15 : -15);
    EXPECT_FALSE(v.passes()) << arcsec;
    for (const Finding& finding : v.findings) EXPECT_EQ(finding.kind, "wall_overcut");
  }
}

/// The edge and the slides are tilted in the same plane. While the edge ploughs, it remains in the designed facet and
/// moves along the root as predicted.
TEST(RandomMachines, PloughsKeepToTheFacetWhereSlidesLeanAlongATiltedEdge) {
  for (const double tilt_arcsec : {-1000.0, 1000.0})
    for (const double lean_arcsec : {-1000.0, 1000.0}) {
      const Machine tilted = machine_with("tool_rotation_y_arcsec", tilt_arcsec);
      const Machine m = with_error(tilted, *setup_quantity(Tilt::table, "y_lean_x_arcsec"), lean_arcsec);
      const Verification v = verified(prism(Strategy::unidirectional), m);
      EXPECT_TRUE(v.passes()) << tilt_arcsec << " " << lean_arcsec << "\n" << listed(v);
      EXPECT_LT(v.facet_distance_nm_max, 2.0);
    }
}

/// Returns a random machine. The tilts of its axes and of its tool are at most `most_arcsec`. The displacements, in um,
/// are at most 0.01 times `most_arcsec`.
Machine any_machine(std::mt19937_64& bits, const std::string& name, double most_arcsec) {
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  Machine m = machine(name);
  std::vector<double> amounts;
  for (const SetupQuantity& quantity : setup_quantities(m.tilt))
    amounts.push_back((quantity.is_angle() ? most_arcsec : 0.01 * most_arcsec) * share(bits));
  m.a.sign.value = share(bits) < 0.0 ? -1.0 : 1.0;
  m.c.sign.value = share(bits) < 0.0 ? -1.0 : 1.0;
  if (m.a.sign.value < 0.0) m.a.limits_deg.value = {-m.a.limits_deg.value.high, -m.a.limits_deg.value.low};
  return with_errors(std::move(m), amounts);
}

template <class Value>
Value one_of(std::mt19937_64& bits, std::initializer_list<Value> values) {
  return values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(bits)];
}

Job any_job(std::mt19937_64& bits, bool is_prism) {
  if (!is_prism) {
    Job job = cube_job(one_of(bits, {false, true}), 0.2);
    job.array = {};
    job.array.arrangement = geometry::Arrangement::single;
    return job;
  }
  Job job = square_job(1);
  job.strategy = one_of(bits, {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step});
  prism_of(job).apex_angle_deg = one_of(bits, {80.0, 90.0, 90.0, 90.05, 100.0});
  job.tool.width_mm = one_of(bits, {0.451, 0.451, 0.3});
  job.tool.edge_radius_um = one_of(bits, {0.0, 1.0, 5.0});
  job.process.roughing_depth_um = one_of(bits, {30.0, 40.0});
  return job;
}

/// Correct programs pass on machines whose errors are between 1 arc second, comparable to the tolerance, and 0.1
/// degrees. No program may fail, whatever the number of machines.
TEST(RandomMachines, RightProgramsOfAnyMachinePass) {
  const int machines = retrace::test::sample_size(100, 500);
  std::mt19937_64 bits(59);
  std::uniform_real_distribution<double> decades(0.0, 2.6);
  for (int k = 0; k < machines; ++k) {
    const bool is_prism = k % 5 != 0;
    const std::string name =
        is_prism ? one_of<std::string>(bits, {"ideal", "paper", "thesis"}) : std::string("ideal-dmc");
    const double most_arcsec = std::pow(10.0, decades(bits));
    const Machine m = any_machine(bits, name, most_arcsec);
    const Job job = any_job(bits, is_prism);
    const Verification v = verified(job, m);
    EXPECT_TRUE(v.passes()) << fmt::format("machine {}: {}, {} arcsec, strategy {}, apex {}, width {}, radius {}\n{}",
                                           k, name, most_arcsec, static_cast<int>(job.strategy),
                                           is_prism ? prism_of(job).apex_angle_deg : 0.0, job.tool.width_mm,
                                           job.tool.edge_radius_um, listed(v));
    EXPECT_LT(v.facet_distance_nm_max, 3.0) << k;
    EXPECT_LT(v.wall_overcut_nm_max, v.wall_overcut_nm_predicted + 3.0) << k;
  }
}

/// The tool is touched off after mounting. Its rounded edge therefore touches the same two planes at the reference
/// point for every rotation of the diamond. The tip of the wedge is the intersection of the two tangents along both
/// facets.
TEST(RandomMachines, ATurnedToolCutsWhereItWasTouchedOff) {
  std::mt19937_64 bits(8);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    Machine m = any_machine(bits, "ideal", 2000.0);
    m.mount.rotation_deg.value = Vec3(3.0 * share(bits), share(bits), share(bits));
    Tool tool;
    tool.width_mm = 0.5;
    tool.edge_radius_um = 5.0 + 4.0 * share(bits);
    const Angle apex = Angle::from_deg(90.0 + 15.0 * share(bits));
    const ToolWedge wedge = tool_wedge(tool, m, apex);
    const Vec3 wall = plunged_normal(m);
    const Vec3 up = wall.cross(edge_direction(m));
    const Vec3 floor = -std::cos(apex.rad()) * wall + std::sin(apex.rad()) * up;
    const double radius_mm = 1e-3 * tool.edge_radius_um;
    const Vec3 centre = radius_mm * (wall + up);
    EXPECT_NEAR(wall.dot(centre - wedge.tip_mm), radius_mm, 1e-12);
    EXPECT_NEAR(floor.dot(centre - wedge.tip_mm), radius_mm, 1e-12);
    EXPECT_NEAR(wedge.edge.dot(wedge.tip_mm), 0.0, 1e-12);
  }
}

/// A rotation of the tool about its edge, which the machine file contains, changes only the clearance angle. A rounded
/// edge then cuts facets with any apex angle as designed.
TEST(RandomMachines, ATurnAboutTheEdgeMovesNoFacet) {
  for (const double turn_deg : {-1.0, 1.0})
    for (const double apex_deg : {80.0, 90.0, 100.0}) {
      Machine m = machine("ideal");
      m.mount.rotation_deg.value = Vec3(turn_deg, 0.0, 0.0);
      Job job = prism(Strategy::two_step);
      prism_of(job).apex_angle_deg = apex_deg;
      job.tool.edge_radius_um = 5.0;
      const Verification v = verified(job, m);
      EXPECT_TRUE(v.passes()) << turn_deg << " " << apex_deg << "\n" << listed(v);
      EXPECT_LT(v.facet_distance_nm_max, 1.0);
    }
  EdgeCut cut;
  cut.at.a_deg = 45.0;
  cut.tip_mm = Vec3(0.0, 0.0, -0.001);
  const Machine m = machine("ideal");
  const PlaneChange change =
      plane_change(m, cut, *setup_quantity(Tilt::table, "tool_rotation_x_arcsec"), Vec3(0, -1, 1).normalized());
  EXPECT_LT(change.point_mm.norm(), 1e-15);
  EXPECT_LT(change.normal.norm(), 1e-15);
}

}  // namespace
}  // namespace retrace::fabrication::test::random_machines_test
