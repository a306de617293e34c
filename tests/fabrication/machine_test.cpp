#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/machine.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::machine_test {
namespace {

using geometry::Vec3;

Machine shipped(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name + ".toml");
}

TEST(Machine, WordsAreTheWorkpieceFrameWhenNothingIsTurned) {
  for (const char* name : {"ideal", "paper", "thesis"}) {
    const AxisPositions axes = inverse(shipped(name), Vec3(3.5, -7.25, 1.125), {0, 0});
    EXPECT_EQ(axes.x_mm, 3.5) << name;
    EXPECT_EQ(axes.y_mm, -7.25) << name;
    EXPECT_EQ(axes.z_mm, 1.125) << name;
  }
}

Vec3 point_within(double size_mm) {
  const auto coordinate = [&] { return size_mm * 1e-6 * *rc::gen::inRange(-1000000, 1000001); };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

RotaryPose any_pose() {
  const double a = 1e-4 * *rc::gen::inRange(-200000, 1100001);
  return {a, 1e-4 * *rc::gen::inRange(-3600000, 3600001)};
}

RC_GTEST_PROP(Machine, ForwardUndoesInverse, ()) {
  Machine machine = shipped(*rc::gen::element(std::string("ideal"), std::string("paper"), std::string("thesis")));
  machine.a.point_mm.value = point_within(50);
  machine.c.point_mm.value = point_within(50);
  machine.a.sign.value = *rc::gen::element(1.0, -1.0);
  machine.c.sign.value = *rc::gen::element(1.0, -1.0);
  machine.y.direction.value = Vec3(1e-3, 1, -2e-3).normalized();
  machine.mount.offset_mm.value = point_within(1);
  machine.mount.rotation_deg.value = point_within(1);
  const Vec3 point = point_within(100);
  const AxisPositions axes = inverse(machine, point, any_pose());
  RC_ASSERT((forward(machine, axes).reference_mm - point).norm() < 1e-12);
}

/// Tests poses for random directions of the axes. In the solved pose, the facet is in the plane in which the tool
/// plunges. In this plane, the root (the line in which both facets of a prism meet) is rotated by the returned tilt.
RC_GTEST_PROP(Machine, SolvedPoseStandsTheFacet, ()) {
  Machine machine = shipped("ideal");
  machine.a.direction.value = (Vec3(1, 0, 0) + 1e-2 * point_within(1)).normalized();
  machine.c.direction.value = (Vec3(0, 0, 1) + 1e-2 * point_within(1)).normalized();
  machine.a.sign.value = *rc::gen::element(1.0, -1.0);
  machine.c.sign.value = *rc::gen::element(1.0, -1.0);
  machine.mount.rotation_deg.value = point_within(0.5);
  const double half_apex = (30.0 + 1e-4 * *rc::gen::inRange(0, 300000)) * std::numbers::pi / 180.0;
  const double azimuth = 1e-6 * *rc::gen::inRange(0, 6283185);
  const Vec3 root(std::cos(azimuth), std::sin(azimuth), 0);
  const Vec3 normal = std::cos(half_apex) * Vec3(0, 0, 1).cross(root) * -1.0 + std::sin(half_apex) * Vec3(0, 0, 1);
  const RotaryPose near = {machine.a.sign.value * half_apex * 180.0 / std::numbers::pi,
                           -machine.c.sign.value * azimuth * 180.0 / std::numbers::pi};
  const PlungePose solved = solve_plunge_pose(machine, normal, root, near);
  const RigidMotion motion = machine_from_workpiece(machine, solved.pose);
  const Vec3 edge = tool_rotation(machine) * Vec3(1, 0, 0);
  const Vec3 plunged = edge.cross(Vec3(0, 0, 1)).normalized();
  RC_ASSERT((motion.direction(normal) - plunged).norm() < 1e-14);
  // The root remains in the plane of the facet. Its rotation is measured from the projection of the tool's edge onto
  // this plane.
  const Vec3 level = (edge - plunged * plunged.dot(edge)).normalized();
  const Vec3 expected_root = rotation_about(plunged, solved.root_tilt) * level;
  RC_ASSERT((motion.direction(root) - expected_root).norm() < 1e-14);
  RC_ASSERT(std::abs(solved.pose.a_deg - near.a_deg) < 5.0);
  RC_ASSERT(std::abs(solved.pose.c_deg - near.c_deg) < 5.0);
}

TEST(Machine, AFacetThatNoPoseReaches) {
  EXPECT_THROW(solve_plunge_pose(shipped("paper"), Vec3(0, 0, 1), Vec3(1, 0, 0), {45, 0}), InputError);
}

TEST(Machine, LimitsNameTheAxis) {
  const Machine machine = shipped("ideal");
  EXPECT_TRUE(limit_excesses(machine, {0, 0, 0, 45, 0}).empty());
  const auto excesses = limit_excesses(machine, {0, -120.001, 0, 110.5, 0});
  ASSERT_EQ(excesses.size(), 2U);
  EXPECT_EQ(excesses[0].axis, 'Y');
  EXPECT_EQ(excesses[1].axis, 'A');
  EXPECT_EQ(excesses[1].limits.high, 110.0);
}

TEST(MachineFile, EveryShippedValueSaysWhereItComesFrom) {
  for (const char* name : {"ideal", "paper", "thesis"}) {
    const Machine machine = shipped(name);
    EXPECT_EQ(machine.name, name);
    EXPECT_FALSE(machine.a.direction.source.empty());
    EXPECT_NEAR(machine.a.direction.value.norm(), 1.0, 1e-15) << "directions are normalised";
  }
  EXPECT_EQ(shipped("paper").a.direction.basis, Basis::measured);
  EXPECT_EQ(shipped("paper").c.direction.basis, Basis::measured);
  EXPECT_EQ(shipped("thesis").a.direction.basis, Basis::measured);
  EXPECT_EQ(shipped("thesis").c.direction.basis, Basis::assumed);
  EXPECT_EQ(shipped("ideal").a.direction.basis, Basis::assumed);
}

/// Returns file, line and key of the error for a machine file in which `from` is replaced by `to`, and records the
/// message of this error.
std::string refusal(const std::string& from, const std::string& to) {
  const std::string text = read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml");
  return refusal_of([&] { parse_machine(with_replaced(text, from, to), "m.toml"); }, "accepted");
}

/// Returns file, line and key of the error like refusal(), but does not record the message.
std::string unrecorded_refusal(const std::string& from, const std::string& to) {
  const std::string text = read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml");
  return unrecorded_refusal_of([&] { parse_machine(with_replaced(text, from, to), "m.toml"); }, "accepted");
}

TEST(MachineFile, BadInputIsRefusedOnOneLine) {
  expect_change_refusals(refusal,
                         {{"[0.999995, -0.0014502, 0.00268292]", "[0, 0, 0]", "m.toml:31: a.direction.value"},
                          {"[0.999995, -0.0014502, 0.00268292]", "[0, 1]", "m.toml:31: a.direction.value"},
                          {"[0.999995, -0.0014502, 0.00268292]", "[nan, 0, 0]", "m.toml:31: a.direction.value"},
                          {"[0.999995, -0.0014502, 0.00268292]", "[0, 0, 1]", "m.toml:37: c"},
                          {"value = [-120, 120]", "value = [120, -120]", "m.toml:10: x.limits_mm.value"},
                          {"value = 10,", "value = 0,", "m.toml:34: a.speed_deg_per_s.value"},
                          {"sign = { value = 1,", "sign = { value = 2,", "m.toml:32: a.sign.value"},
                          {"assumed = \"square guideways\"", "assumed = \"\"", "m.toml:9: x.direction"},
                          {", assumed = \"square guideways\"", "", "m.toml:9: x.direction"},
                          {"[z]", "[w]", "m.toml:22: w"},
                          {"moves_with = \"tool\"", "moves_with = \"spindle\"", "m.toml:52: body[2].moves_with"}});
  const std::string box = "box_mm = { value = [-60, -60, -40, 60, 60, -15]";
  EXPECT_EQ(refusal(box, "points_mm = { value = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]"),
            "m.toml:48: body[1].points_mm.value");
  EXPECT_EQ(refusal(box, "points_mm = { value = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]"),
            "m.toml:48: body[1].points_mm.value");
  EXPECT_EQ(refusal(box, "points_mm = { value = [[0, 0], [1, 0], [0, 1], [1, 1]]"),
            "m.toml:48: body[1].points_mm.value");
  EXPECT_EQ(refusal(box, "points_mm = { value = 5"), "m.toml:48: body[1].points_mm.value");
  EXPECT_EQ(refusal("retrace.machine/1", "retrace.machine/2"), "m.toml:3: schema");
}

/// Programs contain the lines of the machine file unchanged. retrace accepts lines that neither move an axis nor wait.
/// It refuses all other lines unless the machine file permits them.
TEST(MachineFile, LinesOfAnIntegratorAreKnownOrPermitted) {
  EXPECT_EQ(refusal("[z]", "[control]\nmist_on = \"M0\"\n[z]"), "m.toml:23: control.mist_on");
  const auto file_with = [](const std::string& lines) {
    return unrecorded_refusal("[z]", "[control]\n" + lines + "[z]");
  };
  for (const char* line : {"linear Z-3 F100",
                           "X5",
                           "rapid Z50",
                           "close",
                           "abs",
                           "dwell 100",
                           "x (P1)",
                           "P1=2 Z-3",
                           "call 900",
                           "Coord[1].NoBlend=0",
                           "G91",
                           "VELOCITY ON",
                           "MoveLinear([X], [5])",
                           "end",
                           "POSOFFSET SET X 0",
                           "SetupTaskTargetMode(TargetMode.Incremental)",
                           "cmd'#3j=-100'",
                           "while(1)",
                           "FreeRunOn(Z,5)",
                           "jog Z=-50",
                           "Disable(Z)",
                           "MistOn=1",
                           "ccall 3",
                           "P1=P2",
                           "M0",
                           "M1",
                           "M2",
                           "M30",
                           "M98",
                           "M99",
                           "M7 M0",
                           "P1=1 M0",
                           "DigitalOutputSet(X, 0, 1) MoveAbsolute(Z, 1, 1)",
                           "$global[0]=1 Z5",
                           "M7.5",
                           "P=1",
                           "M"}) {
    const std::string given = fmt::format("mist_on = \"{}\"\n", line);
    EXPECT_EQ(file_with(given), "m.toml:23: control.mist_on");
    EXPECT_EQ(file_with(given + "has_unchecked_lines = true\n"), "accepted") << line;
  }
  EXPECT_NE(file_with("stop = \"linear X1\"\n"), "accepted");
  EXPECT_NE(file_with("stop = \"M2\"\n"), "accepted");
  EXPECT_NE(file_with("mist_on = \" M7\"\nhas_unchecked_lines = true\n"), "accepted") << "blank at the beginning";
  EXPECT_EQ(refusal("[x]", "warm_up_s = { value = -1, assumed = \"a test\" }\n[x]"), "m.toml:8: warm_up_s.value");
  EXPECT_EQ(file_with("mist_on = \"P1=1\"\noptional_stop = \"P1=1\"\n"), "m.toml:23: control.mist_on");
  for (const char* line : {"P100=1", "P100=-1.5", "M7", "M107", "Gate3[0].GpioData[0].16=1", "$DO[0].X = 1",
                           "DigitalOutputSet(X, 0, 1)", "$rglobal[2] = 0.5"})
    EXPECT_EQ(file_with(fmt::format("mist_on = \"{}\"\n", line)), "accepted") << line;
  for (const char* line : {"M0", "M1", "P100=1"})
    EXPECT_EQ(file_with(fmt::format("stop = \"{}\"\n", line)), "accepted") << line;
}

TEST(MachineFile, BodiesAreBoxesOrHulls) {
  std::string text = read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml");
  EXPECT_EQ(parse_machine(text, "m.toml").bodies[0].points_mm.value.size(), 8U);
  text +=
      "[[body]]\nname = \"ramp\"\nmoves_with = \"cradle\"\npoints_mm = { value = [[0, 0, 0], [1, 0, 0], [0, 1, "
      "0], [0, 0, 2.5]], assumed = \"a test\" }\n";
  const Machine m = parse_machine(text, "m.toml");
  ASSERT_EQ(m.bodies.back().points_mm.value.size(), 4U);
  EXPECT_EQ(m.bodies.back().points_mm.value[3], Vec3(0, 0, 2.5));
  EXPECT_EQ(m.bodies.back().link, KinematicLink::cradle);
}

TEST(MachineFile, UnknownKeysAreRefused) {
  EXPECT_NE(refusal("point_mm", "point"), "accepted");
  EXPECT_NE(refusal("title", "titel"), "accepted");
}

}  // namespace
}  // namespace retrace::fabrication::machine_test
