#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/shared_arguments.h"
#include "core/data_directory.h"
#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "requests/number_list.h"
#include "studies/design/io/design_reader.h"
#include "studies/design/request_limits.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "studies/roughness/io/roughness_files.h"

namespace retrace::app {
namespace {

struct RoughnessOptions {
  std::string design;
  std::string sa = "0,2,5,10,15,20,30,40,50,75,100,150,200";
  std::string correlation_length_um = "5,20,50";
  std::vector<std::string> facets;    ///< tables of measured facets; if empty, the shipped tables are used
  studies::RoughnessRequest request;  ///< all other options
};

std::vector<Argument> arguments(RoughnessOptions& options) {
  return {design_argument(options.design),
          {"--sa LIST", "Sa of the curves in nm: a,b,c and start:stop:step", &options.sa},
          {"--correlation-length-um LIST", "correlation lengths, one curve each; the first is for measured facets",
           &options.correlation_length_um},
          {"--waviness-length-um L", "period of the waviness of measured facets", &options.request.waviness_length_um},
          {"--facets FILE", "table of measured facets, repeatable [the shipped ones]", &options.facets, files(".csv")},
          {"--incidence T", "angle of incidence in degrees", &options.request.incidence_deg},
          {"--azimuth P", "azimuth of the source in degrees", &options.request.azimuth_deg},
          {"--samples N", "rays for each point [until the target error is reached]", &options.request.rays, whole(1)},
          {"--target-error E", "standard error of RRE to reach, as a fraction", &options.request.target_error,
           not_with("--samples")}};
}

/// Returns the tables of measured facets from the command line, or the shipped tables if none are given.
std::vector<std::filesystem::path> tables_of(const RoughnessOptions& options) {
  if (options.facets.empty())
    return {data_directory() / "facet_quality_2017.csv", data_directory() / "rtp_facets_2017.csv"};
  return {options.facets.begin(), options.facets.end()};
}

studies::RoughnessRequest request_of(const RoughnessOptions& options, const CommonOptions& common,
                                     const std::vector<std::filesystem::path>& tables) {
  studies::RoughnessRequest request = options.request;
  request.sa_nm = requests::read_number_list(options.sa, Field{"sa"});
  request.correlation_length_um =
      requests::read_number_list(options.correlation_length_um, Field{"correlation_length_um"});
  studies::check_azimuth(request.azimuth_deg);
  if (!(request.target_error > 0.0 && request.target_error < 1.0))
    throw InputError({"", 0, "--target-error"}, fmt::format("must lie between 0 and 1, got {}", request.target_error));
  request.seed = common.seed;
  for (const std::filesystem::path& table : tables)
    for (studies::FacetGroup& group : studies::read_facet_table(table)) request.measured.push_back(std::move(group));
  return request;
}

/// Computes all points and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode trace(const RoughnessOptions& options, const CommonOptions& common, studies::MpiSession* session) {
  const studies::Design design = studies::read_design(options.design, common.overrides);
  const std::vector<std::filesystem::path> tables = tables_of(options);
  std::vector<std::string> inputs = files_read({design});
  for (const std::filesystem::path& table : tables) inputs.push_back(table.string());
  const studies::RoughnessStudy study(design, request_of(options, common, tables));
  const OrderlyInterrupt interrupt;
  studies::RoughnessResult result;
  ResultFiles files(common, inputs, "roughness.json");
  files.add("roughness.csv", [&] { return studies::roughness_csv(result); });
  files.add_drawing("roughness", [&] { return report::roughness_plot(result); });
  files.prepare();
  const Words to_shorten = {
      options.request.rays
          ? fmt::format("give a smaller --samples (now {})", *options.request.rays)
          : fmt::format("give a larger --target-error (now {})", shortest(options.request.target_error)),
      "give fewer values (--sa)"};
  interrupt.run(common, {"tracing", to_shorten}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(bar, cancel, share_among(session, slots(common), cancel));
  });
  for (const Warning& remark : remarks_of(session)) result.warnings.push_back(remark);
  return files.write(
      studies::roughness_json(result), studies::roughness_table(result), result.warnings,
      {.complete = result.complete, .interrupted = fmt::format("finished points: {}", result.points.size())});
}

ExitCode run(const RoughnessOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, slots(common), [&](studies::MpiSession* session) { return trace(options, common, session); },
      [&]() -> ComputeTask {
        const auto study = std::make_shared<const studies::RoughnessStudy>(
            studies::read_design(options.design, common.overrides), request_of(options, common, tables_of(options)));
        return
            [study](std::uint64_t point, const Cancellation* cancel) { return study->compute_shared(point, cancel); };
      });
}

}  // namespace

Command roughness_command() {
  return {.name = "roughness",
          .summary = "retroreflective efficiency against the roughness of the facets",
          .manual =
              "RRE against the Sa of the facets' roughness, one curve for each correlation length, with measured "
              "facets beside them.",
          .reads = {"retrace.design/1", "measured facets (CSV)"},
          .writes = {"retrace.roughness/1"},
          .begin = begins<RoughnessOptions>(arguments, run)};
}

}  // namespace retrace::app
