#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"

// Tests of elements that are wider than the tool and are cut in several passes. The verifier must find any pass that is
// missing or too high.

namespace retrace::fabrication::test::passes_test {
namespace {

constexpr double kToolMm = 0.2;

Job wide_prism(Strategy strategy, double width_in_tools) {
  Job job = square_job(1, geometry::Arrangement::single);
  job.strategy = strategy;
  prism_of(job).base_mm = 0.1;
  prism_of(job).width_mm = width_in_tools * kToolMm;
  job.tool.width_mm = kToolMm;
  job.process.roughing_depth_um = 40;
  return job;
}

Machine machine_of(const std::string& name) {
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml";
  return parse_machine(read_file(file), file);
}

Verification verified(const Job& job, const Machine& machine, const Program& program) {
  return verify_programs(job, machine,
                         {parse_nc(nc_text(program, "rs274ngc"), "p", NcDialect::rs274ngc, control_texts())}, {}, {});
}

/// Returns the indices of the program items that are visits: calls of a cutting subroutine at an element.
std::vector<std::size_t> visits_of(const Program& program) {
  std::vector<std::size_t> visits;
  for (std::size_t i = 0; i < program.items.size(); ++i)
    if (std::holds_alternative<CycleCall>(program.items[i])) visits.push_back(i);
  return visits;
}

const CycleCall& visit_at(const Program& program, std::size_t item) {
  return std::get<CycleCall>(program.items[item]);
}

RC_GTEST_PROP(Passes, AMissingPassAndAPassThatIsTooHighAreFound, ()) {
  const auto strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  const double width_in_tools = 0.001 * *rc::gen::inRange(1050, 4400);
  const Job job = wide_prism(strategy, width_in_tools);
  const Machine machine = machine_of(*rc::gen::element<std::string>("ideal", "paper"));
  const Program right = make_plan(job, machine).programs.front();
  const Verification v = verified(job, machine, right);
  RC_LOG() << width_in_tools << " tools wide\n" << listed(v);
  RC_ASSERT(v.passes());
  const std::vector<std::size_t> visits = visits_of(right);
  RC_ASSERT(visit_at(right, visits.front()).passes == static_cast<int>(std::ceil(width_in_tools)));
  const auto passes = static_cast<std::size_t>(visit_at(right, visits.front()).passes);
  for (std::size_t k = 0; k < visits.size(); ++k) {
    Program wrong = right;
    wrong.items.erase(wrong.items.begin() + static_cast<std::ptrdiff_t>(visits[k]));
    RC_LOG() << "without visit " << k << "\n";
    RC_ASSERT(!verified(job, machine, wrong).passes());
  }
  // Raise each visit of the last cycle, which forms the final surface.
  for (std::size_t k = visits.size() - passes; k < visits.size(); ++k) {
    Program wrong = right;
    std::get<CycleCall>(wrong.items[visits[k]]).start.z() += 1000;
    RC_LOG() << "with visit " << k << " raised by 1 um\n";
    RC_ASSERT(!verified(job, machine, wrong).passes());
  }
}

/// If flanks of 45 degrees are moved along Z by d, the distance along their normals is d / sqrt(2). The verifier
/// reports this distance if it is greater than the tolerance.
TEST(Passes, AnElementThatIsTooDeepOrTooHighIsFoundBeyondTheTolerance) {
  const Job job = wide_prism(Strategy::unidirectional, 1.0);
  const Machine machine = machine_of("ideal");
  const Program right = make_plan(job, machine).programs.front();
  const double tolerance_nm = verified(job, machine, right).tolerance_nm;
  ASSERT_GE(tolerance_nm, 4.0) << "positions have steps of 1 nm";
  for (const double tolerances : {-1.5, -0.5, 0.5, 1.5}) {
    Program moved = right;
    for (const std::size_t visit : visits_of(right))
      std::get<CycleCall>(moved.items[visit]).start.z() += std::llround(tolerances * tolerance_nm * std::sqrt(2.0));
    const Verification v = verified(job, machine, moved);
    const std::string kind = tolerances < 0.0 ? "gouge" : "excess";
    const bool is_found = std::ranges::any_of(v.findings, [&](const Finding& f) { return f.kind == kind; });
    EXPECT_EQ(is_found, std::abs(tolerances) > 1.0) << tolerances << "\n" << listed(v);
    EXPECT_EQ(v.passes(), std::abs(tolerances) < 1.0) << tolerances << "\n" << listed(v);
  }
}

/// A prism with base b and flanks of 45 degrees has a cross section of b * b / 4. The passes lie side by side without
/// overlap, so that a missing pass leaves the volume of its own width.
TEST(Passes, TheVolumeOfAMissingPassIsThatOfItsPrism) {
  const Job job = wide_prism(Strategy::unidirectional, 3.0);
  const Machine machine = machine_of("ideal");
  const Program right = make_plan(job, machine).programs.front();
  const double whole_mm3 = verified(job, machine, right).removed_volume_mm3;
  const double section_mm2 = 0.25 * std::pow(prism_of(job).base_mm, 2);
  EXPECT_NEAR(whole_mm3, section_mm2 * prism_of(job).width_mm, 2e-3 * whole_mm3);
  for (int pass = 1; pass <= 3; ++pass) {
    Program wrong = right;
    std::erase_if(wrong.items, [&](const Item& item) {
      const auto* const visit = std::get_if<CycleCall>(&item);
      return visit != nullptr && visit->pass == pass;
    });
    const double removed_mm3 = verified(job, machine, wrong).removed_volume_mm3;
    EXPECT_NEAR(whole_mm3 - removed_mm3, section_mm2 * kToolMm, 5e-3 * whole_mm3) << "without pass " << pass;
  }
}

}  // namespace
}  // namespace retrace::fabrication::test::passes_test
