#include <gtest/gtest.h>

#include "fabrication/planing/io/part_files.h"
#include "fabrication/planing/plan/plan.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/linuxcnc.h"

// The interpreter of LinuxCNC reads the programs of the worked examples. Its moves must equal the planned moves.

namespace retrace::fabrication::linuxcnc_planing_test {
namespace {

void expect_read(const std::string& part_file) {
  const PlaningPlan plan =
      plan_planing(read_planed_part(std::string(RETRACE_SOURCE_DIR) + "/examples/planing/" + part_file));
  for (const PlannedProgram& planned : plan.programs) {
    SCOPED_TRACE(planned.program.name);
    const std::string printed = test::interpreted(nc_text(planned.program, "rs274ngc"));
    EXPECT_NE(printed.find("SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)"), std::string::npos);
    EXPECT_NE(printed.find("PROGRAM_END()"), std::string::npos);
    if (planned.program.spindle) {
      const std::size_t speed = printed.find("SET_SPINDLE_SPEED(0, 300");
      const std::size_t start = printed.find("START_SPINDLE_CLOCKWISE(0");
      ASSERT_NE(speed, std::string::npos) << printed.substr(0, 2000);
      ASSERT_NE(start, std::string::npos) << printed.substr(0, 2000);
      EXPECT_LT(start, printed.find("STRAIGHT_TRAVERSE("));
      EXPECT_GT(printed.rfind("STOP_SPINDLE_TURNING(0"), printed.rfind("STRAIGHT_FEED("));
    }
    const std::vector<test::CanonicalMove> moves = test::canonical_moves(printed);
    std::array<double, 3> at{};
    std::size_t next = 0;
    for (const auto& item : planned.program.items) {
      const auto* const move = std::get_if<Move>(&item);
      if (move == nullptr) continue;
      for (const Axis axis : {kX, kY, kZ})
        if (move->to[axis]) at[axis] = millimetres(*move->to[axis]);
      ASSERT_LT(next, moves.size());
      for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(moves[next].at[axis], at[axis], 1e-4) << "move " << next;
      for (std::size_t axis = 3; axis < 6; ++axis) ASSERT_EQ(moves[next].at[axis], 0.0);
      ASSERT_EQ(moves[next].rapid, (move->motion == Motion::rapid)) << "move " << next;
      ASSERT_EQ(moves[next].feed, move->feed_mm_per_min);
      ++next;
    }
    EXPECT_EQ(next, moves.size());
    EXPECT_GT(next, 30U);
  }
}

TEST(LinuxCncPlaning, MillMovesAsPlanned) {
  expect_read("zone_lens_60ghz.toml");
}

TEST(LinuxCncPlaning, LatheMovesAsPlanned) {
  expect_read("round_zone_lens.toml");
}

}  // namespace
}  // namespace retrace::fabrication::linuxcnc_planing_test
