// Tests of the check of planed and turned lenses, which shares no code with the planner. Its profile is compared with
// the profile of the planner. Its simulation of a round nose is compared with closed forms. It must report findings for
// plans that were made for another lens or tool.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/check/phase_profile.h"
#include "fabrication/planing/check/swept_nose.h"
#include "fabrication/planing/plan/nose_path.h"
#include "fabrication/planing/plan/plan.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/planing/findings.h"
#include "tests/fabrication/planing/turned_lens.h"
#include "tests/support/lines.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::verify_test {
namespace {

using testing::lines_of;

using test::finds;

const ZoneLens kLenses[] = {{500.0, 5.0, 1.52, 250.0}, {200.0, 5.0, 1.52, 90.0}, {80.0, 2.0, 2.1, 70.0}};

PlanedPart turned_part(double nose_mm = 0.0) {
  return test::turned_lens(kLenses[1], 0.05, 2.5, nose_mm);
}

/// Checks the plan for one part against another part.
PlaningCheck check_of(const PlanedPart& planned, const PlanedPart& wanted) {
  const PlaningPlan plan = plan_planing(planned);
  std::vector<PlaningText> texts;
  for (const PlannedProgram& p : plan.programs) texts.push_back({p.program.name, nc_text(p.program, "rs274ngc")});
  return check_planing(wanted, texts, NcDialect::rs274ngc);
}

TEST(PhaseProfile, IsThePlannersProfile) {
  for (const ZoneLens& lens : kLenses) {
    const PhaseProfile by_phase(lens);
    const ZoneProfile by_formula(lens);
    ASSERT_EQ(by_phase.walls().size() + 1, by_formula.zones().size());
    for (std::size_t k = 0; k < by_phase.walls().size(); ++k) {
      const Wall& wall = by_phase.walls()[k];
      EXPECT_NEAR(wall.x_mm, by_formula.zones()[k].to_mm, 1e-9);
      EXPECT_NEAR(wall.inner_depth_mm, by_formula.depth_in_zone_mm(k, wall.x_mm), 1e-9);
      EXPECT_NEAR(wall.outer_depth_mm, by_formula.depth_in_zone_mm(k + 1, wall.x_mm), 1e-9);
    }
    for (double share = 0.0; share <= 1.0; share += 0.00317)
      EXPECT_NEAR(by_phase.depth_mm(share * lens.half_width_mm), by_formula.depth_mm(share * lens.half_width_mm), 1e-9);
  }
}

TEST(PhaseProfile, PlansOfOtherLensesAreFound) {
  PlanedPart mill;
  mill.source = "part.toml";
  mill.lens = kLenses[1];
  mill.length_mm = 100.0;
  mill.tolerance_mm = 0.2;
  mill.mill = PlaningMill{};
  mill.mill->fast_feed_mm_per_min = 3000.0;
  EXPECT_TRUE(check_of(mill, mill).passes());
  EXPECT_TRUE(check_of(turned_part(), turned_part()).passes());
  for (PlanedPart wanted : {mill, turned_part(), turned_part(0.8)}) {
    const PlanedPart planned = wanted;
    wanted.lens.refractive_index += 0.02;
    EXPECT_FALSE(check_of(planned, wanted).passes());
    wanted = planned;
    wanted.lens.focal_length_mm += 4.0;
    EXPECT_FALSE(check_of(planned, wanted).passes());
    wanted = planned;
    wanted.lens.wavelength_mm *= 1.02;
    EXPECT_FALSE(check_of(planned, wanted).passes());
  }
}

std::vector<double> places(double from, double to, int pieces) {
  std::vector<double> result;
  for (int i = 0; i <= pieces; ++i) result.push_back(from + (to - from) * i / pieces);
  return result;
}

TEST(SweptNose, LeavesCuspsBetweenPlacesAndLinesAlongPieces) {
  // A nose at two positions leaves two arcs. With the distance f between them, the cusp is r - sqrt(r^2 - f^2 / 4)
  // above the valleys.
  const double nose = 0.8;
  const double feed = 0.5;
  const SectionLine one = nose_envelope({{-feed / 2, nose}}, nose, places(-0.4, 0.4, 80));
  const SectionLine two = nose_envelope({{feed / 2, nose}}, nose, places(-0.4, 0.4, 80));
  const double cusp = nose - std::sqrt(nose * nose - feed * feed / 4.0);
  EXPECT_NEAR(std::min(one[40].z_mm, two[40].z_mm), cusp, 1e-15);
  EXPECT_NEAR(one[15].z_mm, 0.0, 1e-15);
  // A nose that moves along a slope leaves a parallel line at the distance of its radius.
  const SectionLine line = nose_envelope({{-2.0, -1.0}, {4.0, 2.0}}, nose, places(-0.5, 0.5, 10));
  for (const SectionPoint& p : line) EXPECT_NEAR(p.z_mm, 0.5 * p.x_mm - nose * std::sqrt(1.25), 1e-14);
}

TEST(SweptNose, ComesAsDeepAsACornerLetsIt) {
  // In the corner between a vertical wall and a horizontal floor, the nose leaves a quarter of a circle.
  const double nose = 1.5;
  const SectionLine corner = {{-10.0, 0.0}, {0.0, 0.0}, {0.0, 6.0}, {10.0, 6.0}};
  const auto at = places(-10.0, 10.0, 2000);
  const SectionLine left = nose_envelope(lowest_centres(corner, nose, at), nose, at);
  for (const SectionPoint& p : left) {
    if (p.x_mm < -9.0 || p.x_mm > 9.0 || std::abs(p.x_mm) < 1e-8) continue;
    const double x = p.x_mm + nose;
    const double expected = p.x_mm > 0.0 ? 6.0 : x <= 0.0 ? 0.0 : nose - std::sqrt(std::max(0.0, nose * nose - x * x));
    EXPECT_NEAR(p.z_mm, expected, std::abs(p.x_mm) < 0.02 ? 0.3 : 1e-5) << p.x_mm;
  }
  EXPECT_NEAR(largest_distance(corner, left, 2.0 * nose), nose * (std::numbers::sqrt2 - 1.0), 1e-3);
}

TEST(SweptNose, DistancesAreThoseOfPieces) {
  const SectionLine line = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}, {3.0, 2.0}};
  EXPECT_NEAR(largest_distance({{0.5, 0.3}}, line, 2.0), 0.3, 1e-15);
  EXPECT_NEAR(largest_distance({{0.8, 1.0}}, line, 2.0), 0.2, 1e-15);
  EXPECT_NEAR(largest_distance({{0.8, 1.0}, {2.0, 3.5}}, line, 2.0), 1.5, 1e-15);
  EXPECT_GT(largest_distance({{8.0, 2.0}}, line, 1.0), 1e300) << "nothing is near";
}

TEST(NosePath, TouchesTheProfileEverywhereAndCutsItNowhere) {
  for (const ZoneLens& lens : kLenses) {
    const ZoneProfile profile(lens);
    const double nose = 0.4 * largest_nose_mm(profile);
    ASSERT_TRUE(nose_fits(profile, nose));
    const std::vector<ProfilePoint> surface = points_of(profile, 0.01);
    const std::vector<ProfilePoint> path = nose_points(profile, nose, 0.05, 0.05);
    double largest_jump = 0.0;
    for (std::size_t i = 0; i < path.size(); i += 7) {
      const ProfilePoint middle{path[i].x_mm, path[i].z_mm + nose};
      if (middle.x_mm > lens.half_width_mm) continue;
      double nearest = 1e300;
      for (std::size_t k = 1; k < surface.size(); ++k) {
        const ProfilePoint& a = surface[k - 1];
        const ProfilePoint& b = surface[k];
        if (std::min(std::abs(a.x_mm - middle.x_mm), std::abs(b.x_mm - middle.x_mm)) > nose + 0.02) continue;
        const double dx = b.x_mm - a.x_mm;
        const double dz = b.z_mm - a.z_mm;
        const double along = ((middle.x_mm - a.x_mm) * dx + (middle.z_mm - a.z_mm) * dz) / (dx * dx + dz * dz);
        const double t = std::clamp(along, 0.0, 1.0);
        nearest = std::min(nearest, std::hypot(middle.x_mm - a.x_mm - t * dx, middle.z_mm - a.z_mm - t * dz));
      }
      EXPECT_NEAR(nearest, nose, 1e-6) << path[i].x_mm;
    }
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_GE(path[i].x_mm, path[i - 1].x_mm - 1e-12);
      if (path[i].x_mm > path[i - 1].x_mm + 1e-9)
        largest_jump = std::max(largest_jump, std::abs(path[i].z_mm - path[i - 1].z_mm));
    }
    EXPECT_LT(largest_jump, 0.06) << "but for the ways up beside walls";
  }
}

TEST(NosePath, TheLargestNoseIsTheLargest) {
  const ZoneProfile profile(kLenses[1]);
  const double most = largest_nose_mm(profile);
  EXPECT_GT(most, 1.0);
  EXPECT_TRUE(nose_fits(profile, most));
  EXPECT_FALSE(nose_fits(profile, 1.001 * most + 0.02));
}

TEST(Lathe, ARoundNoseKeepsTheTubeAndLeavesFillets) {
  for (const double nose : {0.1, 0.8, 2.0}) {
    const PlanedPart part = turned_part(nose);
    const PlaningCheck check = check_of(part, part);
    for (const Finding& f : check.findings) ADD_FAILURE() << f.kind << ' ' << f.message << ' ' << f.value;
    EXPECT_LE(check.path_distance_mm_max, 0.05 * 1.01);
    EXPECT_GT(check.path_distance_mm_max, 0.03);
    // The nose is a circle in the corner between a vertical wall and a floor that descends towards the wall by the
    // angle a.
    const ZoneProfile profile(part.lens);
    double corner = 0.0;
    for (std::size_t zone = 0; zone + 1 < profile.zones().size(); ++zone) {
      const double a = std::atan(profile.slope_in_zone(zone, profile.zones()[zone].to_mm));
      corner = std::max(corner, nose * (1.0 / std::sin(0.25 * std::numbers::pi - 0.5 * a) - 1.0));
    }
    EXPECT_NEAR(check.unreached_mm_max, corner, 0.01 * corner);
  }
}

std::string turned_text(const PlanedPart& part, const std::string& dialect) {
  return nc_text(plan_planing(part).programs.front().program, dialect);
}

PlaningCheck check_of(const PlanedPart& part, const std::string& text, NcDialect dialect) {
  return check_planing(part, {{"p", text}}, dialect);
}

/// Returns the text with one line replaced by `other`, or removed if `other` is empty.
/// \param is_last true: replaces the last occurrence of the line; false: the first
std::string with_line(std::string text, const std::string& line, const std::string& other, bool is_last = false) {
  const std::size_t at = is_last ? text.rfind(line + "\n") : text.find(line + "\n");
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size() + 1, other.empty() ? "" : other + "\n");
}

const std::string kStarts[] = {"G97 S800 M3", "S800 M3", "G97 S800 M3", "M103", "M103", "M103"};
const std::string kStops[] = {"M5", "M5", "M5", "M105", "M105", "M105"};

/// Returns a list of all findings as text, and records their messages. Each finding is given by its kind, the spindle
/// speed, and its program line: "feed" for a feed move, "stop" for the spindle stop, and "end" for any other line.
std::string spindle_findings(const PlanedPart& part, const std::string& text, NcDialect dialect) {
  const std::vector<std::string> lines = lines_of(text);
  std::string found;
  for (const Finding& f : check_of(part, text, dialect).findings) {
    record_message(f.message);
    EXPECT_EQ(f.limit, static_cast<double>(part.lathe->spindle_rpm));
    const std::string line = f.line > 0 ? lines.at(static_cast<std::size_t>(f.line) - 1) : "";
    std::string place = "end";
    if (line.starts_with("G1 ") || line.starts_with("linear ")) place = "feed";
    if (line == kStops[static_cast<std::size_t>(dialect)]) place = "stop";
    found += fmt::format("{} {} rpm, {};", f.kind, f.value, place);
  }
  return found;
}

TEST(Lathe, TheSpindleTurnsFromBeforeTheFirstMoveToBehindTheLast) {
  PlanedPart part = turned_part();
  for (std::size_t d = 0; d < std::size(kNcDialectWords); ++d) {
    const auto dialect = static_cast<NcDialect>(d);
    const std::string text = turned_text(part, std::string(kNcDialectWords[d]));
    const std::string move = dialect == NcDialect::pmac ? "\nrapid " : "\nG0 ";
    EXPECT_LT(text.find("\n" + kStarts[d] + "\n"), text.find(move)) << text.substr(0, 400);
    EXPECT_GT(text.rfind("\n" + kStops[d] + "\n"), text.rfind(move));
    EXPECT_EQ(spindle_findings(part, text, dialect), "");
  }
  part.lathe->spindle_direction = SpindleDirection::counterclockwise;
  EXPECT_NE(turned_text(part, "sinumerik").find("\nS800 M4\n"), std::string::npos);
  EXPECT_TRUE(check_of(part, turned_text(part, "sinumerik"), NcDialect::sinumerik).passes());
}

TEST(Lathe, EveryFaultOfTheSpindleIsFoundInEveryDialect) {
  const PlanedPart part = turned_part();
  for (std::size_t d = 0; d < std::size(kNcDialectWords); ++d) {
    const auto dialect = static_cast<NcDialect>(d);
    const std::string& start = kStarts[d];
    const std::string& stop = kStops[d];
    const std::string text = turned_text(part, std::string(kNcDialectWords[d]));
    const auto found = [&](const std::string& faulty) { return spindle_findings(part, faulty, dialect); };
    const std::string at_end = has_own_texts(dialect) ? "spindle 0 rpm, end;" : "spindle 800 rpm, end;";
    EXPECT_EQ(found(with_line(text, start, "")), "spindle 0 rpm, feed;") << d;
    EXPECT_EQ(found(with_line(text, stop, "", true)), at_end) << d;
    // Stop the spindle before the last cut: insert the line before the last feed move.
    const std::size_t last_cut = text.rfind(dialect == NcDialect::pmac ? "\nlinear " : "\nG1 ") + 1;
    EXPECT_EQ(found(std::string(text).insert(last_cut, stop + "\n")), "spindle 0 rpm, stop;") << d;
    if (has_own_texts(dialect)) {
      EXPECT_EQ(found(with_line(text, start, "M3")), "spindle 0 rpm, feed;");
      EXPECT_EQ(found(with_line(text, stop, "M5", true)), at_end);
      EXPECT_THROW(found(with_line(text, start, "M104")), InputError);
      continue;
    }
    EXPECT_EQ(found(with_line(text, start, start.substr(0, start.size() - 1) + "4")), "spindle 800 rpm, feed;") << d;
    EXPECT_EQ(found(with_line(text, start, "S801 M3")), "spindle 801 rpm, feed;") << d;
    EXPECT_EQ(found(with_line(text, start, "M3")), "spindle 0 rpm, feed;") << d;
    EXPECT_EQ(found(std::string(text).insert(last_cut, "S80\n")), "spindle 80 rpm, feed;") << d;
  }
}

TEST(Lathe, ANoseThatIsNotThePlannedOneIsFound) {
  EXPECT_TRUE(finds(check_of(turned_part(0.0), turned_part(0.8)), "path"));
  EXPECT_TRUE(finds(check_of(turned_part(0.8), turned_part(0.0)), "path"));
  EXPECT_TRUE(finds(check_of(turned_part(0.8), turned_part(1.2)), "path"));
  EXPECT_TRUE(finds(check_of(turned_part(1.2), turned_part(0.8)), "path"));
}

}  // namespace
}  // namespace retrace::fabrication::verify_test
