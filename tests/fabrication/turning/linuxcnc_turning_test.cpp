#include <gtest/gtest.h>

#include "fabrication/post/post.h"
#include "fabrication/turning/plan/path.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/linuxcnc.h"
#include "tests/fabrication/turning/paths.h"

// Tests of turning programs with the interpreter of LinuxCNC. Their moves have times instead of feeds. The interpreter
// must make the planned moves in the planned times.

namespace retrace::fabrication::turning::linuxcnc_turning_test {
namespace {

using namespace geometry;
using namespace jets;

const InputLocation kHere{"part.toml", 3, "path"};

FreeformSurface wavy() {
  Sag sag;
  sag.formula = parse_formula("0.1*x^2-0.05*y^3+0.02*sin(5*x)*y", sag_variables(), kHere);
  return {sag, std::nullopt, {}, kHere};
}

/// Compares a path with the moves that the interpreter prints: each point, and the time to reach it from the previous
/// point.
void expect_path(const Path& path, AxisWords& at, const std::vector<test::CanonicalMove>& moves, std::size_t& next) {
  constexpr double kPrinted = 1e-4;  // rounding of printed positions
  for (const Move& move : path.moves) {
    ASSERT_LT(next, moves.size());
    const test::CanonicalMove& read = moves[next++];
    const geometry::Vec3 from(millimetres(*at[kX]), millimetres(*at[kY]), millimetres(*at[kZ]));
    go_to(at, move.to);
    const geometry::Vec3 to(millimetres(*at[kX]), millimetres(*at[kY]), millimetres(*at[kZ]));
    ASSERT_FALSE(read.rapid);
    for (const Axis axis : {kX, kY, kZ}) ASSERT_NEAR(read.at[axis], to[axis], kPrinted);
    ASSERT_NEAR(read.at[5], degrees(*at[kC]), kPrinted);
    // The interpreter converts a time to a feed along X, Y and Z.
    ASSERT_NEAR(read.feed, (to - from).norm() / move.seconds * 60.0, 1e-4 + 1e-6 * read.feed);
  }
}

void expect_read(const std::vector<Pass>& passes, const PathOptions& options) {
  const Program program = turning_program(passes, options, "part", {"a turned part"});
  const std::string printed = test::interpreted(nc_text(program, "rs274ngc"));
  EXPECT_NE(printed.find("feed mode set to inverse time"), std::string::npos);
  EXPECT_NE(printed.find("SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS"), std::string::npos);
  EXPECT_NE(printed.find("PROGRAM_END()"), std::string::npos);
  const std::vector<test::CanonicalMove> moves = test::canonical_moves(printed);
  std::size_t next = 0;
  AxisWords at{};
  for (const Item& item : program.items) {
    if (const auto* const path = std::get_if<Path>(&item)) {
      expect_path(*path, at, moves, next);
      continue;
    }
    const auto& move = std::get<Move>(item);
    go_to(at, move.to);
    ASSERT_LT(next, moves.size());
    EXPECT_EQ(moves[next].rapid, move.motion == Motion::rapid);
    EXPECT_EQ(moves[next].feed, move.feed_mm_per_min);
    for (const Axis axis : {kX, kY, kZ}) EXPECT_NEAR(moves[next].at[axis], millimetres(at[axis].value_or(0)), 1e-4);
    ++next;
  }
  EXPECT_EQ(next, moves.size());
}

TEST(LinuxCncTurning, SpiralsInTheirTimes) {
  PathOptions o;
  o.radius_mm = 1.0;
  o.feed_mm = 0.05;
  o.points_per_turn = 90;
  for (const double skew : {0.0, 20.0})
    for (const Servo servo : {Servo::slow, Servo::fast}) {
      TurningTool tool;
      tool.nose_radius_mm = 0.1;
      tool.skew_deg = skew;
      o.servo = servo;
      expect_read(make_path(wavy(), tool, o, kHere), o);
    }
}

TEST(LinuxCncTurning, RastersInTheirTimes) {
  const PathOptions o = raster_of(1.0, 0.3, 0.05, 0.02);
  for (const double skew : {0.0, -25.0}) {
    TurningTool tool;
    tool.nose_radius_mm = 0.1;
    tool.skew_deg = skew;
    expect_read(make_path(wavy(), tool, o, kHere), o);
  }
}

}  // namespace
}  // namespace retrace::fabrication::turning::linuxcnc_turning_test
