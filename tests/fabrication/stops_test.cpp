#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/limit_error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/substrate_jobs.h"
#include "tests/support/refusals.h"

// Tests of programs that stop: for the next cutting edge, for inspection, and before finishing. Other tests cover
// restarts after a stop, and chips that are too thin to be cut. The planner counts its own moves, and the verifier
// counts the moves of the program text. They share no code for this.

namespace retrace::fabrication::test::stops_test {
namespace {

using geometry::Arrangement;

using Lines = std::vector<std::string>;

using Case = StrategyCase;

std::vector<Case> cases() {
  return strategy_cases([](Job& job) {
    job.tool.width_mm = job.strategy == Strategy::two_step ? 0.3 : 0.451;
    job.tool.edge_radius_um = 1.0;
    job.process.slow_retract_um = job.strategy == Strategy::bidirectional ? 5.0 : 0.0;
    job.process.plough_lift_um = job.strategy == Strategy::unidirectional ? 2.0 : 0.0;
  });
}

Case two_step() {
  return cases()[2];
}

class Stops : public ::testing::TestWithParam<NcDialect> {
 protected:
  std::string word() const { return std::string(kNcDialectWords[static_cast<std::size_t>(GetParam())]); }

  Machine machine_of(const Case& c, double warm_up_s = 0.0) const {
    const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + c.machine + ".toml";
    Machine machine = for_dialect(parse_machine(read_file(file), file), word());
    machine.warm_up_s.value = warm_up_s;
    return machine;
  }
  NcProgram program(const std::string& text, std::int32_t stop_line = 0) const {
    NcProgram program = parse_nc(text, "p", GetParam(), control_texts());
    program.stop_line = stop_line;
    return program;
  }
  std::vector<NcProgram> programs(const Plan& plan) const {
    std::vector<NcProgram> result;
    for (const Program& p : plan.programs) result.push_back(program(nc_text(p, word())));
    return result;
  }
  std::string stop_line() const { return has_own_texts(GetParam()) ? control_texts().stop : "M0"; }
  bool is_comment(const std::string& line) const {
    return line.starts_with("(") || line.starts_with(";") || line.starts_with("//") || line.starts_with("'") ||
           line.starts_with("MSG");
  }
  /// Returns the kinds of the findings, each kind one time. Returns "error" for a text that cannot be executed.
  std::string kinds_in(const Case& c, const Machine& machine, const Lines& lines) const {
    try {
      return kinds_of(verify_programs(c.job, machine, {program(text_of_lines(lines))}, {}, {}));
    } catch (const InputError&) {
      return "error";
    }
  }
  static std::string kinds_of(const Verification& v) {
    std::vector<std::string> kinds;
    for (const Finding& f : v.findings) kinds.push_back(f.kind);
    std::sort(kinds.begin(), kinds.end());
    kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
    return fmt::format("{}", fmt::join(kinds, " "));
  }
};

/// Returns the maximum length of cut, in mm, of a visit, which is one call of a cutting subroutine at an element. A
/// shorter edge life is refused with this length as the limit, so the edge life is raised until the job is accepted.
double longest_visit_mm(const Case& c, const Machine& machine) {
  Job job = c.job;
  job.tool.edge_life_mm = 1e-3;
  for (;;) try {
      make_plan(job, machine);
      return *job.tool.edge_life_mm;
    } catch (const LimitError& error) {
      EXPECT_EQ(error.where().key, "tool.edge_life_mm");
      job.tool.edge_life_mm = error.limit();
    }
}

TEST_P(Stops, EdgesCutNoMoreThanTheirLifeAndNoLess) {
  for (Case c : cases()) {
    const Machine machine = machine_of(c, 20.0);
    Job endless = c.job;
    endless.tool.edge_life_mm = 1e6;
    const double all_mm = make_plan(endless, machine).program_cuts_mm.front();
    for (const NextEdge next : {NextEdge::stop, NextEdge::program}) {
      c.job.tool.edge_life_mm = std::max(all_mm / 3.5, longest_visit_mm(c, machine));
      c.job.tool.next_edge = next;
      const Plan plan = make_plan(c.job, machine);
      EXPECT_EQ(next == NextEdge::stop, plan.programs.size() == 1) << c.name;
      std::vector<double> cut_mm;
      for (const PlannedStop& stop : plan.stops) cut_mm.push_back(stop.wear.cut_mm);
      double last_mm = 0.0;
      for (const double mm : plan.program_cuts_mm) last_mm += mm;
      EXPECT_NEAR(last_mm, all_mm, 1e-5 * all_mm) << c.name;
      if (next == NextEdge::program) cut_mm = plan.program_cuts_mm;
      ASSERT_GE(cut_mm.size(), 3U) << c.name;
      const std::vector<NcProgram> read = programs(plan);
      const Verification v = verify_programs(c.job, machine, read, {}, {});
      EXPECT_TRUE(v.passes()) << c.name << "\n" << listed(v);
      // Planner and verifier compute the same length of cut. The verifier must report an edge life that is slightly
      // shorter than the longest length.
      const double most_mm = *std::max_element(cut_mm.begin(), cut_mm.end());
      EXPECT_LE(most_mm, *c.job.tool.edge_life_mm) << c.name;
      Job shorter = c.job;
      shorter.tool.edge_life_mm = most_mm * (1.0 - 2e-4);
      EXPECT_EQ(kinds_of(verify_programs(shorter, machine, read, {}, {})), "edge_worn") << c.name;
      shorter.tool.edge_life_mm = most_mm;
      EXPECT_TRUE(verify_programs(shorter, machine, read, {}, {}).passes()) << c.name;
    }
  }
}

TEST_P(Stops, ProgramsRunNoLongerThanTheyMayAndWarm) {
  for (Case c : cases()) {
    constexpr double kWarmUp = 10.0;
    const Machine machine = machine_of(c, kWarmUp);
    const double cutting_s = make_plan(c.job, machine).time.total_s() - kWarmUp;
    c.job.process.stop_every_min = (cutting_s / 2.5 + kWarmUp + 5.0) / 60.0;
    const Plan plan = make_plan(c.job, machine);
    ASSERT_GE(plan.stops.size(), 2U) << c.name;
    const std::vector<NcProgram> read = programs(plan);
    const Verification v = verify_programs(c.job, machine, read, {}, {});
    EXPECT_TRUE(v.passes()) << c.name << "\n" << listed(v);
    EXPECT_NEAR(v.time.total_s(), plan.time.total_s(), 0.005 * plan.time.total_s()) << c.name;
    Machine colder = machine;
    colder.warm_up_s.value = 300.0;
    const Verification cold = verify_programs(c.job, colder, read, {}, {});
    std::size_t found = 0;
    for (const Finding& f : cold.findings) found += static_cast<std::size_t>(f.count);
    EXPECT_EQ(found, plan.stops.size() + 1) << listed(cold);
    EXPECT_EQ(kinds_of(cold), "cold");
    Job impatient = c.job;
    impatient.process.stop_every_min = 0.8 * *c.job.process.stop_every_min;
    EXPECT_EQ(kinds_of(verify_programs(impatient, machine, read, {}, {})), "stop_overdue") << c.name;
  }
}

TEST_P(Stops, ElementsAreInspectedBeforeTheyAreFinished) {
  for (Case c : {cases()[2], cases()[3]}) {
    const Machine machine = machine_of(c);
    const std::vector<NcProgram> without = programs(make_plan(c.job, machine));
    c.job.process.stop_before_finishing = true;
    const Plan plan = make_plan(c.job, machine);
    // The elements of a checker are cut in two groups, with one stop before the finishing of each group.
    EXPECT_EQ(plan.stops.size(), c.name == "dmc" ? 1U : 2U);
    for (const PlannedStop& stop : plan.stops) EXPECT_EQ(stop.reason, StopReason::finishing);
    const Verification v = verify_programs(c.job, machine, programs(plan), {}, {});
    EXPECT_TRUE(v.passes()) << c.name << "\n" << listed(v);
    EXPECT_EQ(kinds_of(verify_programs(c.job, machine, without, {}, {})), "not_inspected");
  }
}

/// A program fails verification if any line of a stop is missing. The test removes one line at a time, from the
/// retraction of the tool before the stop to the first cut after the stop.
TEST_P(Stops, EveryLineOfAStopIsMissed) {
  for (Case c : cases()) {
    const Machine machine = machine_of(c, 5.0);
    if (c.name == "two-step" || c.name == "dmc") c.job.process.stop_before_finishing = true;
    c.job.tool.edge_life_mm = 1.5 * longest_visit_mm(c, machine);
    const Plan plan = make_plan(c.job, machine);
    const std::string text = nc_text(plan.programs.front(), word());
    const Lines lines = lines_of_text(text);
    ASSERT_EQ(kinds_in(c, machine, lines), "") << c.name;
    EXPECT_EQ(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), stop_line())), plan.stops.size());
    int tried = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i] != stop_line()) continue;
      // The lines of a stop begin with the last Z move before it, which retracts the tool. They end before the next
      // comment that names an element. The comment "Goes on" does not count.
      const auto is_element = [&](std::size_t k) {
        return lines[k].find("element ") != std::string::npos && lines[k].find("Goes on") == std::string::npos;
      };
      std::size_t begin = i;
      while (lines[begin].find('Z') == std::string::npos || is_comment(lines[begin])) --begin;
      std::size_t end = i + 2;
      while (!is_element(end)) ++end;
      for (std::size_t k = begin; k < end + 3; ++k) {
        if (is_comment(lines[k])) continue;
        Lines spoilt = lines;
        spoilt.erase(spoilt.begin() + static_cast<std::ptrdiff_t>(k));
        // A missing warm-up stroke is not tested, because the other strokes may take long enough without it.
        const bool is_stroke =
            k > i && k < end && (lines[k].find(" X") != std::string::npos || lines[k].find(" Y") != std::string::npos);
        if (!is_stroke) {
          EXPECT_NE(kinds_in(c, machine, spoilt), "") << c.name << " without line " << k + 1 << ": " << lines[k];
        }
        spoilt = lines;
        spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(k), lines[k]);
        if (k < end) {
          EXPECT_EQ(kinds_in(c, machine, spoilt), "") << c.name << " with line " << k + 1 << " twice: " << lines[k];
        }
        ++tried;
      }
      if (tried > 30) break;
    }
    EXPECT_GE(tried, 10) << c.name;
  }
}

/// The verifier must find a stop at any other position of the main program.
TEST_P(Stops, AStopElsewhereIsFound) {
  Case c = two_step();
  const Machine machine = machine_of(c);
  c.job.process.stop_before_finishing = true;
  const Plan plan = make_plan(c.job, machine);
  const Lines lines = lines_of_text(nc_text(plan.programs.front(), word()));
  const auto at = std::find(lines.begin(), lines.end(), stop_line()) - lines.begin();
  int tried = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_element = lines[i].find("element ") != std::string::npos && is_comment(lines[i]);
    if (!is_element || std::abs(static_cast<std::ptrdiff_t>(i) - at) < 3) continue;
    Lines spoilt = lines;
    spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(i), stop_line());
    EXPECT_NE(kinds_in(c, machine, spoilt), "") << "before line " << i + 1 << ": " << lines[i];
    ++tried;
  }
  EXPECT_GE(tried, 15);
}

/// Returns the line of the n-th call that cuts an element, counted from 1.
std::int32_t line_of_visit(const Lines& lines, std::int64_t n) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t at = lines[i].find("element ");
    const bool marks = at != std::string::npos && lines[i].find("Goes on") == std::string::npos &&
                       lines[i].find("from element") == std::string::npos && at < 4;
    if (!marks || --n > 0) continue;
    // Skip the rapid moves and the line that switches the mist on. They precede the call.
    for (++i; i < lines.size(); ++i) {
      const std::string& line = lines[i];
      if (line.ends_with("call") || line.starts_with("REPEAT") || line.starts_with("M98") || line.starts_with("call") ||
          line.starts_with("CALL") || line.starts_with("RT"))
        return static_cast<std::int32_t>(i + 1);
    }
  }
  return 0;
}

/// A program that restarts after any pass of an element repeats no cut.
TEST_P(Stops, RestartsFromAnyVisit) {
  for (Case c : cases()) {
    const Machine machine = machine_of(c, 5.0);
    c.job.process.min_chip_um = 2.0;
    c.job.tool.edge_life_mm = 2.5 * longest_visit_mm(c, machine);
    const Plan whole = make_plan(c.job, machine);
    const std::string text = nc_text(whole.programs.front(), word());
    const Lines lines = lines_of_text(text);
    std::int64_t behind = 0;
    for (std::size_t k = 0; k < whole.stages.size(); ++k) {
      PlanOptions options;
      options.phase = whole.stages[k].name + "+";
      std::vector<CycleCall> order;
      const Plan partial = make_plan(c.job, machine, options);
      for (const Item& item : partial.programs.front().items)
        if (const auto* const visit = std::get_if<CycleCall>(&item)) order.push_back(*visit);
      const std::int64_t passes = whole.stages[k].visits * whole.passes;
      for (std::int64_t n = 0; n < passes; ++n, ++behind) {
        if (behind == 0 || (c.name == "dmc" && n > 1)) continue;
        options.from_element = order[static_cast<std::size_t>(n)].element;
        options.from_pass = order[static_cast<std::size_t>(n)].pass;
        const NcProgram done = program(text, line_of_visit(lines, behind));
        const NcProgram next = program(nc_text(make_plan(c.job, machine, options).programs.front(), word()));
        const Verification v = verify_programs(c.job, machine, {done, next}, {}, {});
        EXPECT_EQ(v.verdict(), "pass") << c.name << " " << options.phase << " " << *options.from_element << "\n"
                                       << listed(v);
        if (n != 1) continue;
        // Restart one visit too early, with a tool that was touched off 0.3 um too low. The repeated visit then cuts a
        // chip that is too thin.
        options.from_element = order[0].element;
        options.from_pass = order[0].pass;
        Machine lower = machine;
        lower.mount.offset_mm.value +=
            c.name == "dmc" ? geometry::Vec3(-3e-4, 0.0, 0.0) : geometry::Vec3(0.0, 0.0, 3e-4);
        const NcProgram again = program(nc_text(make_plan(c.job, lower, options).programs.front(), word()));
        const std::string kinds = kinds_of(verify_programs(c.job, machine, {done, again}, {}, {}));
        EXPECT_NE(kinds.find("rubs"), std::string::npos) << c.name << " " << options.phase << ": " << kinds;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dialects, Stops,
                         ::testing::Values(NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                                           NcDialect::a3200, NcDialect::automation1),
                         [](const auto& dialect) {
                           return std::string(kNcDialectWords[static_cast<std::size_t>(dialect.param)]);
                         });

Machine shipped(const std::string& name) {
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml";
  return parse_machine(read_file(file), file);
}

Verification verified(const Job& job, const Machine& machine, const Plan& plan) {
  std::vector<NcProgram> programs;
  for (const Program& p : plan.programs)
    programs.push_back(parse_nc(nc_text(p, "rs274ngc"), "p", NcDialect::rs274ngc, {}));
  return verify_programs(job, machine, programs, {}, {});
}

/// Expected length of cut on an ideal machine: each plunge cuts from the face of the blank to the floor. Each plough
/// cuts along the floor until it leaves the blank.
TEST(LengthOfCut, IsThatOfTheClosedForm) {
  Job job = square_job(2, Arrangement::aligned);
  job.strategy = Strategy::unidirectional;
  job.tool.edge_life_mm = 1e6;
  const double facet_mm = 0.451 / std::sqrt(2.0);
  double visit_mm = 0.0;
  for (double deep_mm = facet_mm; deep_mm > 0.0; deep_mm -= 1e-3 * job.process.roughing_depth_um)
    visit_mm += deep_mm + std::min(deep_mm, job.process.plough_length_mm);
  EXPECT_NEAR(make_plan(job, shipped("ideal")).program_cuts_mm.front(), 4.0 * visit_mm, 1e-4);
}

/// The first cut of a facet takes the remainder of the depth. If this remainder is thinner than the minimum chip
/// thickness, the first two cuts remove equal thicknesses. No cut of a correct program is therefore too thin.
RC_GTEST_PROP(LeastChip, NoCutOfARightProgramRubs, ()) {
  Job job = square_job(1);
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.process.roughing_depth_um = 1e-2 * *rc::gen::inRange(1500, 6000);
  job.process.finishing_depth_um = *rc::gen::inRange(3, 8);
  const Machine machine = shipped(*rc::gen::element(std::string("ideal"), std::string("paper"), std::string("thesis")));
  const Plan without = make_plan(job, machine);
  job.process.min_chip_um = 0.5 * job.process.finishing_depth_um;
  const Plan plan = make_plan(job, machine);
  const Verification v = verified(job, machine, plan);
  if (!v.passes()) RC_FAIL(listed(v));
  // If both programs are equal, no first cut was too thin.
  const bool is_same = nc_text(without.programs.front(), "rs274ngc") == nc_text(plan.programs.front(), "rs274ngc");
  RC_CLASSIFY(is_same);
  // On an ideal machine, the plan allows for two increments of 1 nm, and the verifier allows for 2 nm of rounding. On
  // machines with a tilted edge, the plan also allows for the different depths at both ends of the edge.
  if (machine.name != "ideal" || is_same) return;
  constexpr double kAllowedUm = 4e-3;
  job.process.min_chip_um = *job.process.min_chip_um + kAllowedUm;
  RC_ASSERT(!verified(job, machine, without).passes());
}

/// No cut of a correct program is too thin, even for other wedge angles, rounded edges and larger increments. In these
/// cases, the edge extends below its reference point.
RC_GTEST_PROP(LeastChip, OfAnyPrisms, ()) {
  Job job = square_job(1);
  geometry::RtpElement& prism = prism_of(job);
  prism.apex_angle_deg = *rc::gen::element(90.0, 60.0, 75.0, 120.0);
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.tool.clearance_deg = *rc::gen::inRange(2, 11);
  job.tool.wedge_deg = wedge_deg(job, *rc::gen::inRange(0, 25));
  job.tool.edge_radius_um = *rc::gen::element(0.0, 0.5, 3.0);
  job.process.roughing_depth_um = 1e-2 * *rc::gen::inRange(1500, 6000);
  job.process.finishing_depth_um = *rc::gen::inRange(3, 8);
  Machine machine = shipped(*rc::gen::element(std::string("ideal"), std::string("paper"), std::string("thesis")));
  machine.increments.linear_nm = *rc::gen::element(1, 10);
  job.process.min_chip_um = 0.5 * job.process.finishing_depth_um;
  const Verification v = verified(job, machine, make_plan(job, machine));
  if (!v.passes())
    RC_FAIL(fmt::format("apex {} clearance {} wedge {} radius {} strategy {} d {} f {} machine {} step {}\n{}",
                        prism.apex_angle_deg, job.tool.clearance_deg, job.tool.wedge_deg, job.tool.edge_radius_um,
                        static_cast<int>(job.strategy), job.process.roughing_depth_um, job.process.finishing_depth_um,
                        machine.name, machine.increments.linear_nm, listed(v)));
}

TEST(LeastChip, OfCubeCorners) {
  for (const double depth_um : {15.0, 15.3, 15.6, 15.9, 16.2, 17.0, 18.0, 19.0, 20.0, 21.0}) {
    Job job = cube_job(true, 0.15);
    job.process.roughing_depth_um = depth_um;
    job.process.min_chip_um = 0.5 * job.process.finishing_depth_um;
    const Machine machine = shipped("ideal-dmc");
    const Verification v = verified(job, machine, make_plan(job, machine));
    EXPECT_TRUE(v.passes()) << depth_um << "\n" << listed(v);
  }
}

/// On a substrate, the first cut of a facet may be arbitrarily thin, and the verifier must accept it.
TEST(LeastChip, OnABase) {
  struct OnBase {
    std::string name;
    Job job;
    std::string machine;
  };
  const OnBase all[] = {{"incline", prisms_on(plane_substrate(10.0, 90.0, ElementAxes::parallel)), "paper"},
                        {"bulge", prisms_on(cylinder_substrate(20.0, false, ElementAxes::normal)), "ideal"},
                        {"hollow", prisms_on(sphere_substrate(-30.0, ElementAxes::parallel)), "paper"},
                        {"cubes", cubes_on(sphere_substrate(-20.0, ElementAxes::normal), true), "ideal-dmc"}};
  for (const OnBase& c : all) {
    Job job = c.job;
    job.process.min_chip_um = 0.5 * job.process.finishing_depth_um;
    job.tool.edge_life_mm = c.name == "cubes" ? 2.0 : 20.0;
    const Machine machine = shipped(c.machine);
    const Plan plan = make_plan(job, machine);
    const Verification v = verified(job, machine, plan);
    EXPECT_TRUE(v.passes()) << c.name << "\n" << listed(v);
    ASSERT_FALSE(plan.stops.empty()) << c.name;
    double most_mm = 0.0;
    for (const PlannedStop& stop : plan.stops) most_mm = std::max(most_mm, stop.wear.cut_mm);
    job.tool.edge_life_mm = most_mm * (1.0 - 2e-4);
    EXPECT_FALSE(verified(job, machine, plan).passes()) << c.name;
  }
}

TEST(StopsRefused, WhatCannotBe) {
  const Machine machine = shipped("ideal");
  Job job = square_job(2);
  job.source = "j.toml";
  const auto refusal = [&] { return refusal_of([&] { make_plan(job, machine); }, "not refused"); };
  job.tool.edge_life_mm = 3.0;
  EXPECT_EQ(refusal(), "j.toml: tool.edge_life_mm");
  job.tool.edge_life_mm.reset();
  job.process.stop_every_min = 0.1;
  EXPECT_EQ(refusal(), "j.toml: process.stop_every_min");
  EXPECT_EQ(refusal(), "j.toml: process.stop_every_min");
  job.process.stop_every_min.reset();
  job.strategy = Strategy::unidirectional;
  job.process.min_chip_um = 7.0;
  EXPECT_EQ(refusal(), "j.toml: process.min_chip_um");
}

TEST(StopsRefused, ControlsWithoutALineForStops) {
  Job job = square_job(2);
  job.process.stop_before_finishing = true;
  Machine machine = for_dialect(shipped("ideal"), "pmac");
  machine.control.stop.clear();
  const Program program = make_plan(job, machine).programs.front();
  for (const char* dialect : {"pmac", "a3200", "automation1"})
    EXPECT_EQ(refusal_of([&] { nc_text(program, dialect); }), "dialect");
}

}  // namespace
}  // namespace retrace::fabrication::test::stops_test
