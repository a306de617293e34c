#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/plan/plan.h"
#include "fabrication/post/post.h"
#include "fabrication/verify/verify.h"
#include "tests/fabrication/jobs.h"

// What the less usual keys of a job ask for is cut as designed: programs are read back and cut virtually, on the
// machines with measured axes.

namespace retrace::fabrication::test {
namespace {

using geometry::Arrangement;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

/// What programs planned for one job leave, judged by another.
Verification verified(const Job& planned, const Job& job, const Machine& m) {
  std::vector<NcProgram> programs;
  for (const Program& program : make_plan(planned, m).programs)
    programs.push_back(parse_nc(nc_text(program, "rs274ngc"), "p.ngc", NcDialect::rs274ngc));
  return verify_programs(job, m, programs, {}, {});
}

std::string listed(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings)
    text +=
        fmt::format("{}:{} {} [{}] {} ({} > {})\n", f.program, f.line, f.kind, f.element, f.message, f.value, f.limit);
  return text.substr(0, 2000);
}

struct Variant {
  std::string what;
  std::function<void(Job&)> change;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"narrow tool", [](Job& job) { job.tool.width_mm = 0.2; }},
      {"gaps", [](Job& job) { job.array.x_gap_mm = job.array.y_gap_mm = 0.03; }},
      {"opened apex", [](Job& job) { job.element.apex_angle_deg = 90.05; }},
      {"closed apex", [](Job& job) { job.element.apex_angle_deg = 89.95; }},
      {"narrow apex", [](Job& job) { job.element.apex_angle_deg = 80.0; }},
      {"wide apex", [](Job& job) { job.element.apex_angle_deg = 95.0; }},
      {"blunt edge", [](Job& job) { job.tool.edge_radius_um = 0.5; }},
      {"blunt edge, opened apex",
       [](Job& job) {
         job.tool.edge_radius_um = 0.5;
         job.element.apex_angle_deg = 90.05;
       }},
      {"direct", [](Job& job) { job.workpiece.kind = WorkpieceKind::direct; }},
      {"shrinkage",
       [](Job& job) {
         job.workpiece.shrinkage_percent = 0.6;
         job.tool.width_mm = blank_element(job).width_mm;
       }},
      {"pattern",
       [](Job& job) {
         job.array.pattern = {"-##", "#-#", "###"};
       }},
      {"odd rows", [](Job& job) { job.array.shifted_rows = geometry::RowParity::odd; }},
      {"short plough with lift",
       [](Job& job) {
         job.process.plough_lift_um = 2.0;
         job.process.slow_retract_um = 5.0;
       }},
      {"shortest plough", [](Job& job) { job.process.shortest_plough = true; }},
      {"other clearance", [](Job& job) { job.tool.clearance_deg = 10.0; }},
      {"one finishing cut", [](Job& job) { job.process.finishing_cuts = 1; }}};
  return all;
}

TEST(PlannedJobs, EveryKeyIsCutAsDesigned) {
  for (const char* name : {"ideal", "paper"}) {
    const Machine m = machine(name);
    for (const Variant& variant : variants())
      for (const auto strategy : {Strategy::unidirectional, Strategy::two_step}) {
        Job job = square_job(3, Arrangement::offset);
        job.strategy = strategy;
        job.process.roughing_depth_um = 40.0;
        variant.change(job);
        const Verification v = verified(job, job, m);
        const std::string what = fmt::format("{}, {}, strategy {}", variant.what, name, static_cast<int>(strategy));
        EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
        EXPECT_EQ(v.elements_cut, static_cast<std::int64_t>(cut_elements(job).size())) << what;
        // Side-by-side ploughs make steps, whose mean leans less than one plough does.
        if (strategy == Strategy::two_step) {
          EXPECT_LT(v.facet_angle_arcmin_max, 0.01) << what;
        }
      }
  }
}

TEST(PlannedJobs, AnotherApexIsFound) {
  for (const double apex_deg : {89.95, 90.05, 80.0}) {
    Job planned = square_job(2, Arrangement::aligned);
    planned.process.roughing_depth_um = 40.0;
    Job job = planned;
    planned.element.apex_angle_deg = apex_deg + 0.02;
    job.element.apex_angle_deg = apex_deg;
    EXPECT_FALSE(verified(planned, job, machine("ideal")).passes()) << apex_deg;
  }
}

}  // namespace
}  // namespace retrace::fabrication::test
