#include "fabrication/chisel/plan/plan.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/plan/move_time.h"
#include "fabrication/chisel/plan/routines.h"
#include "fabrication/job/tool_angles.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/motion_time.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests of plans: cuts, poses (axis angles at which facets are cut), order, safety of moves and time. The expected
// values are those of the thesis, or follow from the forward kinematics of the machine.

namespace retrace::fabrication::test::plan_test {
namespace {

using geometry::Arrangement;
using geometry::Vec3;

constexpr double kArcminPerRad = 60.0 * 180.0 / 3.14159265358979323846;
const std::vector<std::string> kMachines = {"ideal", "paper", "thesis"};

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

Job job_of(double base_mm, double depth_um, Strategy strategy) {
  Job job = square_job(1);
  prism_of(job).base_mm = prism_of(job).width_mm = base_mm;
  job.tool.width_mm = base_mm;
  job.process.roughing_depth_um = depth_um;
  job.strategy = strategy;
  return job;
}

AxisPositions axes_of(const AxisWords& p) {
  return {millimetres(*p[kX]), millimetres(*p[kY]), millimetres(*p[kZ]), degrees(*p[kTilt]), degrees(*p[kC])};
}

std::vector<PlannedMove> moves_of(const Plan& plan) {
  std::vector<PlannedMove> moves;
  for (const Program& program : plan.programs)
    for_each_move(program, [&](const PlannedMove& move) { moves.push_back(move); });
  return moves;
}

std::vector<CycleCall> visits_of(const Plan& plan) {
  std::vector<CycleCall> visits;
  for (const Program& program : plan.programs)
    for (const Item& item : program.items)
      if (const auto* visit = std::get_if<CycleCall>(&item)) visits.push_back(*visit);
  return visits;
}

/// Returns the lengths of the plunges below the face of the blank, in order.
std::vector<double> plunge_lengths_mm(const Job& job) {
  const CuttingPose pose = cutting_pose(job, machine("ideal"), {}, 0.0);
  const Routine routine = unidirectional_routine(job, pose.section);
  const double approach_mm = job.process.clearance_mm * std::sqrt(2.0);
  std::vector<double> lengths;
  for (const Step& step : routine.subroutine.steps)
    if (const auto* move = std::get_if<Move>(&step); move != nullptr && move->motion == Motion::plunge)
      lengths.push_back(-1e-6 * static_cast<double>(*move->to[kZ]) - approach_mm);
  return lengths;
}

TEST(Cuts, AreThoseOfTheThesis) {
  // Milliken 2017, 4.1.3: a prism of 1 mm with a depth of cut of 10 um takes 71 cuts. The last three are 687.1, 697.1
  // and 707.1 um long.
  const std::vector<double> lengths = plunge_lengths_mm(job_of(1.0, 10.0, Strategy::unidirectional));
  ASSERT_EQ(lengths.size(), 71U);
  EXPECT_NEAR(lengths.front(), 0.0071, 6e-5);
  EXPECT_NEAR(lengths[68], 0.6871, 6e-5);
  EXPECT_NEAR(lengths[69], 0.6971, 6e-5);
  EXPECT_NEAR(lengths.back(), std::sqrt(0.5), 1e-6);
}

TEST(Cuts, OfLayersRemoveAsMuchFromEitherFacet) {
  // The layers are nested V-shaped shells. The root of shell i is (N - i) sqrt(2) DOC above the root of the design,
  // with the number of shells N and the depth of cut DOC. N is therefore half of the 71 cuts of the unidirectional
  // strategy.
  EXPECT_EQ(cuts_per_facet(job_of(1.0, 10.0, Strategy::bidirectional)), 36);
}

TEST(Tool, AnglesAreThoseOfTheThesis) {
  Tool tool;
  EXPECT_DOUBLE_EQ(plunge_angles(tool).rake_deg, 37.0);
  EXPECT_DOUBLE_EQ(plough_angles(tool).rake_deg, -53.0);
  EXPECT_DOUBLE_EQ(plough_angles(tool).clearance_deg, 93.0);
  for (const CuttingAngles& angles : {plunge_angles(tool), plough_angles(tool)})
    EXPECT_DOUBLE_EQ(angles.clearance_deg + tool.wedge_deg + angles.rake_deg, 90.0);
}

TEST(Passes, LieSideBySide) {
  EXPECT_EQ(pass_offsets_mm(0.451, 0.451), std::vector<double>{0.0});
  EXPECT_EQ(pass_offsets_mm(0.451, 0.451 + 1e-6).size(), 1U);
  const std::vector<double> three = pass_offsets_mm(1.0, 0.4);
  ASSERT_EQ(three.size(), 3U);
  EXPECT_NEAR(three.front() - 0.2, -0.5, 1e-12) << "the first ends at the border";
  EXPECT_NEAR(three.back() + 0.2, 0.5, 1e-12);
  EXPECT_LE(three[1] - three[0], 0.4);
}

TEST(Poses, StandThePlungedFacetUpright) {
  for (const std::string& name : kMachines)
    for (const double apex_deg : {80.0, 90.0, 90.2, 110.0})
      for (const bool rotated : {false, true})
        for (const int facet : {1, 2}) {
          Job job = square_job(2, Arrangement::checker);
          prism_of(job).apex_angle_deg = apex_deg;
          const Machine m = machine(name);
          const CuttingPose pose = cutting_pose(job, m, {rotated, facet}, 0.0);
          const RigidMotion motion = machine_from_workpiece(m, pose.rounded);
          const Vec3 normal = motion.direction(facet_normal(prism_of(job), {rotated, facet}));
          EXPECT_LT(kArcminPerRad * std::acos(std::min(1.0, -normal.y())), 0.01)
              << name << " apex " << apex_deg << " facet " << facet << (rotated ? " turned" : "");
          EXPECT_GT(motion.direction(pose.root).x(), 0.999);
        }
}

TEST(Poses, LeaveThePredictedRotation) {
  // Expected residual rotation about the normal of the facet, in arc minutes.
  struct Expected {
    std::string machine;
    int facet;
    double a_deg;
    double c_deg;
    double delta_arcmin;
  };
  const Expected all[] = {{"paper", 1, 45.000155, -0.119246, 1.17},
                          {"paper", 2, 45.055168, 179.898541, 2.69},
                          {"thesis", 1, 45.000002, -0.015492, -0.75},
                          {"thesis", 2, 45.000002, 179.984508, -0.75}};
  for (const Expected& e : all) {
    const CuttingPose pose = cutting_pose(square_job(3), machine(e.machine), {false, e.facet}, 0.0);
    EXPECT_NEAR(pose.rounded.a_deg, e.a_deg, 1e-6) << e.machine;
    EXPECT_NEAR(pose.rounded.c_deg, e.c_deg, 1e-6) << e.machine;
    EXPECT_NEAR(std::abs(60.0 * pose.root_tilt.deg()), std::abs(e.delta_arcmin), 0.006) << e.machine;
  }
}

/// Returns the signed distance of a point of the workpiece from a facet of an element, in nm. It is positive outside of
/// the material.
double distance_nm(const Job& job, const CutElement& element, int facet, const Vec3& point) {
  const Vec3 root(element.centre_mm.x(), element.centre_mm.y(), -root_depth_mm(blank_prism(job)));
  return 1e6 * facet_normal(blank_prism(job), {element.rotated, facet}).dot(point - root);
}

/// Returns both ends of the tool's edge in the workpiece frame at the given axis words.
std::array<Vec3, 2> edge_ends(const Job& job, const Machine& m, const AxisWords& at) {
  const ToolPose tool = forward(m, axes_of(at));
  const Vec3 half = tool.workpiece_from_machine * Vec3(0.5 * job.tool.width_mm, 0.0, 0.0);
  return {Vec3(tool.reference_mm - half), Vec3(tool.reference_mm + half)};
}

TEST(Plunges, EndWhereTheDeeperEndTouchesTheOtherFacetAndNeverBelow) {
  for (const std::string& name : kMachines)
    for (const Arrangement arrangement : {Arrangement::offset, Arrangement::checker})
      for (const double apex_deg : {90.0, 90.3, 75.0, 100.0}) {
        Job job = square_job(3, arrangement);
        prism_of(job).apex_angle_deg = apex_deg;
        const Machine m = machine(name);
        const Plan plan = make_plan(job, m);
        std::map<std::pair<std::int32_t, int>, std::array<double, 2>> nearest;  // distances to wall and floor
        for (const PlannedMove& move : moves_of(plan)) {
          if (move.is_rapid() || move.move.motion != Motion::plunge) continue;
          const CutElement& element = plan.elements[static_cast<std::size_t>(move.element)];
          double c_deg = 1e-7 * static_cast<double>(*move.at[kC]) - (element.rotated ? 90.0 : 0.0);
          const int wall = std::abs(c_deg) < 45.0 || std::abs(c_deg - 360.0) < 45.0 ? 1 : 2;
          auto [it, is_new] = nearest.try_emplace({move.element, wall}, std::array{1e9, 1e9});
          for (const Vec3& end : edge_ends(job, m, move.at)) {
            it->second[0] = std::min(it->second[0], distance_nm(job, element, wall, end));
            it->second[1] = std::min(it->second[1], distance_nm(job, element, 3 - wall, end));
          }
        }
        ASSERT_EQ(nearest.size(), 2 * plan.elements.size());
        for (const auto& [key, near] : nearest)
          for (const double nm : near) EXPECT_NEAR(nm, 0.0, 1.5) << name << " element " << key.first;
      }
}

TEST(Unidirectional, SlicesAreParallelToFacetOneAndRootsLieOnThePloughedPlane) {
  const Job job = job_of(1.0, 10.0, Strategy::unidirectional);
  const Machine m = machine("ideal");
  const Plan plan = make_plan(job, m);
  const int cuts = plan.cuts_per_facet;
  int cut = 0;
  for (const PlannedMove& move : moves_of(plan)) {
    if (move.is_rapid() || (move.move.motion != Motion::plunge && move.move.motion != Motion::plough)) continue;
    const Vec3 tip = forward(m, axes_of(move.at)).reference_mm;
    EXPECT_NEAR(distance_nm(job, plan.elements[0], 2, tip), 0.0, 1.0) << "on the ploughed plane";
    if (move.move.motion == Motion::plough) continue;
    ++cut;
    EXPECT_NEAR(distance_nm(job, plan.elements[0], 1, tip), 1e4 * (cuts - cut), 1.0) << "cut " << cut;
    EXPECT_DOUBLE_EQ(move.dwell_s, 0.1);
  }
  EXPECT_EQ(cut, 71);
}

TEST(Bidirectional, EveryTipStopsOnTheRootOfItsShell) {
  const Job job = job_of(1.0, 20.0, Strategy::bidirectional);
  const Machine m = machine("ideal");
  const Plan plan = make_plan(job, m);
  std::map<int, int> plunges;  // number for each facet
  for (const PlannedMove& move : moves_of(plan)) {
    if (move.is_rapid() || move.move.motion != Motion::plunge) continue;
    const int facet = *move.at[kC] < 900000000 ? 1 : 2;
    const int layer = ++plunges[facet];
    const Vec3 tip = forward(m, axes_of(move.at)).reference_mm;
    // Each layer ends one depth of cut below the floor of the previous layer.
    for (const int side : {1, 2})
      EXPECT_NEAR(distance_nm(job, plan.elements[0], side, tip), 2e4 * (plan.cuts_per_facet - layer), 1.5);
  }
  EXPECT_EQ(plunges[1], plan.cuts_per_facet);
  EXPECT_EQ(plunges[2], plan.cuts_per_facet);
}

TEST(TwoStep, RoughingStopsShortOfBothFacets) {
  const Job job = square_job(1);
  const Machine m = machine("ideal");
  const Plan plan = make_plan(job, m);
  double least[2] = {1e9, 1e9};
  for (const PlannedMove& move : moves_of(plan)) {
    if (move.is_rapid() || move.move.feed_mm_per_min != job.process.roughing_feed_mm_per_min) continue;
    const Vec3 tip = forward(m, axes_of(move.at)).reference_mm;
    for (const int facet : {1, 2})
      least[facet - 1] = std::min(least[facet - 1], distance_nm(job, plan.elements[0], facet, tip));
  }
  EXPECT_NEAR(least[0], 1e4, 1.0) << "2 x 5 um";
  EXPECT_NEAR(least[1], 1e4, 1.0);
}

TEST(Options, OfTheThesisChangeTheCutAsTheySay) {
  Job job = job_of(1.0, 10.0, Strategy::unidirectional);
  job.process.shortest_plough = true;
  job.tool.edge_radius_um = 0.5;
  const CuttingPose pose = cutting_pose(job, machine("ideal"), {}, 0.0);
  for (const Step& step : unidirectional_routine(job, pose.section).subroutine.steps)
    if (const auto* move = std::get_if<Move>(&step); move != nullptr && move->motion == Motion::plough) {
      EXPECT_EQ(move->to[kY], -10500);
    }
  job.process.shortest_plough = false;
  job.process.plough_lift_um = 3.0;
  int ploughs = 0;
  for (const Step& step : unidirectional_routine(job, pose.section).subroutine.steps)
    if (const auto* move = std::get_if<Move>(&step); move != nullptr && move->motion == Motion::plough) {
      EXPECT_EQ(move->to[kZ].value_or(0), ploughs++ % 2 == 0 ? 0 : 3000);
    }
  EXPECT_EQ(ploughs, 142);
  job.process.slow_retract_um = 8.0;
  const Routine plunge = plunge_routine(job, pose.section, 0.0, 20.0);
  const auto& slow = std::get<Move>(plunge.subroutine.steps[2]);
  EXPECT_FALSE(slow.to[kY]);
  EXPECT_EQ(slow.to[kZ], 8000);
  EXPECT_EQ(slow.feed_mm_per_min, 20.0);
}

TEST(Order, CTurnsOnlyTwicePerFinishingCut) {
  const Machine m = machine("ideal");
  Job job = square_job(5);
  EXPECT_EQ(make_plan(job, m).elements.size(), 23U);
  EXPECT_EQ(make_plan(job, m).c_rotations, 4) << "the thesis: 25 structures, 4 rotations instead of 100";
  EXPECT_EQ(make_plan(square_job(4, Arrangement::checker), m).c_rotations, 8) << "four poses: 4 per cut";
  job.strategy = Strategy::unidirectional;
  EXPECT_EQ(make_plan(job, m).c_rotations, 0);
  job.strategy = Strategy::bidirectional;
  const Plan layers = make_plan(job, m);
  EXPECT_EQ(layers.c_rotations, 2 * layers.cuts_per_facet);
}

TEST(Order, TravelBetweenElementsIsShort) {
  // Rows are visited in alternating directions. The mean travel is hardly longer than one pitch, which is the minimum
  // for any order.
  const Machine m = machine("ideal");
  for (const Arrangement arrangement : {Arrangement::aligned, Arrangement::offset, Arrangement::checker}) {
    const Job job = square_job(20, arrangement);
    const Plan plan = make_plan(
        job, m,
        {.phase = "roughing", .from_element = {}, .from_pass = {}, .stop_every = {}, .split_hours = {}, .before = {}});
    double travel_mm = 0.0;
    int lines = 0;
    std::optional<geometry::Vec2> last;
    for (const CycleCall& visit : visits_of(plan)) {
      const geometry::Vec2& at = plan.elements[static_cast<std::size_t>(visit.element)].centre_mm;
      if (last) travel_mm += (at - *last).norm();
      last = at;
      ++lines;
    }
    // In a checker arrangement, the nearest prisms with the same orientation are diagonal neighbours. Along a row,
    // prisms with the same orientation are two pitches apart.
    const double pitches = arrangement == Arrangement::checker ? 2.0 : arrangement == Arrangement::offset ? 1.15 : 1.0;
    EXPECT_LT(travel_mm, 1.05 * pitches * 0.451 * lines);
  }
}

TEST(Time, WideToolHalvesTheTimePerArea) {
  Job job = square_job(10, Arrangement::aligned);
  const Plan narrow = make_plan(job, machine("ideal"));
  prism_of(job).width_mm = job.tool.width_mm = 0.902;
  job.array.y_length_mm *= 2.0;
  const Plan wide = make_plan(job, machine("ideal"));
  const double ratio =
      (wide.time.total_s() / wide.aperture_area_mm2) / (narrow.time.total_s() / narrow.aperture_area_mm2);
  EXPECT_NEAR(ratio, 0.5, 0.01);
}

TEST(Time, OfAMoveFromRestToRest) {
  EXPECT_DOUBLE_EQ(rest_to_rest_s(10.0, {2.0, 1.0}), 7.0);  // 2 s up to speed, 3 s for a distance of 6, 2 s down
  EXPECT_DOUBLE_EQ(rest_to_rest_s(4.0, {2.0, 1.0}), 4.0);
  EXPECT_DOUBLE_EQ(rest_to_rest_s(1.0, {2.0, 1.0}), 2.0);
  EXPECT_DOUBLE_EQ(rest_to_rest_s(0.0, {2.0, 1.0}), 0.0);
}

/// If a linear axis moves, the length of a move is the path length of the linear axes. Otherwise, the length is
/// computed as if the two angles were Cartesian coordinates, even if only C rotates.
TEST(Time, LengthOfAMove) {
  EXPECT_DOUBLE_EQ((AxisTravel{Vec3(3.0, 0.0, -4.0), 7.0, 30.0}).length(), 5.0);
  EXPECT_DOUBLE_EQ((AxisTravel{Vec3::Zero(), -3.0, 4.0}).length(), 5.0);
  EXPECT_DOUBLE_EQ((AxisTravel{Vec3::Zero(), 0.0, -30.0}).length(), 30.0);
  Machine m = machine("paper");
  m.control.rapids_are_straight = true;
  m.settling_s.value = 0.0;
  const MotionLimits limits = {m.c.speed_deg_per_s.value, m.c.acceleration_deg_per_s2.value, m.c.jerk_deg_per_s3.value};
  EXPECT_DOUBLE_EQ(rotary_move_s(m, 0.0, 30.0), rest_to_rest_s(30.0, limits));
}

/// Simulates an axis that accelerates from rest to `speed` with limited jerk. The jerk is positive until the
/// acceleration reaches its limit. It is negative at the end, so that the acceleration is 0 when the axis reaches
/// `speed`.
/// \return distance and time until the axis reaches `speed`
std::pair<double, double> speeding_up(double speed, const MotionLimits& limits) {
  const double step_s = 1e-5 * (speed / limits.acceleration + std::sqrt(speed / limits.jerk));
  double at = 0.0;
  double v = 0.0;
  double a = 0.0;
  double time_s = 0.0;
  while (v < speed) {
    // While negative jerk reduces the acceleration a to 0, the speed still increases by a^2 / (2 jerk).
    const bool must_fall = v + a * a / (2.0 * limits.jerk) >= speed;
    const double next = must_fall ? a - limits.jerk * step_s : std::min(a + limits.jerk * step_s, limits.acceleration);
    if (must_fall && next <= 0.0) break;
    const double v_next = v + 0.5 * (a + next) * step_s;
    at += 0.5 * (v + v_next) * step_s;
    v = v_next;
    a = next;
    time_s += step_s;
  }
  return {at, time_s};
}

RC_GTEST_PROP(Time, WithJerkIsThatOfTheMotionStepByStep, ()) {
  const auto size = [](double low, double high) {
    return low * std::pow(high / low, 1e-3 * *rc::gen::inRange(0, 1001));
  };
  const MotionLimits limits{size(0.1, 50.0), size(10.0, 5000.0), size(1e2, 1e7)};
  const auto [ramp, ramp_s] = speeding_up(limits.speed, limits);
  // A long move has a section at constant speed. In a short move, the axis accelerates over half of the distance.
  const double way = size(0.01, 10.0);
  RC_ASSERT(std::abs(rest_to_rest_s(2.0 * ramp + way, limits) / (2.0 * ramp_s + way / limits.speed) - 1.0) < 2e-3);
  const double lower = limits.speed * size(0.01, 1.0);
  const auto [half, half_s] = speeding_up(lower, limits);
  RC_ASSERT(std::abs(rest_to_rest_s(2.0 * half, limits) / (2.0 * half_s) - 1.0) < 2e-3);
}

TEST(Time, MovesSettle) {
  Machine m = machine("paper");
  const double before_s = linear_move_s(m, {0.3, 0.0, 0.4}, 60.0);
  const double turn_s = rotary_move_s(m, 0.0, 30.0);
  m.settling_s.value = 0.25;
  EXPECT_DOUBLE_EQ(linear_move_s(m, {0.3, 0.0, 0.4}, 60.0), before_s + 0.25);
  EXPECT_DOUBLE_EQ(rotary_move_s(m, 0.0, 30.0), turn_s + 0.25);
  EXPECT_DOUBLE_EQ(linear_move_s(m, {0.0, 0.0, 0.0}, 60.0), 0.0);
  EXPECT_DOUBLE_EQ(rotary_move_s(m, 0.0, 0.0), 0.0);
}

/// Returns the height of the tool reference point above the face of the blank, in mm.
double height_mm(const Machine& m, const AxisWords& at) {
  return forward(m, axes_of(at)).reference_mm.z();
}

RC_GTEST_PROP(Moves, AreSafe, ()) {
  Job job = square_job(*rc::gen::inRange(2, 6),
                       *rc::gen::element(Arrangement::aligned, Arrangement::offset, Arrangement::checker));
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  prism_of(job).apex_angle_deg = *rc::gen::element(80.0, 90.0, 90.5, 100.0);
  job.tool.width_mm = *rc::gen::element(0.451, 0.3, 0.15);
  job.process.roughing_depth_um = *rc::gen::element(15.0, 7.3, 40.0);
  job.tool.edge_radius_um = *rc::gen::element(0.0, 0.2, 2.0);
  const Machine m = machine(*rc::gen::elementOf(kMachines));
  const Plan plan = make_plan(job, m);
  AxisWords at{};
  for (const PlannedMove& move : moves_of(plan)) {
    const AxisWords& to = move.at;
    if (move.is_rotary()) {
      RC_ASSERT(at[kZ] >= std::llround(plan.safe_z_mm * 1e6));
    } else if (move.is_rapid() && at[kZ] && at[kX] && to[kX]) {
      const bool down = *to[kZ] < *at[kZ];
      const bool across = to[kX] != at[kX] || to[kY] != at[kY];
      RC_ASSERT(!(down && across));
      // The height is never below the clearance, except for rounding. Rapid moves are straight, so that the height
      // between their ends is not below the lower end.
      RC_ASSERT(height_mm(m, to) > job.process.clearance_mm - 1e-3);
    } else if (!move.is_rapid()) {
      RC_ASSERT(to[kX] == at[kX]);
    }
    at = to;
  }
  RC_ASSERT(*at[kTilt] == 0);
  RC_ASSERT(*at[kC] == 0);
}

RC_GTEST_PROP(Positions, DoNotDrift, ()) {
  Job job = square_job(*rc::gen::inRange(2, 9), Arrangement::offset);
  const Machine m = machine(*rc::gen::elementOf(kMachines));
  const Plan plan = make_plan(job, m);
  for (const CycleCall& visit : visits_of(plan)) {
    const Stage& stage = plan.stages[0].subroutine == visit.subroutine
                             ? plan.stages[0]
                             : *std::find_if(plan.stages.begin(), plan.stages.end(),
                                             [&](const Stage& s) { return s.subroutine == visit.subroutine; });
    const CuttingPose& pose = plan.poses[stage.pose];
    const geometry::Vec2 centre = plan.elements[static_cast<std::size_t>(visit.element)].centre_mm;
    const AxisPositions root = inverse(m, Vec3(centre.x(), centre.y(), -pose.section.depth_mm), pose.rounded);
    // The start of a routine relative to its element is equal for all elements, except for the rounding errors of two
    // positions.
    const CycleCall first = visits_of(plan).front();
    if (visit.subroutine != first.subroutine) continue;
    const geometry::Vec2 centre0 = plan.elements[static_cast<std::size_t>(first.element)].centre_mm;
    const AxisPositions root0 = inverse(m, Vec3(centre0.x(), centre0.y(), -pose.section.depth_mm), pose.rounded);
    const Vec3 moved = millimetres(LinearPosition(visit.start - first.start));
    const Vec3 wanted(root.x_mm - root0.x_mm, root.y_mm - root0.y_mm, root.z_mm - root0.z_mm);
    RC_ASSERT((moved - wanted).cwiseAbs().maxCoeff() < 1.01e-6);
  }
}

bool same_visit(const CycleCall& a, const CycleCall& b) {
  return a.element == b.element && a.subroutine == b.subroutine && a.start == b.start;
}

TEST(LongJobs, PartsAddUpToTheWhole) {
  const Job job = square_job(6);
  const Machine m = machine("paper");
  const std::vector<CycleCall> whole = visits_of(make_plan(job, m));
  PlanOptions hours;
  hours.split_hours = 0.1;
  const Plan split = make_plan(job, m, hours);
  EXPECT_GT(split.programs.size(), 2U);
  for (const double seconds : split.program_times_s) EXPECT_LE(seconds, 360.0);
  const std::vector<CycleCall> parts = visits_of(split);
  ASSERT_EQ(parts.size(), whole.size());
  EXPECT_TRUE(std::equal(parts.begin(), parts.end(), whole.begin(), same_visit));

  PlanOptions rest;
  rest.phase = "finishing-1-facet-2+";
  rest.from_element = 7;
  const std::vector<CycleCall> tail = visits_of(make_plan(job, m, rest));
  ASSERT_LT(tail.size(), whole.size());
  EXPECT_EQ(tail.front().element, 7);
  EXPECT_TRUE(std::equal(tail.rbegin(), tail.rend(), whole.rbegin(), same_visit));

  std::size_t visits = 0;
  for (const std::string phase : {"roughing", "finishing"}) {
    PlanOptions options;
    options.phase = phase;
    visits += visits_of(make_plan(job, m, options)).size();
  }
  EXPECT_EQ(visits, whole.size());
}

TEST(LongJobs, StopsComeAsAsked) {
  PlanOptions options;
  options.stop_every = 10;
  const Plan plan = make_plan(square_job(5), machine("ideal"), options);
  int visits = 0;
  int stops = 0;
  for (const Item& item : plan.programs.front().items) {
    if (std::holds_alternative<CycleCall>(item)) ++visits;
    if (!std::holds_alternative<OptionalStop>(item)) continue;
    ++stops;
    EXPECT_EQ(visits % 10, 0);
  }
  EXPECT_EQ(stops, 5 * 23 / 10);
}

TEST(Messages, TellProgress) {
  const Plan plan = make_plan(square_job(5, Arrangement::checker), machine("ideal"));
  std::vector<std::string> texts;
  for (const Item& item : plan.programs.front().items)
    if (const auto* message = std::get_if<Message>(&item)) texts.push_back(message->text);
  for (const std::string percent : {"25", "50", "75", "100"})
    EXPECT_EQ(std::count(texts.begin(), texts.end(), "Roughing " + percent + " percent"), 1) << percent;
  for (const std::string text :
       {"Finishing cut 1 of 2 C-axis at 0", "Finishing cut 1 of 2 C-axis at 180", "Finishing cut 2 of 2 C-axis at 270"})
    EXPECT_EQ(std::count(texts.begin(), texts.end(), text), 1) << text;
}

std::string refusal(const Job& job, const Machine& m, const PlanOptions& options = {}) {
  return refusal_of([&] { make_plan(job, m, options); }, "not refused");
}

TEST(Refused, JobsBeyondTheLimitsOfAnAxis) {
  Job job = square_job(4);
  job.source = "j.toml";
  const auto refused = [&](const auto& set_limits) {
    Machine m = machine("ideal");
    set_limits(m);
    return refusal(job, m);
  };
  EXPECT_EQ(refused([](Machine& m) { m.x.limits_mm.value = {-0.3, 120.0}; }), "j.toml: machine");
  EXPECT_EQ(refused([](Machine& m) { m.c.limits_deg.value = {-90.0, 90.0}; }), "j.toml: machine");
  EXPECT_EQ(refused([](Machine& m) { m.a.limits_deg.value = {-10.0, 40.0}; }), "j.toml: machine");
  EXPECT_EQ(refused([](Machine& m) { m.z.limits_mm.value = {-120.0, 3.0}; }), "j.toml: machine");
  Machine m = machine("ideal");
  m.c.limits_deg.value = {-190.0, 190.0};
  EXPECT_EQ(refusal(square_job(4, Arrangement::checker), m), "not refused");
}

TEST(Refused, OptionsWithoutMeaning) {
  PlanOptions options;
  options.from_element = 23;
  EXPECT_EQ(refusal(square_job(5), machine("ideal"), options), "from_element");
  options = {};
  options.from_pass = 2;
  options.from_element = 0;
  EXPECT_EQ(refusal(square_job(5), machine("ideal"), options), "from_pass");
  options = {};
  options.phase = "finishing-3-facet-1";
  EXPECT_EQ(refusal(square_job(5), machine("ideal"), options), "phase");
}

}  // namespace
}  // namespace retrace::fabrication::test::plan_test
