#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/linuxcnc.h"
#include "tests/fabrication/substrate_jobs.h"

// LinuxCNC's own interpreter reads our RS274/NGC text: its canonical moves are the planned ones. Golden programs pin
// the text of every dialect.

namespace retrace::fabrication::test::linuxcnc_test {
namespace {

namespace fs = std::filesystem;
using geometry::Arrangement;

const fs::path kSource = RETRACE_SOURCE_DIR;

Machine machine(const std::string& name) {
  return parse_machine(read_file(kSource / "data" / "machines" / (name + ".toml")), name);
}

void expect_planned(const Plan& plan, const std::string& what) {
  SCOPED_TRACE(what);
  for (const Program& program : plan.programs) {
    const std::string printed = interpreted(nc_text(program, "rs274ngc"));
    EXPECT_NE(printed.find("SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)"), std::string::npos);
    EXPECT_NE(printed.find("PROGRAM_END()"), std::string::npos);
    const std::vector<CanonicalMove> moves = canonical_moves(printed);
    std::vector<PlannedMove> planned;
    for_each_move(program, [&](const PlannedMove& move) { planned.push_back(move); });
    ASSERT_EQ(moves.size(), planned.size());
    constexpr double kPrinted = 1e-4;  // four decimals
    for (std::size_t k = 0; k < moves.size(); ++k) {
      const Words& to = planned[k].at;
      ASSERT_EQ(moves[k].rapid, planned[k].is_rapid()) << "move " << k;
      // Behind a stop a program does not know where axes stand, and the interpreter does.
      for (const Axis axis : {kX, kY, kZ}) {
        const double at_mm = to[axis] ? millimetres(*to[axis]) : moves[k].at[axis];
        ASSERT_NEAR(moves[k].at[axis], at_mm, kPrinted);
      }
      const bool tilts_table = program.tilt_letter == 'A';
      ASSERT_NEAR(moves[k].at[tilts_table ? 3 : 4], degrees(*to[kTilt]), kPrinted);
      ASSERT_EQ(moves[k].at[tilts_table ? 4 : 3], 0.0);
      ASSERT_NEAR(moves[k].at[5], degrees(*to[kC]), kPrinted);
      ASSERT_EQ(moves[k].feed, planned[k].move.feed_mm_per_min);
      ASSERT_NEAR(moves[k].dwell_s, planned[k].dwell_s, 1e-9);
      ASSERT_TRUE(moves[k].rapid || !tilts_table || moves[k].at[0] == moves[k - 1].at[0]) << "X while cutting";
    }
  }
}

TEST(LinuxCnc, MovesAsPlannedForAllStrategiesArrangementsAndMachines) {
  for (const char* name : {"ideal", "paper", "thesis"})
    for (const auto strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step})
      for (const auto arrangement :
           {Arrangement::single, Arrangement::aligned, Arrangement::offset, Arrangement::checker}) {
        Job job = square_job(arrangement == Arrangement::single ? 1 : 2, arrangement);
        job.strategy = strategy;
        job.process.roughing_depth_um = 60.0;
        job.process.slow_retract_um = 4.0;
        expect_planned(make_plan(job, machine(name)),
                       std::string(name) + " " + std::string(kStrategyWords[static_cast<std::size_t>(strategy)]) +
                           " arrangement " + std::to_string(static_cast<int>(arrangement)));
      }
}

TEST(LinuxCnc, MovesAsPlannedForCubeCorners) {
  for (const bool is_hexagonal : {false, true})
    expect_planned(make_plan(cube_job(is_hexagonal), machine("ideal-dmc")), is_hexagonal ? "hexagonal" : "triangular");
}

TEST(LinuxCnc, MovesAsPlannedForElementsOnBases) {
  expect_planned(make_plan(prisms_on(plane_substrate(12.0, 0.0, ElementAxes::normal)), machine("ideal")), "incline");
  expect_planned(make_plan(prisms_on(cylinder_substrate(6.0, false, ElementAxes::normal)), machine("thesis")),
                 "cylinder");
  expect_planned(make_plan(prisms_on(sphere_substrate(-12.0, ElementAxes::parallel)), machine("paper")), "bowl");
  expect_planned(make_plan(cubes_on(cylinder_substrate(3.0, true, ElementAxes::normal), true), machine("ideal-dmc")),
                 "hexagons");
}

TEST(LinuxCnc, TakesSplitAndStoppedPrograms) {
  PlanOptions options;
  options.split_hours = 0.03;
  options.stop_every = 4;
  const Plan plan = make_plan(square_job(3), machine("paper"), options);
  ASSERT_GT(plan.programs.size(), 2U);
  expect_planned(plan, "split");
}

/// The folders of golden/ hold a job and its programs in every dialect. RETRACE_WRITE_GOLDEN=1 writes them anew, to be
/// looked through before they are committed.
TEST(Golden, ProgramsOfSmallJobs) {
  const char* const rewrite = std::getenv("RETRACE_WRITE_GOLDEN");
  int folders = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "tests" / "fabrication" / "golden")) {
    if (!entry.is_directory()) continue;
    ++folders;
    SCOPED_TRACE(entry.path().filename().string());
    Job job = parse_job(read_file(entry.path() / "job.toml"), "job.toml");
    expect_planned(make_plan(job, machine(job.machine)), entry.path().filename().string());
    for (const Dialect& dialect : dialects()) {
      const Plan plan = make_plan(job, for_dialect(machine(job.machine), dialect.name));
      const fs::path file = entry.path() / ("program" + std::string(dialect.ending));
      const std::string text = nc_text(plan.programs.front(), dialect.name);
      if (rewrite != nullptr) write_file_atomically(file, text);
      EXPECT_EQ(read_file(file), text) << file;
    }
  }
  EXPECT_GE(folders, 6);
}

TEST(Dialects, AreComplete) {
  const auto text = [&](std::string_view dialect) {
    return nc_text(make_plan(square_job(2), for_dialect(machine("ideal"), dialect)).programs.front(), dialect);
  };
  for (const Dialect& dialect : dialects()) {
    const std::string nc = text(dialect.name);
    SCOPED_TRACE(std::string(dialect.name));
    EXPECT_NE(nc.find("Expected time"), std::string::npos);
    EXPECT_NE(nc.find("Tool: width 0.451 mm"), std::string::npos);
    EXPECT_NE(nc.find("Pose: facet 2 A45.0000000 C180.0000000"), std::string::npos);
    EXPECT_NE(nc.find("Needs: "), std::string::npos);
    EXPECT_NE(nc.find("Roughing 25 percent"), std::string::npos);
    EXPECT_NE(nc.find("Finishing cut 2 of 2 C-axis at 180"), std::string::npos);
    EXPECT_EQ(nc.find("#3006"), std::string::npos);
    const bool has_texts = dialect.name == "pmac" || dialect.name == "a3200" || dialect.name == "automation1";
    for (const char* word : {"M5\n", "M7\n", "M9\n"}) EXPECT_EQ(nc.find(word) != std::string::npos, !has_texts) << word;
  }
  EXPECT_NE(text("sinumerik").find("G60"), std::string::npos);
  EXPECT_NE(text("sinumerik").find("TRAFOOF"), std::string::npos);
  EXPECT_NE(text("fanuc").find("G61"), std::string::npos);
  EXPECT_NE(text("fanuc").find("G4 P100\n"), std::string::npos) << "milliseconds";
  EXPECT_NE(text("pmac").find("Coord[1].NoBlend=1"), std::string::npos);
  EXPECT_NE(text("pmac").find("dwell 100\n"), std::string::npos) << "milliseconds";
  EXPECT_NE(text("a3200").find("G4 P0.100\n"), std::string::npos) << "seconds";
  EXPECT_NE(text("automation1").find("Dwell(0.100)\n"), std::string::npos) << "seconds";
  EXPECT_THROW(text("kugler"), InputError);
}

TEST(Dialects, WriteNumbersInFixedPoint) {
  Program program;
  program.subroutines.push_back({101, "a routine", {increment(Motion::plunge, {0, -1, 2000000}, 12.5)}});
  Move up;
  up.to[kZ] = 5000000;
  Move turn;
  turn.to[kTilt] = -1;
  turn.to[kC] = 450000000;
  program.items = {up, turn, Visit{3, 0, {-123, 1000000000, 7}}};
  const std::string text = nc_text(program, "rs274ngc");
  EXPECT_NE(text.find("G1 Y-0.000001 Z2.000000 F12.500\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G0 A-0.0000001 C45.0000000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G0 X-0.000123 Y1000.000000\nG0 Z0.000007\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace retrace::fabrication::test::linuxcnc_test
