#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "core/data_directory.h"
#include "core/number_format.h"
#include "design/io/design_reader.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "studies/roughness/io/roughness_files.h"

namespace retrace::app {
namespace {

struct RoughnessOptions {
  std::string design;
  std::vector<std::string> facets;  ///< files with measured facets; if empty, the files shipped with retrace are used
  FieldTexts fields;
};

std::vector<Argument> arguments(RoughnessOptions& options) {
  std::vector<Argument> all = {
      design_argument(options.design),
      {"--facets FILE", "table of measured facets, repeatable [the shipped ones]", &options.facets, files(".csv")}};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<RoughnessRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

/// Returns the tables of measured facets from the command line, or the shipped tables if none are given.
std::vector<std::filesystem::path> tables_of(const RoughnessOptions& options) {
  if (options.facets.empty())
    return {data_directory() / "facet_quality_2017.csv", data_directory() / "rtp_facets_2017.csv"};
  return {options.facets.begin(), options.facets.end()};
}

std::vector<studies::FacetGroup> facets_in(const std::vector<std::filesystem::path>& tables) {
  std::vector<studies::FacetGroup> measured;
  for (const std::filesystem::path& table : tables)
    for (studies::FacetGroup& group : studies::read_facet_table(table)) measured.push_back(std::move(group));
  return measured;
}

/// Computes all points and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode trace(const RoughnessOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  const design::Design design = design::read_design(options.design, common.overrides);
  const std::vector<std::filesystem::path> tables = tables_of(options);
  std::vector<std::string> inputs = files_read({design});
  for (const std::filesystem::path& table : tables) inputs.push_back(table.string());
  const auto request = request_of<RoughnessRequest>(options.fields, common);
  const studies::RoughnessStudy study(design, request, facets_in(tables));
  const OrderlyInterrupt interrupt;
  studies::RoughnessResult result;
  ResultFiles files(common, inputs, "roughness.json");
  files.add("roughness.csv", [&] { return studies::roughness_csv(result); });
  files.add_drawing("roughness", [&] { return report::roughness_plot(result); });
  files.prepare();
  const Words to_shorten = {request.samples
                                ? fmt::format("give a smaller --samples (now {})", *request.samples)
                                : fmt::format("give a larger --target-error (now {})", shortest(request.target_error)),
                            "give fewer values (--sa)"};
  interrupt.run(common, {"tracing", to_shorten}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(bar, cancel, distribute_among(session, slots(common), cancel));
  });
  for (const Warning& remark : remarks_of(session)) result.warnings.push_back(remark);
  return files.write(
      studies::roughness_json(result), without_middle(studies::roughness_table(result), common, "roughness.csv"),
      result.warnings,
      {.complete = result.complete, .interrupted = fmt::format("finished points: {}", result.points.size())});
}

ExitCode run(const RoughnessOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, slots(common), [&](compute::MpiSession* session) { return trace(options, common, session); },
      [&]() -> ComputeTask {
        const auto study = std::make_shared<const studies::RoughnessStudy>(
            design::read_design(options.design, common.overrides), request_of<RoughnessRequest>(options.fields, common),
            facets_in(tables_of(options)));
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
              "facets beside them. A LIST contains numbers a,b,c and ranges start:stop:step.",
          .reads = {"retrace.design/1", "measured facets (CSV)"},
          .writes = {"retrace.roughness/1"},
          .begin = begins<RoughnessOptions>(arguments, run)};
}

}  // namespace retrace::app
