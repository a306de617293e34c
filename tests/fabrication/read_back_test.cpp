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
#include "tests/fabrication/jobs.h"
#include "tests/fabrication/nc_record.h"

// The readers, which know nothing of planner and writers, read every dialect back to the planned axis positions.

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

/// Throws if the moves differ in kind, number, feed or dwell.
ReadBack read_back(const Program& program, NcDialect dialect) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
  };
  const std::string_view word = kNcDialectWords[static_cast<std::size_t>(dialect)];
  const std::string text = nc_text(program, word);
  require(recognise_dialect(text, "p") == dialect, "the dialect is not recognised");
  const Record record = record_of(text, dialect);
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
    const Words& to = planned[i].at;
    for (const double d :
         {distance_mm(read.to.x_mm, to[kX]), distance_mm(read.to.y_mm, to[kY]), distance_mm(read.to.z_mm, to[kZ])})
      result.worst_linear_mm = std::max(result.worst_linear_mm, d);
    for (const double d : {read.to.a_deg - degrees(*to[kTilt]), read.to.c_deg - degrees(*to[kC])})
      result.worst_rotary_deg = std::max(result.worst_rotary_deg, std::abs(d));
  }
  for (const Record::Dwell& dwell : record.dwells) dwell_s -= dwell.seconds;
  require(std::abs(dwell_s) < 1e-6, "dwells differ");
  require(
      record.settings.absolute && record.settings.exact_stop == true && record.settings.spindle == NcSpindle::stopped,
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
  const Plan plan =
      make_plan(job, machine(*rc::gen::element(std::string("ideal"), std::string("paper"), std::string("thesis"))));
  for (const Program& program : plan.programs)
    for (const NcDialect dialect : {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac}) {
      const ReadBack result = read_back(program, dialect);
      RC_ASSERT(result.moves > 10U);
      RC_ASSERT(result.worst_linear_mm < 1e-9);  // a thousandth of the nanometre that is asked for
      RC_ASSERT(result.worst_rotary_deg < 1e-11);
    }
}

/// The least feed that a job may have is the least that every dialect can say.
TEST(ReadBack, TheLeastFeedIsNoneOfZero) {
  Job job = square_job(1);
  for (const auto& [feed, is_said] : {std::pair{kLeastFeedMmPerMin, true}, {0.999 * kLeastFeedMmPerMin, false}}) {
    job.process.finishing_feed_mm_per_min = feed;
    const Plan plan = make_plan(job, machine("ideal"));
    for (const char* dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac"})
      EXPECT_EQ(nc_text(plan.programs.front(), dialect).find(" F0.000\n") == std::string::npos, is_said)
          << dialect << ' ' << feed;
  }
}

/// Whoever takes the last digit off every word is found out: the comparison can fail.
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
