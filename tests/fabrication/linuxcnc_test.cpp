#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/linuxcnc.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/nc_record.h"
#include "tests/fabrication/substrate_jobs.h"
#include "tests/support/refusals.h"

// Tests of RS274/NGC programs with the interpreter of LinuxCNC: its canonical moves must equal the planned moves.
// Golden files contain the expected program text of every dialect.

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
    constexpr double kPrinted = 1e-4;  // the interpreter prints four decimals
    for (std::size_t k = 0; k < moves.size(); ++k) {
      const AxisWords& to = planned[k].at;
      ASSERT_EQ(moves[k].rapid, planned[k].is_rapid()) << "move " << k;
      // After a stop, the program does not know the positions of the axes. The interpreter always knows them. Axes that
      // are unknown to the program are therefore not compared.
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

/// Returns the reason why retrace refuses a program, or an empty text.
std::string our_refusal(const std::string& text) {
  std::string fault;
  const std::string refused = refusal_of([&] {
    const Record record = record_of(text, NcDialect::rs274ngc);
    if (!record.end.is_complete) fault = record.end.reason;
    for (const NcMotion& motion : record.motions)
      if (motion.move == NcMove::linear && motion.feed_mm_per_min == 0.0 && motion.duration_s == 0.0) fault = "no feed";
  });
  return refused + fault;
}

TEST(LinuxCnc, WhatItRefusesIsRefused) {
  std::string nested = "%\n";
  for (int k = 1; k <= 10; ++k)
    nested += fmt::format("o{0} sub\n{1}o{0} endsub\n", k, k > 1 ? fmt::format("o{} call\n", k - 1) : "");
  const std::string begin = "%\nG21 G90 G94\n";
  const std::vector<std::string> refused = {begin + "F50\nG94\nG1 X1\nM2\n%\n",       // G94 clears the feed
                                            begin + "G1 F50 X1\nG80\nX2\nM2\n%\n",    // axis words after G80
                                            begin + "G80 X2\nM2\n%\n",                //
                                            "G0 X1\n" + begin + "G0 X1\nM2\n%\n",     // text above the first %
                                            "(text)\n" + begin + "G0 X1\nM2\n%\n",    //
                                            "%(text)\nG0 X1\nM2\n%\n",                // text after % in its line
                                            begin + "M7 M8\nM2\n%\n",                 // two codes of one group
                                            begin + "M8 M9\nM2\n%\n",                 //
                                            begin + "N-5 G0 X1\nM2\n%\n",             // negative line number
                                            begin + "G1\nM2\n%\n",                    // G1 without a feed
                                            begin + "F5\nG93 G1\nM2\n%\n",            //
                                            begin + "G93 G1 F5 X1\nG94 X2\nM2\n%\n",  // G94 clears the F word of G93
                                            begin + "F5 G1 X1\nG93\nX2\nM2\n%\n",     //
                                            begin + "G92.1 X1\nM2\n%\n",              //
                                            begin + "(text) N5 G0 X1\nM2\n%\n",       // a comment before N
                                            nested + "o10 call\nM2\n%\n"};
  for (const std::string& text : refused) {
    EXPECT_NE(interpretation_of(text).status, 0) << text;
    EXPECT_NE(our_refusal(text), "") << text;
  }
  for (const std::string& text : {begin + "G94 F50\nG1 X1\nM2\n%\n", begin + "G80\nG0 X2\nN5 M7\nM8\nM2\n%\n",
                                  "\n" + begin + "G93 G1 F5 X1\nG94 F5 X2\nM2\n%\n", begin + "G93\nG0 X1\nM2\n%\n"}) {
    EXPECT_EQ(interpretation_of(text).status, 0) << text;
    EXPECT_EQ(our_refusal(text), "") << text;
  }
}

/// Edits programs at random. LinuxCNC must accept every edited program that retrace accepts.
TEST(LinuxCnc, TakesEveryEditedProgramThatIsRead) {
  const std::vector<std::string> lines_put_in = {
      "G94",       "G93",       "F50.000",     "G80",         "G80 G90",
      "M8",        "M7 M8",     "%",           "(text)",      "G1",
      "G0",        "G91",       "G92.1",       "G20",         "M9 M5",
      "F0",        "G1 Y0.1",   "X0.1",        "G0 Z5",       "M2",
      "G90",       "S100",      "G61",         "G64 P0.01",   "G64 P0.01 Q-0.02",
      "M0",        "G4 P0.1",   "G4",          "o102 sub",    "G61 G64",
      "M3 M7",     "N-3 G0 Z6", "N7 G0 Z6",    "G40 G49 G54", "G94 F20",
      "o101 call", "o103 call", "G0 G92.1 X1", "G97 S5",      "M30"};
  Job job = square_job(1, Arrangement::single);
  job.strategy = Strategy::two_step;
  job.process.roughing_depth_um = 100.0;
  job.process.finishing_cuts = 1;
  const std::vector<std::string> whole =
      lines_of_text(nc_text(make_plan(job, machine("ideal")).programs.front(), "rs274ngc"));
  std::mt19937 random(59);
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  int taken = 0;
  const char* const more = std::getenv("RETRACE_EDITS");
  const int tries = more == nullptr ? 60 : std::atoi(more);
  for (int k = 0; k < tries; ++k) {
    std::vector<std::string> lines = whole;
    for (std::size_t edits = 1 + below(3); edits > 0; --edits) {
      const std::size_t i = below(lines.size());
      const std::size_t j = below(lines.size());
      std::string& line = lines[i];
      switch (below(6)) {
        case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i)); break;
        case 1: std::swap(line, lines[j]); break;
        case 2: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(j), std::string(line)); break;
        case 3: line = line.substr(0, line.rfind(' ')); break;
        case 4: line += " " + lines_put_in[below(lines_put_in.size())]; break;
        default: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(i), lines_put_in[below(lines_put_in.size())]);
      }
    }
    const std::string text = text_of_lines(lines);
    if (!our_refusal(text).empty()) continue;
    ++taken;
    const Interpretation theirs = interpretation_of(text);
    EXPECT_EQ(theirs.status, 0) << theirs.err << "\n" << text;
  }
  EXPECT_GE(taken, tries / 6);
}

TEST(LinuxCnc, TakesSplitAndStoppedPrograms) {
  PlanOptions options;
  options.split_hours = 0.03;
  options.stop_every = 4;
  const Plan plan = make_plan(square_job(3), machine("paper"), options);
  ASSERT_GT(plan.programs.size(), 2U);
  expect_planned(plan, "split");
}

/// Each folder of golden/ contains a job and its programs in every dialect. RETRACE_WRITE_GOLDEN=1 rewrites the
/// programs. Review them before you commit them.
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
    EXPECT_EQ(nc.find("1008#1") != std::string::npos, dialect.name == "fanuc") << "roll-over of negative words";
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

/// retrace checks lines of the machine file by the syntax of the dialect. A line that is harmless in one dialect may be
/// unknown in another dialect. If the machine file permits unknown lines, the header of the program names them.
TEST(Dialects, NameLinesThatNobodyChecked) {
  Machine on = for_dialect(machine("ideal"), "a3200");
  const auto text = [&](std::string_view dialect) {
    return nc_text(make_plan(square_job(1, Arrangement::single), on).programs.front(), dialect);
  };
  EXPECT_EQ(text("a3200").find("Not checked"), std::string::npos);
  on.control.mist_on = "DigitalOutputSet(X, 0, 1)";
  EXPECT_EQ(text("automation1").find("Not checked"), std::string::npos);
  EXPECT_EQ(refusal_of([&] { text("a3200"); }), "dialect");
  on.control.has_unchecked_lines = true;
  EXPECT_NE(text("a3200").find("' Not checked: the line of control.mist_on, which may move axes or wait\n"),
            std::string::npos);
  EXPECT_EQ(text("automation1").find("Not checked"), std::string::npos);
  EXPECT_EQ(text("rs274ngc").find("Not checked"), std::string::npos) << "RS-274/NGC has its own words for mist";
}

TEST(Dialects, WriteNumbersInFixedPoint) {
  Program program;
  program.subroutines.push_back({101, "a routine", {increment(Motion::plunge, {0, -1, 2000000}, 12.5)}});
  Move up;
  up.to[kZ] = 5000000;
  Move turn;
  turn.to[kTilt] = -1;
  turn.to[kC] = 450000000;
  program.items = {up, turn, CycleCall{3, 0, {-123, 1000000000, 7}}};
  const std::string text = nc_text(program, "rs274ngc");
  EXPECT_NE(text.find("G1 Y-0.000001 Z2.000000 F12.500\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G0 A-0.0000001 C45.0000000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G0 X-0.000123 Y1000.000000\nG0 Z0.000007\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace retrace::fabrication::test::linuxcnc_test
