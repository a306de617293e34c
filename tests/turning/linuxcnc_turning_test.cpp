#include <gtest/gtest.h>

#include <cmath>

#include "fabrication/post/post.h"
#include "fabrication/turning/path.h"
#include "fabrication/turning/turning_program.h"
#include "tests/fabrication/linuxcnc.h"

// LinuxCNC's interpreter reads programs of turning, whose moves have times instead of feeds: it makes the planned moves
// in the planned times.

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

/// The moves of a trace as they are printed, from one point to the next in the time of the point.
void expect_trace(const Trace& trace, const std::vector<test::CanonicalMove>& moves, std::size_t& next) {
  constexpr double kPrinted = 1e-4;  // four decimals
  const auto mm = [](Nanometres nm) { return static_cast<double>(nm) / kNanometresPerMm; };
  for (std::size_t i = 0; i < trace.points.size(); ++i) {
    ASSERT_LT(next, moves.size());
    const test::CanonicalMove& move = moves[next++];
    const TracePoint& p = trace.points[i];
    ASSERT_FALSE(move.rapid);
    ASSERT_NEAR(move.at[0], mm(p.x_nm), kPrinted);
    ASSERT_NEAR(move.at[1], mm(p.y_nm), kPrinted);
    ASSERT_NEAR(move.at[2], mm(p.z_nm), kPrinted);
    ASSERT_NEAR(move.at[5], static_cast<double>(p.c) / kRotaryUnitsPerDeg, kPrinted);
    if (i == 0) {
      ASSERT_EQ(move.feed, trace.approach_feed_mm_per_min);
      continue;
    }
    // The interpreter turns a time into a feed along X, Y and Z.
    const TracePoint& last = trace.points[i - 1];
    const double length = std::hypot(mm(p.x_nm - last.x_nm), mm(p.y_nm - last.y_nm), mm(p.z_nm - last.z_nm));
    ASSERT_NEAR(move.feed, length / p.seconds * 60.0, 1e-4 + 1e-6 * move.feed) << i;
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
  for (const Item& item : program.items) {
    if (const auto* const raise = std::get_if<Raise>(&item)) {
      ASSERT_LT(next, moves.size());
      EXPECT_TRUE(moves[next].rapid);
      EXPECT_NEAR(moves[next++].at[2], static_cast<double>(raise->z_nm) / kNanometresPerMm, 1e-4);
    } else {
      EXPECT_TRUE(moves[next++].rapid) << "over the first point";
      expect_trace(std::get<Trace>(item), moves, next);
    }
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
  PathOptions o;
  o.strategy = Strategy::raster;
  o.width_mm = 1.0;
  o.height_mm = 0.3;
  o.feed_mm = 0.05;
  o.arc_mm = 0.02;
  for (const double skew : {0.0, -25.0}) {
    TurningTool tool;
    tool.nose_radius_mm = 0.1;
    tool.skew_deg = skew;
    expect_read(make_path(wavy(), tool, o, kHere), o);
  }
}

}  // namespace
}  // namespace retrace::fabrication::turning::linuxcnc_turning_test
