#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "report/photometry_plot.h"
#include "studies/design/design_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace::app {
namespace {

constexpr double kMostRotations = 720;

/// \param request with what the standard asks
studies::PhotometryRequest with_options(studies::PhotometryRequest request, const CommandLine& line) {
  const PhotometryOptions& options = line.photometry;
  request.area_cm2 = *options.area_cm2;
  if (options.rotation) {
    request.rotation_deg = read_number_list(*options.rotation, "--rotation");
    if (static_cast<double>(request.rotation_deg.size()) > kMostRotations)
      throw InputError({"", 0, "--rotation"},
                       fmt::format("must be at most {} turns, got {}", kMostRotations, request.rotation_deg.size()));
  }
  if (options.source_arcmin) request.apertures.source = Angle::from_deg(*options.source_arcmin / 60.0);
  if (options.receiver_arcmin) request.apertures.receiver = Angle::from_deg(*options.receiver_arcmin / 60.0);
  request.window_deg = options.window_deg;
  if (options.light != "a" && options.light != "design")
    throw InputError({"", 0, "--light"}, fmt::format("must be a or design, got {}", in_quotes(options.light)));
  request.own_light = options.light == "design";
  request.diffraction = !options.no_diffraction;
  request.advice = !options.no_advice;
  request.engine = studies::engine_from_name(options.engine);
  if (options.cutoff && !(*options.cutoff > 0.0 && *options.cutoff < 1.0))
    throw InputError({"", 0, "--cutoff"}, fmt::format("must lie between 0 and 1, got {}", *options.cutoff));
  request.cutoff = options.cutoff;
  request.rays = options.samples;
  request.seed = line.common.seed;
  request.pictures = !line.common.out.empty();
  return request;
}

std::vector<OutputFile> files_of(const studies::PhotometryResult& result, const std::string& json) {
  const report::PolarPlot field = report::far_field_plot(result);
  const report::LinePlot curves = report::observation_plot(result);
  return {{"photometry.json", json},
          {"photometry.csv", studies::photometry_csv(result)},
          {"far_field.csv", studies::far_field_map_csv(result)},
          {"far_field.svg", report::render_svg(field)},
          {"far_field.png", report::render_png(field)},
          {"r_a.svg", report::render_svg(curves)},
          {"r_a.png", report::render_png(curves)}};
}

}  // namespace

ExitCode run_photometry_command(const CommandLine& line) {
  const PhotometryOptions& options = line.photometry;
  const studies::Design design = studies::read_design(options.design, line.common.overrides);
  const std::filesystem::path limits = studies::limits_file_of(options.standard);
  studies::PhotometryRequest request =
      studies::photometry_request({options.standard, options.part_class, options.colour});
  const std::filesystem::path dye =
      studies::dye_file_of(options.dye, !design.absorption_by_wavelength.empty(), request.programme.colour);
  std::vector<std::string> inputs = files_read({design});
  inputs.push_back(limits.string());
  if (!dye.empty()) inputs.push_back(dye.string());
  request = with_options(std::move(request), line);
  studies::set_dye(request, options.dye, dye);
  const studies::PhotometryStudy study(design, std::move(request));
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common,
                  {inputs,
                   "photometry.json",
                   {"photometry.csv", "far_field.csv", "far_field.svg", "far_field.png", "r_a.svg", "r_a.png"}});
  studies::PhotometryResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  const std::string json = studies::photometry_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = files_of(result, json);
  write_outputs(line.common, json, files, studies::photometry_table(result));
  print_warnings(line.common, result.warnings);
  if (!result.complete) {
    say("retrace: interrupted; what is finished is in the result");
    return ExitCode::interrupted;
  }
  return result.passes() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace retrace::app
