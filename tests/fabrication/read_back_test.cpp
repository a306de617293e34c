#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/jobs.h"
#include "tests/fabrication/nc_record.h"
#include "tests/support/refusals.h"

// Tests that the readers, which share no code with planner and writers, read the programs of every dialect back to the
// planned axis positions.

namespace retrace::fabrication::test::read_back_test {
namespace {

using geometry::Arrangement;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

struct ReadBack {
  double worst_linear_mm = 0.0;
  double worst_rotary_deg = 0.0;
  std::size_t moves = 0;
};

double distance_mm(double read, const std::optional<Nanometres>& planned) {
  return planned ? std::abs(read - static_cast<double>(*planned) / kNanometresPerMm) : 0.0;
}

/// Writes a program, reads it back and returns the deviations. Throws if the moves differ in kind, number, feed or
/// dwell.
ReadBack read_back(const Program& program, NcDialect dialect) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
  };
  const std::string_view word = kNcDialectWords[static_cast<std::size_t>(dialect)];
  const std::string text = nc_text(program, word);
  require(recognise_dialect(text, "p") == dialect, "the dialect is not recognised");
  const Record record = record_of(text, dialect, control_texts());
  require(record.end.is_complete, "the program is not complete");
  std::vector<PlannedMove> planned;
  double dwell_s = 0.0;
  for_each_move(program, [&](const PlannedMove& move) {
    planned.push_back(move);
    dwell_s += move.dwell_s;
  });
  require(planned.size() == record.motions.size(), "there are not as many moves as planned");
  ReadBack result;
  result.moves = planned.size();
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const NcMotion& read = record.motions[i];
    require((read.move == NcMove::rapid) == planned[i].is_rapid(), "rapid and feed are mixed up");
    require(std::abs(read.feed_mm_per_min - planned[i].move.feed_mm_per_min) < 1e-9, "a feed differs");
    const AxisWords& to = planned[i].at;
    for (const double d :
         {distance_mm(read.to.x_mm, to[kX]), distance_mm(read.to.y_mm, to[kY]), distance_mm(read.to.z_mm, to[kZ])})
      result.worst_linear_mm = std::max(result.worst_linear_mm, d);
    if (!to[kTilt]) continue;
    // Positions of a modulo axis are known only up to full rotations.
    for (const double d : {read.to.a_deg - degrees(*to[kTilt]), read.to.c_deg - degrees(*to[kC])})
      result.worst_rotary_deg = std::max(result.worst_rotary_deg, std::abs(std::remainder(d, 360.0)));
  }
  for (const Record::Dwell& dwell : record.dwells) dwell_s -= dwell.seconds;
  require(std::abs(dwell_s) < 1e-6, "dwells differ");
  require(record.settings.absolute && record.settings.exact_stop == true &&
              (has_own_texts(dialect) || record.settings.spindle == NcSpindle::stopped),
          "a setting is missing");
  return result;
}

RC_GTEST_PROP(ReadBack, EveryDialectToThePlannedPositions, ()) {
  Job job = square_job(*rc::gen::inRange(1, 4),
                       *rc::gen::element(Arrangement::aligned, Arrangement::offset, Arrangement::checker));
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.process.roughing_depth_um = *rc::gen::inRange(12, 60);
  job.process.finishing_depth_um = *rc::gen::inRange(1, 6);
  job.process.finishing_cuts = *rc::gen::inRange(1, 4);
  job.process.plough_length_mm = 1e-4 * *rc::gen::inRange(700, 2000);
  job.process.slow_retract_um = *rc::gen::element(0.0, 5.0);
  job.process.plough_lift_um = *rc::gen::element(0.0, 2.0);
  job.process.dwell_s = *rc::gen::element(0.0, 0.1, 0.125);
  prism_of(job).apex_angle_deg = 85.0 + 1e-3 * *rc::gen::inRange(0, 10001);
  const Machine on = machine(*rc::gen::element(std::string("ideal"), std::string("paper"), std::string("thesis")));
  for (const NcDialect dialect : {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                                  NcDialect::a3200, NcDialect::automation1})
    for (const Program& program :
         make_plan(job, for_dialect(on, kNcDialectWords[static_cast<std::size_t>(dialect)])).programs) {
      const ReadBack result = read_back(program, dialect);
      RC_ASSERT(result.moves > 10U);
      RC_ASSERT(result.worst_linear_mm < 1e-9);  // a thousandth of the required nanometre
      RC_ASSERT(result.worst_rotary_deg < 1e-11);
    }
}

/// Positions are computed from rounded poses and rounded to the increments of a Fanuc control, so that no accuracy is
/// lost when they are written.
TEST(ReadBack, EveryIncrementSystemSaysWhatWasPlanned) {
  Job job = square_job(2, Arrangement::checker);
  job.process.roughing_depth_um = job.process.finishing_depth_um = 20.0;  // minimum depth that increments of 1 um allow
  for (std::size_t system = 0; system < std::size(kIncrementSystemWords); ++system) {
    Machine on = machine("paper");
    on.control.increment_system = static_cast<IncrementSystem>(system);
    on = for_dialect(on, "fanuc");
    const Program program = make_plan(job, on).programs.front();
    const ReadBack result = read_back(program, NcDialect::fanuc);
    EXPECT_LT(result.worst_linear_mm, 1e-9) << kIncrementSystemWords[system];
    EXPECT_LT(result.worst_rotary_deg, 1e-9) << kIncrementSystemWords[system];
    const std::string text = nc_text(program, "fanuc");
    const std::size_t point = text.find('.', text.find("G0 Z"));
    EXPECT_EQ(text.find_first_not_of("0123456789", point + 1) - point - 1, 3 + system);
    EXPECT_NE(text.find(fmt::format("increment system IS-{}", kIncrementSystemWords[system])), std::string::npos);
  }
}

TEST(ReadBack, WhatAnIncrementSystemCannotSayIsRefused) {
  Program program;
  Move far;
  far.to[kZ] = 1'000'000'000;
  program.items = {far};
  EXPECT_EQ(refusal_of([&] { nc_text(program, "fanuc"); }), "dialect");
  program.control.increment_system = IncrementSystem::d;
  EXPECT_NE(nc_text(program, "fanuc").find("G0 Z1000.00000\n"), std::string::npos);
  far.motion = Motion::plunge;
  far.feed_mm_per_min = 10000.0;
  program.items = {far};
  EXPECT_EQ(refusal_of([&] { nc_text(program, "fanuc"); }), "dialect");
}

/// Words of a modulo axis are within one rotation, and the axis rotates in the shorter direction. In paths, the words
/// of the axis are increments.
TEST(ReadBack, ModuloAxesOfASinumerik) {
  Program program;
  Move up, turn, back, cut;
  up.to[kZ] = 5'000'000;
  turn.to[kTilt] = -10'000'000;
  turn.to[kC] = -1'192'463;
  back.to[kC] = 1'900'000'000;
  cut.motion = Motion::plough;
  cut.seconds = 1.0;
  cut.to[kC] = 720'000'000'000;
  program.items = {up, turn, back, Path{{cut}}};
  const std::string text = nc_text(program, "sinumerik");
  EXPECT_NE(text.find("G0 A-1.0000000 C=DC(359.8807537)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G0 C=DC(190.0000000)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("G1 C=IC(71810.0000000)"), std::string::npos) << text;
  const Record record = record_of(text, NcDialect::sinumerik);
  ASSERT_EQ(record.motions.size(), 4U);
  EXPECT_NEAR(record.motions[1].to.c_deg, -0.1192463, 1e-9);
  EXPECT_NEAR(record.motions[2].to.c_deg, -170.0, 1e-9);
  EXPECT_NEAR(record.motions[3].to.c_deg, 72000.0 - 360.0, 1e-6);
  program.control.modulo_axes = "";
  EXPECT_NE(nc_text(program, "sinumerik").find("G0 A-1.0000000 C-0.1192463\n"), std::string::npos);
}

/// The duration of a move on an Aerotech control is the path length divided by the programmed speed. The path length
/// combines mm and degrees.
TEST(ReadBack, TimesOfAnAerotechsPathAreThoseOfItsWays) {
  Program program;
  Move up, over, cut;
  up.to[kZ] = 5'000'000;
  over.to[kX] = over.to[kY] = over.to[kC] = 0;
  cut.motion = Motion::plough;
  cut.seconds = 2.0;
  cut.to[kX] = 3'000'000;
  cut.to[kC] = 40'000'000;
  program.items = {up, over, Path{{cut}}};
  EXPECT_NE(nc_text(program, "a3200").find("G108\nG1 X3.000000 C4.0000000 F150.000000\nG109\n"), std::string::npos);
  for (const NcDialect dialect : {NcDialect::a3200, NcDialect::automation1}) {
    const std::string text = nc_text(program, kNcDialectWords[static_cast<std::size_t>(dialect)]);
    EXPECT_DOUBLE_EQ(record_of(text, dialect).motions.back().duration_s, 2.0) << text;
  }
  program.items.emplace_back(Path{{cut}, {}});
  EXPECT_EQ(refusal_of([&] { nc_text(program, "a3200"); }), "dialect");
  EXPECT_NE(nc_text(program, "pmac"), "");
}

/// No dialect rounds the minimum feed of a job to 0. A feed that is lower by 0.1 % is rounded to 0.
TEST(ReadBack, TheLeastFeedIsNoneOfZero) {
  Job job = square_job(1);
  for (const auto& [feed, is_said] : {std::pair{kMinFeedMmPerMin, true}, {0.999 * kMinFeedMmPerMin, false}}) {
    job.process.finishing_feed_mm_per_min = feed;
    const Plan plan = make_plan(job, for_dialect(machine("ideal"), ""));
    for (const char* dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"})
      EXPECT_EQ(nc_text(plan.programs.front(), dialect).find(" F0.000\n") == std::string::npos, is_said)
          << dialect << ' ' << feed;
  }
}

/// If the last digit of one word is changed, the positions that are read back must differ by 1 nm.
TEST(ReadBack, ANanometreIsSeen) {
  const Plan plan = make_plan(square_job(1), machine("paper"));
  std::string text = nc_text(plan.programs.front(), "rs274ngc");
  const Record before = record_of(text, NcDialect::rs274ngc);
  const std::size_t word = text.find("G0 X") + 4;
  char& digit = text[text.find('.', word) + 6];
  digit = digit == '9' ? '8' : static_cast<char>(digit + 1);
  const Record after = record_of(text, NcDialect::rs274ngc);
  ASSERT_EQ(before.motions.size(), after.motions.size());
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < before.motions.size(); ++i)
    worst_mm = std::max(worst_mm, std::abs(before.motions[i].to.x_mm - after.motions[i].to.x_mm));
  EXPECT_NEAR(worst_mm, 1e-6, 1e-12);
}

}  // namespace
}  // namespace retrace::fabrication::test::read_back_test
