#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/plan/plan.h"
#include "fabrication/post/post.h"
#include "fabrication/verify/verify.h"
#include "tests/fabrication/jobs.h"

// What planner and writers make is cut again from its text, by a verifier that knows nothing of either.

namespace retrace::fabrication::test {
namespace {

using geometry::Arrangement;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

std::vector<std::string> texts_of(const Job& job, const std::string& machine_name) {
  std::vector<std::string> texts;
  for (const Program& program : make_plan(job, machine(machine_name)).programs)
    texts.push_back(nc_text(program, "rs274ngc"));
  return texts;
}

Verification verify_texts(const Job& job, const std::string& machine_name, const std::vector<std::string>& texts) {
  std::vector<NcProgram> programs;
  for (const std::string& text : texts) programs.push_back(parse_nc(text, "p.ngc", NcDialect::rs274ngc));
  return verify_programs(job, machine(machine_name), programs, {},
                         {machine("ideal"), machine("paper"), machine("thesis")});
}

std::string listed(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings)
    text += fmt::format("{}:{} {} [{}] {} ({} > {}) x{}\n", f.program, f.line, f.kind, f.element, f.message, f.value,
                        f.limit, f.count);
  return text.substr(0, 3000);
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
        fmt::print(
            "{}: distance {:.3f} nm, angle {:.5f}', apex {:.5f}', root {:.2f} / {:.2f} nm, wall {:.2f} / {:.2f} nm, "
            "volume "
            "{:.9f}, time {:.2f} s, free {:.2f} mm\n",
            what, v.facet_distance_nm_max, v.facet_angle_arcmin_max, v.apex_error_arcmin_max, v.root_residual_nm_max,
            v.root_residual_nm_predicted, v.wall_overcut_nm_max, v.wall_overcut_nm_predicted, v.removed_volume_mm3,
            v.time.total_s(), v.free_tool_length_mm);
      }
}

}  // namespace
}  // namespace retrace::fabrication::test
