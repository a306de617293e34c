#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "report/results/result_plots.h"
#include "studies/forces/forces_study.h"
#include "studies/forces/io/forces_files.h"

namespace retrace::app {
namespace {

struct ForcesOptions {
  studies::ForcesRequest request;
  std::uint32_t facet = 1;
  std::optional<double> plunge_mm;
};

std::vector<Argument> arguments(ForcesOptions& options) {
  return {job_argument(options.request.job),
          {"--configuration WORD", "isolated: between walls with friction, or orthogonal: forces at the edge only",
           &options.request.configuration, one_of(words_of(fabrication::kConfigurationWords))},
          {"--facet N", "of a bidirectional job: 1 or 2", &options.facet, integer(1, 2)},
          {"--plunge-mm L", "length of the plunge [that of the last cut]", &options.plunge_mm}};
}

ExitCode run(const ForcesOptions& options, const CommonOptions& common) {
  studies::ForcesRequest request = options.request;
  request.facet = static_cast<int>(options.facet);
  if (options.plunge_mm) {
    if (!(*options.plunge_mm > 0.0)) throw InputError({"", 0, "--plunge-mm"}, "must be > 0");
    request.plunge_mm = *options.plunge_mm;
  }
  const studies::ForcesResult result = studies::cutting_forces(request);
  ResultFiles files(common, {request.job}, "forces.json");
  files.add("forces.csv", [&] { return studies::forces_csv(result); });
  files.add_drawing("forces", [&] { return report::forces_plot(result); });
  files.prepare();
  return files.write(studies::forces_json(result), studies::forces_table(result), result.warnings);
}

}  // namespace

Command forces_command() {
  return {.name = "forces",
          .summary = "cutting forces of a fabrication job over one cycle",
          .manual =
              "Computes the forces on the tool over one cycle of roughing, with a model that is calibrated by "
              "published measurements.",
          .reads = {"retrace.job/1"},
          .writes = {"retrace.forces/1"},
          .refuses_set = "not allowed with forces, which reads no design",
          .begin = begins<ForcesOptions>(arguments, run)};
}

}  // namespace retrace::app
