// Tests of lenses that consist of zones. Profiles are compared with the law of Snell. Programs are checked by the moves
// in their text.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "core/error.h"
#include "design/io/init_templates.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/planing/plan/plan.h"
#include "fabrication/post/post.h"
#include "studies/planing/io/planing_files.h"
#include "studies/planing/planing_study.h"
#include "tests/fabrication/planing/findings.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::planing_test {
namespace {

using test::finds;

const std::string kExamples = std::string(RETRACE_SOURCE_DIR) + "/examples/planing/";

ZoneLens lens(double half_width_mm = 250.0) {
  return {500.0, 5.0, 1.52, half_width_mm};
}

PlanedPart small_part(double tolerance_mm = 0.2) {
  PlanedPart part;
  part.source = "part.toml";
  part.lens = {200.0, 5.0, 1.52, 90.0};
  part.length_mm = 100.0;
  part.tolerance_mm = tolerance_mm;
  part.mill = PlaningMill{};
  part.mill->fast_feed_mm_per_min = 3000.0;
  return part;
}

std::vector<PlaningText> texts_of(const PlaningPlan& plan, const std::string& dialect) {
  std::vector<PlaningText> texts;
  for (const PlannedProgram& planned : plan.programs)
    texts.push_back({planned.program.name, nc_text(planned.program, dialect)});
  return texts;
}

TEST(ZoneProfile, AllPathsDifferByWholeWavelengths) {
  const ZoneProfile profile(lens());
  for (double x = 0.0; x <= 250.0; x += 0.37) {
    const double depth = profile.depth_mm(x);
    const double way = std::hypot(x, 500.0 + depth) - 500.0 - 1.52 * depth;
    EXPECT_NEAR(way / 5.0, static_cast<double>(profile.zone_of(x)), 1e-11) << x;
    EXPECT_GE(depth, 0.0);
    EXPECT_LE(depth, profile.step_mm() + 1e-9);
  }
  EXPECT_NEAR(profile.step_mm(), 5.0 / 0.52, 1e-12);
}

TEST(ZoneProfile, SlopesRefractLightFromTheFocusParallel) {
  const ZoneProfile profile(lens());
  for (double x = 1.0; x <= 250.0; x += 3.1) {
    const std::size_t zone = profile.zone_of(x);
    const double r = std::hypot(x, 500.0 + profile.depth_mm(x));
    const double sine = x / r;
    const double cosine = (500.0 + profile.depth_mm(x)) / r;
    EXPECT_NEAR(profile.slope_in_zone(zone, x), sine / (1.52 - cosine), 1e-12);
    EXPECT_NEAR(profile.slope_in_zone(zone, x),
                (profile.depth_in_zone_mm(zone, x + 1e-4) - profile.depth_in_zone_mm(zone, x - 1e-4)) / 2e-4, 1e-8);
    EXPECT_NEAR(profile.position_in_zone_mm(zone, profile.depth_mm(x)), x, 1e-9);
  }
}

TEST(ZoneProfile, TooManyZonesForTheFocalLength) {
  EXPECT_THROW(ZoneProfile({20.0, 5.0, 1.2, 500.0}), InputError);
}

TEST(Planing, ToolIsAsSteepAsTheProfileAndNotMuchMore) {
  const ZoneProfile profile(lens());
  EXPECT_GE(flank_slope_of(profile), profile.steepest_slope());
  EXPECT_LT(std::atan(flank_slope_of(profile)) - std::atan(profile.steepest_slope()), 0.5 * std::numbers::pi / 180.0);
}

TEST(Planing, WhatStandsBetweenTwoCutsIsTheLargestOfManySamples) {
  const ZoneProfile profile(lens());
  const ZoneCutter cutter(profile, 0.01, 0.2);
  for (const std::size_t zone : {std::size_t{0}, std::size_t{3}, std::size_t{8}}) {
    const auto cuts = cutter.sequential_cuts(zone);
    for (std::size_t k = 1; k < cuts.size(); k += 7) {
      double most = 0.0;
      const double from = 0.01 * static_cast<double>(cuts[k - 1].x);
      const double to = 0.01 * static_cast<double>(cuts[k].x);
      for (int s = 0; s <= 400; ++s) {
        const double x = from + (to - from) * s / 400.0;
        const double left = std::max(0.0, 0.01 * static_cast<double>(cuts[k].depth) - cutter.flank_slope() * (to - x));
        most = std::max(most, profile.depth_in_zone_mm(zone, x) - left);
      }
      EXPECT_NEAR(cutter.cusp_height_mm(zone, &cuts[k - 1], cuts[k]), most, 1e-9);
      EXPECT_LE(most, 0.2);
    }
  }
}

TEST(Planing, OneAfterAnotherNoCutCouldBeFarther) {
  const ZoneProfile profile(lens());
  const ZoneCutter cutter(profile, 0.01, 0.2);
  const auto cuts = cutter.sequential_cuts(1);
  for (std::size_t k = 1; k + 1 < cuts.size(); ++k) {
    ZoneCut farther = cuts[k];
    farther.x += 1;
    farther.depth = std::llround(profile.depth_in_zone_mm(1, 0.01 * static_cast<double>(farther.x)) / 0.01);
    EXPECT_GT(cutter.cusp_height_mm(1, &cuts[k - 1], farther), 0.2);
  }
}

TEST(Planing, ProgramsKeepTheToleranceAndTheMachine) {
  for (const double tolerance_mm : {0.1, 0.2, 0.5}) {
    const PlanedPart part = small_part(tolerance_mm);
    const PlaningPlan plan = plan_planing(part);
    EXPECT_LT(plan.quantum_mm, tolerance_mm);
    const PlaningCheck check = check_planing(part, texts_of(plan, "rs274ngc"), NcDialect::rs274ngc);
    for (const Finding& f : check.findings) ADD_FAILURE() << f.kind << ' ' << f.line << ' ' << f.message;
    EXPECT_LE(check.excess_mm_max, tolerance_mm);
    EXPECT_GT(check.excess_mm_max, 0.5 * tolerance_mm);
    EXPECT_LE(check.gouge_mm_max, 0.005 + 1e-6);
    EXPECT_GE(check.shortest_x_mm, 13.0 - 1e-9);
    EXPECT_GE(check.shortest_y_mm, 13.0 - 1e-9);
    EXPECT_GE(check.shortest_z_mm, 6.0 - 1e-9);
    EXPECT_LT(check.off_grid_nm_max, 0.1);
    ASSERT_EQ(check.time_s.size(), plan.programs.size());
    for (std::size_t k = 0; k < plan.programs.size(); ++k) {
      EXPECT_NEAR(check.time_s[k], plan.programs[k].time_s, 1e-6 * plan.programs[k].time_s);
      EXPECT_EQ(check.frames[k], plan.programs[k].frames);
    }
  }
}

TEST(Planing, AFinerToleranceTakesMoreCuts) {
  std::size_t fewer = 0;
  for (const double tolerance_mm : {0.5, 0.2, 0.1}) {
    const std::size_t cuts = plan_planing(small_part(tolerance_mm)).cuts.size();
    EXPECT_GT(cuts, fewer);
    fewer = cuts;
  }
}

TEST(Planing, AllDialectsSayTheSame) {
  const PlanedPart part = small_part();
  const PlaningPlan plan = plan_planing(part);
  const PlaningCheck first = check_planing(part, texts_of(plan, "rs274ngc"), NcDialect::rs274ngc);
  for (std::size_t k = 0; k < std::size(kNcDialectWords); ++k) {
    const PlaningCheck check =
        check_planing(part, texts_of(plan, std::string(kNcDialectWords[k])), static_cast<NcDialect>(k));
    EXPECT_TRUE(check.passes()) << kNcDialectWords[k];
    EXPECT_EQ(check.frames, first.frames);
    EXPECT_EQ(check.excess_mm_max, first.excess_mm_max);
  }
}

TEST(Planing, ProgramsEndInTime) {
  PlanedPart part = small_part();
  const double whole_s = plan_planing(part).time_s();
  part.mill->max_hours = 0.25 * whole_s / 3600.0;
  const PlaningPlan plan = plan_planing(part);
  EXPECT_GT(plan.programs.size(), 4U);
  for (const PlannedProgram& planned : plan.programs) EXPECT_LE(planned.time_s, 0.25 * whole_s + 1e-9);
  EXPECT_TRUE(check_planing(part, texts_of(plan, "fanuc"), NcDialect::fanuc).passes());
  part.mill->max_hours = 0.001;
  EXPECT_THROW(plan_planing(part), InputError);
}

TEST(Planing, TravelThatIsTooShortIsToldWithWhatItTakes) {
  PlanedPart part = small_part();
  part.mill->travel_y_mm = 120.0;
  try {
    plan_planing(part);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "part.toml: mill.travel_mm");
  }
}

/// Returns the programs with one line replaced.
/// \param nth number of the line among the lines that contain `word`, from 1
std::vector<PlaningText> with_fault(std::vector<PlaningText> texts, std::size_t program, const std::string& word,
                                    std::size_t nth, const std::function<std::string(const std::string&)>& change) {
  std::istringstream in(texts[program].text);
  std::string out;
  std::size_t seen = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find(word) != std::string::npos && ++seen == nth) line = change(line);
    if (!line.empty()) out += line + "\n";
  }
  EXPECT_GE(seen, nth);
  texts[program].text = out;
  return texts;
}

TEST(Planing, EveryPlantedFaultIsFound) {
  const PlanedPart part = small_part();
  const PlaningPlan plan = plan_planing(part);
  const auto texts = texts_of(plan, "rs274ngc");
  const auto check = [&](const std::vector<PlaningText>& faulty) {
    return check_planing(part, faulty, NcDialect::rs274ngc);
  };
  const auto moved = [](double by_mm) {
    return [by_mm](const std::string& line) {
      const std::size_t at = line.find_first_of("XYZ", 2);
      std::ostringstream text;
      text.precision(6);
      text << line.substr(0, at + 1) << std::fixed << std::stod(line.substr(at + 1)) + by_mm;
      return text.str();
    };
  };
  EXPECT_TRUE(finds(check(with_fault(texts, 0, "G0 X", 9, moved(0.004))), "off_grid"));
  EXPECT_TRUE(finds(check(with_fault(texts, 0, "G0 Z-", 9, moved(-0.6))), "gouge"));
  bool is_gouged = false;  // true as soon as one of the changed X words causes a gouge
  for (std::size_t nth = 20; nth < 40 && !is_gouged; ++nth)
    is_gouged = finds(check(with_fault(texts, 0, "G0 X", nth, moved(-1.0))), "gouge");
  EXPECT_TRUE(is_gouged);
  EXPECT_TRUE(finds(check(with_fault(texts, 0, "G0 Y", 6, moved(-60.0))), "ends_in_part"));
  EXPECT_TRUE(finds(check(with_fault(texts, 0, "G0 Y", 6, moved(400000.0))), "travel"));
  EXPECT_TRUE(
      finds(check(with_fault(texts, 0, "G0 Y", 6, [](const std::string& l) { return l + " X3.0"; })), "several_axes"));
  EXPECT_TRUE(
      finds(check(with_fault(texts, 0, "G0 Y", 6, [](const std::string& l) { return "G1" + l.substr(2) + " F500."; })),
            "not_fast"));
  EXPECT_TRUE(
      finds(check(with_fault(texts, 0, "G0 Y", 6, [](const std::string&) { return "G0 Y60.000000\nG0 X50.000000"; })),
            "moves_in_part"));
  EXPECT_TRUE(finds(check(with_fault(texts, 0, "M2", 1, [](const std::string&) { return ""; })), "truncated"));
  auto missing = texts;
  missing.erase(missing.begin());
  EXPECT_TRUE(finds(check(missing), "excess"));
  PlanedPart quick = part;
  quick.mill->max_hours = 0.01;
  EXPECT_TRUE(finds(check_planing(quick, texts, NcDialect::rs274ngc), "too_long"));
  quick = part;
  quick.mill->min_move_z_mm = 6.5;
  EXPECT_TRUE(finds(check_planing(quick, texts, NcDialect::rs274ngc), "short_move"));
}

TEST(Planing, TheExampleIsMadeInTwoHalves) {
  const studies::PlaningResult result = studies::plane(kExamples + "zone_lens_60ghz.toml", "sinumerik");
  EXPECT_TRUE(result.check.passes());
  EXPECT_EQ(result.plan.runs, 2);
  const auto json = nlohmann::json::parse(studies::planing_json(result));
  EXPECT_EQ(json["schema"], "retrace.planing/2");
  EXPECT_EQ(json["verdict"], "pass");
  EXPECT_LE(json["form_error_mm_max"].get<double>(), 0.2);
  EXPECT_EQ(json["published_seconds_per_block"], nlohmann::json({7.2, 8.2}));
  for (const auto& program : json["programs"]) EXPECT_LE(program["hours"].get<double>(), 8.0);
  // Inner zones are too flat to be finished by one cut at each depth. Outer zones are steep enough.
  EXPECT_EQ(json["zones"].front()["method"], "one_after_another");
  EXPECT_EQ(json["zones"].back()["method"], "by_depths");
  EXPECT_NEAR(json["seconds_per_block"].get<double>() * json["blocks"].get<double>(),
              3600.0 * json["hours"].get<double>(), 1e-6 * 3600.0 * json["hours"].get<double>());
}

TEST(Planing, ControlsWithoutWordsAreToldHowTheSpindleStarts) {
  for (const std::string dialect : {"pmac", "a3200", "automation1"}) try {
      studies::plane(kExamples + "round_zone_lens.toml", dialect);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(recorded_place_of(error), "examples/planing/round_zone_lens.toml:15: lathe.spindle_start");
    }
  EXPECT_TRUE(studies::plane(kExamples + "zone_lens_60ghz.toml", "pmac").check.passes()) << "a mill needs none";
}

TEST(Planing, TheTemplateOfALatheIsMadeInEveryDialect) {
  const std::string text = design::design_template("round_zone_lens");
  const PlanedPart part = parse_planed_part(text, "t.toml");
  EXPECT_EQ(part.lathe->spindle_rpm, 800);
  // Lines that show a default or an alternative must be valid without their leading "# ".
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);)
    all += (line.starts_with("# ") && line.find(" = ") != std::string::npos ? line.substr(2) : line) + "\n";
  const PlanedPart whole = parse_planed_part(all, "t.toml");
  EXPECT_EQ(whole.lathe->depth_of_cut_mm, part.lathe->depth_of_cut_mm);
  EXPECT_EQ(whole.lathe->clearance_mm, part.lathe->clearance_mm);
  EXPECT_EQ(whole.lathe->nose_radius_mm, part.lathe->nose_radius_mm);
  const PlaningPlan plan = plan_planing(whole);
  for (std::size_t k = 0; k < std::size(kNcDialectWords); ++k)
    EXPECT_TRUE(
        check_planing(whole, texts_of(plan, std::string(kNcDialectWords[k])), static_cast<NcDialect>(k)).passes())
        << kNcDialectWords[k];
}

TEST(Planing, TheRoundExampleStaysInItsTube) {
  const studies::PlaningResult result = studies::plane(kExamples + "round_zone_lens.toml", "rs274ngc");
  EXPECT_TRUE(result.check.passes());
  EXPECT_LE(result.check.path_distance_mm_max, 0.05 * 1.001);
  EXPECT_GT(result.check.path_distance_mm_max, 0.04);
  EXPECT_LE(result.plan.chords.size(), result.plan.longest.size());
  EXPECT_EQ(result.plan.passes, 4);  // 9.615 mm in passes of 2.5 mm
  // The check must find a last pass that does not reach the profile.
  auto programs = result.programs;
  const std::size_t at = programs[0].text.rfind("G1 X");
  const std::size_t z = programs[0].text.find(" Z", at);
  programs[0].text.replace(z, programs[0].text.find(" F", z) - z, " Z-1.000000");
  EXPECT_TRUE(finds(check_planing(result.part, programs, NcDialect::rs274ngc), "path"));
}

}  // namespace
}  // namespace retrace::fabrication::planing_test
