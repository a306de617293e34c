#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests of programs that make only a part of a job: phases, restarts after a line, and split programs. The verifier
// uses the material that earlier programs have left.

namespace retrace::fabrication::test::partial_programs_test {
namespace {

using Case = StrategyCase;

std::vector<Case> cases() {
  return strategy_cases([](Job&) {});
}

class PartialPrograms : public ::testing::TestWithParam<NcDialect> {
 protected:
  std::string word() const { return std::string(kNcDialectWords[static_cast<std::size_t>(GetParam())]); }

  Machine machine_of(const Case& c) const {
    const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + c.machine + ".toml";
    return for_dialect(parse_machine(read_file(file), file), word());
  }
  std::vector<std::string> texts(const Case& c, const PlanOptions& options) const {
    std::vector<std::string> texts;
    for (const Program& program : make_plan(c.job, machine_of(c), options).programs)
      texts.push_back(nc_text(program, word()));
    return texts;
  }
  NcProgram program(const std::string& text, std::int32_t stop_line = 0) const {
    NcProgram program = parse_nc(text, "p", GetParam(), control_texts());
    program.stop_line = stop_line;
    return program;
  }
  Verification verified(const Case& c, const std::vector<NcProgram>& programs, std::size_t standing = 0) const {
    VerifyOptions options;
    options.unchecked_programs = standing;
    return verify_programs(c.job, machine_of(c), programs, options, {});
  }
};

TEST_P(PartialPrograms, EveryPhaseIsRightAfterWhatComesBefore) {
  for (const Case& c : cases()) {
    const Plan whole = make_plan(c.job, machine_of(c));
    for (std::size_t k = 0; k < whole.stages.size(); ++k) {
      PlanOptions options;
      options.phase = whole.stages[k].name;
      // The name of a phase may stand for several stages of the plan.
      const bool is_last = make_plan(c.job, machine_of(c), options).stages.back().name == whole.stages.back().name;
      std::vector<NcProgram> programs = {program(texts(c, options).front())};
      if (k > 0) {
        PlanOptions before;
        before.before = options.phase;
        programs.insert(programs.begin(), program(texts(c, before).front()));
      }
      const Verification v = verified(c, programs, programs.size() - 1);
      EXPECT_EQ(v.verdict(), is_last ? "pass" : "incomplete") << c.name << " " << options.phase << "\n" << listed(v);
      if (k == 0) continue;
      EXPECT_NE(verified(c, {programs.back()}).verdict(), "pass") << c.name << " " << options.phase;
      options.phase += "+";
      const Verification rest = verified(c, {programs.front(), program(texts(c, options).front())}, 1);
      EXPECT_EQ(rest.verdict(), "pass") << c.name << " " << options.phase << "\n" << listed(rest);
    }
  }
}

TEST_P(PartialPrograms, AProgramGoesOnWhereAnotherWasStopped) {
  for (const Case& c : cases()) {
    const Plan whole = make_plan(c.job, machine_of(c));
    const std::string text = texts(c, {}).front();
    for (const std::size_t stage : {std::size_t{0}, whole.stages.size() - 1}) {
      PlanOptions options;
      options.phase = whole.stages[stage].name + "+";
      // Restart at the second element of the stage. The operator stopped the program after the call for the first
      // element.
      const Plan rest = make_plan(c.job, machine_of(c), options);
      std::vector<std::int32_t> visited;
      for (const Item& item : rest.programs.front().items)
        if (const auto* const visit = std::get_if<CycleCall>(&item)) visited.push_back(visit->element);
      options.from_element = visited[1];
      const std::string next = texts(c, options).front();
      // The first program must contain the first item of the restarted program, after the line at which the operator
      // stopped.
      std::size_t passed = 0;
      for (std::size_t k = 0; k < stage; ++k)
        passed += static_cast<std::size_t>(std::count_if(whole.programs.front().items.begin(),
                                                         whole.programs.front().items.end(), [&](const Item& item) {
                                                           const auto* const visit = std::get_if<CycleCall>(&item);
                                                           return visit != nullptr && visit->element == visited[0] &&
                                                                  visit->subroutine == whole.stages[k].subroutine;
                                                         }));
      // In some dialects, comments end with a bracket.
      const auto find_mark = [&](std::size_t from) {
        const std::string name = fmt::format("element {}", visited[0]);
        std::size_t found = text.find(name, from);
        while (text[found + name.size()] != '\n' && text[found + name.size()] != ')')
          found = text.find(name, found + 1);
        return found;
      };
      std::size_t at = find_mark(0);
      for (std::size_t k = 0; k < passed; ++k) at = find_mark(at + 1);
      at = text.find(fmt::format("{}", whole.subroutines[whole.stages[stage].subroutine].number), at);
      const auto line =
          static_cast<std::int32_t>(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
      const Verification v = verified(c, {program(text, line), program(next)});
      EXPECT_EQ(v.verdict(), "pass") << c.name << " " << options.phase << " stopped at " << line << "\n" << listed(v);
      EXPECT_NE(verified(c, {program(text, line)}).verdict(), "pass") << c.name;
    }
  }
}

/// A program that stops at any line is complete only if it stops after its last call. A line that is never executed is
/// refused.
TEST_P(PartialPrograms, EveryLineStopsTheProgramOrIsRefused) {
  const Case c = cases()[2];
  const std::string text = texts(c, {}).front();
  const std::string_view call = GetParam() == NcDialect::rs274ngc    ? " call\n"
                                : GetParam() == NcDialect::sinumerik ? "\nREPEAT RT"
                                : GetParam() == NcDialect::fanuc     ? "\nM98 P"
                                : GetParam() == NcDialect::pmac      ? "\ncall "
                                : GetParam() == NcDialect::a3200     ? "\nCALL RT"
                                                                     : "\nRT";
  const std::string_view end = GetParam() == NcDialect::rs274ngc      ? "\nM2\n"
                               : GetParam() == NcDialect::pmac        ? "\nclose\n"
                               : GetParam() == NcDialect::a3200       ? "\nEND PROGRAM\n"
                               : GetParam() == NcDialect::automation1 ? "\nend\n"
                                                                      : "\nM30\n";
  const auto line_of = [&](std::size_t at) {
    return static_cast<std::int32_t>(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  };
  const std::int32_t last_call = line_of(text.rfind(call) + (call.front() == '\n' ? 1 : 0));
  const std::int32_t last = line_of((GetParam() == NcDialect::automation1 ? text.find(end) : text.rfind(end)) + 1);
  int refused = 0;
  for (std::int32_t line = 1; line < line_of(text.size()); ++line) {
    std::string verdict = "refused";
    try {
      verdict = verified(c, {program(text, line)}).verdict();
    } catch (const InputError& error) {
      EXPECT_EQ(recorded_place_of(error), fmt::format("p:{}", line));
      ++refused;
    }
    // After the last call, nothing remains to be cut.
    EXPECT_TRUE((verdict == "pass") == (line >= last_call && line <= last) || verdict == "refused")
        << line << ": " << verdict;
  }
  EXPECT_GE(refused, 10);
}

INSTANTIATE_TEST_SUITE_P(Dialects, PartialPrograms,
                         ::testing::Values(NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                                           NcDialect::a3200, NcDialect::automation1),
                         [](const auto& dialect) {
                           return std::string(kNcDialectWords[static_cast<std::size_t>(dialect.param)]);
                         });

}  // namespace
}  // namespace retrace::fabrication::test::partial_programs_test
