#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "report/footprint_plot.h"
#include "report/rre_plot.h"
#include "studies/design/design_reader.h"
#include "studies/rre/io/derivative_files.h"
#include "studies/rre/io/far_field_files.h"
#include "studies/rre/io/footprint_files.h"
#include "studies/rre/io/rre_files.h"

namespace retrace::app {
namespace {

void check_share(double value, bool zero_allowed, const char* option) {
  if (!(value > 0.0 && value < 1.0) && !(zero_allowed && value == 0.0))
    throw InputError({"", 0, option},
                     fmt::format("must lie between 0 {}and 1, got {}", zero_allowed ? "(included) " : "", value));
}

void check_has_folder(const CommandLine& line, bool asked, const char* option) {
  if (asked && line.common.out.empty()) throw InputError({"", 0, option}, "needs --out DIR for its files");
}

studies::RreRequest request_of(const CommandLine& line) {
  studies::RreRequest request;
  const CurveList incidence = read_curve_list(line.rre.incidence, "--incidence");
  request.incidence_deg = incidence.values;
  for (const NumberRange& range : incidence.chosen) request.incidence_spans.push_back({range.low, range.high});
  request.azimuth_deg = read_number_list(line.rre.azimuth, "--azimuth");
  request.engine = studies::engine_from_name(line.rre.engine);
  request.sampling = studies::sampling_from_name(line.rre.sampling);
  request.rays = line.rre.samples;
  if (line.rre.target_error) check_share(*line.rre.target_error, false, "--target-error");
  if (line.rre.cutoff) check_share(*line.rre.cutoff, true, "--cutoff");
  request.target_error = line.rre.target_error;
  request.cutoff = line.rre.cutoff;
  request.seed = line.common.seed;
  request.derivatives = line.rre.derivatives;
  request.footprint = line.rre.footprint;
  request.far_field = line.rre.far_field;
  check_has_folder(line, request.footprint, "--footprint");
  check_has_folder(line, request.far_field, "--far-field");
  return request;
}

std::vector<studies::Design> designs_of(const CommandLine& line) {
  if (std::count(line.rre.designs.begin(), line.rre.designs.end(), "-") > 1)
    throw InputError("standard input can be read as one design only");
  std::vector<studies::Design> designs;
  for (const std::string& file : line.rre.designs) designs.push_back(studies::read_design(file, line.common.overrides));
  return designs;
}

/// The files of a run beside rre.json.
std::vector<std::string> other_files(const studies::RreRequest& request) {
  std::vector<std::string> names = {"rre.csv", "rre.svg", "rre.png"};
  if (request.footprint) names.insert(names.end(), {"footprint.json", "footprint.svg", "footprint.png"});
  if (request.far_field) names.insert(names.end(), {"far_field.json", "far_field.csv"});
  return names;
}

/// Says so if not every footprint is drawn.
void warn_of_panels(studies::RreResult& result) {
  if (result.faces.empty() || result.returned.size() <= report::kMostFootprintPanels) return;
  result.warnings.push_back(fmt::format("footprint.svg and footprint.png show the first {} of {} directions",
                                        report::kMostFootprintPanels, result.returned.size()));
}

std::vector<OutputFile> files_of(const studies::RreResult& result, const std::string& json, const RreOptions& asked) {
  const report::LinePlot plot = report::rre_plot(result);
  std::vector<OutputFile> files = {{"rre.json", json},
                                   {"rre.csv", studies::rre_csv(result)},
                                   {"rre.svg", report::render_svg(plot)},
                                   {"rre.png", report::render_png(plot)}};
  if (asked.footprint) {
    const report::MapPlot map = report::footprint_plot(result);
    files.push_back({"footprint.json", studies::footprint_json(result)});
    files.push_back({"footprint.svg", report::render_svg(map)});
    files.push_back({"footprint.png", report::render_png(map)});
  }
  if (asked.far_field) {
    files.push_back({"far_field.json", studies::far_field_json(result)});
    files.push_back({"far_field.csv", studies::far_field_csv(result)});
  }
  return files;
}

}  // namespace

ExitCode run_rre_command(const CommandLine& line) {
  studies::RreRequest request = request_of(line);
  const std::vector<std::string> others = other_files(request);
  std::vector<studies::Design> designs = designs_of(line);
  const std::vector<std::string> inputs = files_read(designs);
  const studies::RreStudy study(std::move(designs), std::move(request));
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {inputs, "rre.json", others});

  studies::RreResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  warn_of_panels(result);
  const std::string json = studies::rre_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = files_of(result, json, line.rre);
  write_outputs(line.common, json, files, studies::rre_table(result) + studies::derivative_table(result));
  print_warnings(line.common, result.warnings);
  if (!result.complete) {
    say(fmt::format("retrace: interrupted; finished points: {}", result.points.size()));
    return ExitCode::interrupted;
  }
  return ExitCode::done;
}

}  // namespace retrace::app
