#include "fabrication/turning/plan/cubic_path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/post/post.h"
#include "fabrication/turning/check/turning_check.h"
#include "fabrication/turning/io/part_files.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/turning/plain_cut.h"
#include "tests/support/refusals.h"
#include "tests/support/sample_size.h"

// Tests of spirals that are given by positions, velocities and times. The test parses the program text itself and
// evaluates its moves as Bezier curves. The reference is a plane, for which the position of the nose is known in closed
// form.

namespace retrace::fabrication::turning::cubic_path_test {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr std::array kDialects = {NcDialect::pmac, NcDialect::a3200, NcDialect::automation1};

std::string word_of(NcDialect dialect) {
  return std::string(kNcDialectWords[static_cast<std::size_t>(dialect)]);
}

/// A plane surface, its tool and its path.
struct Plane {
  double x_slope = 0.1;
  double y_slope = 0.05;
  double nose_mm = 0.2;
  double radius_mm = 0.06;
  double feed_mm = 0.02;
  double rpm = 30.0;
  double acceleration = 400.0;
  double error_nm = 2.0;
  double skew_deg = 0.0;

  std::string file(const std::string& more = "") const {
    return fmt::format(
        "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"formula\"\nformula = \"{}*x+{}*y\"\n"
        "[tool]\nnose_radius_mm = {}\nclearance_deg = 30\nskew_deg = {}\n"
        "[path]\nradius_mm = {}\nfeed_um = {}\nspindle_rpm = {}\ncubic_error_nm = {}\n"
        "[machine]\nc_acceleration_deg_per_s2 = {}\n{}[inspect]\nform_tolerance_nm = 20\nmap_pixels = 11\n",
        x_slope, y_slope, nose_mm, skew_deg, radius_mm, 1e3 * feed_mm, rpm, error_nm, acceleration, more);
  }

  /// Returns the height of the lowest point of the nose at the spindle angle c. It is the height of the plane plus r
  /// (sqrt(1 + s^2) - 1), where s is the slope along the edge. With the additional height, the nose touches the plane
  /// at a point next to its lowest point and does not gouge.
  double height_mm(double x_mm, double y_mm, double c_deg) const {
    const double c = c_deg * kRad;
    const double px = x_mm * std::cos(c) + y_mm * std::sin(c);
    const double py = -x_mm * std::sin(c) + y_mm * std::cos(c);
    const double aside = x_slope * std::cos(c) - y_slope * std::sin(c);
    return x_slope * px + y_slope * py + nose_mm * (std::sqrt(1.0 + aside * aside) - 1.0);
  }

  /// Returns the distance of the point of contact from the spindle axis, for a tool without skew.
  double touching_radius_mm(double x_mm, double c_deg) const {
    const double c = c_deg * kRad;
    const double aside = x_slope * std::cos(c) - y_slope * std::sin(c);
    return std::abs(x_mm + nose_mm * aside / std::sqrt(1.0 + aside * aside));
  }
};

struct Planned {
  TurnedPart part;
  CubicPath path;
  Program program;
};

Planned planned(const std::string& file) {
  TurnedPart part = parse_turned_part(file, "part.toml");
  CubicPath path = cubic_path(part.surface, part.tool, part.path, 1.0 / part.machine.blocks_per_s.value_or(1e9),
                              {"part.toml", 0, "path.cubic_error_nm"});
  Program program = turning_program(path, part.path, "part", {});
  return {std::move(part), std::move(path), std::move(program)};
}

/// Positions of X, Y, Z and C at the end of a move, their speeds per second, and the duration of the move.
struct Knot {
  std::array<double, 4> at{};
  std::array<double, 4> speed{};
  double seconds = 0.0;
};

std::vector<double> numbers_in(const std::string& text) {
  static const std::regex kNumber("-?[0-9]+(?:\\.[0-9]+)?");
  std::vector<double> result;
  for (std::sregex_iterator it(text.begin(), text.end(), kNumber), end; it != end; ++it)
    result.push_back(std::stod(it->str()));
  return result;
}

/// Returns the moves of a program text, parsed independently of retrace. The first element is `start`.
std::vector<Knot> knots_in(const std::string& text, NcDialect dialect, const Knot& start) {
  std::vector<Knot> knots = {start};
  double clock_s = 0.0;
  const auto place = [](char letter) { return std::string("XYZC").find(letter); };
  for (const std::string& line : fabrication::test::lines_of_text(text)) {
    Knot knot = knots.back();
    knot.speed = {};
    if (dialect == NcDialect::pmac && line.starts_with("pvt")) {
      const std::vector<double> n = numbers_in(line);
      knot.seconds = 1e-3 * n[0];
      std::size_t k = 1;
      for (const char c : line.substr(3))
        if (const auto axis = place(c); axis != std::string::npos) {
          knot.at[axis] = n[k++];
          knot.speed[axis] = n[k++] / 60.0;  // Coord[1].FeedTime=60000: speeds are per minute
        }
    } else if (dialect == NcDialect::a3200 && line.starts_with("PVT X")) {
      const std::vector<double> n = numbers_in(line);
      std::size_t k = 0;
      for (const char c : line.substr(3, line.find("TIME") - 3))
        if (const auto axis = place(c); axis != std::string::npos) {
          knot.at[axis] = n[k++];
          knot.speed[axis] = n[k++];
        }
      knot.seconds = n[k] - clock_s;
      clock_s = n[k];
    } else if (dialect == NcDialect::automation1 && line.starts_with("MovePvt(")) {
      const std::vector<double> n = numbers_in(line);
      std::vector<std::size_t> axes;
      for (const char c : line.substr(8, line.find(']') - 8))
        if (const auto axis = place(c); axis != std::string::npos) axes.push_back(axis);
      for (std::size_t k = 0; k < axes.size(); ++k) {
        knot.at[axes[k]] = n[k];
        knot.speed[axes[k]] = n[axes.size() + k];
      }
      knot.seconds = n.back();
    } else {
      continue;
    }
    knots.push_back(knot);
  }
  return knots;
}

/// Returns the position at the fraction t of the move from a to b. The cubic is evaluated by the algorithm of de
/// Casteljau.
std::array<double, 4> between(const Knot& a, const Knot& b, double t) {
  std::array<double, 4> at{};
  for (std::size_t axis = 0; axis < 4; ++axis) {
    std::array<double, 4> p = {a.at[axis], a.at[axis] + a.speed[axis] * b.seconds / 3.0,
                               b.at[axis] - b.speed[axis] * b.seconds / 3.0, b.at[axis]};
    for (std::size_t level = 3; level > 0; --level)
      for (std::size_t k = 0; k < level; ++k) p[k] += t * (p[k + 1] - p[k]);
    at[axis] = p[0];
  }
  return at;
}

TEST(CubicPath, TextOfEveryDialectStaysAsNearAsAsked) {
  std::mt19937 bits(3);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  for (int k = 0; k < 12; ++k) {
    Plane plane;
    plane.x_slope = uniform(-0.2, 0.2);
    plane.y_slope = uniform(-0.2, 0.2);
    plane.nose_mm = uniform(0.05, 0.5);
    plane.radius_mm = uniform(0.05, 0.3);
    plane.rpm = uniform(5.0, 120.0);
    plane.acceleration = uniform(50.0, 5000.0);
    plane.error_nm = uniform(0.5, 8.0);
    plane.skew_deg = k % 3 == 0 ? uniform(-20.0, 20.0) : 0.0;
    const Planned plan = planned(plane.file());
    EXPECT_LE(plan.path.error_nm, plane.error_nm);
    const double skew = plane.skew_deg * kRad;
    Knot start;
    start.at = {plane.radius_mm * std::cos(skew), -plane.radius_mm * std::sin(skew), 0.0, 0.0};
    start.at[2] = plane.height_mm(start.at[0], start.at[1], 0.0);
    for (const NcDialect dialect : kDialects) {
      const std::vector<Knot> knots = knots_in(nc_text(plan.program, word_of(dialect)), dialect, start);
      ASSERT_EQ(knots.size(), plan.path.points.size()) << word_of(dialect);
      EXPECT_EQ(knots.back().speed, (std::array<double, 4>{})) << "ends at a standstill";
      EXPECT_NEAR(knots.back().at[0], 0.0, 1e-6);
      double worst_nm = 0.0;
      for (std::size_t i = 1; i < knots.size(); ++i) {
        EXPECT_NEAR(1e3 * knots[i].seconds, std::round(1e3 * knots[i].seconds), 1e-6) << "whole milliseconds";
        for (int part = 0; part <= 16; ++part) {
          const std::array<double, 4> at = between(knots[i - 1], knots[i], part / 16.0);
          const double r = plane.radius_mm - plane.feed_mm * at[3] / 360.0;
          const double aside = std::hypot(at[0] - r * std::cos(skew), at[1] + r * std::sin(skew));
          worst_nm = std::max({worst_nm, 1e6 * aside, 1e6 * std::abs(at[2] - plane.height_mm(at[0], at[1], at[3]))});
        }
      }
      // Positions in the text are rounded to 1 nm, so that each may be wrong by half a nanometre.
      EXPECT_LT(worst_nm, plane.error_nm + 1.5) << word_of(dialect) << ' ' << k;
    }
  }
}

/// Returns the deviations from the design at points on the border. The moves are evaluated as cubics by this test.
std::vector<double> border_of(const TurnedPart& part, const std::vector<Knot>& knots) {
  std::vector<std::array<double, 4>> points = {knots.front().at};
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (int step = 1; step <= 12; ++step) points.push_back(between(knots[i - 1], knots[i], step / 12.0));
  return fabrication::test::deviations(fabrication::test::PlainCut(part, points),
                                       fabrication::test::border_places(part, 40));
}

bool differ_in_z_only(const std::vector<Knot>& a, const std::vector<Knot>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Knot& one, const Knot& other) {
    for (const std::size_t axis : {0U, 1U, 3U})
      if (one.at[axis] != other.at[axis] || one.speed[axis] != other.speed[axis]) return false;
    return one.seconds == other.seconds;
  });
}

std::vector<Finding> findings_of(const TurnedPart& part, const std::string& text, NcDialect dialect) {
  FindingList findings;
  check_turning(part, read_cuts(part, {parse_nc(text, "part", dialect)}, findings), std::nullopt, findings);
  return findings.take();
}

TEST(CubicPath, TextIsReadAsWhatItSays) {
  const Plane plane;
  const Planned plan = planned(plane.file());
  Knot start;
  start.at = {plane.radius_mm, 0.0, 1e-6 * std::round(1e6 * plane.height_mm(plane.radius_mm, 0.0, 0.0)), 0.0};
  for (const NcDialect dialect : kDialects) {
    const std::string text = nc_text(plan.program, word_of(dialect));
    EXPECT_EQ(recognise_dialect(text, "part"), dialect);
    CutRecorder recorder;
    EXPECT_TRUE(run_nc(parse_nc(text, "part", dialect), recorder).is_complete);
    const std::vector<CutPass> cuts = recorder.take();
    ASSERT_EQ(cuts.size(), 1U);
    const std::vector<Knot> knots = knots_in(text, dialect, start);
    std::size_t knot = 1;
    double into_s = 0.0;
    for (std::size_t i = 1; i < cuts[0].size(); ++i) {
      into_s += cuts[0].duration_s[i];
      const std::array<double, 4> at = between(knots[knot - 1], knots[knot], into_s / knots[knot].seconds);
      EXPECT_NEAR(cuts[0].x_mm[i], at[0], 1e-9);
      EXPECT_NEAR(cuts[0].z_mm[i], at[2], 1e-9);
      EXPECT_NEAR(cuts[0].c_rad[i] / kRad, at[3], 1e-8);
      if (cuts[0].block_s[i] == 0.0) continue;
      EXPECT_NEAR(cuts[0].block_s[i], knots[knot].seconds, 1e-9);
      into_s = 0.0;
      ++knot;
    }
    EXPECT_EQ(knot, knots.size());
    for (const Finding& finding : findings_of(plan.part, text, dialect)) ADD_FAILURE() << text_of(finding);
  }
}

TEST(CubicPath, TakesFewerMovesThanStraightOnes) {
  const Plane plane{.radius_mm = 0.5, .rpm = 60.0};
  const Planned plan = planned(plane.file());
  const auto straight = make_path(plan.part.surface, plan.part.tool, plan.part.path, {"part.toml", 0, "path"});
  EXPECT_LT(10 * plan.path.points.size(), straight.front().size());
}

TEST(CubicPath, MovesAreNoShorterThanTheControlCarriesOut) {
  const Planned plan = planned(Plane{.rpm = 15.0, .error_nm = 10.0}.file("blocks_per_s = 40\n"));
  for (auto point = plan.path.points.begin() + 1; point != plan.path.points.end(); ++point)
    EXPECT_GE(point->point.seconds, 0.025 - 1e-12);
  for (const Finding& finding : findings_of(plan.part, nc_text(plan.program, "a3200"), NcDialect::a3200))
    ADD_FAILURE() << text_of(finding);
  EXPECT_THROW(planned(Plane{.rpm = 6000.0, .acceleration = 1e6, .error_nm = 0.1}.file()), InputError);
}

/// The limits of the machine are checked for cubic moves in the same way as for straight moves. The expected motion is
/// computed from closed forms.
TEST(CubicPath, LimitsOfTheMachineAreThose) {
  const Plane plane{.x_slope = 0.2, .y_slope = 0.0, .radius_mm = 0.3, .rpm = 60.0};
  const Planned plan = planned(plane.file());
  FindingList findings;
  const TurningCheck check = check_turning(
      plan.part, read_cuts(plan.part, {parse_nc(nc_text(plan.program, "pmac"), "part", NcDialect::pmac)}, findings),
      std::nullopt, findings);
  EXPECT_NEAR(check.motion.spindle_rpm, 60.0, 1e-3);
  EXPECT_NEAR(check.motion.c_acceleration_deg_per_s2, plane.acceleration, 0.01 * plane.acceleration);
  // The motion of Z at one revolution per second is compared with a circle slightly inside the rim. At the rim itself,
  // C is still accelerating.
  double acceleration = 0.0;
  double jerk = 0.0;
  for (int c_deg = 0; c_deg < 360; ++c_deg) {
    const auto z = [&](double seconds) { return plane.height_mm(0.29, 0.0, c_deg + 360.0 * seconds); };
    constexpr double h = 1e-3;
    acceleration = std::max(acceleration, std::abs(z(h) - 2.0 * z(0.0) + z(-h)) / (h * h));
    jerk = std::max(jerk, std::abs(z(2 * h) - 2.0 * z(h) + 2.0 * z(-h) - z(-2 * h)) / (2.0 * h * h * h));
  }
  EXPECT_NEAR(check.motion.axes[2].acceleration_mm_per_s2, acceleration, 0.04 * acceleration);
  EXPECT_NEAR(check.motion.axes[2].jerk_mm_per_s3, jerk, 0.1 * jerk);
  TurnedPart weak = plan.part;
  weak.machine.axes[2].acceleration_mm_per_s2 = 0.5 * acceleration;
  const std::vector<Finding> found = findings_of(weak, nc_text(plan.program, "pmac"), NcDialect::pmac);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Finding& f) { return f.kind == "axis_acceleration"; }));
}

/// Adds programs in which one number of every second move is changed, in four ways.
void add_changed_numbers(const std::string& text, std::vector<fabrication::test::Mutant>& mutants) {
  static const std::regex kNumber("-?[0-9]+\\.[0-9]+");
  const std::vector<std::string> lines = fabrication::test::lines_of_text(text);
  std::size_t moves = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_move =
        lines[i].starts_with("pvt") || lines[i].starts_with("PVT X") || lines[i].starts_with("MovePvt");
    if (!is_move || moves++ % 2 != 0) continue;
    for (std::sregex_iterator it(lines[i].begin(), lines[i].end(), kNumber), end; it != end; ++it)
      for (const auto& [factor, shift] : {std::pair{1.0, 1e-3}, {1.0, -1e-3}, {1.5, 0.0}, {1.0, 20.0}}) {
        std::vector<std::string> changed = lines;
        changed[i].replace(static_cast<std::size_t>(it->position()), static_cast<std::size_t>(it->length()),
                           fmt::format("{:.7f}", std::stod(it->str()) * factor + shift));
        mutants.push_back({changed[i] + " for " + lines[i], fabrication::test::text_of_lines(changed)});
      }
  }
}

/// Changes one line or number of a program. The test evaluates the moves as cubics and computes how much the change
/// alters the part. The verifier must find every change that alters the part by more than twice the tolerance.
TEST(CubicPath, NoFaultOfAMovePasses) {
  // A usual run tries every seventh change. A long run tries every change.
  const std::size_t stride = retrace::test::sample_size<std::size_t>(7, 1);
  const Plane plane{.radius_mm = 0.05, .feed_mm = 0.02, .error_nm = 5.0};
  const Planned plan = planned(plane.file());
  Knot start;
  start.at = {plane.radius_mm, 0.0, 1e-6 * std::round(1e6 * plane.height_mm(plane.radius_mm, 0.0, 0.0)), 0.0};
  const auto worst_nm = [&](const std::vector<Knot>& knots) {
    double worst = 0.0;
    for (std::size_t i = 1; i < knots.size(); ++i)
      for (int part = 1; part <= 16; ++part) {
        const std::array<double, 4> at = between(knots[i - 1], knots[i], part / 16.0);
        if (plane.touching_radius_mm(at[0], at[3]) > plane.radius_mm) continue;  // the nose touches outside of the part
        worst = std::max(worst, std::abs(at[2] - plane.height_mm(at[0], at[1], at[3])));
      }
    return 1e6 * worst;
  };
  int faults = 0;
  for (const NcDialect dialect : kDialects) {
    const std::string text = nc_text(plan.program, word_of(dialect));
    std::vector<fabrication::test::Mutant> mutants = fabrication::test::mutants_of(text, {}, {});
    add_changed_numbers(text, mutants);
    const std::vector<Knot> right_knots = knots_in(text, dialect, start);
    const std::vector<double> right = border_of(plan.part, right_knots);
    for (std::size_t k = 0; k < mutants.size(); k += stride) {
      const fabrication::test::Mutant& mutant = mutants[k];
      double left_nm = 0.0;
      try {
        const std::vector<Knot> knots = knots_in(mutant.text, dialect, start);
        left_nm = worst_nm(knots);
        // If only Z differs, compare the deviations at the border with those of the correct program.
        if (differ_in_z_only(knots, right_knots)) {
          const std::vector<double> border = border_of(plan.part, knots);
          for (std::size_t i = 0; i < border.size(); ++i)
            left_nm = std::max(left_nm, 1e6 * std::max(border[i] - right[i], -border[i]));
        }
      } catch (const std::exception&) {
        continue;  // the test cannot parse the changed move
      }
      if (!(left_nm > 2.0 * plan.part.form_tolerance_nm)) continue;
      ++faults;
      bool is_found = true;
      try {
        is_found = !findings_of(plan.part, mutant.text, dialect).empty();
      } catch (const InputError&) {
      }
      EXPECT_TRUE(is_found) << word_of(dialect) << ": " << mutant.what << " leaves " << left_nm << " nm";
    }
  }
  EXPECT_GT(faults, 30);
}

TEST(CubicPath, WhatNoControlCarriesOutIsRefused) {
  struct Case {
    NcDialect dialect;
    std::string lines;
    std::string place;
  };
  const std::string pmac = "open prog 1\nabs\nCoord[1].FeedTime=60000\nrapid X0. Z0. C0.\n";
  const std::string a3200 = "G71 G76 G90\nG0 X0. Z0. C0.\n";
  const std::string automation1 =
      "program\nSetupTaskDistanceUnits(DistanceUnits.Primary)\nSetupTaskTimeUnits(TimeUnits.Seconds)\nG90\nG0 X0. Z0. "
      "C0.\n";
  const Case cases[] = {
      {NcDialect::pmac, pmac + "pvt10 X1.\nclose\n", "part:5"},
      {NcDialect::pmac, pmac + "pvt10\nclose\n", "part:5"},
      {NcDialect::pmac, pmac + "pvt0 X1.:0\nclose\n", "part:5"},
      {NcDialect::pmac, pmac + "pvt10 X1.:0 X2.:0\nclose\n", "part:5"},
      {NcDialect::pmac, pmac + "pvt10 X1.:5\nclose\n", "part:6"},
      {NcDialect::pmac, pmac + "pvt10 X1.:5 Z1.:0\npvt10 Z2.:0\nclose\n", "part:6"},
      {NcDialect::pmac, "open prog 1\nabs\npvt10 X1.:0\nclose\n", "part:3"},
      {NcDialect::pmac, pmac + "X1.:5\nclose\n", "part:5"},
      {NcDialect::a3200, a3200 + "PVT X 1.,0. TIME 1.\nEND PROGRAM\n", "part:3"},
      {NcDialect::a3200, a3200 + "PVT INIT TIME ABS\nPVT X 1.,0. TIME 1.\nPVT X 2.,0. TIME 1.\nEND PROGRAM\n",
       "part:5"},
      {NcDialect::a3200, a3200 + "PVT INIT TIME ABS\nPVT X 1. TIME 1.\nEND PROGRAM\n", "part:4"},
      {NcDialect::a3200, a3200 + "PVT INIT TIME ABS\nPVT X 1.,0.\nEND PROGRAM\n", "part:4"},
      {NcDialect::a3200, a3200 + "PVT INIT TIME INC\nEND PROGRAM\n", "part:3"},
      {NcDialect::a3200, a3200 + "G75\nPVT INIT TIME ABS\nPVT X 1.,0. TIME 1.\nEND PROGRAM\n", "part:5"},
      {NcDialect::automation1, automation1 + "MovePvt([X], [1.], [0.])\nend\n", "part:6"},
      {NcDialect::automation1, automation1 + "MovePvt([X, Z], [1.], [0., 0.], 1.)\nend\n", "part:6"},
      {NcDialect::automation1, automation1 + "MovePvt([Q], [1.], [0.], 1.)\nend\n", "part:6"},
      {NcDialect::automation1, automation1 + "MovePvt([X], [1.], [0.], -1.)\nend\n", "part:6"},
      {NcDialect::automation1, automation1 + "MovePvt([X], [1.], [0.], 1.) 3\nend\n", "part:6"}};
  for (const Case& c : cases) {
    CutRecorder recorder;
    EXPECT_EQ(refusal_of([&] { run_nc(parse_nc(c.lines, "part", c.dialect), recorder); }), c.place) << c.lines;
  }
  for (const char* dialect : {"rs274ngc", "sinumerik", "fanuc"})
    EXPECT_THROW(nc_text(planned(Plane{}.file()).program, dialect), InputError);
}

TEST(CubicPath, PartsThatCannotHaveItAreRefused) {
  const std::string good = Plane{}.file();
  const auto refused = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    try {
      parse_turned_part(text, "part.toml");
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "accepted";
  };
  EXPECT_EQ(refused("c_acceleration_deg_per_s2 = 400", ""), "part.toml:13: path.cubic_error_nm");
  EXPECT_EQ(refused("spindle_rpm = 30", "spindle_rpm = 30\nservo = \"fast\""), "part.toml:14: path.cubic_error_nm");
  EXPECT_EQ(refused("cubic_error_nm = 2", "cubic_error_nm = 0"), "part.toml:13: path.cubic_error_nm");
  EXPECT_EQ(refused("cubic_error_nm = 2", "cubic_error_nm = nan"), "part.toml:13: path.cubic_error_nm");
  EXPECT_EQ(refused("radius_mm = 0.06\nfeed_um = 20\nspindle_rpm = 30",
                    "strategy = \"raster\"\nsize_mm = [1, 1]\narc_um = 5\ncutting_mm_per_min = 6\nfeed_um = 20"),
            "part.toml:15: path.cubic_error_nm");
}

}  // namespace
}  // namespace retrace::fabrication::turning::cubic_path_test
