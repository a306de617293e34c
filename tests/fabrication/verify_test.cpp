#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests of the verifier, which simulates the text of programs and shares no code with planner and writers.

namespace retrace::fabrication::test::verify_test {
namespace {

using geometry::Arrangement;
using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

std::vector<std::string> texts_of(const Job& job, const std::string& machine_name) {
  std::vector<std::string> texts;
  for (const Program& program : make_plan(job, machine(machine_name)).programs)
    texts.push_back(nc_text(program, "rs274ngc"));
  return texts;
}

Verification verify_texts(const Job& job, const Machine& m, const std::vector<std::string>& texts) {
  std::vector<NcProgram> programs;
  for (const std::string& text : texts) programs.push_back(parse_nc(text, "p.ngc", NcDialect::rs274ngc));
  return verify_programs(job, m, programs, {}, {machine("ideal"), machine("paper"), machine("thesis")});
}

Verification verify_texts(const Job& job, const std::string& machine_name, const std::vector<std::string>& texts) {
  return verify_texts(job, machine(machine_name), texts);
}

TEST(Verify, CorrectProgramsOfEveryStrategyAndMachine) {
  for (const char* name : {"ideal", "paper", "thesis"})
    for (const auto strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step})
      for (const auto arrangement : {Arrangement::single, Arrangement::offset, Arrangement::checker}) {
        Job job = square_job(arrangement == Arrangement::single ? 1 : 2, arrangement);
        job.strategy = strategy;
        const Verification v = verify_texts(job, name, texts_of(job, name));
        const std::string what = fmt::format("{} strategy {} arrangement {}", name, static_cast<int>(strategy),
                                             static_cast<int>(arrangement));
        EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
        EXPECT_NEAR(v.facet_angle_arcmin_max, v.facet_angle_arcmin_predicted, 0.01) << what;
        EXPECT_LT(v.facet_distance_nm_max, 1.0) << what;
        EXPECT_LT(std::abs(v.apex_error_arcmin_max), 0.01) << what;
        EXPECT_LE(v.root_residual_nm_max, v.root_residual_nm_predicted + 2.0) << what;
        EXPECT_NEAR(v.wall_overcut_nm_max,
                    strategy == Strategy::unidirectional ? v.wall_overcut_nm_max : v.wall_overcut_nm_predicted, 2.0)
            << what;
        EXPECT_EQ(v.elements_cut, static_cast<std::int64_t>(v.elements.size())) << what;
      }
}

/// A facet that is ploughed (cut along the facet from the root) with a tilted edge is inclined along the root by the
/// remaining error of the machine's axes. The verifier reports both the tilt and the unavoidable part.
TEST(Verify, TheTiltOfAPloughedFacetIsToldWithWhatIsUnavoidable) {
  Job job = square_job(1);
  job.strategy = Strategy::unidirectional;
  const Verification v = verify_texts(job, "paper", texts_of(job, "paper"));
  EXPECT_NEAR(v.facet_angle_arcmin_predicted, 1.17, 0.005);
  EXPECT_NEAR(v.facet_angle_arcmin_max, 1.17, 0.005);
  job.strategy = Strategy::two_step;
  const Verification finished = verify_texts(job, "paper", texts_of(job, "paper"));
  EXPECT_EQ(finished.facet_angle_arcmin_predicted, 0.0);
  EXPECT_LT(finished.facet_angle_arcmin_max, 0.01);
}

/// Verifies the golden programs. They cover several passes per element, another apex angle, masks, direct cutting, and
/// every dialect.
TEST(Verify, GoldenProgramsOfEveryDialect) {
  int count = 0;
  for (const auto& folder : std::filesystem::directory_iterator(RETRACE_SOURCE_DIR "/tests/fabrication/golden")) {
    const Job job = read_job(folder.path() / "job.toml");
    for (const char* ending : {"ngc", "mpf", "nc", "pmc"}) {
      const std::string text = read_file(folder.path() / ("program." + std::string(ending)));
      const NcProgram program = parse_nc(text, "p", recognise_dialect(text, "p"), control_texts());
      const Verification v = verify_programs(job, machine(job.machine), {program}, {}, {});
      EXPECT_TRUE(v.passes()) << folder.path().filename() << " " << ending << "\n" << listed(v);
      ++count;
    }
  }
  EXPECT_GE(count, 28);
}

/// Returns a small job for the machine with the largest errors: four prisms in a checker arrangement, finished with one
/// cut per facet.
Job small_job() {
  Job job = square_job(2, Arrangement::checker);
  job.strategy = Strategy::two_step;
  job.process.roughing_depth_um = 50;
  job.process.finishing_cuts = 1;
  return job;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t at = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; at = end + 1, end = text.find('\n', at))
    lines.push_back(text.substr(at, end - at));
  return lines;
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Fixture with the program of the small job, into which tests insert faults.
class Faults : public ::testing::Test {
 protected:
  Faults() : lines_(lines_of(texts_of(job_, "paper").front())) {}

  /// Returns the index of the first line from `from` on that contains `what`.
  std::size_t find(const std::string& what, std::size_t from = 0) const {
    for (std::size_t i = from; i < lines_.size(); ++i)
      if (lines_[i].find(what) != std::string::npos) return i;
    ADD_FAILURE() << "the program has no " << what;
    return 0;
  }
  void replace(std::size_t line, const std::string& from, const std::string& to) {
    const std::size_t at = lines_[line].find(from);
    ASSERT_NE(at, std::string::npos) << lines_[line] << " has no " << from;
    lines_[line].replace(at, from.size(), to);
  }
  Verification verified() const { return verify_texts(job_, "paper", {text_of(lines_)}); }
  void expect_found(const std::string& kind, std::size_t index_of_line) const {
    const Verification v = verified();
    EXPECT_TRUE(has(v, kind, index_of_line)) << listed(v);
  }

  /// Replaces `from` by `to` in the first line of the subroutine that contains `what`, and expects a finding for this
  /// line.
  void expect_fault_in_subroutine(const std::string& what, const std::string& from, const std::string& to,
                                  const std::string& kind) {
    const std::size_t line = find(what, find("o101 sub"));
    replace(line, from, to);
    expect_found(kind, line);
  }

  static bool has(const Verification& v, const std::string& kind, std::size_t index_of_line) {
    for (const Finding& f : v.findings)
      if (f.kind == kind && f.line == static_cast<std::int32_t>(index_of_line + 1)) return true;
    return false;
  }
  static bool has_kind(const Verification& v, const std::string& kind) {
    for (const Finding& f : v.findings)
      if (f.kind == kind) return true;
    return false;
  }

  Job job_ = small_job();
  std::vector<std::string> lines_;
};

TEST_F(Faults, NoneWithoutAFault) {
  EXPECT_TRUE(verified().passes()) << listed(verified());
}

TEST_F(Faults, WrongSignOfC) {
  for (std::string& line : lines_) {
    if (!line.starts_with("G0 A")) continue;
    const std::size_t c = line.find(" C") + 2;
    if (line[c] == '-')
      line.erase(c, 1);
    else
      line.insert(c, "-");
  }
  const Verification v = verified();
  EXPECT_TRUE(has_kind(v, "gouge")) << listed(v);
}

TEST_F(Faults, DwellLost) {
  const std::size_t dwell = find("G4 P0.1");
  lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(dwell));
  const Verification v = verified();
  EXPECT_TRUE(has(v, "missing_dwell", dwell - 1)) << listed(v);
  EXPECT_EQ(v.findings.size(), 1U) << listed(v);
}

TEST_F(Faults, FeedOfZero) {
  expect_fault_in_subroutine("F50", "F50", "F0", "zero_feed");
}

TEST_F(Faults, ElementDropped) {
  const std::size_t call = find("o101 call");
  lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(call));
  const Verification v = verified();
  EXPECT_FALSE(v.passes());
  EXPECT_TRUE(has_kind(v, "chip_too_thick")) << "the finishing cut takes all at once: " << listed(v);
}

TEST_F(Faults, ElementMissingAltogether) {
  for (std::size_t i = 0; i < lines_.size(); ++i)
    if (lines_[i] == "(element 3)")
      for (std::size_t k = i + 1; k < lines_.size(); ++k)
        if (lines_[k].find("call") != std::string::npos) {
          lines_[k] = "(nothing)";
          break;
        }
  const Verification v = verified();
  ASSERT_TRUE(has_kind(v, "element_missing")) << listed(v);
  for (const Finding& f : v.findings) EXPECT_EQ(f.element, 3) << listed(v);
}

TEST_F(Faults, ElementCutTwice) {
  const std::size_t call = find("o101 call");
  const std::size_t approach = find("G0 Z", call - 2);
  std::vector<std::string> again = {lines_[approach], lines_[call]};
  std::size_t xy = approach;
  while (lines_[xy].find("G0 X") == std::string::npos) --xy;
  again.insert(again.begin(), lines_[xy]);
  again.insert(again.begin(), "G0 Z5.");
  lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(call) + 1, again.begin(), again.end());
  EXPECT_TRUE(has_kind(verified(), "cut_twice")) << listed(verified());
}

TEST_F(Faults, LostReturnToAbsolute) {
  const std::size_t line = find("G90", find("o101 sub"));
  lines_[line] = "(lost)";
  const Verification v = verified();
  EXPECT_FALSE(v.passes());
}

TEST_F(Faults, TruncatedFile) {
  lines_.resize(lines_.size() / 2);
  expect_found("truncated", lines_.size() - 1);
}

TEST_F(Faults, SignFlippedInOneLineOfASubroutine) {
  expect_fault_in_subroutine("G1 Y-0.1", "Y-", "Y", "clearance_face_leads");
}

TEST_F(Faults, TheTableAndTheHolder) {
  const std::size_t call = find("o101 call");
  lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(call), "G1 Z-22. F10");
  const Verification v = verified();
  EXPECT_TRUE(has(v, "fixture_collision", call)) << listed(v);
  EXPECT_TRUE(has(v, "holder_collision", call)) << listed(v);
  EXPECT_TRUE(has(v, "gouge", call)) << listed(v);
}

/// Returns the machine of the paper with an additional convex body.
Machine machine_with(const std::string& moves_with, const std::vector<Vec3>& points) {
  Machine m = machine("paper");
  MachineBody body;
  body.name = "clamp";
  body.link = moves_with == "cradle" ? KinematicLink::cradle : KinematicLink::workpiece;
  body.points_mm.value = points;
  m.bodies.push_back(body);
  return m;
}

std::vector<Vec3> box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()})
      for (const double z : {low.z(), high.z()}) corners.emplace_back(x, y, z);
  return corners;
}

/// A ramp next to the blank, 10 to 30 mm towards +Y, rises away from the tool. While A is at 45 degrees, it is parallel
/// to the holder, at 7 mm from the holder's axis. The holder extends 5 mm from its axis, so it does not meet the ramp,
/// but it meets the bounding box of the ramp.
TEST_F(Faults, FixturesAreConvexBodiesAndNotTheirBoxes) {
  std::vector<Vec3> ramp;
  for (const double x : {-20.0, 20.0})
    for (const auto& [y, z] : {std::pair{10.0, 0.0}, {30.0, 0.0}, {30.0, 20.0}}) ramp.emplace_back(x, y, z);
  const std::vector<std::string> texts = {text_of(lines_)};
  const Verification beside = verify_texts(job_, machine_with("workpiece", ramp), texts);
  EXPECT_TRUE(beside.passes()) << listed(beside);
  const Verification v = verify_texts(job_, machine_with("workpiece", box({-20, 10, 0}, {20, 30, 20})), texts);
  ASSERT_TRUE(has_kind(v, "fixture_collision")) << listed(v);
  // At the first pose, the holder and the diamond on its way down meet the body in their first moves. With C at 180
  // degrees, they do not meet it.
  const auto first_call = static_cast<std::int32_t>(find("o101 call"));
  std::int32_t first = std::numeric_limits<std::int32_t>::max();
  for (const Finding& f : v.findings) {
    EXPECT_EQ(f.kind, "fixture_collision") << listed(v);
    record_message(f.message);
    first = std::min(first, f.line);
  }
  EXPECT_LE(first, first_call) << listed(v);
}

TEST_F(Faults, TheDiamondRunsIntoAFixtureWithinTheArray) {
  // The fixture is a pin, 0.1 mm wide, next to the last element. It reaches up to the clearance plane. All bodies that
  // move with the tool are removed, so that only the diamond can collide with the pin.
  Machine m = machine_with("workpiece", box({0.2, 0.2, 0.0}, {0.3, 0.3, 0.3}));
  std::erase_if(m.bodies, [](const MachineBody& body) { return body.link == KinematicLink::tool; });
  const Verification v = verify_texts(job_, m, {text_of(lines_)});
  EXPECT_TRUE(has_kind(v, "fixture_collision")) << listed(v);
  for (const Finding& f : v.findings) record_message(f.message);
}

TEST_F(Faults, WhatTurnsMeetsTheHolder) {
  // A post on the table. It is below the holder at neither end of the rotation, but collides with it between C = 0 and
  // C = 90 degrees.
  const std::size_t turn = find("G0 A", find("o101 call"));
  const Verification v =
      verify_texts(job_, machine_with("workpiece", box({24, 24, 0}, {26, 26, 60})), {text_of(lines_)});
  EXPECT_TRUE(has(v, "fixture_collision", turn)) << listed(v);
  // A body that C does not rotate does not collide.
  EXPECT_FALSE(has(verify_texts(job_, machine_with("cradle", box({24, 24, 0}, {26, 26, 60})), {text_of(lines_)}),
                   "fixture_collision", turn));
}

TEST_F(Faults, BeyondAnAxisLimit) {
  const std::size_t line = find("G0 Z");
  lines_[line] = "G0 Z151.";
  expect_found("axis_limit", line);
}

TEST_F(Faults, TheTableTurnsBelowTheTool) {
  const std::size_t turn = find("G0 A", find("o101 call"));
  lines_[turn - 1] = "(no lift)";
  expect_found("rotation_too_low", turn);
}

TEST_F(Faults, ShiftedOrigin) {
  for (std::string& line : lines_)
    if (line.starts_with("G0 X")) {
      const double x = std::stod(line.substr(4));
      const std::size_t end = line.find(' ', 4);
      line = fmt::format("G0 X{:.6f}{}", x + 0.001, end == std::string::npos ? "" : line.substr(end));
    }
  const Verification v = verified();
  EXPECT_TRUE(has_kind(v, "wall_overcut")) << listed(v);
  EXPECT_NEAR(v.wall_overcut_nm_max, 1000 + v.wall_overcut_nm_predicted, 1.0);
}

TEST_F(Faults, ClearanceOfAQuarter) {
  Job flat = job_;
  flat.process.clearance_mm = 0.05;
  const auto texts = texts_of(flat, "paper");
  const Verification v = verify_texts(job_, "paper", texts);
  EXPECT_TRUE(has_kind(v, "clearance")) << listed(v);
}

TEST_F(Faults, OverTravelLost) {
  // The finishing plunge of facet 1 stops one depth of cut before it passes facet 2.
  const std::size_t routine = find("finishing-1-facet-1");
  const std::size_t line = find("G1 Z-", routine);
  const double z = std::stod(lines_[line].substr(4));
  lines_[line] = fmt::format("G1 Z{:.6f} F20.000", z + 1e-3 * job_.process.finishing_depth_um);
  expect_found("chip_not_separated", line);
}

TEST_F(Faults, StartOfFacet2UsedAtC0) {
  // Exchange the start positions: elements begin the finishing of facet 1 where the finishing of facet 2 should begin.
  const std::size_t first = find("finishing-1-facet-1");
  static_cast<void>(first);
  std::vector<std::size_t> calls1;
  std::vector<std::size_t> calls2;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i] == "o103 call") calls1.push_back(i);
    if (lines_[i] == "o104 call") calls2.push_back(i);
  }
  ASSERT_FALSE(calls1.empty());
  ASSERT_FALSE(calls2.empty());
  const auto start_of = [&](std::size_t call) {
    std::size_t i = call;
    while (!lines_[i].starts_with("G0 X")) --i;
    return i;
  };
  lines_[start_of(calls1.front())] = lines_[start_of(calls2.front())];
  EXPECT_FALSE(verified().passes());
}

TEST_F(Faults, AxisVectorScaledByOnePercent) {
  // Plan the program with axis directions that are not normalised. In this case, the formula of Rodrigues does not only
  // rotate, but also stretches.
  Machine spoilt = machine("paper");
  spoilt.a.direction.value *= 1.01;
  std::string text;
  for (const Program& program : make_plan(job_, spoilt).programs) text += nc_text(program, "rs274ngc");
  EXPECT_FALSE(verify_texts(job_, "paper", {text}).passes());
}

TEST_F(Faults, PlannedForIdealAxesShowsTheErrorsOfTheMachine) {
  const Verification v = verify_texts(job_, "paper", texts_of(job_, "ideal"));
  EXPECT_FALSE(v.passes());
  // The facets of upright elements deviate by 5.06 and 5.42 arcmin, and their apex angle by 3.32 arcmin. The deviations
  // of rotated elements are different.
  double upright = 0.0;
  for (const ElementResult& e : {v.elements[0], v.elements[3]}) {
    EXPECT_NEAR(e.facet_angle_arcmin[0], 5.06, 0.01);
    EXPECT_NEAR(e.facet_angle_arcmin[1], 5.42, 0.01);
    upright = std::max(upright, std::abs(e.apex_error_arcmin));
  }
  EXPECT_NEAR(upright, 3.32, 0.01);
}

TEST_F(Faults, ProgramForAnotherMachineIsRefused) {
  try {
    verify_texts(job_, "paper", texts_of(job_, "thesis"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "p.ngc");
  }
}

}  // namespace
}  // namespace retrace::fabrication::test::verify_test
