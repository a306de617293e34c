// Tests of correct and changed programs of turned parts. Correct programs of random parts must pass in every dialect.
// The verifier must find every small change that an independent rule calls a fault. The changed programs are small.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/csv.h"
#include "core/error.h"
#include "fabrication/post/post.h"
#include "fabrication/turning/check/turning_check.h"
#include "fabrication/turning/io/part_files.h"
#include "fabrication/turning/plan/path.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/turning/plain_cut.h"

namespace retrace::fabrication::turning::turning_mutation_test {
namespace {

using fabrication::test::border_places;
using fabrication::test::deviations;
using fabrication::test::PlainCut;
using fabrication::test::PlainMove;
using fabrication::test::PlainProgram;

const std::string kHead =
    "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"formula\"\nformula = \"0.1*x-0.3*y^2\"\n"
    "[tool]\nnose_radius_mm = 0.2\nclearance_deg = 20\n";
const std::string kSpiral = kHead +
                            "[path]\nradius_mm = 0.06\nfeed_um = 20\nspindle_rpm = 30\npoints_per_turn = 22\n"
                            "[machine]\nspindle_rpm = 60\nc_acceleration_deg_per_s2 = 400\nblocks_per_s = 20\n"
                            "[machine.x]\ntravel_mm = [-1, 1]\nacceleration_mm_per_s2 = 0.2\n"
                            "[machine.z]\ntravel_mm = [-1, 2]\nspeed_mm_per_s = 0.1\nacceleration_mm_per_s2 = 0.3\n"
                            "[inspect]\nform_tolerance_nm = 100\nmap_pixels = 11\n";
const std::string kRaster = kHead +
                            "[path]\nstrategy = \"raster\"\nsize_mm = [0.07, 0.05]\nfeed_um = 20\narc_um = 5\n"
                            "cutting_mm_per_min = 6\n[inspect]\nform_tolerance_nm = 100\nmap_pixels = 11\n";

struct Planned {
  TurnedPart part;
  std::vector<Pass> passes;
  Program program;

  std::string text(const std::string& dialect) const { return nc_text(program, dialect); }
};

Planned planned(const std::string& file) {
  TurnedPart part = parse_turned_part(file, "part.toml");
  std::vector<Pass> passes = make_path(part.surface, part.tool, part.path, {"part.toml", 0, "path"});
  Program program = turning_program(passes, part.path, "part", {});
  return {std::move(part), std::move(passes), std::move(program)};
}

std::vector<Finding> findings_of(const TurnedPart& part, const std::vector<std::string>& texts,
                                 NcDialect dialect = NcDialect::rs274ngc,
                                 const std::optional<StrokeTable>& strokes = std::nullopt) {
  FindingList findings;
  std::vector<NcProgram> programs;
  for (const std::string& text : texts)
    programs.push_back(parse_nc(text, "p" + std::to_string(programs.size()), dialect));
  check_turning(part, read_cuts(part, programs, findings), strokes, findings);
  return findings.take();
}

bool is_found(const TurnedPart& part, const std::vector<std::string>& texts) {
  try {
    return !findings_of(part, texts).empty();
  } catch (const InputError&) {
    return true;
  }
}

bool finds(const std::vector<Finding>& findings, const std::string& kind) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return f.kind == kind; });
}

std::string listed(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) text += f.kind + ": " + text_of(f) + "\n";
  return text;
}

std::string form_fault(const PlainProgram& program) {
  if (program.is_odd) return "not understood";
  if (!program.ends) return "does not end";
  if (!program.is_prepared || !program.stops_spindle || program.spindle_is_left_on) return "settings";
  if (program.moves.empty()) return "";
  const PlainMove& first = program.moves.front();
  if (!first.named[2] || first.named[0] || first.named[1] || first.named[3] || !first.is_rapid) return "first move";
  return "";
}

/// Returns a description of the first fault of a program, or an empty text.
/// \param border deviations of the correct program at points of the border; if it is empty, the deviations of `program`
/// are stored in it
std::string fault_of(const TurnedPart& part, const PlainProgram& program, std::vector<double>& border) {
  if (const std::string fault = form_fault(program); !fault.empty()) return fault;
  const bool is_spiral = part.path.strategy == Strategy::spiral;
  const double reach = is_spiral ? part.path.radius_mm : 0.5 * part.path.width_mm;
  double highest = -1e300;
  for (double x = -reach; x <= reach; x += 0.01) highest = std::max(highest, part.surface.height_mm(x, 0.0));
  std::vector<PlainMove> cuts;
  double last_c_speed = 0.0;
  double last_z_speed = 0.0;
  double last_dt = 0.0;
  const auto stops_turning = [&] {
    const bool is_sudden = part.machine.c_acceleration_deg_per_s2 && last_dt > 0.0 &&
                           2.0 * last_c_speed / last_dt > 1.05 * *part.machine.c_acceleration_deg_per_s2;
    last_c_speed = last_z_speed = last_dt = 0.0;
    return is_sudden;
  };
  for (const PlainMove& m : program.moves) {
    if (m.is_spindle_on) return "spindle";
    const bool is_known = m.known[0] && m.known[1] && m.known[2] && m.known[3];
    const bool moves_aside = (m.named[0] && m.at[0] != m.from[0]) || (m.named[1] && m.at[1] != m.from[1]) ||
                             (m.named[3] && m.at[3] != m.from[3]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisLimits& limits = part.machine.axes[axis];
      if (limits.low_mm && (m.known[axis] || m.named[axis]) &&
          (m.at[axis] < *limits.low_mm - 1e-4 || m.at[axis] > *limits.high_mm + 1e-4))
        return "travel";
    }
    if (m.is_rapid) {
      if (stops_turning()) return "C stops at once";
      const double low = m.known[2] ? std::min(m.from[2], m.at[2]) : m.at[2];
      if ((moves_aside || m.at[2] < m.from[2]) && low < highest + 0.9 * part.path.clearance_mm) return "low rapid";
      continue;
    }
    if (!is_known) return "cuts before its place is known";
    if (!moves_aside && !m.is_timed) {
      const bool moves = m.at[2] != m.from[2];
      if (moves && m.feed > 1.01 * part.path.approach_mm_per_min) return "approach";
      if (moves && m.feed <= 0.0) return "no feed";
      if (moves && !m.is_stop) return "approach without a stop";
      if (stops_turning()) return "C stops at once";
      continue;
    }
    if (!m.is_timed) return "untimed";
    if (m.is_stop) return "stops";
    if (m.feed <= 0.0) return "no time";
    const double dt = 60.0 / m.feed;
    const double c_speed = (m.at[3] - m.from[3]) / dt;
    const double z_speed = (m.at[2] - m.from[2]) / dt;
    if (is_spiral && c_speed <= 0.0) return "C does not rise";
    if (is_spiral && c_speed > 6.06 * part.path.spindle_rpm) return "C too fast";
    if (!is_spiral &&
        60.0 * std::hypot(m.at[0] - m.from[0], m.at[1] - m.from[1]) / dt > 1.01 * part.path.cutting_mm_per_min)
      return "too fast";
    if (part.machine.blocks_per_s && 1.0 / dt > 1.01 * *part.machine.blocks_per_s) return "blocks";
    if (part.machine.axes[2].speed_mm_per_s && std::abs(z_speed) > 1.01 * *part.machine.axes[2].speed_mm_per_s)
      return "Z too fast";
    if (part.machine.c_acceleration_deg_per_s2 &&
        2.0 * std::abs(c_speed - last_c_speed) / (dt + last_dt) > 1.05 * *part.machine.c_acceleration_deg_per_s2)
      return "C acceleration";
    if (part.machine.axes[2].acceleration_mm_per_s2 && last_dt > 0.0 &&
        2.0 * std::abs(z_speed - last_z_speed) / (dt + last_dt) > 1.05 * *part.machine.axes[2].acceleration_mm_per_s2)
      return "Z acceleration";
    last_c_speed = c_speed;
    last_z_speed = z_speed;
    last_dt = dt;
    cuts.push_back(m);
  }
  const PlainCut left(part, cuts);
  const double tolerance = 1e-6 * part.form_tolerance_nm;
  const double cusp = 1.3 * part.path.feed_mm * part.path.feed_mm / (8.0 * part.tool.nose_radius_mm);
  const auto fault_at = [&](double x, double y) -> std::string {
    const double off = left.deviation(x, y);
    if (off > cusp + 2.0 * tolerance) return "too high";
    return off < -1.5 * tolerance ? "too deep" : "";
  };
  for (int i = 0; i < 10; ++i)
    for (int k = 0; k < 30; ++k) {
      std::string fault;
      if (is_spiral) {
        // Skip the centre, where the part rotates under a nearly fixed edge. Also skip the rim, where only one
        // neighbouring cut exists.
        const double r = 0.25 * reach + (0.75 * reach - part.path.feed_mm) * (i + 0.5) / 10.0;
        const double angle = 2.0 * std::numbers::pi * (k + 0.3 * i) / 30.0;
        fault = fault_at(r * std::cos(angle), r * std::sin(angle));
      } else {
        fault = fault_at((0.5 * part.path.height_mm - part.path.feed_mm) * (2.0 * (i + 0.5) / 10.0 - 1.0),
                         0.5 * part.path.width_mm * (2.0 * (k + 0.5) / 30.0 - 1.0));
      }
      if (!fault.empty()) return fault;
    }
  const std::vector<double> at_border = deviations(left, border_places(part, 15));
  if (border.empty()) border = at_border;
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (at_border[i] > std::max(border[i], cusp) + 2.0 * tolerance) return "too high at the border";
    if (at_border[i] < -1.5 * tolerance) return "too deep at the border";
  }
  return "";
}

void judge_all(const std::string& file, const std::vector<fabrication::test::NumberChange>& changes) {
  const Planned plan = planned(file);
  const std::string text = plan.text("rs274ngc");
  EXPECT_EQ(listed(findings_of(plan.part, {text})), "");
  std::vector<double> border;
  EXPECT_EQ(fault_of(plan.part, fabrication::test::plain_program(text), border), "");
  // Use one thread. The programs are so small that parallel loops would take longer.
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  int tried = 0;
  int faults = 0;
  int missed = 0;
  int found_besides = 0;
  for (const fabrication::test::Mutant& mutant :
       fabrication::test::mutants_of(text, changes, {"M3 S300", "G61", "G64", "G91", "G94", "G20"})) {
    const std::string fault = fault_of(plan.part, fabrication::test::plain_program(mutant.text), border);
    const bool found = is_found(plan.part, {mutant.text});
    ++tried;
    faults += !fault.empty();
    found_besides += fault.empty() && found;
    if (fault.empty() || found) continue;
    if (++missed < 20) ADD_FAILURE() << mutant.what << ": " << fault << " is not found";
  }
  ::testing::Test::RecordProperty("tried", tried);
  ::testing::Test::RecordProperty("faults", faults);
  ::testing::Test::RecordProperty("found_besides", found_besides);
  EXPECT_GT(faults, tried / 2);
  EXPECT_EQ(missed, 0);
}

TEST(TurningMutants, OfASpiralAreFound) {
  judge_all(kSpiral, {{'X', 1.0, 0.01},
                      {'X', 1.0, -0.02},
                      {'Z', 1.0, 0.001},
                      {'Z', 1.0, -0.001},
                      {'Z', 1.0, -0.06},
                      {'C', 1.0, 5.0},
                      {'C', 1.0, -30.0},
                      {'Y', 1.0, 0.01},
                      {'F', 5.0, 0.0},
                      {'F', 0.2, 0.0}});
}

TEST(TurningMutants, OfARasterAreFound) {
  judge_all(kRaster, {{'X', 1.0, 0.01},
                      {'X', 1.0, -0.02},
                      {'Z', 1.0, 0.001},
                      {'Z', 1.0, -0.001},
                      {'Z', 1.0, -0.06},
                      {'C', 1.0, 5.0},
                      {'Y', 1.0, 0.004},
                      {'Y', 1.0, -0.01},
                      {'F', 5.0, 0.0}});
}

TEST(TurningCheck, LimitsOfTheMachineAreKeptOrFound) {
  const Planned plan = planned(kSpiral);
  const std::string text = plan.text("sinumerik");
  const auto found = [&](const std::function<void(TurnedPart&)>& change, const std::string& kind) {
    Planned changed = planned(kSpiral);
    change(changed.part);
    return finds(findings_of(changed.part, {text}, NcDialect::sinumerik), kind);
  };
  EXPECT_EQ(listed(findings_of(plan.part, {text}, NcDialect::sinumerik)), "");
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.c_acceleration_deg_per_s2 = 300.0; }, "axis_acceleration"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.spindle_rpm = 29.0; }, "axis_speed"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.path.spindle_rpm = 29.0; }, "feed_too_high"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.blocks_per_s = 10.9; }, "block_rate"));
  EXPECT_FALSE(found([](TurnedPart& p) { p.machine.blocks_per_s = 11.0; }, "block_rate"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.axes[0].high_mm = 0.05; }, "axis_limit"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.axes[2].high_mm = 0.5; }, "axis_limit"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.axes[2].speed_mm_per_s = 0.01; }, "axis_speed"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.machine.axes[2].jerk_mm_per_s3 = 0.01; }, "axis_jerk"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.path.clearance_mm = 1.1; }, "clearance"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.path.feed_mm = 0.019; }, "feed_step"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.path.radius_mm = 0.09; }, "feed_step"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.tool.nose_radius_mm = 0.1; }, "excess"));
  EXPECT_TRUE(found([](TurnedPart& p) { p.tool.skew_deg = 5.0; }, "skew"));
}

TEST(TurningKinematics, ASpiralSpinsUpAndDownAtTheAccelerationOfC) {
  const Planned plan = planned(kSpiral);
  const Pass& pass = plan.passes.front();
  double seconds = 0.0;
  for (std::size_t i = 1; i < pass.size(); ++i) {
    seconds += pass[i].seconds;
    const double from_end = pass.back().c_deg - pass[i].c_deg;
    const double ramp = 180.0 * 180.0 / (2.0 * 400.0);
    if (pass[i].c_deg < ramp) {
      EXPECT_NEAR(pass[i].c_deg, 0.5 * 400.0 * seconds * seconds, 1e-9);
    } else if (from_end > ramp) {
      EXPECT_NEAR(pass[i].c_deg, ramp + 180.0 * (seconds - 180.0 / 400.0), 1e-9);
    }
  }
  EXPECT_NEAR(seconds, pass.back().c_deg / 180.0 + 180.0 / 400.0, 1e-9);
}

TEST(TurningKinematics, AShortSpiralNeverReachesItsSpeed) {
  Planned plan = planned(kSpiral);
  plan.part.path.spin_deg_per_s2 = plan.part.machine.c_acceleration_deg_per_s2 = 10.0;
  const auto passes = make_path(plan.part.surface, plan.part.tool, plan.part.path, {"part.toml", 0, "path"});
  EXPECT_NEAR(path_seconds(passes), 2.0 * std::sqrt(passes.front().back().c_deg / 10.0), 1e-9);
  for (const NcDialect dialect : {NcDialect::pmac, NcDialect::a3200, NcDialect::automation1}) {
    const std::string_view word = kNcDialectWords[static_cast<std::size_t>(dialect)];
    const std::string text = nc_text(turning_program(passes, plan.part.path, "part", {}), word);
    EXPECT_EQ(listed(findings_of(plan.part, {text}, dialect)), "") << word;
  }
}

/// Returns a program with the moves in lines `from` to `to` of another program. It begins at the start position of
/// these moves and has opening and closing lines.
std::string part_of(const std::vector<std::string>& lines, std::size_t from, std::size_t to) {
  std::size_t begin = 0;
  while (!lines[begin].starts_with("G93")) ++begin;
  std::vector<std::string> result(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(begin) + 1);
  const std::string& first = lines[from - 1];  // start position of the moves
  for (std::string& line : result) {
    const std::size_t z = first.find(" Z");
    if (line.starts_with("G0 X") && from > begin + 1)
      line = "G0" + first.substr(2, z - 2) + " Y0.000000" +
             first.substr(first.find(" C"), first.find(" F") - first.find(" C"));
    if (line.starts_with("G1 Z") && from > begin + 1) line = "G1" + first.substr(z, first.find(" C") - z) + " F5.000";
  }
  result.insert(result.end(), lines.begin() + static_cast<std::ptrdiff_t>(from),
                lines.begin() + static_cast<std::ptrdiff_t>(to));
  result.insert(result.end(), {"G94", "G61", "M9", "G0 Z2.000000", "M2", "%"});
  return fabrication::test::text_of_lines(result);
}

TEST(TurningCheck, ASpiralMayBeSplitAndBegunAgain) {
  Planned plan = planned(kSpiral);
  // A split spiral stops during its rotation, which a limit on the acceleration of C does not allow. Remove this limit.
  plan.part.machine.c_acceleration_deg_per_s2.reset();
  const std::vector<std::string> lines = fabrication::test::lines_of_text(plan.text("rs274ngc"));
  std::size_t begin = 0;
  while (!lines[begin].starts_with("G93")) ++begin;
  ++begin;
  std::size_t end = begin;
  while (!lines[end].starts_with("G94")) ++end;
  const std::size_t middle = begin + 30;
  const std::string first = part_of(lines, begin, middle);
  EXPECT_EQ(listed(findings_of(plan.part, {first, part_of(lines, middle, end)})), "");
  EXPECT_EQ(listed(findings_of(plan.part, {first, part_of(lines, middle - 10, end)})), "") << "begun again before";
  EXPECT_TRUE(finds(findings_of(plan.part, {first}), "uncut"));
  EXPECT_TRUE(finds(findings_of(plan.part, {part_of(lines, middle, end)}), "feed_step"));
  EXPECT_TRUE(finds(findings_of(plan.part, {first, part_of(lines, middle + 8, end)}), "feed_step")) << "a gap";
}

TEST(TurningCheck, ATruncatedProgramIsAFinding) {
  for (const std::string& file : {kSpiral, kRaster}) {
    const Planned plan = planned(file);
    for (std::size_t d = 0; d < std::size(kNcDialectWords); ++d) {
      const std::vector<std::string> lines =
          fabrication::test::lines_of_text(plan.text(std::string(kNcDialectWords[d])));
      for (std::size_t kept = 15; kept + 1 < lines.size(); kept += 5) {
        const std::string text =
            fabrication::test::text_of_lines({lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(kept)});
        EXPECT_TRUE(finds(findings_of(plan.part, {text}, static_cast<NcDialect>(d)), "truncated"))
            << kNcDialectWords[d] << ' ' << kept;
      }
    }
  }
}

TEST(TurningCheck, StrokesOfAFastServoBelongToTheirPoints) {
  std::string file = kSpiral;
  file.replace(file.find("points_per_turn = 22\n"), 21, "points_per_turn = 22\nservo = \"fast\"\n");
  const Planned plan = planned(file);
  CsvWriter csv("c_deg,stroke_mm");
  for (const PathPoint& p : plan.passes.front())
    csv.row(fmt::format("{:.7f}", p.c_deg), fmt::format("{:.6f}", p.servo_mm));
  const std::string text = plan.text("rs274ngc");
  const auto found = [&](const std::string& table) {
    return findings_of(plan.part, {text}, NcDialect::rs274ngc, StrokeTable{"servo.csv", table});
  };
  const std::string table = csv.text();
  EXPECT_EQ(listed(found(table)), "");
  std::vector<std::string> lines = fabrication::test::lines_of_text(table);
  std::swap(lines[20], lines[21]);
  EXPECT_TRUE(finds(found(fabrication::test::text_of_lines(lines)), "servo"));
  lines = fabrication::test::lines_of_text(table);
  lines.pop_back();
  EXPECT_TRUE(finds(found(fabrication::test::text_of_lines(lines)), "servo"));
  lines = fabrication::test::lines_of_text(table);
  lines[30] = lines[30].substr(0, lines[30].find(',') + 1) + "0.002";
  EXPECT_FALSE(found(fabrication::test::text_of_lines(lines)).empty());
  EXPECT_THROW(found("c_deg,stroke_mm\nx,1\n"), InputError);
}

// The verifier does not check the surface closer to the axis than one feed per revolution, where the part rotates under
// a nearly fixed edge.
TEST(TurningCheck, PartsOfFewTurnsAreNotJudgedAtTheirAxis) {
  for (const double radius_mm : {0.04, 0.08, 0.12, 0.135, 0.15, 0.2}) {
    const Planned plan = planned(fmt::format(
        "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"xy_polynomial\"\nterms = [[1, 0, -0.05], [2, "
        "0, -0.126], [0, 2, -0.282]]\n[tool]\nnose_radius_mm = 0.367\nclearance_deg = 25\nrake_deg = -19.3\n"
        "[path]\nradius_mm = {}\noverrun_mm = 0.02\nfeed_um = 17.25\nspindle_rpm = 94.54\npoints_per_turn = "
        "720\n[inspect]\nmap_pixels = 11\n",
        radius_mm));
    EXPECT_EQ(listed(findings_of(plan.part, {plan.text("rs274ngc")})), "") << radius_mm;
  }
}

TEST(TurningCheck, RightProgramsOfRandomPartsPassInEveryDialect) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  std::mt19937 random(23);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int made = 0;
  for (int tried = 0; made < 6 && tried < 200; ++tried) {
    const bool is_raster = tried % 3 == 2;
    std::string file = fmt::format(
        "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"xy_polynomial\"\nterms = [[1, 0, {:.3f}], [2, 0, "
        "{:.3f}], "
        "[1, 1, {:.3f}], [0, 2, {:.3f}], [3, 0, {:.3f}], [2, 2, {:.3f}]]\n[tool]\nnose_radius_mm = "
        "{:.3f}\nclearance_deg "
        "= 25\nrake_deg = {:.1f}\nskew_deg = {:.1f}\n",
        between(-0.05, 0.05), between(-0.3, 0.3), between(-0.2, 0.2), between(-0.3, 0.3), between(-0.1, 0.1),
        between(-0.2, 0.2), between(0.05, 0.5), tried % 4 == 0 ? between(-20.0, 5.0) : 0.0,
        tried % 5 == 0 ? between(-20.0, 20.0) : 0.0);
    file +=
        is_raster
            ? fmt::format(
                  "[path]\nstrategy = \"raster\"\nsize_mm = [{:.3f}, {:.3f}]\nfeed_um = {:.2f}\narc_um = "
                  "{:.2f}\ncutting_mm_per_min = {:.2f}\n",
                  between(0.15, 0.3), between(0.1, 0.3), between(5.0, 15.0), between(2.0, 6.0), between(10.0, 100.0))
            : fmt::format("[path]\nradius_mm = {:.3f}\noverrun_mm = {:.3f}\nfeed_um = {:.2f}\nspindle_rpm = {:.2f}\n{}",
                          between(0.12, 0.2), tried % 2 == 0 ? 0.02 : 0.0, between(8.0, 20.0), between(5.0, 120.0),
                          tried % 2 == 0 ? "points_per_turn = 720\n" : "sampling = \"arc\"\narc_um = 2.5\n");
    if (!is_raster && tried % 4 < 2)
      file += fmt::format("[machine]\nc_acceleration_deg_per_s2 = {:.1f}\n", between(50.0, 3000.0));
    file += "[inspect]\nmap_pixels = 11\n";
    try {
      const Planned plan = planned(file);
      ++made;
      for (const int which : {made % 4, (made + 1) % 4}) {
        const auto d = static_cast<std::size_t>(which);
        EXPECT_EQ(
            listed(findings_of(plan.part, {plan.text(std::string(kNcDialectWords[d]))}, static_cast<NcDialect>(d))), "")
            << kNcDialectWords[d] << '\n'
            << file;
      }
    } catch (const InputError&) {
      continue;  // the tool collides with this surface
    }
  }
  EXPECT_EQ(made, 6);
}

}  // namespace
}  // namespace retrace::fabrication::turning::turning_mutation_test
