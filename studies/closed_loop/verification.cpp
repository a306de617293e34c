#include "studies/closed_loop/verification.h"

#include <algorithm>

#include "fabrication/check/io/program_files.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

using namespace fabrication;

/// Returns the programs of the job for all stages before the given one. A stage is one step of machining with its own
/// program, such as roughing.
std::vector<NcProgram> programs_before(const std::string& stage, const Job& job, const Machine& machine) {
  constexpr std::string_view dialect = "rs274ngc";
  PlanOptions options;
  options.before = stage;
  std::vector<NcProgram> programs;
  for (const Program& program : make_plan(job, machine, options).programs)
    programs.push_back(parse_nc(nc_text(program, dialect), "before " + stage, NcDialect::rs274ngc));
  return programs;
}

}  // namespace

VerificationRun run_verification(const VerificationRequest& request, const Cancellation* cancellation) {
  requests::check(request);
  VerificationRun run;
  run.request = request;
  run.job = read_job(request.job, request.texts);
  run.machine = load_machine(run.job.machine, run.job.where("machine"));
  run.warnings = run.job.warnings;
  append(run.warnings, run.machine.warnings);
  if (!request.next_stage.empty()) run.programs = programs_before(request.next_stage, run.job, run.machine);
  run.unchecked_programs = run.programs.size();
  for (NcProgram& program :
       read_programs(request.programs, request.dialect, texts_of(run.machine.control), request.texts))
    run.programs.push_back(std::move(program));
  VerifyOptions options;
  options.tolerance_nm = request.tolerance_nm;
  options.unchecked_programs = run.unchecked_programs;
  run.result = verify_programs(run.job, run.machine, run.programs, options, shipped_machines(), cancellation);
  return run;
}

ErrorMap error_map(const VerificationRun& run) {
  constexpr std::size_t kPixels = 900;
  constexpr double kTolerances = 5.0;
  constexpr double kMargin = 1.2;
  ErrorMap map;
  map.field = fabrication::error_field(run.job, run.machine, run.programs, kPixels);
  // The colour scale covers all unavoidable deviations. Larger faults are clamped: the picture shows where they are,
  // but not how large they are.
  map.colour_range_nm =
      std::max(kTolerances * run.result.tolerance_nm, kMargin * run.result.root_residual_nm_predicted);
  return map;
}

}  // namespace retrace::studies
