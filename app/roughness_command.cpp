#include <fmt/format.h>

#include <cmath>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "core/data_directory.h"
#include "report/roughness_plot.h"
#include "studies/design/design_reader.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "studies/roughness/io/roughness_files.h"

namespace retrace::app {
namespace {

/// Those of the command line, else the shipped ones.
std::vector<std::filesystem::path> tables_of(const RoughnessOptions& options) {
  if (options.facets.empty())
    return {data_directory() / "facet_quality_2017.csv", data_directory() / "rtp_facets_2017.csv"};
  return {options.facets.begin(), options.facets.end()};
}

studies::RoughnessRequest request_of(const CommandLine& line, const std::vector<std::filesystem::path>& tables) {
  const RoughnessOptions& options = line.roughness;
  studies::RoughnessRequest request;
  request.sa_nm = read_number_list(options.sa, "--sa");
  request.correlation_length_um = read_number_list(options.correlation_length_um, "--correlation-length-um");
  request.waviness_length_um = options.waviness_length_um;
  request.incidence_deg = options.incidence_deg;
  request.azimuth_deg = options.azimuth_deg;
  if (!std::isfinite(request.azimuth_deg))
    throw InputError({"", 0, "--azimuth"}, fmt::format("must be a finite number, got {}", request.azimuth_deg));
  request.rays = options.samples;
  request.target_error = options.target_error;
  if (!(request.target_error > 0.0 && request.target_error < 1.0))
    throw InputError({"", 0, "--target-error"}, fmt::format("must lie between 0 and 1, got {}", request.target_error));
  request.seed = line.common.seed;
  for (const std::filesystem::path& table : tables)
    for (studies::FacetGroup& group : studies::read_facet_table(table)) request.measured.push_back(std::move(group));
  return request;
}

}  // namespace

ExitCode run_roughness_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.roughness.design, line.common.overrides);
  const std::vector<std::filesystem::path> tables = tables_of(line.roughness);
  std::vector<std::string> inputs = files_read({design});
  for (const std::filesystem::path& table : tables) inputs.push_back(table.string());
  const studies::RoughnessStudy study(design, request_of(line, tables));
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {inputs, "roughness.json", {"roughness.csv", "roughness.svg", "roughness.png"}});
  studies::RoughnessResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  const std::string json = studies::roughness_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) {
    const report::LinePlot plot = report::roughness_plot(result);
    files = {{"roughness.json", json},
             {"roughness.csv", studies::roughness_csv(result)},
             {"roughness.svg", report::render_svg(plot)},
             {"roughness.png", report::render_png(plot)}};
  }
  write_outputs(line.common, json, files, studies::roughness_table(result));
  print_warnings(line.common, result.warnings);
  if (!result.complete) {
    say(fmt::format("retrace: interrupted; finished points: {}", result.points.size()));
    return ExitCode::interrupted;
  }
  return ExitCode::done;
}

}  // namespace retrace::app
